//! Materials: a card whose parameters are moved, and laws fitted to tests.

use serde::{Deserialize, Serialize};

use gelbench::calibration::{self, Fit, FitSettings, Provenance, TestData};
use gelbench::document::Statements;
use gelbench::error::Error;
use gelbench::material::Card;
use gelbench::material::curve::Mode;
use gelbench::material::registry::Law;
use gelbench::material::stability::stable_range;
use gelbench::results::Drawing;
use gelbench_calibration::calibration::{StableRange, refuse_repeated};
use gelbench_report::results::{LineChart, fit_picture, tests_chart};

use super::background::Worker;
use super::engine::Fault;
use super::scene::CardFile;

/// A file of test data.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct TestFile {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub text: String,
}

/// Tests and the laws that shall be fitted to them.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct FitQuestion {
    /// The files; all are fitted together.
    pub tests: Vec<TestFile>,
    /// What the files do not state.
    pub reading: Statements,
    /// The law; all laws where there is none.
    pub law: Option<String>,
    /// Whether laws are fitted, or the tests are only looked at.
    pub fit: bool,
}

/// What came of a question.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct FitAnswer {
    /// The points of the tests.
    pub measured: LineChart,
    /// The laws, where they were fitted.
    pub ranking: Option<Ranking>,
}

/// A fitted law.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Fitted {
    /// Its law.
    pub law: String,
    /// Its energy.
    pub formula: String,
    /// Key, value and uncertainty of every parameter.
    pub parameters: Vec<[String; 3]>,
    /// Root mean square of the residuals in MPa.
    pub rmse: f64,
    /// Mean absolute difference in %.
    pub nmad_percent: f64,
    /// Akaike's corrected criterion, by which laws are ranked.
    pub aicc: f64,
    /// Whether it is stable over the data.
    pub stable: bool,
    /// The stretches within which it is stable, test by test.
    pub ranges: Vec<(String, [f64; 2])>,
    /// The verdict on the residuals, in a sentence.
    pub verdict: String,
    /// What must be known before it is used.
    pub warnings: Vec<String>,
    /// Data, curve and residuals.
    pub charts: Vec<LineChart>,
    /// Its card.
    pub card: String,
}

/// Fits, the best one first, and the laws that could not be fitted with the reason.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Ranking {
    /// The fits.
    pub fits: Vec<Fitted>,
    /// The reasons of the others.
    pub without: Vec<String>,
}

/// Fits laws to tests.
#[derive(Default)]
pub struct Fitter;

impl Worker for Fitter {
    type Question = FitQuestion;
    type Answer = Result<FitAnswer, Fault>;
    const NAME: &'static str = "fitter";

    fn answer(&mut self, question: &FitQuestion) -> Result<FitAnswer, Fault> {
        let tests = read(&question.tests, &question.reading)?;
        let ranking = question.fit.then(|| fit(question, &tests)).transpose()?;
        Ok(FitAnswer {
            measured: tests_chart(&tests),
            ranking,
        })
    }
}

fn fit(question: &FitQuestion, tests: &[TestData]) -> Result<Ranking, Error> {
    let settings = FitSettings::default();
    let (fits, without) = match &question.law {
        Some(name) => {
            let law = Law::named(name).ok_or_else(|| {
                Error::input(
                    format!("there is no law `{name}`"),
                    "choose one from the list",
                )
            })?;
            (vec![calibration::fit(law, tests, &settings)?], Vec::new())
        }
        None => calibration::rank(tests, &settings),
    };
    let provenance = Provenance {
        files: question
            .tests
            .iter()
            .map(|file| file.name.clone())
            .collect(),
        reading: question.reading.clone(),
        base_card: None,
    };
    let fitted = |fit: &Fit| fitted(fit, &fit.fitted_tests(tests), &provenance);
    Ok(Ranking {
        fits: fits.iter().map(fitted).collect(),
        without,
    })
}

/// Reads files of test data.
///
/// # Errors
/// [`Error::Input`] with what is wrong, or what must be stated because a file does not.
pub fn read(files: &[TestFile], reading: &Statements) -> Result<Vec<TestData>, Error> {
    let each = files.iter();
    let tests = each.map(|file| TestData::parse(&file.name, &file.text, reading));
    let tests = tests.collect::<Result<Vec<_>, _>>()?;
    refuse_repeated(&tests)?;
    Ok(tests)
}

fn fitted(fit: &Fit, tests: &[TestData], provenance: &Provenance) -> Fitted {
    let quality = &fit.quality;
    let parameter = |index: usize| {
        let (parameter, estimate) = (&fit.parameters[index], &quality.estimates[index]);
        let value = format!("{} {}", figures(parameter.value, 6), parameter.unit());
        let [low, high] = estimate.interval;
        let uncertainty = match (quality.at_bound[index], quality.has_intervals()) {
            _ if quality.held[index] => "held, not fitted".to_owned(),
            (true, _) => "at a bound".to_owned(),
            (_, false) => "no interval".to_owned(),
            _ => format!("95 % {} … {}", figures(low, 5), figures(high, 5)),
        };
        [parameter.key.to_owned(), value, uncertainty]
    };
    let charts = match fit_picture(fit, tests) {
        Drawing::Charts(charts) => charts.into_iter().map(|(chart, _)| chart).collect(),
        _ => Vec::new(),
    };
    let range = |range: &StableRange| (range.mode.name().to_owned(), range.stretches);
    Fitted {
        law: fit.law.name.to_owned(),
        formula: fit.law.formula.to_owned(),
        parameters: (0..fit.parameters.len()).map(parameter).collect(),
        rmse: quality.rmse,
        nmad_percent: quality.nmad_percent,
        aicc: quality.aicc,
        stable: quality.is_stable(),
        ranges: quality.stable.iter().map(range).collect(),
        verdict: quality
            .verdict
            .map(|verdict| verdict.sentence())
            .unwrap_or_default(),
        warnings: quality.warnings.clone(),
        charts,
        card: calibration::card_text(fit, tests, provenance),
    }
}

