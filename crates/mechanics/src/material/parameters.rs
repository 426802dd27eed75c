//! The parameters of a material card, as a law reads them.

use std::cell::{Cell, RefCell};
use std::f64::consts::FRAC_PI_2;

use super::volume::POISSON_RATIO;
use crate::document::{Bound, Section, name_of};
use crate::units::Dimension;

/// Largest strain that is taken as stated; a larger one may have been meant in percent.
const LARGEST_STRAIN: f64 = 30.0;

/// The stress measure of a curve or a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StressMeasure {
    /// Force per reference area (first Piola–Kirchhoff, engineering stress).
    Nominal,
    /// Force per current area (true stress).
    Cauchy,
}

/// The strain measure of a curve or a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrainMeasure {
    /// ε = λ − 1 (engineering strain).
    Nominal,
    /// ε = ln λ (true strain).
    Logarithmic,
}

/// Treatment of a curve whose stress at rest is not zero.
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

    /// Nominal stress from a stress of this measure at λ = 1 + `x`.
    ///
    /// σ = λ P holds along the axis of any test of an incompressible sheet without shear.
    pub fn to_nominal(self, stress: f64, x: f64) -> f64 {
        match self {
            Self::Nominal => stress,
            Self::Cauchy => stress / (1.0 + x),
        }
    }

    /// A stress of this measure from nominal stress at λ = 1 + `x`.
    pub fn of_nominal(self, nominal: f64, x: f64) -> f64 {
        match self {
            Self::Nominal => nominal,
            Self::Cauchy => nominal * (1.0 + x),
        }
    }

    /// Its name at the beginning of a title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Cauchy => "Cauchy",
        }
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

    /// λ − 1 from a strain of this measure.
    pub fn to_nominal(self, strain: f64) -> f64 {
        match self {
            Self::Nominal => strain,
            Self::Logarithmic => strain.exp_m1(),
        }
    }

    /// A strain of this measure from λ − 1.
    pub fn of_nominal(self, x: f64) -> f64 {
        match self {
            Self::Nominal => x,
            Self::Logarithmic => x.ln_1p(),
        }
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

/// One parameter of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its key on a card.
    pub key: &'static str,
    /// Its value in the internal unit.
    pub value: f64,
    /// Its dimension; a ratio has no unit.
    pub dimension: Dimension,
    /// The values that it may take.
    pub bound: Bound,
    /// Range of the values of usual materials, for a parameter that is not a stress; of an angle, the period of the law.
    pub usual: [f64; 2],
}

impl Parameter {
    /// The internal unit, or a dash.
    pub fn unit(&self) -> &'static str {
        match self.dimension {
            Dimension::Ratio => "–",
            other => other.internal_unit(),
        }
    }

    /// The least size that counts, a thousandth of a usual one; `stress` is a usual stress.
    pub fn least_size(&self, stress: f64) -> f64 {
        const SHARE: f64 = 1e-3;
        let [low, high] = self.usual.map(f64::abs);
        SHARE
            * if self.is_stress() {
                stress
            } else {
                low.max(high)
            }
    }

    /// Whether a value is an angle about which the stresses of a sheet that is stretched along its axes are symmetric.
    pub fn is_symmetric_at(&self, value: f64) -> bool {
        const SAME: f64 = 1e-9;
        let quarters = value / FRAC_PI_2;
        let off = (quarters - quarters.round()).abs() * FRAC_PI_2;
        self.dimension == Dimension::Angle && off < SAME
    }

    /// Whether energy and stress are proportional to it, as they are to every parameter that is a stress.
    pub fn is_stress(&self) -> bool {
        self.dimension == Dimension::Stress
    }

    /// Whether stresses grow with it without limit, as with exponents.
    pub fn is_exponent(&self) -> bool {
        self.dimension == Dimension::Ratio && self.usual[0] > 0.0
    }
}

