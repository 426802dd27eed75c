//! The strain energy of a sheet as a sum over sampling points, common to the finite elements and the corrector's
//! difference scheme, which differ in the points and in the gradients alone.

use std::ops::Range;
use std::sync::Arc;

use super::laws::CellLaws;
use super::sampling_point::{DerivativeTable, PointMap, SamplingPoint};
use crate::material::HyperelasticLaw;
use crate::material::stability::is_stable;
use crate::mesh::{CellShape, Mesh};
use crate::solve::{
    Connectivity, Evaluated, Inadmissible, Local, Potential, Remembering, Take,
    evaluate_by_elements,
};

/// Π(u) = Σ V Ψ(H(u)) over the sampling points of all cells, in mJ.
#[derive(Clone, Debug)]
pub struct SheetEnergy {
    laws: CellLaws,
    /// The unknowns of each cell: ux, uy of node after node.
    connectivity: Connectivity,
    tables: Vec<DerivativeTable>,
    /// The table of each cell.
    table_of: Vec<u8>,
    /// All points, cell by cell.
    points: Vec<PointMap>,
    /// Where the points of each cell begin.
    point_starts: Vec<u32>,
    /// The largest energy of every point so far in mJ/mm³; empty where the body was never loaded, or has no memory.
    history: Vec<f64>,
}

impl SheetEnergy {
    /// An energy without cells for so many nodes.
    pub fn new(laws: impl Into<CellLaws>, nodes: usize) -> Self {
        Self {
            laws: laws.into(),
            connectivity: Connectivity::new(2 * nodes),
            tables: Vec::new(),
            table_of: Vec::new(),
            points: Vec::new(),
            point_starts: vec![0],
            history: Vec::new(),
        }
    }

    /// Adds a table for cells to come; returns its number.
    pub fn push_table(&mut self, table: DerivativeTable) -> u8 {
        self.tables.push(table);
        u8::try_from(self.tables.len() - 1).expect("few kinds of cells")
    }

    /// Appends a cell of some nodes with its points, whose derivatives are those of a table.
    ///
    /// # Panics
    /// When the nodes or points are not those of the table.
    pub fn push_cell(
        &mut self,
        nodes: &[usize],
        table: u8,
        points: impl IntoIterator<Item = PointMap>,
    ) {
        self.connectivity.push_nodes(nodes);
        self.table_of.push(table);
        let before = self.points.len();
        self.points.extend(points);
        let end = u32::try_from(self.points.len());
        self.point_starts.push(end.expect("fewer than 2³² points"));
        let derivative_table = &self.tables[usize::from(table)];
        let sizes = [derivative_table.nodes(), derivative_table.points().len()];
        assert_eq!([nodes.len(), self.points.len() - before], sizes);
    }

    /// The energy of the cells of a mesh, integrated by their quadrature: the finite-element method.
    pub fn of_mesh(laws: impl Into<CellLaws>, mesh: &Mesh, thickness: f64) -> Self {
        let mut energy = Self::new(laws, mesh.nodes.len());
        let mut kinds: Vec<(CellShape, u8, DerivativeTable, Vec<f64>)> = Vec::new();
        for cell in 0..mesh.cell_count() {
            let shape = mesh.shape(cell);
            let known = kinds.iter().position(|(other, ..)| *other == shape);
            let kind = known.unwrap_or_else(|| {
                let table = DerivativeTable::of_shape(shape);
                let rule = shape.quadrature().into_iter();
                let weights = rule.map(|(_, weight)| weight).collect();
                kinds.push((shape, energy.push_table(table.clone()), table, weights));
                kinds.len() - 1
            });
            let (_, number, table, weights) = &kinds[kind];
            let points = table.points().zip(weights).map(|(derivatives, weight)| {
                let (inverse, jacobian) = mesh.inverse_map(cell, derivatives);
                let volume = thickness * jacobian * weight;
                PointMap { inverse, volume }
            });
            energy.push_cell(mesh.cell(cell), *number, points);
        }
        energy.complete(mesh.nodes.clone())
    }

    /// The energy with the positions of its nodes, by which large systems are ordered for elimination.
    #[must_use]
    pub fn complete(mut self, nodes: Vec<[f64; 2]>) -> Self {
        self.table_of.shrink_to_fit();
        self.points.shrink_to_fit();
        self.point_starts.shrink_to_fit();
        self.connectivity = self.connectivity.with_positions(nodes).shared();
        self
    }

