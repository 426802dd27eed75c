//! Numbers and stretches as a report writes them.

use crate::problem::ClampedPlate;
use crate::results::or_dash;
use crate::units::decimals;

/// A figure with so many decimals; a dash where there is none.
pub fn figure(value: Option<f64>, decimals: usize) -> String {
    or_dash(value, |value| format!("{value:.decimals$}"))
}

/// A force, a length or an energy with some decimals, of small ones their first digits; a dash where it is none.
pub fn quantity(value: Option<f64>, places: usize) -> String {
    or_dash(value, |value| decimals(value, places))
}

/// A figure as a power of ten; a dash where it is none.
pub fn power(value: f64) -> String {
    if value.is_nan() {
        "–".into()
    } else {
        format!("{value:.1e}")
    }
}

/// `15 %, 30 % stretch`, for sentences.
pub fn at_stretches(stretches: Vec<f64>) -> String {
    let percent = |stretch: f64| format!("{} %", ClampedPlate::percent(stretch));
    let all: Vec<String> = stretches.into_iter().map(percent).collect();
    format!("{} stretch", all.join(", "))
}
