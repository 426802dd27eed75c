//! The parameters with which a law comes nearest to some tests.
//!
//! ```text
//! min Σᵢ (wᵢ (σᵢ − σ(p; λᵢ)))²,   w = 1 (absolute)   or   w = 1/max(|σᵢ|, 1 % of the test's largest) (relative)
//! ```
//!
//! σ is the stress that the test measured, nominal or Cauchy. Where the relative residuals are noise, the weights are
//! those of the fitted stresses instead of the measured ones. Energies are linear in their parameters with the
//! dimension of a stress; given the others, these follow by linear least squares. Starts are drawn for the others
//! alone (a fixed sequence, the same on every machine), completed linearly, and the best of them are improved by
//! Levenberg–Marquardt.
//!
//! # References
//! G. H. Golub, V. Pereyra, Inverse Problems 19, R1 (2003), doi:10.1088/0266-5611/19/2/201

use super::data::{Observation, Test, TestData};
use super::least_squares::{self, LEAST_SIZE, Residuals};
use super::regression::refined_zero::Found;
use super::regression::{Misfit, Rival, Search, check_minimum, ordered, refined_zero, settled};
use super::settings::{FitSettings, MEASURE, limits};
use super::softened::Softened;
use super::trust::{Assessment, Quality, noise_warnings, warnings};
use crate::error::Error;
use crate::material::HyperelasticLaw;
use crate::material::marlow::{Marlow, TableCurve};
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::{Law, MARLOW_TABLE, SWELLING};
use crate::material::viscosity::ViscousMaterial;
use doubtful_zero::WithGivenZeros;

mod doubtful_zero;

/// A law fitted to tests.
#[derive(Debug)]
pub struct Fit {
    /// The law's entry in the registry.
    pub law: &'static Law,
    /// The law with its parameters.
    pub fitted: Box<dyn HyperelasticLaw>,
    /// The parameters, in internal units.
    pub parameters: Vec<Parameter>,
    /// Other entries of a card of the law: key and choice.
    pub choices: Vec<(&'static str, String)>,
    /// The points (λ − 1, nominal stress in MPa) of a law that takes the curve as it is.
    pub curve: Vec<[f64; 2]>,
    pub(in crate::calibration) stress_measure: StressMeasure,
    /// The settings.
    pub settings: FitSettings,
    /// The quality of the fit.
    pub quality: Quality,
    /// The Prony series of a fit to what was measured over time; its shares and times follow the law's parameters.
    pub relaxed: Option<Relaxed>,
    /// The softening of a fit to loading and unloading; its parameters follow the law's.
    pub softened: Option<Softened>,
}

/// The relaxation of a fit.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// The series, and what the data cover.
    pub material: ViscousMaterial,
    /// The number of the fit's parameters that belong to the law.
    pub of_law: usize,
    /// The fitted stresses at all observations of each test, in the measure of the data, in MPa.
    pub predicted: Vec<Vec<f64>>,
    /// The numbers of terms that were tried with their AICc.
    pub tried: Vec<(usize, f64)>,
}

impl Fit {
    /// The parameters of the law.
    pub fn law_parameters(&self) -> &[Parameter] {
        let count = self.relaxed.as_ref().map(|relaxed| relaxed.of_law);
        let count = count.or(self.softened.as_ref().map(|softened| softened.of_law));
        &self.parameters[..count.unwrap_or(self.parameters.len())]
    }

    /// The stress measure of the data.
    pub fn stress_measure(&self) -> StressMeasure {
        self.stress_measure
    }

    /// Adds the warning about a zero of strain or stress that the law finds elsewhere than the tests have it, if there is one. It takes
    /// about as long as the fit.
    pub fn doubt_zeros(&mut self, tests: &[TestData]) {
        let misfit = Misfit::new(self.law, tests, self.settings.weighting);
        let (parameters, stiffness) = (self.law_parameters(), misfit.stiffness());
        let Ok(bounds) = limits(self.law, parameters, &self.settings.bounds, stiffness) else {
            return;
        };
        let given = WithGivenZeros {
            law: self.law,
            tests,
            weighting: self.settings.weighting,
            bounds: &bounds,
            least: &sizes(parameters, stiffness),
        };
        let warning = given.warning(parameters);
        self.quality.warnings.extend(warning);
    }

    /// The tests as they were fitted: with the zeros that were found together with the law.
    pub fn fitted_tests(&self, tests: &[TestData]) -> Vec<TestData> {
        refined_zero::with_zeros(tests, &self.quality.zeros)
    }

