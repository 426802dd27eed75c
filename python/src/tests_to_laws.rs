//! From test curves to laws, and from recordings to springs and dashpots.

use std::collections::BTreeMap;

use gelbench::calibration::{
    self, Bounds, FitSettings, Memory, Provenance, Terms, TestData, Weighting,
};
use gelbench::document::{Statements, Table};
use gelbench::error::Error;
use gelbench::identification::{
    Argument, Form, IdentificationSettings, Recording, Shape, identify as identified, law_text,
};
use gelbench::material::Card;
use gelbench::material::registry::Law;
use gelbench_base::error::suggestion;
use gelbench_calibration::calibration::{KEYS, refuse_repeated};
use gelbench_report::results::{
    fit_json, fit_picture, identification_json, identification_picture,
};
use pyo3::prelude::*;

use crate::errors::{choice, input, refused};
use crate::material::{MaterialCard, law_named};
use crate::results::drawn;
use crate::running::run;

/// JSON, card or law, picture.
type Fitted = (String, MaterialCard, Vec<u8>);

/// What is said of all tests: key and value.
type StatedTexts = BTreeMap<String, String>;

/// Fits a law, or the best of all, to tests by their names and tables.
#[pyfunction]
#[pyo3(signature = (tests, law, name, said, weighting, bounds, starts, history=None, progress=None))]
#[expect(
    clippy::too_many_arguments,
    reason = "each is a keyword of gelbench.fit"
)]
pub fn fit(
    py: Python<'_>,
    tests: Vec<(String, String)>,
    law: Option<String>,
    name: String,
    said: StatedTexts,
    weighting: &str,
    bounds: Bounds,
    starts: u16,
    history: Option<&str>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Fitted> {
    run(py, progress, |watch| {
        let mut reading: Statements = said.into_iter().collect();
        if let Some(key) = reading.keys().find(|key| !KEYS.contains(&key.as_str())) {
            let hint = suggestion(key, &KEYS, "one of");
            return Err(input(format!("`{key}` is not a key of test data"), &hint));
        }
        if history.is_some() {
            // What relaxes or softens is the whole record.
            reading.entry("cycle".into()).or_insert("all".into());
        }
        let tables = tests.iter();
        let read = tables.map(|(name, table)| TestData::parse(name, table, &reading));
        let tests_read = read.collect::<Result<Vec<_>, Error>>()?;
        refuse_repeated(&tests_read)?;
        let settings = FitSettings {
            weighting: choice("weighting", weighting, &Weighting::NAMES)?,
            bounds,
            starts: starts.into(),
        };
        let fit = match law {
            Some(name) => {
                watch.report(&name);
                memory(history)?.fit(law_named(&name, Law::fitted())?, &tests_read, &settings)?
            }
            None => {
                watch.report("all laws");
                let (fits, _) = calibration::rank(&tests_read, &settings);
                calibration::best(fits)
                    .ok_or_else(|| input("no law could be fitted", "look at the data"))?
            }
        };
        let provenance = Provenance {
            files: tests.into_iter().map(|(name, _)| name).collect(),
            reading,
            ..Provenance::default()
        };
        let tests_read = fit.fitted_tests(&tests_read);
        let text = calibration::card_text(&fit, &tests_read, &provenance);
        let card = Card::parse(&name, &format!("{name}.toml"), &text)?;
        let json = fit_json(&fit, &tests_read).to_string();
        let picture = drawn(&fit_picture(&fit, &tests_read))?;
        Ok((json, MaterialCard::of(card), picture))
    })
}

/// What is fitted besides a law: nothing, softening, or a Prony series of a given number of terms or of the number with the least AICc.
fn memory(history: Option<&str>) -> Result<Memory, Error> {
    match history {
        None => Ok(Memory::None),
        Some("softening") => Ok(Memory::Softening),
        Some("relaxation") => Ok(Memory::Relaxation(Terms::Automatic)),
        Some(text) => Terms::parse(text).map(Memory::Relaxation).ok_or_else(|| {
            let message = format!("relaxation={text} is not a number of terms");
            input(message, "True, or 0 to 6")
        }),
    }
}

/// Finds K(·) and D(·) in a recording by its name and table: JSON, text of the law, picture.
#[pyfunction]
#[pyo3(signature = (recording, said, forms, shapes, damping_over, progress=None))]
pub fn identify(
    py: Python<'_>,
    recording: (String, String),
    said: StatedTexts,
    forms: [String; 2],
    shapes: [String; 2],
    damping_over: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, String, Vec<u8>)> {
    run(py, progress, |watch| {
        let (name, table) = recording;
        let read = Recording::of_table(&Table::parse(&name, &table)?, &said.into_iter().collect())?;
        let form = |text: &String| Form::parse(text).map_err(|fault| refused(fault.to_string()));
        let [stiffness, damping] = &forms;
        let [of_stiffness, of_damping] = &shapes;
        let settings = IdentificationSettings {
            forms: [form(stiffness)?, form(damping)?],
            shapes: [
                choice("stiffness_shape", of_stiffness, &Shape::NAMES)?,
                choice("damping_shape", of_damping, &Shape::NAMES)?,
            ],
            argument: choice("damping_over", damping_over, &Argument::NAMES)?,
        };
        let identification = identified(&read, settings, &|what| watch.report(what))?;
        let json = identification_json(&identification, &read, &name).to_string();
        let picture = drawn(&identification_picture(&identification, &read))?;
        Ok((json, law_text(&identification, &read, &name), picture))
    })
}
