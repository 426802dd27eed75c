//! The parameters of a Prony series.

use super::prony::MOST_SHARED;
use crate::document::Bound;
use crate::material::parameters::Parameter;
use crate::units::Dimension;

/// How many terms a series has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terms {
    /// As many as AICc asks for.
    Automatic,
    /// So many.
    Exactly(usize),
}

/// Keys of shares, as the card's.
pub const SHARES: [&str; Terms::MOST] = [
    "relaxation.1.share",
    "relaxation.2.share",
    "relaxation.3.share",
    "relaxation.4.share",
    "relaxation.5.share",
    "relaxation.6.share",
];
/// Keys of times, as the card's.
pub const TIMES: [&str; Terms::MOST] = [
    "relaxation.1.time",
    "relaxation.2.time",
    "relaxation.3.time",
    "relaxation.4.time",
    "relaxation.5.time",
    "relaxation.6.time",
];

impl Terms {
    /// The most terms of a series.
    pub const MOST: usize = 6;

    /// Reads `automatic` or a number.
    pub fn parse(text: &str) -> Option<Self> {
        let number = text.parse().ok().filter(|terms| *terms <= Self::MOST);
        match (text, number) {
            ("automatic", _) => Some(Self::Automatic),
            (_, number) => number.map(Self::Exactly),
        }
    }

    /// The numbers that are tried.
    pub fn tried(self) -> std::ops::RangeInclusive<usize> {
        match self {
            Self::Automatic => 0..=Self::MOST,
            Self::Exactly(terms) => terms.min(Self::MOST)..=terms.min(Self::MOST),
        }
    }
}

/// The parameters of a law with so many terms.
pub fn parameters(law: &[Parameter], terms: usize, [low, high]: [f64; 2]) -> Vec<Parameter> {
    let of_term = |index: usize| {
        let share = Parameter {
            key: SHARES[index],
            value: f64::NAN,
            dimension: Dimension::Ratio,
            bound: Bound::Within(0.0, MOST_SHARED),
            usual: [0.0, 1.0],
        };
        let time = Parameter {
            key: TIMES[index],
            dimension: Dimension::Time,
            bound: Bound::Within(low, high),
            usual: [low, high],
            ..share.clone()
        };
        [share, time]
    };
    law.iter()
        .cloned()
        .chain((0..terms).flat_map(of_term))
        .collect()
}

/// Limits with times by their logarithms.
pub fn transformed(mut limits: Vec<[f64; 2]>, of_law: usize) -> Vec<[f64; 2]> {
    for limit in limits[of_law..].iter_mut().skip(1).step_by(2) {
        *limit = limit.map(f64::ln);
    }
    limits
}
