//! What a user must know before using a fit.

use super::quality::{Quality, StableRange, has_known_sign};
use crate::calibration::data::TestData;
use crate::calibration::regression::Rival;
use crate::material::curve::Mode;
use crate::material::parameters::Parameter;
use crate::statistics::f_tail;

/// A rival minimum that is worse by less is always reported.
const NEARLY: f64 = 0.05;

/// The warnings of a fit that has another minimum.
pub fn warnings(quality: &Quality, parameters: &[Parameter], rival: Option<&Rival>) -> Vec<String> {
    let away = (quality.nmad_percent > 20.0).then(|| {
        let percent = quality.nmad_percent;
        format!("the law does not follow the data: the mean deviation is {percent:.0} %")
    });
    let rival = rival.filter(|rival| rival.worse <= NEARLY || is_possible(rival, quality));
    let other = rival.map(|rival| {
        let pairs = parameters.iter().zip(&rival.values);
        let texts = pairs.map(|(parameter, value)| format!("{} = {value:.4}", parameter.key));
        let values = texts.collect::<Vec<_>>().join(", ");
        if rival.worse <= NEARLY { format!("the fit is not unique: the sum of squares of {values} is at most 5 % larger") } else { format!(
            "the fit is not unique: the sum of squares of {values} is {:.0} % larger, which the noise of so few independent points does not \
             exclude; intervals belong to the fit that was taken",
            100.0 * rival.worse
        ) }
    });
    away.into_iter()
        .chain(uncertain(quality, parameters))
        .chain(correlated(quality, parameters))
        .chain(other)
        .chain(quality.stable.iter().filter_map(unstable))
        .chain(predicted(quality))
        .collect()
}

/// Whether the sum of squares at the true parameters is, by noise, as much larger than the minimum in more than a twentieth of tests:
/// F = (S′/S − 1) (nₑ − k)/k.
fn is_possible(rival: &Rival, quality: &Quality) -> bool {
    let parameters = rival.values.len() as f64;
    let freedom = quality.effective_points() - parameters;
    quality.has_intervals()
        && f_tail([parameters, freedom], rival.worse * freedom / parameters) > 0.05
}

/// Zeros that were found in the records and are taken as known.
pub fn taken_zeros(tests: &[TestData]) -> Option<String> {
    let result = tests.iter().filter(|test| test.found_zero.is_some());
    let names: Vec<&str> = result.map(|test| &*test.name).collect();
    (!names.is_empty()).then(|| {
        format!(
            "the zero that was found in {} is taken as known: the intervals do not include its uncertainty",
            names.join(", ")
        )
    })
}

/// Parameters that a bound holds, or whose sign is not known.
fn uncertain(quality: &Quality, parameters: &[Parameter]) -> Vec<String> {
    let (mut warnings, mut vague) = (Vec::new(), Vec::new());
    for (index, estimate) in quality.estimates.iter().enumerate() {
        let (key, value) = (parameters[index].key, estimate.value);
        if quality.at_bound[index] {
            let others = if !quality.has_intervals() {
                ""
            } else if quality.fixed[index] {
                ": the intervals of the others assume that it is exactly there"
            } else {
                ": the intervals of the others treat it as free"
            };
            warnings.push(format!("{key} = {value:.4e} is at a bound{others}"));
        } else if !quality.held[index] && !has_known_sign(estimate) {
            vague.push(key);
        }
    }
    if !vague.is_empty() {
        warnings.push(format!(
            "not identifiable from these data: {}, whose sign they do not determine",
            vague.join(", ")
        ));
    }
    warnings
}

/// The pair of parameters with the largest correlation.
fn correlated(quality: &Quality, parameters: &[Parameter]) -> Option<String> {
    let pairs = (0..parameters.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
    let mut close: Vec<(f64, (usize, usize))> = pairs
        .map(|pair| (quality.correlation[pair], pair))
        .filter(|(correlation, _)| correlation.abs() >= 0.99)
        .collect();
    close.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let (correlation, (j, i)) = close.first()?;
    let more = match close.len() - 1 {
        0 => String::new(),
        more => format!(", and {more} more pairs above 0.99"),
    };
    Some(format!(
        "{} and {} can hardly be distinguished: their correlation is {correlation:.4}{more}",
        parameters[*j].key, parameters[*i].key
    ))
}

fn unstable(range: &StableRange) -> Option<String> {
    let ([low, high], [from, to]) = (range.stretches, range.needed);
    let name = range.mode.name();
    if high <= 1.0 || low >= 1.0 {
        return Some(format!("the law is unstable from rest in {name} tests"));
    }
    (!range.is_enough()).then(|| {
        format!(
            "the law is stable (Drucker) in {name} tests from λ = {low:.3} to {high:.3} only, the data go from {from:.3} to {to:.3}"
        )
    })
}

fn predicted(quality: &Quality) -> Option<String> {
    let untested: Vec<_> = quality.untested.iter().map(|mode| mode.name()).collect();
    let only = if !quality.untested.contains(&Mode::Uniaxial) && untested.len() == 2 {
        "uniaxial only: "
    } else {
        ""
    };
    let untested = match &untested[..] {
        [] => return None,
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    };
    Some(format!(
        "{only}{untested} stresses are predictions that no data support"
    ))
}
