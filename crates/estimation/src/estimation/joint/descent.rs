//! The search for the parameters on which all frames agree.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::direction::{Direction, LOOSE, VAGUE, directions, inverse};
use super::estimate::{Step, Watch};
use super::frame::{Frame, State};
use crate::error::{Error, SolveFault};
use crate::estimation::equations::solve;
use crate::estimation::input::RegressedLaw;

/// Steps allowed.
const MOST_STEPS: usize = 40;

/// Steps after which smoothness and noise of the frames are fixed, so that the misfit has a minimum.
const JOINT_VARIANCE_STEPS: usize = 4;

/// The length of a negligible step, in standard errors.
const CLOSE: f64 = 0.02;

/// The largest change of a parameter in one step, relative to its scale, and to the distance to the end of its bound.
const WITHIN: f64 = 0.5;

/// The shortest share of a step.
const SHORTEST: f64 = 1.0 / 64.0;

pub struct Descent<'a> {
    pub frames: Vec<&'a Frame<'a>>,
    pub law: RegressedLaw,
    /// The scale of every parameter, once the determined combinations are known; before, it follows the search.
    scales: Option<Vec<f64>>,
}

/// The state of the search.
#[derive(Clone)]
pub struct Course {
    pub values: Vec<f64>,
    pub states: Vec<State>,
    pub steps: usize,
    /// Why it ended before the least misfit: a frame has no equilibrium at the next values.
    pub ended: Option<String>,
}

impl Course {
    /// A course that begins at these values, without states.
    pub fn of_start(values: Vec<f64>) -> Self {
        Self {
            values,
            states: Vec::new(),
            steps: 0,
            ended: None,
        }
    }

    /// Σ Sₖ.
    pub fn information(&self) -> DMatrix<f64> {
        let count = self.values.len();
        let states = self.states.iter();
        states.fold(DMatrix::zeros(count, count), |sum, state| {
            sum + &state.information
        })
    }

    fn score(&self) -> Step {
        let states = self.states.iter();
        states.fold(DVector::zeros(self.values.len()), |sum, state| {
            sum + &state.score
        })
    }

    /// The length √(δᵀ Σ Sₖ δ) of a step in standard errors.
    fn standard_errors(&self, step: &Step) -> f64 {
        step.dot(&(self.information() * step)).max(0.0).sqrt()
    }

    /// Σ Qₖ.
    pub fn misfit(&self) -> f64 {
        self.states.iter().map(|state| state.misfit).sum()
    }
}

impl<'a> Descent<'a> {
    /// The number of measured forces.
    pub fn measured(&self) -> f64 {
        let measured = self.frames.iter().map(|frame| frame.measured().len());
        measured.sum::<usize>() as f64
    }

    /// The search over frames, with a law that begins at its first values.
    pub fn new(frames: Vec<&'a Frame<'a>>, law: &RegressedLaw) -> Self {
        Self {
            frames,
            law: law.clone(),
            scales: None,
        }
    }

    /// The parameters of the least misfit, and their scales: first of all combinations that the data determine at all, then, where some
    /// are vague, of the others alone, with the vague ones at their first values.
    ///
    /// # Errors
    /// As [`Self::descend`].
    pub fn run(&mut self, watch: Watch) -> Result<(Course, Vec<f64>), Error> {
        self.scale()?;
        let start = self.law.start();
        let first = self.descend(Course::of_start(start.clone()), None, watch);
        let scales = self.scales_at(first.as_ref().map_or(&start, |course| &course.values));
        self.scales = Some(scales.clone());
        let states = match first {
            Ok(course) => {
                let all = directions(&course.information(), &scales);
                if course.ended.is_some() || all.iter().all(Direction::is_determined) {
                    return Ok((course, scales));
                }
                course.states
            }
            Err(_) => Vec::new(),
        };
        let begin = Course {
            states,
            ..Course::of_start(start)
        };
        Ok((self.descend(begin, None, watch)?, scales))
    }

    /// Takes the initial stiffness from the measured forces, where the law can be scaled.
    ///
    /// # Errors
    /// As the search of a frame.
    fn scale(&mut self) -> Result<(), Error> {
        let frames = self.frames.par_iter();
        let of_frames = frames.map(|frame| frame.cross_predict(&self.law, None));
        let predicted = of_frames.collect::<Result<Vec<_>, Error>>()?;
        let forces = self.frames.iter().zip(&predicted);
        let forces = forces.flat_map(|(frame, state)| frame.measured().iter().zip(&state.forces));
        let [product, square] = forces.fold([0.0; 2], |[product, square], (measured, force)| {
            let weight = measured.standard_deviation.powi(-2);
            [
                product + weight * measured.force * force,
                square + weight * force * force,
            ]
        });
        let factor = product / square;
        if factor > 0.0
            && factor.is_finite()
            && let Some(scaled) = self.law.with_stress_times(factor)
        {
            self.law = scaled;
        }
        Ok(())
    }

    /// Descends to the least misfit, with one parameter that may be `held` fixed; from a course with states, smoothness and noise are fixed.
    ///
    /// # Errors
    /// As the search of a frame at the first values; [`SolveFault::Stalled`] when [`MOST_STEPS`] do not reach it.
    pub fn descend(
        &self,
        from: Course,
        held: Option<usize>,
        watch: Watch,
    ) -> Result<Course, Error> {
        let warm = !from.states.is_empty();
        let mut course = self.at(&from, from.values.clone(), warm)?;
        let mut length = f64::NAN;
        for step in 1..=MOST_STEPS {
            let settled = warm || step > JOINT_VARIANCE_STEPS;
            let change = self.step(&course, held);
            length = course.standard_errors(&change);
            watch(&format!(
                "step {step}, change of {length:.1e} standard errors"
            ));
            if length <= CLOSE && settled {
                course.steps = step;
                return Ok(course);
            }
            match self.advance(&course, &change, settled, held) {
                Ok(next) => course = next,
                Err(fault) => {
                    course.steps = step;
                    course.ended = Some(fault.to_string());
                    return Ok(course);
                }
            }
        }
        Err(solve(SolveFault::Stalled {
            iterations: MOST_STEPS,
            residual: length,
            tolerance: CLOSE,
        }))
    }

