//! The card of a law with estimated values.

use crate::document::quoted;
use crate::error::Error;
use crate::estimation::JointEstimate;
use crate::material::Card;
use crate::material::parameters::Parameter;
use crate::statistics::Estimate;

/// The name of its file.
pub const FILE: &str = "card.toml";

/// A card with the values estimated from some specimens: its text except for parameters, title and note.
///
/// # Errors
/// [`Error::Input`] where the parameters stand in no table of their own, so that they cannot be replaced.
pub fn with_values(card: &Card, estimate: &JointEstimate, specimens: &str) -> Result<Card, Error> {
    let note = format!(
        "parameters estimated by `gelbench correct` from the displacement fields of {specimens}; initial values from the card `{}`",
        card.name
    );
    let title = format!("{} from displacement fields", card.law_name);
    let value = |key: &str| {
        let (parameter, value) = estimate.with_keys().find(|(one, _)| one.key == key)?;
        Some(written(parameter, value.value))
    };
    let mut text = format!("# {note}.\n");
    let mut table = "";
    for line in card.text.lines() {
        let start = line.trim_start();
        if start.starts_with('[') {
            let head = start.split(']').next().unwrap_or_default();
            table = head.trim_matches('[');
        }
        let key = start.split('=').next().unwrap_or_default().trim();
        let replaced = match (table, key) {
            ("fit", _) => continue,
            ("", _) if start.starts_with('#') => continue,
            ("parameters" | "volume", key) => value(key),
            ("", "title") => Some(quoted(&title)),
            ("source", "note") => Some(quoted(&note)),
            _ => None,
        };
        match replaced {
            Some(value) => text += &format!("{key} = {value}\n"),
            None => text += &format!("{line}\n"),
        }
    }
    let estimated = Card::parse(&card.name, FILE, &text)?;
    let is_replaced = |(parameter, value): (&Parameter, &Estimate)| {
        let read = estimated.parameter(parameter.key).unwrap_or(f64::NAN);
        (read - value.value).abs() <= 1e-12 * value.value.abs()
    };
    if estimate.with_keys().all(is_replaced) {
        return Ok(estimated);
    }
    Err(Error::input(
        format!(
            "the parameters of the card `{}` cannot be replaced",
            card.name
        ),
        "write them as a table [parameters] with one key a line",
    ))
}

fn written(parameter: &Parameter, value: f64) -> String {
    match parameter.unit() {
        "–" => format!("{value}"),
        unit => quoted(&format!("{value} {unit}")),
    }
}
