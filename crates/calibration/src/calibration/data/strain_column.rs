//! What a column of deformation holds.

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
