//! Material cards: a law, its parameters with units, and where they come from.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::law::HyperelasticLaw;
use super::neo_hooke::NeoHooke;
use super::parameters::{OffsetTreatment, Parameter, Parameters, StrainMeasure, StressMeasure};
use super::registry::{CARDS, LAWS, Law};
use super::softened_law::SoftenedLaw;
use super::softening::Softening;
use super::viscosity::{Covered, Relaxation, ViscousMaterial};
use super::volume::Volume;
use crate::document::{Bound, Document, Faults, Key, Section, file, read_text};
use crate::error::{Diagnostic, Error, nearest};
use crate::units::Dimension;

mod changed;
mod energy;
mod parameter_uncertainty;
mod provenance;
mod published;
mod resistance;

pub use parameter_uncertainty::ParameterUncertainty;

/// A material: law, parameters and provenance.
#[derive(Clone, Debug)]
pub struct Card {
    /// The name by which it was loaded.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// The law's name: in the registry, or that of a law that a program defines.
    pub law_name: String,
    /// The law's formula, in the convention of the card; [`energy`](Card::energy) adds the change of volume.
    pub formula: &'static str,
    /// The law with its parameters, including the resistance to a change of volume.
    pub law: Arc<dyn HyperelasticLaw>,
    /// The law without the card's change of volume; `None` where the card states none.
    pub isochoric: Option<Arc<dyn HyperelasticLaw>>,
    /// How the material resists a change of volume; `None` where it keeps its volume.
    pub volume: Option<Volume>,
    /// Poisson's ratio, where the card states it and the bulk modulus follows from it.
    pub poisson_ratio: Option<f64>,
    /// The parameters in internal units.
    pub parameters: Vec<Parameter>,
    /// Other entries of the law: key and choice.
    pub choices: Vec<(&'static str, String)>,
    /// Mass density in tonne/mm³; `None` where the card does not state it.
    pub density: Option<f64>,
    /// The viscous part; empty where the card does not state it.
    pub viscosity: ViscousMaterial,
    /// The stress measure of the curve behind the card.
    pub stress_measure: StressMeasure,
    /// The strain measure of the curve behind the card.
    pub strain_measure: StrainMeasure,
    /// The treatment of a stress at rest.
    pub offset: OffsetTreatment,
    /// The kind of test behind the card.
    pub test: String,
    /// The stretches within which the card was calibrated; those that curves are drawn for where the card does not state them.
    pub stretch_range: [f64; 2],
    /// Whether the card states the range.
    pub range_is_stated: bool,
    /// Full citation.
    pub citation: String,
    /// DOI; empty when the source has none.
    pub doi: String,
    /// What was tested.
    pub specimen: String,
    /// Remarks for users; may be empty.
    pub note: String,
    /// How the card was fitted; `None` where it was not.
    pub fit: Option<FitRecord>,
    /// The card's text as it was read.
    pub text: String,
    /// A file of this shipped card's name with another text, which was not read.
    pub overlooked: Option<PathBuf>,
}

/// A file of a shipped card's name, beside a study or in its or this folder's `materials`, whose text is not the shipped one.
fn overlooked(name: &str, folder: &Path, shipped: &str) -> Option<PathBuf> {
    let file = format!("{name}.toml");
    let candidates = [
        folder.join(&file),
        folder.join("materials").join(&file),
        Path::new("materials").join(&file),
    ];
    candidates
        .into_iter()
        .find(|path| std::fs::read_to_string(path).is_ok_and(|text| text != shipped))
}

/// What is needed to fit a card again.
#[derive(Clone, Debug)]
pub struct FitRecord {
    /// The files of test data, relative to the card.
    pub data: Vec<String>,
    /// Statements that the files do not contain: `key: value`.
    pub reading: Vec<String>,
    /// The weighting's name.
    pub weighting: String,
    /// The number of starts that were improved.
    pub starts: usize,
    /// Bounds as `key=low..high`.
    pub bounds: Vec<String>,
    /// The number of fitted terms of a Prony series; `None` where the law alone was fitted.
    pub relaxation_terms: Option<usize>,
    /// Whether softening was fitted.
    pub softening: bool,
    /// The card, relative to this one, whose law is the base of the fitted softening; `None` where the law was fitted with it.
    pub base_card: Option<String>,
    /// What the fit found: `key = value` in internal units; empty where it was not recorded.
    pub values: Vec<String>,
    /// The uncertainty of the law's parameters; `None` where the residuals were no noise, or nothing is recorded.
    pub uncertainty: Option<ParameterUncertainty>,
}

impl Card {
    /// Finds a card by the name of a shipped one, or by the path of a file ending in `.toml`,
    /// relative to `folder`.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault of the card.
    pub fn load(name: &str, folder: &Path) -> Result<Self, Error> {
        if let Some((_, text)) = CARDS.iter().find(|(known, _)| *known == name) {
            let mut card = Self::parse(name, &format!("materials/{name}.toml"), text)?;
            card.overlooked = overlooked(name, folder, text);
            return Ok(card);
        }
        if Path::new(name)
            .extension()
            .is_none_or(|extension| extension != "toml")
        {
            return Err(Error::Input(vec![unknown_card(name)]));
        }
        let path = folder.join(name);
        let hint = "a card is TOML in UTF-8; its path in a study is relative to the study";
        let text = read_text(&path, file::MOST_OF_A_STUDY, hint)?;
        Self::parse(name, &path.display().to_string(), &text)
    }

