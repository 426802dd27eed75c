//! What a file of test data says about itself, and the command line about it.

use std::ops::Range;

use super::Reading;
use crate::calibration::table::{Column, Table};
use crate::error::{Diagnostic, suggestion};
use crate::units::{self, Dimension};

pub type Faulty<T> = Result<T, Box<Diagnostic>>;

/// The head of a file together with what the command line says.
pub struct Head<'a> {
    pub table: &'a Table,
    pub reading: &'a Reading,
}

impl Head<'_> {
    pub fn fault(
        &self,
        place: Range<usize>,
        message: impl Into<String>,
        hint: &str,
    ) -> Box<Diagnostic> {
        let fault = Diagnostic::error("", message.into()).hint(hint);
        Box::new(fault.at(&self.table.source, place))
    }

    pub fn missing(&self, key: &str, example: &str) -> Box<Diagnostic> {
        let option = key.replace(" measure", "").replace(' ', "-");
        let message = format!("{}: the {key} is not stated", self.table.source.name);
        let quoted = match example.contains(' ') {
            true => format!("\"{example}\""),
            false => example.to_owned(),
        };
        let hint = format!(
            "write `# {key}: {example}` at the top of the file, or give --{option} {quoted}"
        );
        Box::new(Diagnostic::error("", message).hint(hint))
    }

    /// What the file or the command line says about `key`; `told` is what a column's name says.
    pub fn setting(&self, key: &str, told: Option<&str>) -> Faulty<Option<String>> {
        let in_file = self.table.head.get(key);
        let mut said: Vec<(&str, String, Range<usize>)> = Vec::new();
        if let Some(told) = told {
            let place = self.table.columns_place.clone();
            said.push(("the name of a column", told.to_owned(), place));
        }
        if let Some((value, place)) = in_file {
            // A remark may follow the word: `nominal (first Piola-Kirchhoff)`.
            let word = value.split(['(', ',']).next().unwrap_or_default().trim();
            said.push(("the head", word.to_owned(), place.clone()));
        }
        if let Some(value) = self.reading.get(key) {
            said.push(("the command line", value.trim().to_owned(), 0..0));
        }
        for pair in said.windows(2) {
            if pair[0].1 != pair[1].1 {
                let message = format!(
                    "the {key} is {} by {} and {} by {}",
                    pair[0].1, pair[0].0, pair[1].1, pair[1].0
                );
                return Err(self.fault(pair[0].2.clone(), message, "say it once, or alike"));
            }
        }
        Ok(said.into_iter().next().map(|(_, value, _)| value))
    }

    pub fn choice<T: Copy>(
        &self,
        key: &str,
        told: Option<&str>,
        names: &[(&'static str, T)],
    ) -> Faulty<T> {
        let Some(value) = self.setting(key, told)? else {
            return Err(self.missing(key, names[0].0));
        };
        if let Some((_, choice)) = names.iter().find(|(name, _)| *name == value) {
            return Ok(*choice);
        }
        let known: Vec<_> = names.iter().map(|(name, _)| *name).collect();
        let hint = suggestion(&value, &known, "it must be one of");
        let place = self.place(key);
        Err(self.fault(place, format!("the {key} `{value}` is not known"), &hint))
    }

    /// A quantity such as the specimen's area.
    pub fn quantity(&self, key: &str, dimension: Dimension) -> Faulty<f64> {
        let Some(value) = self.setting(key, None)? else {
            return Err(self.missing(key, dimension.example().trim_matches('"')));
        };
        let place = self.place(key);
        match units::parse(&value, dimension) {
            Ok(number) if number > 0.0 => Ok(number),
            Ok(_) => Err(self.fault(
                place,
                format!("the {key} {value} is not positive"),
                "mend it",
            )),
            Err(fault) => {
                let hint = format!("write it as {}", dimension.example());
                Err(self.fault(place, format!("the {key} \"{value}\" {fault}"), &hint))
            }
        }
    }

    /// The factor from a column's unit to the internal one.
    pub fn factor(&self, key: &str, column: &Column, dimension: Dimension) -> Faulty<f64> {
        let told = column.unit.as_deref();
        let Some(unit) = self.setting(key, told)? else {
            let example = if dimension == Dimension::Ratio {
                "-"
            } else {
                "MPa"
            };
            return Err(self.missing(key, example));
        };
        if dimension == Dimension::Ratio
            && ["-", "–", "1", "mm/mm", "m/m", "in/in"].contains(&&*unit)
        {
            return Ok(1.0);
        }
        units::parse(&format!("1 {unit}"), dimension).map_err(|fault| {
            let units: Vec<_> = dimension.units().collect();
            let hint = format!("known units: {}", units.join(", "));
            let place = self.table.columns_place.clone();
            self.fault(place, format!("the {key} {fault}"), &hint)
        })
    }

    /// Where the head says something about `key`.
    pub fn place(&self, key: &str) -> Range<usize> {
        let said = self.table.head.get(key);
        said.map_or(0..0, |(_, place)| place.clone())
    }
}
