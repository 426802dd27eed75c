//! The forces of a sheet alone, many points at once: laws are quickest so.

use std::ops::Range;

use super::sheet_energy::SheetEnergy;
use crate::material::HyperelasticLaw;
use crate::solve::{Inadmissible, Potential};

/// Points that are evaluated together, at least.
const BLOCK: usize = 256;

/// Points of some cells side by side: components 11, 12, 21, 22 of the displacement gradient and of P in MPa.
#[derive(Default)]
struct Points {
    gradients: [Vec<f64>; 4],
    stresses: [Vec<f64>; 4],
    /// Displacements or forces of one cell.
    cell: Vec<f64>,
}

impl SheetEnergy {
    /// Adds ∂Π/∂u in N at the displacements `u` of a body without a history.
    ///
    /// # Errors
    /// [`Inadmissible`] with the first inverted cell.
    pub(super) fn add_virgin_forces(
        &self,
        u: &[f64],
        forces: &mut [f64],
    ) -> Result<(), Inadmissible> {
        let mut points = Points::default();
        let mut first = 0;
        while first < self.elements() {
            let mut last = first;
            points.gradients.iter_mut().for_each(Vec::clear);
            while last < self.elements() && points.gradients[0].len() < BLOCK {
                points.push(self, last, u);
                last += 1;
            }
            if !points.evaluate(self.law()) {
                let faulty = (first..last).find(|cell| {
                    let mut alone = Points::default();
                    alone.push(self, *cell, u);
                    !alone.evaluate(self.law())
                });
                return Err(Inadmissible {
                    element: faulty.unwrap_or(first),
                });
            }
            points.add_forces(self, first..last, forces);
            first = last;
        }
        Ok(())
    }
}

impl Points {
    /// Takes the points of another cell.
    fn push(&mut self, energy: &SheetEnergy, cell: usize, u: &[f64]) {
        let unknowns = energy.element_unknowns(cell).iter();
        self.cell.clear();
        self.cell.extend(unknowns.map(|unknown| u[*unknown]));
        for point in energy.cell_points(cell) {
            let h = point.gradient(&self.cell);
            for (component, value) in self.gradients.iter_mut().zip(h.as_slice()) {
                component.push(*value);
            }
        }
    }

    /// P at all points; whether all of them are admissible.
    fn evaluate(&mut self, law: &dyn HyperelasticLaw) -> bool {
        let count = self.gradients[0].len();
        let sizes = self.stresses.iter_mut();
        sizes.for_each(|own| own.resize(count, 0.0));
        let gradients = self.gradients.each_ref().map(|own| &own[..]);
        let stresses = self.stresses.each_mut().map(|own| &mut own[..]);
        let positive = law.stresses(gradients, stresses);
        positive && self.stresses.iter().flatten().all(|p| p.is_finite())
    }

    /// Adds the forces of the cells whose points they are.
    fn add_forces(&mut self, energy: &SheetEnergy, cells: Range<usize>, forces: &mut [f64]) {
        let mut place = 0;
        for cell in cells {
            let unknowns = energy.element_unknowns(cell);
            self.cell.clear();
            self.cell.resize(unknowns.len(), 0.0);
            for point in energy.cell_points(cell) {
                let stress = self.stresses.each_ref().map(|own| own[place]);
                point.add_force(&stress.into(), &mut self.cell);
                place += 1;
            }
            for (unknown, force) in unknowns.iter().zip(&self.cell) {
                forces[*unknown] += force;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::material::{HyperelasticLaw, NeoHooke, Ogden};
    use crate::mesh::{CellShape, Shape};
    use crate::problem::{BoundaryProblem, Drive, Load, Support};
    use crate::solve::{Assembly, Loading};

    /// Sheets with tied nodes, a pressure and a traction, whose forces element by element come with an energy.
    #[test]
    fn forces_alone_are_those_that_come_with_the_energy() {
        let ring = Shape::RingSector {
            radii: [10.0, 20.0],
            angle: 1.2,
        };
        let neo_hooke: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
        let ogden = Ogden {
            terms: vec![[0.03, 2.4], [0.01, -1.7]],
        };
        for law in [neo_hooke, Arc::new(ogden)] {
            for (_, kind) in CellShape::NAMES {
                let problem = BoundaryProblem {
                    thickness: 2.0,
                    law: Arc::clone(&law),
                    supports: vec![
                        ("start".into(), Support::Roller),
                        (
                            "end".into(),
                            Support::Grip([Drive::Force(0.3), Drive::Displacement(0.1)]),
                        ),
                    ],
                    loads: vec![
                        ("inside".into(), Load::Pressure(0.01)),
                        ("outside".into(), Load::Traction([0.002, 0.001])),
                    ],
                };
                let mesh = ring.mesh(8, kind);
                let energy = problem.finite_elements(&mesh);
                let model = problem.on(&mesh, &energy).unwrap();
                let field = |[x, y]: &[f64; 2]| [0.02 * x + 0.001 * y * y, 0.005 * x - 0.01 * y];
                let mut u: Vec<f64> = mesh.nodes.iter().flat_map(field).collect();
                model.impose(1.0, &mut u);
                let potential = model.potential(1.0, &[]);
                let mut with_energy = vec![0.0; u.len()];
                Assembly::residual(&*potential, &u, &mut with_energy).unwrap();
                let mut alone = vec![0.0; u.len()];
                potential.add_forces(&u, &mut alone).unwrap();
                for (unknown, (own, other)) in alone.iter().zip(&with_energy).enumerate() {
                    assert!(
                        (own - other).abs() < 1e-13,
                        "{kind:?}, {unknown}: {own} {other}"
                    );
                }
                let folded: Vec<f64> = u.iter().map(|u| -400.0 * u).collect();
                let by_element = Assembly::residual(&*potential, &folded, &mut with_energy);
                assert!(by_element.is_err());
                assert_eq!(
                    potential.add_forces(&folded, &mut alone),
                    by_element.map(|_| ())
                );
            }
        }
    }
}
