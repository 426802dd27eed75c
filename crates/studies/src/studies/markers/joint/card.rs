//! The card of a law with the values that were found.

use crate::document::quoted;
use crate::error::Error;
use crate::estimation::JointEstimate;
use crate::material::Card;
use crate::material::parameters::Parameter;

/// The name of its file.
pub const FILE: &str = "card.toml";

/// A card with the values that were found with these specimens: its text but for parameters, title and note.
///
/// # Errors
/// [`Error::Input`] where the parameters stand in no table of their own, so that they cannot be replaced.
pub fn with_values(card: &Card, estimate: &JointEstimate, specimens: &str) -> Result<Card, Error> {
    let note = format!(
        "parameters estimated by `gelbench correct` from the displacement fields of {specimens}; initial values from the card `{}`",
        card.name
    );
    let value = |key: &str| {
        let found = estimate.with_keys().find(|(one, _)| one.key == key)?;
        Some(written(found.0, found.1.value))
    };
    let mut text = format!("# {note}.\n");
    let mut table = String::new();
    for line in card.text.lines() {
        let start = line.trim_start();
        if start.starts_with('[') {
            table = start
                .split(']')
                .next()
                .unwrap_or_default()
                .trim_matches('[')
                .to_owned();
        }
        let key = start.split('=').next().unwrap_or_default().trim();
        let replaced = match (table.as_str(), key) {
            ("fit", _) => continue,
            ("", _) if start.starts_with('#') => continue,
            ("parameters" | "volume", key) => value(key),
            ("", "title") => Some(quoted(&format!(
                "{} from displacement fields",
                card.law_name
            ))),
            ("source", "note") => Some(quoted(&note)),
            _ => None,
        };
        match replaced {
            Some(value) => text += &format!("{key} = {value}\n"),
            None => text += &format!("{line}\n"),
        }
    }
    let found = Card::parse(&card.name, FILE, &text)?;
    let holds = |(parameter, estimate): (&Parameter, &crate::statistics::Estimate)| {
        let read = found.parameter(parameter.key).unwrap_or(f64::NAN);
        (read - estimate.value).abs() <= 1e-12 * estimate.value.abs()
    };
    if estimate.with_keys().all(holds) {
        Ok(found)
    } else {
        Err(Error::input(
            format!(
                "the parameters of the card `{}` cannot be replaced",
                card.name
            ),
            "write them as a table [parameters] with one key a line",
        ))
    }
}

fn written(parameter: &Parameter, value: f64) -> String {
    match parameter.unit() {
        "–" => format!("{value}"),
        unit => quoted(&format!("{value} {unit}")),
    }
}
