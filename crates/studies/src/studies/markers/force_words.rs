//! Forces with their intervals in words: whether they rest on the card alone, and what a specimen that ends farther out adds.

use super::MarkerStudy;
use crate::estimation::{Answer, FieldEstimate};
use crate::statistics::Estimate;
use crate::units::decimals;

/// A force as `12.87 N (12.84 … 12.90 given the card; up to 15.56 N if the specimen reaches 5.00 mm farther out)`.
pub fn newtons(field: &MarkerStudy, found: &FieldEstimate, force: &Estimate) -> String {
    let value = decimals(force.value, 4);
    let [low, high] = force.interval;
    let interval = match (found.has_intervals(), found.verdict.answer) {
        _ if low >= high => String::new(),
        (true, _) => format!(" ({})", interval(field, found, force)),
        (false, Answer::NotExplained) => " (no interval: not explained)".to_owned(),
        (false, _) => " (no interval: the noise is that of gross errors)".to_owned(),
    };
    format!("{value} N{interval}")
}

/// The interval through the edges of the mesh, and how far an edge farther out takes it, where that is more.
fn interval(field: &MarkerStudy, found: &FieldEstimate, force: &Estimate) -> String {
    let half = found.reach * force.standard_error;
    let [low, high] = force.interval;
    let [less, more] = [force.value - half - low, high - force.value - half];
    let (ends, farther) = match half.max(less).max(more) {
        _ if half <= 0.0 => ([low, high], None),
        most if most == less => ([low + less, high], Some(low)),
        most if most == more => ([low, high - more], Some(high)),
        _ => ([low, high], None),
    };
    let mut text = ends.map(|end| decimals(end, 4)).join(" … ");
    if found.is_given_the_law && found.law_deviations.is_empty() {
        text += " given the card";
    }
    if let Some((gap, end)) = field.unknown_gap.zip(farther) {
        let (gap, end) = (decimals(gap, 4), decimals(end, 4));
        text += &format!("; up to {end} N if the specimen reaches {gap} mm farther out");
    }
    text
}

/// What the size of the forces rests on, where it is the card's.
pub fn basis(field: &MarkerStudy, found: &FieldEstimate) -> Option<String> {
    let name = &field.card.name;
    if !found.is_given_the_law || !found.has_intervals() {
        return None;
    }
    Some(if found.law_deviations.is_empty() {
        format!(
            "Forces and stresses are given the card `{name}`, which records no uncertainty: its relative error in stiffness is one of theirs \
         that no interval includes, and that only a measured force shows (--force)."
        )
    } else {
        let all = found.law_deviations.iter().flatten();
        let most = all.fold(0.0, |most: f64, one| most.max(*one));
        format!(
            "Intervals of forces and stresses include the uncertainty that the card `{name}` records, up to ± {} N; that another law may fit \
             as well is not in it.",
            decimals(found.reach * most, 4)
        )
    })
}
