//! A card of what is known of a material: moduli, and parameters by their names, here or in another code.
//!
//! The energy of a law is linear in its parameters that are stresses, so that one of them, unstated, follows from the shear
//! modulus at rest; Poisson's ratio or the bulk modulus follow in closed form ([`Moduli`]).

use super::Card;
use super::parameters::Parameter;
use super::registry::{Law, MARLOW_TABLE, SWELLING};
use super::volume::{LARGEST_POISSON_RATIO, VolumeEnergy};
use crate::error::{Diagnostic, Error, nearest};
use crate::units::{self, Dimension};

mod codes;
mod draft;
mod moduli;
#[cfg(test)]
mod tests;

use draft::Draft;
pub use moduli::Moduli;
use moduli::SmallStrainModuli;

/// The name of the card in messages, which is not written yet.
const CARD: &str = "the card";

/// What is known of a material.
#[derive(Clone, Debug)]
pub struct Known {
    /// Its law.
    pub law: &'static Law,
    /// Its moduli at small strain.
    pub moduli: Moduli,
    /// Parameters of the law by their keys, as a card states them: `c10`, `0.05 MPa`.
    pub parameters: Vec<(String, String)>,
    /// The factor of Ogden's law, as a card states it.
    pub convention: Option<String>,
    /// The energy of a change of volume; that of cards which do not state it, if `None`.
    pub volume_energy: Option<VolumeEnergy>,
    /// Mass density, as a card states it.
    pub density: Option<String>,
}

impl Known {
    /// A law of which nothing is known yet.
    pub fn of(law: &'static Law) -> Self {
        Self {
            law,
            moduli: Moduli::default(),
            parameters: Vec::new(),
            convention: None,
            volume_energy: None,
            density: None,
        }
    }

    /// The card's text with the title `title`.
    ///
    /// # Errors
    /// [`Error::Input`] with what is missing, contradicts, or is no parameter of the law.
    pub fn card_text(&self, title: &str) -> Result<String, Error> {
        let draft = self.draft(title)?;
        let text = draft.text();
        Card::parse(CARD, CARD, &text).map_err(of_options)?;
        Ok(text)
    }

    /// The card, with the parameter that follows from the moduli.
    fn draft(&self, title: &str) -> Result<Draft, Error> {
        let (_, entries) = self.law.unknown();
        let choices = entries.choices.iter().map(|(key, _)| *key);
        self.check_keys(entries.parameters.iter().map(|one| one.key).chain(choices))?;
        if self.law.name == MARLOW_TABLE {
            let hint = "fit it to a file: gelbench materials fit DATA.csv --law marlow-table";
            return Err(Error::input(
                "the law marlow-table is a measured curve",
                hint,
            ));
        }
        let of_parameters = self.ratio_of_parameters(&entries.parameters)?;
        let moduli = Moduli {
            poisson_ratio: self.moduli.poisson_ratio.or(of_parameters),
            ..self.moduli
        };
        let moduli = moduli.solved()?;
        let has_convention = entries.choices.iter().any(|(key, _)| *key == "convention");
        let convention = has_convention.then(|| self.stated_convention(&entries.parameters));
        let mut draft = Draft {
            law: self.law,
            title: title.to_owned(),
            density: self.density.clone(),
            parameters: self.parameters.clone(),
            convention: convention.transpose()?,
            computed: Vec::new(),
            volume: None,
            volume_energy: self.volume_energy,
        };
        self.of_volume(&moduli, &entries.parameters, &mut draft)?;
        if let Some(shear) = moduli.shear {
            self.of_shear_modulus(shear, &entries.parameters, &mut draft)?;
        }
        Ok(draft)
    }

    /// Refuses parameters that the law does not have, or that are stated twice.
    fn check_keys(&self, known: impl Iterator<Item = &'static str>) -> Result<(), Error> {
        let known: Vec<&str> = known.collect();
        for (index, (key, _)) in self.parameters.iter().enumerate() {
            if self.parameters[..index]
                .iter()
                .any(|(other, _)| other == key)
            {
                return Err(Error::input(
                    format!("{key} is stated twice"),
                    "leave one out",
                ));
            }
            if known.contains(&&**key) {
                continue;
            }
            let hint = match nearest(key, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("it has {}", known.join(", ")),
            };
            let law = self.law.name;
            return Err(Error::input(
                format!("the law {law} has no parameter {key}"),
                hint,
            ));
        }
        Ok(())
    }