/// So many figures of a value, however small it is.
fn figures(value: f64, count: usize) -> String {
    let size = value.abs().log10().floor();
    if (-4.0..count as f64).contains(&size) {
        format!("{value:.*}", (count as f64 - 1.0 - size) as usize)
    } else if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.*e}", count - 1)
    }
}

impl CardFile {
    /// The card as the library reads it.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault.
    pub fn read(&self) -> Result<Card, Error> {
        Card::parse(&self.name, &self.reference(), &self.text)
    }

    /// The card with another value of a parameter, in its internal unit; it is the user's own from then on.
    pub fn with_parameter(&self, card: &Card, key: &str, value: f64) -> Option<Self> {
        let mut table = self.text.parse::<toml::Table>().ok()?;
        let parameter = card.parameters.iter().find(|known| known.key == key)?;
        let entry = table.get_mut("parameters")?.as_table_mut()?.get_mut(key)?;
        *entry = match parameter.unit() {
            "–" => value.into(),
            unit => format!("{value} {unit}").into(),
        };
        let name = if self.is_shipped() {
            format!("my-{}", self.name)
        } else {
            self.name.clone()
        };
        let text = table.to_string();
        Some(Self { name, text })
    }
}

/// The stretches within which a card's law is stable in the usual tests (Drucker).
pub fn stable_ranges(card: &Card) -> Vec<(&'static str, [f64; 2])> {
    let range = |(name, mode): (&'static str, Mode)| (name, stable_range(&*card.law, mode));
    Mode::ALL.into_iter().map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn treloar() -> TestFile {
        TestFile {
            name: "treloar_1944_uniaxial.csv".into(),
            text: include_str!("../../../materials/data/treloar_1944_uniaxial.csv").into(),
        }
    }

    #[test]
    fn values_are_seen_however_small_they_are() {
        for (value, seen) in [
            (23.4027684, "23.4028"),
            (-0.000512345678, "-0.000512346"),
            (4.81e-12, "4.81000e-12"),
            (1234567.0, "1.23457e6"),
            (999999.4, "999999"),
            (0.0, "0"),
        ] {
            assert_eq!(figures(value, 6), seen);
        }
    }

    #[test]
    fn a_fit_is_what_the_command_finds_and_its_card_can_be_read() {
        let question = FitQuestion {
            tests: vec![treloar()],
            law: Some("yeoh".into()),
            fit: true,
            ..FitQuestion::default()
        };
        let ranking = Fitter.answer(&question).unwrap().ranking.unwrap();
        let fit = &ranking.fits[0];
        // The guide: `gelbench materials fit materials/data/treloar_1944_uniaxial.csv --law yeoh`.
        assert_eq!(fit.parameters[0], ["c10", "0.176284 MPa", "no interval"]);
        assert_eq!(fit.charts.len(), 2);
        let card = CardFile {
            name: "fitted".into(),
            text: fit.card.clone(),
        };
        assert_eq!(card.read().unwrap().law_name, "yeoh");
    }

    #[test]
    fn what_a_file_does_not_say_must_be_stated() {
        let bare = TestFile {
            name: "bare.csv".into(),
            text: "strain,stress\n0.1,0.01\n0.2,0.02\n0.3,0.03\n0.4,0.05\n".into(),
        };
        let mut question = FitQuestion {
            tests: vec![bare],
            law: Some("neo-hooke".into()),
            fit: true,
            ..FitQuestion::default()
        };
        let fault = Fitter.answer(&question).unwrap_err();
        assert!(!fault.message.is_empty());
        for (key, value) in [
            ("test", "uniaxial"),
            ("stress measure", "nominal"),
            ("strain measure", "nominal"),
            ("stress unit", "MPa"),
            ("strain unit", "-"),
        ] {
            question.reading.insert(key.into(), value.into());
        }
        let ranking = Fitter.answer(&question).unwrap().ranking.unwrap();
        assert_eq!(ranking.fits.len(), 1, "{fault:?}");
    }

    #[test]
    fn a_moved_parameter_is_in_the_card_and_the_card_is_no_longer_the_shipped_one() {
        let shipped = CardFile::shipped("meunier-yeoh").unwrap();
        let card = shipped.read().unwrap();
        for parameter in &card.parameters {
            let moved = shipped
                .with_parameter(&card, parameter.key, 1.5 * parameter.value)
                .unwrap();
            let read = moved.read().unwrap();
            let changed = read
                .parameters
                .iter()
                .find(|other| other.key == parameter.key)
                .unwrap();
            assert!((changed.value / parameter.value - 1.5).abs() < 1e-12);
            assert!(!moved.is_shipped());
        }
    }

    #[test]
    fn every_shipped_parameter_can_be_moved() {
        for (name, _) in gelbench::material::registry::CARDS {
            let shipped = CardFile::shipped(name).unwrap();
            let card = shipped.read().unwrap();
            for parameter in &card.parameters {
                let moved = shipped.with_parameter(&card, parameter.key, parameter.value);
                assert!(
                    moved.is_some_and(|moved| moved.read().is_ok()),
                    "{name} {}",
                    parameter.key
                );
            }
        }
    }
}
