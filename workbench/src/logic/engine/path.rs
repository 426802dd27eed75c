//! From one position of the grip to another by Newton's method, which starts from the former state.

use gelbench::error::Error;
use gelbench::mesh::Mesh;
use gelbench::problem::Model;
use gelbench::solve::{Loading, NewtonSettings, Potential, State, follow};
use gelbench_mechanics::solve::Attendance;

use super::bodies::{Body, Sheet};
use crate::logic::scene::Grip;

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 40,
};

/// Load factors of a path from rest.
const FROM_REST: [f64; 4] = [0.25, 0.5, 0.75, 1.0];

/// A sheet whose grip goes from where it was at load factor 0 to where it shall be at 1.
struct GripPath<'a> {
    model: &'a Model<'a>,
    held: Vec<bool>,
    /// The field before.
    from: &'a [f64],
    /// Its change by the motion of the grip, linear between the two positions.
    change: Vec<f64>,
}

impl Loading for GripPath<'_> {
    fn held(&self) -> Vec<bool> {
        self.held.clone()
    }

    fn impose(&self, factor: f64, displacement: &mut [f64]) {
        for (unknown, _) in self.held.iter().enumerate().filter(|(_, held)| **held) {
            displacement[unknown] = self.from[unknown] + factor * self.change[unknown];
        }
    }

    fn potential<'a>(&'a self, _: f64, _: &'a [f64]) -> Box<dyn Potential + 'a> {
        self.model.potential(1.0, &[])
    }

    fn guess(&self, factor: f64, previous: Option<&State>) -> Option<Vec<f64>> {
        let (at, field) = previous.map_or((0.0, self.from), |state| {
            (state.factor, &state.displacement)
        });
        let parts = field.iter().zip(&self.change);
        Some(
            parts
                .map(|(u, change)| u + (factor - at) * change)
                .collect(),
        )
    }

    fn describe(&self, element: usize) -> String {
        self.model.describe(element)
    }

    fn describe_unknown(&self, unknown: usize) -> String {
        self.model.describe_unknown(unknown)
    }
}

/// The equilibrium with the grip at a place: from the state before, else in load steps from rest.
///
/// # Errors
/// [`Error::Solve`] where neither leads there.
pub fn reach(body: &Body, sheet: &Sheet, grip: Grip) -> Result<Vec<f64>, Error> {
    let rest = vec![0.0; body.displacement.len()];
    let near = solve_path(body, sheet, body.grip, &body.displacement, grip, &[1.0]);
    near.or_else(|_| solve_path(body, sheet, Grip::default(), &rest, grip, &FROM_REST))
}

fn solve_path(
    body: &Body,
    sheet: &Sheet,
    before: Grip,
    from: &[f64],
    grip: Grip,
    factors: &[f64],
) -> Result<Vec<f64>, Error> {
    let model = body.model(sheet, grip)?;
    let path = GripPath {
        held: model.held(),
        change: between_grips(&body.mesh, [sheet.length, sheet.axis], [before, grip]),
        model: &model,
        from,
    };
    let states = follow(&path, factors, NEWTON, Attendance::reporting(&|_| ()));
    let states = states.map_err(|end| Error::Solve {
        model: "sheet".into(),
        step: format!("the grip at {grip}"),
        fault: end.fault,
    });
    Ok(states?
        .pop()
        .expect("one for each load factor")
        .displacement)
}

/// What the grip's motion from one place to another changes, falling to zero at the left grip in proportion to X; for a sheet with some length
/// and axis in mm.
pub fn between_grips(mesh: &Mesh, [length, axis]: [f64; 2], grips: [Grip; 2]) -> Vec<f64> {
    let [earlier, later] = grips.map(|grip| grip.lines(axis));
    let change = |position: &[f64; 2]| {
        let share = position[0] / length;
        [0, 1].map(|axis| share * (later[axis].at(*position) - earlier[axis].at(*position)))
    };
    mesh.nodes.iter().flat_map(change).collect()
}
