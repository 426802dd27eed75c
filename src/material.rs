//! Hyperelastic laws, the cards that hold their parameters, and the thin sheet made of them.
//!
//! A new law is one file that implements [`HyperelasticLaw`] and one line in [`registry`].

mod arruda_boyce;
pub mod card;
mod fung_demiray;
mod gent;
pub mod law;
mod marlow;
mod mooney_rivlin;
mod neo_hooke;
pub mod parameters;
mod polynomial;
pub mod registry;
pub mod sheet;
pub mod stability;
pub mod uniaxial;
mod veronda_westmann;
mod yeoh;

#[cfg(test)]
mod battery;

pub use arruda_boyce::ArrudaBoyce;
pub use card::Card;
pub use fung_demiray::FungDemiray;
pub use gent::Gent;
pub use law::{EnergyDerivatives, HyperelasticLaw, Invariants};
pub use marlow::MarlowExponential;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hooke::NeoHooke;
pub use polynomial::Polynomial;
pub use veronda_westmann::VerondaWestmann;
pub use yeoh::Yeoh;
