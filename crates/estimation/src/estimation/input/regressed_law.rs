//! A law with some parameters that are found with the field, or whose uncertainty a card records.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::document::Bound;
use crate::error::{Diagnostic, suggestion};
use crate::material::parameters::{Parameter, StrainMeasure, StressMeasure};
use crate::material::registry::Law;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::material::volume::{self, bulk_modulus};
use crate::material::{Card, HyperelasticLaw, PlaneState, Volume};
use crate::units::Dimension;

/// The law of a card with parameters to be found. The resistance to a change of volume is one of them where the card
/// has it: its bulk modulus or its Poisson's ratio, whichever the card states; the other one follows.
#[derive(Clone, Debug)]
pub struct RegressedLaw {
    law: &'static Law,
    measures: (StressMeasure, StrainMeasure),
    volume: Option<Volume>,
    plane: PlaneState,
    all: Vec<Parameter>,
    chosen: Vec<Parameter>,
    positions: Vec<usize>,
}

/// A law with one parameter a little smaller and a little larger, and the difference of both values.
pub type Neighbours = ([Arc<dyn HyperelasticLaw>; 2], f64);

/// The key that stands for all parameters of a card.
const ALL: &str = "all";

/// The keys of the resistance to a change of volume.
const BULK_MODULUS: &str = "bulk_modulus";
const POISSON_RATIO: &str = "poisson_ratio";

impl RegressedLaw {
    /// The parameters `keys` of a card, or all that act on its law and are not zero where the only key is `all`; the search begins at
    /// the card's values.
    ///
    /// # Errors
    /// A [`Diagnostic`] when the law has no such parameter, one begins at zero, a key is given twice, none is given, or
    /// the law does not follow from the values of its parameters alone.
    pub fn of_card(card: &Card, keys: &[&str]) -> Result<Self, Diagnostic> {
        let fault = |message: String, hint: &str| Err(Diagnostic::error("", message).hint(hint));
        let mut law = Self {
            law: Law::of_card(&card.law_name, &card.choices).ok_or_else(|| undefined(card))?,
            measures: (card.stress_measure, card.strain_measure),
            volume: card.volume,
            plane: card.law.plane_state(),
            all: card
                .parameters
                .iter()
                .cloned()
                .chain(resistance(card))
                .collect(),
            chosen: Vec::new(),
            positions: Vec::new(),
        };
        let known: Vec<&str> = law.all.iter().map(|parameter| parameter.key).collect();
        let names: Vec<&str> = match keys {
            [ALL] => law.acting(),
            _ => keys.to_vec(),
        };
        for key in &names {
            let Some(position) = known.iter().position(|known| known == key) else {
                let message = format!("the card `{}` has no parameter `{key}`", card.name);
                return fault(message, &suggestion(key, &known, "its parameters are"));
            };
            if law.positions.contains(&position) || law.all[position].value == 0.0 {
                let message = format!("the parameter `{key}` is given twice, or zero on the card");
                return fault(
                    message,
                    "name each once, with a non-zero initial value on the card",
                );
            }
            law.positions.push(position);
            law.chosen.push(law.all[position].clone());
        }
        if law.positions.is_empty() {
            let hint = "name those to be estimated, or all";
            return fault("no parameter is to be estimated".into(), hint);
        }
        if law.is_law_of(card) {
            Ok(law)
        } else {
            Err(undefined(card))
        }
    }