    /// Reads a card's text.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault of the card.
    pub fn parse(name: &str, file: &str, text: &str) -> Result<Self, Error> {
        let faults = Faults::default();
        let card = Self::read(name, file, text, &faults);
        faults.finish()?;
        Ok(card)
    }

    /// The keys that are looked up when a card's text is read.
    pub fn keys(text: &str) -> Vec<Key> {
        let faults = Faults::default();
        Self::read("", "", text, &faults);
        faults.keys()
    }

    /// Reads a card; its faults are recorded.
    fn read(name: &str, file: &str, text: &str, faults: &Faults) -> Self {
        let document = Document::parse(file, text, faults);
        let root = document.root(None, faults);
        let unread = Arc::new(NeoHooke { c10: f64::NAN });
        let mut card = Self::of_law(name, unread, [1.0, 1.0]);
        card.text = text.to_owned();
        if root.has("title") {
            card.title = root.text("title");
        }
        let laws: Vec<_> = LAWS.iter().map(|law| (law.name, law)).collect();
        let law = root.choice("law", &laws);
        card.density = root.optional_quantity("density", Dimension::Density, Bound::Positive);
        if root.has("viscosity") {
            card.viscosity = read_viscosity(&root.section("viscosity"));
        }
        let softening = root.stated("softening", Section::section);
        let softening = softening.map(|section| Softening::read(&section));
        let is_curve = law.is_some_and(|law| law.is_measured_curve());
        card.read_data(&root.section("data"), is_curve);
        card.read_source(&root.section("source"));
        let fit = root.stated("fit", Section::section);
        card.fit = fit.map(|section| read_fit(&section));
        let parameters = root.section("parameters");
        let volume = root.stated("volume", Section::section);
        root.unknown_keys();
        let Some(law) = law else {
            return card;
        };
        let parameters = Parameters::of_card(parameters, card.stress_measure, card.strain_measure);
        card.law = (law.read)(&parameters).into();
        let entries = parameters.finish_with(|key| of_other_laws(key, law.name));
        (card.parameters, card.choices) = (entries.parameters, entries.choices);
        (card.law_name, card.formula) = (law.name.to_owned(), law.formula_of(&card.choices));
        if let Some(volume) = volume {
            card.resist(&volume);
        }
        if let Some(softening) = softening {
            card.law = Arc::new(SoftenedLaw::unloaded(card.law, softening));
        }
        card
    }

    /// A card of any law, in the registry or not, for the stretches within `stretch_range`: studies run with it as with a card
    /// that was read. Other entries of a card (density, viscosity, formula, source) are set in its fields.
    pub fn of_law(name: &str, law: Arc<dyn HyperelasticLaw>, stretch_range: [f64; 2]) -> Self {
        let unstated = || "not stated".to_owned();
        Self {
            name: name.to_owned(),
            title: name.to_owned(),
            law_name: name.to_owned(),
            formula: "not stated",
            law,
            isochoric: None,
            volume: None,
            poisson_ratio: None,
            parameters: Vec::new(),
            choices: Vec::new(),
            density: None,
            viscosity: ViscousMaterial::default(),
            stress_measure: StressMeasure::Nominal,
            strain_measure: StrainMeasure::Nominal,
            offset: OffsetTreatment::Subtract,
            test: "no".to_owned(),
            stretch_range,
            range_is_stated: true,
            citation: unstated(),
            doi: String::new(),
            specimen: unstated(),
            note: String::new(),
            fit: None,
            text: String::new(),
            overlooked: None,
        }
    }

