//! Equilibria along a path of load factors.

use super::convergence::NewtonSettings;
use super::ending::diagnose;
use super::journal::{Attendance, Journal, Milestone};
use super::loading::{Loading, Stage, State};
use super::newton::Newton;
use super::potential::Potential;
use super::tangent::Tangent;
use super::vector::{difference, norm};
use crate::error::SolveFault;

/// The end of a path before its last load factor.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: {fault}; {}", self.describe(), fault.advice())]
#[non_exhaustive]
pub struct PathEnd {
    /// The load factor that could not be reached.
    pub factor: f64,
    /// The fault there.
    pub fault: SolveFault,
    /// The equilibria at the load factors before it.
    pub states: Vec<State>,
    /// The last intermediate equilibrium after them; `None` where none was found.
    pub last: Option<Box<State>>,
}

impl PathEnd {
    /// The last load factor with an equilibrium; zero where there is none.
    pub fn reached(&self) -> f64 {
        let last = self.last.as_deref().or(self.states.last());
        last.map_or(0.0, |state| state.factor)
    }

    /// `load factor 0.75 (reached 0.6183)`, for messages.
    pub fn describe(&self) -> String {
        format!(
            "load factor {} (reached {:.4})",
            self.factor,
            self.reached()
        )
    }
}

/// The shortest step, as a share of the load factor that it leads to; the resolution of a path's end.
const SHORTEST: f64 = 1.0 / 1024.0;

/// The shortest step from or to rest, as a share of the load factor that is wanted or left.
const SHORTEST_FROM_REST: f64 = 1.0 / 1_048_576.0;

/// Tolerances from which on an equilibrium is a first guess, on any branch; a guess that needs steps shorter than twice such a share of the way is
/// given up.
const FIRST_GUESS_TOLERANCE: f64 = 1e-2;
const SHORTEST_GUESS: f64 = 1.0 / 4.0;

/// Most iterations of an easy step.
const EASY: usize = 6;

/// Solves all load factors, one after the other. One that cannot be reached from the one before in a single step is
/// approached by shorter steps: halved where they fail, doubled after easy ones. Load factors that a journal has kept
/// are not solved again.
///
/// The memory of a body changes only at the given load factors: between them the body has the history of
/// the one before, and results do not depend on the intermediate steps.
///
/// # Errors
/// [`PathEnd`] with the load factor at which no equilibrium was found and the states before it.
pub fn follow(
    loading: &dyn Loading,
    factors: &[f64],
    settings: NewtonSettings,
    attendance: Attendance,
) -> Result<Vec<State>, PathEnd> {
    let Some(&first) = factors.first() else {
        return Ok(Vec::new());
    };
    let kept = attendance.journal.map_or_else(Vec::new, Journal::begin);
    let mut path = Path::new(loading, settings, first).map_err(|fault| PathEnd {
        factor: first,
        fault,
        states: Vec::new(),
        last: None,
    })?;
    if let Some(last) = kept.last() {
        path.step = last.step;
    }
    let mut states: Vec<State> = kept.into_iter().map(|kept| kept.state).collect();
    states
        .iter()
        .for_each(|state| (attendance.reached)(state.factor));
    for &factor in &factors[states.len()..] {
        match path.reach(states.last(), factor, attendance.on_the_way) {
            Ok(state) => {
                if let Some(journal) = attendance.journal {
                    journal.keep(Milestone {
                        state: state.clone(),
                        step: path.step,
                    });
                }
                states.push(state);
            }
            Err((fault, last)) => {
                return Err(PathEnd {
                    factor,
                    fault,
                    states,
                    last,
                });
            }
        }
        (attendance.reached)(factor);
    }
    Ok(states)
}

/// The equilibrium at a stage with the potential there, from a guess on which held unknowns are imposed.
///
/// # Errors
/// As [`Newton::solve`].
pub fn equilibrium(
    loading: &dyn Loading,
    potential: &dyn Potential,
    stage: Stage<'_>,
    newton: &mut Newton,
    mut displacement: Vec<f64>,
    settings: NewtonSettings,
) -> Result<State, SolveFault> {
    loading.impose(stage.factor, &mut displacement);
    let mut residual = vec![0.0; displacement.len()];
    let convergence = newton.solve(
        potential,
        &mut displacement,
        &mut residual,
        settings,
        &|element| loading.describe(element),
    )?;
    loading.impose(stage.factor, &mut displacement);
    Ok(stage.reached(displacement, residual, convergence))
}

/// The change of an equilibrium at load factor 1, without a history, by its transposed tangent under small forces on free
/// unknowns, while held ones rest: the influence of a disturbance of the field on the forces' displacement, and, where the
/// tangent is symmetric, the sensitivity of the field to the forces.
///
/// # Errors
/// A [`SolveFault`] when the tangent is not positive definite.
pub fn compliance(
    tangent: &mut Tangent,
    loading: &dyn Loading,
    displacement: &[f64],
    forces: &[f64],
) -> Result<Vec<f64>, SolveFault> {
    let potential = loading.potential(1.0, &[]);
    let describe = |element| loading.describe(element);
    tangent.respond(&*potential, displacement, forces, &describe)
}

/// An equilibrium at the end of a step.
struct StepEnd {
    state: State,
    /// Whether it is farther from its first guess than the guess is from the state before: the body has snapped to another branch.
    is_far: bool,
    /// Whether it is not far, and all tangents of the step were positive definite: otherwise there are other branches.
    is_sure: bool,
}

