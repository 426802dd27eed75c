//! A motion as it is played: the instants computed so far, and the one that is shown.

use super::engine::Fault;
use super::engine::motion::{MotionAnswer, MotionQuestion, MotionState, MovingFrame, WATER};
use super::scene::{Model, Scene};

/// Periods of the slowest vibration along the sheet that are computed.
const PERIODS: f64 = 4.0;

/// Instants in a period at most, and numbers of a model that are kept at most.
const INSTANTS: f64 = 48.0;
const NUMBERS: f64 = 2e7;

/// Instants of a piece.
const PIECE: f64 = 6.0;

/// What a period takes on the screen in s at first.
const SHOWN_PERIOD: f64 = 2.0;

/// A motion that is computed and played.
pub struct Playing {
    /// Its number.
    pub number: u64,
    /// The scene whose grip was released.
    pub scene: Scene,
    /// The damping of the motion in MPa·s.
    pub damping: f64,
    next: [Option<MotionState>; 3],
    asked: [bool; 3],
    frames: [Vec<MovingFrame>; 3],
    faults: [Option<Fault>; 3],
    energy_error: [f64; 3],
    /// How long it lasts in s.
    pub duration: f64,
    interval: f64,
    piece: f64,
    clock: f64,
    /// Seconds on the screen for one of the motion.
    pub slowness: f64,
    /// Whether it is played or paused.
    pub running: bool,
}

impl Playing {
    /// Lets models go from where they are; `damping` is a shear viscosity in MPa·s besides the card's.
    ///
    /// # Errors
    /// What is wrong with the card.
    pub fn begin(
        number: u64,
        scene: &Scene,
        damping: f64,
        starts: [Option<Vec<f64>>; 3],
    ) -> Result<Self, Fault> {
        let card = scene.card.read()?;
        let density = card.density.unwrap_or(WATER);
        // A bar held at one end, of a material that keeps its volume: T = 4 L/c with c² = 3 μ/ρ.
        let speed = (3.0 * card.law.shear_modulus() / density).sqrt();
        let period = 4.0 * scene.size[0] / speed;
        let nodes = starts.iter().flatten().map(Vec::len).max().unwrap_or(0) as f64;
        let instants = (NUMBERS / (1.5 * nodes.max(1.0) * PERIODS)).clamp(8.0, INSTANTS);
        let interval = period / instants.floor();
        let duration = PERIODS * period;
        let relaxing = !card.viscosity.relaxation.is_empty();
        Ok(Self {
            number,
            scene: scene.clone(),
            damping,
            next: starts.map(|start| {
                start.map(|displacement| MotionState {
                    time: 0.0,
                    velocity: vec![0.0; displacement.len()],
                    displacement,
                })
            }),
            asked: [false; 3],
            frames: Default::default(),
            faults: Default::default(),
            energy_error: [0.0; 3],
            duration,
            interval,
            // What relaxes remembers, and is not cut into pieces.
            piece: if relaxing { duration } else { PIECE * interval },
            clock: 0.0,
            slowness: SHOWN_PERIOD / period,
            running: true,
        })
    }

    /// The time that is shown in s.
    pub fn clock(&self) -> f64 {
        self.clock
    }

    /// Shows another time.
    pub fn show(&mut self, time: f64) {
        self.clock = time.clamp(0.0, self.computed());
    }

    /// How far the energy balance of a model has strayed.
    pub fn energy_error(&self, model: Model) -> f64 {
        self.energy_error[model as usize]
    }

    /// Why a model goes no farther.
    pub fn fault(&self, model: Model) -> Option<&Fault> {
        self.faults[model as usize].as_ref()
    }

    /// The pieces to be computed now that were not asked for yet.
    pub fn questions(&mut self) -> Vec<MotionQuestion> {
        let mut questions = Vec::new();
        for model in Model::ALL {
            let index = model as usize;
            let Some(from) = self.next[index].as_ref().filter(|_| !self.asked[index]) else {
                continue;
            };
            let rest = self.duration - from.time;
            if rest < 0.5 * self.interval {
                continue;
            }
            questions.push(MotionQuestion {
                motion: self.number,
                scene: self.scene.clone(),
                model,
                damping: self.damping,
                from: from.clone(),
                duration: self.piece.min(rest),
                interval: self.interval,
            });
            self.asked[index] = true;
        }
        questions
    }

    /// Takes a piece; those of another motion are ignored.
    pub fn take(&mut self, answer: MotionAnswer) {
        if answer.motion != self.number {
            return;
        }
        let index = answer.model as usize;
        self.asked[index] = false;
        let goes_on = answer.fault.is_none();
        self.next[index] = answer.last.filter(|_| goes_on);
        self.faults[index] = answer.fault;
        self.energy_error[index] = self.energy_error[index].max(answer.energy_error);
        let frames = &mut self.frames[index];
        // A piece begins with the instant that the one before ended with.
        let known = usize::from(!frames.is_empty());
        frames.extend(answer.frames.into_iter().skip(known));
    }

    /// Whether anything is still to be computed.
    pub fn is_complete(&self) -> bool {
        let ended = |state: &Option<MotionState>| {
            state
                .as_ref()
                .is_none_or(|state| self.duration - state.time < 0.5 * self.interval)
        };
        self.next.iter().all(ended)
    }

    /// The time in s up to which it can be played: finite elements follow, and nobody waits for them.
    pub fn computed(&self) -> f64 {
        let quick = [Model::Springs, Model::Corrected];
        let known = |model: &Model| {
            self.next[*model as usize].is_some() || !self.frames[*model as usize].is_empty()
        };
        let all: Vec<Model> = if quick.iter().any(known) {
            quick.into_iter().filter(known).collect()
        } else {
            vec![Model::Elements]
        };
        let ends = all.iter().filter(|model| self.fault(**model).is_none());
        let end = |model: &Model| self.frames[*model as usize].last().map_or(0.0, |f| f.time);
        let least = ends.map(end).reduce(f64::min);
        least.unwrap_or_else(|| all.iter().map(end).fold(0.0, f64::max))
    }

