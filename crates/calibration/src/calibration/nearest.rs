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

use std::sync::Arc;

use super::data::{Observation, Test, TestData};
use super::fitted::Fit;
use super::least_squares::descend;
use super::regression::{Elastic, Misfit, Response, Rival, Search, ordered};
use super::settings::{FitSettings, held, limits};
use super::solution::Solution;
use super::trust::noise_warnings;
use crate::error::Error;
use crate::material::marlow::{Marlow, TableCurve};
use crate::material::parameters::{Parameter, StressMeasure};
use crate::material::registry::{Law, MARLOW_TABLE, SWELLING};

/// The fit of a law, however far it is from the data.
pub fn nearest(
    law: &'static Law,
    tests: &[TestData],
    settings: &FitSettings,
) -> Result<Fit, Error> {
    check_measures(tests)?;
    refuse_swelling(law)?;
    if law.name == MARLOW_TABLE {
        return take_curve(law, tests, settings);
    }
    let response = Elastic::new(law, tests);
    let (unknown, entries) = response.build(&[]);
    if unknown.bulk_modulus().is_some() && tests[0].stress_measure == StressMeasure::Cauchy {
        let message = format!(
            "{}: the deformed area of a compressible body does not follow from its stretch",
            law.name
        );
        let hint = "give nominal stress: force over the area at rest";
        return Err(Error::input(message, hint));
    }
    let parameters = entries.parameters;
    let bounds = limits(
        law,
        tests,
        &parameters,
        &settings.bounds,
        response.stiffness,
    )?;
    let misfit = Misfit::new(response, settings.weighting);
    let fitted = bounds.iter().filter(|[low, high]| low < high).count();
    check_points(law, tests, fitted)?;
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
    let solution = Solution {
        misfit,
        values: minimum.values,
        bounds,
    }
    .checked(law, &parameters)?
    .settled()
    .with_zeros();
    Ok(finished(
        law,
        &parameters,
        solution,
        settings,
        minimum.rival.as_ref(),
    ))
}

/// A law with a part that is linear in its values about `start`, see [`Elastic::with_linear`]. Values are those of the law, followed by those
/// of the zeros that are sought.
pub struct About<'a, D> {
    pub law: &'static Law,
    pub tests: &'a [TestData],
    pub start: &'a [f64],
    /// The derivatives of what is linear at an observation, and how many times larger what was measured is.
    pub linear: D,
    /// Other values, and the tests that would have been measured by them.
    pub other: Option<(&'a [f64], &'a [TestData])>,
    pub settings: &'a FitSettings,
}

/// A model with the parameters of its law, and the bounds and sizes of its values.
struct Model<'a> {
    misfit: Misfit<Elastic<'a>>,
    parameters: Vec<Parameter>,
    bounds: Vec<[f64; 2]>,
    sizes: Vec<f64>,
}

impl<D: Fn(&Observation) -> (Vec<f64>, f64)> About<'_, D> {
    fn model(&self) -> Result<Model<'_>, Error> {
        let response = Elastic::new(self.law, self.tests).with_zeros();
        let parameters = response.build(&[]).1.parameters;
        let (bounds, stiffness) = (&self.settings.bounds, response.stiffness);
        let mut bounds = limits(self.law, self.tests, &parameters, bounds, stiffness)?;
        bounds.extend(response.zeros().iter().map(|zero| zero.bounds()));
        let pairs = parameters.iter().zip(self.start);
        let mut sizes: Vec<f64> = pairs
            .map(|(parameter, value)| size(parameter, *value, stiffness))
            .collect();
        sizes.resize(bounds.len(), SIZE_OF_ZERO);
        let mut response = response.with_linear(self.start.to_vec(), &self.linear);
        if let Some((values, tests)) = self.other {
            let other = Elastic::new(self.law, tests).with_zeros();
            response = response.bent(values, &other, &sizes);
        }
        Ok(Model {
            misfit: Misfit::new(response, self.settings.weighting),
            parameters,
            bounds,
            sizes,
        })
    }

    /// The best values that differ from the start by at most a share of the size of each.
    pub fn within(&self, share: f64) -> Result<Vec<f64>, Error> {
        let model = self.model()?;
        let sizes = self.start.iter().zip(&model.sizes);
        let limits = model.bounds.iter().zip(sizes);
        let bounds: Vec<[f64; 2]> = limits
            .map(|([low, high], (value, size))| {
                [
                    low.max(value - share * size),
                    high.min(value + share * size),
                ]
            })
            .collect();
        Ok(descend(&model.misfit, self.start, &bounds).unwrap_or_else(|| self.start.to_vec()))
    }

    /// The fit.
    pub fn fit(&self) -> Result<Fit, Error> {
        let model = self.model()?;
        let values = descend(&model.misfit, self.start, &model.bounds);
        let solution = Solution {
            values: values.unwrap_or_else(|| self.start.to_vec()),
            misfit: model.misfit,
            bounds: model.bounds,
        };
        Ok(finished(
            self.law,
            &model.parameters,
            solution.settled(),
            self.settings,
            None,
        ))
    }
}

