//! The table: its scene, the solutions of the models, and what is still to be solved. It draws nothing and waits for nothing.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use gelbench::mesh::Mesh;
use gelbench_report::results::Finding;

use super::deviations::Deviation;
use super::engine::{Answer, Fault, Solved, Task, meshes};
use super::history::History;
use super::playing::Playing;
use super::scene::{CardFile, Grip, Known, Look, Model, Outline, Scene};

/// What a user does.
#[derive(Clone, Debug)]
pub enum Action {
    /// Changes the scene; those of one gesture are one step back together.
    Change {
        /// The scene as it shall be.
        scene: Box<Scene>,
        /// Whether something is held while it changes, such as the grip.
        gesture: bool,
    },
    /// Lets go of what was held.
    EndGesture,
    /// Takes a step back.
    Undo,
    /// Takes it again.
    Redo,
    /// Lets the sheet go: its right grip opens, and the models move from where they are.
    LetGo {
        /// Shear viscosity in MPa·s besides the card's.
        damping: f64,
    },
    /// Ends the motion: the grip holds the sheet where it held it before.
    Hold,
    /// Opens a study or a card.
    Open {
        /// The name of the file.
        file: String,
        /// What it holds.
        text: String,
    },
}

/// A result with the place of the grip that it belongs to.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Where the grip was; nothing where the sheet, or what is known of it, has changed since.
    pub grip: Option<Grip>,
    /// Whether it is exact.
    pub settled: bool,
    /// What was found.
    pub solved: Solved,
    /// Computing time in s.
    pub seconds: f64,
}

impl Shown {
    /// It stays to be seen until there is another one.
    fn outdate(&mut self) {
        self.grip = None;
    }
}

/// The question that a model was solved for; it is solved again for another one.
#[derive(Clone, Debug, PartialEq)]
struct Asked {
    scene: Scene,
    settled: bool,
    multipliers: bool,
}

/// The table.
pub struct Table {
    scene: History<Scene>,
    sheet: Scene,
    meshes: Result<[Mesh; 2], Fault>,
    /// The areas of the nodes of each mesh, once colours need them: the first picture has none.
    areas: [OnceCell<Vec<f64>>; 2],
    shown: [Option<Shown>; 3],
    faults: [Option<Fault>; 3],
    asked: [Option<Asked>; 3],
    deviations: [Option<Deviation>; 2],
    /// Force along X over stretch of each model, by the stretch in ten thousandths.
    curves: [BTreeMap<i64, f64>; 3],
    /// Transverse motion and rotation of the grip for which the curves are valid.
    pulled: ([f64; 2], f64),
    /// The conditions of the corrector for which they are valid.
    known: Known,
    numbers: u64,
    oldest: u64,
    revision: u64,
    sheets: usize,
    holding: bool,
    cards: Vec<CardFile>,
    message: Option<Fault>,
    moving: Option<Playing>,
    motions: u64,
}

impl Table {
    /// With a scene on it.
    pub fn new(scene: Scene) -> Self {
        Self {
            meshes: meshes(&scene).map_err(Fault::from),
            areas: Default::default(),
            sheet: scene.clone(),
            scene: History::new(scene),
            shown: [None, None, None],
            faults: [None, None, None],
            asked: [None, None, None],
            deviations: [None; 2],
            curves: Default::default(),
            pulled: ([0.0; 2], 0.0),
            known: Known::ALL,
            numbers: 0,
            oldest: 0,
            revision: 0,
            sheets: 0,
            holding: false,
            cards: Vec::new(),
            message: None,
            moving: None,
            motions: 0,
        }
    }

    /// The scene as it is.
    pub fn scene(&self) -> &Scene {
        self.scene.now()
    }

    /// The meshes of the lattice and of the finite elements, or why there are none.
    pub fn meshes(&self) -> Result<&[Mesh; 2], &Fault> {
        self.meshes.as_ref()
    }

