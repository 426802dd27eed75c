//! Possible faults of a recording that hardly increase its misfit: each is one more parameter, tried in one linearised step, and where that is
//! promising, in as many as change it.
//!
//! ```text
//! r = z τ + J δ + noise,   δ of variance P⁻¹           z the derivative of both signals by a suspect, J those by motion and functions, over the noise
//! I = zᵀz − zᵀJ (JᵀJ + P)⁻¹ Jᵀz,   τ = zᵀr / I,   t = τ √I
//! ```
//!
//! An error of the force's zero by a fiftieth of its range changes K(·) by far more than its interval and leaves a misfit of 1.05: the test
//! of one degree of freedom detects it. It also detects features that smooth functions miss: a step of K(·) at rest, and dry friction.

use std::slice;

use nalgebra::DVector;

use super::basis::{Basis, Form};
use super::joint::{Column, Joint, State};
use super::penalty::PenalisedFit;
use super::smoothing::{RESOLUTION, SplineValues, nearest};
use super::types::{FittedMotion, Identification};
use crate::solve::vector::largest;

/// t above which a suspect is reported: by chance in less than one recording of a thousand, with eight tried.
const LIMIT: f64 = 4.0;

/// The share of the residuals in excess of the noise, and of those that another suspect explains, that a suspect has to explain: where forms
/// are wrong, or the noise is not white, any suspect explains a little of it.
const TAKEN: f64 = 0.5;

/// The residuals that may exceed the noise by chance, in standard errors of their sum of squares.
const CHANCE: f64 = 2.0;

/// t of one step above which a suspect's size is found by several steps.
const PROMISING: f64 = 2.0;

/// Steps allowed, and the changes that end them: of a size in its standard errors, and of the squares that it explains as
/// a share of them.
const MOST_STEPS: usize = 12;
const SETTLED: [f64; 2] = [0.1, 0.01];

/// The least share of zᵀz in I: a smaller one is part of K(·), D(·) or the motion.
const LEAST_SHARE: f64 = 1e-6;

/// A mass that is smaller by more than this share of itself is negative, beyond the error of one linearised step.
const TURNED: f64 = 1.5;

/// A possible fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Suspect {
    /// A constant on the force in N.
    ForceZero,
    /// A constant on the extension in mm.
    ExtensionZero,
    /// A force that drifts, in N over the recording.
    ForceDrift,
    /// An extension that drifts, in mm over the recording.
    ExtensionDrift,
    /// A force that is late, in s.
    Lag,
    /// A mass that is larger than stated, in tonne.
    Mass,
    /// A force that is counted in the direction opposite to the extension: a mass that is negative.
    SignOfForce,
    /// A K(·) that steps at rest, in N/mm.
    StepOfK,
    /// A force of constant size against the motion, in N.
    Friction,
}

impl Suspect {
    const ALL: [Self; 8] = [
        Self::ForceZero,
        Self::ExtensionZero,
        Self::ForceDrift,
        Self::ExtensionDrift,
        Self::Lag,
        Self::Mass,
        Self::StepOfK,
        Self::Friction,
    ];

    /// Whether it is the zero of a signal: K(·) x that does not vanish at rest.
    fn is_zero(self) -> bool {
        matches!(self, Self::ForceZero | Self::ExtensionZero)
    }

    /// Whether it belongs to the body rather than to the recording.
    fn is_of_body(self) -> bool {
        matches!(self, Self::StepOfK | Self::Friction)
    }

    /// A description of the suspect with its amount.
    fn words(self, amount: f64, error: f64) -> String {
        let (what, factor, unit) = match self {
            Self::ForceZero => ("a zero error of the force of", 1.0, "N"),
            Self::ExtensionZero => ("a zero error of the extension of", 1.0, "mm"),
            Self::ForceDrift => ("a force that drifts by", 1.0, "N over the recording"),
            Self::ExtensionDrift => ("an extension that drifts by", 1.0, "mm over the recording"),
            Self::Lag => ("a force that is recorded", 1e3, "ms later than the motion"),
            Self::Mass if amount < 0.0 => ("a mass that is smaller by", -1e6, "g"),
            Self::Mass => ("a mass that is larger by", 1e6, "g"),
            Self::SignOfForce => return "a force of the wrong sign".to_owned(),
            Self::StepOfK => ("a step of K(·) at rest by", 1.0, "N/mm"),
            Self::Friction => ("a dry friction of", 1.0, "N"),
        };
        let error = f64::abs(factor) * error;
        format!("{what} {:.3} ± {error:.3} {unit}", factor * amount)
    }
}

/// A suspect with its size.
#[derive(Clone, Copy, Debug)]
pub struct Suspected {
    suspect: Suspect,
    /// Its size.
    amount: f64,
    /// The standard error of the size; infinite where it is part of the functions or the motion.
    error: f64,
    /// The squares of the residuals that it explains.
    explained: f64,
    /// The largest change of a signal by it, over the largest value of that signal.
    effect: f64,
}