struct Path<'a> {
    loading: &'a dyn Loading,
    settings: NewtonSettings,
    newton: Newton,
    /// The longest step of the load factor that is tried.
    step: f64,
}

impl<'a> Path<'a> {
    /// Begins at rest; the pattern is that of one load factor.
    fn new(
        loading: &'a dyn Loading,
        settings: NewtonSettings,
        factor: f64,
    ) -> Result<Self, SolveFault> {
        let (potential, solver) = (loading.potential(factor, &[]), loading.linear_solver());
        let newton = Newton::with_solver(&*potential, &loading.held(), solver)?;
        Ok(Self {
            loading,
            settings,
            newton,
            step: f64::INFINITY,
        })
    }

    /// Solves one load factor from the state before it, through intermediate ones where needed, which are reported; a
    /// fault is returned with the last of these.
    fn reach(
        &mut self,
        from: Option<&State>,
        factor: f64,
        on_the_way: &dyn Fn(f64),
    ) -> Result<State, (SolveFault, Option<Box<State>>)> {
        let begin = from.map_or(0.0, |state| state.factor);
        let at_rest = SHORTEST_FROM_REST * factor.abs().max(begin.abs());
        let history = from.map_or_else(Vec::new, |state| self.loading.remembered(state));
        let (mut last, mut load_steps, mut halved) = (None::<Box<State>>, 0, false);
        let mut snaps = 0;
        loop {
            let previous = last.as_deref().or(from);
            let start = previous.map_or(0.0, |state| state.factor);
            let rest = factor - start;
            // A remainder hardly longer than a step is taken with it.
            let step = self.step.min(self.loading.longest_step(factor));
            let target = if rest.abs() <= 1.001 * step {
                factor
            } else {
                start + step.copysign(rest)
            };
            let least = if self.is_guess() {
                SHORTEST_GUESS * (factor - begin).abs()
            } else {
                SHORTEST * target.abs()
            };
            let shortest = 0.5 * (target - start).abs() <= at_rest.max(least);
            // A step that would be halved after a shift anyway is given up at the shift.
            self.newton.shifts = shortest || self.is_rough();
            let solution = match self.solve_at(previous, target, &history) {
                Ok(solution) if solution.is_sure || shortest => solution,
                Err(fault) if shortest && self.is_guess() => return Err((fault, last)),
                Err(fault) if shortest => {
                    let stage = Stage {
                        factor: target,
                        history: &history,
                    };
                    let newton = &mut self.newton;
                    let fault = diagnose(newton, self.loading, previous, stage, fault);
                    return Err((fault, last));
                }
                _ => {
                    self.step = 0.5 * (target - start).abs();
                    halved = true;
                    continue;
                }
            };
            load_steps += 1;
            snaps += usize::from(solution.is_far);
            let mut state = solution.state;
            state.load_steps = load_steps;
            state.convergence.snaps = snaps;
            let log = &state.convergence;
            let easy = log.iterations() <= EASY && log.cut_steps + log.shifted_steps == 0;
            if easy && !halved {
                self.step *= 2.0;
            }
            halved = false;
            if target == factor {
                return Ok(state);
            }
            on_the_way(target);
            last = Some(Box::new(state));
        }
    }

    /// Whether only a first guess is wanted: the reason of a failure is then not needed.
    fn is_guess(&self) -> bool {
        self.settings.tolerance >= FIRST_GUESS_TOLERANCE
    }

    /// Whether an equilibrium of any branch will do.
    fn is_rough(&self) -> bool {
        self.is_guess() || !self.loading.follows_its_branch()
    }

    fn solve_at(
        &mut self,
        previous: Option<&State>,
        factor: f64,
        history: &[f64],
    ) -> Result<StepEnd, SolveFault> {
        let potential = self.loading.potential(factor, history);
        let mut guess = match self.loading.guess(factor, previous) {
            Some(guess) => guess,
            None => self.predict(previous, factor, &*potential)?,
        };
        let state = equilibrium(
            self.loading,
            &*potential,
            Stage { factor, history },
            &mut self.newton,
            guess.clone(),
            self.settings,
        )?;
        self.loading.impose(factor, &mut guess);
        let correction = norm(&difference(&state.displacement, &guess));
        let step = match previous {
            Some(previous) => norm(&difference(&guess, &previous.displacement)),
            None => norm(&guess),
        };
        let rough = self.is_rough();
        let is_far = !rough && correction > step;
        Ok(StepEnd {
            is_far,
            is_sure: rough || !is_far && state.convergence.shifted_steps == 0,
            state,
        })
    }

    /// The linear prediction: the tangent at the state before, for the change of supports and loads.
    fn predict(
        &mut self,
        previous: Option<&State>,
        factor: f64,
        potential: &dyn Potential,
    ) -> Result<Vec<f64>, SolveFault> {
        let mut start = match previous {
            Some(previous) => previous.displacement.clone(),
            None => vec![0.0; potential.unknowns()],
        };
        let mut target = start.clone();
        self.loading.impose(factor, &mut target);
        let motion = difference(&target, &start);
        let describe = |element| self.loading.describe(element);
        let tangent = &mut self.newton.tangent;
        let step = tangent.predict(potential, &start, &motion, &describe)?;
        for ((u, motion), step) in start.iter_mut().zip(motion).zip(step) {
            *u += motion + step;
        }
        Ok(start)
    }
}

#[cfg(test)]
mod tests;
