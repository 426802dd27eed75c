//! From measured curves to a material card: reading of test data, least squares, and how far a fit can
//! be trusted.
//!
//! ```text
//! table ─data─▶ TestData ─regression─▶ parameters ─trust─▶ Quality ─▶ Fit: card, picture, JSON
//! ```

mod card_text;
mod data;
mod fit;
mod least_squares;
mod ranking;
mod regression;
mod relaxation;
mod settings;
mod softened;
mod softening;
#[cfg(test)]
mod tests;
mod trust;

pub use card_text::{Provenance, card_text};
pub use data::{
    ColumnReading, Conversion, FoundZero, KEYS, Observation, PRECONDITIONED, StrainColumn,
    TableReading, Test, TestData, Times,
};
pub use fit::{Fit, Relaxed, fit};
pub use ranking::{best, rank};
pub use regression::MovedZero;
pub use relaxation::{Terms, fit_relaxation};
pub use settings::{Bounds, FitSettings, Weighting};
pub use softened::{Softened, SofteningCycle};
pub use softening::{Base, fit_softening};
pub use trust::{Answer, Quality, StableRange, Verdict};
