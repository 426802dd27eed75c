//! Plates between two grips: strips that are clamped at one end and pulled at the other, with keys of their own, on grids of lines.

use std::path::Path;

use super::specimen::{self, Specimen};
use super::{Kind, Loaded, PreparedStudy};
use crate::budget::Budget;
use crate::document::Key;
use crate::error::Error;

mod read;

/// The `kind` of these studies.
pub const KIND: &str = "plate";

/// The study that `gelbench new` writes: every key with its default.
pub const DEFAULT: &str = include_str!("plate/default.toml");

/// Studies of plates, which need no `kind`.
pub const PLATE: Kind = Kind {
    of_shape: None,
    name: KIND,
    study: DEFAULT,
    file: "default.toml",
    slow: false,
};

/// Reads the study of a file within a budget; its models are solved and compared as those of any specimen.
///
/// # Errors
/// [`Error::Input`] with every fault of the study and of its card.
pub fn load(file: &Path, text: &str, budget: Budget) -> Result<Loaded<Specimen>, Error> {
    PLATE.load(file, text, budget, read::read)
}

/// The same, ready to be computed.
///
/// # Errors
/// [`Error::Input`] with every fault of the study and of its card.
pub fn prepare(file: &Path, text: &str, budget: Budget) -> Result<PreparedStudy, Error> {
    let loaded = load(file, text, budget)?;
    Ok(specimen::ready(&PLATE, super::name(file), text, loaded))
}

/// The keys that are looked up when a text is read.
pub fn keys(text: &str) -> Vec<Key> {
    PLATE.keys(text, read::read)
}
