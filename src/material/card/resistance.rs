//! What a card says of changes of volume.

use std::sync::Arc;

use super::Card;
use crate::document::{Bound, Section};
use crate::material::sheet::PlaneState;
use crate::material::volume::{POISSON_RATIO, Volume, VolumeEnergy, bulk_modulus};
use crate::units::Dimension;

/// The law of gels in contact with their solvent.
const SWELLING: &str = "flory-rehner";

impl Card {
    /// Reads how the material resists a change of volume.
    pub(super) fn resist(&mut self, section: &Section) {
        let (bulk, ratio) = ("bulk_modulus", "poisson_ratio");
        let bulk_modulus = match (section.has(bulk), section.has(ratio)) {
            (false, true) => {
                let stated = section.number(ratio, POISSON_RATIO);
                self.poisson_ratio = Some(stated);
                bulk_modulus(self.law.shear_modulus(), stated)
            }
            (true, true) => {
                let hint = "each follows from the other and from the law's shear modulus";
                section.fault(
                    ratio,
                    "and `bulk_modulus` are both given; one of them is enough",
                    hint,
                );
                f64::NAN
            }
            (_, false) => section.quantity(bulk, Dimension::Stress, Bound::Positive),
        };
        let energy = match section.has("energy") {
            true => section.choice("energy", &VolumeEnergy::NAMES),
            false => None,
        };
        section.unknown_keys();
        let volume = Volume {
            bulk_modulus,
            energy: energy.unwrap_or_default(),
            plane: PlaneState::Stress,
        };
        let own = self.law.bulk_modulus().is_some();
        match Arc::clone(&self.law).with_volume(volume) {
            Some(law) => (self.law, self.volume) = (law, Some(volume)),
            None if own => section.fault(
                bulk,
                &format!("the law `{}` has a change of volume of its own", self.law_name),
                "leave out `[volume]`: the law's parameters say how it changes its volume",
            ),
            None => section.fault(
                bulk,
                &format!("the law `{}` cannot take a change of volume", self.law_name),
                "take an isotropic law: neo-hooke, mooney-rivlin, yeoh, ogden, gent and others; laws with fibres keep their volume",
            ),
        }
    }

    /// The initial bulk modulus in MPa; `None` where the material keeps its volume.
    pub fn bulk_modulus(&self) -> Option<f64> {
        let stated = self.volume.map(|volume| volume.bulk_modulus);
        stated.or_else(|| self.law.bulk_modulus())
    }

    /// What the sheet is in words: `an incompressible material in plane stress`.
    pub fn describe_sheet(&self) -> String {
        let material = match (self.law_name == SWELLING, self.bulk_modulus()) {
            (true, _) => "a gel that takes up and gives off solvent".to_owned(),
            (false, None) => "an incompressible material".to_owned(),
            (false, Some(modulus)) => {
                format!("a material that changes its volume (bulk modulus κ = {modulus:.4} MPa)")
            }
        };
        let plane = match self.law.plane_state() {
            PlaneState::Stress => "plane stress",
            PlaneState::Strain => "plane strain",
        };
        let softens = match self.law.softening() {
            Some(_) => ", which softens by its largest load",
            None => "",
        };
        format!("{material} in {plane}{softens}")
    }

    /// The title of a study of this material that gives none: what is studied and the card's title.
    pub fn title_of(&self, what: &str) -> String {
        let words: Vec<&str> = self.title.split_whitespace().collect();
        format!("{what} of {}", words.join(" "))
    }

    /// The same material in plane strain; `None` where its card states no resistance to a change of volume.
    pub fn in_plane_strain(self) -> Option<Self> {
        Some(Self {
            law: self.law.in_plane_strain()?,
            volume: self.volume.map(Volume::in_plane_strain),
            ..self
        })
    }
}