/// Entries that a law reads from a card.
#[derive(Clone, Debug, Default)]
pub struct CardEntries {
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its choices: key and name.
    pub choices: Vec<(&'static str, String)>,
    /// Parameters that only tests with shear determine, with the values at which fits to others hold them.
    pub of_shear: &'static [(&'static str, f64)],
}

/// The source of the values.
#[derive(Debug)]
enum Origin<'a> {
    Card(Section<'a>),
    Values(&'a [f64]),
}

/// The source of a law's parameters: the `[parameters]` table of a card, or plain values in the order in which the
/// law asks for them. In both cases it records what was asked for.
#[derive(Debug)]
pub struct Parameters<'a> {
    origin: Origin<'a>,
    /// Stress measure of the card.
    pub stress_measure: StressMeasure,
    /// Strain measure of the card.
    pub strain_measure: StrainMeasure,
    asked: RefCell<Vec<Parameter>>,
    choices: RefCell<Vec<(&'static str, String)>>,
    of_shear: Cell<&'static [(&'static str, f64)]>,
}

impl<'a> Parameters<'a> {
    /// Parameters from the card's section.
    pub fn of_card(
        section: Section<'a>,
        stress_measure: StressMeasure,
        strain_measure: StrainMeasure,
    ) -> Self {
        Self::new(Origin::Card(section), stress_measure, strain_measure)
    }

    /// Parameters with the given values, in the order in which the law asks for them; missing ones are NaN.
    pub fn of_values(
        values: &'a [f64],
        stress_measure: StressMeasure,
        strain_measure: StrainMeasure,
    ) -> Self {
        Self::new(Origin::Values(values), stress_measure, strain_measure)
    }

    fn new(
        origin: Origin<'a>,
        stress_measure: StressMeasure,
        strain_measure: StrainMeasure,
    ) -> Self {
        Self {
            origin,
            stress_measure,
            strain_measure,
            asked: RefCell::default(),
            choices: RefCell::default(),
            of_shear: Cell::default(),
        }
    }

    /// A parameter with the dimension of a stress, in MPa.
    pub fn stress(&self, key: &'static str, bound: Bound) -> f64 {
        self.ask(key, Dimension::Stress, bound, [f64::NAN; 2])
    }

    /// A dimensionless parameter; the values of usual materials lie within `usual`.
    pub fn number(&self, key: &'static str, bound: Bound, usual: [f64; 2]) -> f64 {
        self.ask(key, Dimension::Ratio, bound, usual)
    }

    /// μ in MPa and ν of a body that changes its volume.
    pub fn shear_modulus_and_ratio(&self) -> [f64; 2] {
        [
            self.stress("mu", Bound::Positive),
            self.number("poisson_ratio", POISSON_RATIO, [0.0, 0.49]),
        ]
    }

    /// The exponent of a power of the stretches: any number but zero.
    pub fn exponent(&self, key: &'static str) -> f64 {
        let exponent = self.number(key, Bound::Within(-50.0, 50.0), [-8.0, 12.0]);
        if exponent == 0.0 {
            self.fault(key, "must not be zero", "a power of zero has no energy");
        }
        exponent
    }

    /// An angle in rad. Every angle gives the law that one within `period` gives, if need be with other parameters exchanged.
    pub fn angle(&self, key: &'static str, period: [f64; 2]) -> f64 {
        self.ask(key, Dimension::Angle, Bound::Any, period)
    }

