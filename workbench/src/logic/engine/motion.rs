//! A sheet whose right grip has let go: its motion, piece by piece, each from the state at the end of the one before.

use serde::{Deserialize, Serialize};

use gelbench::dynamics::{
    Dashpots, Integrator, Motion, MovingSupport, SheetViscosity, Start, TimeSettings, follow,
    lumped_mass,
};
use gelbench::error::Error;
use gelbench::mass_spring::DashpotLaw;
use gelbench::material::Card;
use gelbench::material::viscosity::ViscousMaterial;
use gelbench::mesh::Side;
use gelbench::solve::Potential;
use gelbench_mechanics::dynamics::{Step, Viscosity};

use super::bodies::{Body, Energy, LastBodies};
use super::{Fault, values};
use crate::logic::background::Worker;
use crate::logic::scene::{Colour, Model, Scene};

/// Steps that a piece may take: one of a fine mesh takes some thousands.
const MOST_STEPS: f64 = 1e7;

/// The density in tonne/mm³ of a card that does not state it: that of water.
pub const WATER: f64 = 1e-9;

/// A sheet in motion.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MotionState {
    /// Time since the release of the grip in s.
    pub time: f64,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// The velocities of node after node in mm/s.
    pub velocity: Vec<f64>,
}

/// A piece of a motion that is wanted.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MotionQuestion {
    /// The number of the motion; answers carry it.
    pub motion: u64,
    /// The sheet, and what colours it.
    pub scene: Scene,
    /// The model.
    pub model: Model,
    /// Shear viscosity in MPa·s that is added to the card's.
    pub damping: f64,
    /// Where the piece begins.
    pub from: MotionState,
    /// Its length in s.
    pub duration: f64,
    /// The time between instants in s.
    pub interval: f64,
}

/// An instant as it is shown.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MovingFrame {
    /// In s.
    pub time: f64,
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f32>,
    /// What colours the nodes.
    pub values: Vec<f32>,
}

/// A piece of a motion.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MotionAnswer {
    /// The number of the motion.
    pub motion: u64,
    /// The model.
    pub model: Model,
    /// The instants; the first one is where the piece began.
    pub frames: Vec<MovingFrame>,
    /// Where the next piece begins.
    pub last: Option<MotionState>,
    /// How far the energy balance strays, relative to the largest energy.
    pub energy_error: f64,
    /// Why it went no farther.
    pub fault: Option<Fault>,
}

/// Moves the models of the last scene.
#[derive(Default)]
pub struct Mover {
    bodies: LastBodies,
}

impl Worker for Mover {
    type Question = MotionQuestion;
    type Answer = MotionAnswer;
    const NAME: &'static str = "mover";

    fn answer(&mut self, question: &MotionQuestion) -> MotionAnswer {
        let failed = |error: Error| MotionAnswer {
            motion: question.motion,
            model: question.model,
            frames: Vec::new(),
            last: None,
            energy_error: 0.0,
            fault: Some(error.into()),
        };
        self.moved(question).unwrap_or_else(failed)
    }
}

impl Mover {
    fn moved(&mut self, question: &MotionQuestion) -> Result<MotionAnswer, Error> {
        let scene = &question.scene;
        let bodies = self.bodies.of(scene)?;
        let card = scene.card.read()?;
        let thickness = bodies.sheet.thickness;
        let sheet = bodies.sheet.clone();
        let body = bodies.body(question.model)?;
        let viscosity = viscosity(&card, question.damping)?;
        let (history, fault) = body.let_go(&card, &viscosity, thickness, question)?;
        let begun = question.from.time;
        let energy_error = history.energy_error();
        let last = history.instants.last().map(|last| MotionState {
            time: begun + last.time,
            displacement: last.displacement.clone(),
            velocity: last.velocity.clone(),
        });
        let frames = history.instants.into_iter().map(|instant| {
            body.displacement = instant.displacement;
            let shown = |values: &[f64]| values.iter().map(|value| *value as f32).collect();
            MovingFrame {
                time: begun + instant.time,
                values: shown(&values(body, &sheet, colour(scene))),
                displacement: shown(&body.displacement),
            }
        });
        Ok(MotionAnswer {
            motion: question.motion,
            model: question.model,
            frames: frames.collect(),
            last,
            energy_error,
            fault,
        })
    }
}

