//! Test data: reading of tables and records, what their columns mean, zeros and cycles, what cannot be.

mod conversion;
mod cycles;
mod layout;
mod plausible;
mod reading;
mod record;
mod roles;
mod rounding;
mod test_data;
mod zero;

pub use conversion::Conversion;
pub use cycles::Branches;
pub use reading::KEYS;
pub use test_data::{FoundZero, Observation, StrainColumn, Test, TestData, Times};
