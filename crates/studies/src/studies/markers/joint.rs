//! Parameters of laws from all frames of one or more specimens together.
//!
//! ```text
//! specimens ─▶ JointStudy ─estimate─▶ one JointEstimate per law, the first one's card ─▶ every specimen corrected with it
//! ```

use std::path::Path;

use super::{Conditions, MarkerStudy};
use crate::error::{Diagnostic, Error};
use crate::estimation::{
    FieldEstimate, JointEstimate, JointFrame, JointSettings, Knowledge, RegressedLaw, Robust,
    Watch, check_joint_frames, estimate_jointly,
};
use crate::material::Card;

mod card;
mod report;
mod results;

pub use results::{KIND, results, undetermined};

/// A specimen and its name.
pub type NamedSpecimen = (String, MarkerStudy);

/// Specimens and laws.
#[derive(Debug)]
pub struct JointStudy {
    /// The specimens; the law of each is that of its card, whose parameters are to be estimated.
    pub specimens: Vec<NamedSpecimen>,
    /// The laws: the first one is that of the results, the others are compared with it.
    pub cards: Vec<Card>,
    /// The parameters of the first law that are estimated; for all other laws all of them are.
    pub fit: Vec<String>,
    /// How they are estimated.
    pub settings: JointSettings,
}

/// The results of all laws.
#[derive(Debug)]
pub struct JointResults {
    /// The first law.
    pub estimate: JointEstimate,
    /// Its card with the estimated values.
    pub card: Card,
    /// The estimates of the other laws in the order of their cards, or why there is none.
    pub others: Vec<Result<JointEstimate, Error>>,
}

/// A specimen that was corrected with the estimated law.
#[derive(Debug)]
pub struct CorrectedSpecimen {
    /// Its name.
    pub name: String,
    /// The specimen with the estimated card.
    pub study: MarkerStudy,
    /// Its frames.
    pub estimates: Vec<FieldEstimate>,
    /// The number of doubts about their figures.
    pub doubts: usize,
}

impl JointStudy {
    /// Checks that the specimens can be distinguished, and that the laws have their parameters.
    ///
    /// # Errors
    /// [`Error::Input`] with the faults.
    pub fn check(&self) -> Result<(), Error> {
        for (index, (name, specimen)) in self.specimens.iter().enumerate() {
            if self.specimens[..index]
                .iter()
                .any(|(other, _)| other == name)
            {
                return Err(Error::input(
                    format!("two specimens have the name `{name}`"),
                    "give each a `name` of its own under [specimen]",
                ));
            }
            if specimen.coarse.is_some() {
                return Err(Error::input(
                    format!(
                        "the field of `{name}` is transferred to another mesh, and then has no noise that could weight it"
                    ),
                    "leave out its mesh",
                ));
            }
        }
        for index in 0..self.cards.len() {
            self.law(index)?;
        }
        check_joint_frames(&self.frames())
    }

    /// Estimates the parameters of all laws.
    ///
    /// # Errors
    /// As [`estimate_jointly`] for the first law.
    pub fn estimate(&self, watch: Watch) -> Result<JointResults, Error> {
        let frames = self.frames();
        let of = |index: usize| {
            let name = &self.cards[index].name;
            let settings = JointSettings {
                profiles: index == 0 && self.settings.profiles,
                ..self.settings
            };
            let law = self.law(index)?;
            estimate_jointly(&frames, &law, &settings, &|action| {
                watch(&format!("{name}: {action}"))
            })
        };
        let estimate = of(0)?;
        Ok(JointResults {
            card: card::with_values(&self.cards[0], &estimate, &self.specimen_words())?,
            others: (1..self.cards.len()).map(of).collect(),
            estimate,
        })
    }

    fn law(&self, index: usize) -> Result<RegressedLaw, Error> {
        let keys: Vec<&str> = match index {
            0 => self.fit.iter().map(String::as_str).collect(),
            _ => vec!["all"],
        };
        Ok(RegressedLaw::of_card(&self.cards[index], &keys)?)
    }

    fn frames(&self) -> Vec<JointFrame<'_>> {
        let studies = self.specimens.iter().map(|(_, study)| study);
        studies.flat_map(MarkerStudy::joint_frames).collect()
    }

    /// The names of the specimens with the numbers of their frames.
    fn specimen_words(&self) -> String {
        let words = |(name, study): &NamedSpecimen| match study.series.frames.len() {
            1 => format!("{name} (1 frame)"),
            count => format!("{name} ({count} frames)"),
        };
        self.specimens
            .iter()
            .map(words)
            .collect::<Vec<_>>()
            .join(", ")
    }
}

impl MarkerStudy {
    fn joint_frames(&self) -> Vec<JointFrame<'_>> {
        let frames = self.series.frames.iter();
        frames
            .map(|frame| JointFrame {
                specimen: self.specimen(),
                markers: &frame.markers,
                knowledge: Knowledge {
                    robust: self.conditions.robust.unwrap_or(Robust::Tukey),
                    edge_gap: self.unknown_gap,
                    ..self.conditions.knowledge(frame.number, None)
                },
            })
            .collect()
    }

    /// The study with another card, whose law is not regressed; forces are only compared with those of the field.
    #[must_use]
    pub fn with_card(&self, card: &Card) -> Self {
        let mut other = Self {
            card: card.clone(),
            regressed: None,
            ..self.clone()
        };
        other.conditions.fit.clear();
        other.conditions.forces_are_checks = true;
        other.warnings.push(given_the_law());
        other
    }
}

/// The warning that the intervals of a field, whose law was estimated from several fields, do not include the law's uncertainty.
pub fn given_the_law() -> Diagnostic {
    let message = "intervals of displacements, stresses and forces apply to the estimated parameter values: the uncertainty of the parameters is not included";
    Diagnostic::warning("", message).hint("where a parameter scales the stress, add its relative interval to those of forces and stresses")
}

impl Conditions {
    /// Refuses what belongs to a specimen's file.
    ///
    /// # Errors
    /// [`Error::Input`] where the file names a specimen.
    pub fn without_specimen(self, path: &Path) -> Result<Self, Error> {
        match &self.specimen {
            None => Ok(self),
            Some(_) => Err(Error::input(
                format!("{} has a [specimen]", path.display()),
                "name the file with --specimen, or leave out that section",
            )),
        }
    }
}