    /// Poisson's ratio among the law's own parameters, which Young's modulus alone needs.
    fn ratio_of_parameters(&self, parameters: &[Parameter]) -> Result<Option<f64>, Error> {
        if !self.moduli.is_young_alone() {
            return Ok(None);
        }
        let keys = parameters.iter().filter(|one| is_ratio(one));
        let keys: Vec<&str> = keys.map(|one| one.key).collect();
        let stated = self.parameters.iter();
        let stated = stated.filter(|(key, _)| keys.contains(&&**key));
        let values: Vec<Option<f64>> = stated
            .map(|(_, value)| units::parse(value, Dimension::Ratio).ok())
            .collect();
        if values.len() < keys.len() || values.is_empty() {
            return Ok(None);
        }
        if values.iter().any(|value| *value != values[0]) {
            let message = format!(
                "Young's modulus does not determine the parameters of {} with several Poisson's ratios",
                self.law.name
            );
            return Err(Error::input(message, "state the shear modulus instead"));
        }
        Ok(values[0])
    }

    fn states(&self, key: &str) -> bool {
        self.parameters.iter().any(|(known, _)| known == key)
    }

    /// The factor of Ogden's law: it has to be stated where a μᵢ is.
    fn stated_convention(&self, parameters: &[Parameter]) -> Result<String, Error> {
        let key = "convention";
        let stated = self.parameters.iter().find(|(known, _)| known == key);
        let stated = stated.map(|(_, name)| name).or(self.convention.as_ref());
        let needs_one = parameters
            .iter()
            .any(|one| one.is_stress() && self.states(one.key));
        match stated {
            Some(name) => Ok(name.clone()),
            None if needs_one => Err(Error::input(
                "the factor before the sums of Ogden's law is not stated",
                "add --convention: 2mu/alpha^2 (Abaqus, CalculiX), mu/alpha (Ogden, Ansys) or mu/alpha^2 (FEBio)",
            )),
            None => Ok("2mu/alpha^2".to_owned()),
        }
    }

    /// Adds the resistance to a change of volume: to the law's own parameters, or as `[volume]`.
    fn of_volume(
        &self,
        moduli: &SmallStrainModuli,
        parameters: &[Parameter],
        draft: &mut Draft,
    ) -> Result<(), Error> {
        let name = self.law.name;
        let unstated = |one: &&Parameter| is_ratio(one) && !self.states(one.key);
        let ratios: Vec<_> = parameters
            .iter()
            .filter(unstated)
            .map(|one| one.key)
            .collect();
        let changes_volume = parameters.iter().any(is_ratio);
        match (changes_volume, moduli.poisson_ratio) {
            (true, Some(0.5)) => Err(Error::input(
                format!(
                    "the law {name} changes its volume, and a Poisson's ratio of 0.5 allows none"
                ),
                format!(
                    "take at most {LARGEST_POISSON_RATIO}, or an incompressible law such as neo-hooke"
                ),
            )),
            (true, Some(_)) if ratios.is_empty() && self.moduli.is_young_alone() => Ok(()),
            (true, Some(_)) if ratios.is_empty() => Err(Error::input(
                "Poisson's ratio is stated twice",
                "state it as a modulus or as a parameter of the law",
            )),
            (true, Some(ratio)) => {
                let ratios = ratios.into_iter().map(|key| (key, ratio.to_string()));
                draft.computed.extend(ratios);
                Ok(())
            }
            (true, None) if !ratios.is_empty() && !moduli.is_empty() => Err(Error::input(
                format!("the law {name} changes its volume, and its Poisson's ratio is not stated"),
                "add --poisson, such as --poisson 0.45, or --bulk-modulus",
            )),
            (true, None) => Ok(()),
            (false, ratio) => {
                draft.volume = match (moduli.bulk, ratio) {
                    (Some(bulk), _) => Some(("bulk_modulus", format!("\"{bulk} MPa\""))),
                    (None, Some(0.5) | None) => None,
                    (None, Some(ratio)) => Some(("poisson_ratio", ratio.to_string())),
                };
                Ok(())
            }
        }
    }

