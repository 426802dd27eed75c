//! From recorded force and motion to the functions K(·) and D(·) of a spring with a dashpot.
//!
//! ```text
//! m ẍ + D(·) ẋ + K(·) x = f                        x: extension beyond the length at rest, f: tensile force
//! minimise  ‖x̃ − x‖²/s_x² + ‖f̃ − f‖²/s_f² + penalty      over the motion x(t), K(·) and D(·)
//! ```
//!
//! Both signals are data of one motion: a spline of degree 5 over time with exact derivatives, and with as many parts
//! as generalised cross-validation asks for in either signal. No noisy signal is differentiated or put into a
//! regressor, so that noise causes no bias of first order; a regression of f̃ on derivatives of x̃ would
//! underestimate K and D. The residuals of a spline fitted to each signal alone give its noise s_x, s_f.
//!
//! K(·) and D(·) are constants, polynomials, or cubic B-splines with a penalty on the squares of third differences of their coefficients.
//! The weights of the penalty are a tenth of those that minimise generalised cross-validation, so that the intervals are valid; splines may
//! be constrained to rise or to fall. Force and motion must be sampled at the same instants, and their noise must be white.
//!
//! # References
//! H. Mohammadi, W. Wan: A novel numerical corrective technique to mass spring systems, Eq. 2–5;
//! P. H. C. Eilers, B. D. Marx, Stat. Sci. 11, 89 (1996), doi:10.1214/ss/1038425655;
//! P. Craven, G. Wahba, Numer. Math. 31, 377 (1979), doi:10.1007/BF01404567

use crate::error::Error;
use crate::solve::vector::largest;
use crate::statistics::extremes;
use band::reach;
use joint::{Joint, JointEquations, State};
use penalty::PenalisedFit;
use smoothing::{
    FEWEST_IN_MOTION, LONGER, SignalSpline, SplineValues, nearest, smooth, wanted_parts,
};

mod band;
mod basis;
mod corners;
mod joint;
mod law_text;
mod penalty;
mod recording;
mod sample;
mod smoothing;
mod suspects;
mod types;
mod verdict;

pub use band::Function;
pub use basis::{Basis, Form, Shape, UnknownForm};
use corners::{corners, spikes};
pub use joint::Argument;
pub use law_text::law_text;
pub use recording::Recording;
pub use sample::Sample;
use suspects::Examination;
pub use types::{FittedMotion, Identification, IdentificationSettings, RecordingVerdict};
use verdict::{Evidence, notes};

#[cfg(test)]
mod tests;

/// Gauss–Newton steps allowed, and the number of first steps in which the penalties are still chosen.
const MOST_STEPS: usize = 300;
const CHOICES: usize = 6;

/// The iteration ends when the penalised sum of squares falls by less than this, relative to the misfit; a change of one is a standard error.
const SETTLED: f64 = 1e-3;

/// Least noise, relative to the largest value of its signal: the rounding of sums in floating point.
const LEAST_NOISE: f64 = 1e-9;

/// Finds K(·) and D(·); `report` is called with what is being computed.
///
/// # Errors
/// [`Error::Input`] when the recording does not determine them, or when a form cannot take a shape.
pub fn identify(
    recording: &Recording,
    settings: IdentificationSettings,
    report: &dyn Fn(&str),
) -> Result<Identification, Error> {
    for (form, shape) in settings.forms.iter().zip(settings.shapes) {
        if shape != Shape::Free && !matches!(form, Form::Spline(_)) {
            let message = "only splines can be constrained to rise or to fall";
            return Err(Error::input(
                message,
                "leave out the shape, or take the form `spline`",
            ));
        }
    }
    report("noise of force and motion");
    let signals = smooth(&recording.times, &recording.extension, 5)
        .zip(smooth(&recording.times, &recording.force, 3))
        .ok_or_else(|| undetermined("the motion"))?;
    report("the motion");
    let (joint, start) =
        begin(recording, settings, &signals).ok_or_else(|| undetermined("the motion"))?;
    let (fit, solution) = nearest_fit(&joint, start, report)?;
    report("intervals");
    fit.conclude(settings, &solution, &signals)
        .ok_or_else(|| undetermined("K(·) and D(·)"))
}

/// A misfit above this may be that of a wrong minimum; 1 is noise.
const POOR: f64 = 2.0;