    /// The energy of the same cells with another law of those that belong to no region.
    #[must_use]
    pub fn with_law(&self, law: Arc<dyn HyperelasticLaw>) -> Self {
        Self {
            laws: self.laws.with_law(law),
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
        let table = &self.tables[usize::from(self.table_of[cell])];
        let maps = &self.points[self.points_of(cell)];
        let points = table.points().zip(maps);
        points.map(|(derivatives, map)| SamplingPoint::new(derivatives, *map))
    }

    /// The numbers of a cell's sampling points among all.
    pub fn points_of(&self, cell: usize) -> Range<usize> {
        self.point_starts[cell] as usize..self.point_starts[cell + 1] as usize
    }

    /// The materials.
    pub fn laws(&self) -> &CellLaws {
        &self.laws
    }
}

impl Potential for SheetEnergy {
    fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    fn evaluate_element(&self, element: usize, u: &[f64], local: Local<'_>) -> Evaluated {
        self.evaluate_after(element, u, local, &self.history)
    }

    fn evaluate(&self, u: &[f64], forces: &mut [f64], take: Take<'_>) -> Evaluated {
        if self.history.is_empty() {
            self.evaluate_virgin(u, forces, take)
        } else {
            evaluate_by_elements(self, u, forces, take)
        }
    }

    /// The first sampling point at which the law is not stable in the sense of Drucker.
    fn instability(&self, element: usize, u: &[f64]) -> Option<String> {
        self.cell_points(element).find_map(|point| {
            let kinematics = point.kinematics(u).ok()?;
            let unstable = !is_stable(self.laws.of(element), &kinematics);
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
    ) -> Evaluated {
        let law = self.laws.of(element);
        let softening = law.softening().filter(|_| !history.is_empty());
        let softening = softening.map(|softening| (softening, &history[self.points_of(element)]));
        let mut energy = 0.0;
        for (index, point) in self.cell_points(element).enumerate() {
            let kinematics = point.kinematics(u).map_err(|()| Inadmissible { element })?;
            let (density, stress) = match &mut local.stiffness {
                None => {
                    let virgin = law.stress(&kinematics);
                    softening.map_or(virgin, |(softening, most)| {
                        softening.stress(virgin, most[index])
                    })
                }
                Some(stiffness) => {
                    let virgin = law.response(&kinematics);
                    let response = softening.map_or(virgin, |(softening, most)| {
                        softening.response(virgin, most[index])
                    });
                    point.add_stiffness(response.tangent.as_slice(), stiffness);
                    (response.energy, response.first_piola_kirchhoff_stress)
                }
            };
            energy += point.volume() * density;
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
        let mut laws = self.laws.all().iter();
        if laws.all(|law| law.softening().is_none()) {
            return;
        }
        history.resize(self.points.len(), 0.0);
        for element in 0..self.elements() {
            let cell_displacement = self.connectivity.values(element, u);
            let law = self.laws.of(element);
            let points = &mut history[self.points_of(element)];
            for (most, point) in points.iter_mut().zip(self.cell_points(element)) {
                if let Ok(kinematics) = point.kinematics(&cell_displacement) {
                    *most = most.max(law.stress(&kinematics).0);
                }
            }
        }
    }

    fn dissipated(&self, history: &[f64]) -> f64 {
        let cells = 0..self.elements();
        let softening = cells.filter_map(|cell| Some((cell, self.laws.of(cell).softening()?)));
        let parts = softening.flat_map(|(cell, softening)| {
            let history = history.get(self.points_of(cell)).unwrap_or_default();
            let points = self.cell_points(cell).zip(history);
            points.map(move |(point, most)| point.volume() * softening.dissipated(*most))
        });
        parts.sum()
    }

    fn is_objective(&self) -> bool {
        self.laws.all().iter().all(|law| law.is_objective())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::sheet::{Kinematics, PlaneTensor};
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
        let computed = crate::solve::Assembly::residual(&energy, &u, &mut residual).unwrap();
        let (density, stress) = law.stress(&Kinematics::new(&h).unwrap());
        assert!((computed / (2.0 * 12.0 * density) - 1.0).abs() < 1e-13);
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
        let instability =
            |c01| SheetEnergy::of_mesh(law(c01), &mesh, 2.0).instability(0, &rest[..18]);
        assert_eq!(instability(-0.359).as_deref(), Some("I₁ = 3.00"));
        assert_eq!(instability(0.1), None);
    }
}
