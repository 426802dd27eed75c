//! The values of a section by their kinds.

use toml::Spanned;
use toml::de::DeValue;

use super::plain::{
    bare, bare_numbers, count_pair, plain_number, quantity, rounded, text, unquoted, whole_number,
};
use super::{Section, Value};
use crate::document::{Bound, Takes};
use crate::units::{self, Dimension, Linear};

/// Bare ratios up to here are taken as they are; a larger one may be intended in percent.
const MOST_BARE: f64 = 5.0;

impl<'a> Section<'a> {
    /// A text.
    pub fn text(&self, key: &'static str) -> String {
        self.record_key(key, Some(Takes::Text));
        self.read(key, "text in quotes", text).unwrap_or_default()
    }

    /// A list of texts.
    pub fn texts(&self, key: &'static str) -> Vec<String> {
        self.record_key(key, Some(Takes::Texts));
        self.texts_like(key)
    }

    pub(super) fn texts_like(&self, key: &'static str) -> Vec<String> {
        self.read(key, "a list of texts in quotes", |value| match value {
            DeValue::Array(items) => items.iter().map(|item| text(item.get_ref())).collect(),
            _ => None,
        })
        .unwrap_or_default()
    }

    /// A truth value.
    pub fn flag(&self, key: &'static str) -> bool {
        self.record_key(key, Some(Takes::Flag));
        self.read(key, "true or false", DeValue::as_bool)
            .unwrap_or_default()
    }

    /// A whole number from `low` to `high`.
    pub fn count(&self, key: &'static str, low: usize, high: usize) -> usize {
        self.record_key(key, Some(Takes::Count([low, high])));
        let wanted = format!("a whole number from {low} to {high}");
        self.read(key, &wanted, |value| {
            whole_number(value).filter(|n| (low..=high).contains(n))
        })
        .unwrap_or(low)
    }

    /// A list of exactly two whole numbers from `low` to `high`; `None` when it is wrong, which is recorded
    /// as a fault.
    pub fn count_pair(&self, key: &'static str, low: usize, high: usize) -> Option<[usize; 2]> {
        self.record_key(key, Some(Takes::Counts([low, high], None)));
        let wanted = format!("two whole numbers from {low} to {high}, such as [60, 20]");
        self.read(key, &wanted, |value| count_pair(value, low, high))
    }

    /// A list of exactly two whole numbers, or a word that leaves the choice to the program: `Some(None)`.
    pub fn count_pair_or(
        &self,
        word: &str,
        key: &'static str,
        [low, high]: [usize; 2],
    ) -> Option<Option<[usize; 2]>> {
        self.record_key(key, Some(Takes::Counts([low, high], Some(word.to_owned()))));
        let wanted =
            format!("two whole numbers from {low} to {high}, such as [60, 20], or \"{word}\"");
        self.read(key, &wanted, |value| match value {
            DeValue::String(text) => (text == word).then_some(None),
            other => count_pair(other, low, high).map(Some),
        })
    }

    /// A number without a dimension.
    pub fn number(&self, key: &'static str, bound: Bound) -> f64 {
        self.record_key(key, Some(Takes::Number(bound)));
        let Some(value) = self.value(key) else {
            return f64::NAN;
        };
        match plain_number(value.get_ref()) {
            Some(number) => self.bounded(key, value, number, bound),
            None => {
                let hint = match value.get_ref() {
                    DeValue::String(text) => unquoted(text),
                    _ => "such as 1e-8".to_owned(),
                };
                self.fault_at(key, value, "must be a number without a unit", &hint);
                f64::NAN
            }
        }
    }

    /// A quantity with a unit, in the internal unit of `dimension`.
    pub fn quantity(&self, key: &'static str, dimension: Dimension, bound: Bound) -> f64 {
        self.record_key(key, Some(Takes::Quantity(dimension, bound)));
        match self.value_like(key, &dimension.blank()) {
            Some(value) => self.item(key, value, dimension, bound, MOST_BARE),
            None => f64::NAN,
        }
    }

