//! The strain energy of a sheet as a sum over sampling points, common to the finite elements and the corrector's
//! difference scheme, which differ in the points and in the gradients alone.

use std::sync::Arc;

use crate::material::HyperelasticLaw;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::material::stability::is_stable;
use crate::mesh::{CellShape, Mesh};
use crate::solve::vector::gather;
use crate::solve::{
    Connectivity, Inadmissible, Local, Potential, Remembering, Take, evaluate_by_elements,
};

/// A point at which the energy is sampled: the displacement gradient there as a combination of nodal values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplingPoint<'a> {
    /// ∂u/∂X = Σ uₐ ⊗ gₐ with one gₐ in 1/mm for each node of the cell.
    pub gradients: &'a [[f64; 2]],
    /// Share of the sheet's reference volume in mm³.
    pub volume: f64,
}

/// Π(u) = Σ V Ψ(H(u)) over the sampling points of all cells, in mJ.
#[derive(Clone, Debug)]
pub struct SheetEnergy {
    law: Arc<dyn HyperelasticLaw>,
    /// The unknowns of each cell: ux, uy of node after node.
    connectivity: Connectivity,
    /// The gradients of all points, one after the other.
    gradients: Vec<[f64; 2]>,
    /// Where the gradients of each cell begin.
    gradient_starts: Vec<usize>,
    /// The volumes of all points in mm³.
    volumes: Vec<f64>,
    /// Where the points of each cell begin.
    point_starts: Vec<usize>,
    /// The largest energy of every point so far in mJ/mm³; empty where the body was never loaded, or has no memory.
    history: Vec<f64>,
}

impl SheetEnergy {
    /// An energy without cells for so many nodes.
    pub fn new(law: Arc<dyn HyperelasticLaw>, nodes: usize) -> Self {
        Self {
            law,
            connectivity: Connectivity::new(2 * nodes),
            gradients: Vec::new(),
            gradient_starts: vec![0],
            volumes: Vec::new(),
            point_starts: vec![0],
            history: Vec::new(),
        }
    }

    /// Appends a cell of some nodes whose points were pushed before.
    pub fn push_cell(&mut self, nodes: &[usize]) {
        self.connectivity.push_nodes(nodes);
        self.gradient_starts.push(self.gradients.len());
        self.point_starts.push(self.volumes.len());
    }

    /// Reserves memory for so many cells like the first one.
    fn reserve(&mut self, cells: usize) {
        self.gradients.reserve(cells * self.gradients.len());
        self.gradient_starts.reserve(cells);
        self.volumes.reserve(cells * self.volumes.len());
        self.point_starts.reserve(cells);
    }

    /// Appends a point of the next cell: a gradient for each of its nodes, and its volume in mm³.
    pub fn push_point(&mut self, gradients: impl IntoIterator<Item = [f64; 2]>, volume: f64) {
        self.gradients.extend(gradients);
        self.volumes.push(volume);
    }

    /// The energy of the cells of a mesh, integrated by their quadrature: the finite-element method.
    pub fn of_mesh(law: Arc<dyn HyperelasticLaw>, mesh: &Mesh, thickness: f64) -> Self {
        let mut energy = Self::new(law, mesh.nodes.len());
        let mut rule = (None, Vec::new());
        for cell in 0..mesh.cell_count() {
            let shape = mesh.shape(cell);
            if rule.0 != Some(shape) {
                rule = (Some(shape), quadrature(shape));
            }
            for (derivatives, weight) in &rule.1 {
                let (gradients, jacobian) = mesh.transformed(cell, derivatives);
                energy.push_point(gradients, thickness * jacobian * *weight);
            }
            energy.push_cell(mesh.cell(cell));
            if cell == 0 {
                energy.reserve(mesh.cell_count());
            }
        }
        energy.with_places(mesh.nodes.clone())
    }

    /// The same energy with the places of its nodes: large systems are eliminated in an order by places.
    #[must_use]
    pub fn with_places(self, nodes: Vec<[f64; 2]>) -> Self {
        Self {
            connectivity: self.connectivity.with_places(nodes),
            ..self
        }
    }

    /// The energy of the same cells with another law.
    #[must_use]
    pub fn with_law(&self, law: Arc<dyn HyperelasticLaw>) -> Self {
        Self {
            law,
            ..self.clone()
        }
    }

    /// The energy of the same cells of a body with a history.
    #[must_use]
    pub fn with_history(self, history: Vec<f64>) -> Self {
        Self { history, ..self }
    }

    /// The history of the body.
    pub fn history(&self) -> &[f64] {
        &self.history
    }

