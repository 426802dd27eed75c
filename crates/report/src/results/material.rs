//! The material of a study, in words for the report and as data for programs.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::Block;
use crate::document::stored;
use crate::material::Card;
use crate::material::curve::{Mode, far_end};
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
            blocks.extend([heading, properties(card)]);
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
            blocks: vec![Block::heading("Material"), properties(card)],
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

/// A property of a material and its value.
type Row = (String, String);

fn row(property: impl Into<String>, value: impl Into<String>) -> Row {
    (property.into(), value.into())
}

/// The contents of a card: law, parameters, moduli, behaviour in time, measures, ranges, source.
pub fn properties(card: &Card) -> Block {
    let along = if card.law.is_isotropic() {
        ""
    } else {
        " along the first axis"
    };
    let mut rows = vec![
        row("card", &card.name),
        row("law", format!("{}: {}", card.law_name, card.energy())),
    ];
    rows.extend(card.parameters.iter().map(|parameter| {
        let (value, unit) = (parameter.value, parameter.unit());
        row(parameter.key, format!("{value} {unit}"))
    }));
    rows.extend(card.choices.iter().map(|(key, name)| row(*key, name)));
    rows.extend(of_volume(card));
    let statements = card.law.statements().into_iter();
    rows.extend(statements.map(|(name, statement)| row(name, statement)));
    rows.extend([
        row(
            "initial Young's modulus E₀",
            format!("{:.6} MPa{along}", card.youngs_modulus()),
        ),
        row(
            "initial shear modulus μ₀",
            format!("{:.6} MPa", card.law.shear_modulus()),
        ),
    ]);
    rows.extend(in_time(card));
    rows.extend(of_softening(card));
    rows.extend([
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
        row("specimen", &card.specimen),
        row("source", &card.citation),
        row("DOI", &card.doi),
        row("note", &card.note),
    ]);
    rows.retain(|(_, value)| !value.is_empty());
    let rows = rows
        .into_iter()
        .map(|(property, value)| vec![property, value]);
    Block::table(&["property", "value"], rows)
}

/// The moduli and energy for changes of volume, and their effect on tension.
fn of_volume(card: &Card) -> Vec<Row> {
    let mut rows = Vec::new();
    if let Some(modulus) = card.bulk_modulus() {
        let modulus = format!("{modulus:.6} MPa; {}", card.law.plane_state().name());
        rows.push(row("bulk modulus κ", modulus));
    }
    if let Some(volume) = card.volume {
        rows.push(row("energy of volume", volume.energy.name()));
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

/// Density, viscosity and relaxation, as far as the card states them.
fn in_time(card: &Card) -> Vec<Row> {
    let mut rows = Vec::new();
    if let Some(density) = card.density {
        rows.push(row("density", format!("{:.6} kg/m³", 1e12 * density)));
    }
    let viscosity = &card.viscosity;
    if viscosity.shear_viscosity > 0.0 {
        let shear = 1e6 * viscosity.shear_viscosity;
        let shear = format!("{shear:.6} Pa·s in parallel with the law");
        rows.push(row("shear viscosity η", shear));
    }
    rows.extend(viscosity.relaxation.iter().map(|term| {
        let (share, time) = (100.0 * term.share, term.time);
        let term = format!("{share:.4} % of the instantaneous stress in τ = {time} s");
        row("relaxation", term)
    }));
    let covered = viscosity.covered;
    for (what, range, unit) in [
        ("times", covered.times, "s"),
        ("rates", covered.rates, "1/s"),
    ] {
        if let Some([low, high]) = range {
            let range = format!("{low:.4} to {high:.4} {unit}");
            rows.push(row(format!("{what} of the relaxation tests"), range));
        }
    }
    if !viscosity.relaxation.is_empty() {
        let at_once = viscosity.relaxation_function(0.0);
        rows.push(row(
            "instantaneous stress over that of the law",
            format!("{at_once:.6}"),
        ));
    }
    rows
}

/// The energy that unloading from some stretches dissipates; empty for a material that does not soften.
fn of_softening(card: &Card) -> Vec<Row> {
    let Some(softening) = card.law.softening() else {
        return Vec::new();
    };
    let far = far_end(card.stretch_range) - 1.0;
    let from = |share: f64| {
        let state = card.law.tension([1.0, 0.0], share * far);
        let most = state.energy;
        let [least, _] = softening.factor(0.0, most);
        let lost = format!(
            "{:.4} of {:.4} kJ/m³ are dissipated, η falls to {least:.4}",
            1e3 * softening.dissipated(most),
            1e3 * most,
        );
        let stretch = 1.0 + share * far;
        row(
            format!("unloaded from λ = {stretch:.3} in uniaxial tension"),
            lost,
        )
    };
    [0.5, 1.0].map(from).into()
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