    /// A quantity, or a word with which the program chooses it: `None`.
    pub fn quantity_or(
        &self,
        word: &str,
        key: &'static str,
        dimension: Dimension,
        bound: Bound,
    ) -> Option<f64> {
        let is_word = self.is_word(word, key);
        self.record_key(key, Some(Takes::Quantity(dimension, bound)));
        (!is_word).then(|| self.quantity(key, dimension, bound))
    }

    /// A number without a dimension, or a word with which the program chooses it: `None`.
    pub fn number_or(&self, word: &str, key: &'static str, bound: Bound) -> Option<f64> {
        let is_word = self.is_word(word, key);
        self.record_key(key, Some(Takes::Number(bound)));
        (!is_word).then(|| self.number(key, bound))
    }

    /// Whether the value of a key is a word that it may take.
    fn is_word(&self, word: &str, key: &'static str) -> bool {
        self.record_key(key, Some(Takes::Choice(vec![word.to_owned()])));
        let is_word = |value: Value<'a>| text(value.get_ref()).is_some_and(|text| text == word);
        self.value(key).is_some_and(is_word)
    }

    /// A list of quantities, or one of some words.
    pub fn quantities_or<'b>(
        &self,
        words: &[&'b str],
        key: &'static str,
        dimension: Dimension,
    ) -> (Option<&'b str>, Vec<f64>) {
        let names = words.iter().map(|word| (*word).to_owned());
        self.record_key(key, Some(Takes::Choice(names.collect())));
        let is_text = |value: &Value<'a>| matches!(value.get_ref(), DeValue::String(_));
        match self.value(key).filter(is_text) {
            Some(_) => {
                self.record_key(key, Some(Takes::Quantities(dimension, Bound::Any)));
                let choices: Vec<_> = words.iter().map(|word| (*word, *word)).collect();
                (self.choice(key, &choices), Vec::new())
            }
            None => (None, self.quantities(key, dimension, Bound::Any)),
        }
    }

