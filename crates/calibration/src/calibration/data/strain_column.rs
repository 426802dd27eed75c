//! What a column of deformation holds, and columns whose sign is reversed.

use crate::document::{Faulty, Head};
use crate::material::parameters::StrainMeasure;

/// The quantity in a column of deformation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrainColumn {
    /// λ.
    Stretch,
    /// A strain.
    Strain(StrainMeasure),
    /// The Green-Lagrange strain (λ² − 1)/2.
    GreenLagrange,
}

impl StrainColumn {
    /// The names that files use.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("stretch", Self::Stretch),
        ("nominal", Self::Strain(StrainMeasure::Nominal)),
        ("logarithmic", Self::Strain(StrainMeasure::Logarithmic)),
        ("green-lagrange", Self::GreenLagrange),
    ];

    /// λ − 1 from a value of the column.
    pub fn to_nominal(self, value: f64) -> f64 {
        match self {
            Self::Stretch => value - 1.0,
            Self::Strain(measure) => measure.to_nominal(value),
            Self::GreenLagrange => 2.0 * value / (1.0 + (1.0 + 2.0 * value).sqrt()),
        }
    }

    /// A value of the column from λ − 1.
    pub fn of_nominal(self, x: f64) -> f64 {
        match self {
            Self::Stretch => 1.0 + x,
            Self::Strain(measure) => measure.of_nominal(x),
            Self::GreenLagrange => x + 0.5 * x * x,
        }
    }
}

/// The key of the columns whose sign is reversed.
pub const FLIP: &str = "flip";

/// The columns whose sign is reversed.
const FLIPS: [(&str, [f64; 2]); 3] = [
    ("strain", [-1.0, 1.0]),
    ("stress", [1.0, -1.0]),
    ("both", [-1.0, -1.0]),
];

/// The signs of strains and stresses that are stated.
pub fn flip(head: &Head, measure: StrainColumn) -> Faulty<[f64; 2]> {
    if head.setting(FLIP, None)?.is_none() {
        return Ok([1.0; 2]);
    }
    let signs = head.choice(FLIP, None, &FLIPS)?;
    if signs[0] < 0.0 && measure == StrainColumn::Stretch {
        let message = "a stretch has no sign that could be reversed";
        return Err(head.fault_of(FLIP, message, "--flip stress reverses the stresses"));
    }
    Ok(signs)
}
