//! Choices: names that stand for something; keys that are read from the file itself, whatever the defaults contain.

use toml::de::DeValue;

use super::Section;
use super::plain::text;
use crate::document::{Bound, Presence, Takes, quoted};
use crate::error::nearest;
use crate::units::Dimension;

impl<'a> Section<'a> {
    /// What is read under a key that the file itself contains; `None` where it does not.
    pub fn stated<T>(
        &self,
        key: &'static str,
        read: impl FnOnce(&Self, &'static str) -> T,
    ) -> Option<T> {
        self.has(key).then(|| read(self, key))
    }

    /// A text that may be missing, and is empty then.
    pub fn optional_text(&self, key: &'static str) -> String {
        self.stated(key, Self::text).unwrap_or_default()
    }

    /// A list of texts that may be missing, and is empty then.
    pub fn optional_texts(&self, key: &'static str) -> Vec<String> {
        self.stated(key, Self::texts).unwrap_or_default()
    }

    /// The tables of a list that may be missing, and is empty then.
    pub fn optional_tables(&self, key: &'static str) -> Vec<Section<'a>> {
        self.stated(key, Self::tables).unwrap_or_default()
    }

    /// A quantity that may be missing, in the internal unit of `dimension`.
    pub fn optional_quantity(
        &self,
        key: &'static str,
        dimension: Dimension,
        bound: Bound,
    ) -> Option<f64> {
        self.stated(key, |_, key| self.quantity(key, dimension, bound))
    }

    /// One of several names, which may be missing; `None` also where it is unknown, which is recorded as a fault.
    pub fn optional_choice<T: Copy>(&self, key: &'static str, choices: &[(&str, T)]) -> Option<T> {
        self.stated(key, |_, key| self.choice(key, choices))
            .flatten()
    }

    /// One of several names; `None` when it is missing or unknown, which is recorded as a fault.
    pub fn choice<T: Copy>(&self, key: &'static str, choices: &[(&str, T)]) -> Option<T> {
        let names = choices.iter().map(|(known, _)| (*known).to_owned());
        self.record_key(key, Some(Takes::Choice(names.collect())));
        let value = self.value_like(key, &joined(choices, " | "))?;
        let name = self.converted(key, value, "text in quotes", text)?;
        let named = self.named(key, &name, choices);
        self.undecided.set(self.undecided.get() || named.is_none());
        named
    }

    /// Some of several names, each once; `None` when one is unknown, which is recorded as a fault.
    pub fn choices<T: Copy>(&self, key: &'static str, choices: &[(&str, T)]) -> Option<Vec<T>> {
        let names = choices.iter().map(|(known, _)| (*known).to_owned());
        self.record_key(key, Some(Takes::Choices(names.collect())));
        let mut names = self.texts_like(key);
        let mut seen = Vec::new();
        names.retain(|name| {
            let is_new = !seen.contains(name);
            seen.push(name.clone());
            is_new
        });
        let result = names.iter().map(|name| self.named(key, name, choices));
        // All of them are looked at, so that every fault is reported.
        let result: Vec<Option<T>> = result.collect();
        result.into_iter().collect()
    }

    /// A truth value that is `usual` where the file does not state it, whatever the built-in study has as an example.
    pub fn flag_or(&self, usual: bool, key: &'static str) -> bool {
        self.record_key_as(
            key,
            Some(Takes::Flag),
            Some(usual.to_string()),
            Presence::Default,
        );
        let Some(value) = self.written(key) else {
            self.faults
                .defaulted(format!("{} = {usual}", self.full(key)));
            return usual;
        };
        self.converted(key, value, "true or false", DeValue::as_bool)
            .unwrap_or(usual)
    }

    /// What a name stands for; `None` where it is unknown, which is recorded as a fault.
    fn named<T: Copy>(&self, key: &'static str, name: &str, choices: &[(&str, T)]) -> Option<T> {
        if let Some((_, choice)) = choices.iter().find(|(known, _)| *known == name) {
            return Some(*choice);
        }
        let mut hint = format!("one of {}", joined(choices, ", "));
        if let Some(near) = nearest(name, choices.iter().map(|(known, _)| *known)) {
            hint = format!("did you mean \"{near}\"? It must be {hint}");
        }
        self.fault(key, &format!("\"{name}\" is not known here"), &hint);
        None
    }
}

/// All names in quotes.
fn joined<T>(choices: &[(&str, T)], by: &str) -> String {
    let names = choices.iter().map(|(known, _)| quoted(known));
    names.collect::<Vec<_>>().join(by)
}
