//! A law some of whose parameters are found with the field.

use std::sync::Arc;

use crate::error::{Diagnostic, suggestion};
use crate::material::parameters::{Parameter, StrainMeasure, StressMeasure};
use crate::material::registry::Law;
use crate::material::sheet::{Gradient, Kinematics};
use crate::material::{Card, HyperelasticLaw, Volume};

/// The law of a card with parameters to be found.
#[derive(Clone, Debug)]
pub struct RegressedLaw {
    law: &'static Law,
    measures: (StressMeasure, StrainMeasure),
    volume: Option<Volume>,
    values: Vec<f64>,
    chosen: Vec<Parameter>,
    places: Vec<usize>,
}

/// The parameters of a card that act on its law and are not zero.
fn acting(card: &Card, law: Option<&Law>) -> Vec<&'static str> {
    let values: Vec<f64> = card.parameters.iter().map(|one| one.value).collect();
    let entries = law.map(|law| {
        law.with_values(&values, card.stress_measure, card.strain_measure)
            .1
    });
    let parameters = entries.into_iter().flat_map(|entries| entries.parameters);
    parameters
        .filter(|one| one.value != 0.0)
        .map(|one| one.key)
        .collect()
}

/// What stands for all parameters of a card.
const ALL: &str = "all";

impl RegressedLaw {
    /// The parameters `keys` of a card, or all that are not zero where the only key is `all`; the search begins at the card's values.
    ///
    /// # Errors
    /// A [`Diagnostic`] when the law has no such parameter, one begins at zero, a key is given twice, none is given, or
    /// the law does not follow from the values of its parameters alone.
    pub fn of_card(card: &Card, keys: &[&str]) -> Result<Self, Diagnostic> {
        let fault = |message: String, hint: &str| Err(Diagnostic::error("", message).hint(hint));
        let known: Vec<&str> = card
            .parameters
            .iter()
            .map(|parameter| parameter.key)
            .collect();
        let mut places = Vec::new();
        let law = Law::named(&card.law_name);
        let own: Vec<&str> = match keys {
            [ALL] => acting(card, law),
            _ => keys.to_vec(),
        };
        for key in &own {
            let Some(place) = known.iter().position(|known| known == key) else {
                let message = format!("the card `{}` has no parameter `{key}`", card.name);
                return fault(message, &suggestion(key, &known, "its parameters are"));
            };
            if places.contains(&place) || card.parameters[place].value == 0.0 {
                let message = format!("the parameter `{key}` is given twice, or zero on the card");
                return fault(message, "name each once, with a first guess on the card");
            }
            places.push(place);
        }
        if places.is_empty() {
            return fault(
                "no parameter is to be found".into(),
                "name those to be found, or all",
            );
        }
        let all = law.map(|law| Self {
            law,
            measures: (card.stress_measure, card.strain_measure),
            volume: card.volume,
            values: card
                .parameters
                .iter()
                .map(|parameter| parameter.value)
                .collect(),
            chosen: places
                .iter()
                .map(|place| card.parameters[*place].clone())
                .collect(),
            places: places.clone(),
        });
        match all {
            Some(all) if all.is_law_of(card) => Ok(all),
            _ => fault(
                format!(
                    "the law of the card `{}` is more than its parameters",
                    card.name
                ),
                "take a card whose law is given by parameters alone",
            ),
        }
    }

    /// Whether the values make the card's law, at one state.
    fn is_law_of(&self, card: &Card) -> bool {
        let state = Kinematics::new(&Gradient::new(0.11, 0.03, -0.02, 0.05));
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

    /// The same with a search that begins at multiples of the card's values.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let values: Vec<f64> = self.start().iter().map(|value| factor * value).collect();
        self.beginning_at(&values)
    }

    /// The same with a search that begins at other values.
    #[must_use]
    pub fn beginning_at(&self, values: &[f64]) -> Self {
        let mut other = self.clone();
        for (parameter, value) in other.chosen.iter_mut().zip(values) {
            parameter.value = *value;
        }
        other
    }

    /// The same with stresses that are so many times as large; `None` where not all parameters that are stresses are to be found.
    pub fn with_stress_times(&self, factor: f64) -> Option<Self> {
        let (_, entries) = self
            .law
            .with_values(&self.values, self.measures.0, self.measures.1);
        let all = entries.parameters.iter().enumerate();
        let mut stresses = all.filter(|(_, parameter)| parameter.is_stress());
        if !stresses.all(|(place, _)| self.places.contains(&place)) {
            return None;
        }
        let values = self
            .chosen
            .iter()
            .map(|parameter| match parameter.is_stress() {
                true => factor * parameter.value,
                false => parameter.value,
            });
        Some(self.beginning_at(&values.collect::<Vec<_>>()))
    }

    /// The law with other values.
    pub fn at(&self, values: &[f64]) -> Arc<dyn HyperelasticLaw> {
        let mut all = self.values.clone();
        for (place, value) in self.places.iter().zip(values) {
            all[*place] = *value;
        }
        let (law, _) = self.law.with_values(&all, self.measures.0, self.measures.1);
        let law: Arc<dyn HyperelasticLaw> = Arc::from(law);
        let resisting = self.volume.and_then(|volume| volume.of(Arc::clone(&law)));
        resisting.unwrap_or(law)
    }
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
        let told = |name: &str, keys: &[&str]| {
            RegressedLaw::of_card(&card(name), keys)
                .unwrap_err()
                .to_string()
        };
        assert!(told("neo-hooke", &["c1"]).contains("did you mean `c10`"));
        assert!(told("neo-hooke", &[]).contains("name those"));
        assert!(told("neo-hooke", &["c10", "c10"]).contains("twice"));
        let all = RegressedLaw::of_card(&card("pva-10-cauchy"), &["all"]).unwrap();
        assert_eq!(
            all.parameters().len(),
            2,
            "a stress at rest does not act on the law"
        );
        let pva = RegressedLaw::of_card(&card("pva-10-cauchy"), &["amplitude", "exponent"]);
        assert_eq!(pva.unwrap().start().len(), 2);
    }
}