/// The fit from the recorded motion. Where it does not converge, or ends far from the data, also from the motion that belongs to polynomials:
/// a noisy motion has accelerations that splines with a weak penalty follow.
fn nearest_fit<'a>(
    joint: &'a Joint,
    start: State,
    report: &dyn Fn(&str),
) -> Result<(Fit<'a>, PenalisedFit), Error> {
    let converged = |start: State| {
        let mut fit = Fit::new(joint, start);
        fit.improve(report).map(|solution| (fit, solution))
    };
    let squares = |(fit, _): &(Fit, PenalisedFit)| joint.sum_of_squares(&fit.state);
    let direct = converged(start.clone());
    let observations = 2.0 * joint.recording.times.len() as f64;
    if matches!(&direct, Ok(pair) if squares(pair) < POOR * observations) {
        return direct;
    }
    let simple = joint.with_polynomials();
    let mut fit = Fit::new(&simple, simple.state(start.motion));
    // Even where it does not converge, its motion is smoother.
    let _ = fit.improve(report);
    match (direct, converged(joint.state(fit.state.motion))) {
        (Ok(one), Ok(other)) => Ok(if squares(&other) < squares(&one) {
            other
        } else {
            one
        }),
        (Err(_), Ok(pair)) | (Ok(pair), Err(_)) => Ok(pair),
        (Err(fault), Err(_)) => Err(fault),
    }
}

fn undetermined(what: &str) -> Error {
    Error::input(
        format!("the recording does not determine {what}"),
        "record a longer motion with several speeds at each extension, without gaps, or take constants or polynomials",
    )
}

/// The motion's spline with the coefficients nearest to the recorded motion.
fn begin<'a>(
    recording: &'a Recording,
    settings: IdentificationSettings,
    (extension, force): &(SignalSpline, SignalSpline),
) -> Option<(Joint<'a>, State)> {
    let times = &recording.times;
    let wanted = wanted_parts(extension, force).min(times.len() / FEWEST_IN_MOTION);
    let mut intervals = wanted;
    let (spline, motion) = loop {
        match nearest(times, &recording.extension, (intervals, LONGER), 5) {
            Some(fitted) => break fitted,
            None if intervals > 1 => intervals -= 1 + intervals / 9,
            None => return None,
        }
    };
    let orders = [0, 1, 2].map(|order| SplineValues::new(&spline, times, order));
    let range = |order: usize| extremes((0..times.len()).map(|i| orders[order].value(i, &motion)));
    let arguments = [
        range(0),
        range(usize::from(settings.argument == Argument::Rate)),
    ];
    let functions = [0, 1].map(|index| Basis {
        form: settings.forms[index],
        shape: settings.shapes[index],
        range: arguments[index],
    });
    let noise = [
        extension
            .noise
            .max(LEAST_NOISE * largest(&recording.extension)),
        force.noise.max(LEAST_NOISE * largest(&recording.force)),
    ];
    let joint = Joint {
        recording,
        runs: spline.runs(),
        is_bridged: LONGER * intervals < wanted,
        orders,
        noise,
        functions,
        argument: settings.argument,
    };
    let state = joint.state(motion);
    Some((joint, state))
}

/// The state of a fit during the iteration.
struct Fit<'a> {
    joint: &'a Joint<'a>,
    state: State,
}

impl<'a> Fit<'a> {
    fn new(joint: &'a Joint<'a>, state: State) -> Self {
        Self { joint, state }
    }

    fn observations(&self) -> f64 {
        2.0 * self.joint.recording.times.len() as f64
    }

    /// Gauss–Newton steps until convergence. The functions are fitted first with the motion fixed.
    fn improve(&mut self, report: &dyn Fn(&str)) -> Result<PenalisedFit, Error> {
        let unknown = || undetermined("K(·) and D(·)");
        let functions = &self.joint.functions;
        let mut exponents = [0.0; 2];
        let fixed = self.joint.with_motion_fixed(&self.state);
        let first = fixed
            .minimum(&self.state.functions, functions, exponents)
            .ok_or_else(unknown)?;
        self.state.functions = first.coefficients;
        let mut merit = f64::INFINITY;
        for step in 0..MOST_STEPS {
            report(&format!("K(·) and D(·), step {}", step + 1));
            let linearised = self
                .joint
                .linearise(&self.state, &[])
                .map_err(|_| unknown())?;
            if step < CHOICES {
                let counts = [self.observations(), self.state.motion.len() as f64];
                let from = &self.state.functions;
                exponents = linearised.reduced.choose(from, functions, counts);
            }
            let solution = linearised
                .reduced
                .minimum(&self.state.functions, functions, exponents)
                .ok_or_else(unknown)?;
            let next = self.advance(&linearised, &solution);
            if step >= CHOICES && merit - next < SETTLED * next / self.observations() {
                return Ok(solution);
            }
            merit = next;
        }
        Err(Error::input(
            "the iteration for K(·) and D(·) does not converge",
            "look at the mass and the length at rest, or take constants or polynomials",
        ))
    }

