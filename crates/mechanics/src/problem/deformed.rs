//! A deformed sheet and its values at points: displacement, stretches, stress.

use super::laws::CellLaws;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::material::softened_law::StressAfter;
use crate::mesh::{CellPoint, Mesh};

/// A sheet with the displacements of its nodes, from any model.
#[derive(Clone, Debug)]
pub struct DeformedSheet {
    mesh: Mesh,
    displacement: Vec<f64>,
    laws: CellLaws,
    past: Vec<Vec<f64>>,
}

/// Stress at a point of a sheet, in MPa.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stress {
    /// First Piola–Kirchhoff stress P, force per reference area: components 11, 12, 21, 22. The nominal stress is its
    /// transpose.
    pub first_piola_kirchhoff: [f64; 4],
    /// Cauchy stress, force per deformed area: components 11, 12, 22.
    pub cauchy: [f64; 3],
}

/// Why a sheet has no value at a point.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PointFault {
    /// The point is not on the sheet.
    #[error(
        "the point ({x}, {y}) mm is not on the sheet at rest: give its reference coordinates, which do not move with the sheet"
    )]
    Outside {
        /// Reference coordinate along X in mm.
        x: f64,
        /// Reference coordinate along Y in mm.
        y: f64,
    },
    /// The field turns the sheet inside out at the point.
    #[error(
        "the sheet is turned inside out at ({x}, {y}) mm, so it has no stress there: refine the mesh, or correct the field"
    )]
    Inverted {
        /// Reference coordinate along X in mm.
        x: f64,
        /// Reference coordinate along Y in mm.
        y: f64,
    },
}

/// How far outside its nearest cell a point may lie, relative to the size of that cell, and still count as on the edge: rounding.
const ON_THE_EDGE: f64 = 1e-9;

impl DeformedSheet {
    /// A sheet of a law, or of a law in each cell, with displacements in mm: ux, uy of node after node of its mesh.
    ///
    /// # Panics
    /// When there are not two displacements for every node.
    pub fn new(mesh: Mesh, displacement: Vec<f64>, laws: impl Into<CellLaws>) -> Self {
        assert_eq!(
            displacement.len(),
            2 * mesh.nodes.len(),
            "ux, uy of every node"
        );
        Self {
            mesh,
            displacement,
            laws: laws.into(),
            past: Vec::new(),
        }
    }

    /// The sheet after some displacement fields, which a softening material remembers. Without them it is loaded for the first time.
    #[must_use]
    pub fn after(self, past: Vec<Vec<f64>>) -> Self {
        Self { past, ..self }
    }

    /// The mesh at rest.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// ux, uy of node after node in mm.
    pub fn displacement(&self) -> &[f64] {
        &self.displacement
    }

    /// The displacement in mm of the point with the reference coordinates `point` in mm.
    ///
    /// # Errors
    /// [`PointFault::Outside`].
    pub fn displacement_at(&self, point: [f64; 2]) -> Result<[f64; 2], PointFault> {
        self.locate(point)?;
        Ok(self.mesh.displacement_at(&self.displacement, point))
    }

    /// The in-plane principal stretches at a point, the larger first, and the thickness stretch.
    ///
    /// # Errors
    /// [`PointFault`].
    pub fn principal_stretches_at(&self, point: [f64; 2]) -> Result<[f64; 3], PointFault> {
        let position = self.locate(point)?;
        let kinematics = self.kinematics_in(position, point)?;
        let [larger, smaller] = kinematics.principal_stretches();
        let thickness = self.laws.of(position.0).thickness_stretch(&kinematics);
        Ok([larger, smaller, thickness])
    }

    /// The stress at a point; on a side between cells, that of one of them.
    ///
    /// # Errors
    /// [`PointFault`].
    pub fn stress_at(&self, point: [f64; 2]) -> Result<Stress, PointFault> {
        let position = self.locate(point)?;
        let kinematics = self.kinematics_in(position, point)?;
        let past = self
            .past
            .iter()
            .map(|field| self.gradient_in(position, field));
        let law = self.laws.of(position.0);
        let StressAfter { stress, .. } = StressAfter::new(law, &kinematics, past);
        Ok(Stress {
            first_piola_kirchhoff: stress.into(),
            cauchy: law.cauchy_stress(&kinematics, &stress),
        })
    }

    fn kinematics_in(
        &self,
        position: CellPoint,
        [x, y]: [f64; 2],
    ) -> Result<Kinematics, PointFault> {
        let gradient = self.gradient_in(position, &self.displacement);
        Kinematics::new(&gradient).map_err(|_| PointFault::Inverted { x, y })
    }

    fn gradient_in(&self, (cell, local): CellPoint, field: &[f64]) -> PlaneTensor {
        PlaneTensor::from(self.mesh.gradient_at(field, cell, local))
    }

    fn locate(&self, point @ [x, y]: [f64; 2]) -> Result<CellPoint, PointFault> {
        let located = self.mesh.locate_within(point, ON_THE_EDGE);
        located.ok_or(PointFault::Outside { x, y })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::material::NeoHooke;
    use crate::mesh::CellShape;

    fn sheet(stretch: impl Fn([f64; 2]) -> [f64; 2]) -> DeformedSheet {
        let mesh = Mesh::plate([30.0, 10.0], [6, 2], CellShape::Quad9);
        let displacement = mesh.nodes.iter().flat_map(|node| stretch(*node)).collect();
        DeformedSheet::new(mesh, displacement, Arc::new(NeoHooke { c10: 0.5 }))
    }

    #[test]
    fn a_uniaxial_stretch_has_its_displacement_and_stress_at_every_point() {
        let (along, across) = (0.44_f64, 1.0 / 1.44_f64.sqrt() - 1.0);
        let sheet = sheet(|[x, y]| [along * x, across * y]);
        for point in [[0.0, 0.0], [30.0, 10.0], [12.3, 4.5]] {
            let [ux, uy] = sheet.displacement_at(point).unwrap();
            assert!(
                (ux - along * point[0]).abs() < 1e-12 && (uy - across * point[1]).abs() < 1e-12
            );
            let stretches = sheet.principal_stretches_at(point).unwrap();
            assert!((stretches[0] - 1.44).abs() < 1e-12);
            // σ = 2 C₁₀ (λ² − 1/λ) under tension.
            let Stress {
                cauchy,
                first_piola_kirchhoff: p,
            } = sheet.stress_at(point).unwrap();
            let exact = 1.44_f64.powi(2) - 1.0 / 1.44;
            assert!(
                (cauchy[0] - exact).abs() < 1e-12 && cauchy[2].abs() < 1e-12,
                "{cauchy:?}"
            );
            assert!((p[0] - exact / 1.44).abs() < 1e-12, "{p:?}");
        }
    }

    #[test]
    fn points_beside_the_sheet_and_inverted_cells_are_named_with_a_remedy() {
        let fault = sheet(|_| [0.0; 2]).stress_at([31.0, 5.0]).unwrap_err();
        assert!(
            fault
                .to_string()
                .contains("(31, 5) mm is not on the sheet at rest"),
            "{fault}"
        );
        let fault = sheet(|[x, _]| [-2.0 * x, 0.0])
            .stress_at([15.0, 5.0])
            .unwrap_err();
        assert!(
            fault.to_string().contains("inside out at (15, 5) mm"),
            "{fault}"
        );
    }
}