    /// The size of a unit by its name alone, such as `"mm"`, or as a quantity, such as `"0.05 mm"`.
    pub fn unit(&self, key: &'static str, dimension: Dimension) -> f64 {
        self.record_key(key, Some(Takes::Unit(dimension)));
        let unit = dimension.units().next().unwrap_or_default();
        let Some(value) = self.value_like(key, &format!("\"{unit}\"")) else {
            return f64::NAN;
        };
        let DeValue::String(name) = value.get_ref() else {
            let hint = format!("write its name in quotes, such as \"{unit}\"");
            self.fault_at(
                key,
                value,
                &format!("must be a unit of {}", dimension.name()),
                &hint,
            );
            return f64::NAN;
        };
        let begins_with_number = name
            .trim_start()
            .starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first));
        match units::factor(name, dimension) {
            Ok(factor) => factor,
            Err(_) if begins_with_number => {
                self.item(key, value, dimension, Bound::Positive, MOST_BARE)
            }
            Err(fault) => {
                let hint = fault.remedy(name, dimension);
                self.fault_at(key, value, &format!("\"{name}\" {fault}"), &hint);
                f64::NAN
            }
        }
    }

    /// A length that may be linear in the place at rest, as text such as `"2 mm + 0.1 * X"`.
    pub fn linear_length(&self, key: &'static str) -> Linear {
        self.record_key(key, Some(Takes::LinearLength));
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
            self.fault_at(key, value, &format!("\"{text}\" {fault}"), &fault.remedy());
            nothing
        })
    }

    /// A list of quantities of one dimension.
    pub fn quantities(&self, key: &'static str, dimension: Dimension, bound: Bound) -> Vec<f64> {
        self.list(key, (dimension, &dimension.blank()), bound, MOST_BARE)
    }

    /// A list of stretches λ − 1; numbers without a percent sign, in quotes or not, that could as well be λ are refused.
    pub fn stretches(&self, key: &'static str, bound: Bound) -> Vec<f64> {
        self.refuse_stretch_ratios(key);
        self.quantities(key, Dimension::Ratio, bound)
    }

    /// One stretch λ − 1, likewise.
    pub fn stretch(&self, key: &'static str, bound: Bound) -> f64 {
        self.refuse_stretch_ratios(key);
        self.quantity(key, Dimension::Ratio, bound)
    }

    fn refuse_stretch_ratios(&self, key: &'static str) {
        if let Some(value) = self.written(key)
            && let Some(ratios) = bare_numbers(value.get_ref())
            && units::could_be_stretch_ratios(&ratios)
        {
            let largest = ratios.into_iter().fold(1.0, f64::max);
            let [stretch, other] = [largest, largest - 1.0].map(|ratio| rounded(100.0 * ratio));
            let message = format!("{largest} could be a stretch of {stretch} % or λ, {other} %");
            let hint =
                format!("write \"{other} %\" where it is λ, and \"{stretch} %\" where it is not");
            self.fault_at(key, value, &message, &hint);
        }
    }

    /// A list of ratios that may exceed 1, such as load factors: bare numbers up to `most` are taken as they are.
    pub fn multiples(&self, key: &'static str, bound: Bound, most: f64) -> Vec<f64> {
        self.list(key, (Dimension::Ratio, "1.0"), bound, most)
    }

    fn list(
        &self,
        key: &'static str,
        (dimension, example): (Dimension, &str),
        bound: Bound,
        most: f64,
    ) -> Vec<f64> {
        self.record_key(key, Some(Takes::Quantities(dimension, bound)));
        let example = format!("[{example}, …]");
        let Some(value) = self.value_like(key, &example) else {
            return Vec::new();
        };
        let DeValue::Array(items) = value.get_ref() else {
            self.fault_at(key, value, "must be a list", &format!("write {example}"));
            return vec![f64::NAN];
        };
        let in_percent = |item: &Spanned<DeValue>| match item.get_ref() {
            DeValue::String(text) => text.contains('%'),
            _ => false,
        };
        // Among percentages a bare number is one too, or forgotten.
        let most = if items.iter().any(in_percent) {
            0.0
        } else {
            most
        };
        let items = items.iter();
        items
            .map(|item| self.item(key, item, dimension, bound, most))
            .collect()
    }

    /// A quantity; a ratio above `most` must say whether it is in percent.
    fn item(
        &self,
        key: &'static str,
        value: Value<'a>,
        dimension: Dimension,
        bound: Bound,
        most: f64,
    ) -> f64 {
        let quantity = quantity(value.get_ref(), dimension);
        let bare =
            bare(value.get_ref()).filter(|bare| dimension == Dimension::Ratio && bare.abs() > most);
        match (quantity, bare) {
            (Ok(_), Some(bare)) => {
                let message = format!("{bare} means {} %", rounded(100.0 * bare));
                let hint = format!(
                    "write \"{bare} %\", or \"{} %\" if that is meant",
                    rounded(100.0 * bare)
                );
                self.fault_at(key, value, &message, &hint);
                f64::NAN
            }
            (Ok(number), None) => self.bounded(key, value, number, bound),
            (Err((message, hint)), _) => {
                self.fault_at(key, value, &message, &hint);
                f64::NAN
            }
        }
    }

    fn bounded(&self, key: &'static str, value: Value<'a>, number: f64, bound: Bound) -> f64 {
        let number = bound.on_the_end(number);
        if let Some(wanted) = bound.violation(number) {
            self.must_be(key, value, &wanted);
            return f64::NAN;
        }
        number
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

    fn read<T>(
        &self,
        key: &'static str,
        wanted: &str,
        convert: impl Fn(&DeValue<'a>) -> Option<T>,
    ) -> Option<T> {
        let value = self.value(key)?;
        self.converted(key, value, wanted, convert)
    }

    /// A value as what it should be, a fault where it is not.
    pub(super) fn converted<T>(
        &self,
        key: &'static str,
        value: Value<'a>,
        wanted: &str,
        convert: impl Fn(&DeValue<'a>) -> Option<T>,
    ) -> Option<T> {
        let converted = convert(value.get_ref());
        if converted.is_none() {
            self.must_be(key, value, wanted);
        }
        converted
    }

    /// Records that a value is not what is wanted, and how it is written.
    fn must_be(&self, key: &'static str, value: Value<'a>, wanted: &str) {
        let written = self.source.text.get(value.span()).unwrap_or_default();
        let hint = format!("it is {written}");
        self.fault_at(key, value, &format!("must be {wanted}"), &hint);
    }
}
