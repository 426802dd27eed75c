//! Plates that are symmetric about both middle lines, solved by a quarter of their finite elements.
//!
//! Where a plate is stretched, its material is isotropic and its cells are symmetric, the field is symmetric too:
//! with the length L, the width W and the stretch s
//!
//! ```text
//! ux(L − X, Y) = s L − ux(X, Y)     uy(L − X, Y) = uy(X, Y)         [mm]
//! ux(X, W − Y) = ux(X, Y)           uy(X, W − Y) = −uy(X, Y)
//! ```
//!
//! and the quarter at the origin, with ux = s L/2 at X = L/2 and uy = 0 at Y = W/2, determines the full plate. Fields found in this
//! way are a first guess: Newton's method on the full mesh begins with them, ends where they are in balance, and checks whether
//! they are stable. Compressed plates may lose their symmetry, and take the path of the full plate.

use std::sync::Arc;

use crate::error::SolveFault;
use crate::mesh::{Mesh, Side};
use crate::problem::sheet_energy::SheetEnergy;
use crate::problem::{BoundaryProblem, ClampedPlate, Model, Support};
use crate::solve::{Attendance, LinearSolver, NewtonSettings, State};

/// The middle lines as groups of the quarter.
const MIDDLES: [&str; 2] = ["half length", "half width"];

/// Largest departure of a symmetric field from symmetry, relative to its largest displacement.
const SYMMETRIC: f64 = 1e-8;

/// The quarter at the origin of a plate's finite elements.
pub struct Quarter {
    problem: BoundaryProblem,
    mesh: Mesh,
    energy: SheetEnergy,
    linear_solver: LinearSolver,
    /// For each node of the full mesh: the node of the quarter that it is or mirrors, and the axes along which it mirrors it.
    images: Vec<(usize, [bool; 2])>,
    /// Length of the full plate in mm.
    length: f64,
}

impl Quarter {
    /// The quarter of a plate's elements on a mesh; `None` where the plate need not stay symmetric, remembers its loads, or has cells that are
    /// not symmetric.
    pub fn of(plate: &ClampedPlate, full: &Mesh, linear_solver: LinearSolver) -> Option<Self> {
        let law = &plate.law;
        let cells = full.grid().cells;
        let is_symmetric = law.is_isotropic()
            && law.softening().is_none()
            && plate.stretches.iter().all(|stretch| *stretch > 0.0)
            && cells.iter().all(|cells| cells.is_multiple_of(2));
        if !is_symmetric {
            return None;
        }
        let steps = cells.map(|cells| cells * full.degree());
        let half = steps.map(|steps| steps / 2);
        let image = |node: usize| {
            let position = [node / (steps[1] + 1), node % (steps[1] + 1)];
            let mirrored = [0, 1].map(|axis| position[axis] > half[axis]);
            let [i, j] = [0, 1].map(|axis| position[axis].min(steps[axis] - position[axis]));
            (i * (half[1] + 1) + j, mirrored)
        };
        let images: Vec<(usize, [bool; 2])> = (0..full.nodes.len()).map(image).collect();
        let mesh = part(full, &images);
        let held = [
            (Side::Left.name(), [Some(0.0), Some(0.0)]),
            (MIDDLES[0], [Some(0.5 * plate.size[0]), None]),
            (MIDDLES[1], [None, Some(0.0)]),
        ];
        let supports = held.map(|(group, by)| (group.to_owned(), Support::Displacement(by)));
        Some(Self {
            problem: BoundaryProblem::supported(plate.thickness, Arc::clone(law), supports.into()),
            energy: SheetEnergy::of_mesh(Arc::clone(law), &mesh, plate.thickness),
            mesh,
            linear_solver,
            images,
            length: plate.size[0],
        })
    }