/// The size of a zero's value by which steps are measured.
const SIZE_OF_ZERO: f64 = 0.1;

/// The size of a parameter by which steps are measured; a small stress may become one of the data's.
fn size(parameter: &Parameter, value: f64, stiffness: f64) -> f64 {
    let [from, to] = parameter.usual;
    let least = if parameter.is_stress() {
        0.02 * stiffness
    } else if from > 0.0 {
        (from * to).sqrt()
    } else {
        0.5 * (to - from)
    };
    value.abs().max(least)
}

/// The fit of a solution, with all warnings.
fn finished(
    law: &'static Law,
    parameters: &[Parameter],
    mut solution: Solution<Elastic>,
    settings: &FitSettings,
    rival: Option<&Rival>,
) -> Fit {
    solution.values = ordered(parameters, &solution.bounds, solution.values);
    let mut fit = solution.fit(law, parameters, settings, rival);
    let tests = solution.misfit.response.moved_tests(&solution.values);
    let of_noise = noise_warnings(&fit.quality, &*fit.fitted, &tests, settings.weighting);
    fit.quality.warnings.extend(of_noise);
    let of_shear = held_warning(&fit, &tests);
    fit.quality.warnings.extend(of_shear);
    fit.choices = solution.misfit.response.build(&solution.values).1.choices;
    fit
}

/// The warning about parameters that only shear determines.
fn held_warning(fit: &Fit, tests: &[TestData]) -> Option<String> {
    let held = held(fit.law, tests, &fit.settings.bounds);
    let is_held = |one: &&Parameter| held.iter().any(|(key, _)| *key == one.key);
    let parameters = fit.parameters.iter().filter(is_held);
    let values: Vec<String> = parameters
        .map(|one| format!("{} = {:.4}", one.key, one.value))
        .collect();
    (!values.is_empty()).then(|| {
        format!(
            "no test shears the sheet, which would determine {}: held, not fitted; state what is known, or add a test in simple shear",
            values.join(", ")
        )
    })
}

/// The law of a swollen network is not fitted.
fn refuse_swelling(law: &Law) -> Result<(), Error> {
    if law.name == SWELLING {
        let message = format!(
            "{SWELLING} is not fitted: tests do not determine how far the gel was swollen when its network was made"
        );
        let hint = "fit neo-hooke, whose stresses are the same at a given swelling, and write the card by hand; see `gelbench guide materials`";
        return Err(Error::input(message, hint));
    }
    Ok(())
}

/// Parameters need more points than there are of them.
fn check_points(law: &Law, tests: &[TestData], parameters: usize) -> Result<(), Error> {
    let points: usize = tests.iter().map(|test| test.observations.len()).sum();
    if points > parameters {
        return Ok(());
    }
    let message = format!(
        "{}: {parameters} parameters need at least {} points, and there are {points}",
        law.name,
        parameters + 1,
    );
    let hint = "measure more points, or choose a law with fewer parameters";
    Err(Error::input(message, hint))
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
fn take_curve(law: &'static Law, tests: &[TestData], settings: &FitSettings) -> Result<Fit, Error> {
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
    let response = Elastic::of_curve(law, tests, Arc::new(Marlow { curve }));
    let taken = Solution {
        misfit: Misfit::new(response, settings.weighting),
        values: Vec::new(),
        bounds: Vec::new(),
    };
    let mut fit = taken.fit(law, &[], settings, None);
    fit.quality.warnings.extend(subtracted(points[0]));
    // Nothing was fitted that could be compared with other laws.
    fit.quality.aicc = f64::NAN;
    fit.choices = vec![("extrapolation", "linear".to_owned())];
    fit.curve = points;
    fit.stress_measure = StressMeasure::Nominal;
    Ok(fit)
}
