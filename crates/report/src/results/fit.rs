//! The numbers of a fitted law.

use serde_json::{Map, Value, json};

use super::digits;
use crate::calibration::{Fit, MovedZero, Protocols, Softened, TestData, Zero};
use crate::material::curve::samples;
use crate::material::parameters::Parameter;

/// All numbers of a fit. Numbers that do not exist are `null`.
pub fn fit_json(fit: &Fit, tests: &[TestData]) -> Value {
    let quality = &fit.quality;
    let rows = quality.correlation.row_iter();
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "law": fit.law.name,
        "formula": fit.law.formula,
        "data": tests.iter().map(|test| json!({
            "file": test.name,
            "test": test.test.name(),
            "specimen": test.specimen,
            "stress_measure": test.stress_measure.name(),
            "points": test.observations.len(),
            "columns": test.table.columns.iter().map(|column| json!({
                "quantity": column.quantity,
                "column": column.column,
                "unit": column.unit,
                "divided_by": column.divided_by,
            })).collect::<Vec<_>>(),
            "columns_not_read": test.table.unread,
            "lines": test.table.lines,
            "remarks": test.remarks,
            "points_left_out": test.left_out.len(),
        })).collect::<Vec<_>>(),
        "weighting": fit.settings.weighting.name(),
        "residuals": fit.settings.weighting.describe(),
        "verdict": quality.verdict.map(|verdict| json!({
            "answer": verdict.answer.words(),
            "durbin_watson": verdict.durbin_watson.map(|test| test.statistic),
            "durbin_watson_probability": verdict.durbin_watson.map(|test| test.probability),
            "correlation_of_neighbours": verdict.of_neighbours,
            "pattern_probability": verdict.pattern_probability,
            "effective_points": verdict.effective_points,
            "noise_ratio": verdict.noise_ratio,
        })),
        "parameters": (0..fit.parameters.len()).map(|index| parameter_json(fit, index)).collect::<Vec<_>>(),
        "relaxation": fit.relaxed.as_ref().map(|relaxed| json!({
            "shares": relaxed.material.relaxation.iter().map(|term| term.share).collect::<Vec<_>>(),
            "times_s": relaxed.material.relaxation.iter().map(|term| term.time).collect::<Vec<_>>(),
            "terms_and_aicc": relaxed.tried,
            "resolved_times_s": relaxed.material.covered.times,
            "rates_per_s": relaxed.material.covered.rates,
        })),
        "softening": fit.softened.as_ref().map(softening_json),
        "rest_state": quality.zeros.iter().map(zero_json).collect::<Vec<_>>(),
        "mounting": fit.mounted.as_ref().map(|mounted| json!({
            "homogeneous_parameters": values_json(&mounted.homogeneous),
            "homogeneous_bias_percent": mounted.bias_percent,
            "forces_of_smaller_cells_percent": mounted.discretisation_percent,
            "rounds": mounted.rounds,
        })),
        "homogeneous_at_rest_as_mounted": fit.at_rest_as_mounted.as_ref().map(|(parameters, r_squared)| json!({
            "parameters": values_json(parameters),
            "r_squared": r_squared,
        })),
        "protocols": fit.protocols.as_ref().map(protocols_json),
        "correlation": rows.map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>(),
        "points": quality.points,
        "sum_of_squares_MPa2": quality.sum_of_squares,
        "rmse_MPa": quality.rmse,
        "nmad_percent": quality.nmad_percent,
        "r_squared": quality.r_squared,
        "aicc": quality.aicc,
        "largest_relative_error_percent": quality.largest_relative_error_percent,
        "initial_shear_modulus_MPa": fit.fitted.shear_modulus(),
        "initial_youngs_modulus_MPa": fit.fitted.youngs_modulus(),
        "stretch_range": quality.stretch_range,
        "stable": quality.stable.iter().map(|range| json!({
            "test": range.mode.name(),
            "stretches": range.stretches,
        })).collect::<Vec<_>>(),
        "curves": samples(&*fit.fitted, quality.stretch_range).iter().map(|sample| json!({
            "test": sample.name(),
            "supported_by_data": sample.mode.is_some_and(|mode| !quality.untested.contains(&mode)),
            "stretch_and_nominal_stress_MPa": sample.points,
        })).collect::<Vec<_>>(),
        "warnings": quality.warnings,
    })
}

