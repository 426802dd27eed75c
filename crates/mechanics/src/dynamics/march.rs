//! Steps from instant to instant, halved where they become unstable.

use super::central::Central;
use super::history::{EnergyBalance, History};
use super::implicit::Implicit;
use super::motion::Motion;
use super::state::{BodyState, Stepper};
use crate::error::SolveFault;

/// The integrator of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Velocity Verlet, which is the method of central differences; viscous forces are taken at the end of a step.
    VelocityVerlet,
    /// Generalised-α of Chung and Hulbert.
    GeneralisedAlpha {
        /// ρ∞, the share of the fastest motions that remains after a step: 1 is Newmark's average acceleration, 0 damps them at once.
        spectral_radius: f64,
        /// Largest residual of a free unknown relative to the largest force.
        tolerance: f64,
    },
}

/// The length of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Half of the longest stable step for Verlet, computed from the stiffness repeatedly; a hundredth of the slowest
    /// period for generalised-α, or of a shorter period of oscillating supports or forces.
    Automatic,
    /// The longest step in s.
    AtMost(f64),
}

/// The settings of a time integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSettings {
    /// The end in s.
    pub duration: f64,
    /// The time between instants in s; the last instant is the end.
    pub interval: f64,
    /// The length of a step.
    pub step: Step,
    /// The integrator.
    pub integrator: Integrator,
    /// The number of steps allowed.
    pub most_steps: f64,
}

/// The end of a motion before its time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: {fault}; {}", self.describe(), fault.advice())]
#[non_exhaustive]
pub struct MotionEnd {
    /// The last time in s that was reached.
    pub time: f64,
    /// The fault.
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

/// Steps that are taken before the longest stable one is checked again.
const RUN: usize = 64;

/// Runs after which a step may grow, the first time.
const RUNS_BEFORE_GROWTH: usize = 8;

/// Share of the largest energy that a motion may gain or lose without work, since it started or was last halved, before it counts as unstable.
const LARGEST_ENERGY_ERROR: f64 = 0.05;

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
    let mut march = March::new(motion, settings);
    let outcome = march.run(progress);
    let history = march.history;
    match outcome {
        Ok(()) => Ok(history),
        Err(fault) => Err(MotionEnd {
            time: history.instants.last().map_or(0.0, |last| last.time),
            fault,
            history,
        }),
    }
}

/// The state of a time integration.
struct March<'a> {
    motion: &'a Motion<'a>,
    stepper: Box<dyn Stepper>,
    /// The unknowns that supports hold now.
    held: Vec<bool>,
    pace: Pace,
    history: History,
    settings: TimeSettings,
}

/// Where a run of steps ends.
struct Stop {
    /// The time in s.
    time: f64,
    /// Whether it is an instant.
    is_instant: bool,
}

/// Where runs of steps end: at instants, kinks and releases.
fn stops(motion: &Motion, settings: TimeSettings) -> Vec<Stop> {
    let TimeSettings {
        duration, interval, ..
    } = settings;
    let count = (duration / interval * (1.0 - 1e-12)).ceil().max(1.0) as usize;
    let instants = (1..=count).map(|i| Stop {
        time: (i as f64 * interval).min(duration),
        is_instant: true,
    });
    let mut stops: Vec<Stop> = instants.collect();
    for mark in motion.marks(duration) {
        let near = |stop: &&mut Stop| (stop.time - mark).abs() < 1e-9 * interval;
        match stops.iter_mut().find(near) {
            // The instant moves to the mark, by a rounding error.
            Some(stop) => stop.time = mark,
            None => stops.push(Stop {
                time: mark,
                is_instant: false,
            }),
        }
    }
    stops.sort_by(|a, b| a.time.total_cmp(&b.time));
    stops
}

/// The reliability of a step's energies.
#[derive(Clone, Copy)]
enum Trust {
    /// All of them must balance.
    AllEnergies,
    /// The work of viscous forces that decay faster than the step may be too large: without it, an exact motion gains
    /// only the energy that relaxing stresses give back.
    ViscousWorkTooLarge,
}

/// The length of steps.
struct Pace {
    /// The longest that the settings allow; infinite where it is automatic.
    wanted: f64,
    /// The length in use.
    current: f64,
    /// Runs since it was last changed.
    runs: usize,
    /// Runs after which it may grow: twice as many after each growth that was too much.
    patience: usize,
    /// Whether it has grown since it was last halved.
    grown: bool,
    /// The energies relative to which gains are counted.
    from: EnergyBalance,
}

impl Pace {
    fn new(step: Step) -> Self {
        Self {
            wanted: match step {
                Step::Automatic => f64::INFINITY,
                Step::AtMost(step) => step,
            },
            current: f64::INFINITY,
            runs: 0,
            patience: RUNS_BEFORE_GROWTH,
            grown: false,
            from: EnergyBalance::default(),
        }
    }

    /// The longest step now: not beyond a limit, and no longer than halving has left it. A step that was halved, or
    /// that may be twice as long, is doubled after some runs: equal steps conserve the energy.
    fn within(&mut self, limit: f64) -> f64 {
        if self.current > limit {
            self.current = limit;
        } else if self.runs >= self.patience && 2.0 * self.current <= limit {
            self.current *= 2.0;
            (self.runs, self.grown) = (0, true);
        }
        self.current
    }

