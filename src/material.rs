//! Hyperelastic laws, the cards that hold their parameters, and the thin sheet made of them.
//!
//! A new law is one file that implements [`InvariantLaw`], or [`HyperelasticLaw`] where it is no law of
//! invariants, and one entry in [`registry`].

mod arruda_boyce;
pub mod card;
pub mod code;
pub mod curve;
mod exponential;
mod fung_demiray;
mod gent;
mod holzapfel_gasser_ogden;
pub mod invariants;
pub mod law;
pub mod marlow;
mod mooney_rivlin;
mod neo_hooke;
mod ogden;
pub mod parameters;
mod polynomial;
pub mod registry;
pub mod samples;
pub mod scalar_function;
pub mod sheet;
pub mod stability;
mod veronda_westmann;
pub mod viscosity;
pub mod volume;
mod yeoh;

#[cfg(test)]
mod battery;

pub use arruda_boyce::ArrudaBoyce;
pub use card::Card;
pub use code::{Code, CodeLaw};
pub use fung_demiray::FungDemiray;
pub use gent::Gent;
pub use holzapfel_gasser_ogden::HolzapfelGasserOgden;
pub use invariants::{EnergyDerivatives, Invariants};
pub use law::{HyperelasticLaw, InvariantLaw};
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hooke::NeoHooke;
pub use ogden::Ogden;
pub use polynomial::Polynomial;
pub use sheet::PlaneState;
pub use veronda_westmann::VerondaWestmann;
pub use volume::{Volume, VolumetricSheet};
pub use yeoh::Yeoh;