    /// Adds the parameter that the shear modulus in MPa determines.
    ///
    /// ```text
    /// μ₀(x) = μ₀(0) + x dμ₀/dx,   x = (μ − μ₀(0))/(dμ₀/dx)                                [MPa]
    /// ```
    fn of_shear_modulus(
        &self,
        shear: f64,
        parameters: &[Parameter],
        draft: &mut Draft,
    ) -> Result<(), Error> {
        let key = self.unstated_stress(parameters, draft)?;
        let modulus = |value: f64| {
            let text = draft.with(key, value).text();
            let card = Card::parse(CARD, CARD, &text).map_err(of_options)?;
            Ok::<f64, Error>(card.law.shear_modulus())
        };
        let [one, two] = [modulus(shear)?, modulus(2.0 * shear)?];
        let (at_zero, slope) = (2.0 * one - two, (two - one) / shear);
        if slope.abs() < 1e-9 {
            let message =
                format!("the modulus at rest does not depend on {key}, which is not stated");
            let hint = format!("add --parameter {key}=\"… MPa\"");
            return Err(Error::input(message, hint));
        }
        *draft = draft.with(key, (shear - at_zero) / slope);
        Ok(())
    }

    /// The one parameter that is a stress and neither stated nor computed.
    fn unstated_stress(
        &self,
        parameters: &[Parameter],
        draft: &Draft,
    ) -> Result<&'static str, Error> {
        let name = self.law.name;
        let (law, _) = self.law.unknown();
        let fault = |message: String, hint: String| Err(Error::input(message, hint));
        if !law.is_isotropic() || name == SWELLING {
            return fault(
                format!("the parameters of the law {name} do not follow from its moduli"),
                format!(
                    "state them: --parameter KEY=VALUE; `gelbench keys card` lists those of {name}"
                ),
            );
        }
        let unstated = |one: &&Parameter| {
            let computed = draft.computed.iter().any(|(key, _)| *key == one.key);
            !self.states(one.key) && !computed
        };
        let unstated = parameters.iter().filter(unstated);
        let (stresses, others): (Vec<&Parameter>, Vec<&Parameter>) =
            unstated.partition(|one| one.is_stress());
        match (&stresses[..], &others[..]) {
            (_, [first, ..]) => fault(
                format!("the law {name} needs {} too", keys(&others)),
                format!("add --parameter {}=…", first.key),
            ),
            ([one], []) => Ok(one.key),
            ([], []) => fault(
                format!(
                    "all parameters of {name} are stated, and a modulus that follows from them"
                ),
                "leave out the modulus, or one of the parameters that are stresses".to_owned(),
            ),
            ([_, .., last], []) => fault(
                format!(
                    "one modulus does not determine {} of {name}",
                    keys(&stresses)
                ),
                format!(
                    "state all but one of them, such as --parameter {}=\"… MPa\"",
                    last.key
                ),
            ),
        }
    }
}

/// Whether a parameter is a Poisson's ratio.
fn is_ratio(one: &Parameter) -> bool {
    one.key == "poisson_ratio" || one.key.starts_with("nu_")
}

fn keys(of: &[&Parameter]) -> String {
    let keys: Vec<&str> = of.iter().map(|one| one.key).collect();
    keys.join(", ")
}

/// Faults of a card that is not written yet, in the words of the options.
fn of_options(error: Error) -> Error {
    error.map_faults(|fault| {
        let key = match fault.key.split_once('.') {
            Some(("parameters", key)) => format!("--parameter {key}"),
            Some(("volume", "poisson_ratio")) => "--poisson".to_owned(),
            Some(("volume", _)) => "--bulk-modulus".to_owned(),
            _ => format!("--{}", fault.key),
        };
        let hint = match (fault.key.strip_prefix("parameters."), &*fault.message) {
            (Some(key), "is missing") => Some(format!("add --parameter {key}=…")),
            _ => fault.hint,
        };
        Diagnostic {
            key,
            position: None,
            hint,
            ..fault
        }
    })
}
