//! Columns whose sign is reversed.

use super::strain_column::StrainColumn;
use crate::document::{Faulty, Head};

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