    /// Halves a step that failed from a state with such energies.
    fn halve(&mut self, step: f64, from: EnergyBalance) {
        self.current = 0.5 * step;
        self.runs = 0;
        if std::mem::take(&mut self.grown) {
            self.patience *= 2;
        }
        self.from = from;
    }
}

impl<'a> March<'a> {
    fn new(motion: &'a Motion<'a>, settings: TimeSettings) -> Self {
        Self {
            motion,
            stepper: match settings.integrator {
                Integrator::VelocityVerlet => Box::new(Central::default()),
                Integrator::GeneralisedAlpha {
                    spectral_radius,
                    tolerance,
                } => Box::new(Implicit::new(spectral_radius, tolerance)),
            },
            held: motion.held(0.0),
            pace: Pace::new(settings.step),
            history: History::default(),
            settings,
        }
    }

    fn run(&mut self, progress: &dyn Fn(f64)) -> Result<(), SolveFault> {
        let motion = self.motion;
        let mut at = motion.begin()?;
        self.history.instants.push(motion.instant(&at));
        self.stepper.prepare(motion, &self.held)?;
        // Supports that begin at once to move are met by viscous forces from the first step on.
        motion.enter(&mut at);
        motion.evaluate_viscous(&mut at, 0.0)?;
        motion.accelerate(&mut at, &self.held)?;
        self.pace.from = at.energy;
        for stop in stops(motion, self.settings) {
            let now = motion.held(at.time);
            if now != self.held {
                self.held = now;
                self.stepper.prepare(motion, &self.held)?;
                motion.accelerate(&mut at, &self.held)?;
            }
            motion.enter(&mut at);
            at = self.reach(at, stop.time)?;
            if stop.is_instant {
                self.history.instants.push(motion.instant(&at));
                progress(stop.time);
            }
            self.history.factorisations = self.stepper.factorisations();
        }
        Ok(())
    }

    /// Takes equal steps to a time.
    fn reach(&mut self, mut at: BodyState, end: f64) -> Result<BodyState, SolveFault> {
        while end - at.time > 1e-9 * end {
            let rest = end - at.time;
            let longest = self.longest(&at)?.min(rest);
            let count = (rest / longest * (1.0 - 1e-9)).ceil().max(1.0);
            let step = rest / count;
            let run = (count as usize).min(RUN);
            // After a jerk viscous forces may decay faster than any step.
            let trust = if 0.5 * step < SHORTEST * self.pace.wanted.min(rest) {
                Trust::ViscousWorkTooLarge
            } else {
                Trust::AllEnergies
            };
            match self.take(&at, step, run, trust) {
                Ok(next) => {
                    self.history.steps += run;
                    at = next;
                    if run == count as usize {
                        at.time = end;
                    }
                    self.pace.runs += 1;
                }
                Err(fault) => {
                    self.history.halved += run;
                    self.pace.halve(step, at.energy);
                    if self.pace.current < SHORTEST * self.pace.wanted.min(rest) {
                        return Err(fault);
                    }
                }
            }
        }
        Ok(at)
    }

    /// The longest step now, according to the settings, the integrator and halving.
    fn longest(&mut self, at: &BodyState) -> Result<f64, SolveFault> {
        let limit = if self.pace.wanted.is_finite() {
            self.pace.wanted
        } else {
            let longest = self.stepper.longest(self.motion, at)?;
            longest.unwrap_or(f64::INFINITY)
        };
        self.afford(at.time, limit)?;
        Ok(self.pace.within(limit))
    }

    /// A fault where even the longest steps are too many to the end.
    fn afford(&self, time: f64, longest: f64) -> Result<(), SolveFault> {
        let rest = self.settings.duration - time;
        let needed = self.history.steps as f64 + rest / longest;
        if needed <= self.settings.most_steps {
            Ok(())
        } else {
            Err(SolveFault::TooManySteps {
                needed,
                longest,
                allowed: self.settings.most_steps,
            })
        }
    }

    /// The energy in mJ that steps have gained without work, or lost where they must not.
    fn energy_error(&self, energy: &EnergyBalance, trust: Trust) -> f64 {
        let gain = energy.total() - self.pace.from.total();
        let viscous_work = energy.viscous_work - self.pace.from.viscous_work;
        let created = match trust {
            Trust::AllEnergies => gain,
            Trust::ViscousWorkTooLarge => gain.min(gain - viscous_work),
        };
        if self.stepper.conserves() {
            created.max(-gain)
        } else {
            created
        }
    }

    /// A run of equal steps; a fault where the energy balance is violated.
    fn take(
        &mut self,
        start: &BodyState,
        step: f64,
        count: usize,
        trust: Trust,
    ) -> Result<BodyState, SolveFault> {
        let mut at = start.clone();
        for _ in 0..count {
            let mut next = self.stepper.step(self.motion, &at, step, &self.held)?;
            self.motion.account(&at, &mut next, &self.held, step);
            next.memory = self.motion.memory_after(&at.memory, &next, step)?;
            at = next;
        }
        let energy_error = self.energy_error(&at.energy, trust);
        let largest = at.energy.largest().max(start.energy.largest());
        if energy_error.is_finite() && energy_error <= LARGEST_ENERGY_ERROR * largest {
            return Ok(at);
        }
        Err(SolveFault::Explodes {
            time: start.time,
            step,
        })
    }
}
