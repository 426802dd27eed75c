//! The sheet in motion, once its grip has let go.

use gelbench::mesh::Mesh;

use super::Table;
use crate::logic::engine::Fault;
use crate::logic::engine::motion::{self, MotionAnswer, MotionQuestion};
use crate::logic::playing::Playing;
use crate::logic::scene::{Colour, Grip, Model};

/// A model as it is drawn now.
pub struct Drawn<'a> {
    /// ux, uy of node after node in mm.
    pub displacement: std::borrow::Cow<'a, [f64]>,
    /// Whether it is where the grip, or the time, is.
    pub follows: bool,
}

impl Table {
    /// The motion that is played.
    pub fn moving(&self) -> Option<&Playing> {
        self.moving.as_ref()
    }

    /// The motion that is played, once there is anything to be played: the picture of what was held stays until then.
    pub fn played(&self) -> Option<&Playing> {
        self.moving().filter(|moving| moving.has_begun())
    }

    /// The motion, to be stopped, wound and played on.
    pub fn moving_mut(&mut self) -> Option<&mut Playing> {
        self.revision += 1;
        self.moving.as_mut()
    }

    /// Lets all models go that are shown.
    pub(super) fn begin_motion(&mut self, damping: f64) {
        let scene = self.scene().clone();
        let start = |model: Model| {
            let shown = self
                .shown(model)
                .filter(|_| scene.look.models[model as usize])?;
            (shown.grip == Some(scene.grip)).then(|| shown.solved.displacement.clone())
        };
        let starts = Model::ALL.map(start);
        if starts.iter().all(Option::is_none) {
            self.message = Some(Fault {
                message: "no model is solved at the position of the grip".to_owned(),
                advice: "wait until a model has followed, then release the grip".to_owned(),
            });
            return;
        }
        if scene.grip == Grip::default() {
            self.message = Some(Fault {
                message: "the sheet is at rest, so there is no motion to compute".to_owned(),
                advice: "pull the grip first".to_owned(),
            });
            return;
        }
        self.motions += 1;
        match Playing::begin(self.motions, &scene, damping, starts) {
            Ok(playing) => self.moving = Some(playing),
            Err(fault) => self.message = Some(fault),
        }
    }

    /// A motion ends when its sheet or its grip is changed; other colours, or other models, are computed from the beginning.
    pub(super) fn end_other_motions(&mut self) {
        let Some(playing) = &self.moving else {
            return;
        };
        let (then, now) = (&playing.scene, self.scene());
        if !then.same_sheet(now) || then.grip != now.grip {
            self.moving = None;
        } else if then.look.models != now.look.models || motion::colour(then) != motion::colour(now)
        {
            let damping = playing.damping;
            self.moving = None;
            self.begin_motion(damping);
        }
    }

    /// Pieces of the motion that are to be computed.
    pub fn motion_questions(&mut self) -> Vec<MotionQuestion> {
        self.moving
            .as_mut()
            .map_or_else(Vec::new, Playing::questions)
    }

    /// Takes a piece of the motion.
    pub fn take_motion(&mut self, answer: MotionAnswer) {
        if let Some(playing) = &mut self.moving {
            playing.take(answer);
            self.revision += 1;
        }
    }

    /// Plays the motion for so many seconds.
    pub fn advance(&mut self, seconds: f64) {
        if let Some(playing) = &mut self.moving
            && playing.advance(seconds)
        {
            self.revision += 1;
        }
    }

