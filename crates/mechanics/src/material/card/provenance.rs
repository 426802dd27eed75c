//! Where a card's values come from: a card is used without that, and shared only with it.

use super::Card;
use crate::document::{Bound, Document, Faults, Section};
use crate::error::Error;
use crate::material::parameters::{OffsetTreatment, StrainMeasure, StressMeasure};

/// The stretches that curves are drawn for where a card states no range.
const DRAWN: [f64; 2] = [0.5, 3.0];

/// Beginnings of texts without content.
const UNSTATED: &str = "not stated";

/// What a card has to state before it is shared: table, key, and an example of its value.
const SHARED: [(&str, &str, &str); 8] = [
    ("", "title", "\"silicone rubber, Shore A 30\""),
    (
        "data",
        "test",
        "\"uniaxial\", or \"none\" where nothing was tested",
    ),
    ("data", "stress_measure", "\"nominal\""),
    ("data", "strain_measure", "\"nominal\""),
    ("data", "offset", "\"subtract\""),
    ("data", "stretch_range", "[1.0, 1.5]"),
    ("source", "citation", "\"A. Author, Journal 1 (2026) 1-10\""),
    (
        "source",
        "specimen",
        "\"strip, 20 mm × 4 mm × 1 mm, at 22 °C\"",
    ),
];

impl Card {
    /// Reads the measures and the range of the data. Only a law that is a measured curve has to have its measures.
    pub(super) fn read_data(&mut self, data: &Section, is_curve: bool) {
        let stress = chosen(data, "stress_measure", &StressMeasure::NAMES, is_curve);
        self.stress_measure = stress.unwrap_or(StressMeasure::Nominal);
        let strain = chosen(data, "strain_measure", &StrainMeasure::NAMES, is_curve);
        self.strain_measure = strain.unwrap_or(StrainMeasure::Nominal);
        let offset = chosen(data, "offset", &OffsetTreatment::NAMES, false);
        self.offset = offset.unwrap_or(OffsetTreatment::Subtract);
        let test = data.stated("test", Section::text);
        self.test = test.unwrap_or_else(|| "none".to_owned());
        let range = data.stated("stretch_range", |_, _| read_range(data));
        self.range_is_stated = range.is_some();
        self.stretch_range = range.unwrap_or(DRAWN);
        data.unknown_keys();
    }

    /// Reads the source, as far as the card states it.
    pub(super) fn read_source(&mut self, source: &Section) {
        for (key, text) in [
            ("citation", &mut self.citation),
            ("specimen", &mut self.specimen),
        ] {
            if source.has(key) {
                *text = source.text(key);
            }
        }
        self.doi = source.optional_text("doi");
        self.note = source.optional_text("note");
        source.unknown_keys();
    }

    /// Reads a card that others are to use: it states its title, the test behind it with measures and range, citation and specimen.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault and everything that is missing.
    pub fn parse_shared(name: &str, file: &str, text: &str) -> Result<Self, Error> {
        let faults = Faults::default();
        let card = Self::read(name, file, text, &faults);
        let document = Document::parse(file, text, &Faults::default());
        let root = document.root(None, &faults);
        require_provenance(&root);
        faults.finish()?;
        Ok(card)
    }

    /// ` (uniaxial test)`; empty where the card is not based on a test.
    pub fn in_tests(&self) -> String {
        match &*self.test {
            "none" => String::new(),
            test => format!(" ({test} test)"),
        }
    }

    /// Describes the range of stretches: `λ = 1 … 2 (uniaxial test)`.
    pub fn describe_range(&self) -> String {
        let [low, high] = self.stretch_range;
        if self.range_is_stated {
            format!("λ = {low} … {high}{}", self.in_tests())
        } else {
            format!("not stated; curves are drawn for λ = {low} … {high}")
        }
    }

    /// Whether the card may be used at the stretch `lambda`; a card without a range may be used at any.
    pub fn covers(&self, lambda: f64) -> bool {
        let [low, high] = self.stretch_range;
        !self.range_is_stated || (low..=high * (1.0 + 1e-12)).contains(&lambda)
    }
}

/// A choice of the section that is optional unless it is required.
fn chosen<T: Copy>(
    section: &Section,
    key: &'static str,
    names: &[(&'static str, T)],
    is_required: bool,
) -> Option<T> {
    (section.has(key) || is_required)
        .then(|| section.choice(key, names))
        .flatten()
}

/// The stretches of the data: two in ascending order.
fn read_range(data: &Section) -> [f64; 2] {
    let range = data.multiples("stretch_range", Bound::Positive, f64::INFINITY);
    match range[..] {
        [low, high] if low < high => [low, high],
        _ => {
            let message = "must be two increasing stretches";
            data.fault("stretch_range", message, "such as [1.0, 2.0]");
            DRAWN
        }
    }
}

/// Records what is missing of a card that is to be shared.
fn require_provenance(root: &Section) {
    for (table, key, example) in SHARED {
        let nested = (!table.is_empty()).then(|| root.section(table));
        let section = nested.as_ref().unwrap_or(root);
        let says_nothing = section.has(key)
            && ["title", "citation", "specimen"].contains(&key)
            && section.text(key).starts_with(UNSTATED);
        if says_nothing || !section.has(key) {
            let position = match table {
                "" => "at the top".to_owned(),
                table => format!("under [{table}]"),
            };
            let hint =
                format!("a card that others use states it {position}, such as `{key} = {example}`");
            section.fault(key, "is not stated", &hint);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::registry::CARDS;

    const BARE: &str = "law = \"neo-hooke\"\n[parameters]\nc10 = \"3 kPa\"\n";

    #[test]
    fn a_card_is_used_without_provenance() {
        let card = Card::parse("gel", "gel.toml", BARE).unwrap();
        assert_eq!((&*card.title, &*card.citation), ("gel", "not stated"));
        assert!(card.covers(7.0) && card.describe_range().starts_with("not stated"));
        assert!((card.law.youngs_modulus() - 0.018).abs() < 1e-15);
    }

    #[test]
    fn a_shared_card_states_its_provenance() {
        let Err(Error::Input(faults)) = Card::parse_shared("gel", "gel.toml", BARE) else {
            panic!("accepted")
        };
        assert_eq!(faults.len(), SHARED.len(), "{faults:#?}");
        assert!(faults[7].hint.as_ref().unwrap().contains("under [source]"));
        for (name, text) in CARDS {
            assert!(Card::parse_shared(name, name, text).is_ok(), "{name}");
        }
        let empty = CARDS[0]
            .1
            .replace("specimen = \"10 %", "specimen = \"not stated: 10 %");
        assert!(Card::parse_shared("gel", "gel.toml", &empty).is_err());
    }

    /// A curve of another measure is another material.
    #[test]
    fn a_measured_curve_has_its_measures() {
        let text =
            "law = \"marlow-exponential\"\n[parameters]\namplitude = \"61 kPa\"\nexponent = 2.2\n";
        let Err(Error::Input(faults)) = Card::parse("gel", "gel.toml", text) else {
            panic!("accepted")
        };
        let keys: Vec<&str> = faults.iter().map(|fault| &*fault.key).collect();
        assert_eq!(keys, ["data.stress_measure", "data.strain_measure"]);
    }
}
