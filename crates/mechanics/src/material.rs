//! Hyperelastic laws, the cards with their parameters, and the thin sheet made of them.
//!
//! A new law is one file and one entry in [`registry`]. The file implements [`InvariantLaw`], [`AnisotropicLaw`] for
//! a sheet with directions, [`BodyLaw`] for a body that changes its volume, or [`HyperelasticLaw`] for any other law.

mod anisotropic_law;
mod arruda_boyce;
pub mod body;
pub mod card;
pub mod code;
mod compressible_neo_hooke;
pub mod curve;
mod energy;
mod exponential;
mod expression;
mod flory;
mod fung;
mod fung_demiray;
mod gent;
mod holzapfel_gasser_ogden;
mod holzapfel_ogden;
mod invariant_law;
pub mod invariants;
mod jet;
pub mod known;
pub mod law;
mod lee_sacks;
mod linear_elastic;
mod logarithm;
pub mod marlow;
mod may_newman;
mod measures;
mod monotone_cubic;
mod mooney_rivlin;
mod neo_hooke;
pub mod network;
mod ogden;
mod ogden_hill;
pub mod parameters;
mod polynomial;
pub mod prestretched;
pub mod registry;
mod saint_venant_kirchhoff;
pub mod samples;
pub mod scalar_function;
pub mod sheet;
pub mod softened_law;
pub mod softening;
pub mod stability;
mod veronda_westmann;
pub mod viscosity;
pub mod volume;
mod yeoh;

#[cfg(test)]
mod battery;

pub use anisotropic_law::{AnisotropicLaw, AnisotropicSheet};
pub use arruda_boyce::ArrudaBoyce;
pub use body::{BodyDerivatives, BodyLaw, BodySheet, BodyStretches};
pub use card::{Card, ParameterUncertainty};
pub use code::{Code, CodeLaw};
pub use compressible_neo_hooke::CompressibleNeoHooke;
pub use fung::Fung;
pub use fung_demiray::FungDemiray;
pub use gent::Gent;
pub use holzapfel_gasser_ogden::HolzapfelGasserOgden;
pub use holzapfel_ogden::HolzapfelOgden;
pub use invariant_law::InvariantLaw;
pub use invariants::{EnergyDerivatives, Invariants};
pub use jet::Jet;
pub use known::{Known, Moduli};
pub use law::HyperelasticLaw;
pub use lee_sacks::LeeSacks;
pub use linear_elastic::LinearElastic;
pub use may_newman::MayNewman;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hooke::NeoHooke;
pub use network::Network;
pub use ogden::Ogden;
pub use ogden_hill::{FoamTerm, OgdenHill};
pub use polynomial::Polynomial;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use sheet::PlaneState;
pub use softened_law::SoftenedLaw;
pub use softening::Softening;
pub use veronda_westmann::VerondaWestmann;
pub use volume::{SmallStrain, Volume, VolumeEnergy};
pub use yeoh::Yeoh;
