//! The statements of a table in the lines above its rows, and those of the user about it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::{Column, Table};
use crate::error::{Diagnostic, Error, suggestion};
use crate::units::{self, Dimension, QuantityFault};

/// Statements that supplement the head of a table: keys and values.
pub type Statements = BTreeMap<String, String>;

/// The result of looking something up in a head.
pub type Faulty<T> = Result<T, Box<Diagnostic>>;

/// Values with their places, by their keys.
type Pairs = BTreeMap<String, (String, Range<usize>)>;

/// The head of a table together with the statements of the command line.
pub struct Head<'a> {
    /// The table.
    pub table: &'a Table,
    pairs: Pairs,
    given: &'a Statements,
}

impl<'a> Head<'a> {
    /// The head of a table whose `known` keys may share lines.
    ///
    /// # Errors
    /// [`Error::Input`] when one of them stands twice with different values.
    pub fn new(table: &'a Table, known: &[&str], given: &'a Statements) -> Result<Self, Error> {
        Ok(Self {
            table,
            pairs: pairs(table, known).map_err(Error::Input)?,
            given,
        })
    }

    /// The keys and values in the file.
    pub fn written(&self) -> Statements {
        let pairs = self.pairs.iter();
        pairs
            .map(|(key, (value, _))| (key.clone(), value.clone()))
            .collect()
    }

    /// A fault at a place of the table.
    pub fn fault(
        &self,
        position: Range<usize>,
        message: impl Into<String>,
        hint: &str,
    ) -> Box<Diagnostic> {
        Box::new(self.table.fault(position, message, hint))
    }

    /// A fault of the statement about `key`.
    pub fn fault_of(&self, key: &str, message: impl Into<String>, hint: &str) -> Box<Diagnostic> {
        let pair = self.pairs.get(key);
        let position = pair.map_or(0..0, |(_, position)| position.clone());
        self.fault(position, message, hint)
    }

    /// A fault for a key that is not stated.
    pub fn missing(&self, key: &str, example: &str) -> Box<Diagnostic> {
        let option = key.replace(" measure", "").replace(' ', "-");
        let message = format!("{}: the {key} is not stated", self.table.source.name);
        let quoted = if example.contains(' ') {
            format!("\"{example}\"")
        } else {
            example.to_owned()
        };
        let hint = if self.table.is_text {
            format!(
                "write `# {key}: {example}` at the top of the file, or give --{option} {quoted}"
            )
        } else {
            format!("give --{option} {quoted}")
        };
        Box::new(Diagnostic::error("", message).hint(hint))
    }

    /// The statement of the file or the command line about `key`; `named` is that of a column's name.
    ///
    /// # Errors
    /// A fault where they contradict each other.
    pub fn setting(&self, key: &str, named: Option<&str>) -> Faulty<Option<String>> {
        // A remark may follow the word: `nominal (first Piola-Kirchhoff)`; a comma before a digit belongs to a number.
        let word = |value: &str| {
            let ends = |(at, letter): &(usize, char)| match *letter {
                '(' => true,
                ',' => !value[*at + 1..].starts_with(|next: char| next.is_ascii_digit()),
                _ => false,
            };
            let end = value.char_indices().find(ends);
            value[..end.map_or(value.len(), |(at, _)| at)]
                .trim()
                .to_owned()
        };
        self.agreed(key, named, &word)
    }

    /// The whole statement of the file or the command line about `key`.
    ///
    /// # Errors
    /// A fault where they contradict each other.
    pub fn text(&self, key: &str) -> Faulty<Option<String>> {
        self.agreed(key, None, &str::to_owned)
    }

    /// The statement about `key`, `read` from what the head has.
    fn agreed(
        &self,
        key: &str,
        named: Option<&str>,
        read: &dyn Fn(&str) -> String,
    ) -> Faulty<Option<String>> {
        let mut printed: Vec<(&str, String, Range<usize>)> = Vec::new();
        if let Some(named) = named {
            let position = self.table.columns_place.clone();
            printed.push(("the name of a column", named.to_owned(), position));
        }
        if let Some((value, position)) = self.pairs.get(key) {
            printed.push(("the header", read(value), position.clone()));
        }
        if let Some(value) = self.given.get(key) {
            printed.push(("the command line", value.trim().to_owned(), 0..0));
        }
        for pair in printed.windows(2) {
            let [(one, first, position), (other, second, _)] = pair else {
                continue;
            };
            if !units::are_equal(first, second) {
                let message = format!(
                    "the {key} is {first} according to {one} and {second} according to {other}"
                );
                return Err(self.fault(position.clone(), message, "state it once, or identically"));
            }
        }
        Ok(printed.into_iter().next().map(|(_, value, _)| value))
    }

