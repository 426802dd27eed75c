//! The material of a study, in words for the report and as data for programs.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::Block;
use crate::document::stored;
use crate::material::Card;
use crate::material::curve::Mode;
use crate::material::law::HyperelasticLaw;
use crate::material::stability::{SEARCHED, stable_range};

/// The description of a material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The description for readers.
    pub blocks: Vec<Block>,
    /// The description for programs.
    #[serde(with = "stored::json")]
    pub json: Value,
}

impl Material {
    /// The description of a sheet of several regions, each with its number, its name and its card; that of the cells of no region has the number 0.
    ///
    /// # Panics
    /// Without a region.
    pub fn of_regions(regions: &[(usize, &str, &Card)]) -> Self {
        let rows = regions.iter().map(|(number, name, card)| {
            let title = format!("{}: {}", card.law_name, card.formula);
            vec![
                number.to_string(),
                (*name).to_owned(),
                card.name.clone(),
                title,
            ]
        });
        let mut blocks = vec![
            Block::heading("Regions"),
            Block::table(&["number", "region", "card", "law"], rows),
        ];
        for (_, name, card) in regions {
            let heading = Block::heading(format!("Material of {name}"));
            blocks.push(heading);
            blocks.extend(statement(card).into_iter().skip(1));
        }
        let of_region = |(number, name, card): &(usize, &str, &Card)| json!({ "number": number, "name": name, "material": json(card) });
        let mut all = json(regions[0].2);
        all["regions"] = regions.iter().map(of_region).collect();
        Self { blocks, json: all }
    }
}

impl From<&Card> for Material {
    fn from(card: &Card) -> Self {
        Self {
            blocks: statement(card),
            json: json(card),
        }
    }
}

/// A card: its law, every parameter with value and unit, its range and its text.
fn json(card: &Card) -> Value {
    let parameters = card.parameters.iter().map(|parameter| {
        let value = json!({ "value": parameter.value, "unit": parameter.unit() });
        (parameter.key.to_owned(), value)
    });
    let choices = card.choices.iter();
    let choices = choices.map(|(key, name)| ((*key).to_owned(), json!(name)));
    json!({
        "card": card.name,
        "law": card.law_name,
        "formula": card.energy(),
        "parameters": parameters.chain(choices).collect::<Map<_, _>>(),
        "youngs_modulus_MPa": card.youngs_modulus(),
        "bulk_modulus_MPa": card.bulk_modulus(),
        "sheet": card.law.plane_state().name(),
        "stretch_range": card.range_is_stated.then_some(card.stretch_range),
        "fit_error_percent": card.fit_error_percent(),
        "text": card.text,
    })
}

/// The card of a study: law, parameters, measures, ranges, source.
fn statement(card: &Card) -> Vec<Block> {
    let law: &dyn HyperelasticLaw = &*card.law;
    let row = |key: &str, value: String| vec![key.to_owned(), value];
    let mut rows = vec![
        row("card", card.name.clone()),
        row("law", format!("{}: {}", card.law_name, card.energy())),
    ];
    let parameters = card.parameters.iter();
    rows.extend(parameters.map(|parameter| {
        let (value, unit) = (parameter.value, parameter.unit());
        row(parameter.key, format!("{value} {unit}"))
    }));
    rows.extend(
        card.choices
            .iter()
            .map(|(key, name)| row(key, name.clone())),
    );
    rows.extend(of_volume(card));
    let statements = law.statements().into_iter();
    rows.extend(statements.map(|(name, statement)| row(name, statement)));
    rows.extend([
        row(
            "initial Young's modulus E₀",
            format!("{:.6} MPa", card.youngs_modulus()),
        ),
        row("calibrated range", card.describe_range()),
        row(
            "measures",
            format!(
                "{} stress, {} strain; stress at rest: {}",
                card.stress_measure.name(),
                card.strain_measure.name(),
                card.offset.name()
            ),
        ),
        row("stable (Drucker)", stable(card)),
        row("specimen", card.specimen.clone()),
        row("source", card.citation.clone()),
    ]);
    for (key, value) in [("DOI", &card.doi), ("note", &card.note)] {
        rows.extend((!value.is_empty()).then(|| row(key, value.clone())));
    }
    vec![
        Block::Heading(2, "Material".into()),
        Block::table(&["property", "value"], rows),
    ]
}

/// What the card says of changes of volume, and what they make of tension.
fn of_volume(card: &Card) -> Vec<Vec<String>> {
    let row = |key: &str, value: String| vec![key.to_owned(), value];
    let mut rows = Vec::new();
    if let Some(modulus) = card.bulk_modulus() {
        let modulus = format!("{modulus:.6} MPa; {}", card.law.plane_state().name());
        rows.push(row("bulk modulus κ", modulus));
    }
    if let Some([stretch, change]) = card.tension_by_volume() {
        let percent = 100.0 * change;
        let effect = format!(
            "{percent:+.2} % at λ = {stretch:.3}, relative to the same parameters at constant volume"
        );
        rows.push(row(
            "largest effect of the volume change on the tension",
            effect,
        ));
    }
    rows
}

/// The stable stretches in the usual tests.
fn stable(card: &Card) -> String {
    let range = |(name, mode): (&str, Mode)| {
        let [low, high] = stable_range(&*card.law, mode);
        format!("{name} λ = {low:.3} … {high:.3}")
    };
    let [low, high] = SEARCHED;
    let ranges = Mode::ALL.map(range).join(", ");
    format!("{ranges}; looked for from {low} to {high}")
}