    /// A model as it is drawn now: in motion, or held by its grip.
    pub fn drawn(&self, model: Model) -> Option<Drawn<'_>> {
        if let Some((frame, follows)) = self.played().and_then(|moving| moving.frame(model)) {
            return Some(Drawn {
                displacement: wide(&frame.displacement).into(),
                follows,
            });
        }
        let shown = self.shown(model)?;
        Some(Drawn {
            displacement: (&shown.solved.displacement[..]).into(),
            follows: self.played().is_none() && shown.grip == Some(self.scene().grip),
        })
    }

    /// What colours the nodes of a model that is drawn; nothing where it is not known there.
    pub fn drawn_values(&self, model: Model) -> Option<Vec<f64>> {
        let Some(moving) = self.played() else {
            return self.values(model);
        };
        match moving.frame(model) {
            Some((frame, _)) => Some(wide(&frame.values)),
            // A motion lacks some of the quantities that colour a held sheet.
            None if self.shown_colour() == self.scene().look.colour => self.values(model),
            None => None,
        }
    }

    /// What is shown by the colours now.
    pub fn shown_colour(&self) -> Colour {
        let scene = self.scene();
        match self.played() {
            Some(_) => motion::colour(scene),
            None => scene.look.colour,
        }
    }

    /// The values that the colours of all shown models span, each with the area of its node: while they move, those where they were
    /// let go.
    pub fn spanned(&self, models: &[Model]) -> Vec<(f64, f64)> {
        let values = |model: &Model| match self.played() {
            Some(moving) => moving.first(*model).map(|frame| wide(&frame.values)),
            None => self.values(*model),
        };
        let weighted = models.iter().filter_map(|model| {
            let values = values(model)?;
            let areas = &self.areas[usize::from(*model == Model::Elements)];
            let areas = areas.get_or_init(|| {
                let mesh = self.mesh(*model);
                mesh.map_or_else(Vec::new, Mesh::areas_of_all_nodes)
            });
            Some(values.into_iter().zip(areas.iter().copied()))
        });
        weighted.flatten().collect()
    }
}

fn wide(values: &[f32]) -> Vec<f64> {
    values.iter().map(|value| f64::from(*value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::background::Worker;
    use crate::logic::engine::motion::Mover;
    use crate::logic::engine::{Engine, Task};
    use crate::logic::scene::Scene;
    use crate::logic::table::Action;

    fn settled(scene: Scene) -> Table {
        let (mut table, mut engine) = (Table::new(scene), Engine::default());
        let tasks: Vec<Task> = table.tasks();
        for task in tasks {
            table.take(engine.answer(&task));
        }
        table
    }

    fn small() -> Scene {
        let mut scene = Scene {
            cells: [12, 4],
            ..Scene::default()
        };
        scene.look.models = [true, true, false];
        scene
    }

    #[test]
    fn what_is_let_go_moves_and_is_held_again_by_any_change() {
        let mut table = settled(small());
        table.act(Action::LetGo { damping: 0.0 });
        assert!(table.moving().is_some());
        let mut mover = Mover::default();
        let questions = table.motion_questions();
        assert_eq!(questions.len(), 2, "models that are not shown do not move");
        for question in questions {
            table.take_motion(mover.answer(&question));
        }
        let held = table
            .shown(Model::Springs)
            .unwrap()
            .solved
            .displacement
            .clone();
        let before = table.revision();
        table.advance(0.1);
        assert!(table.revision() > before);
        let drawn = table.drawn(Model::Springs).unwrap();
        let far = drawn.displacement.iter().zip(&held);
        assert!(far.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) > 0.5);
        drop(drawn);
        let mut scene = Box::new(table.scene().clone());
        scene.look.cells = true;
        table.act(Action::Change {
            scene: scene.clone(),
            gesture: false,
        });
        assert!(table.moving().is_some(), "cells are drawn of a motion too");
        scene.look.colour = Colour::Stretch;
        table.act(Action::Change {
            scene: scene.clone(),
            gesture: false,
        });
        assert_eq!(
            table.moving().unwrap().number,
            2,
            "other colours are computed anew"
        );
        scene.grip.displacement[0] += 1.0;
        table.act(Action::Change {
            scene,
            gesture: false,
        });
        assert!(table.moving().is_none());
    }

    #[test]
    fn nothing_is_let_go_at_rest_or_before_it_is_solved() {
        let mut table = Table::new(small());
        table.act(Action::LetGo { damping: 0.0 });
        assert!(table.moving().is_none() && table.message().is_some());
        let mut table = settled(Scene {
            grip: Grip::default(),
            ..small()
        });
        table.act(Action::LetGo { damping: 0.0 });
        assert!(table.moving().is_none() && table.message().is_some());
    }
}
