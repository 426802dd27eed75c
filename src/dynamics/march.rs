//! Steps from instant to instant, halved where they explode.

use super::History;
use super::central::Central;
use super::implicit::Implicit;
use super::motion::{Motion, Moving};
use crate::error::SolveFault;

/// How a motion is integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Velocity Verlet, which is the method of central differences; viscous forces are taken at the end of a step.
    VelocityVerlet,
    /// Generalised-α of Chung and Hulbert.
    GeneralisedAlpha {
        /// ρ∞, the part of the fastest motions that a step leaves: 1 is Newmark's average acceleration, 0 damps them
        /// at once.
        spectral_radius: f64,
        /// Largest residual of a free unknown relative to the largest force.
        tolerance: f64,
    },
}

/// How long a step is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Half of the longest stable one for Verlet, found from the stiffness again and again; a hundredth of the slowest
    /// period for generalised-α.
    Automatic,
    /// At most so many s.
    AtMost(f64),
}

/// What is computed, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// The end in s.
    pub duration: f64,
    /// The time between instants in s; the last instant is the end.
    pub interval: f64,
    /// How long a step is.
    pub step: Step,
    /// How it is taken.
    pub integrator: Integrator,
}

/// The end of a motion before its time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: {fault}; {}", self.describe(), fault.advice())]
pub struct MotionEnd {
    /// The last time in s that was reached.
    pub time: f64,
    /// Why.
    pub fault: SolveFault,
    /// The instants before it.
    pub history: History,
}

impl MotionEnd {
    /// `time 0.25 s`, for messages.
    pub fn describe(&self) -> String {
        format!("time {} s", self.time)
    }
}

/// One way to take a step.
pub(super) trait Stepper {
    /// Makes ready for the supports that hold after a time.
    fn prepare(&mut self, motion: &Motion, held: &[bool]) -> Result<(), SolveFault>;

    /// The longest step in s that is safe at a state; nothing where any is.
    fn longest(&mut self, motion: &Motion, moving: &Moving) -> Result<Option<f64>, SolveFault>;

    /// The state a step later. `held` are the unknowns that supports hold in the step.
    fn step(
        &mut self,
        motion: &Motion,
        before: &Moving,
        step: f64,
        held: &[bool],
    ) -> Result<Moving, SolveFault>;

    /// Whether an exact step would not change the sum of the energies; otherwise it may lose some.
    fn conserves(&self) -> bool;

    /// Factorisations so far.
    fn factorisations(&self) -> usize;
}

/// Steps that are taken before the longest stable one is looked at again.
const RUN: usize = 64;

/// Runs after which a step may grow, the first time.
const PATIENCE: usize = 8;

/// Share of the largest energy that a motion may gain from nowhere, or lose to nowhere, since it started or was last
/// halved, before it counts as exploding.
const ASTRAY: f64 = 0.05;

/// The shortest step, as a share of the first.
const SHORTEST: f64 = 1.0 / 4096.0;

/// Computes a motion from time 0 to its end.
///
/// # Errors
/// [`MotionEnd`] with the time beyond which no step is stable, and the instants before it.
pub fn follow(
    motion: &Motion,
    settings: TimeSettings,
    progress: &dyn Fn(f64),
) -> Result<History, MotionEnd> {
    let mut history = History::default();
    let outcome = march(motion, settings, &mut history, progress);
    outcome.map_err(|fault| MotionEnd {
        time: history.instants.last().map_or(0.0, |last| last.time),
        fault,
        history: history.clone(),
    })?;
    Ok(history)
}

fn march(
    motion: &Motion,
    settings: TimeSettings,
    history: &mut History,
    progress: &dyn Fn(f64),
) -> Result<(), SolveFault> {
    let mut moving = motion.begin()?;
    history.instants.push(motion.instant(&moving));
    let mut stepper: Box<dyn Stepper> = match settings.integrator {
        Integrator::VelocityVerlet => Box::new(Central::default()),
        Integrator::GeneralisedAlpha {
            spectral_radius,
            tolerance,
        } => Box::new(Implicit::new(spectral_radius, tolerance)),
    };
    let mut held = motion.held(0.0);
    stepper.prepare(motion, &held)?;
    let mut pace = Pace {
        wanted: match settings.step {
            Step::Automatic => f64::INFINITY,
            Step::AtMost(step) => step,
        },
        automatic: settings.step == Step::Automatic,
        current: f64::INFINITY,
        runs: 0,
        patience: PATIENCE,
        grown: false,
        total: moving.energy.total(),
    };
    for (end, is_instant) in stops(motion, settings) {
        let now = motion.held(moving.time);
        if now != held {
            held = now;
            stepper.prepare(motion, &held)?;
            motion.accelerate(&mut moving, &held)?;
        }
        motion.enter(&mut moving);
        moving = pace.reach(motion, &mut *stepper, moving, end, &held, history)?;
        if is_instant {
            history.instants.push(motion.instant(&moving));
            progress(end);
        }
        history.factorisations = stepper.factorisations();
    }
    Ok(())
}