    /// The keys of the parameters that act on the law and are not zero.
    pub fn acting(&self) -> Vec<&'static str> {
        let resistance = self.all.last().filter(|_| self.volume.is_some()).cloned();
        let acting = self.law_parameters().into_iter().chain(resistance);
        acting
            .filter(|one| one.value != 0.0)
            .map(|one| one.key)
            .collect()
    }

    /// The parameters that the law asks for, in its order.
    fn law_parameters(&self) -> Vec<Parameter> {
        let values: Vec<f64> = self.all.iter().map(|one| one.value).collect();
        self.law
            .with_values(&values, self.measures.0, self.measures.1)
            .1
            .parameters
    }

    /// Whether the values give the card's law, checked at one state.
    fn is_law_of(&self, card: &Card) -> bool {
        let state = Kinematics::new(&PlaneTensor::new(0.11, 0.03, -0.02, 0.05));
        let stress = |law: &dyn HyperelasticLaw| state.map(|state| law.stress(&state).1);
        match (stress(&*card.law), stress(&*self.at(&self.start()))) {
            (Ok(a), Ok(b)) => (a - b).norm() <= 1e-12 * a.norm(),
            _ => false,
        }
    }

    /// The parameters with their values on the card.
    pub fn parameters(&self) -> &[Parameter] {
        &self.chosen
    }

    /// The values on the card.
    pub fn start(&self) -> Vec<f64> {
        self.chosen
            .iter()
            .map(|parameter| parameter.value)
            .collect()
    }

    /// The same law with a search that begins at multiples of the card's values.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let values: Vec<f64> = self.start().iter().map(|value| factor * value).collect();
        self.beginning_at(&values)
    }

    /// The same law with a search that begins at other values.
    #[must_use]
    pub fn beginning_at(&self, values: &[f64]) -> Self {
        let mut other = self.clone();
        for (parameter, value) in other.chosen.iter_mut().zip(values) {
            parameter.value = *value;
        }
        other
    }

    /// The same law with stresses multiplied by a factor; `None` unless all parameters that are stresses are to be found.
    pub fn with_stress_times(&self, factor: f64) -> Option<Self> {
        let mut stresses = self
            .law_parameters()
            .into_iter()
            .filter(Parameter::is_stress);
        if !stresses.all(|one| self.chosen.iter().any(|chosen| chosen.key == one.key)) {
            return None;
        }
        let values = self.chosen.iter().map(|parameter| {
            if parameter.is_stress() {
                factor * parameter.value
            } else {
                parameter.value
            }
        });
        Some(self.beginning_at(&values.collect::<Vec<_>>()))
    }

    /// For each of the parameters the laws with a little smaller and a little larger value.
    pub fn neighbours(&self, values: &[f64]) -> Vec<Neighbours> {
        const STEP: f64 = 1e-5;
        let pair = |index: usize| {
            let step = STEP * values[index].abs();
            let moved = [-step, step].map(|step| {
                let mut moved = values.to_vec();
                moved[index] += step;
                self.at(&moved)
            });
            (moved, 2.0 * step)
        };
        (0..values.len()).map(pair).collect()
    }

    /// The law with other values.
    pub fn at(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw> {
        let mut all: Vec<f64> = self.all.iter().map(|one| one.value).collect();
        for (position, value) in self.positions.iter().zip(values) {
            all[*position] = *value;
        }
        let (law, _) = self.law.with_values(&all, self.measures.0, self.measures.1);
        let law: Arc<dyn HyperelasticLaw> = Arc::from(law);
        let resisting = self.volume.zip(self.all.last()).and_then(|(volume, last)| {
            let stated = all[all.len() - 1];
            let bulk_modulus = match last.key {
                POISSON_RATIO => bulk_modulus(law.shear_modulus(), stated),
                _ => stated,
            };
            let volume = Volume {
                bulk_modulus,
                ..volume
            };
            Arc::clone(&law).with_volume(volume)
        });
        match self.plane {
            PlaneState::Strain if resisting.is_none() => law.in_plane_strain().unwrap_or(law),
            _ => resisting.unwrap_or(law),
        }
    }
}

/// Parameters of a law with their covariance.
#[derive(Clone, Debug)]
pub struct UncertainLaw {
    law: RegressedLaw,
    covariance: DMatrix<f64>,
}

impl UncertainLaw {
    /// That of a card; `None` where it records none of its parameters' uncertainty, or its law is not defined by them.
    pub fn of_card(card: &Card) -> Option<Self> {
        let recorded = card.fit.as_ref()?.uncertainty.as_ref()?;
        let keys: Vec<&str> = recorded.keys.iter().map(String::as_str).collect();
        Some(Self {
            law: RegressedLaw::of_card(card, &keys).ok()?,
            covariance: recorded.covariance.clone(),
        })
    }

