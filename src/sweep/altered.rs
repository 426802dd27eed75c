//! A study with the values that a run sets.

use std::path::{Path, PathBuf};

use super::variable::Setting;
use crate::kinds;
use gelbench_base::budget::Budget;
use gelbench_base::document::{EditedDocument, NewValue, with_files};
use gelbench_base::error::{Diagnostic, Error, suggestion};
use gelbench_mechanics::material::Card;
use gelbench_studies::studies::specimen::Along;
use gelbench_studies::studies::{PreparedStudy, Steps, motion, specimen};

/// What the name of a run's card begins with, which is a file in memory in the folder of the study's own card.
const CARD: &str = "gelbench-sweep-card";

/// The keys under `material` that belong to the study; all others are parameters of the card.
const OF_THE_STUDY: [&str; 5] = ["card", "on", "sheet", "density", "viscosity"];

/// A file in memory: its path and its content.
type File = (PathBuf, Vec<u8>);

/// The study that is computed many times.
#[derive(Clone, Debug)]
pub struct BaseStudy {
    /// Its file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Files in memory, by the names in the text: cards that are on no disk.
    pub files: Vec<File>,
    /// The cost that each run may have.
    pub budget: Budget,
}

impl BaseStudy {
    /// What its steps run along.
    pub fn steps_run_along(&self) -> Steps {
        let case = kinds::kind_of(&self.path.display().to_string(), &self.text);
        match case.ok().flatten().map(|case| case.name) {
            None => Steps::Path(Along::Stretch),
            Some(specimen::KIND) => Steps::Path(Along::LoadFactor),
            Some(motion::KIND) => Steps::Time,
            Some(_) => Steps::Unknown,
        }
    }

    /// The study with some keys set.
    ///
    /// # Errors
    /// [`Error::Input`] with what cannot be set, and every fault of the study.
    pub fn with(&self, keys: &[String], settings: &[Setting]) -> Result<PreparedStudy, Error> {
        let (study, cards) = with_files(self.files.clone(), || self.edited(keys, settings))?;
        let files = self.files.iter().cloned().chain(cards);
        with_files(files, || kinds::read_given(&self.path, study, self.budget))
    }

    /// The study as it is.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault.
    pub fn read(&self) -> Result<PreparedStudy, Error> {
        with_files(self.files.clone(), || {
            kinds::read_given(&self.path, self.text.clone(), self.budget)
        })
    }

    /// The study's text with some keys set, and the cards that this run has of its own.
    fn edited(&self, keys: &[String], settings: &[Setting]) -> Result<(String, Vec<File>), Error> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let mut study = EditedDocument::parse(&self.text).map_err(|cause| {
            let message = format!("{} is not TOML: {cause}", self.path.display());
            Error::input(message, "correct the study")
        })?;
        // Cards are named before their parameters are set.
        let mut all: Vec<(&String, &Setting)> = keys.iter().zip(settings).collect();
        all.sort_by_key(|(key, _)| !(key.starts_with("material.") && key.ends_with(".card")));
        let mut cards = Vec::new();
        for (key, setting) in all {
            let path: Vec<&str> = key.split('.').collect();
            let value = new_value(setting);
            let of_card = match of_material(&study, &path) {
                Some((section, parameter)) => {
                    let card = VariedCard::of(&mut cards, &study, section, folder)?;
                    let of_card = card.set(parameter, &value);
                    if let [name] = parameter
                        && !of_card
                        && !OF_THE_STUDY.contains(name)
                    {
                        return Err(card.has_none(key, name));
                    }
                    of_card
                }
                None => false,
            };
            if !of_card {
                study
                    .set(&path, &value)
                    .map_err(|reason| no_place(key, reason))?;
            }
        }
        let mut files = Vec::new();
        for card in cards.iter().filter(|card| card.is_varied) {
            let name = NewValue::Text(card.position.to_string_lossy().into_owned());
            let mut key: Vec<&str> = card.section.iter().map(String::as_str).collect();
            key.push("card");
            let named = study.set(&key, &name);
            named.map_err(|reason| no_place(&key.join("."), reason))?;
            let path = folder.join(&card.position);
            let plain = path.strip_prefix(".").unwrap_or(&path).to_owned();
            files.push((plain, card.document.text().into_bytes()));
        }
        Ok((study.text(), files))
    }
}

/// The section of a material and the key in it, as in `material.c10`, and in `material.1.c10` of a list of materials; `None` for its card, and for
/// all other keys.
fn of_material<'a>(
    study: &EditedDocument,
    path: &'a [&'a str],
) -> Option<(&'a [&'a str], &'a [&'a str])> {
    let is_list = study.holds(&["material", "0"]);
    let length = if is_list { 2 } else { 1 };
    let is_in_it = path.first() == Some(&"material")
        && path.len() > length
        && (!is_list || study.holds(&path[..length]));
    let (section, key) = is_in_it.then(|| path.split_at(length))?;
    (key != ["card"]).then_some((section, key))
}

fn no_place(key: &str, reason: String) -> Error {
    let hint =
        "a key's parts have dots between them; places in lists count from 0: load.stretches.0";
    Diagnostic::error(key, reason).hint(hint).into()
}

/// A card whose parameters are set.
struct VariedCard {
    /// The section of the study that names it.
    section: Vec<String>,
    /// Relative to the study.
    position: PathBuf,
    card: Card,
    document: EditedDocument,
    is_varied: bool,
}