    /// Parameters that only tests with shear determine, with the values at which fits to others hold them.
    pub fn hold_without_shear(&self, held: &'static [(&'static str, f64)]) {
        self.of_shear.set(held);
    }

    /// Records that the law takes another value of a parameter than was asked for.
    pub fn replace(&self, key: &'static str, value: f64) -> f64 {
        let mut asked = self.asked.borrow_mut();
        let same = asked.iter_mut().filter(|one| one.key == key);
        same.for_each(|one| one.value = value);
        value
    }

    /// A choice that a card states; the first one where there is no card.
    pub fn choice<T: Copy>(&self, key: &'static str, choices: &[(&'static str, T)]) -> T {
        let chosen = match &self.origin {
            Origin::Card(section) => section
                .choice(key, choices)
                .and_then(|_| {
                    let name = section.text(key);
                    choices.iter().find(|(known, _)| *known == name)
                })
                .unwrap_or(&choices[0]),
            Origin::Values(_) => &choices[0],
        };
        self.choices.borrow_mut().push((key, chosen.0.to_owned()));
        chosen.1
    }

    /// A text that a card states; empty where there is no card.
    pub fn text(&self, key: &'static str) -> String {
        let text = match &self.origin {
            Origin::Card(section) => section.text(key),
            Origin::Values(_) => String::new(),
        };
        self.choices.borrow_mut().push((key, text.clone()));
        text
    }

    /// A known condition of the material in its internal unit, which is never fitted: the card's value, or `standard`
    /// where the card states none; where `standard` is NaN, the card must state a value.
    pub fn condition(&self, key: &'static str, dimension: Dimension, standard: f64) -> f64 {
        let value = match &self.origin {
            Origin::Card(section) if section.has(key) || standard.is_nan() => match dimension {
                Dimension::Ratio => section.number(key, Bound::Any),
                _ => section.quantity(key, dimension, Bound::Positive),
            },
            _ => standard,
        };
        let unit = dimension.internal_unit();
        let statement = format!("{value} {unit}");
        self.choices
            .borrow_mut()
            .push((key, statement.trim_end().to_owned()));
        value
    }

    /// Whether a card states a key.
    pub fn states(&self, key: &'static str) -> bool {
        matches!(&self.origin, Origin::Card(section) if section.has(key))
    }

    /// An optional stress on a card that does not affect the law.
    pub fn remark(&self, key: &'static str) {
        if let Origin::Card(section) = &self.origin
            && section.has(key)
        {
            self.stress(key, Bound::Any);
        }
    }

    /// Two lists of a card, strains and stresses in MPa; empty where there is no card.
    pub fn curve(&self) -> Vec<[f64; 2]> {
        let Origin::Card(section) = &self.origin else {
            return Vec::new();
        };
        let strains = section.multiples("strain", Bound::Any, LARGEST_STRAIN);
        let stresses = section.quantities("stress", Dimension::Stress, Bound::Any);
        if strains.len() != stresses.len() {
            let counts = [stresses.len(), strains.len()];
            let message = format!("has {} values and strain has {}", counts[0], counts[1]);
            section.fault("stress", &message, "give one stress for each strain");
        }
        let pairs = strains.into_iter().zip(stresses);
        pairs.map(<[f64; 2]>::from).collect()
    }

    /// Records a fault about a key of the card.
    pub fn fault(&self, key: &'static str, message: &str, hint: &str) {
        if let Origin::Card(section) = &self.origin {
            section.fault(key, message, hint);
        }
    }

    /// Reports unknown keys and returns the entries that were read.
    pub fn finish(self) -> CardEntries {
        self.finish_with(|_| None)
    }

    /// [`Self::finish`] with a remedy for an unknown key.
    pub fn finish_with(self, remedy: impl Fn(&str) -> Option<String>) -> CardEntries {
        if let Origin::Card(section) = &self.origin {
            section.unknown_keys_with(remedy);
        }
        CardEntries {
            parameters: self.asked.into_inner(),
            choices: self.choices.into_inner(),
            of_shear: self.of_shear.get(),
        }
    }

    fn ask(&self, key: &'static str, dimension: Dimension, bound: Bound, usual: [f64; 2]) -> f64 {
        let mut asked = self.asked.borrow_mut();
        let value = match &self.origin {
            Origin::Card(section) if dimension == Dimension::Ratio => section.number(key, bound),
            Origin::Card(section) => section.quantity(key, dimension, bound),
            Origin::Values(values) => values.get(asked.len()).copied().unwrap_or(f64::NAN),
        };
        asked.push(Parameter {
            key,
            value,
            dimension,
            bound,
            usual,
        });
        value
    }
}
