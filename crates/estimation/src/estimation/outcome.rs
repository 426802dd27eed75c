//! The result of an estimate: the field with its uncertainty and the verdict of the data.

mod field_estimate;
mod verdict;

pub use field_estimate::{
    Contradiction, EdgeForce, EdgeOutcome, FieldEstimate, ForceCheck, FoundParameter,
    MarkerEstimate, RULE, RULE_WITH_MODEL_ERROR, Smoothing, StressEstimate,
};
pub use verdict::{
    Alternative, Answer, MovedPart, NoiseCorrelation, Reason, Trial, Verdict, Worst,
};