impl Suspected {
    /// The size in standard errors.
    fn size(&self) -> f64 {
        (self.amount / self.error).abs()
    }
}

/// A fit and its recording.
pub struct Examination<'a> {
    pub joint: &'a Joint<'a>,
    pub state: &'a State,
    pub fit: &'a Identification,
    pub penalised: &'a PenalisedFit,
    /// The parts that the noise of the force allows a spline of it.
    pub parts_of_force: usize,
}

impl Examination<'_> {
    /// The derivatives of both signals with respect to a suspect, over the noise.
    fn column(&self, motion: &FittedMotion, suspect: Suspect) -> Column {
        let times = &self.joint.recording.times;
        let noise = self.joint.noise;
        let duration = times[times.len() - 1] - times[0];
        let rates = if suspect == Suspect::Lag {
            self.rates(&motion.force)
        } else {
            Vec::new()
        };
        let of = |i: usize| {
            let (x, v) = (motion.extension[i], motion.rate[i]);
            match suspect {
                Suspect::ForceZero => [0.0, 1.0],
                Suspect::ExtensionZero => [1.0, 0.0],
                Suspect::ForceDrift => [0.0, (times[i] - times[0]) / duration - 0.5],
                Suspect::ExtensionDrift => [(times[i] - times[0]) / duration - 0.5, 0.0],
                Suspect::Lag => [0.0, -rates[i]],
                Suspect::Mass | Suspect::SignOfForce => [0.0, motion.acceleration[i]],
                Suspect::StepOfK => [0.0, 0.5 * x.abs()],
                Suspect::Friction => [0.0, v.signum()],
            }
        };
        let over = |[x, f]: [f64; 2]| [x / noise[0], f / noise[1]];
        (0..times.len()).map(|i| over(of(i))).collect()
    }

    /// The rates of a force, of a spline with as many parts as its noise allows: the noise of rates from instant to instant would make a
    /// lag too small.
    fn rates(&self, force: &[f64]) -> Vec<f64> {
        let times = &self.joint.recording.times;
        let Some((spline, coefficients)) = nearest(times, force, (self.parts_of_force, 1), 3)
        else {
            return vec![0.0; times.len()];
        };
        let rates = SplineValues::new(&spline, times, 1);
        let instants = 0..times.len();
        instants.map(|i| rates.value(i, &coefficients)).collect()
    }

    /// Tries all suspects in one linearised step.
    fn trials(&self) -> Vec<Suspected> {
        let (joint, state) = (self.joint, self.state);
        // A form that is wrong looks like a body of another kind.
        let is_free = |function: &Basis| matches!(function.form, Form::Spline(_));
        let are_free = joint.functions.iter().all(is_free);
        let possible = Suspect::ALL.into_iter().filter(|suspect| match suspect {
            Suspect::Mass => joint.recording.mass > 0.0,
            other => are_free || !other.is_of_body(),
        });
        let tried: Vec<Suspect> = possible.collect();
        let columns: Vec<Column> = tried
            .iter()
            .map(|suspect| self.column(&self.fit.motion, *suspect))
            .collect();
        let Ok(equations) = joint.linearise(state, &columns) else {
            return Vec::new();
        };
        let (reduced, count) = (&equations.reduced, state.functions.len());
        let penalised = self.penalised;
        let gradient = reduced.gradient.rows(0, count) - &penalised.penalty * &state.functions;
        let trial = |(index, suspect): (usize, &Suspect)| {
            let position = count + index;
            let mixed: DVector<f64> = reduced
                .information
                .view((0, position), (count, 1))
                .column(0)
                .into();
            let follow = &penalised.inverse * &mixed;
            let information = reduced.information[(position, position)] - mixed.dot(&follow);
            let square: f64 = columns[index].iter().flatten().map(|z| z * z).sum();
            let score = reduced.gradient[position] - follow.dot(&gradient);
            let is_separate = information > LEAST_SHARE * square;
            let (amount, error) = if is_separate {
                let error = (self.fit.misfit.max(1.0) / information).sqrt();
                (score / information, error)
            } else {
                (0.0, f64::INFINITY)
            };
            Suspected {
                suspect: *suspect,
                amount,
                error,
                explained: score * score / information,
                effect: amount.abs() * self.relative_size(&columns[index]),
            }
        };
        tried.iter().enumerate().map(trial).collect()
    }

    /// A suspect with motion and functions moved until its size no longer changes: where it bends them much, one linearised step from the
    /// bent ones falls short. `None` where the steps do not converge.
    fn settled(&self, suspect: Suspect) -> Option<Suspected> {
        let count = self.state.functions.len();
        let penalty = self.penalised.penalty.clone();
        let penalty = penalty.resize(count + 1, count + 1, 0.0);
        let roughness = |functions: &DVector<f64>| functions.dot(&(&penalty * functions));
        let mut state = self.state.clone();
        let mut functions = state.functions.clone().resize_vertically(count + 1, 0.0);
        let before = self.joint.sum_of_squares(&state) + roughness(&functions);
        let mut last = [f64::INFINITY; 2];
        for _ in 0..MOST_STEPS {
            let column = self.column(&FittedMotion::new(self.joint, &state), suspect);
            let equations = self
                .joint
                .linearise(&state, slice::from_ref(&column))
                .ok()?;
            let (information, gradient) =
                (&equations.reduced.information, &equations.reduced.gradient);
            let inverse = (information + &penalty).cholesky()?.inverse();
            // The step of the functions, and the whole size of the suspect.
            let step = &inverse * (gradient - &penalty * &functions);
            let change = step.dot(&(information * &step)) - 2.0 * step.dot(gradient);
            let squares = equations.reduced.sum + change;
            let motion = equations.motion_step(&step);
            state
                .motion
                .iter_mut()
                .zip(&motion)
                .for_each(|(c, step)| *c += step);
            state.functions += step.rows(0, count);
            functions.rows_mut(0, count).copy_from(&state.functions);
            let amount = step[count];
            let explained = before - squares - roughness(&functions);
            let misfit = (squares / self.fit.freedom).max(1.0);
            let error = (misfit * inverse[(count, count)]).sqrt();
            let changes = [
                (amount - last[0]).abs() / error,
                ((explained - last[1]) / explained).abs(),
            ];
            if changes[0] < SETTLED[0] && changes[1] < SETTLED[1] {
                return Some(Suspected {
                    suspect,
                    amount,
                    error,
                    explained,
                    effect: amount.abs() * self.relative_size(&column),
                });
            }
            last = [amount, explained];
        }
        None
    }

    /// The largest change of a signal by one unit of a suspect, over the largest value of that signal.
    fn relative_size(&self, column: &Column) -> f64 {
        let joint = self.joint;
        let signals = [&joint.recording.extension, &joint.recording.force];
        let of_signal = |index: usize| {
            let most = column.iter().map(|of| of[index].abs()).fold(0.0, f64::max);
            most * joint.noise[index] / largest(signals[index])
        };
        of_signal(0).max(of_signal(1))
    }

    /// The suspects that are surely present in the recording, the one that explains most of it first.
    pub fn suspects(&self) -> Vec<Suspected> {
        let fit = self.fit;
        let by_chance = CHANCE * (2.0 * fit.freedom).sqrt();
        let excess = ((fit.misfit - 1.0) * fit.freedom - by_chance).max(0.0);
        let mut found = self.trials();
        found.retain(|trial| trial.size() > PROMISING);
        for trial in &mut found {
            if let Some(settled) = self.settled(trial.suspect) {
                *trial = settled;
            }
        }
        let is_significant = |found: &Suspected| {
            // Friction never drives a motion.
            let is_possible = found.suspect != Suspect::Friction || found.amount > 0.0;
            is_possible && found.size() > LIMIT && found.effect > RESOLUTION
        };
        let significant = found.iter().filter(|found| is_significant(found));
        let most = significant.fold(excess, |most, found| most.max(found.explained));
        let is_sure = |found: &Suspected| is_significant(found) && found.explained > TAKEN * most;
        // A zero error of either signal bends the functions as one of the other does.
        let is_sure_zero = |found: &Suspected| found.suspect.is_zero() && is_sure(found);
        let has_zero = found.iter().any(is_sure_zero);
        found.retain(|found| is_sure(found) || has_zero && found.suspect.is_zero());
        // No mass is negative: one that seems to be is that of a force with the other sign.
        for suspected in &mut found {
            let least = -TURNED * self.joint.recording.mass;
            if suspected.suspect == Suspect::Mass && suspected.amount < least {
                suspected.suspect = Suspect::SignOfForce;
            }
        }
        found.sort_by(|a, b| b.explained.total_cmp(&a.explained));
        found
    }
}

/// The reason why suspects make a recording doubtful, with a remedy.
pub fn description(suspects: &[Suspected]) -> Option<String> {
    let descriptions = suspects
        .iter()
        .map(|suspected| suspected.suspect.words(suspected.amount, suspected.error));
    let words: Vec<String> = descriptions.collect();
    let zeros = suspects.iter().filter(|one| one.suspect.is_zero());
    let remedy = if zeros.count() > 1 {
        "look up at the machine which zero is off, which the recording does not tell, and correct it in the data first, because no interval includes it"
    } else if suspects.first()?.suspect.is_of_body() {
        "smooth functions cannot follow it, and no interval or band includes it"
    } else {
        "correct this in the data first, because no interval includes it"
    };
    Some(format!(
        "the recording indicates {}: {remedy}",
        words.join(", or alternatively ")
    ))
}
