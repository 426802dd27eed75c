//! One table of a document, read key by key.

use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::keys::{self, plain_path};
use super::{Faults, Key, Presence, Takes};
use crate::budget::{Budget, Excess, Need};
use crate::error::{Diagnostic, Source, suggestion};

mod choices;
mod plain;
mod values;

/// One table of a document.
#[derive(Debug)]
pub struct Section<'a> {
    path: String,
    source: &'a Arc<Source>,
    span: Range<usize>,
    table: Option<&'a DeTable<'a>>,
    defaults: Option<&'a DeTable<'a>>,
    faults: &'a Faults,
    known: RefCell<Vec<&'static str>>,
    /// Whether a choice on which other keys may depend is unknown.
    undecided: Cell<bool>,
    required: &'static [&'static str],
}

type Value<'a> = &'a Spanned<DeValue<'a>>;

impl<'a> Section<'a> {
    /// The table of a whole document.
    pub(super) fn of(
        source: &'a Arc<Source>,
        table: Option<&'a DeTable<'a>>,
        defaults: Option<&'a DeTable<'a>>,
        faults: &'a Faults,
    ) -> Self {
        Self {
            path: String::new(),
            source,
            span: 0..0,
            table,
            defaults,
            faults,
            known: RefCell::default(),
            undecided: Cell::default(),
            required: &[],
        }
    }

