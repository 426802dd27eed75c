//! A study with the keys of a run set.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::variable::Setting;
use super::{Run, Sweep};
use crate::document::with_files;
use crate::error::{Diagnostic, Error};
use crate::material::Card;
use crate::studies::PreparedStudy;
use crate::validation;

/// The card of a run stands beside the study's own under this name, in memory.
const CARD: &str = "gelbench-sweep-card.toml";

/// Reads the study of a run.
///
/// # Errors
/// [`Error::Input`] with what cannot be set, and every fault of the study.
pub fn prepare(sweep: &Sweep, run: &Run) -> Result<PreparedStudy, Error> {
    let fault = |message: String, hint: &str| Error::input(message, hint);
    let file = sweep.path.display();
    let mut study: Table = sweep
        .text
        .parse()
        .map_err(|cause| fault(format!("{file} is not TOML: {cause}"), "mend the study"))?;
    let folder = sweep.path.parent().unwrap_or(Path::new(""));
    let mut card = None;
    for (key, setting) in sweep.keys().iter().zip(&run.settings) {
        let parts: Vec<&str> = key.split('.').collect();
        let value = toml_value(setting);
        let is_set = match parts[..] {
            ["material", parameter] if parameter != "card" => {
                let own = match &mut card {
                    Some(own) => own,
                    None => card.insert(VariedCard::of(&study, folder)?),
                };
                match own.set(parameter, &value) {
                    true => Ok(()),
                    false => set(&mut study, &parts, value),
                }
            }
            _ => set(&mut study, &parts, value),
        };
        is_set.map_err(|reason| {
            let hint = "a key's parts have dots between them; places in lists count from 0: load.stretches.0";
            Error::Input(vec![Diagnostic::error(key.as_str(), reason).hint(hint)])
        })?;
    }
    let mut files = Vec::new();
    if let Some(card) = card.filter(|card| card.is_varied) {
        let name = card.place.to_string_lossy().into_owned();
        let path = folder.join(&card.place);
        let plain = path.strip_prefix(".").unwrap_or(&path).to_owned();
        files.push((plain, card.table.to_string().into_bytes()));
        set(&mut study, &["material", "card"], Value::String(name))
            .map_err(|reason| fault(reason, "give the study a [material] with its card"))?;
    }
    let text = study.to_string();
    with_files(files, || {
        validation::read_given(&sweep.path, text, sweep.budget)
    })
}

/// A card whose parameters are set.
struct VariedCard {
    /// Relative to the study.
    place: PathBuf,
    card: Card,
    table: Table,
    is_varied: bool,
}

impl VariedCard {
    fn of(study: &Table, folder: &Path) -> Result<Self, Error> {
        let name = study
            .get("material")
            .and_then(|section| section.get("card"));
        let name = name.and_then(Value::as_str).ok_or_else(|| {
            Error::input(
                "a parameter of the card is varied, but the study names no card",
                "give it [material] card = …, or vary keys of the study",
            )
        })?;
        let card = Card::load(name, folder)?;
        let table = card.text.parse().map_err(|cause| {
            Error::input(
                format!("the card {name} is not TOML: {cause}"),
                "mend the card",
            )
        })?;
        Ok(Self {
            place: Path::new(name).with_file_name(CARD),
            card,
            table,
            is_varied: false,
        })
    }

    /// Sets a parameter; says whether the card has one of this name.
    fn set(&mut self, key: &str, value: &Value) -> bool {
        let section = match key {
            "poisson_ratio" | "bulk_modulus" => "volume",
            _ => "parameters",
        };
        if self.card.parameter(key).is_none() {
            return false;
        }
        self.is_varied |= set(&mut self.table, &[section, key], value.clone()).is_ok();
        self.is_varied
    }
}

/// Whole numbers stay whole, numbers with a unit are texts.
fn toml_value(setting: &Setting) -> Value {
    match setting {
        Setting::Integer(whole) => Value::Integer(*whole),
        Setting::Number(value, unit) if unit.is_empty() => Value::Float(*value),
        Setting::Number(value, unit) => Value::String(format!("{value} {unit}")),
        Setting::Text(text) => Value::String(text.clone()),
    }
}

/// Sets the value at a path; tables that are not there are made, places of lists are not.
fn set(table: &mut Table, parts: &[&str], value: Value) -> Result<(), String> {
    let [first, rest @ ..] = parts else {
        return Err("there is no key".to_owned());
    };
    if rest.is_empty() {
        table.insert((*first).to_owned(), value);
        return Ok(());
    }
    let inner = table
        .entry(*first)
        .or_insert_with(|| Value::Table(Table::new()));
    set_within(inner, (first, rest), value)
}

fn set_within(
    inner: &mut Value,
    (name, rest): (&str, &[&str]),
    value: Value,
) -> Result<(), String> {
    match inner {
        Value::Table(table) => set(table, rest, value),
        Value::Array(list) => {
            let count = list.len();
            let place = rest[0]
                .parse::<usize>()
                .ok()
                .and_then(|place| list.get_mut(place));
            let place = place.ok_or_else(|| {
                format!(
                    "`{name}` is a list of {count}, in which `{}` is no place",
                    rest[0]
                )
            })?;
            match rest {
                [_] => {
                    *place = value;
                    Ok(())
                }
                _ => set_within(place, (rest[0], &rest[1..]), value),
            }
        }
        _ => Err(format!("`{name}` is a value and no section")),
    }
}