    /// The mesh of a model; `None` where the scene has none.
    pub fn mesh(&self, model: Model) -> Option<&Mesh> {
        let [lattice, elements] = self.meshes.as_ref().ok()?;
        Some(match model {
            Model::Elements => elements,
            _ => lattice,
        })
    }

    /// The newest result of a model.
    pub fn shown(&self, model: Model) -> Option<&Shown> {
        self.shown[model as usize].as_ref()
    }

    /// Why a model has no newer result.
    pub fn fault(&self, model: Model) -> Option<&Fault> {
        self.faults[model as usize].as_ref()
    }

    /// What the command would warn of in the state that is held, as the finite elements found it last.
    pub fn warnings(&self) -> &[Finding] {
        let held = self
            .shown(Model::Elements)
            .filter(|shown| shown.grip.is_some() && self.played().is_none());
        held.map_or(&[], |shown| &shown.solved.warnings)
    }

    /// What springs or corrected springs deviate from the finite elements.
    pub fn deviation(&self, model: Model) -> Option<&Deviation> {
        self.deviations.get(model as usize)?.as_ref()
    }

    /// The stretches and forces of a model through which its grip was pulled.
    pub fn curve(&self, model: Model) -> Vec<[f64; 2]> {
        let points = self.curves[model as usize].iter();
        points
            .map(|(at, force)| [*at as f64 * 1e-4, *force])
            .collect()
    }

    /// Counts what changes how the models look.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Counts the meshes.
    pub fn sheet_number(&self) -> usize {
        self.sheets
    }

    /// The message of the last action.
    pub fn message(&self) -> Option<&Fault> {
        self.message.as_ref()
    }

    /// Whether there is something to undo, and to redo.
    pub fn steps(&self) -> [bool; 2] {
        self.scene.steps()
    }

    /// Cards of the user's that are known.
    pub fn cards(&self) -> &[CardFile] {
        &self.cards
    }

    /// Whether all models that are wanted are exact and where the grip is.
    pub fn is_settled(&self) -> bool {
        let (grip, colour) = (Some(self.scene().grip), self.scene().look.colour);
        let exact =
            |shown: &Shown| shown.settled && shown.grip == grip && shown.solved.colour == colour;
        let at_rest =
            |model: Model| self.shown(model).is_some_and(exact) || self.fault(model).is_some();
        !self.holding && self.wanted().all(at_rest)
    }

    /// Lets go of what was held, where something was.
    pub fn let_go(&mut self) {
        if self.holding {
            self.act(Action::EndGesture);
        }
    }

    /// Does what a user does.
    pub fn act(&mut self, action: Action) {
        self.message = None;
        let before = self.drawn_as();
        match action {
            Action::Change { scene, gesture } => {
                self.holding = gesture;
                self.scene.change(*scene, gesture);
            }
            Action::EndGesture => {
                self.holding = false;
                self.scene.end_gesture();
            }
            Action::Undo => self.scene.undo(),
            Action::Redo => self.scene.redo(),
            Action::LetGo { damping } => self.begin_motion(damping),
            Action::Hold => self.moving = None,
            Action::Open { file, text } => {
                if let Err(error) = self.open(&file, &text) {
                    self.message = Some(error.into());
                }
            }
        }
        self.lay_out();
        self.end_other_motions();
        self.revision += u64::from(before != self.drawn_as());
    }

    /// What decides how the fields are drawn besides their results: not where the grip is, which moves in every frame.
    fn drawn_as(&self) -> (Look, usize, Option<u64>) {
        let motion = self.moving.as_ref().map(|playing| playing.number);
        (self.scene().look, self.sheets, motion)
    }

