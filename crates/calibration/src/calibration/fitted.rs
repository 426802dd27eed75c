//! A law that was fitted to tests.

use std::sync::Arc;

use super::data::{Observation, TestData};
use super::least_squares::{self, LEAST_SIZE, Residuals};
use super::settings::{FitSettings, MEASURE};
use super::softened::Softened;
use super::trust::Quality;
use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::Law;
use crate::material::viscosity::ViscousMaterial;

/// A law fitted to tests.
#[derive(Debug)]
pub struct Fit {
    /// The law's entry in the registry.
    pub law: &'static Law,
    /// The law with its parameters.
    pub fitted: Arc<dyn HyperelasticLaw>,
    /// The parameters, in internal units: those of the law, followed by those of relaxation or softening.
    pub parameters: Vec<Parameter>,
    /// The number of the law's parameters; zero where the law is that of a card.
    pub of_law: usize,
    /// Other entries of a card of the law: key and choice.
    pub choices: Vec<(&'static str, String)>,
    /// The points (λ − 1, nominal stress in MPa) of a law that takes the curve as it is.
    pub curve: Vec<[f64; 2]>,
    /// The stress measure of the data.
    pub stress_measure: StressMeasure,
    /// The fitted stresses at all observations of each test, in the measure of the data, in MPa.
    pub predicted: Vec<Vec<f64>>,
    /// The settings.
    pub settings: FitSettings,
    /// The quality of the fit.
    pub quality: Quality,
    /// The Prony series of a fit to what was measured over time.
    pub relaxed: Option<Relaxed>,
    /// The softening of a fit to loading and unloading.
    pub softened: Option<Softened>,
    /// The parameters and R² for a homogeneous sheet that is free of stress as mounted, where its state at rest was found with the law.
    pub at_rest_as_mounted: Option<(Vec<Parameter>, f64)>,
    /// The mounting of a sheet that was solved with the law.
    pub mounted: Option<MountedFit>,
    /// How well the protocols of a biaxial test determine the law.
    pub protocols: Option<Protocols>,
}

/// The relaxation of a fit.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// The series, and what the data cover.
    pub material: ViscousMaterial,
    /// The numbers of terms that were tried with their AICc.
    pub tried: Vec<(usize, f64)>,
}

/// A sheet that was solved on its mounting with the law.
#[derive(Debug)]
pub struct MountedFit {
    /// The tests as they would be of the homogeneous middle.
    pub(in crate::calibration) tests: Vec<TestData>,
    /// The law's parameters by the homogeneous reading.
    pub homogeneous: Vec<Parameter>,
    /// By how much the stresses of the homogeneous reading deviate at most along both axes, in equibiaxial states up to the largest stretch
    /// that both axes reached, in %.
    pub bias_percent: [f64; 2],
    /// By how much the forces changed at most in the extrapolation from cells and halved cells for the last fit, in % of the largest.
    pub discretisation_percent: f64,
    /// How often the sheet was solved with the law.
    pub rounds: usize,
}

/// How well the protocols of a biaxial test determine a law.
#[derive(Clone, Debug)]
pub struct Protocols {
    /// The root of the mean square of the errors with which each protocol is predicted by the law fitted to the others, in % of the largest
    /// stress of all.
    pub left_out_percent: Vec<f64>,
    /// The protocol that would narrow the widest interval most; `None` where there are no intervals.
    pub further: Option<FurtherProtocol>,
}

/// A protocol that was not measured, with as many rows as those that were.
#[derive(Clone, Copy, Debug)]
pub struct FurtherProtocol {
    /// The largest stretches along both axes.
    pub stretches: [f64; 2],
    /// The parameter whose standard error is the largest share of its value.
    pub key: &'static str,
    /// Its standard error in % of its value, today and with the protocol.
    pub standard_error_percent: [f64; 2],
}

impl Protocols {
    /// The root of the mean square of all errors of prediction in % of the largest stress.
    pub fn all_left_out_percent(&self) -> f64 {
        let squares = self
            .left_out_percent
            .iter()
            .map(|percent| percent * percent);
        (squares.sum::<f64>() / self.left_out_percent.len() as f64).sqrt()
    }
}

