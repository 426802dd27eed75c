//! A card's statements on changes of volume.

use std::sync::Arc;

use super::Card;
use crate::document::{Bound, Section};
use crate::material::curve::Mode;
use crate::material::registry::SWELLING;
use crate::material::sheet::PlaneState;
use crate::material::volume::{POISSON_RATIO, Volume, VolumeEnergy, bulk_modulus};
use crate::units::Dimension;

/// Stretches at which tension is compared.
const POINTS: u32 = 100;

impl Card {
    /// Reads the resistance to a change of volume.
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
        let energy = section.optional_choice("energy", &VolumeEnergy::NAMES);
        section.unknown_keys();
        let volume = Volume {
            bulk_modulus,
            energy: energy.unwrap_or_default(),
            plane: PlaneState::Stress,
        };
        let compressible = self.law.bulk_modulus().is_some();
        match Arc::clone(&self.law).with_volume(volume) {
            Some(law) => {
                let isochoric = std::mem::replace(&mut self.law, law);
                (self.isochoric, self.volume) = (Some(isochoric), Some(volume));
            }
            None if compressible => section.fault(
                bulk,
                &format!("the law `{}` is compressible by itself", self.law_name),
                "leave out `[volume]`: the law's parameters determine its change of volume",
            ),
            None => section.fault(
                bulk,
                &format!("the law `{}` has no compressible form", self.law_name),
                "take an isotropic law: neo-hooke, mooney-rivlin, yeoh, ogden, gent and others; laws with fibres are incompressible",
            ),
        }
    }

    /// The initial bulk modulus in MPa; `None` where the material keeps its volume.
    pub fn bulk_modulus(&self) -> Option<f64> {
        let stated = self.volume.map(|volume| volume.bulk_modulus);
        stated.or_else(|| self.law.bulk_modulus())
    }

    /// The initial Young's modulus in MPa, in plane strain too: E = 9 κ μ/(3 κ + μ); along the first axis where there are fibres.
    pub fn youngs_modulus(&self) -> f64 {
        match (self.law.plane_state(), self.law.bulk_modulus()) {
            (PlaneState::Strain, Some(bulk)) => {
                let shear = self.law.shear_modulus();
                9.0 * bulk * shear / (3.0 * bulk + shear)
            }
            _ => self.law.youngs_modulus(),
        }
    }

    /// The effect of the card's `[volume]` on uniaxial tension: the stretch within the range of the card at which the nominal stress
    /// differs most from that of the same parameters at constant volume, and the relative difference. `None` without a `[volume]`.
    ///
    /// Parameters and curves are mostly those of tests that were evaluated as if the volume were constant.
    pub fn tension_by_volume(&self) -> Option<[f64; 2]> {
        let isochoric = self.isochoric.as_ref()?;
        let volume = Volume {
            plane: PlaneState::Stress,
            ..self.volume?
        };
        let with_volume = Arc::clone(isochoric).with_volume(volume)?;
        let [low, high] = self.stretch_range;
        let stretches = (0..=POINTS).map(|i| low + (high - low) * f64::from(i) / f64::from(POINTS));
        let changes = stretches.filter_map(|stretch| {
            let [changed, kept] = [&with_volume, isochoric]
                .map(|law| Mode::Uniaxial.nominal_stress(&**law, stretch - 1.0));
            let change = changed / kept - 1.0;
            change.is_finite().then_some([stretch, change])
        });
        changes.max_by(|a, b| a[1].abs().total_cmp(&b[1].abs()))
    }

    /// Describes the sheet: `an incompressible material in plane stress`.
    pub fn describe_sheet(&self) -> String {
        let material = match (self.law_name == SWELLING, self.bulk_modulus()) {
            (true, _) => "a gel that exchanges solvent".to_owned(),
            (false, None) => "an incompressible material".to_owned(),
            (false, Some(modulus)) => {
                format!("a compressible material (bulk modulus κ = {modulus:.4} MPa)")
            }
        };
        let plane = match self.law.plane_state() {
            PlaneState::Stress => "plane stress",
            PlaneState::Strain => "plane strain",
        };
        let softens = match self.law.softening() {
            Some(_) => ", with Mullins softening",
            None => "",
        };
        format!("{material} in {plane}{softens}")
    }

    /// The title of a study of some materials that states none: the kind of study and the cards' titles, each once.
    pub fn title_of(what: &str, cards: &[Self]) -> String {
        let mut titles: Vec<String> = Vec::new();
        for card in cards {
            let words: Vec<&str> = card.title.split_whitespace().collect();
            let title = words.join(" ");
            if !titles.contains(&title) {
                titles.push(title);
            }
        }
        if titles.is_empty() {
            return what.to_owned();
        }
        format!("{what} of {}", titles.join(" and "))
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