    /// Meshes a new sheet; the results of the old one are removed.
    fn lay_out(&mut self) {
        let scene = self.scene.now();
        let pulled = ([0.0, scene.grip.displacement[1]], scene.grip.angle);
        if scene.look.known != self.known && scene.outline == Outline::Plate {
            let corrected = Model::Corrected as usize;
            self.shown[corrected].iter_mut().for_each(Shown::outdate);
            (self.asked[corrected], self.deviations[corrected]) = (None, None);
        }
        if pulled != self.pulled || scene.look.known != self.known {
            (self.pulled, self.known) = (pulled, scene.look.known);
            self.curves = Default::default();
        }
        if scene.same_sheet(&self.sheet) {
            return;
        }
        let same_mesh = scene.outline == self.sheet.outline
            && scene.size == self.sheet.size
            && scene.cells == self.sheet.cells;
        if !same_mesh || self.meshes.is_err() {
            self.meshes = meshes(scene).map_err(Fault::from);
            self.areas = Default::default();
            self.shown = [None, None, None];
            self.sheets += 1;
        }
        self.sheet = self.scene.now().clone();
        self.shown.iter_mut().flatten().for_each(Shown::outdate);
        self.asked = [None, None, None];
        self.faults = [None, None, None];
        self.deviations = [None; 2];
        self.curves = Default::default();
        self.oldest = self.numbers + 1;
    }

    /// The models that are solved: those that are shown, and those that they are compared with.
    fn wanted(&self) -> impl Iterator<Item = Model> + '_ {
        let look = self.scene().look;
        let wanted = move |model: &Model| {
            look.models[*model as usize] || *model == Model::Elements || look.multipliers
        };
        Model::ALL.into_iter().filter(wanted)
    }

    /// What is to be solved now that was not asked for yet.
    pub fn tasks(&mut self) -> Vec<Task> {
        if self.meshes.is_err() {
            return Vec::new();
        }
        let models: Vec<Model> = self.wanted().collect();
        models
            .into_iter()
            .filter_map(|model| self.task(model))
            .collect()
    }

    fn task(&mut self, model: Model) -> Option<Task> {
        let scene = self.scene();
        let plain = Scene::default().look;
        let colour = scene.look.colour;
        let known = match model {
            Model::Corrected if scene.outline == Outline::Plate => scene.look.known,
            _ => plain.known,
        };
        let mut asked = scene.clone();
        asked.look = Look {
            colour,
            known,
            ..plain
        };
        let settled = model != Model::Corrected || !self.holding;
        let springs = self
            .springs_at_grip()
            .filter(|_| settled && model == Model::Corrected && scene.look.multipliers)
            .map(|solved| solved.displacement.clone());
        let asked = Asked {
            scene: asked,
            settled,
            multipliers: springs.is_some(),
        };
        let slot = &mut self.asked[model as usize];
        if slot.as_ref() == Some(&asked) {
            return None;
        }
        let scene = asked.scene.clone();
        *slot = Some(asked);
        self.numbers += 1;
        Some(Task {
            number: self.numbers,
            scene,
            model,
            settled,
            springs,
        })
    }

    fn springs_at_grip(&self) -> Option<&Solved> {
        let shown = self.shown(Model::Springs)?;
        (shown.grip == Some(self.scene().grip)).then_some(&shown.solved)
    }

    /// Takes the answer to a task; those of another sheet are ignored.
    pub fn take(&mut self, answer: Answer) {
        if answer.number < self.oldest {
            return;
        }
        let index = answer.model as usize;
        self.revision += 1;
        match answer.result {
            Err(fault) => self.faults[index] = Some(fault),
            Ok(solved) => {
                self.faults[index] = None;
                let stretch = answer.grip.displacement[0] / self.scene().size[0];
                let pulled = ([0.0, answer.grip.displacement[1]], answer.grip.angle);
                if pulled == self.pulled {
                    let at = (stretch * 1e4).round() as i64;
                    self.curves[index].insert(at, solved.force[0]);
                }
                self.shown[index] = Some(Shown {
                    grip: Some(answer.grip),
                    settled: answer.settled,
                    solved,
                    seconds: answer.seconds,
                });
            }
        }
        self.compare();
    }

    /// Ignores answers to the tasks so far, as after a stop.
    pub fn forget_tasks(&mut self) {
        self.oldest = self.numbers + 1;
    }
}

mod compared;
mod moving;
mod open;

pub use moving::Drawn;

#[cfg(test)]
mod tests;