impl Fit {
    /// The parameters of the law.
    pub fn law_parameters(&self) -> &[Parameter] {
        &self.parameters[..self.of_law]
    }

    /// The values that were fitted: those of the law, followed by those of the zeros and of the state at rest.
    pub(in crate::calibration) fn values(&self) -> Vec<f64> {
        let of_law = self
            .law_parameters()
            .iter()
            .map(|parameter| parameter.value);
        let of_zeros = self.quality.zeros.iter().map(|zero| zero.value);
        of_law.chain(of_zeros).collect()
    }

    /// The fit; refused where it does not follow the data at all although no bound was stated, which could be the reason.
    ///
    /// # Errors
    /// [`Error::Input`] with the columns, rows and zeros that were read, in which the reason may be.
    pub(in crate::calibration) fn that_follows(self, tests: &[TestData]) -> Result<Self, Error> {
        let quality = &self.quality;
        if quality.follows_data() || !self.settings.bounds.is_empty() {
            return Ok(self);
        }
        let message = format!(
            "{}: the law does not follow the data at all: the mean deviation is {:.0} %, R² {:.2}",
            self.law.name, quality.nmad_percent, quality.r_squared
        );
        let taken = tests.iter().map(|test| {
            let remarks = test.remarks.iter().map(|remark| format!("; {remark}"));
            format!(
                "{}: {}{}",
                test.name,
                test.table.sentence(),
                remarks.collect::<String>()
            )
        });
        let hint = format!(
            "look at columns, rows, signs and zero that were taken, or choose another law; {}",
            taken.collect::<Vec<_>>().join("; ")
        );
        Err(Error::input(message, hint))
    }

    /// The tests as they were fitted: with the zeros that were found together with the law, and where a sheet was solved on its mounting, the
    /// tests of its middle.
    pub fn fitted_tests(&self, tests: &[TestData]) -> Vec<TestData> {
        let tests = self
            .mounted
            .as_ref()
            .map_or(tests, |mounted| &mounted.tests);
        let mut moved = tests.to_vec();
        for zero in &self.quality.zeros {
            for (number, test) in moved.iter_mut().enumerate() {
                *test = zero.applied(number, test);
            }
        }
        moved
    }

    /// Half the widths of the 95 % intervals of the fitted curve at some observations, in MPa; NaN where there are
    /// none because the residuals are not noise.
    pub fn half_widths(&self, data: &TestData, at: &[Observation]) -> Vec<f64> {
        let known = self.known_half_widths(data, at);
        known.unwrap_or_else(|| vec![f64::NAN; at.len()])
    }

    fn known_half_widths(&self, data: &TestData, at: &[Observation]) -> Option<Vec<f64>> {
        let known = self.quality.noise.as_ref();
        let noise = known.filter(|_| self.quality.has_intervals())?;
        // Zeros do not enter the law's curve.
        let fixed = &self.quality.fixed;
        let mut values: Vec<f64> = self.parameters.iter().map(|one| one.value).collect();
        values.resize(fixed.len(), 1.0);
        let least = vec![LEAST_SIZE; values.len()];
        let curve = Curve {
            fit: self,
            data,
            at,
        };
        let gradients = least_squares::jacobian(&curve, &values, fixed, &least)?;
        let estimated: Vec<usize> = (0..fixed.len()).filter(|index| !fixed[*index]).collect();
        let gradients = gradients.select_columns(&estimated);
        let half = |point: usize| noise.half_width(&gradients.row(point).transpose());
        Some((0..at.len()).map(half).collect())
    }
}

/// The stresses of the fitted law at some observations as a function of its parameters.
struct Curve<'a> {
    fit: &'a Fit,
    data: &'a TestData,
    at: &'a [Observation],
}

impl Residuals for Curve<'_> {
    fn count(&self) -> usize {
        self.at.len()
    }

    fn evaluate(&self, parameters: &[f64], stresses: &mut [f64]) -> bool {
        let Fit { law, of_law, .. } = self.fit;
        let measure = self.fit.stress_measure;
        let (law, _) = law.with_values(&parameters[..*of_law], measure, MEASURE);
        for (stress, one) in stresses.iter_mut().zip(self.at) {
            *stress = self.data.stress_of(&*law, one);
        }
        stresses.iter().all(|stress| stress.is_finite())
    }
}
