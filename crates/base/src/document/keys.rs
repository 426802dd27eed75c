//! The keys that a reader looks up, recorded while it reads.

use super::Bound;
use crate::units::Dimension;

/// The type of a key's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Takes {
    /// A text.
    Text,
    /// A list of texts.
    Texts,
    /// A truth value.
    Flag,
    /// One of some names.
    Choice(Vec<String>),
    /// A list of some names.
    Choices(Vec<String>),
    /// A whole number within limits.
    Count([usize; 2]),
    /// Two whole numbers within limits, or a word.
    Counts([usize; 2], Option<String>),
    /// A number without a unit.
    Number(Bound),
    /// A quantity with a unit.
    Quantity(Dimension, Bound),
    /// A list of quantities.
    Quantities(Dimension, Bound),
    /// The name of a unit, or a quantity.
    Unit(Dimension),
    /// A length that may be linear in the coordinates.
    LinearLength,
    /// A table.
    Section,
    /// A list of tables.
    Sections,
}

impl Takes {
    /// A value that suits, as TOML has it; empty for tables.
    pub fn example(&self) -> String {
        let quantity = |dimension: &Dimension| {
            let example = dimension.example();
            example.rsplit(" or ").next().unwrap_or(example).to_owned()
        };
        match self {
            Self::Text => "\"…\"".to_owned(),
            Self::Texts => "[\"…\"]".to_owned(),
            Self::Flag => "true".to_owned(),
            Self::Choice(names) => {
                let first = names.first();
                first.map_or(String::new(), |name| format!("\"{name}\""))
            }
            Self::Choices(names) => {
                let first = names.first();
                first.map_or("[]".to_owned(), |name| format!("[\"{name}\"]"))
            }
            Self::Count([low, _]) => low.to_string(),
            Self::Counts([low, _], _) => format!("[{low}, {low}]"),
            Self::Number(bound) if bound.ends()[0] > 1.0 => "2.0".to_owned(),
            Self::Number(_) => "1.0".to_owned(),
            Self::Quantity(dimension, _) => quantity(dimension),
            Self::Quantities(dimension, _) => format!("[{}]", quantity(dimension)),
            Self::Unit(dimension) => {
                format!("\"{}\"", dimension.units().next().unwrap_or_default())
            }
            Self::LinearLength => "\"2 mm\"".to_owned(),
            Self::Section | Self::Sections => String::new(),
        }
    }
}

/// A key that a reader has looked up.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Key {
    /// Its tables and its name: `plate.length`, `support[].kind`.
    pub path: String,
    /// The types that it takes; empty where the reader has only checked whether it is present.
    pub takes: Vec<Takes>,
    /// The value in the built-in study.
    pub example: Option<String>,
    /// Whether it may be left out.
    pub presence: Presence,
}

/// Whether a key may be left out, and the meaning of that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// A file must contain it.
    Required,
    /// It takes the value in the built-in study.
    Default,
    /// Without it, nothing is stated.
    Optional,
}

/// A path without the numbers of its tables.
pub(super) fn plain_path(path: &str) -> String {
    let mut plain = String::new();
    let mut inside = false;
    for letter in path.chars() {
        inside = letter == '[' || inside && letter != ']';
        if !inside || letter == '[' {
            plain.push(letter);
        }
    }
    plain
}

/// Adds a key, or its new types, to those that were looked up before.
pub(super) fn note(keys: &mut Vec<Key>, key: Key) {
    match keys.iter_mut().find(|known| known.path == key.path) {
        None => keys.push(key),
        // Where a key may be missing, its presence is checked before it is read.
        Some(known) => {
            known.example = known.example.take().or(key.example);
            // A choice is read as a text too.
            let is_choice = matches!(known.takes.first(), Some(Takes::Choice(_)));
            let others = key
                .takes
                .into_iter()
                .filter(|one| !(known.takes.contains(one) || is_choice && *one == Takes::Text));
            let new: Vec<Takes> = others.collect();
            known.takes.extend(new);
        }
    }
}