    /// The covariance of its parameters in internal units.
    pub(in crate::estimation) fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// The laws about that of the card, a pair for each parameter.
    pub(in crate::estimation) fn neighbours(&self) -> Vec<Neighbours> {
        self.law.neighbours(&self.law.start())
    }
}

/// The refusal of a card whose law needs more than its parameters.
fn undefined(card: &Card) -> Diagnostic {
    let message = format!(
        "the law of the card `{}` is not defined by its parameters alone",
        card.name
    );
    let hint = "use a card whose law is given by parameters alone";
    Diagnostic::error("", message).hint(hint)
}

/// The resistance to a change of volume, as the card states it.
fn resistance(card: &Card) -> Option<Parameter> {
    let volume = card.volume?;
    Some(match card.poisson_ratio {
        Some(value) => Parameter {
            key: POISSON_RATIO,
            value,
            dimension: Dimension::Ratio,
            bound: volume::POISSON_RATIO,
            usual: [0.0, 0.5],
        },
        None => Parameter {
            key: BULK_MODULUS,
            value: volume.bulk_modulus,
            dimension: Dimension::Stress,
            bound: Bound::Positive,
            usual: [f64::NAN; 2],
        },
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn parameters_are_those_of_the_card() {
        let card = |name: &str| Card::load(name, Path::new(".")).unwrap();
        let yeoh = RegressedLaw::of_card(&card("meunier-yeoh"), &["c20", "c10"]).unwrap();
        assert_eq!(yeoh.parameters()[1].key, "c10");
        let doubled: Vec<f64> = yeoh.start().iter().map(|value| 2.0 * value).collect();
        let slope = yeoh.at(&doubled).youngs_modulus() / yeoh.at(&yeoh.start()).youngs_modulus();
        assert!((slope - 2.0).abs() < 1e-9);
        let message = |name: &str, keys: &[&str]| {
            RegressedLaw::of_card(&card(name), keys)
                .unwrap_err()
                .to_string()
        };
        assert!(message("neo-hooke", &["c1"]).contains("did you mean `c10`"));
        assert!(message("neo-hooke", &[]).contains("name those"));
        assert!(message("neo-hooke", &["c10", "c10"]).contains("twice"));
        let all = RegressedLaw::of_card(&card("pva-10-cauchy"), &["all"]).unwrap();
        assert_eq!(
            all.parameters().len(),
            2,
            "a stress at rest does not act on the law"
        );
        let pva = RegressedLaw::of_card(&card("pva-10-cauchy"), &["amplitude", "exponent"]);
        assert_eq!(pva.unwrap().start().len(), 2);
    }

    #[test]
    fn a_stated_poissons_ratio_stays_while_the_stiffness_changes() {
        let text = Card::load("neo-hooke", Path::new(".")).unwrap().text;
        let fitted = |stated: &str, keys: &[&str], values: &[f64]| {
            let text = text.replace("[data]", &format!("[volume]\n{stated}\n[data]"));
            let card = Card::parse("own", "own.toml", &text).unwrap();
            RegressedLaw::of_card(&card, keys).unwrap().at(values)
        };
        let ratio =
            |law: &dyn HyperelasticLaw| law.youngs_modulus() / (2.0 * law.shear_modulus()) - 1.0;
        let softer = fitted("poisson_ratio = 0.3", &["c10"], &[0.01]);
        assert!((ratio(&*softer) - 0.3).abs() < 1e-9);
        let both = fitted("poisson_ratio = 0.3", &["all"], &[0.01, 0.2]);
        assert!((ratio(&*both) - 0.2).abs() < 1e-9);
        let modulus = fitted("bulk_modulus = \"0.04 MPa\"", &["all"], &[0.01, 0.02]);
        let expected = (3.0 * 0.02 - 2.0 * 0.02) / (2.0 * (3.0 * 0.02 + 0.02));
        assert!((ratio(&*modulus) - expected).abs() < 1e-9);
    }
}
