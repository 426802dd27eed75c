//! The equations, the measured forces and the law linearised about a field.

use nalgebra::{DMatrix, DVector};

use super::body_force::BodyForce;
use crate::error::Error;
use crate::estimation::equations::{Equations, SearchState, solve};
use crate::estimation::input::MeasuredForce;
use crate::problem::corner_forces::Share;
use crate::solve::Assembly;
use crate::solve::vector::{add_scaled, dot};

/// The equations and the observations linearised about a state.
pub struct Linear {
    /// −K⁻¹ F.
    pub newton_step: Vec<f64>,
    /// ∂u/∂p of one parameter after the other.
    pub sensitivities: Vec<Vec<f64>>,
    /// H ∂u/∂p.
    pub design: DMatrix<f64>,
    /// The derivatives of the measured forces with respect to p, and measured less computed forces, both over the standard deviations.
    pub force_rows: (DMatrix<f64>, DVector<f64>),
}

impl Equations<'_> {
    /// Linearises the equations and the observations about a state.
    pub(in crate::estimation) fn linearise(
        &mut self,
        state: &SearchState,
    ) -> Result<Linear, Error> {
        let (mesh, field) = (self.task.specimen.mesh, &state.field);
        let describe = |cell: usize| mesh.describe_cell(cell);
        let residual =
            self.with_potential(|newton, potential| newton.tangent.at(potential, field, &describe));
        let residual = residual.map_err(solve)?;
        let imposed = self.motion.at(&state.parameters);
        let motions = imposed.motions(self.motion.parameters(), field.len());
        let slopes = self.law_slopes(&state.parameters, field)?;
        let mut forces = vec![residual.clone()];
        for motion in &motions {
            let mut force = vec![0.0; field.len()];
            let added = Assembly::add_product(&self.energy, field, motion, &mut force);
            added.map_err(|fault| self.inverted(fault))?;
            forces.push(force);
        }
        forces.extend(slopes.iter().cloned());
        let body = self.body.iter().flat_map(BodyForce::columns);
        forces.extend(body.map(|column| column.iter().map(|force| -force).collect()));
        let mut changes = self.newton.tangent.changes(&forces).map_err(solve)?;
        let mut sensitivities = changes.split_off(1);
        for (sensitivity, motion) in sensitivities.iter_mut().zip(&motions) {
            add_scaled(sensitivity, 1.0, motion);
        }
        let newton_step = changes.remove(0);
        let interpolation = &self.task.observations.interpolation;
        let columns = sensitivities
            .iter()
            .flat_map(|column| interpolation.multiply(column));
        let design = DMatrix::from_iterator(interpolation.len(), sensitivities.len(), columns);
        let force_rows =
            self.force_rows(field, &residual, &newton_step, &sensitivities, &slopes)?;
        Ok(Linear {
            newton_step,
            sensitivities,
            design,
            force_rows,
        })
    }

    /// The measured forces, linearised.
    fn force_rows(
        &self,
        field: &[f64],
        residual: &[f64],
        newton_step: &[f64],
        sensitivities: &[Vec<f64>],
        slopes: &[Vec<f64>],
    ) -> Result<(DMatrix<f64>, DVector<f64>), Error> {
        let measured = self.task.knowledge.measured_forces();
        let mut rows = DMatrix::zeros(measured.len(), sensitivities.len());
        let mut values = DVector::zeros(measured.len());
        for (row, measured) in measured.iter().enumerate() {
            let grip = self.grip_of_edge(measured, field)?;
            let force = dot(&grip.factors, residual) + dot(&grip.gradient, newton_step);
            values[row] = (measured.force - force) / measured.standard_deviation;
            let slopes = grip.slopes(sensitivities, self.motion.parameters(), slopes);
            for (column, slope) in slopes.into_iter().enumerate() {
                rows[(row, column)] = slope / measured.standard_deviation;
            }
        }
        Ok((rows, values))
    }

    /// A measured force as a function of the field.
    pub fn grip_of_edge(&self, measured: &MeasuredForce, field: &[f64]) -> Result<Grip, Error> {
        let bodies = self.bodies.iter();
        let of_edge = bodies.filter(|body| body.name == measured.edge);
        let shares = of_edge.flat_map(|body| &body.shares[measured.axis]);
        let shares: Vec<Share> = shares.copied().collect();
        self.grip(&shares, measured.axis, field)
    }

    /// The force of some reactions along an axis as a function of the field.
    pub fn grip(&self, shares: &[Share], axis: usize, field: &[f64]) -> Result<Grip, Error> {
        let mut factors = vec![0.0; field.len()];
        for (node, factor) in shares {
            factors[2 * node + axis] += factor;
        }
        for unknown in self.newton.free() {
            factors[*unknown] = 0.0;
        }
        let mut gradient = vec![0.0; field.len()];
        let added = Assembly::add_product(&self.energy, field, &factors, &mut gradient);
        added.map_err(|fault| self.inverted(fault))?;
        Ok(Grip { factors, gradient })
    }
}

/// The force g·∂Π/∂u of a grip.
pub struct Grip {
    /// g: the factors of the reactions at the grip's held unknowns.
    pub factors: Vec<f64>,
    /// g·K.
    pub gradient: Vec<f64>,
}

impl Grip {
    /// Its derivatives with respect to p. The parameters from `first` on are those of the law; `law` is ∂F/∂θ.
    pub fn slopes(&self, sensitivities: &[Vec<f64>], first: usize, law: &[Vec<f64>]) -> Vec<f64> {
        let columns = sensitivities.iter();
        let mut slopes: Vec<f64> = columns.map(|column| dot(&self.gradient, column)).collect();
        for (slope, force) in slopes[first..].iter_mut().zip(law) {
            *slope += dot(&self.factors, force);
        }
        slopes
    }
}
