//! TOML documents, read with the position of every value: all faults of a file are collected and reported together.
//!
//! A [`Section`] returns values. When a value is missing or wrong it records a [`Diagnostic`] and returns a
//! placeholder, so that reading continues; [`Faults::finish`] then rejects the whole document, and a placeholder
//! never enters a computation.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use toml::de::DeTable;

use crate::budget::Budget;
use crate::error::{Diagnostic, Error, Severity, Source};
use crate::units::{SIZES, on_the_end};

mod archive;
mod arrays;
pub mod binary;
mod chosen;
mod columns;
mod comments;
mod converted;
mod decimals;
mod edited;
mod encoding;
mod explore;
pub mod file;
mod formats;
mod given;
mod head;
pub mod inputs;
mod keys;
mod lines;
mod records;
mod section;
mod spreadsheet;
pub mod stored;
mod syntax;
mod table;
mod text;
mod written;

pub use chosen::{
    ChosenColumns, ColumnNames, ColumnRole, FoundColumns, MACHINE_DISPLACEMENTS, MACHINE_FORCES,
    TIMES, column_meaning, column_named, meaning,
};
pub use columns::{Column, is_pixel, plain_name};
pub use comments::comments;
pub use edited::{EditedDocument, NewValue};
pub use encoding::TextEncoding;
pub use explore::{FoundKey, explore};
pub use formats::is_table_path;
pub use given::{given, with_files};
pub use head::{Faulty, Head, Statements};
pub use keys::{Key, Presence, Takes};
pub use records::{read_records, write_records};
pub use section::Section;
pub use table::{Table, TextPart};
pub use text::read_text;
pub use written::Written;

/// A parsed TOML file.
#[derive(Debug)]
pub struct Document<'a> {
    source: Arc<Source>,
    table: DeTable<'a>,
}

/// Most syntax faults reported for one document: the first ones usually cause the others.
const MOST_SYNTAX_FAULTS: usize = 5;

/// How messages about TOML's syntax begin.
const SYNTAX: &str = "TOML syntax";

/// Most findings reported for one document.
const MOST_DIAGNOSTICS: usize = 50;

/// Collects the findings while a document is read.
#[derive(Debug, Default)]
pub struct Faults {
    budget: Budget,
    diagnostics: RefCell<Vec<Diagnostic>>,
    defaulted: RefCell<Vec<String>>,
    keys: RefCell<Vec<Key>>,
    /// Whether the syntax is so broken that only its first fault says what is wrong.
    is_broken: Cell<bool>,
}

impl Faults {
    /// An empty collection for a document that is read within a budget.
    pub fn within(budget: Budget) -> Self {
        Self {
            budget,
            ..Self::default()
        }
    }

    /// Adds a finding.
    pub fn push(&self, diagnostic: Diagnostic) {
        self.diagnostics.borrow_mut().push(diagnostic);
    }

    /// Notes a key that was not written and took its default.
    fn defaulted(&self, printed: String) {
        let mut all = self.defaulted.borrow_mut();
        if !all.contains(&printed) {
            all.push(printed);
        }
    }

    /// The keys that were looked up.
    pub fn keys(&self) -> Vec<Key> {
        self.keys.borrow().clone()
    }

    /// The keys that were not written, with the defaults used: `finite_element.element = "Q2"`.
    pub fn defaults(&self) -> Vec<String> {
        self.defaulted.borrow().clone()
    }

    /// Whether no finding so far stops the program.
    pub fn none(&self) -> bool {
        self.diagnostics
            .borrow()
            .iter()
            .all(|fault| fault.severity == Severity::Warning)
    }

    /// The warnings, in the order of the file.
    ///
    /// # Errors
    /// [`Error::Input`] with all findings when one of them is an error.
    pub fn finish(self) -> Result<Vec<Diagnostic>, Error> {
        let ok = self.none();
        let mut all = self.diagnostics.into_inner();
        if self.is_broken.get() {
            all.retain(|fault| fault.message.starts_with(SYNTAX));
        }
        all.sort_by_key(|fault| fault.position.as_ref().map_or(0, |(_, span)| span.start));
        if all.len() > MOST_DIAGNOSTICS {
            let more = all.len() - MOST_DIAGNOSTICS;
            // Errors come first: the author must see them.
            all.sort_by_key(|fault| fault.severity == Severity::Warning);
            all.truncate(MOST_DIAGNOSTICS);
            let severity = if ok {
                Severity::Warning
            } else {
                Severity::Error
            };
            let rest = Diagnostic::error("", format!("{more} further findings are not listed"));
            all.push(Diagnostic { severity, ..rest });
        }
        if ok { Ok(all) } else { Err(Error::Input(all)) }
    }
}