    /// Whether there is anything to be played: until then what was held stays.
    pub fn has_begun(&self) -> bool {
        self.computed() > 0.0
    }

    /// Plays for so many seconds; from the end it begins again. Whether another instant is shown.
    pub fn advance(&mut self, seconds: f64) -> bool {
        let before = self.instant();
        let computed = self.computed();
        if self.running && computed > 0.0 {
            self.clock += seconds / self.slowness;
            if self.clock > computed {
                let over = self.duration - computed < 0.5 * self.interval || self.is_complete();
                self.clock = if over { 0.0 } else { computed };
            }
        }
        self.instant() != before
    }

    fn instant(&self) -> usize {
        (self.clock / self.interval).round() as usize
    }

    /// What is shown of a model: the instant nearest to the time, or the last one before it; and whether it is that time's.
    pub fn frame(&self, model: Model) -> Option<(&MovingFrame, bool)> {
        let frames = &self.frames[model as usize];
        let wanted = self.instant();
        let last = frames.len().checked_sub(1)?;
        Some((&frames[wanted.min(last)], wanted <= last))
    }

    /// The instant at which a model was released.
    pub fn first(&self, model: Model) -> Option<&MovingFrame> {
        self.frames[model as usize].first()
    }

    /// Time and displacement along X of the middle of the right end of a model, instant after instant; `node` is the node there.
    pub fn curve(&self, model: Model, node: usize) -> Vec<[f64; 2]> {
        let frames = self.frames[model as usize].iter();
        let at =
            |frame: &MovingFrame| Some([frame.time, f64::from(*frame.displacement.get(2 * node)?)]);
        frames.filter_map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logic::background::Worker;
    use crate::logic::engine::motion::Mover;

    fn small() -> Scene {
        Scene {
            cells: [12, 4],
            ..Scene::default()
        }
    }

    fn stretched(scene: &Scene) -> Vec<f64> {
        let lattice = crate::logic::engine::meshes(scene).unwrap()[0].clone();
        let stretch = scene.stretch();
        let nodes = lattice.nodes.iter();
        nodes.flat_map(|[x, _]| [stretch * x, 0.0]).collect()
    }

    #[test]
    fn pieces_join_and_the_end_begins_again() {
        let scene = small();
        let starts = [Some(stretched(&scene)), None, None];
        let mut playing = Playing::begin(7, &scene, 0.0, starts).unwrap();
        let mut mover = Mover::default();
        assert_eq!(playing.computed(), 0.0);
        assert!(!playing.advance(1.0), "nothing is known yet");
        while !playing.is_complete() {
            let questions = playing.questions();
            assert_eq!(questions.len(), 1);
            assert!(playing.questions().is_empty(), "asked for already");
            playing.take(mover.answer(&questions[0]));
        }
        let times: Vec<f64> = playing.frames[0].iter().map(|frame| frame.time).collect();
        assert_eq!(times.len(), (PERIODS * INSTANTS) as usize + 1);
        assert!(times.windows(2).all(|pair| {
            let step = pair[1] - pair[0];
            (step - playing.interval).abs() < 1e-6 * playing.interval
        }));
        assert!(playing.energy_error(Model::Springs) < 0.02);
        let seconds = 0.5 * playing.duration * playing.slowness;
        assert!(playing.advance(seconds));
        assert!((playing.clock() / playing.duration - 0.5).abs() < 1e-9);
        playing.advance(1.1 * seconds);
        assert_eq!(playing.clock(), 0.0);
        playing.running = false;
        assert!(!playing.advance(1.0));
    }

    #[test]
    fn it_swings_with_a_period_near_that_of_a_bar() {
        let mut scene = small();
        scene.grip.displacement[0] = 1.5;
        let starts = [Some(stretched(&scene)), None, None];
        let mut playing = Playing::begin(1, &scene, 0.0, starts).unwrap();
        let mut mover = Mover::default();
        while !playing.is_complete() {
            for question in playing.questions() {
                playing.take(mover.answer(&question));
            }
        }
        let mesh = crate::logic::engine::meshes(&scene).unwrap()[0].clone();
        let right = mesh.nodes.iter().position(|position| position[0] > 149.9);
        let curve = playing.curve(Model::Springs, right.unwrap());
        // From stretched to pressed and back: half a period each.
        let crossings: Vec<f64> = curve
            .windows(2)
            .filter(|pair| pair[0][1] * pair[1][1] < 0.0)
            .map(|pair| pair[1][0])
            .collect();
        let half = crossings[1] - crossings[0];
        let expected = 0.5 * playing.duration / PERIODS;
        assert!((half / expected - 1.0).abs() < 0.15, "{half} {expected}");
    }

    #[test]
    fn answers_of_another_motion_are_put_away_and_a_fault_ends_one_model_alone() {
        let scene = small();
        let starts = [Some(stretched(&scene)), None, None];
        let mut playing = Playing::begin(2, &scene, 0.0, starts).unwrap();
        let fault = Fault {
            message: "broken".into(),
            advice: String::new(),
        };
        let answer = |motion| MotionAnswer {
            motion,
            model: Model::Springs,
            frames: Vec::new(),
            last: None,
            energy_error: 0.0,
            fault: Some(fault.clone()),
        };
        playing.take(answer(1));
        assert!(playing.fault(Model::Springs).is_none());
        playing.take(answer(2));
        assert!(playing.fault(Model::Springs).is_some() && playing.is_complete());
    }
}
