//! An estimated field with what the data say about it, as it is handed on.

mod field_estimate;
mod verdict;

pub use field_estimate::{
    Contradiction, EdgeForce, EdgeOutcome, FieldEstimate, ForceCheck, FoundParameter,
    MarkerEstimate, RULE, RULE_WITH_MODEL_ERROR, Smoothing, StressEstimate, VariogramBin,
    Whiteness,
};
pub use verdict::{Alternative, Answer, NoiseCorrelation, Reason, Trial, Verdict, Worst};