    /// Half the widths of the 95 % intervals of the fitted curve at some observations, in MPa; NaN where there are
    /// none because the residuals are not noise.
    pub fn half_widths(&self, data: &TestData, at: &[Observation]) -> Vec<f64> {
        let fixed = &self.quality.fixed;
        let noise = self.quality.noise.as_ref();
        let unknown = || vec![f64::NAN; at.len()];
        let Some(noise) = noise.filter(|_| self.quality.has_intervals()) else {
            return unknown();
        };
        // Zeros do not enter the law's curve.
        let mut values: Vec<f64> = self.parameters.iter().map(|one| one.value).collect();
        values.resize(fixed.len(), 1.0);
        let least = vec![LEAST_SIZE; values.len()];
        let curve = Curve {
            fit: self,
            data,
            at,
        };
        let gradients = least_squares::jacobian(&curve, &values, fixed, &least);
        let estimated = (0..fixed.len()).filter(|index| !fixed[*index]);
        let estimated: Vec<usize> = estimated.collect();
        let Some(gradients) = gradients else {
            return unknown();
        };
        let gradients = gradients.select_columns(&estimated);
        let half = |point: usize| noise.half_width(&gradients.row(point).transpose());
        (0..at.len()).map(half).collect()
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
        let Fit {
            law,
            stress_measure,
            ..
        } = self.fit;
        let parameters = &parameters[..self.fit.law_parameters().len()];
        let (law, _) = law.with_values(parameters, *stress_measure, MEASURE);
        for (stress, one) in stresses.iter_mut().zip(self.at) {
            *stress = self.data.stress_of(&*law, one);
        }
        stresses.iter().all(|stress| stress.is_finite())
    }
}

/// Fits a law to some tests together, and doubts their zeros.
///
/// # Errors
/// [`Error::Input`] when there are too few points, when a bound names no parameter, or when no parameters
/// within the bounds describe the data at all; [`Error::Solve`] when the search ends at no minimum.
pub fn fit(law: &'static Law, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
    let mut fit = nearest(law, tests, settings)?;
    fit.doubt_zeros(tests);
    Ok(fit)
}

/// As [`fit`], without doubts about zeros.
pub(in crate::calibration) fn nearest(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
) -> Result<Fit, Error> {
    check_measures(tests)?;
    let misfit = Misfit::new(law, tests, settings.weighting);
    if law.name == SWELLING {
        let message = format!(
            "{SWELLING} is not fitted: tests do not determine how far the gel was swollen when its network was made"
        );
        let hint = "fit neo-hooke, whose stresses are the same at a given swelling, and write the card by hand; see `gelbench guide materials`";
        return Err(Error::input(message, hint));
    }
    if law.name == MARLOW_TABLE {
        return take_curve(law, tests, settings, &misfit);
    }
    let (unknown, entries) = misfit.build(&[]);
    if unknown.bulk_modulus().is_some() && tests[0].stress_measure == StressMeasure::Cauchy {
        let message = format!(
            "{}: the deformed area of a compressible body does not follow from its stretch",
            law.name
        );
        let hint = "give nominal stress: force over the area at rest";
        return Err(Error::input(message, hint));
    }
    let parameters = entries.parameters;
    let bounds = limits(law, &parameters, &settings.bounds, misfit.stiffness())?;
    let points: usize = tests.iter().map(|test| test.observations.len()).sum();
    if points <= parameters.len() {
        let message = format!(
            "{}: {} parameters need at least {} points, and there are {points}",
            law.name,
            parameters.len(),
            parameters.len() + 1,
        );
        let hint = "measure more points, or choose a law with fewer parameters";
        return Err(Error::input(message, hint));
    }
    let search = Search {
        misfit: &misfit,
        parameters: &parameters,
        bounds: &bounds,
    };
    let minimum = search.minimum(settings.starts).ok_or_else(|| {
        let message = format!(
            "{}: no parameters within the bounds describe the data",
            law.name
        );
        Error::input(message, "widen the bounds, or choose another law")
    })?;
    check_minimum(&misfit, law, &parameters, &minimum.values, &bounds)?;
    let begun = Found {
        misfit,
        values: minimum.values,
        bounds,
    };
    let rival = minimum.rival;
    Ok(finished(law, tests, settings, begun, &parameters, rival))
}

