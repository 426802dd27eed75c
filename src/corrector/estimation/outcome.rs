//! An estimated field with what the data say about it, as it is handed on.

mod field_estimate;
mod verdict;

pub use field_estimate::{
    Contradiction, EdgeForce, EdgeOutcome, FieldEstimate, ForceCheck, FoundParameter,
    MarkerEstimate, Smoothing, StressEstimate, TRADE, TRADE_WEIGHTED, VariogramBin, Whiteness,
};
pub use verdict::{Answer, Freedom, Mend, NoiseCorrelation, Reason, Verdict, Worst};