/// What colours a sheet in motion: distances need two models at the same time, and displacements take their place.
pub fn colour(scene: &Scene) -> Colour {
    match scene.look.colour {
        Colour::Distance => Colour::Displacement,
        colour => colour,
    }
}

/// The viscous part of the card, with more damping.
///
/// # Errors
/// [`Error::Input`] where the card's law changes its volume, and the viscous stress would not.
fn viscosity(card: &Card, damping: f64) -> Result<ViscousMaterial, Error> {
    let card_viscosity = &card.viscosity;
    let viscosity = ViscousMaterial {
        shear_viscosity: card_viscosity.shear_viscosity + damping,
        ..card_viscosity.clone()
    };
    if !viscosity.is_none() && card.bulk_modulus().is_some() {
        return Err(Error::input(
            "the viscous stress assumes an incompressible sheet, but this card is compressible",
            "set the damping to zero, or choose an incompressible card",
        ));
    }
    Ok(viscosity)
}

impl Body {
    /// Moves from a state on, held at its left side alone; the instants, and why it ended before its time.
    fn let_go(
        &self,
        card: &Card,
        viscosity: &ViscousMaterial,
        thickness: f64,
        question: &MotionQuestion,
    ) -> Result<(gelbench::dynamics::History, Option<Fault>), Error> {
        let MotionQuestion { from, .. } = question;
        if from.displacement.len() != self.displacement.len() {
            return Err(Error::input(
                "the motion began on another mesh",
                "release the grip again",
            ));
        }
        let dashpots = DashpotLaw::Material(viscosity.clone());
        let viscous: Option<Box<dyn Viscosity + '_>> = match (&self.energy, viscosity.is_none()) {
            (_, true) => None,
            (Energy::Springs(springs), _) => Some(Box::new(Dashpots::new(springs, &dashpots))),
            (Energy::Sheet(sheet), _) => Some(Box::new(SheetViscosity::new(sheet, viscosity))),
        };
        let energy: &dyn Potential = self.potential();
        let clamped = self.mesh.groups()[Side::Left.name()].nodes.iter();
        let motion = Motion {
            energy,
            viscosity: viscous.as_deref(),
            mass: lumped_mass(&self.mesh, card.density.unwrap_or(WATER), thickness),
            supports: vec![MovingSupport::fixed(
                clamped.flat_map(|node| [2 * node, 2 * node + 1]).collect(),
            )],
            forces: Vec::new(),
            start: Start {
                displacement: from.displacement.clone(),
                velocity: from.velocity.clone(),
                relaxed: true,
            },
            describe: Box::new(|element| self.describe(element)),
        };
        let settings = TimeSettings {
            duration: question.duration,
            interval: question.interval,
            step: Step::Automatic,
            integrator: Integrator::VelocityVerlet,
            most_steps: MOST_STEPS,
        };
        Ok(match follow(&motion, settings, &|_| ()) {
            Ok(history) => (history, None),
            Err(end) => {
                let fault = Fault::from(Error::Solve {
                    model: question.model.name().into(),
                    step: format!("time {:.4} s", from.time + end.time),
                    fault: end.fault.clone(),
                });
                (end.history, Some(fault))
            }
        })
    }

    fn describe(&self, element: usize) -> String {
        match &self.energy {
            Energy::Springs(springs) => springs.describe_element(element),
            Energy::Sheet(_) => self.mesh.describe_cell(element),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::engine::bodies::Bodies;
    use crate::logic::engine::{Engine, Task};
    use crate::logic::scene::{CardFile, Grip, Outline};

    fn question(scene: &Scene, model: Model, from: MotionState, duration: f64) -> MotionQuestion {
        MotionQuestion {
            motion: 1,
            scene: scene.clone(),
            model,
            damping: 0.0,
            from,
            duration,
            interval: duration / 4.0,
        }
    }

    fn pulled(scene: &Scene, model: Model) -> MotionState {
        let task = Task::settled(scene, model);
        let displacement = Engine::default().answer(&task).result.unwrap().displacement;
        MotionState {
            time: 0.0,
            velocity: vec![0.0; displacement.len()],
            displacement,
        }
    }

    fn right_end(scene: &Scene, frame: &MovingFrame) -> f32 {
        let length = scene.size[0];
        let bodies = Bodies::of(scene).unwrap();
        let nodes = bodies.lattice.nodes.iter().enumerate();
        let right = nodes.filter(|(_, position)| (position[0] - length).abs() < 1e-9);
        let moved: Vec<f32> = right
            .map(|(node, _)| frame.displacement[2 * node])
            .collect();
        moved.iter().sum::<f32>() / moved.len() as f32
    }

    #[test]
    fn every_shape_springs_back_and_keeps_its_energy() {
        for (name, outline) in Outline::all([90.0, 30.0]) {
            let scene = Scene {
                outline,
                size: [90.0, 30.0],
                cells: [12, 4],
                grip: Grip {
                    displacement: [6.0, 1.0],
                    angle: 0.03,
                },
                ..Scene::default()
            };
            for model in [Model::Springs, Model::Corrected] {
                let from = pulled(&scene, model);
                let answer = Mover::default().answer(&question(&scene, model, from, 0.01));
                assert_eq!(answer.fault, None, "{name} {model:?}");
                assert!(answer.energy_error < 0.02, "{name} {model:?}: {answer:?}");
                let [first, last] = [0, 4].map(|at| right_end(&scene, &answer.frames[at]));
                assert!(
                    last < first - 1.0,
                    "{name} {model:?}: from {first} to {last}"
                );
            }
        }
    }

    #[test]
    fn a_motion_in_two_pieces_is_the_motion_in_one() {
        let mut scene = Scene {
            cells: [12, 4],
            ..Scene::default()
        };
        scene.grip.displacement[0] = 6.0;
        for damping in [0.0, 2e-5] {
            for model in [Model::Springs, Model::Corrected] {
                let from = pulled(&scene, model);
                let ask = |from, duration| {
                    let plain = question(&scene, model, from, duration);
                    let damped = MotionQuestion { damping, ..plain };
                    Mover::default().answer(&damped)
                };
                let full = ask(from.clone(), 0.01).last.unwrap();
                let half = ask(from, 0.005).last.unwrap();
                let two = ask(half, 0.005).last.unwrap();
                assert!((two.time - 0.01).abs() < 1e-12);
                let pairs = full.displacement.iter().zip(&two.displacement);
                let far = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(far < 0.05, "{model:?} {damping}: {far} mm");
            }
        }
    }

    #[test]
    fn damping_takes_energy_out_and_is_refused_where_the_volume_changes() {
        let mut scene = Scene {
            cells: [12, 4],
            ..Scene::default()
        };
        let from = pulled(&scene, Model::Springs);
        let fast = |damping: f64| {
            let plain = question(&scene, Model::Springs, from.clone(), 0.06);
            let last = Mover::default().answer(&MotionQuestion { damping, ..plain });
            let last = last.last.unwrap();
            last.velocity.iter().map(|v| v * v).sum::<f64>()
        };
        assert!(fast(2e-4) < 0.5 * fast(0.0));
        let parameters = "mu = \"0.1 MPa\"\npoisson_ratio = 0.4";
        scene.card = CardFile::shipped("neo-hooke").unwrap();
        scene.card.text = scene
            .card
            .text
            .replace("law = \"neo-hooke\"", "law = \"neo-hooke-simo-pister\"")
            .replace("c10 = \"0.05 MPa\"", parameters);
        let card = scene.card.read().unwrap();
        assert!(card.bulk_modulus().is_some());
        assert!(viscosity(&card, 1e-5).is_err() && viscosity(&card, 0.0).is_ok());
    }

    #[test]
    fn the_first_sheet_springs_back_through_a_period_with_the_damping_that_it_has_at_first() {
        let scene = Scene::default();
        for model in [Model::Springs, Model::Corrected] {
            let from = pulled(&scene, model);
            let plain = question(&scene, model, from, 0.05);
            let damping = 2e-5;
            let answer = Mover::default().answer(&MotionQuestion { damping, ..plain });
            assert_eq!(answer.fault, None, "{model:?}");
            assert!(
                answer.energy_error < 0.02,
                "{model:?}: {}",
                answer.energy_error
            );
        }
    }
}
