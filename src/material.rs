//! Hyperelastic laws, the cards that hold their parameters, and the thin sheet made of them.
//!
//! A new law is one file that implements [`HyperelasticLaw`] and one line in [`registry`].

pub mod card;
pub mod law;
mod marlow;
mod mooney_rivlin;
mod neo_hooke;
pub mod parameters;
pub mod registry;
pub mod sheet;
pub mod uniaxial;

#[cfg(test)]
mod battery;

pub use card::Card;
pub use law::{EnergyDerivatives, HyperelasticLaw, Invariants};
pub use marlow::MarlowExponential;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hooke::NeoHooke;
