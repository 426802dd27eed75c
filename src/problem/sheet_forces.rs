//! The forces of a sheet alone, many points at once: laws are quickest so.

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
                self.push_gradients(last, u, &mut points.gradients);
                last += 1;
            }
            if !points.evaluate(self.law()) {
                let faulty = (first..last).find(|cell| !self.is_admissible(*cell, u));
                return Err(Inadmissible {
                    element: faulty.unwrap_or(first),
                });
            }
            let mut place = 0;
            for cell in first..last {
                place = self.add_cell_forces(cell, &points, place, forces);
            }
            first = last;
        }
        Ok(())
    }

    fn push_gradients(&self, cell: usize, u: &[f64], gradients: &mut [Vec<f64>; 4]) {
        let unknowns = self.element_unknowns(cell);
        for point in self.cell_points(cell) {
            let mut h = [0.0; 4];
            for (g, own) in point.gradients.iter().zip(unknowns.chunks_exact(2)) {
                let [x, y] = [u[own[0]], u[own[1]]];
                h[0] += x * g[0];
                h[1] += x * g[1];
                h[2] += y * g[0];
                h[3] += y * g[1];
            }
            for (component, value) in gradients.iter_mut().zip(h) {
                component.push(value);
            }
        }
    }

    /// Adds the forces of a cell, whose points begin at a place; the place after them.
    fn add_cell_forces(
        &self,
        cell: usize,
        points: &Points,
        place: usize,
        forces: &mut [f64],
    ) -> usize {
        let unknowns = self.element_unknowns(cell);
        let mut next = place;
        for point in self.cell_points(cell) {
            let p = points
                .stresses
                .each_ref()
                .map(|own| point.volume * own[next]);
            for (g, own) in point.gradients.iter().zip(unknowns.chunks_exact(2)) {
                forces[own[0]] += p[0] * g[0] + p[1] * g[1];
                forces[own[1]] += p[2] * g[0] + p[3] * g[1];
            }
            next += 1;
        }
        next
    }

    fn is_admissible(&self, cell: usize, u: &[f64]) -> bool {
        let mut points = Points::default();
        self.push_gradients(cell, u, &mut points.gradients);
        points.evaluate(self.law())
    }
}

impl Points {
    /// P at all points; whether all of them are admissible.
    fn evaluate(&mut self, law: &dyn HyperelasticLaw) -> bool {
        let count = self.gradients[0].len();
        self.stresses
            .iter_mut()
            .for_each(|own| own.resize(count, 0.0));
        let gradients = self.gradients.each_ref().map(|own| &own[..]);
        let stresses = self.stresses.each_mut().map(|own| &mut own[..]);
        let positive = law.stresses(gradients, stresses);
        positive && self.stresses.iter().flatten().all(|p| p.is_finite())
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