    fn model(&self) -> Model<'_> {
        let model = self.problem.on(&self.mesh, &self.energy);
        let model = model.expect("the sides of a quarter are groups of its mesh");
        model.solved_by(self.linear_solver)
    }

    /// The states of the full plate at stretches, beginning with those of coarser elements where there are any;
    /// `None` where one was not found in this way, or is not stable.
    pub fn states(
        &self,
        full: &Model,
        stretches: &[f64],
        coarser: Option<(&Mesh, &[State])>,
        settings: NewtonSettings,
        attendance: Attendance,
    ) -> Option<Vec<State>> {
        let affine = self.mesh.nodes.iter().flat_map(|[x, _]| [*x, 0.0]);
        let mut model = self.model().guessing(affine.collect());
        if let Some((mesh, states)) = coarser {
            model = model.near(mesh, states);
        }
        let quarters = model.attended(stretches, settings, attendance).ok()?;
        let field = |quarter: &State| {
            (
                quarter.factor,
                self.unfolded(&quarter.displacement, quarter.factor * self.length),
            )
        };
        let fields: Vec<(f64, Vec<f64>)> = quarters.iter().map(field).collect();
        let mut states = full.equilibria_near(&fields, settings).ok()?;
        for (state, quarter) in states.iter_mut().zip(quarters) {
            let (log, before) = (&mut state.convergence, quarter.convergence);
            let iterations = before.iterations();
            log.residuals
                .splice(0..0, before.residuals.into_iter().take(iterations));
            log.cut_steps += before.cut_steps;
            log.shifted_steps += before.shifted_steps;
            log.snaps += before.snaps;
            state.load_steps = quarter.load_steps;
        }
        Some(states)
    }

    /// The fields of the full plate in mm/mm caused by a motion of the right grip along X at states; `None` where one of these is not symmetric.
    pub fn influences(&self, states: &[State]) -> Option<Vec<Result<Vec<f64>, SolveFault>>> {
        let quarters: Option<Vec<State>> = states.iter().map(|state| self.folded(state)).collect();
        let influences = self
            .model()
            .influences(&quarters?, MIDDLES[0], 0)
            .into_iter();
        // The middle moves half as far as the grip.
        let unfold = |quarter: Vec<f64>| {
            let halved: Vec<f64> = quarter.iter().map(|z| 0.5 * z).collect();
            self.unfolded(&halved, 1.0)
        };
        Some(influences.map(|quarter| quarter.map(unfold)).collect())
    }

    /// A field of the quarter on the full plate, whose right grip has moved by `end`.
    fn unfolded(&self, field: &[f64], end: f64) -> Vec<f64> {
        let of_node = |(node, [along, across]): &(usize, [bool; 2])| {
            let [x, y] = [field[2 * node], field[2 * node + 1]];
            let x = if *along { end - x } else { x };
            [x, if *across { -y } else { y }]
        };
        self.images.iter().flat_map(of_node).collect()
    }

    /// A state on the quarter, as far as its field matters; `None` where it is not symmetric.
    fn folded(&self, state: &State) -> Option<State> {
        let mut field = vec![0.0; 2 * self.mesh.nodes.len()];
        for (full, (node, mirrored)) in self.images.iter().enumerate() {
            if *mirrored == [false; 2] {
                let [x, y] = [0, 1].map(|axis| state.displacement[2 * full + axis]);
                (field[2 * node], field[2 * node + 1]) = (x, y);
            }
        }
        let expected = self.unfolded(&field, state.factor * self.length);
        let largest = expected.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        let mut pairs = expected.iter().zip(&state.displacement);
        let is_symmetric = pairs.all(|(a, b)| (a - b).abs() <= SYMMETRIC * largest);
        is_symmetric.then(|| State {
            displacement: field,
            residual: Vec::new(),
            ..state.clone()
        })
    }
}

