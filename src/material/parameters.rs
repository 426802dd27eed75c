//! The parameters of a material card, as a law reads them.

use crate::document::{Bound, Section};
use crate::units::Dimension;

/// Which stress a curve or a card speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressMeasure {
    /// Force per reference area (first Piola–Kirchhoff, engineering stress).
    Nominal,
    /// Force per current area (true stress).
    Cauchy,
}

/// Which strain a curve or a card speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrainMeasure {
    /// ε = λ − 1 (engineering strain).
    Nominal,
    /// ε = ln λ (true strain).
    Logarithmic,
}

/// What a card does with a curve whose stress at rest is not zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OffsetTreatment {
    /// The stress at rest is subtracted; the law starts at zero stress.
    Subtract,
    /// The published curve is drawn as it stands; such a card cannot drive a model.
    Keep,
}

impl StressMeasure {
    /// The names that cards use.
    pub const NAMES: [(&'static str, Self); 2] =
        [("nominal", Self::Nominal), ("cauchy", Self::Cauchy)];

    /// The name that cards use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }
}

impl StrainMeasure {
    /// The names that cards use.
    pub const NAMES: [(&'static str, Self); 2] = [
        ("nominal", Self::Nominal),
        ("logarithmic", Self::Logarithmic),
    ];

    /// The name that cards use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }
}

impl OffsetTreatment {
    /// The names that cards use.
    pub const NAMES: [(&'static str, Self); 2] =
        [("subtract", Self::Subtract), ("keep", Self::Keep)];

    /// The name that cards use.
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, self)
    }
}

/// The name of a choice that a list of names holds.
fn name_of<T: PartialEq>(names: &[(&'static str, T)], choice: T) -> &'static str {
    let found = names.iter().find(|(_, known)| *known == choice);
    found.map_or("", |(name, _)| name)
}

/// The `[parameters]` table of a card together with the measures that it is to be read in.
#[derive(Debug)]
pub struct Parameters<'a> {
    section: Section<'a>,
    /// Stress measure of the card.
    pub stress_measure: StressMeasure,
    /// Strain measure of the card.
    pub strain_measure: StrainMeasure,
    values: std::cell::RefCell<Vec<(&'static str, f64, &'static str)>>,
}

impl<'a> Parameters<'a> {
    /// Parameters from the card's section.
    pub fn new(
        section: Section<'a>,
        stress_measure: StressMeasure,
        strain_measure: StrainMeasure,
    ) -> Self {
        Self {
            section,
            stress_measure,
            strain_measure,
            values: std::cell::RefCell::default(),
        }
    }

    /// A parameter with the dimension of a stress, in MPa.
    pub fn stress(&self, key: &'static str, bound: Bound) -> f64 {
        let value = self.section.quantity(key, Dimension::Stress, bound);
        self.values.borrow_mut().push((key, value, "MPa"));
        value
    }

    /// A parameter without a dimension.
    pub fn number(&self, key: &'static str, bound: Bound) -> f64 {
        let value = self.section.number(key, bound);
        self.values.borrow_mut().push((key, value, "–"));
        value
    }

    /// Reports unknown keys and returns what was read: (key, value, unit).
    pub fn finish(self) -> Vec<(&'static str, f64, &'static str)> {
        self.section.unknown_keys();
        self.values.into_inner()
    }
}