/// How well a law predicts protocols of a biaxial test that were left out, and whether further ones would tell its parameters better.
fn protocols_json(protocols: &Protocols) -> Value {
    json!({
        "left_out_percent": protocols.left_out_percent,
        "all_left_out_percent": protocols.all_left_out_percent(),
        "further": protocols.further.map(|further| json!({
            "stretches": further.stretches,
            "parameter": further.key,
            "standard_error_percent": further.standard_error_percent[0],
            "standard_error_with_it_percent": further.standard_error_percent[1],
        })),
    })
}

/// Parameters by key, in internal units.
fn values_json(parameters: &[Parameter]) -> Value {
    let pairs = parameters
        .iter()
        .map(|parameter| (parameter.key.to_owned(), json!(parameter.value)));
    pairs.collect::<Map<_, _>>().into()
}

/// A zero or a stretch that was found with the law.
fn zero_json(moved: &MovedZero) -> Value {
    let (what, unit) = match moved.zero {
        Zero::Record { test, .. } => (format!("zero of test {}", test + 1), ""),
        Zero::Force { axis, .. } => (
            format!("stress without load along axis {}", axis + 1),
            "MPa",
        ),
        Zero::Stretch { axis } => (
            format!("stretch as mounted less 1 along axis {}", axis + 1),
            "-",
        ),
    };
    json!({
        "what": what,
        "unit": unit,
        "value": moved.by.value,
        "standard_error": moved.by.standard_error,
        "interval_95_percent": moved.by.interval,
    })
}

/// A parameter with its uncertainty.
fn parameter_json(fit: &Fit, index: usize) -> Value {
    let (quality, parameter) = (&fit.quality, &fit.parameters[index]);
    let estimate = quality.has_intervals().then_some(&quality.estimates[index]);
    json!({
        "key": parameter.key,
        "value": parameter.value,
        "unit": parameter.unit(),
        "standard_error": estimate.map(|estimate| estimate.standard_error),
        "interval_95_percent": estimate.map(|estimate| estimate.interval),
        "at_bound": quality.at_bound[index],
        "held": quality.held[index],
    })
}

/// The numbers of softening.
fn softening_json(softened: &Softened) -> Value {
    json!({
        "r": softened.softening.r,
        "m_MPa": softened.softening.m,
        "beta": softened.softening.beta,
        "cycles": softened.cycles.iter().map(|cycle| json!({
            "file": cycle.test,
            "stretch": cycle.stretch,
            "measured_work_mJ_per_mm3": cycle.measured,
            "fitted_work_mJ_per_mm3": cycle.fitted,
            "closed_form_mJ_per_mm3": cycle.closed_form,
            "dissipated_by_softening_mJ_per_mm3": cycle.dissipated,
        })).collect::<Vec<_>>(),
    })
}

/// The parameters with their standard errors, and how far the law is from the data.
pub(super) fn notes(fit: &Fit) -> Vec<String> {
    /// Parameters that a picture has room for.
    const MOST: usize = 6;
    let quality = &fit.quality;
    let parameter = |(index, parameter): (usize, &Parameter)| {
        let estimate = quality.estimates.get(index);
        let error = estimate.filter(|_| quality.has_intervals() && !quality.held[index]);
        let number = match error.map(|estimate| estimate.standard_error) {
            Some(error) if error > 0.0 && error < parameter.value.abs() => {
                // As many decimals as the error has with two digits.
                let decimals = (1.0 - error.log10().floor()).max(0.0) as usize;
                format!("{:.decimals$} ± {error:.decimals$}", parameter.value)
            }
            _ => digits(parameter.value, 4),
        };
        let value = format!("{} = {number} {}", parameter.key, parameter.unit());
        value.trim_end_matches([' ', '–']).to_owned()
    };
    let shown = fit.parameters.iter().take(MOST).enumerate();
    let mut notes: Vec<String> = shown.map(parameter).collect();
    if fit.parameters.len() > MOST {
        notes.push(format!(
            "and {} more parameters",
            fit.parameters.len() - MOST
        ));
    }
    notes.push(format!("mean error {} %", digits(quality.nmad_percent, 2)));
    notes
}

/// `Mooney-Rivlin` for `mooney-rivlin`.
pub(super) fn title_case(name: &str) -> String {
    let parts = name.split('-').map(|part| {
        let mut letters = part.chars();
        let first = letters.next().map(|letter| letter.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    });
    parts.collect::<Vec<_>>().join("-")
}
