//! Frame times: the grip is moved to and fro without a user, and every frame is timed.

use web_time::{Duration, Instant};

use crate::logic::scene::{Grip, Model, Scene};
use crate::logic::table::{Action, Table};

/// Frames that are not counted: the first ones prepare meshes and solve from rest.
const WARMING: usize = 60;

/// A series of frames.
pub struct Measure {
    frames: usize,
    begun: Vec<Instant>,
    /// Corrected fields that came, and the time that they took to compute in s.
    solved: Vec<f64>,
    /// What the program itself took for every frame in s, before anything was drawn.
    work: Vec<f64>,
    last: Option<Grip>,
}

impl Measure {
    /// So many frames.
    pub fn of(frames: usize) -> Self {
        Self {
            frames,
            begun: Vec::new(),
            solved: Vec::new(),
            work: Vec::new(),
            last: None,
        }
    }

    /// Notes a frame, and pulls.
    pub fn frame(&mut self, table: &mut Table) {
        if self.begun.len() > WARMING + self.frames {
            return;
        }
        if let Some(shown) = table.shown(Model::Corrected)
            && self.last != shown.grip
        {
            self.last = shown.grip;
            self.solved.push(shown.seconds);
        }
        if self.last.is_none() {
            return;
        }
        self.begun.push(Instant::now());
        let phase = self.begun.len() as f64 / 60.0;
        let length = table.scene().size[0];
        let grip = Grip {
            displacement: [
                (0.3 + 0.15 * phase.sin()) * length,
                0.02 * length * phase.cos(),
            ],
            angle: 0.05 * phase.sin(),
        };
        let scene = Box::new(Scene {
            grip,
            ..table.scene().clone()
        });
        table.act(Action::Change {
            scene,
            gesture: true,
        });
    }

    /// Notes what the program itself took for the frame that was noted last.
    pub fn worked(&mut self, work: Duration) {
        if self.work.len() < self.begun.len() {
            self.work.push(work.as_secs_f64());
        }
    }

    /// Median and worst time from frame to frame, of the program's own work in it, and of a corrected field, once all were drawn.
    pub fn report(&self) -> Option<String> {
        if self.begun.len() <= WARMING + self.frames {
            return None;
        }
        let pairs = self.begun[WARMING..].windows(2);
        let frames = pairs
            .map(|pair| 1e3 * (pair[1] - pair[0]).as_secs_f64())
            .collect();
        let work = self
            .work
            .iter()
            .skip(WARMING)
            .map(|work| 1e3 * work)
            .collect();
        let solved = self.solved.iter().map(|seconds| 1e3 * seconds).collect();
        let [[frame, worst], [work, most], [field, slowest]] =
            [frames, work, solved].map(median_and_worst);
        Some(format!(
            "{} frames: median {frame:.1} ms, worst {worst:.1} ms; the program's own work: median {work:.1} ms, worst {most:.1} ms; \
             {} corrected fields: median {field:.1} ms, worst {slowest:.1} ms",
            self.frames,
            self.solved.len()
        ))
    }
}

fn median_and_worst(mut times: Vec<f64>) -> [f64; 2] {
    times.sort_by(f64::total_cmp);
    let at = |position: usize| times.get(position).copied().unwrap_or(f64::NAN);
    [at(times.len() / 2), at(times.len().saturating_sub(1))]
}