/// The cells of a plate whose nodes are images of themselves, with the middle lines as groups.
fn part(full: &Mesh, images: &[(usize, [bool; 2])]) -> Mesh {
    let is_kept = |node: &usize| images[*node].1 == [false; 2];
    let nodes = (0..images.len())
        .filter(is_kept)
        .map(|node| full.nodes[node]);
    let cells = (0..full.cell_count()).filter(|cell| full.cell(*cell).iter().all(is_kept));
    let cells = cells.map(|cell| {
        let nodes = full.cell(cell).iter().map(|node| images[*node].0);
        (full.shape(cell), nodes.collect())
    });
    let mut mesh = Mesh::new(nodes.collect(), cells);
    let [_, end] = mesh.bounding_box();
    mesh.name_boundary(Side::Left.name(), |[x, _]| x == 0.0);
    mesh.name_boundary(MIDDLES[0], |[x, _]| x == end[0]);
    mesh.name_boundary(MIDDLES[1], |[_, y]| y == end[1]);
    mesh
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::finite_element::{Element, FiniteElements};
    use crate::material::Card;
    use crate::material::registry::CARDS;

    fn plate(card: &str, stretches: &[f64]) -> ClampedPlate {
        ClampedPlate {
            size: [90.0, 40.0],
            thickness: 2.0,
            law: Card::load(card, Path::new("")).unwrap().law,
            stretches: stretches.to_vec(),
        }
    }

    fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
        let pairs = a.iter().zip(b);
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    }

    #[test]
    fn a_quarter_finds_the_states_and_influences_of_the_whole_with_every_card() {
        let settings = NewtonSettings::default();
        let mut symmetric = 0;
        for ((card, _), element) in CARDS
            .iter()
            .zip([Element::Q1, Element::Q2].into_iter().cycle())
        {
            let plate = plate(card, &[0.1, 0.3]);
            let elements = FiniteElements::graded(&plate, [6, 4], element, 1.5);
            let Some(quarter) = Quarter::of(&plate, &elements.mesh, LinearSolver::Automatic) else {
                assert!(
                    !plate.law.is_isotropic() || plate.law.softening().is_some(),
                    "{card}"
                );
                continue;
            };
            let model = elements.model(&plate);
            let attendance = Attendance::reporting(&|_| ());
            let folded = quarter.states(&model, &plate.stretches, None, settings, attendance);
            let folded = folded.unwrap_or_else(|| panic!("{card}: none"));
            let full = model.solve(&plate.stretches, settings, &|_| ()).unwrap();
            for (folded, full) in folded.iter().zip(&full) {
                let off = largest_difference(&folded.displacement, &full.displacement);
                assert!(off < 1e-7, "{card} {}: {off} mm", folded.factor);
                let size = full
                    .residual
                    .iter()
                    .fold(0.0, |most: f64, r| most.max(r.abs()));
                let off = largest_difference(&folded.residual, &full.residual);
                assert!(
                    off < 1e-8 * size,
                    "{card} {}: {off} of {size} N",
                    folded.factor
                );
                let energies = [folded, full].map(|state| state.convergence.energy);
                crate::assert_near(energies[0], energies[1], 1e-9, &(&card, &energies));
            }
            let expected = model.influences(&full, Side::Right.name(), 0);
            for (folded, full) in quarter.influences(&folded).unwrap().iter().zip(&expected) {
                let off = largest_difference(folded.as_ref().unwrap(), full.as_ref().unwrap());
                assert!(off < 1e-7, "{card}: {off} mm/mm");
            }
            symmetric += 1;
        }
        assert!(symmetric > CARDS.len() / 2, "{symmetric}");
    }

    #[test]
    fn what_need_not_be_symmetric_has_no_quarter() {
        let has_one = |card: &str, stretches: &[f64], cells| {
            let plate = plate(card, stretches);
            let elements = FiniteElements::new(&plate, cells, Element::Q2);
            Quarter::of(&plate, &elements.mesh, LinearSolver::Automatic).is_some()
        };
        assert!(has_one("pva-10", &[0.1, 0.2], [4, 2]));
        assert!(!has_one("pva-10", &[-0.1], [4, 2]));
        assert!(!has_one("pva-10", &[0.1], [4, 3]));
        assert!(!has_one("pva-10", &[0.1], [5, 2]));
    }

    #[test]
    fn a_field_that_is_not_symmetric_has_no_influence_by_a_quarter() {
        let plate = plate("pva-10", &[0.1]);
        let elements = FiniteElements::new(&plate, [4, 2], Element::Q2);
        let mut states = elements
            .solve(&plate, NewtonSettings::default(), &|_| ())
            .unwrap();
        let quarter = Quarter::of(&plate, &elements.mesh, LinearSolver::Automatic).unwrap();
        assert!(quarter.influences(&states).is_some());
        // The second node behind the left side.
        let unknown = 2 * (5 + 1) + 1;
        states[0].displacement[unknown] += 1e-4;
        assert!(quarter.influences(&states).is_none());
    }
}
