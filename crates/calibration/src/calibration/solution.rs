//! Values of a model of tests: their weights, their uncertainty, and the resulting fit.
//!
//! ```text
//! rᵢ = (σᵢ − σ(p; λᵢ))/σ(p₀; λᵢ),   p₀ = p at the end
//! ```
//!
//! Weights 1/σᵢ share the noise of the stresses that they weigh. A stress is of the first degree in the parameters that are
//! stresses, σ = Σ p ∂σ/∂p, so that (σᵢ − σ)/σᵢ = 1 − Σ p ∂(σ/σᵢ)/∂p: a constant and the derivatives explain all of it, whatever the
//! noise, so that no test distinguishes noise from a pattern. And stresses that are measured too low weigh more: a noise of s makes stresses too
//! small by 2 s². Fitted stresses as weights have neither; where the residuals are noise, the fit is repeated with them until
//! it no longer changes (quasi-likelihood). Where the residuals are not noise, the values stay those by the weights of the data.
//!
//! # References
//! R. W. M. Wedderburn, Biometrika 61, 439 (1974), doi:10.1093/biomet/61.3.439

use super::data::TestData;
use super::fitted::Fit;
use super::least_squares::{Precision, descend, lower, minimise, sum_of_squares};
use super::regression::{Elastic, Misfit, Response, Rival, Zero, improved};
use super::settings::{FitSettings, MEASURE, Weighting};
use super::trust::{Judged, Quality, warnings};
use crate::error::{Error, SolveFault};
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::Law;
use crate::statistics::Estimate;

/// Values within their bounds, and the residuals that they leave.
pub struct Solution<R> {
    pub misfit: Misfit<R>,
    pub values: Vec<f64>,
    pub bounds: Vec<[f64; 2]>,
}

impl<R: Response> Solution<R> {
    /// The statistics of the residuals.
    pub fn judged(&self) -> Judged {
        Judged::of(&self.misfit, &self.values, &self.bounds)
    }

    /// Refuses values at which the sum of squares still falls.
    pub fn checked(self, law: &Law, parameters: &[Parameter]) -> Result<Self, Error> {
        if lower(&self.misfit, &self.values, &self.bounds).is_none() {
            return Ok(self);
        }
        let keys: Vec<&str> = parameters.iter().map(|parameter| parameter.key).collect();
        Err(Error::Solve {
            model: format!("fit of {}", law.name),
            step: format!("{} = {:.4?}", keys.join(", "), self.values),
            fault: SolveFault::NoMinimum,
        })
    }

    /// The solution with the weights of the fitted stresses; where the residuals are noise, the values are fitted again with them.
    pub fn settled(self) -> Self {
        let reweighed = Self {
            misfit: self.misfit.reweighed(&self.values),
            ..self
        };
        let is_relative = reweighed.misfit.weighting == Weighting::Relative;
        if is_relative && reweighed.judged().is_noise() {
            reweighed.repeated().unwrap_or(reweighed)
        } else {
            reweighed
        }
    }

    /// The values that are the best ones by the weights of the stresses that they give; `None` where this iteration does not converge.
    fn repeated(&self) -> Option<Self> {
        const REPEATS: usize = 20;
        const SAME: f64 = 1e-8;
        let (mut misfit, mut values) = (self.misfit.clone(), self.values.clone());
        for _ in 0..REPEATS {
            values = minimise(&misfit, &values, &self.bounds, Precision::Full)?;
            let before = sum_of_squares(&misfit, &values);
            misfit = misfit.reweighed(&values);
            let now = sum_of_squares(&misfit, &values);
            if (now - before).abs() <= SAME * now {
                return Some(Self {
                    misfit,
                    values,
                    bounds: self.bounds.clone(),
                });
            }
        }
        None
    }

    /// The figures of the fit, without warnings.
    fn quality(&self, predicted: &[Vec<f64>]) -> Quality {
        let response = &self.misfit.response;
        let mut judged = self.judged();
        let tests = response.moved_tests(&self.values);
        let points = predicted.iter().map(Vec::len).sum();
        let square = weighted_square(self.misfit.weighting, &tests, predicted);
        judged.count_gathered(points, square);
        let (mut estimates, correlation) = judged.estimates(&self.values);
        for (index, estimate) in estimates.iter_mut().enumerate() {
            if response.is_logarithmic(index) {
                *estimate = Estimate {
                    value: estimate.value.exp(),
                    standard_error: estimate.value.exp() * estimate.standard_error,
                    interval: estimate.interval.map(f64::exp),
                };
            }
        }
        let law = response.law(&self.values);
        let quality = judged.quality(&*law, &tests, predicted, (estimates, correlation));
        quality.with_zeros(response.zeros())
    }

