//! The material card of a fit, as text.

use std::fmt::{Display, Write};
use std::path::Path;

use nalgebra::DMatrix;

use super::data::TestData;
use super::fitted::Fit;
use crate::document::Statements;
use crate::document::quoted;
use crate::material::registry::MARLOW_TABLE;
use crate::material::{ParameterUncertainty, Softening};
use crate::units::Dimension;

/// The origin of a card's data.
#[derive(Clone, Debug, Default)]
pub struct Provenance {
    /// The files of test data, as the card names them.
    pub files: Vec<String>,
    /// Statements about the files in addition to their heads.
    pub reading: Statements,
    /// The card whose law is the base of the fitted softening, as the new card names it.
    pub base_card: Option<String>,
}

/// The text of a card that `gelbench materials refit` can make again.
pub fn card_text(fit: &Fit, tests: &[TestData], provenance: &Provenance) -> String {
    if let Some(base) = fit
        .softened
        .as_ref()
        .and_then(|softened| softened.card.as_deref())
    {
        return softened_card(base, fit, provenance);
    }
    let names = provenance.files.iter().map(|file| file_name(file));
    let files = names.collect::<Vec<_>>().join(", ");
    let [specimen, source, doi] = ["specimen", "source", "doi"].map(|key| stated(tests, key));
    let title = match &specimen {
        Some(specimen) => format!("{specimen}, {}", fit.law.name),
        None => format!("{} fitted to {files}", fit.law.name),
    };
    let mut kinds: Vec<&str> = tests.iter().map(|test| test.test.name()).collect();
    kinds.dedup();
    let mut text = format!(
        "# Fitted by `gelbench materials fit`; `gelbench materials refit` fits it again and compares.\n\n\
         title = {}\nlaw = {}\n\n[parameters]\n",
        quoted(&title),
        quoted(fit.law.name)
    );
    parameters(&mut text, fit);
    viscosity(&mut text, fit);
    softening(&mut text, fit);
    let [low, high] = fit.quality.stretch_range;
    let data = [
        ("test", quoted(&kinds.join(", "))),
        ("stress_measure", quoted(fit.stress_measure.name())),
        ("strain_measure", quoted("nominal")),
        ("offset", quoted("subtract")),
        ("stretch_range", format!("[{low}, {high}]")),
    ];
    let citation = source.unwrap_or_else(|| format!("data of {files}"));
    let specimen = specimen.as_deref().unwrap_or("not stated in the data");
    let mut origin = vec![("citation", quoted(&citation))];
    origin.extend(doi.map(|doi| ("doi", quoted(&doi))));
    origin.push(("specimen", quoted(specimen)));
    origin.push(("note", quoted(&note(fit, tests))));
    text + &section("data", data) + &section("source", origin) + &recipe(fit, provenance)
}

