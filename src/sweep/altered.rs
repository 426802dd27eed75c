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

/// The name of a run's card, which is a file in memory in the folder of the study's own card.
const CARD: &str = "gelbench-sweep-card.toml";

/// The keys under `material` that belong to the study; all others are parameters of the card.
const OF_THE_STUDY: [&str; 4] = ["card", "sheet", "density", "viscosity"];

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
        let (study, card) = with_files(self.files.clone(), || self.edited(keys, settings))?;
        let files = self.files.iter().cloned().chain(card);
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

    /// The study's text with some keys set, and the card of this run, where it has one of its own.
    fn edited(
        &self,
        keys: &[String],
        settings: &[Setting],
    ) -> Result<(String, Option<File>), Error> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let mut study = EditedDocument::parse(&self.text).map_err(|cause| {
            let message = format!("{} is not TOML: {cause}", self.path.display());
            Error::input(message, "correct the study")
        })?;
        let mut card = None;
        for (key, setting) in keys.iter().zip(settings) {
            let path: Vec<&str> = key.split('.').collect();
            let value = new_value(setting);
            let of_card = match path[..] {
                ["material", ref parameter @ ..] if parameter != ["card"] => {
                    if card.is_none() {
                        card = Some(VariedCard::of(&study, folder)?);
                    }
                    card.as_mut()
                        .is_some_and(|card| card.set(parameter, &value))
                }
                _ => false,
            };
            if let (["material", parameter], Some(card)) = (&path[..], &card)
                && !of_card
                && !OF_THE_STUDY.contains(parameter)
            {
                return Err(card.has_none(key, parameter));
            }
            if !of_card {
                study
                    .set(&path, &value)
                    .map_err(|reason| no_place(key, reason))?;
            }
        }
        let mut file = None;
        if let Some(card) = card.filter(|card| card.is_varied) {
            let name = NewValue::Text(card.position.to_string_lossy().into_owned());
            let named = study.set(&["material", "card"], &name);
            named.map_err(|reason| no_place("material.card", reason))?;
            let path = folder.join(&card.position);
            let plain = path.strip_prefix(".").unwrap_or(&path).to_owned();
            file = Some((plain, card.document.text().into_bytes()));
        }
        Ok((study.text(), file))
    }
}

fn no_place(key: &str, reason: String) -> Error {
    let hint =
        "a key's parts have dots between them; places in lists count from 0: load.stretches.0";
    Diagnostic::error(key, reason).hint(hint).into()
}

/// A card whose parameters are set.
struct VariedCard {
    /// Relative to the study.
    position: PathBuf,
    card: Card,
    document: EditedDocument,
    is_varied: bool,
}

impl VariedCard {
    fn of(study: &EditedDocument, folder: &Path) -> Result<Self, Error> {
        let name = study.text_of(["material", "card"]).ok_or_else(|| {
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
        Ok(Self {
            position: Path::new(name).with_file_name(CARD),
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