    /// The value of a parameter in internal units.
    pub fn parameter(&self, key: &str) -> Option<f64> {
        self.parameters
            .iter()
            .find(|parameter| parameter.key == key)
            .map(|parameter| parameter.value)
            .or_else(|| match key {
                "poisson_ratio" => self.poisson_ratio,
                "bulk_modulus" => self.bulk_modulus(),
                _ => None,
            })
    }
}

/// Reads the viscous part of a material from its section.
pub fn read_viscosity(section: &Section) -> ViscousMaterial {
    let shear = section.optional_quantity("shear", Dimension::Viscosity, Bound::NonNegative);
    let terms = section.optional_tables("relaxation");
    let term = |term: &Section| {
        let read = Relaxation {
            share: term.quantity("share", Dimension::Ratio, Bound::Within(0.0, 0.999)),
            time: term.quantity("time", Dimension::Time, Bound::Positive),
        };
        term.unknown_keys();
        read
    };
    let relaxation: Vec<Relaxation> = terms.iter().map(term).collect();
    if relaxation.iter().map(|term| term.share).sum::<f64>() > 0.999 {
        let hint = "they are fractions of the instantaneous stress after a sudden stretch; the rest is the long-term stress";
        section.fault("relaxation", "the shares must add up to less than 1", hint);
    }
    let range = |key: &'static str, dimension, bound| match section
        .stated(key, |_, key| section.quantities(key, dimension, bound))?[..]
    {
        [low, high] if low <= high => Some([low, high]),
        _ => {
            let hint = "the smallest and the largest one that the data cover";
            section.fault(key, "must be two values in order", hint);
            None
        }
    };
    let covered = Covered {
        times: range("times", Dimension::Time, Bound::Positive),
        rates: range("rates", Dimension::Frequency, Bound::Positive),
    };
    section.unknown_keys();
    ViscousMaterial {
        shear_viscosity: shear.unwrap_or(0.0),
        relaxation,
        covered,
    }
}

fn read_fit(section: &Section) -> FitRecord {
    let record = FitRecord {
        data: section.texts("data"),
        reading: section.optional_texts("reading"),
        weighting: section.text("weighting"),
        starts: section.count("starts", 1, 1000),
        bounds: section.optional_texts("bounds"),
        relaxation_terms: section.stated("relaxation_terms", |_, key| section.count(key, 0, 6)),
        softening: section.has("softening") && section.flag("softening"),
        base_card: section.stated("base_card", Section::text),
        values: section.optional_texts("values"),
        uncertainty: ParameterUncertainty::read(section),
    };
    section.unknown_keys();
    record
}

/// Names under which moduli of a material at rest are often written, which most laws do not have as parameters.
const MODULI: [&str; 7] = [
    "young",
    "youngs_modulus",
    "e",
    "E",
    "poisson_ratio",
    "poisson",
    "nu",
];

/// Advice on a parameter that only other laws have.
fn of_other_laws(key: &str, law_name: &str) -> Option<String> {
    if MODULI.contains(&key) {
        return Some(format!(
            "`gelbench materials new --law {law_name} --young \"20 kPa\" --poisson 0.45` makes a card of Young's modulus and Poisson's ratio; on a \
             card the latter stands under [volume] as poisson_ratio"
        ));
    }
    let has = |law: &&Law| {
        let (_, entries) = law.unknown();
        entries
            .parameters
            .iter()
            .any(|parameter| parameter.key == key)
            || entries.choices.iter().any(|(known, _)| *known == key)
    };
    let laws: Vec<_> = LAWS.iter().filter(has).map(|law| law.name).collect();
    (!laws.is_empty()).then(|| {
        let laws = laws.join(", ");
        format!(
            "a card has one law, and {law_name} has no {key}: leave it out, or take another law ({laws})"
        )
    })
}

fn unknown_card(name: &str) -> Diagnostic {
    let known: Vec<_> = CARDS.iter().map(|(known, _)| *known).collect();
    let hint = match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!(
            "shipped cards: {}; a card of your own is given as a path ending in .toml",
            known.join(", ")
        ),
    };
    Diagnostic::error("material.card", format!("there is no card `{name}`")).hint(hint)
}

#[cfg(test)]
mod tests;
