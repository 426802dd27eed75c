//! From measured curves to a material card: reading of test data, least squares, and how far a fit can
//! be trusted.
//!
//! ```text
//! table ─data─▶ TestData ─▶ Response ─regression─▶ Solution ─trust─▶ Quality ─▶ Fit: card, picture, JSON
//!                            a law alone; with a Prony series; with softening
//! ```

mod card_text;
mod data;
mod fit;
mod fitted;
mod group;
mod least_squares;
mod mounted;
mod nearest;
mod protocols;
mod ranking;
mod regression;
mod relaxation;
mod settings;
mod softened;
mod softening;
mod solution;
#[cfg(test)]
mod tests;
mod trust;

pub use card_text::{Provenance, card_text};
pub use data::{
    ColumnReading, Conversion, FoundZero, KEYS, Mounted, Mounting, Observation, PRECONDITIONED,
    RestState, StrainColumn, TableReading, Test, TestData, Times, refuse_repeated,
};
pub use fit::{Memory, fit};
pub use fitted::{Fit, FurtherProtocol, MountedFit, Protocols, Relaxed};
pub use group::{Group, GroupState};
pub use ranking::{Criterion, best, rank};
pub use regression::{MovedZero, Zero};
pub use relaxation::{Terms, fit_relaxation};
pub use settings::{Bounds, FitSettings, Weighting};
pub use softened::{Softened, SofteningCycle};
pub use softening::{Base, fit_softening};
pub use trust::{Answer, Quality, StableRange, Verdict};
