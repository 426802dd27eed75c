//! Keys that are read from the file itself, whatever the defaults contain.

use super::Section;
use crate::document::Bound;
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
}
