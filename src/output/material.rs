//! The material of a study for machines.

use serde_json::{Map, Value, json};

use crate::material::Card;

/// A card: its law, every parameter with value and unit, its range and its text.
pub fn material_json(card: &Card) -> Value {
    let parameters = card.parameters.iter().map(|parameter| {
        let value = json!({ "value": parameter.value, "unit": parameter.unit() });
        (parameter.key.to_owned(), value)
    });
    let choices = card.choices.iter();
    let choices = choices.map(|(key, name)| ((*key).to_owned(), json!(name)));
    json!({
        "card": card.name,
        "law": card.law_name,
        "formula": card.formula,
        "parameters": parameters.chain(choices).collect::<Map<_, _>>(),
        "youngs_modulus_MPa": card.law.youngs_modulus(),
        "stretch_range": card.stretch_range,
        "text": card.text,
    })
}