    /// The sampling points of a cell.
    pub fn cell_points(&self, cell: usize) -> impl ExactSizeIterator<Item = SamplingPoint<'_>> {
        let nodes = self.element_unknowns(cell).len() / 2;
        let first = self.gradient_starts[cell];
        let gradients = &self.gradients[first..self.gradient_starts[cell + 1]];
        let volumes = &self.volumes[self.point_starts[cell]..self.point_starts[cell + 1]];
        let points = gradients.chunks_exact(nodes).zip(volumes);
        points.map(|(gradients, volume)| SamplingPoint {
            gradients,
            volume: *volume,
        })
    }

    /// The material.
    pub fn law(&self) -> &dyn HyperelasticLaw {
        &*self.law
    }
}

impl SamplingPoint<'_> {
    /// ∂u/∂X, or ∂u̇/∂X, from nodal values: components 11, 12, 21, 22.
    pub fn gradient(&self, u: &[f64]) -> PlaneTensor {
        let mut h = PlaneTensor::zeros();
        for (g, u) in self.gradients.iter().zip(u.chunks_exact(2)) {
            h[0] += u[0] * g[0];
            h[1] += u[0] * g[1];
            h[2] += u[1] * g[0];
            h[3] += u[1] * g[1];
        }
        h
    }

    /// Adds the nodal forces of a first Piola–Kirchhoff stress in MPa.
    pub fn add_force(&self, stress: &PlaneTensor, force: &mut [f64]) {
        let traction = stress * self.volume;
        for (r, g) in force.chunks_exact_mut(2).zip(self.gradients) {
            r[0] += traction[0] * g[0] + traction[1] * g[1];
            r[1] += traction[2] * g[0] + traction[3] * g[1];
        }
    }

    /// Kinematics with the nodal displacements `u`.
    fn kinematics(&self, u: &[f64]) -> Result<Kinematics, ()> {
        Kinematics::new(&self.gradient(u)).map_err(|_| ())
    }
}

impl Potential for SheetEnergy {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(
        &self,
        element: usize,
        u: &[f64],
        local: Local<'_>,
    ) -> Result<f64, Inadmissible> {
        self.evaluate_after(element, u, local, &self.history)
    }

    fn add_forces(&self, u: &[f64], forces: &mut [f64]) -> Result<(), Inadmissible> {
        match self.history.is_empty() {
            true => self.add_virgin_forces(u, forces),
            false => evaluate_by_elements(self, u, forces, None).map(|_| ()),
        }
    }

    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Result<f64, Inadmissible> {
        match self.history.is_empty() {
            true => self.evaluate_virgin(u, forces, take),
            false => evaluate_by_elements(self, u, forces, take),
        }
    }

    /// The first sampling point at which the law is not stable in the sense of Drucker.
    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        self.cell_points(element).find_map(|point| {
            let kinematics = point.kinematics(u).ok()?;
            let unstable = !is_stable(&*self.law, &kinematics);
            unstable.then(|| format!("I₁ = {:.2}", 3.0 + kinematics.invariants.i1_minus_3))
        })
    }
}

impl Remembering for SheetEnergy {
    fn evaluate_after(
        &self,
        element: usize,
        u: &[f64],
        mut local: Local<'_>,
        history: &[f64],
    ) -> Result<f64, Inadmissible> {
        let softening = self.law.softening().filter(|_| !history.is_empty());
        let softening = softening.map(|own| (own, &history[self.point_starts[element]..]));
        let mut energy = 0.0;
        for (index, point) in self.cell_points(element).enumerate() {
            let kinematics = point.kinematics(u).map_err(|()| Inadmissible { element })?;
            let (density, stress) = match &mut local.stiffness {
                None => {
                    let virgin = self.law.stress(&kinematics);
                    softening.map_or(virgin, |(own, most)| own.stress(virgin, most[index]))
                }
                Some(stiffness) => {
                    let virgin = self.law.response(&kinematics);
                    let response =
                        softening.map_or(virgin, |(own, most)| own.response(virgin, most[index]));
                    let tangent = response.tangent * point.volume;
                    add_stiffness(stiffness, point.gradients, tangent.as_slice());
                    (response.energy, response.first_piola_kirchhoff_stress)
                }
            };
            energy += point.volume * density;
            point.add_force(&stress, local.residual);
        }
        if energy.is_finite() {
            Ok(energy)
        } else {
            Err(Inadmissible { element })
        }
    }

