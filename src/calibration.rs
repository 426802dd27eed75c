//! From measured curves to a material card: reading of test data, least squares, and how far a fit can
//! be trusted.
//!
//! ```text
//! table ─reading─▶ TestData ─fit─▶ Fit ─quality─▶ Quality ─▶ card, picture, JSON
//! ```

mod assessment;
mod card_text;
mod conversion;
mod cycles;
mod fit;
mod history;
mod judged;
mod layout;
mod least_squares;
mod misfit;
mod plausible;
mod prony;
mod quality;
mod ranking;
mod reading;
mod record;
mod refined_zero;
mod relaxation;
mod reweighed;
mod roles;
mod rounding;
mod search;
mod settings;
mod softened;
mod softening;
mod softening_misfit;
mod terms;
mod test_data;
mod uneven_noise;
mod verdict;
mod warnings;
mod zero;

pub use card_text::{Provenance, card_text};
pub use conversion::Conversion;
pub use fit::{Fit, Relaxed, fit};
pub use quality::{Quality, StableRange};
pub use ranking::{best, rank};
pub use reading::KEYS;
pub use refined_zero::MovedZero;
pub use relaxation::fit_relaxation;
pub use settings::{Bounds, FitSettings, Weighting};
pub use softened::{Softened, SofteningCycle};
pub use softening::fit_softening;
pub use softening_misfit::Base;
pub use terms::Terms;
pub use test_data::{FoundZero, Observation, StrainColumn, Test, TestData, Times};
pub use verdict::{Answer, Verdict};

#[cfg(test)]
mod quality_tests;
#[cfg(test)]
mod relaxation_tests;
#[cfg(test)]
mod softening_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod uncertainty_tests;
#[cfg(test)]
mod verdict_tests;
#[cfg(test)]
mod weighting_tests;