    /// The fit of a law that has the first of the parameters, with the warnings that all fits have.
    pub fn fit(
        &self,
        law: &'static Law,
        parameters: &[Parameter],
        settings: &FitSettings,
        rival: Option<&Rival>,
    ) -> Fit {
        let response = &self.misfit.response;
        let with_value = |(index, (parameter, value)): (usize, (&Parameter, &f64))| Parameter {
            value: if response.is_logarithmic(index) {
                value.exp()
            } else {
                *value
            },
            ..parameter.clone()
        };
        let pairs = parameters.iter().zip(&self.values).enumerate();
        let mut parameters: Vec<Parameter> = pairs.map(with_value).collect();
        let (_, entries) = law.with_values(&self.values, StressMeasure::Nominal, MEASURE);
        for (parameter, of_law) in parameters.iter_mut().zip(&entries.parameters) {
            if parameter.key == of_law.key {
                parameter.value = of_law.value;
            }
        }
        let predicted = response.predicted(&self.values);
        let mut quality = self.quality(&predicted);
        quality.warnings = warnings(&quality, &parameters, rival);
        Fit {
            law,
            fitted: response.law(&self.values),
            of_law: parameters.len(),
            parameters,
            choices: Vec::new(),
            curve: Vec::new(),
            stress_measure: response.data()[0].stress_measure,
            predicted,
            settings: settings.clone(),
            quality,
            relaxed: None,
            softened: None,
            at_rest_as_mounted: None,
            mounted: None,
            protocols: None,
        }
    }
}

/// Σ (w (σᵢ − σ))² of all observations by the weights of the fitted stresses.
fn weighted_square(weighting: Weighting, tests: &[TestData], predicted: &[Vec<f64>]) -> f64 {
    let of_test = |(data, predicted): (&TestData, &Vec<f64>)| -> f64 {
        let rows = data.observations.iter().zip(predicted);
        rows.map(|(one, fitted)| {
            (weighting.weight_of(data, *fitted) * (one.stress - fitted)).powi(2)
        })
        .sum()
    };
    tests.iter().zip(predicted).map(of_test).sum()
}

/// Zeros of strain or stress that were found at the beginning of a record, and the state at rest of a mounted sheet, found with the law.
///
/// The parabola that follows a beginning back to rest, [`super::data`], sees a few rows; the law sees all of them. Taken as known, the
/// zero that the parabola finds makes the law's parameters wrong by many of their standard errors. So the zero is one more
/// value of the fit, r(p, δ) = σᵢ − σ(p; λᵢ + δ) or σᵢ + δ − σ(p; λᵢ), and its uncertainty is part of the intervals. Where the
/// residuals are then not noise, a shift of the zero would compensate for a misfit of the law: the zero of a record stays.
impl<'a> Solution<Elastic<'a>> {
    /// With the zeros of records among the values, where the residuals are then noise, and with the state at rest where it is sought.
    pub fn with_zeros(self) -> Self {
        self.wider().unwrap_or(self)
    }

    fn wider(&self) -> Option<Self> {
        /// Stretches as mounted from which the search begins.
        const STRETCHES: [f64; 4] = [1.0, 1.02, 1.06, 1.15];
        let misfit = Misfit {
            response: self.misfit.response.with_zeros(),
            ..self.misfit.clone()
        };
        let zeros = misfit.response.zeros().to_vec();
        if zeros.is_empty() {
            return None;
        }
        let is_stretch = |zero: &Zero| matches!(zero, Zero::Stretch { .. });
        let of_record = |zero: &Zero| matches!(zero, Zero::Record { .. });
        let stretches = if zeros.iter().any(is_stretch) {
            &STRETCHES[..]
        } else {
            &STRETCHES[..1]
        };
        let start = |stretch: &f64| {
            let begin = |zero: &Zero| if is_stretch(zero) { *stretch } else { 1.0 };
            [
                &self.values[..],
                &zeros.iter().map(begin).collect::<Vec<_>>(),
            ]
            .concat()
        };
        let bounds = self.bounds.iter().copied();
        let bounds: Vec<[f64; 2]> = bounds
            .chain(zeros.iter().map(|zero| zero.bounds()))
            .collect();
        let mut values = start(&STRETCHES[0]);
        if stretches.len() > 1 {
            let rough = improved(&misfit, stretches.iter().map(start).collect(), &bounds);
            values = rough.into_iter().next()?.1;
        }
        let wider = Solution {
            values: descend(&misfit, &values, &bounds)?,
            misfit,
            bounds,
        };
        let settled = wider.settled();
        (!zeros.iter().any(of_record) || settled.judged().is_noise()).then_some(settled)
    }
}
