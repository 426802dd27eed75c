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
    /// This number.
    Exactly(usize),
}

/// The keys of the share and of the time of each term, as the card's.
pub const TERM_KEYS: [[&str; 2]; Terms::MOST] = [
    ["relaxation.1.share", "relaxation.1.time"],
    ["relaxation.2.share", "relaxation.2.time"],
    ["relaxation.3.share", "relaxation.3.time"],
    ["relaxation.4.share", "relaxation.4.time"],
    ["relaxation.5.share", "relaxation.5.time"],
    ["relaxation.6.share", "relaxation.6.time"],
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

/// The parameters of a law with `terms` terms.
pub fn parameters(law: &[Parameter], terms: usize, [low, high]: [f64; 2]) -> Vec<Parameter> {
    let of_term = |[share, time]: [&'static str; 2]| {
        let share = Parameter {
            key: share,
            value: f64::NAN,
            dimension: Dimension::Ratio,
            bound: Bound::Within(0.0, MOST_SHARED),
            usual: [0.0, 1.0],
        };
        let time = Parameter {
            key: time,
            dimension: Dimension::Time,
            bound: Bound::Within(low, high),
            usual: [low, high],
            ..share.clone()
        };
        [share, time]
    };
    let of_terms = TERM_KEYS.into_iter().take(terms).flat_map(of_term);
    law.iter().cloned().chain(of_terms).collect()
}

/// Limits with times by their logarithms.
pub fn transformed(mut limits: Vec<[f64; 2]>, of_law: usize) -> Vec<[f64; 2]> {
    for limit in limits[of_law..].iter_mut().skip(1).step_by(2) {
        *limit = limit.map(f64::ln);
    }
    limits
}