    /// The values of the least misfit of all frames but `members`, beginning with those of all frames; `None` where no force remains.
    ///
    /// # Errors
    /// As [`Self::descend`].
    pub fn without_frames(
        &self,
        course: &Course,
        members: &Range<usize>,
        watch: Watch,
    ) -> Result<Option<Vec<f64>>, Error> {
        let others = || (0..self.frames.len()).filter(|index| !members.contains(index));
        let rest = Descent {
            frames: others().map(|index| self.frames[index]).collect(),
            law: self.law.clone(),
            scales: self.scales.clone(),
        };
        if rest.frames.iter().all(|frame| frame.measured().is_empty()) {
            return Ok(None);
        }
        let from = Course {
            values: course.values.clone(),
            states: others().map(|index| course.states[index].clone()).collect(),
            ..Course::of_start(Vec::new())
        };
        Ok(Some(rest.descend(from, None, watch)?.values))
    }

    /// The states of all frames at other values.
    fn at(&self, course: &Course, values: Vec<f64>, settled: bool) -> Result<Course, Error> {
        let law = self.law.beginning_at(&values);
        let frames = self.frames.par_iter().enumerate();
        let states = frames.map(|(index, frame)| frame.at(&law, course.states.get(index), settled));
        Ok(Course {
            values,
            states: states.collect::<Result<Vec<State>, Error>>()?,
            steps: course.steps,
            ended: None,
        })
    }

    /// The step to the least misfit of the linearised frames, over the combinations that they determine. A parameter at the end of its bound
    /// that would leave it is held.
    fn step(&self, course: &Course, held: Option<usize>) -> Step {
        let mut held: Vec<usize> = held.into_iter().collect();
        loop {
            let mut step = self.step_without(course, &held);
            let most = self.largest_changes(&course.values, &step);
            let at_end = |index: &usize| step[*index] != 0.0 && most[*index] <= 0.0;
            if let Some(index) = (0..most.len()).find(at_end) {
                held.push(index);
                continue;
            }
            let share = step.iter().zip(&most).map(|(step, most)| step.abs() / most);
            step /= share.fold(1.0, f64::max);
            return step;
        }
    }

    /// The whole step, with some parameters held.
    fn step_without(&self, course: &Course, held: &[usize]) -> Step {
        let mut information = course.information();
        let mut score = course.score();
        for held in held {
            information.row_mut(*held).fill(0.0);
            information.column_mut(*held).fill(0.0);
            score[*held] = 0.0;
        }
        let (scales, limit) = match &self.scales {
            None => (self.scales_at(&course.values), LOOSE),
            Some(scales) => (scales.clone(), VAGUE),
        };
        let mut step = inverse(&directions(&information, &scales), &scales, limit) * score;
        held.iter().for_each(|held| step[*held] = 0.0);
        step
    }

    /// The largest change of each parameter in a step; from the end of its bound, of one that leads inside.
    fn largest_changes(&self, values: &[f64], step: &Step) -> Vec<f64> {
        let scales = self.scales_at(values);
        let parameters = self.law.parameters().iter().zip(values).zip(scales);
        let most = parameters
            .zip(step.iter())
            .map(|(((parameter, value), scale), step)| {
                let [low, high] = parameter.bound.ends();
                let (below, above) = (value - low, high - value);
                let nearest = below.min(above);
                let ahead = if *step > 0.0 { above } else { below };
                WITHIN * scale.min(if nearest > 0.0 { nearest } else { ahead })
            });
        most.collect()
    }

    /// The scale of every parameter: the larger of its value and its first value.
    fn scales_at(&self, values: &[f64]) -> Vec<f64> {
        let first = self.law.start();
        let pairs = values.iter().zip(&first);
        pairs
            .map(|(value, first)| value.abs().max(first.abs()))
            .collect()
    }

    /// Takes the largest share of the step at which all frames have an equilibrium and, once smoothness and noise are fixed, the misfit
    /// or the next step becomes smaller. Where the model leaves large residuals, steps of the linearised frames end where the score
    /// vanishes, which is close to the least misfit but not at it: near it the misfit rises although steps become shorter.
    fn advance(
        &self,
        course: &Course,
        change: &Step,
        settled: bool,
        held: Option<usize>,
    ) -> Result<Course, Error> {
        // The part of the misfit that is due to rounding and to the searches of the frames.
        const ROUGH: f64 = 1e-3;
        let length = course.standard_errors(change);
        let mut share = 1.0;
        loop {
            let pairs = course.values.iter().zip(change.iter());
            let values = pairs
                .map(|(value, change)| value + share * change)
                .collect();
            let next = self.at(course, values, settled);
            let worse = |next: &Course| {
                settled
                    && next.misfit() > course.misfit() + ROUGH
                    && next.standard_errors(&self.step(next, held)) >= length
            };
            match next {
                Ok(next) if !worse(&next) || share <= SHORTEST => return Ok(next),
                Err(fault) if share <= SHORTEST => return Err(fault),
                _ => share *= 0.5,
            }
        }
    }
}