/// A section of a card.
fn section(name: &str, entries: impl IntoIterator<Item = (&'static str, String)>) -> String {
    let entries = entries.into_iter();
    let lines: String = entries
        .map(|(key, value)| format!("{key} = {value}\n"))
        .collect();
    format!("\n[{name}]\n{lines}")
}

/// The text of a card in which the softening of a fit replaces earlier statements on softening and fits.
fn softened_card(base: &str, fit: &Fit, provenance: &Provenance) -> String {
    let mut text = format!(
        "# The softening was fitted by `gelbench materials fit` to {}.\n",
        provenance.files.join(", ")
    );
    let mut kept = true;
    for line in base.lines() {
        if line.trim_start().starts_with('[') {
            // A remark may follow the heading.
            let heading = line.trim_start().trim_start_matches('[').split(']').next();
            let name = heading.unwrap_or_default().trim();
            kept = !["softening", "fit"].contains(&name);
        }
        if kept {
            text += line;
            text.push('\n');
        }
    }
    softening(&mut text, fit);
    text + &recipe(fit, provenance)
}

/// The settings with which the fit can be repeated.
fn recipe(fit: &Fit, provenance: &Provenance) -> String {
    let mut entries = vec![
        ("data", list(provenance.files.iter().cloned())),
        ("weighting", quoted(fit.settings.weighting.name())),
        ("starts", fit.settings.starts.to_string()),
    ];
    entries.extend(fit.relaxed.as_ref().map(|relaxed| {
        let terms = relaxed.material.relaxation.len();
        ("relaxation_terms", terms.to_string())
    }));
    if fit.softened.is_some() {
        entries.push(("softening", "true".to_owned()));
    }
    let base = provenance.base_card.as_deref();
    entries.extend(base.map(|card| ("base_card", quoted(card))));
    let limits = fit.settings.bounds.iter();
    let bounds = limits.map(|(key, [low, high])| format!("{key}={low}..{high}"));
    if bounds.len() > 0 {
        entries.push(("bounds", list(bounds)));
    }
    let uncertainty = uncertainty(fit);
    entries.extend(uncertainty.iter().flat_map(ParameterUncertainty::lines));
    let statements = provenance.reading.iter();
    let reading = statements.map(|(key, value)| format!("{key}: {value}"));
    if reading.len() > 0 {
        entries.push(("reading", list(reading)));
    }
    let fitted = fit.parameters.iter();
    let values = fitted.map(|one| format!("{} = {}", one.key, one.value));
    if values.len() > 0 {
        entries.push(("values", list(values)));
    }
    section("fit", entries)
}

/// The covariance of the law's parameters that are estimated, where the residuals are noise.
fn uncertainty(fit: &Fit) -> Option<ParameterUncertainty> {
    let quality = &fit.quality;
    let law = fit.law_parameters();
    let estimated = |index: &usize| quality.estimates[*index].standard_error.is_finite();
    let known: Vec<usize> = (0..law.len()).filter(estimated).collect();
    if known.is_empty() || !quality.has_intervals() {
        return None;
    }
    let deviation = |index: usize| quality.estimates[index].normal_deviation();
    Some(ParameterUncertainty {
        keys: known
            .iter()
            .map(|index| law[*index].key.to_owned())
            .collect(),
        covariance: DMatrix::from_fn(known.len(), known.len(), |row, column| {
            let [row, column] = [known[row], known[column]];
            deviation(row) * quality.correlation[(row, column)] * deviation(column)
        }),
    })
}

/// The statements of the data's heads about a key.
fn stated(tests: &[TestData], key: &str) -> Option<String> {
    let mut result: Vec<&str> = Vec::new();
    for value in tests.iter().filter_map(|test| test.head.get(key)) {
        if !result.contains(&&**value) {
            result.push(value);
        }
    }
    Some(result.join("; ")).filter(|text| !text.is_empty())
}

fn put(text: &mut String, key: &str, value: impl Display) {
    let _ = writeln!(text, "{key} = {value}");
}

fn list(items: impl Iterator<Item = String>) -> String {
    let items: Vec<_> = items.map(|item| quoted(&item)).collect();
    format!("[{}]", items.join(", "))
}

fn parameters(text: &mut String, fit: &Fit) {
    for (index, parameter) in fit.law_parameters().iter().enumerate() {
        let value = match parameter.dimension {
            Dimension::Ratio => parameter.value.to_string(),
            other => quoted(&format!("{} {}", parameter.value, other.internal_unit())),
        };
        let _ = writeln!(text, "{} = {value} # {}", parameter.key, error(fit, index));
    }
    for (key, name) in &fit.choices {
        put(text, key, quoted(name));
    }
    if fit.law.name == MARLOW_TABLE {
        let numbers = |axis: usize| fit.curve.iter().map(move |point| point[axis]);
        let strains: Vec<_> = numbers(0).map(|x| x.to_string()).collect();
        put(text, "strain", format!("[{}]", strains.join(", ")));
        put(text, "stress", list(numbers(1).map(|p| format!("{p} MPa"))));
    }
}

/// The standard error of a parameter as text.
fn error(fit: &Fit, index: usize) -> String {
    match fit.quality.estimates[index].standard_error {
        _ if fit.quality.held[index] => "held, not fitted".to_owned(),
        error if !error.is_finite() => "at a bound".to_owned(),
        _ if !fit.quality.has_intervals() => "no interval".to_owned(),
        error => format!("standard error {error:.2e}"),
    }
}

/// The Prony series, and the ranges of times and rates that the data cover.
fn viscosity(text: &mut String, fit: &Fit) {
    let Some(relaxed) = &fit.relaxed else {
        return;
    };
    if relaxed.material.relaxation.is_empty() {
        return;
    }
    text.push_str("\n[viscosity]\nrelaxation = [\n");
    for (term, one) in relaxed.material.relaxation.iter().enumerate() {
        let [share, time] = [0, 1].map(|part| error(fit, fit.of_law + 2 * term + part));
        let (weight, tau) = (one.share, one.time);
        let _ = writeln!(
            text,
            "    {{ share = {weight}, time = \"{tau} s\" }}, # share: {share}; time in s: {time}"
        );
    }
    text.push_str("]\n");
    let covered = &relaxed.material.covered;
    for (key, range, unit) in [
        ("times", covered.times, "s"),
        ("rates", covered.rates, "1/s"),
    ] {
        if let Some(range) = range {
            put(
                text,
                key,
                list(range.iter().map(|value| format!("{value} {unit}"))),
            );
        }
    }
}

/// The softening.
fn softening(text: &mut String, fit: &Fit) {
    let Some(softened) = &fit.softened else {
        return;
    };
    let error = |part: usize| error(fit, fit.of_law + part);
    let Softening { r, m, beta } = softened.softening;
    let _ = write!(
        text,
        "\n[softening]\nr = {r} # {}\nm = \"{m} MPa\" # {}\nbeta = {beta} # {}\n",
        error(0),
        error(1),
        error(2)
    );
}

/// The last part of a file's path.
fn file_name(path: &str) -> String {
    let name = Path::new(path).file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// The figures and the warnings of the fit in one line.
fn note(fit: &Fit, tests: &[TestData]) -> String {
    let quality = &fit.quality;
    let mut note = if fit.parameters.is_empty() {
        format!("the curve of {} points as it was measured", quality.points)
    } else {
        let residuals = fit.settings.weighting.describe();
        format!(
            "least squares of {residuals} residuals over {} points: RMSE {:.4e} MPa, NMAD {:.3} %, R² {:.5}",
            quality.points, quality.rmse, quality.nmad_percent, quality.r_squared
        )
    };
    if let Some(relaxed) = &fit.relaxed {
        let terms = relaxed.material.relaxation.len();
        let _ = write!(
            note,
            "; the law is the long-term one, with {terms} terms of a Prony series"
        );
    }
    if fit.softened.is_some() {
        note += "; the law describes the first loading, softened after Ogden and Roxburgh";
    }
    if let Some(verdict) = &quality.verdict {
        note += "; residuals: ";
        note += &verdict.sentence();
    }
    for test in tests {
        let _ = write!(
            note,
            "; {}: {}",
            file_name(&test.name),
            test.table.sentence()
        );
    }
    for remark in tests.iter().flat_map(|test| &test.remarks) {
        note += "; ";
        note += remark;
    }
    for warning in &quality.warnings {
        note += "; ";
        note += warning;
    }
    note
}