    /// Halves a step until the penalised sum of squares does not rise, takes it, and returns that sum.
    fn advance(&mut self, linearised: &JointEquations, solution: &PenalisedFit) -> f64 {
        const HALVINGS: i32 = 12;
        let functions = &solution.coefficients - &self.state.functions;
        let motion = linearised.motion_step(&functions);
        let before = self.merit(&self.state, solution);
        let mut length = 1.0;
        for _ in 0..HALVINGS {
            let along = self.state.motion.iter().zip(&motion);
            let next = State {
                motion: along.map(|(c, step)| c + length * step).collect(),
                functions: &self.state.functions + &functions * length,
            };
            let merit = self.merit(&next, solution);
            if merit <= before {
                self.state = next;
                return merit;
            }
            length *= 0.5;
        }
        before
    }

    fn merit(&self, state: &State, solution: &PenalisedFit) -> f64 {
        let penalty = state.functions.dot(&(&solution.penalty * &state.functions));
        self.joint.sum_of_squares(state) + penalty
    }

    fn conclude(
        &self,
        settings: IdentificationSettings,
        solution: &PenalisedFit,
        signals: &(SignalSpline, SignalSpline),
    ) -> Option<Identification> {
        let joint = self.joint;
        let used = self.state.motion.len() as f64 + solution.degrees.iter().sum::<f64>();
        let freedom = self.observations() - used;
        let misfit = joint.sum_of_squares(&self.state) / freedom;
        let mut first = 0;
        let mut functions = [0, 1].map(|index| {
            let basis = joint.functions[index];
            let (start, count) = (first, basis.count());
            first += count;
            Function {
                basis,
                coefficients: self.state.functions.rows(start, count).into_owned(),
                covariance: solution.inverse.view((start, start), (count, count)) * misfit,
                degrees: solution.degrees[index],
                reach: [0.0; 2],
            }
        });
        let reach = reach(&functions, freedom)?;
        functions
            .iter_mut()
            .for_each(|function| function.reach = reach);
        let [stiffness, damping] = functions;
        let identification = Identification {
            settings,
            stiffness,
            damping,
            motion: FittedMotion::new(joint, &self.state),
            noise: joint.noise,
            misfit,
            freedom,
            verdict: RecordingVerdict::default(),
            warnings: Vec::new(),
        };
        Some(self.judged(identification, solution, signals))
    }

    /// The result with its verdict; without intervals where it is not explained.
    fn judged(
        &self,
        mut identification: Identification,
        fit: &PenalisedFit,
        signals: &(SignalSpline, SignalSpline),
    ) -> Identification {
        let joint = self.joint;
        let Recording {
            times,
            extension,
            force,
            ..
        } = joint.recording;
        let spikes = |signal: &[f64]| spikes(times, signal, &joint.runs);
        let corners = corners(times, extension, &joint.runs);
        // A motion with corners has steps of the force.
        let spikes_of_force = if corners.is_none() {
            spikes(force)
        } else {
            Vec::new()
        };
        let spikes = [spikes(extension), spikes_of_force];
        // Where a spline cannot follow the motion, instants of the recording would wrongly seem suspect.
        let is_followed =
            !signals.0.coarse && !signals.1.coarse && corners.is_none() && !joint.is_bridged;
        let suspects = if is_followed && spikes.iter().all(Vec::is_empty) {
            let examination = Examination {
                joint,
                state: &self.state,
                fit: &identification,
                penalised: fit,
                parts_of_force: signals.1.intervals,
            };
            examination.suspects()
        } else {
            Vec::new()
        };
        let evidence = Evidence {
            recording: joint.recording,
            signals,
            spikes,
            is_bridged: joint.is_bridged,
            corners,
            suspects: &suspects,
        };
        identification.verdict = evidence.verdict(&identification);
        identification.warnings = notes(&identification, joint.recording);
        if !identification.is_explained() {
            identification.stiffness.withhold_intervals();
            identification.damping.withhold_intervals();
        }
        identification
    }
}