impl VariedCard {
    /// The card of a section among those that are known, which it joins.
    fn of<'a>(
        known: &'a mut Vec<Self>,
        study: &EditedDocument,
        section: &[&str],
        folder: &Path,
    ) -> Result<&'a mut Self, Error> {
        let position = known.iter().position(|card| card.section == section);
        if position.is_none() {
            known.push(Self::load(study, section, folder)?);
        }
        let position = position.unwrap_or(known.len() - 1);
        Ok(&mut known[position])
    }

    fn load(study: &EditedDocument, section: &[&str], folder: &Path) -> Result<Self, Error> {
        let key = [section, &["card"]].concat();
        let name = study.text_of(&key).ok_or_else(|| {
            Error::input(
                "a parameter of the card is varied, but the study names no card",
                "give it [material] card = …, or vary keys of the study",
            )
        })?;
        let card = Card::load(name, folder)?;
        let document = EditedDocument::parse(&card.text).map_err(|cause| {
            Error::input(
                format!("the card {name} is not TOML: {cause}"),
                "correct the card",
            )
        })?;
        let number = section.get(1);
        let number = number.map_or_else(String::new, |place| format!("-{place}"));
        Ok(Self {
            section: section.iter().map(|part| (*part).to_owned()).collect(),
            position: Path::new(name).with_file_name(format!("{CARD}{number}.toml")),
            card,
            document,
            is_varied: false,
        })
    }

    /// The fault of a parameter that the card does not have.
    fn has_none(&self, key: &str, parameter: &str) -> Error {
        let known: Vec<&str> = self.card.parameters.iter().map(|entry| entry.key).collect();
        let message = format!("the card {} has no parameter `{parameter}`", self.card.name);
        let hint = suggestion(parameter, &known, "its parameters are");
        Diagnostic::error(key, message).hint(hint).into()
    }

    /// Sets a parameter, by the name that a fit has for it; returns whether the card has one of this name.
    fn set(&mut self, parameter: &[&str], value: &NewValue) -> bool {
        // Terms are counted from one.
        let index = match *parameter {
            ["relaxation", term, _] => term
                .parse::<usize>()
                .ok()
                .and_then(|number| number.checked_sub(1)),
            _ => None,
        };
        let index = index.map(|index| index.to_string());
        let position: &[&str] = match (parameter, &index) {
            ([key @ ("poisson_ratio" | "bulk_modulus")], _) => &["volume", key],
            ([key], _) => &["parameters", key],
            (["softening", key], _) => &["softening", key],
            (["relaxation", _, key], Some(index)) => &["viscosity", "relaxation", index, key],
            _ => return false,
        };
        let is_known = match *parameter {
            [key] => self.card.parameter(key).is_some(),
            _ => self.document.holds(position),
        };
        let is_set = is_known && self.document.set(position, value).is_ok();
        if is_set {
            // How it was fitted holds no longer.
            self.document.remove("fit");
        }
        self.is_varied |= is_set;
        is_set
    }
}

/// Whole numbers stay whole, numbers with a unit are texts; no key takes `true` or `false` as a text.
fn new_value(setting: &Setting) -> NewValue {
    match setting {
        Setting::Integer(integer) => NewValue::Integer(*integer),
        Setting::Number(value, unit) if unit.is_empty() => NewValue::Float(*value),
        Setting::Number(value, unit) => NewValue::Text(format!("{value} {unit}")),
        Setting::Text(text) => match text.parse() {
            Ok(flag) => NewValue::Flag(flag),
            Err(_) => NewValue::Text(text.clone()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXAMPLE: &str = include_str!("../../examples/inclusion.toml");

    /// The study of two regions with keys set to texts.
    fn set(all: &[[&str; 2]]) -> Result<(String, Vec<File>), Error> {
        let study = BaseStudy {
            path: Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/inclusion.toml"),
            text: EXAMPLE.to_owned(),
            files: Vec::new(),
            budget: Budget::USUAL,
        };
        let keys: Vec<String> = all.iter().map(|[key, _]| (*key).to_owned()).collect();
        let settings: Vec<Setting> = all.iter().map(|[_, text]| Setting::of(text)).collect();
        study.with(&keys, &settings)?;
        study.edited(&keys, &settings)
    }

    #[test]
    fn keys_of_a_region_and_parameters_of_its_card_are_set() {
        let (study, files) = set(&[["material.0.card", "mooney-rivlin"]]).unwrap();
        assert!(
            study.contains("card = \"mooney-rivlin\"") && files.is_empty(),
            "{study}"
        );
        let (study, files) = set(&[["material.1.c10", "0.25 MPa"]]).unwrap();
        let varied = "card = \"gelbench-sweep-card-1.toml\"";
        assert!(
            study.contains(varied) && study.contains("card = \"neo-hooke\""),
            "{study}"
        );
        let [(path, text)] = &files[..] else {
            panic!("{files:?}");
        };
        assert!(path.ends_with("examples/gelbench-sweep-card-1.toml"));
        let text = String::from_utf8_lossy(text);
        assert!(
            text.contains("c10 = \"0.25 MPa\"") && text.contains("c30 = "),
            "{text}"
        );
        let other = ["material.1.card", "neo-hooke"];
        let (_, files) = set(&[["material.1.c10", "0.25 MPa"], other]).unwrap();
        let text = String::from_utf8_lossy(&files[0].1);
        assert!(text.contains("law = \"neo-hooke\""), "{text}");
    }

    #[test]
    fn what_no_region_or_its_card_has_is_refused() {
        for (key, reason) in [
            ("material.1.mu", "has no parameter `mu`"),
            ("material.c10", "a list of 2 entries, and `c10` is not one"),
            ("material.2.c10", "a list of 2 entries, and `2` is not one"),
        ] {
            let fault = set(&[[key, "0.25 MPa"]]).unwrap_err().to_string();
            assert!(fault.contains(reason), "{key}: {fault}");
        }
    }
}
