//! A sheet's forces and tangents at many points at once, where laws are fastest.

use std::ops::Range;

use super::sheet_energy::SheetEnergy;
use crate::material::HyperelasticLaw;
use crate::material::sheet::COMPONENTS;
use crate::solve::{Evaluated, Inadmissible, Potential, Take};

/// Least number of points that are evaluated together.
const BLOCK: usize = 256;

/// Points of some cells side by side, with the numbers that a law returns for each.
struct Points {
    /// Components 11, 12, 21, 22 of the displacement gradient.
    gradients: [Vec<f64>; 4],
    responses: [Vec<f64>; COMPONENTS],
    /// Displacements or forces of one cell.
    cell: Vec<f64>,
}

impl SheetEnergy {
    /// As [`Potential::evaluate`], of a body without a history.
    pub(super) fn evaluate_virgin(
        &self,
        u: &[f64],
        forces: &mut [f64],
        mut take: Take<'_>,
    ) -> Evaluated {
        let (mut energy, mut stiffness) = (0.0, Vec::new());
        let tangents = take.is_some();
        self.in_blocks(u, tangents, |points, cells| {
            let mut position = 0;
            for cell in cells {
                let indexed = (position..).zip(self.cell_points(cell));
                let terms =
                    indexed.map(|(index, point)| point.volume() * points.responses[0][index]);
                energy += terms.sum::<f64>();
                points.add_forces(self, cell, position, forces);
                if let Some(take) = &mut take {
                    points.stiffness(self, cell, position, &mut stiffness);
                    take(cell, &stiffness);
                }
                position += self.cell_points(cell).len();
            }
        })?;
        Ok(energy)
    }

    /// Evaluates the laws at the points of all cells, some cells of one law at a time.
    fn in_blocks(
        &self,
        u: &[f64],
        tangents: bool,
        mut take: impl FnMut(&mut Points, Range<usize>),
    ) -> Result<(), Inadmissible> {
        let mut points = Points::new();
        let mut first = 0;
        while first < self.elements() {
            let mut last = first;
            let number = self.laws().number(first);
            points.gradients.iter_mut().for_each(Vec::clear);
            while last < self.elements()
                && points.gradients[0].len() < BLOCK
                && self.laws().number(last) == number
            {
                points.push(self, last, u);
                last += 1;
            }
            let law = self.laws().of(first);
            if !points.evaluate(law, tangents) {
                let faulty = (first..last).find(|cell| {
                    let mut alone = Points::new();
                    alone.push(self, *cell, u);
                    !alone.evaluate(law, tangents)
                });
                return Err(Inadmissible {
                    element: faulty.unwrap_or(first),
                });
            }
            take(&mut points, first..last);
            first = last;
        }
        Ok(())
    }
}

impl Points {
    fn new() -> Self {
        Self {
            gradients: Default::default(),
            responses: [const { Vec::new() }; COMPONENTS],
            cell: Vec::new(),
        }
    }

    /// Takes the points of another cell.
    fn push(&mut self, energy: &SheetEnergy, cell: usize, u: &[f64]) {
        let unknowns = energy.element_unknowns(cell).iter();
        self.cell.clear();
        self.cell
            .extend(unknowns.map(|unknown| u[*unknown as usize]));
        let points = energy.cell_points(cell);
        let begin = self.gradients[0].len();
        let [xx, xy, yx, yy] = self.gradients.each_mut().map(|component| {
            component.resize(begin + points.len(), 0.0);
            &mut component[begin..]
        });
        for (index, point) in points.enumerate() {
            let h = point.gradient(&self.cell);
            (xx[index], xy[index], yx[index], yy[index]) = (h[0], h[1], h[2], h[3]);
        }
    }

