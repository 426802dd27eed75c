//! From measured curves to a material card: reading of test data, least squares, and how far a fit can
//! be trusted.
//!
//! ```text
//! table ─reading─▶ TestData ─fit─▶ Fit ─quality─▶ Quality ─▶ card, picture, JSON
//! ```

mod card_text;
mod conversion;
mod fit;
mod layout;
mod least_squares;
mod misfit;
mod quality;
mod reading;
mod rounding;
mod search;
mod settings;
mod test_data;
mod verdict;
mod warnings;

pub use card_text::{Provenance, card_text};
pub use conversion::Conversion;
pub use fit::{Fit, fit, rank};
pub use quality::{Quality, StableRange};
pub use reading::KEYS;
pub use settings::{Bounds, FitSettings, Weighting};
pub use test_data::{Observation, StrainColumn, Test, TestData};
pub use verdict::{Answer, Verdict};

#[cfg(test)]
mod quality_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod verdict_tests;