    /// Requires keys of the file: for these a default is only an example, and is never used.
    #[must_use]
    pub fn requiring(self, required: &'static [&'static str]) -> Self {
        Self { required, ..self }
    }

    /// The table under `key`; where it is missing, the defaults alone are read.
    pub fn section(&self, key: &'static str) -> Section<'a> {
        self.record_key(key, Some(Takes::Section));
        let (mut table, mut span) = (None, self.span.clone());
        if let Some(value) = self.written(key) {
            span = value.span();
            match value.get_ref() {
                DeValue::Table(inner) => table = Some(inner),
                _ => self.fault_at(
                    key,
                    value,
                    "must be a table",
                    &format!("write [{}]", self.full(key)),
                ),
            }
        }
        let defaults = match self
            .defaults
            .and_then(|table| table.get(key))
            .map(Spanned::get_ref)
        {
            Some(DeValue::Table(inner)) => Some(inner),
            _ => None,
        };
        self.inner(self.full(key), span, table, defaults)
    }

    fn inner(
        &self,
        path: String,
        span: Range<usize>,
        table: Option<&'a DeTable<'a>>,
        defaults: Option<&'a DeTable<'a>>,
    ) -> Self {
        Self {
            path,
            span,
            ..Self::of(self.source, table, defaults, self.faults)
        }
    }

    /// The tables of a list under `key`, written as `[[key]]`; a missing list is read from the defaults.
    pub fn tables(&self, key: &'static str) -> Vec<Section<'a>> {
        self.record_key(key, Some(Takes::Sections));
        let Some(value) = self.value(key) else {
            return Vec::new();
        };
        let DeValue::Array(items) = value.get_ref() else {
            let hint = format!("write [[{}]] before each", self.full(key));
            self.fault_at(key, value, "must be a list of tables", &hint);
            return Vec::new();
        };
        let table = |item: &'a Spanned<DeValue<'a>>| match item.get_ref() {
            DeValue::Table(table) => Some((table, item.span())),
            _ => {
                let hint = format!("write [[{}]] before each", self.full(key));
                self.fault_at(key, item, "must be a list of tables", &hint);
                None
            }
        };
        let tables = items.iter().filter_map(table).enumerate();
        tables
            .map(|(index, (table, span))| {
                let path = format!("{}[{}]", self.full(key), index + 1);
                self.inner(path, span, Some(table), None)
            })
            .collect()
    }

    /// The table under `key`, or the tables of a list, written as `[[key]]`; where both are missing, the defaults alone are read.
    pub fn section_or_sections(&self, key: &'static str) -> Vec<Section<'a>> {
        self.record_key(key, Some(Takes::Section));
        self.record_key(key, Some(Takes::Sections));
        if self.is_list(key) {
            self.tables(key)
        } else {
            vec![self.section(key)]
        }
    }

    /// Whether the file itself contains a list under `key`.
    pub fn is_list(&self, key: &'static str) -> bool {
        let written = self.written(key);
        written.is_some_and(|value| matches!(value.get_ref(), DeValue::Array(_)))
    }

    /// Whether the file itself contains the table `key`, which selects a dialect and is no key that was looked up.
    pub fn is_of(&self, key: &'static str) -> bool {
        self.written(key).is_some()
    }

    /// Whether the file itself contains `key`.
    pub fn has(&self, key: &'static str) -> bool {
        self.record_key(key, None);
        self.written(key).is_some()
    }

    /// Adds a finding about another file that this one names.
    pub fn add(&self, finding: Diagnostic) {
        self.faults.push(finding);
    }

    /// Records a fault at the place of `key`.
    pub fn fault(&self, key: &'static str, message: &str, hint: &str) {
        self.record(
            self.position(key),
            Diagnostic::error(self.full(key), message).hint(hint),
        );
    }

    /// Records a fault at the place of `key` where its need exceeds the budget; `smaller` describes what to change.
    /// Returns whether the budget suffices.
    pub fn affords(&self, key: &'static str, need: Need, smaller: &str) -> bool {
        let excess = self.excess(need);
        // An estimate from a value with a fault is no estimate.
        if excess.as_ref().is_some_and(|excess| excess.needed.is_nan()) && !self.faults.none() {
            return false;
        }
        if let Some(excess) = &excess {
            self.fault(key, &excess.to_string(), &excess.remedy(smaller));
        }
        excess.is_none()
    }

    /// The budget of the document.
    pub fn budget(&self) -> Budget {
        self.faults.budget
    }

    /// The excess of a need over the budget, if there is any.
    pub fn excess(&self, need: Need) -> Option<Excess> {
        self.faults.budget.afford(need).err()
    }

    /// Records a warning at the place of `key`.
    pub fn warning(&self, key: &'static str, message: &str, hint: &str) {
        self.record(
            self.position(key),
            Diagnostic::warning(self.full(key), message).hint(hint),
        );
    }

    /// Reports every key of the table that was never looked up.
    pub fn unknown_keys(&self) {
        self.unknown_keys_with(|_| None);
    }

    /// Reports every key of the table that was never looked up, with a `remedy` where there is one; reports nothing where a choice on which
    /// keys may depend could not be read.
    pub fn unknown_keys_with(&self, remedy: impl Fn(&str) -> Option<String>) {
        if self.undecided.get() {
            return;
        }
        let known = self.known.borrow();
        for (name, value) in self.table.into_iter().flat_map(|table| table.iter()) {
            let key = name.get_ref().as_ref();
            if known.contains(&key) {
                continue;
            }
            let hint = remedy(key).unwrap_or_else(|| {
                if known.is_empty() {
                    "no key is expected here".to_owned()
                } else {
                    suggestion(key, &known, "known here:")
                }
            });
            let span = name.span().start..name.span().end.max(name.span().start + 1);
            let kind = if matches!(value.get_ref(), DeValue::Table(_)) {
                "table"
            } else {
                "key"
            };
            let diagnostic = Diagnostic::error(self.full(key), format!("unknown {kind}"));
            self.faults
                .push(diagnostic.hint(hint).at(self.source, span));
        }
    }

    /// Records that a key is looked up, and the type of its value if that is read.
    fn record_key(&self, key: &'static str, takes: Option<Takes>) {
        let example = self.defaults.and_then(|table| table.get(key));
        let required = self.required.contains(&key);
        let table = matches!(takes, Some(Takes::Section));
        let presence = match (&takes, example) {
            (None, _) => Presence::Optional,
            (Some(_), Some(_)) if !required => Presence::Default,
            (Some(_), None) if table => Presence::Optional,
            _ => Presence::Required,
        };
        self.record_key_as(
            key,
            takes,
            example.map(|value| shown(value.get_ref())),
            presence,
        );
    }

    fn record_key_as(
        &self,
        key: &'static str,
        takes: Option<Takes>,
        example: Option<String>,
        presence: Presence,
    ) {
        let key = Key {
            path: plain_path(&self.full(key)),
            takes: takes.into_iter().collect(),
            example,
            presence,
        };
        keys::note(&mut self.faults.keys.borrow_mut(), key);
    }

    /// The value in the file, otherwise the default; a fault when there is neither, or when the file must contain it.
    fn value(&self, key: &'static str) -> Option<Value<'a>> {
        self.value_like(key, "…")
    }

    /// The value in the file, otherwise the default; `example` stands in the fault where the defaults have none.
    fn value_like(&self, key: &'static str, example: &str) -> Option<Value<'a>> {
        if let Some(written) = self.written(key) {
            return Some(written);
        }
        let default = self.defaults.and_then(|table| table.get(key));
        let required = self.required.contains(&key);
        match default.filter(|_| !required) {
            Some(default) => {
                let printed = format!("{} = {}", self.full(key), shown(default.get_ref()));
                self.faults.defaulted(printed);
                Some(default)
            }
            None => {
                let example = default.map_or(example.to_owned(), |value| shown(value.get_ref()));
                self.missing(key, &example);
                None
            }
        }
    }

    /// Records that the file does not contain a key, with an example of its value.
    fn missing(&self, key: &'static str, example: &str) {
        let hint = match (self.required.contains(&key), self.path.is_empty()) {
            (false, true) => format!("add `{key} = {example}`"),
            (false, false) => format!("add `{key} = {example}` under {}", self.toml_heading()),
            (true, true) => {
                format!("add `{key} = {example}`, for example; it has no default")
            }
            (true, false) => format!(
                "add `{key} = {example}`, for example, under {}; it has no default",
                self.toml_heading()
            ),
        };
        self.fault(key, "is missing", &hint);
    }

    /// The line above its keys, as TOML writes it: `[plate]`, or `[[support]]` with its number.
    fn toml_heading(&self) -> String {
        let name = plain_path(&self.path).replace("[]", "");
        let number = self
            .path
            .strip_suffix(']')
            .and_then(|path| path.rsplit_once('['));
        match number {
            Some((_, number)) => format!("[[{name}]] number {number}"),
            None => format!("[{name}]"),
        }
    }

    fn written(&self, key: &'static str) -> Option<Value<'a>> {
        if !self.known.borrow().contains(&key) {
            self.known.borrow_mut().push(key);
        }
        self.table.and_then(|table| table.get(key))
    }

    fn fault_at(&self, key: &'static str, value: Value<'a>, message: &str, hint: &str) {
        self.record(
            Some(value.span()),
            Diagnostic::error(self.full(key), message).hint(hint),
        );
    }

    fn record(&self, span: Option<Range<usize>>, diagnostic: Diagnostic) {
        self.faults
            .push(diagnostic.at(self.source, span.unwrap_or_else(|| self.span.clone())));
    }

    fn position(&self, key: &'static str) -> Option<Range<usize>> {
        self.table
            .and_then(|table| table.get(key))
            .map(Spanned::span)
    }

    fn full(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }
}

/// A value as written in a document.
fn shown(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => super::quoted(text),
        DeValue::Integer(number) => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(date) => date.to_string(),
        DeValue::Array(items) => {
            let items = items.iter().map(|item| shown(item.get_ref()));
            format!("[{}]", items.collect::<Vec<_>>().join(", "))
        }
        DeValue::Table(table) => {
            let entries = table
                .iter()
                .map(|(key, value)| format!("{} = {}", key.get_ref(), shown(value.get_ref())));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}