    /// The largest energy of each sampling point.
    fn remember(&self, history: &mut Vec<f64>, u: &[f64]) {
        if self.law.softening().is_none() {
            return;
        }
        history.resize(self.volumes.len(), 0.0);
        for element in 0..self.elements() {
            let own = gather(self.element_unknowns(element), u);
            let first = self.point_starts[element];
            for (most, point) in history[first..].iter_mut().zip(self.cell_points(element)) {
                if let Ok(kinematics) = point.kinematics(&own) {
                    *most = most.max(self.law.stress(&kinematics).0);
                }
            }
        }
    }

    fn dissipated(&self, history: &[f64]) -> f64 {
        let Some(softening) = self.law.softening() else {
            return 0.0;
        };
        let points = self.volumes.iter().zip(history);
        let parts = points.map(|(volume, most)| volume * softening.dissipated(*most));
        parts.sum()
    }

    fn is_objective(&self) -> bool {
        self.law.is_objective()
    }
}

/// The derivatives of a shape's functions by natural coordinates at the points of its quadrature, with their weights.
fn quadrature(shape: CellShape) -> Vec<(Vec<[f64; 2]>, f64)> {
    let points = shape.quadrature().into_iter();
    points
        .map(|(local, weight)| (shape.derivatives(local), weight))
        .collect()
}

/// K_(a i)(b k) += gₐ_J A_(i J)(k L) g_b_L over the lower triangle; `a` is symmetric, 4 × 4.
pub fn add_stiffness(stiffness: &mut [f64], gradients: &[[f64; 2]], a: &[f64]) {
    let size = 2 * gradients.len();
    for (b, g) in gradients.iter().enumerate() {
        for k in 0..2 {
            let column: [f64; 4] =
                std::array::from_fn(|row| a[row + 8 * k] * g[0] + a[row + 8 * k + 4] * g[1]);
            for (node, g) in gradients.iter().enumerate().skip(b) {
                let row = 2 * node;
                stiffness[row * size + 2 * b + k] += g[0] * column[0] + g[1] * column[1];
                stiffness[(row + 1) * size + 2 * b + k] += g[0] * column[2] + g[1] * column[3];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{MooneyRivlin, NeoHooke};
    use crate::mesh::CellShape;
    use crate::solve::assembly::derivative_errors;

    fn mesh() -> Mesh {
        Mesh::plate([4.0, 3.0], [2, 2], CellShape::Quad9)
    }

    /// Π = t A Ψ of a homogeneous deformation, its forces and its stiffness by differences.
    #[test]
    fn a_homogeneous_deformation_has_the_energy_of_its_volume() {
        let law = NeoHooke { c10: 0.05 };
        let mesh = mesh();
        let energy = SheetEnergy::of_mesh(Arc::new(law), &mesh, 2.0);
        let h = PlaneTensor::new(0.3, 0.1, -0.05, 0.2);
        let field = |[x, y]: &[f64; 2]| [h[0] * x + h[1] * y, h[2] * x + h[3] * y];
        let u: Vec<f64> = mesh.nodes.iter().flat_map(field).collect();
        let mut residual = vec![0.0; u.len()];
        let found = crate::solve::Assembly::residual(&energy, &u, &mut residual).unwrap();
        let (density, stress) = law.stress(&Kinematics::new(&h).unwrap());
        assert!((found / (2.0 * 12.0 * density) - 1.0).abs() < 1e-13);
        // The right side of 3 × 2 mm² carries the first column of P.
        let right = (0..mesh.nodes.len()).filter(|node| mesh.nodes[*node][0] == 4.0);
        let force = right.fold([0.0; 2], |[x, y], node| {
            [x + residual[2 * node], y + residual[2 * node + 1]]
        });
        assert!((force[0] - 6.0 * stress[0]).abs() < 1e-13);
        assert!((force[1] - 6.0 * stress[2]).abs() < 1e-13);
        let direction: Vec<f64> = (0..u.len()).map(|i| (1.3 * i as f64).sin()).collect();
        let errors = derivative_errors(&energy, &u, &direction);
        assert!(errors.iter().all(|error| *error < 1e-8), "{errors:?}");
    }

    #[test]
    fn a_cell_whose_material_is_unstable_is_named_with_its_invariant() {
        let law = |c01| Arc::new(MooneyRivlin { c10: 0.307, c01 });
        let mesh = mesh();
        let rest = vec![0.0; 2 * mesh.nodes.len()];
        let told = |c01| SheetEnergy::of_mesh(law(c01), &mesh, 2.0).instability(0, &rest[..18]);
        assert_eq!(told(-0.359).as_deref(), Some("I₁ = 3.00"));
        assert_eq!(told(0.1), None);
    }
}