impl<'a> Document<'a> {
    /// Parses `text`; syntax faults go to `faults` and what could be read is kept.
    pub fn parse(name: &str, text: &'a str, faults: &Faults) -> Self {
        let source = Arc::new(Source {
            name: name.to_owned(),
            text: text.to_owned(),
        });
        let (spanned, syntax_faults) = DeTable::parse_recoverable(text);
        let mut output = 0;
        for fault in &syntax_faults {
            let (message, span) = (fault.message().trim(), fault.span().unwrap_or(0..0));
            let hint = syntax::remedy(text, &span, message);
            // Where the intention is unknown, later faults are consequences of the first.
            let is_broken = hint.is_none();
            if is_broken || output < MOST_SYNTAX_FAULTS {
                let diagnostic = Diagnostic {
                    hint: hint.or_else(|| syntax::advice(message)),
                    ..Diagnostic::error("", format!("{SYNTAX}: {message}"))
                };
                faults.push(diagnostic.at(&source, syntax::visible(text, span)));
                output += 1;
            }
            if is_broken {
                faults.is_broken.set(true);
                break;
            }
        }
        let more = syntax_faults.len() - output;
        if more > 0 {
            let message = format!("{SYNTAX}: {more} further syntax errors are not listed");
            faults.push(Diagnostic::error("", message).at(&source, text.len()..text.len()));
        }
        Self {
            source,
            table: spanned.into_inner(),
        }
    }

    /// The whole document as a section. Keys that are missing are taken from `defaults`.
    pub fn root(&'a self, defaults: Option<&'a Self>, faults: &'a Faults) -> Section<'a> {
        Section::of(
            &self.source,
            Some(&self.table),
            defaults.map(|document| &document.table),
            faults,
        )
    }
}

/// The first name of a choice in a list such as that of [`Section::choice`].
pub fn name_of<T: PartialEq>(names: &[(&'static str, T)], choice: T) -> &'static str {
    let entry = names.iter().find(|(_, known)| *known == choice);
    entry.map_or("", |(name, _)| name)
}

/// A text in quotes, as written in a document.
pub fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// The values that a number may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Any finite number.
    Any,
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NonNegative,
    /// Within both limits, inclusive.
    Within(f64, f64),
    /// Within both limits, inclusive; the text describes the range.
    Range(f64, f64, &'static str),
}

impl Bound {
    /// The size of an object, in mm.
    pub const SIZE: Self = Self::Range(SIZES[0], SIZES[1], "greater than zero, from 1 nm to 1 km");

    /// The least and the largest value, infinite where there is no limit.
    pub fn ends(self) -> [f64; 2] {
        match self {
            Self::Any => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Positive | Self::NonNegative => [0.0, f64::INFINITY],
            Self::Within(low, high) | Self::Range(low, high, _) => [low, high],
        }
    }

    /// A value, or the limit of the bound where a conversion of units has rounded the value beyond it.
    fn on_the_end(self, value: f64) -> f64 {
        match self {
            Self::Within(low, high) | Self::Range(low, high, _) => on_the_end(value, [low, high]),
            Self::Any | Self::Positive | Self::NonNegative => value,
        }
    }

    fn violation(self, value: f64) -> Option<String> {
        let (holds, wanted) = match self {
            Self::Any => (value.is_finite(), "a finite number".to_owned()),
            Self::Positive => (value > 0.0, "greater than zero".to_owned()),
            Self::NonNegative => (value >= 0.0, "zero or greater".to_owned()),
            Self::Range(low, high, words) => ((low..=high).contains(&value), words.to_owned()),
            Self::Within(low, high) => (
                (low..=high).contains(&value),
                format!("between {low} and {high}"),
            ),
        };
        (!holds || !value.is_finite()).then_some(wanted)
    }
}
