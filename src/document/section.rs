//! One table of a document, read key by key.

use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Bound, Faults};
use crate::error::{Diagnostic, Source, nearest, suggestion};
use crate::units::{self, Dimension, Linear, LinearFault, QuantityFault};

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
    required: &'static [&'static str],
}

type Value<'a> = &'a Spanned<DeValue<'a>>;

impl<'a> Section<'a> {
    /// The table of a whole document.
    pub(super) fn root(
        source: &'a Arc<Source>,
        table: &'a DeTable<'a>,
        defaults: Option<&'a DeTable<'a>>,
        faults: &'a Faults,
    ) -> Self {
        Self {
            path: String::new(),
            source,
            span: 0..0,
            table: Some(table),
            defaults,
            faults,
            known: RefCell::default(),
            required: &[],
        }
    }

    /// With keys that the file must hold: for these a default is an example, and never taken.
    #[must_use]
    pub fn requiring(self, required: &'static [&'static str]) -> Self {
        Self { required, ..self }
    }

    /// The table under `key`; a missing one is read from the defaults alone.
    pub fn section(&self, key: &'static str) -> Section<'a> {
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
        let path = self.full(key);
        Section {
            path,
            source: self.source,
            span,
            table,
            defaults,
            faults: self.faults,
            known: RefCell::default(),
            required: &[],
        }
    }

    /// The tables of a list under `key`, written as `[[key]]`; a missing list is read from the defaults.
    pub fn tables(&self, key: &'static str) -> Vec<Section<'a>> {
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
            .map(|(index, (table, span))| Section {
                path: format!("{}[{}]", self.full(key), index + 1),
                source: self.source,
                span,
                table: Some(table),
                defaults: None,
                faults: self.faults,
                known: RefCell::default(),
                required: &[],
            })
            .collect()
    }

    /// Whether the file itself holds `key`.
    pub fn has(&self, key: &'static str) -> bool {
        self.written(key).is_some()
    }

    /// A text.
    pub fn text(&self, key: &'static str) -> String {
        self.read(key, "text in quotes", |value| match value {
            DeValue::String(text) => Some(text.to_string()),
            _ => None,
        })
        .unwrap_or_default()
    }

    /// A text that may be missing, and is empty then.
    pub fn optional_text(&self, key: &'static str) -> String {
        if self.has(key) {
            self.text(key)
        } else {
            String::new()
        }
    }

    /// A list of texts.
    pub fn texts(&self, key: &'static str) -> Vec<String> {
        let text = |value: &DeValue<'_>| match value {
            DeValue::String(text) => Some(text.to_string()),
            _ => None,
        };
        self.read(key, "a list of texts in quotes", |value| match value {
            DeValue::Array(items) => items.iter().map(|item| text(item.get_ref())).collect(),
            _ => None,
        })
        .unwrap_or_default()
    }

    /// A truth value.
    pub fn flag(&self, key: &'static str) -> bool {
        self.read(key, "true or false", |value| match value {
            DeValue::Boolean(flag) => Some(*flag),
            _ => None,
        })
        .unwrap_or_default()
    }

    /// One of several names; nothing when it is missing or unknown, which is recorded as a fault.
    pub fn choice<T: Copy>(&self, key: &'static str, choices: &[(&str, T)]) -> Option<T> {
        let name = self.read(key, "text in quotes", |value| match value {
            DeValue::String(text) => Some(text.to_string()),
            _ => None,
        })?;
        if let Some((_, choice)) = choices.iter().find(|(known, _)| *known == name) {
            return Some(*choice);
        }
        let names: Vec<_> = choices
            .iter()
            .map(|(known, _)| format!("\"{known}\""))
            .collect();
        let mut hint = format!("one of {}", names.join(", "));
        if let Some(near) = nearest(&name, choices.iter().map(|(known, _)| *known)) {
            hint = format!("did you mean \"{near}\"? It must be {hint}");
        }
        self.fault(key, &format!("\"{name}\" is not known here"), &hint);
        None
    }

    /// A whole number from `low` to `high`.
    pub fn count(&self, key: &'static str, low: usize, high: usize) -> usize {
        let wanted = format!("a whole number from {low} to {high}");
        self.read(key, &wanted, |value| {
            whole_number(value).filter(|n| (low..=high).contains(n))
        })
        .unwrap_or(low)
    }

    /// A list of exactly two whole numbers from `low` to `high`; nothing when it is wrong, which is recorded
    /// as a fault.
    pub fn count_pair(&self, key: &'static str, low: usize, high: usize) -> Option<[usize; 2]> {
        let wanted = format!("two whole numbers from {low} to {high}, such as [60, 20]");
        self.read(key, &wanted, |value| count_pair(value, low, high))
    }

    /// The same, or a word that leaves the choice to the program: nothing within the result.
    pub fn count_pair_or(
        &self,
        word: &str,
        key: &'static str,
        [low, high]: [usize; 2],
    ) -> Option<Option<[usize; 2]>> {
        let wanted =
            format!("two whole numbers from {low} to {high}, such as [60, 20], or \"{word}\"");
        self.read(key, &wanted, |value| match value {
            DeValue::String(text) => (text == word).then_some(None),
            other => count_pair(other, low, high).map(Some),
        })
    }

    /// A number without a dimension.
    pub fn number(&self, key: &'static str, bound: Bound) -> f64 {
        let Some(value) = self.value(key) else {
            return f64::NAN;
        };
        match plain_number(value.get_ref()) {
            Some(number) => self.bounded(key, value, number, bound),
            None => {
                self.fault_at(
                    key,
                    value,
                    "must be a number",
                    "write it without quotes, such as 1e-8",
                );
                f64::NAN
            }
        }
    }

    /// A quantity with a unit, in the internal unit of `dimension`.
    pub fn quantity(&self, key: &'static str, dimension: Dimension, bound: Bound) -> f64 {
        match self.value_like(key, dimension.example()) {
            Some(value) => self.quantity_of(key, value, dimension, bound),
            None => f64::NAN,
        }
    }

    /// The size of a unit by its name alone, such as `"mm"`, or as a quantity, such as `"0.05 mm"`.
    pub fn unit(&self, key: &'static str, dimension: Dimension) -> f64 {
        let Some(value) = self.value_like(key, dimension.example()) else {
            return f64::NAN;
        };
        let named = match value.get_ref() {
            DeValue::String(name) => units::factor(name, dimension).ok(),
            _ => None,
        };
        named.unwrap_or_else(|| self.quantity_of(key, value, dimension, Bound::Positive))
    }

    /// A length that may be linear in the place at rest, as text such as `"2 mm + 0.1 * X"`.
    pub fn linear_length(&self, key: &'static str) -> Linear {
        const EXAMPLE: &str = "\"2 mm\" or \"0.1 * X\"";
        let nothing = Linear::constant(f64::NAN);
        let Some(value) = self.value_like(key, EXAMPLE) else {
            return nothing;
        };
        let DeValue::String(text) = value.get_ref() else {
            self.fault_at(
                key,
                value,
                "must be a length",
                &format!("such as {EXAMPLE}"),
            );
            return nothing;
        };
        units::parse_linear_length(text).unwrap_or_else(|fault| {
            self.fault_at(
                key,
                value,
                &format!("\"{text}\" {fault}"),
                LinearFault::HINT,
            );
            nothing
        })
    }

    /// A list of quantities of one dimension.
    pub fn quantities(&self, key: &'static str, dimension: Dimension, bound: Bound) -> Vec<f64> {
        let example = format!("[{}, …]", dimension.example());
        let Some(value) = self.value_like(key, &example) else {
            return Vec::new();
        };
        match value.get_ref() {
            DeValue::Array(items) => items
                .iter()
                .map(|item| self.quantity_of(key, item, dimension, bound))
                .collect(),
            _ => {
                let hint = format!("write [{}, …]", dimension.example());
                self.fault_at(key, value, "must be a list", &hint);
                vec![f64::NAN]
            }
        }
    }

    fn quantity_of(
        &self,
        key: &'static str,
        value: Value<'a>,
        dimension: Dimension,
        bound: Bound,
    ) -> f64 {
        let example = dimension.example();
        let quantity = match value.get_ref() {
            DeValue::String(text) => units::parse(text, dimension).map_err(|fault| {
                let hint = match &fault {
                    QuantityFault::UnknownUnit(unit) => {
                        let known: Vec<_> = dimension.units().collect();
                        suggestion(unit, &known, "known units:")
                    }
                    _ => format!("write a {} such as {example}", dimension.name()),
                };
                (format!("\"{text}\" {fault}"), hint)
            }),
            other => match plain_number(other) {
                Some(number) if dimension == Dimension::Ratio => Ok(number),
                Some(_) => Err((
                    format!("a {} needs a unit", dimension.name()),
                    format!("write it as text, such as {example}"),
                )),
                None => Err((
                    format!("must be a {}", dimension.name()),
                    format!("such as {example}"),
                )),
            },
        };
        match quantity {
            Ok(number) => self.bounded(key, value, number, bound),
            Err((message, hint)) => {
                self.fault_at(key, value, &message, &hint);
                f64::NAN
            }
        }
    }

    fn bounded(&self, key: &'static str, value: Value<'a>, number: f64, bound: Bound) -> f64 {
        if let Some(wanted) = bound.violation(number) {
            self.fault_at(
                key,
                value,
                &format!("must be {wanted}"),
                &format!("it is {}", self.written_text(value)),
            );
            return f64::NAN;
        }
        number
    }

    fn written_text(&self, value: Value<'a>) -> String {
        self.source
            .text
            .get(value.span())
            .unwrap_or_default()
            .to_owned()
    }

    /// Adds a finding about another file that this one names.
    pub fn add(&self, finding: Diagnostic) {
        self.faults.push(finding);
    }

    /// A heading: a text of one line.
    pub fn heading(&self, key: &'static str) -> String {
        let text = self.text(key);
        if text.chars().any(char::is_control) {
            self.fault(
                key,
                "must be one line of plain text",
                "leave out line breaks",
            );
        }
        text
    }

    /// Records a fault at the place of `key`.
    pub fn fault(&self, key: &'static str, message: &str, hint: &str) {
        self.record(
            self.place(key),
            Diagnostic::error(self.full(key), message).hint(hint),
        );
    }

    /// Records a warning at the place of `key`.
    pub fn warning(&self, key: &'static str, message: &str, hint: &str) {
        self.record(
            self.place(key),
            Diagnostic::warning(self.full(key), message).hint(hint),
        );
    }

    /// Reports every key of the table that was never asked for.
    pub fn unknown_keys(&self) {
        let known = self.known.borrow();
        for (name, value) in self.table.into_iter().flat_map(|table| table.iter()) {
            let key = name.get_ref().as_ref();
            if known.contains(&key) {
                continue;
            }
            let hint = if known.is_empty() {
                "nothing is expected here".to_owned()
            } else {
                suggestion(key, &known, "known here:")
            };
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

    fn read<T>(
        &self,
        key: &'static str,
        wanted: &str,
        convert: impl Fn(&DeValue<'a>) -> Option<T>,
    ) -> Option<T> {
        let value = self.value(key)?;
        let converted = convert(value.get_ref());
        if converted.is_none() {
            self.fault_at(
                key,
                value,
                &format!("must be {wanted}"),
                &format!("it is {}", self.written_text(value)),
            );
        }
        converted
    }

    /// The value in the file, else the default; a fault when there is neither, or when the file must hold it.
    fn value(&self, key: &'static str) -> Option<Value<'a>> {
        self.value_like(key, "…")
    }

    /// The same with an example for the fault where the defaults have none.
    fn value_like(&self, key: &'static str, example: &str) -> Option<Value<'a>> {
        if let Some(written) = self.written(key) {
            return Some(written);
        }
        let default = self.defaults.and_then(|table| table.get(key));
        let required = self.required.contains(&key);
        match default.filter(|_| !required) {
            Some(default) => {
                let said = format!("{} = {}", self.full(key), shown(default.get_ref()));
                self.faults.defaulted(said);
                Some(default)
            }
            None => {
                let example = default.map_or(example.to_owned(), |value| shown(value.get_ref()));
                self.missing(key, &example);
                None
            }
        }
    }

    /// Records that the file does not hold a key, with an example of its value.
    fn missing(&self, key: &'static str, example: &str) {
        let hint = match (self.required.contains(&key), self.path.is_empty()) {
            (false, _) => format!("add `{key} = {example}`"),
            (true, true) => {
                format!("only what a study says is done: add `{key} = {example}`, for example")
            }
            (true, false) => format!(
                "only what a study says is done: add `{key} = {example}`, for example, under [{}]",
                self.path
            ),
        };
        self.fault(key, "is missing", &hint);
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

    fn place(&self, key: &'static str) -> Option<Range<usize>> {
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

/// A value as a document has it.
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
            let entries = table.iter();
            let entries = entries
                .map(|(key, value)| format!("{} = {}", key.get_ref(), shown(value.get_ref())));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}

fn plain_number(value: &DeValue<'_>) -> Option<f64> {
    let text = match value {
        DeValue::Float(number) => number.as_str(),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        _ => return None,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

fn count_pair(value: &DeValue<'_>, low: usize, high: usize) -> Option<[usize; 2]> {
    let DeValue::Array(items) = value else {
        return None;
    };
    let numbers = items.iter().map(|item| whole_number(item.get_ref()));
    let numbers: Vec<usize> = numbers.collect::<Option<_>>()?;
    let inside = numbers.iter().all(|n| (low..=high).contains(n));
    inside.then(|| numbers.try_into().ok()).flatten()
}

fn whole_number(value: &DeValue<'_>) -> Option<usize> {
    match value {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse().ok(),
        _ => None,
    }
}
