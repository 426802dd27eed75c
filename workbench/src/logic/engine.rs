//! Solves one model of a scene after the other as its grip moves, in the background.
//!
//! Plates are corrected by the climb as long as the grip is on its way: to a thousandth of the discretisation error, from
//! the state before. Once it rests, and for the other models and shapes, Newton's method goes on from the state before
//! to 1e-10 of the reaction, so that the result does not depend on the path of the grip.

use serde::{Deserialize, Serialize};
use web_time::Instant;

use gelbench::error::Error;
use gelbench::solve::{LinearSolver, Loading};
use gelbench_mechanics::problem::CellLaws;
use gelbench_mechanics::solve::{Tangent, compliance};
use gelbench_report::results::{Finding, nodal_states};

use super::background::Worker;
use super::scene::{Colour, Grip, Known, Model, Scene};

mod bodies;
mod known;
pub mod motion;
mod path;
mod plate;

pub use bodies::{Bodies, meshes};
use bodies::{Body, LastBodies};
pub use path::between_grips;

/// What is to be solved.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Task {
    /// Its number; answers carry it.
    pub number: u64,
    /// The sheet, its grip, and what colours it.
    pub scene: Scene,
    /// The model.
    pub model: Model,
    /// Whether the grip rests, and the result shall be exact.
    pub settled: bool,
    /// The springs' displacements at the same place of the grip, where the multipliers of their correction are wanted.
    pub springs: Option<Vec<f64>>,
}

impl Task {
    /// A model of a sheet whose grip rests, by itself.
    pub fn settled(scene: &Scene, model: Model) -> Self {
        Self {
            number: 1,
            scene: scene.clone(),
            model,
            settled: true,
            springs: None,
        }
    }
}

/// A solved model.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Solved {
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// What colours the nodes.
    pub colour: Colour,
    /// Its value at each node; empty where it is a distance, which needs two models.
    pub values: Vec<f64>,
    /// Force on the right grip in N.
    pub force: [f64; 2],
    /// Moment on the right grip about its middle as it is, in N mm.
    pub moment: f64,
    /// Finite elements: their displacements at the nodes of the lattice in mm.
    pub on_lattice: Option<Vec<f64>>,
    /// Finite elements: what the command would warn of.
    pub warnings: Vec<Finding>,
    /// Multipliers of the correction at each node in mm²/N; nothing where they were not wanted.
    pub multipliers: Option<Vec<f64>>,
}

/// Why there is no result, in the library's words.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Fault {
    /// What is wrong, and where.
    pub message: String,
    /// What to try; may be empty.
    pub advice: String,
}

/// What came of a task.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Answer {
    /// The task.
    pub number: u64,
    /// The model.
    pub model: Model,
    /// Where the grip was.
    pub grip: Grip,
    /// Whether the result is exact.
    pub settled: bool,
    /// The result.
    pub result: Result<Solved, Fault>,
    /// Computing time in s.
    pub seconds: f64,
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Self {
            message: error.to_string(),
            advice: error.advice().unwrap_or_default().to_owned(),
        }
    }
}

/// The models of the last scene, each in its last state.
#[derive(Default)]
pub struct Engine {
    bodies: LastBodies,
}

impl Worker for Engine {
    type Question = Task;
    type Answer = Answer;
    const NAME: &'static str = "engine";

    fn answer(&mut self, task: &Task) -> Answer {
        let begun = Instant::now();
        let result = self.solve(task);
        Answer {
            number: task.number,
            model: task.model,
            grip: task.scene.grip,
            settled: task.settled,
            result: result.map_err(Fault::from),
            seconds: begun.elapsed().as_secs_f64(),
        }
    }
}

impl Engine {
    fn solve(&mut self, task: &Task) -> Result<Solved, Error> {
        let bodies = self.bodies.of(&task.scene)?;
        let (grip, colour) = (task.scene.grip, task.scene.look.colour);
        let sheet = bodies.sheet.clone();
        let known = task.scene.look.known;
        let is_partly_known = task.model == Model::Corrected && known != Known::ALL;
        let partly = is_partly_known
            .then(|| bodies.partly_known(grip, known))
            .transpose()?;
        let body = bodies.body(task.model)?;
        // What is not known at the boundary is no state that the next one goes on from.
        let (kept, force) = match partly {
            Some(field) => (Some(std::mem::replace(&mut body.displacement, field)), None),
            None => (None, body.follow(&sheet, grip, task.settled)?),
        };
        let (force, moment) = body.reaction(&sheet, grip, force);
        let values = values(body, &sheet, colour);
        let multipliers = match &task.springs {
            Some(springs) => Some(multipliers(body, &sheet, grip, springs)?),
            None => None,
        };
        let displacement = match kept {
            Some(before) => std::mem::replace(&mut body.displacement, before),
            None => body.displacement.clone(),
        };
        let warnings = match task.model {
            Model::Elements => bodies.warnings(),
            _ => Vec::new(),
        };
        let (mesh, lattice) = (&bodies.built(task.model).mesh, &bodies.lattice);
        let on_lattice =
            (task.model == Model::Elements).then(|| mesh.displacement_on(&displacement, lattice));
        Ok(Solved {
            displacement,
            colour,
            values,
            force,
            moment,
            on_lattice,
            warnings,
            multipliers,
        })
    }
}

/// What colours the nodes.
fn values(body: &Body, sheet: &bodies::Sheet, colour: Colour) -> Vec<f64> {
    let laws = CellLaws::from(sheet.law.clone());
    let states = || nodal_states(&laws, &body.mesh, &[&body.displacement], &[]).into_iter();
    match colour {
        Colour::Displacement => {
            let vectors = body.displacement.chunks_exact(2);
            vectors.map(|u| u[0].hypot(u[1])).collect()
        }
        Colour::Stretch => states().map(|state| state.stretches[0]).collect(),
        Colour::Stress => states().map(|state| state.von_mises()).collect(),
        Colour::Distance => Vec::new(),
    }
}

/// ψ of the correction of the springs' field ū to the corrected one u: K ψ = ū − u at the nodes between the grips, the
/// derivative of the smallest ½ ‖u − ū‖² by the forces there, in mm²/N.
fn multipliers(
    body: &Body,
    sheet: &bodies::Sheet,
    grip: Grip,
    springs: &[f64],
) -> Result<Vec<f64>, Error> {
    let corrected = &body.displacement;
    if springs.len() != corrected.len() {
        return Ok(vec![0.0; corrected.len()]);
    }
    let model = body.model(sheet, grip)?;
    let change: Vec<f64> = springs.iter().zip(corrected).map(|(s, u)| s - u).collect();
    let tangent = Tangent::new(
        &*model.potential(1.0, &[]),
        &model.held(),
        LinearSolver::Direct,
    );
    let computed =
        tangent.and_then(|mut tangent| compliance(&mut tangent, &model, corrected, &change));
    computed.map_err(|fault| Error::Solve {
        model: "multipliers".into(),
        step: grip.to_string(),
        fault,
    })
}

#[cfg(test)]
mod tests;