    /// One of several names.
    ///
    /// # Errors
    /// A fault where it is not stated or not known.
    pub fn choice<T: Copy>(
        &self,
        key: &str,
        named: Option<&str>,
        names: &[(&'static str, T)],
    ) -> Faulty<T> {
        let value = self.setting(key, named)?;
        let known = || names.iter().map(|(name, _)| *name).collect::<Vec<_>>();
        let value = value.ok_or_else(|| {
            let mut fault = self.missing(key, names[0].0);
            let hint = fault.hint.take().unwrap_or_default();
            fault.hint = Some(format!("{hint}; it is one of {}", known().join(", ")));
            fault
        })?;
        if let Some((_, choice)) = names.iter().find(|(name, _)| *name == value) {
            return Ok(*choice);
        }
        let hint = suggestion(&value, &known(), "it must be one of");
        Err(self.fault_of(key, format!("the {key} `{value}` is not known"), &hint))
    }

    /// A positive quantity such as the specimen's area, where it is stated.
    ///
    /// # Errors
    /// A fault where it is not a positive quantity.
    pub fn quantity(&self, key: &str, dimension: Dimension) -> Faulty<Option<f64>> {
        let Some(value) = self.setting(key, None)? else {
            return Ok(None);
        };
        let (reason, hint) = match units::parse(&value, dimension) {
            Ok(number) if number > 0.0 => return Ok(Some(number)),
            Ok(_) => {
                let hint = format!("write it as {}", dimension.example());
                ("is not positive".to_owned(), hint)
            }
            Err(fault) => (fault.to_string(), fault.remedy(&value, dimension)),
        };
        Err(self.fault_of(key, format!("the {key} \"{value}\" {reason}"), &hint))
    }

    /// A positive quantity that must be stated.
    ///
    /// # Errors
    /// A fault where it is not stated, or is not a positive quantity.
    pub fn required_quantity(&self, key: &str, dimension: Dimension) -> Faulty<f64> {
        let example = dimension.example().trim_matches('"');
        self.quantity(key, dimension)?
            .ok_or_else(|| self.missing(key, example))
    }

    /// The factor from a column's unit to the internal one, where the column or the setting `key` states it.
    ///
    /// # Errors
    /// A fault where it is not stated, or is not a unit of the dimension.
    pub fn factor(&self, key: &str, column: &Column, dimension: Dimension) -> Faulty<f64> {
        let example = match dimension {
            Dimension::Ratio => "-",
            other => other.internal_unit(),
        };
        // What cannot be read as a unit of this kind gives way to a statement.
        let stated = self.setting(key, None)?;
        let column_unit = column.unit.as_deref();
        let readable = column_unit.filter(|column_unit| {
            stated.is_none() || units::factor(column_unit, dimension).is_ok()
        });
        let unit = match (&stated, readable) {
            (Some(stated), Some(column_unit)) if units::symbol(stated) == Some(column_unit) => {
                Some(column_unit.to_owned())
            }
            _ => self.setting(key, readable)?,
        };
        let unit = unit.ok_or_else(|| self.missing(key, example))?;
        let rare = units::rare(&unit).filter(|rare| rare.dimension == dimension);
        // A unit that is stated for this file is intended, however rare it is.
        let is_confirmed = self
            .given
            .get(key)
            .is_some_and(|given| given.trim() == unit);
        if let Some(rare) = rare.filter(|_| is_confirmed) {
            return Ok(rare.factor);
        }
        let symbol = units::symbol(&unit).unwrap_or(&unit);
        units::factor(symbol, dimension).map_err(|fault| {
            let option = key.replace(' ', "-");
            let hint = match rare {
                Some(rare) => format!(
                    "`{unit}` is {}: if {usual} is meant, correct it or give --{option} {usual}; if not, give --{option} {unit}",
                    rare.meaning,
                    usual = rare.usual
                ),
                None => fault.remedy(&unit, dimension) + unmarked(dimension, &fault),
            };
            let position = self.table.columns_place.clone();
            self.fault(position, format!("the {key} {fault}"), &hint)
        })
    }
}

/// What columns may have in place of an unknown unit of a dimension.
fn unmarked(dimension: Dimension, fault: &QuantityFault) -> &'static str {
    match (dimension, fault) {
        (Dimension::Ratio, QuantityFault::UnknownUnit(_)) => "; `-` or mm/mm of a plain ratio",
        _ => "",
    }
}

/// The `key: value` pairs of the lines that begin with `#`, the first of each key with its place; several with one
/// of the `known` keys first may stand on one line, separated by semicolons.
///
/// # Errors
/// The known keys that stand twice with different values.
pub(super) fn pairs(table: &Table, known: &[&str]) -> Result<Pairs, Vec<Diagnostic>> {
    let (mut pairs, mut faults) = (Pairs::new(), Vec::new());
    let known = |key: &str| known.contains(&&*plain_key(key));
    let mut start = 0;
    for line in table.source.text.split_inclusive('\n') {
        let position = start..start + line.trim_end().len();
        start += line.len();
        let Some(comment) = line.strip_prefix('#') else {
            continue;
        };
        let several = known(comment.split(':').next().unwrap_or_default());
        let parts = comment.split(|letter| several && letter == ';');
        for (key, value) in parts.filter_map(|part| part.split_once(':')) {
            let (key, value) = (plain_key(key), value.trim().to_owned());
            match pairs.get(&key) {
                Some((first, _)) if known(&key) && !units::are_equal(first, &value) => {
                    let message = format!("the {key} is stated twice with different values");
                    faults.push(table.fault(position.clone(), message, "state it once"));
                }
                Some(_) => {}
                None => {
                    pairs.insert(key, (value, position.clone()));
                }
            }
        }
    }
    if faults.is_empty() {
        Ok(pairs)
    } else {
        Err(faults)
    }
}

/// A key of the head in lower case with spaces.
fn plain_key(key: &str) -> String {
    key.trim().to_lowercase().replace('_', " ")
}