/// The fit at the best values, with its zeros and its warnings.
fn finished(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
    begun: Found,
    parameters: &[Parameter],
    rival: Option<Rival>,
) -> Fit {
    let stiffness = begun.misfit.stiffness();
    let least = sizes(parameters, stiffness);
    let given = WithGivenZeros {
        law,
        tests,
        weighting: settings.weighting,
        bounds: &begun.bounds,
        least: &least,
    };
    let is_noise = |misfit: &Misfit, values: &[f64], bounds: &[[f64; 2]]| {
        given.assess(misfit, tests, values, bounds, |own| own.is_noise())
    };
    let of_law = |misfit: &Misfit, values: &[f64]| is_noise(misfit, values, &begun.bounds);
    let (misfit, values) = settled(&begun.misfit, begun.values, &begun.bounds, of_law);
    let found = Found {
        misfit,
        values,
        bounds: begun.bounds.clone(),
    };
    let mut found = found.with_zeros(&is_noise);
    found.values = ordered(parameters, &found.bounds, found.values);
    let (fitted, built) = found.misfit.build(&found.values);
    let moved = found.misfit.moved_tests(&found.values);
    let quality = given.assess(&found.misfit, &moved, &found.values, &found.bounds, |own| {
        warned(own, &built.parameters, rival.as_ref())
    });
    Fit {
        law,
        fitted,
        parameters: built.parameters,
        choices: built.choices,
        curve: Vec::new(),
        stress_measure: tests[0].stress_measure,
        settings: settings.clone(),
        quality,
        relaxed: None,
        softened: None,
    }
}

/// The figures of a fit with their warnings.
fn warned(assessment: &Assessment, parameters: &[Parameter], rival: Option<&Rival>) -> Quality {
    let mut quality = assessment.quality();
    quality.warnings = warnings(&quality, parameters, rival);
    let (tests, weighting) = (assessment.tests, assessment.weighting);
    let of_noise = noise_warnings(&quality, assessment.law, tests, weighting);
    quality.warnings.extend(of_noise);
    quality
}

/// The least size of each parameter that counts.
fn sizes(parameters: &[Parameter], stiffness: f64) -> Vec<f64> {
    let all = parameters.iter();
    all.map(|parameter| parameter.least_size(stiffness))
        .collect()
}

/// All tests of one fit must have one stress measure.
pub fn check_measures(tests: &[TestData]) -> Result<(), Error> {
    let Some(first) = tests.first() else {
        return Err(Error::input("there are no tests", "give one at least"));
    };
    let other = |test: &&TestData| test.stress_measure != first.stress_measure;
    let Some(other) = tests.iter().find(other) else {
        return Ok(());
    };
    let message = format!(
        "{} gives {} stress and {} gives {} stress",
        first.name,
        first.stress_measure.name(),
        other.name,
        other.stress_measure.name()
    );
    let hint = "convert one of them with `gelbench materials convert`";
    Err(Error::input(message, hint))
}

/// The warning about a curve that begins at rest with a stress.
fn subtracted([x, at_rest]: [f64; 2]) -> Option<String> {
    (x == 0.0 && at_rest != 0.0)
        .then(|| format!("the stress at rest, {at_rest:.4e} MPa, is subtracted from the curve"))
}

/// Marlow's law of one measured tension curve: nothing is fitted.
fn take_curve(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
    misfit: &Misfit,
) -> Result<Fit, Error> {
    let refuse = |message: String, hint: &str| Error::input(format!("{}{message}", law.name), hint);
    let [test] = tests else {
        let hint = "the others can be compared with `gelbench materials plot`";
        return Err(refuse(": takes one file".into(), hint));
    };
    if test.test != Test::Uniaxial {
        let hint = "give the file of a uniaxial test, or choose another law";
        return Err(refuse(": takes a uniaxial test".into(), hint));
    }
    if let Some((key, _)) = settings.bounds.first() {
        return Err(refuse(
            format!(" has no parameter `{key}`"),
            "leave the bound out",
        ));
    }
    let point = |one: &Observation| {
        let x = test.drawn_strain(one);
        [x, test.stress_measure.to_nominal(one.stress, x)]
    };
    let points: Vec<[f64; 2]> = test.observations.iter().map(point).collect();
    let curve = TableCurve::new(&points, true).map_err(|reason| {
        let hint = "cut the file to the loading branch from rest on, or fit another law";
        refuse(format!(": {reason}"), hint)
    })?;
    let fitted: Box<dyn HyperelasticLaw> = Box::new(Marlow { curve });
    let assessment = Assessment {
        misfit,
        weighting: settings.weighting,
        tests,
        law: &*fitted,
        values: &[],
        bounds: &[],
        least: &[],
    };
    let mut quality = assessment.quality();
    quality.warnings = warnings(&quality, &[], None);
    quality.warnings.extend(subtracted(points[0]));
    Ok(Fit {
        law,
        fitted,
        parameters: Vec::new(),
        choices: vec![("extrapolation", "linear".to_owned())],
        curve: points,
        stress_measure: StressMeasure::Nominal,
        settings: settings.clone(),
        quality,
        relaxed: None,
        softened: None,
    })
}