/// Where runs of steps end: at instants, kinks and releases; and whether it is an instant.
fn stops(motion: &Motion, settings: TimeSettings) -> Vec<(f64, bool)> {
    let TimeSettings {
        duration, interval, ..
    } = settings;
    let count = (duration / interval * (1.0 - 1e-12)).ceil().max(1.0) as usize;
    let instants = (1..=count).map(|i| (i as f64 * interval).min(duration));
    let mut stops: Vec<(f64, bool)> = instants.map(|time| (time, true)).collect();
    for mark in motion.marks(duration) {
        let near = |time: f64| (time - mark).abs() < 1e-9 * interval;
        match stops.iter_mut().find(|(time, _)| near(*time)) {
            // The instant moves to the mark, by a rounding error.
            Some(stop) => stop.0 = mark,
            None => stops.push((mark, false)),
        }
    }
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    stops
}

/// The length of steps.
struct Pace {
    /// The longest that the settings allow.
    wanted: f64,
    automatic: bool,
    /// The one in use.
    current: f64,
    /// Runs since it was last changed.
    runs: usize,
    /// Runs after which it may grow: twice as many after each growth that was too much.
    patience: usize,
    /// Whether it has grown since it was last halved.
    grown: bool,
    /// The sum of the energies that gains are counted from, in mJ.
    total: f64,
}

impl Pace {
    /// Takes equal steps to a time.
    fn reach(
        &mut self,
        motion: &Motion,
        stepper: &mut dyn Stepper,
        mut moving: Moving,
        end: f64,
        held: &[bool],
        history: &mut History,
    ) -> Result<Moving, SolveFault> {
        while end - moving.time > 1e-9 * (end - moving.time).max(end) {
            let rest = end - moving.time;
            let longest = self.allowed(motion, stepper, &moving)?.min(rest);
            let count = (rest / longest * (1.0 - 1e-9)).ceil().max(1.0);
            let step = rest / count;
            let run = (count as usize).min(RUN);
            match self.take(motion, stepper, &moving, (step, run), held) {
                Ok(next) => {
                    history.steps += run;
                    moving = next;
                    if run == count as usize {
                        moving.time = end;
                    }
                    self.runs += 1;
                }
                Err(fault) => {
                    history.halved += run;
                    self.current = 0.5 * step;
                    self.runs = 0;
                    if std::mem::take(&mut self.grown) {
                        self.patience *= 2;
                    }
                    self.total = moving.energy.total();
                    let shortest = SHORTEST * self.wanted.min(rest);
                    if self.current < shortest {
                        return Err(fault);
                    }
                }
            }
        }
        Ok(moving)
    }

    /// The longest step now: as the settings say, as the integrator says, and as halving has left it. A step that was
    /// halved, or that may be twice as long, is doubled after some runs: equal steps keep the energy.
    fn allowed(
        &mut self,
        motion: &Motion,
        stepper: &mut dyn Stepper,
        moving: &Moving,
    ) -> Result<f64, SolveFault> {
        let mut limit = self.wanted;
        if self.automatic {
            let longest = stepper.longest(motion, moving)?;
            limit = longest.unwrap_or(f64::INFINITY);
        }
        if self.current > limit {
            self.current = limit;
        } else if self.runs >= self.patience && 2.0 * self.current <= limit {
            self.current *= 2.0;
            (self.runs, self.grown) = (0, true);
        }
        Ok(self.current)
    }

    /// A run of equal steps; a fault where the energy goes astray.
    fn take(
        &self,
        motion: &Motion,
        stepper: &mut dyn Stepper,
        start: &Moving,
        (step, count): (f64, usize),
        held: &[bool],
    ) -> Result<Moving, SolveFault> {
        let mut moving = start.clone();
        for _ in 0..count {
            let mut next = stepper.step(motion, &moving, step, held)?;
            motion.account(&moving, &mut next, held);
            if let Some(viscosity) = motion.viscosity {
                let memory = moving
                    .memory
                    .after(motion.energy, viscosity, next.whole(step));
                next.memory = memory.map_err(super::viscosity::inverted(&*motion.describe))?;
            }
            moving = next;
        }
        let gain = moving.energy.total() - self.total;
        let astray = if stepper.conserves() {
            gain.abs()
        } else {
            gain
        };
        let largest = moving.energy.largest().max(start.energy.largest());
        if astray.is_finite() && astray <= ASTRAY * largest {
            return Ok(moving);
        }
        Err(SolveFault::Explodes {
            time: start.time,
            step,
        })
    }
}