    /// Evaluates a law, and its tangents if they are asked for, at all points; returns whether all of them are admissible.
    fn evaluate(&mut self, law: &dyn HyperelasticLaw, tangents: bool) -> bool {
        let count = self.gradients[0].len();
        for component in &mut self.responses {
            component.resize(count, 0.0);
        }
        let gradients = self.gradients.each_ref().map(|component| &component[..]);
        let responses = self
            .responses
            .each_mut()
            .map(|component| &mut component[..]);
        let positive = law.responses(gradients, responses, tangents);
        let evaluated = if tangents { COMPONENTS } else { 5 };
        let mut values = self.responses[..evaluated].iter().flatten();
        positive && values.all(|value| value.is_finite())
    }

    /// Adds the forces of a cell whose points begin at a position.
    fn add_forces(
        &mut self,
        energy: &SheetEnergy,
        cell: usize,
        position: usize,
        forces: &mut [f64],
    ) {
        let unknowns = energy.element_unknowns(cell);
        self.cell.clear();
        self.cell.resize(unknowns.len(), 0.0);
        for (index, point) in (position..).zip(energy.cell_points(cell)) {
            let stress = [1, 2, 3, 4].map(|component| self.responses[component][index]);
            point.add_force(&stress.into(), &mut self.cell);
        }
        for (unknown, force) in unknowns.iter().zip(&self.cell) {
            forces[*unknown as usize] += force;
        }
    }

    /// Writes the stiffness of a cell whose points begin at a position.
    fn stiffness(
        &self,
        energy: &SheetEnergy,
        cell: usize,
        position: usize,
        stiffness: &mut Vec<f64>,
    ) {
        let size = energy.element_unknowns(cell).len();
        stiffness.clear();
        stiffness.resize(size * size, 0.0);
        for (index, point) in (position..).zip(energy.cell_points(cell)) {
            point.add_stiffness(&self.tangent(index), stiffness);
        }
    }

    /// ∂P/∂F at a point, column by column.
    fn tangent(&self, point: usize) -> [f64; 16] {
        const LOWER: [usize; 16] = [0, 1, 2, 3, 1, 4, 5, 6, 2, 5, 7, 8, 3, 6, 8, 9];
        LOWER.map(|component| self.responses[5 + component][point])
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::material::{HyperelasticLaw, NeoHooke, Ogden};
    use crate::mesh::{CellShape, Shape};
    use crate::problem::{BoundaryProblem, Drive, Load, Support};
    use crate::solve::{Loading, evaluate_by_elements};

    /// Energy, forces and stiffnesses of sheets with tied nodes, a pressure and a traction.
    #[test]
    fn many_points_at_once_are_element_by_element() {
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
                    regions: Vec::new(),
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
                let mut lower = Vec::new();
                let mut take =
                    |element: usize, stiffness: &[f64]| lower.push((element, stiffness.to_vec()));
                let take = Some(&mut take as &mut dyn FnMut(usize, &[f64]));
                let energy = evaluate_by_elements(&*potential, &u, &mut with_energy, take).unwrap();
                let (mut together, mut position) = (vec![0.0; u.len()], 0);
                let mut take = |element: usize, stiffness: &[f64]| {
                    let (other_element, other) = &lower[position];
                    assert_eq!(element, *other_element);
                    let size = other.len().isqrt();
                    for row in 0..size {
                        for entry in row * size..=row * size + row {
                            let far = (stiffness[entry] - other[entry]).abs();
                            assert!(far < 1e-13, "{kind:?}, {element}, {entry}: {far}");
                        }
                    }
                    position += 1;
                };
                let evaluated = potential.evaluate(&u, &mut together, Some(&mut take));
                assert!((evaluated.unwrap() / energy - 1.0).abs() < 1e-13);
                assert_eq!(position, lower.len());
                for (unknown, other) in with_energy.iter().enumerate() {
                    let far = (together[unknown] - other).abs();
                    assert!(far < 1e-13, "{kind:?}, {unknown}: {far}");
                }
                let folded: Vec<f64> = u.iter().map(|u| -400.0 * u).collect();
                let by_element = evaluate_by_elements(&*potential, &folded, &mut with_energy, None);
                assert!(by_element.is_err());
                let at_once = potential.evaluate(&folded, &mut together, None);
                assert_eq!(at_once, by_element);
            }
        }
    }
}
