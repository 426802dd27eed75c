//! The forces on the edges of an estimated field, the parameters of its law, and how both depend on the position of the edges.

use super::edges::Body;
use super::equations::Grip;
use super::outcome::{EdgeForce, ForceCheck, FoundParameter};
use super::search::{MeshError, NearestField};
use super::uncertainty::ScaleChange;
use crate::error::Error;
use crate::material::parameters::Parameter;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::solve::vector::dot;
use crate::statistics::Estimate;

impl NearestField<'_> {
    /// The force of a body along an axis, and its derivatives with respect to p; `slopes` are those of F with respect to the law's parameters.
    pub(super) fn grip_of(
        &self,
        body: usize,
        axis: usize,
        slopes: &[Vec<f64>],
    ) -> Result<(Grip, Vec<f64>), Error> {
        let shares = &self.equations.bodies[body].shares[axis];
        let grip = self.equations.grip(shares, axis, &self.field)?;
        let first = self.equations.motion.parameters();
        let row = grip.slopes(&self.linear.sensitivities, first, slopes);
        Ok((grip, row))
    }

    /// A value of each body along x and along y.
    pub(super) fn by_body<T>(
        &self,
        value: impl Fn(usize, usize) -> Result<T, Error>,
    ) -> Result<Vec<[T; 2]>, Error> {
        let bodies = 0..self.equations.bodies.len();
        bodies
            .map(|body| Ok([value(body, 0)?, value(body, 1)?]))
            .collect()
    }

    /// The forces of the bodies that hold the sheet, with the discretisation error if it is known, and the standard errors due to considered
    /// parameters if there are any.
    pub fn forces(
        &self,
        reach: f64,
        mesh_error: Option<&MeshError>,
        considered: &[[f64; 2]],
    ) -> Result<Vec<EdgeForce>, Error> {
        let reactions = self.reactions();
        let slopes = self.equations.law_slopes(&self.parameters, &self.field)?;
        let along = |index: usize, axis: usize| -> Result<Estimate, Error> {
            let (grip, row) = self.grip_of(index, axis, &slopes)?;
            let force = dot(&grip.factors, &reactions);
            let mesh = mesh_error.map_or(0.0, |mesh_error| {
                mesh_error.forces[index][axis] + dot(&row, mesh_error.parameters.as_slice())
            });
            let division = self.equations.bodies[index].division_error(&reactions, axis);
            let by_considered = considered.get(index).map_or(0.0, |all| all[axis]);
            let others = [mesh, division, by_considered];
            let error = others.into_iter().fold(self.error(&row), f64::hypot);
            Ok(Estimate::new(force, error, reach))
        };
        let bodies = self.equations.bodies.iter().zip(self.by_body(along)?);
        let force = |(body, force): (&Body, [Estimate; 2])| EdgeForce {
            edge: body.name.clone(),
            force,
        };
        Ok(bodies.map(force).collect())
    }

    /// The parameters of the law that were found.
    pub(super) fn law_parameters(
        &self,
        reach: f64,
        mesh_error: Option<&MeshError>,
    ) -> Vec<FoundParameter> {
        let first = self.equations.motion.parameters();
        let regressed = self.equations.task.knowledge.law.iter();
        let parameters = regressed.flat_map(|law| law.parameters()).enumerate();
        let estimate = |(index, parameter): (usize, &Parameter)| {
            let position = first + index;
            let error = self.fit.covariance[(position, position)].max(0.0).sqrt();
            let mesh = mesh_error.map_or(0.0, |mesh_error| mesh_error.parameters[position]);
            let value = Estimate::new(self.parameters[position], error.hypot(mesh), reach);
            (parameter.key.into(), parameter.unit().into(), value)
        };
        parameters.map(estimate).collect()
    }

    /// The measured forces compared with those of the field, which also depend on the picture's scale and on considered parameters; must be called
    /// before the covariance includes the scale. A force that a parameter of the law fits exactly is no check.
    pub(super) fn force_checks(
        &self,
        mesh_error: Option<&MeshError>,
        scale: &ScaleChange,
        considered: &[[f64; 2]],
    ) -> Result<Vec<ForceCheck>, Error> {
        const REDUNDANT: f64 = 1e-3;
        let with_all = self.forces(1.0, mesh_error, considered)?;
        let plain = self.forces(1.0, None, &[])?;
        let mut checks = Vec::new();
        let knowledge = self.equations.task.knowledge;
        for measured in &knowledge.forces {
            let axis = measured.axis;
            let sum = |forces: &[EdgeForce]| {
                let on_edge = forces.iter().filter(|force| force.edge == measured.edge);
                on_edge.fold([0.0, 0.0], |[value, square], force| {
                    let force = &force.force[axis];
                    [value + force.value, square + force.standard_error.powi(2)]
                })
            };
            let ([estimated, noise], [_, complete]) = (sum(&plain), sum(&with_all));
            let variance = measured.standard_deviation.powi(2);
            let variance_of_force = if knowledge.forces_are_checks {
                variance + noise
            } else {
                variance - noise
            };
            if variance_of_force > REDUNDANT * variance {
                let bodies = self.equations.bodies.iter().zip(&scale.forces);
                let of_edge = bodies.filter(|(body, _)| body.name == measured.edge);
                let change: f64 = of_edge.map(|(_, change)| change[axis]).sum();
                let by_scale = knowledge.scale_deviation * change;
                let spread = (variance_of_force + (complete - noise).max(0.0))
                    .sqrt()
                    .hypot(by_scale);
                checks.push(ForceCheck {
                    measured: measured.clone(),
                    estimated,
                    standardised: (measured.force - estimated) / spread,
                });
            }
        }
        Ok(checks)
    }

    /// |Σ F| of all bodies and forces on the interior over the largest force of a body: how far the forces are from balance.
    pub(super) fn imbalance(&self) -> f64 {
        let reactions = self.reactions();
        let (mut sum, mut largest) = ([0.0; 2], 0.0_f64);
        for body in &self.equations.bodies {
            let force = body.force(&reactions);
            (0..2).for_each(|axis| sum[axis] += force[axis]);
            largest = largest.max(force[0].hypot(force[1]));
        }
        for pair in self.equations.forces.chunks_exact(2) {
            (0..2).for_each(|axis| sum[axis] += pair[axis]);
        }
        sum[0].hypot(sum[1]) / largest.max(f64::MIN_POSITIVE)
    }

    /// ∮ Ψ ds/∫ Ψ dA along the free edges.
    pub(super) fn growth(&self) -> f64 {
        let mesh = self.equations.task.specimen.mesh;
        let energy = |cell: usize, local: [f64; 2]| {
            let gradient = PlaneTensor::from(mesh.gradient_at(&self.field, cell, local));
            Kinematics::new(&gradient).map_or(0.0, |kinematics| {
                self.equations.law(cell).stress(&kinematics).0
            })
        };
        let over = |cell: usize| -> f64 {
            let points = mesh.shape(cell).quadrature().into_iter();
            points
                .map(|(local, weight)| weight * mesh.gradients(cell, local).1 * energy(cell, local))
                .sum()
        };
        let total: f64 = (0..mesh.cell_count()).map(over).sum();
        let edges = self.equations.edges.iter();
        let free = edges.filter(|edge| !edge.is_loaded());
        let along = |pair: &[usize]| {
            let [a, b] = [mesh.nodes[pair[0]], mesh.nodes[pair[1]]];
            let middle = [0, 1].map(|axis| (a[axis] + b[axis]) / 2.0);
            let (cell, local) = mesh.locate(middle);
            (b[0] - a[0]).hypot(b[1] - a[1]) * energy(cell, local)
        };
        let around = free
            .flat_map(|edge| edge.segment.nodes.windows(2))
            .map(along);
        around.sum::<f64>() / total.max(f64::MIN_POSITIVE)
    }
}
