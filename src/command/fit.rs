//! `gelbench materials fit` and `refit`.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args};
use serde_json::Value;

use super::arguments::one_of;
use super::parameter_bounds::{ParameterBounds, bounds};
use super::pictures::StyleOptions;
use super::progress::{Progress, report_files};
use super::terminal::{Outcome, Printed, print, print_report, together, warn};
use super::test_reading::{ReadingArguments, read_tests};
use super::{fit_message, interrupt};
use gelbench_base::document::Statements;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_calibration::calibration::{
    self, Base, Criterion, Fit, FitSettings, Memory, PRECONDITIONED, Provenance, Terms, TestData,
    Weighting,
};
use gelbench_mechanics::material::Card;
use gelbench_mechanics::material::card::FitRecord;
use gelbench_mechanics::material::registry::{CARDS, DATA, Law};
use gelbench_report::output::{self, ResultFolder};
use gelbench_report::results::{Drawing, PictureStyle, fit_json, fit_picture};

#[derive(Args)]
#[command(group = ArgGroup::new("laws").required(true))]
pub struct FitArguments {
    /// Files of test data, all fitted together
    #[arg(required = true)]
    data: Vec<PathBuf>,
    /// The law
    #[arg(long, group = "laws", value_parser = a_law())]
    law: Option<&'static Law>,
    /// Fit all laws, rank them by AICc, or by how well they predict protocols of a biaxial test that they were not fitted to, and write the
    /// first one that is stable over the data and whose parameters are all identifiable: none is at a bound or has an interval that holds zero
    #[arg(long, group = "laws")]
    all: bool,
    /// Also fit a Prony series, to tests with a column of times (relaxation, creep, cycles, several rates), with this
    /// number of terms; selected by AICc if no number is given
    #[arg(long, value_name = "TERMS", num_args = 0..=1, default_missing_value = "automatic", conflicts_with = "all")]
    relaxation: Option<String>,
    /// Fit softening by the largest previous load (Mullins effect, after Ogden and Roxburgh) to loading and unloading
    #[arg(long, conflicts_with_all = ["all", "relaxation"])]
    softening: bool,
    /// Fit the softening alone, on top of the law of this card
    #[arg(long, group = "laws", requires = "softening")]
    card: Option<String>,
    /// absolute: equal weight for stress differences; relative: equal weight for relative differences, with stresses below
    /// 1 % of the test's largest taken as that 1 %
    #[arg(long, default_value = "absolute", value_parser = one_of(&Weighting::NAMES))]
    weighting: Weighting,
    #[command(flatten)]
    parameters: ParameterBounds,
    /// Number of starts that are optimised
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=1000))]
    starts: u16,
    /// Name of the written files; the first file's and the law's if omitted
    #[arg(long)]
    name: Option<String>,
    /// Write into this folder
    #[arg(long, value_name = "FOLDER", default_value = "output/materials")]
    output: PathBuf,
    #[command(flatten)]
    reading: ReadingArguments,
    #[command(flatten)]
    printed: Printed,
    #[command(flatten)]
    style: StyleOptions,
}

/// A card by its name or path.
pub fn load(name: &str) -> Result<Card, Error> {
    let card = Card::load(name, Path::new("."))?;
    warn(&card.warnings());
    Ok(card)
}

/// Fits, prints, and writes card, picture and figures.
pub fn fit(arguments: FitArguments) -> Outcome {
    arguments.printed.choose();
    let mut reading = arguments.reading.reading()?;
    let terms = arguments.relaxation.as_deref().map(terms).transpose()?;
    let memory = memory(terms, arguments.softening);
    if memory != Memory::None {
        // Relaxation and softening need the complete record.
        reading.entry("cycle".into()).or_insert("all".into());
    }
    if memory != Memory::Softening {
        check_history(&reading)?;
    }
    let tests = read_tests(&arguments.data, &reading)?;
    let (law, bounds) = match arguments.law {
        Some(law) => {
            let (law, bounds) = arguments.parameters.of(law)?;
            (Some(law), bounds)
        }
        None => (None, arguments.parameters.bounds()?),
    };
    let settings = FitSettings {
        weighting: arguments.weighting,
        bounds,
        starts: arguments.starts.into(),
    };
    let base = arguments.card.as_deref().map(load).transpose()?;
    let fit = chosen_fit(law, base, &tests, &settings, memory)?;
    let tests = fit.fitted_tests(&tests);
    let name = arguments
        .name
        .unwrap_or_else(|| usual_name(&arguments.data[0], &fit));
    let position = arguments.output.join(&name);
    let Some(stem) = Path::new(&name).file_name().and(position.file_name()) else {
        return Err(Error::input(
            format!("--name \"{name}\" names no file"),
            "such as --name my-gel",
        ));
    };
    let stem = stem.to_string_lossy();
    let folder = position.parent().unwrap_or(Path::new("."));
    let written = Written {
        fit: &fit,
        tests: &tests,
        data: &arguments.data,
        reading,
        base: arguments.card.as_deref(),
        style: arguments.style.style(),
    };
    let warning = written.into_folder(folder, &stem)?;
    warn(warning.as_slice());
    print_report(|| fit_json(&fit, &tests))?;
    let card = folder.join(format!("{stem}.toml"));
    let card = card.display();
    print(&format!(
        "{}\nwritten: {card} with .png and .json; use it in a study as material.card = \"{card}\"\n",
        fit_message::fit(&fit, &tests)
    ))?;
    Ok(0)
}

/// How many terms a Prony series is asked for.
fn terms(text: &str) -> Result<Terms, Error> {
    Terms::parse(text).ok_or_else(|| {
        Error::input(
            format!("--relaxation {text} is not a number of terms"),
            format!(
                "a number up to {}, or nothing, for as many as AICc selects",
                Terms::MOST
            ),
        )
    })
}

/// What is fitted besides a law.
fn memory(terms: Option<Terms>, softening: bool) -> Memory {
    if softening {
        Memory::Softening
    } else {
        terms.map_or(Memory::None, Memory::Relaxation)
    }
}

/// The name of a fit's files where none is stated.
fn usual_name(data: &Path, fit: &Fit) -> String {
    let more = match (&fit.relaxed, &fit.softened) {
        (Some(_), _) => "-relaxation",
        (_, Some(_)) => "-softening",
        (None, None) => "",
    };
    let first = data.file_stem().unwrap_or_default().to_string_lossy();
    format!("{first}-{}{more}", fit.law.name)
}

/// Checks that nothing is stated of an earlier loading, which only a fit of softening takes.
fn check_history(reading: &Statements) -> Result<(), Error> {
    if reading.contains_key(PRECONDITIONED) {
        Err(Error::input(
            "an earlier stretch only matters for the softening of a specimen",
            "add --softening, or leave out --preconditioned",
        ))
    } else {
        Ok(())
    }
}

/// The fit of a law, on top of a card, or of the best law where neither is named.
fn chosen_fit(
    law: Option<&'static Law>,
    base: Option<Card>,
    tests: &[TestData],
    settings: &FitSettings,
    memory: Memory,
) -> Result<Fit, Error> {
    let progress = Progress::of(0);
    match (law, &base) {
        (_, Some(card)) => {
            progress.report(&card.name);
            calibration::fit_softening(Base::Card(card), tests, settings)
        }
        (Some(law), _) => {
            progress.report(law.name);
            memory.fit(law, tests, settings)
        }
        _ => {
            progress.report("all laws");
            let (fits, reasons) = calibration::rank(tests, settings);
            print(&fit_message::ranking(&fits, &reasons))?;
            let criterion = Criterion::of(&fits);
            let first = fits.first().map(|fit| (fit.law.name, criterion.value(fit)));
            let best = calibration::best(fits);
            if let (Some(best), Some(first)) = (&best, first) {
                print(&fit_message::chosen(best, criterion, first))?;
            }
            best.ok_or_else(|| Error::input("no law could be fitted", "look at the reasons above"))
        }
    }
}

/// Whether a card comes along with the program.
pub fn shipped(name: &str) -> bool {
    CARDS.iter().any(|(known, _)| *known == name)
}

/// What is written of a fit.
struct Written<'a> {
    fit: &'a Fit,
    tests: &'a [TestData],
    data: &'a [PathBuf],
    reading: Statements,
    /// The card on top of whose law softening was fitted.
    base: Option<&'a str>,
    style: PictureStyle,
}

impl Written<'_> {
    /// Writes card, figures and picture, all of them or none; returns a warning where the picture cannot be drawn.
    fn into_folder(self, folder: &Path, stem: &str) -> Result<Option<Diagnostic>, Error> {
        let [card, json, png, svg, pdf] =
            ["toml", "json", "png", "svg", "pdf"].map(|ending| format!("{stem}.{ending}"));
        let files: Vec<String> = self
            .data
            .iter()
            .map(|path| output::relative(path, folder))
            .collect();
        guard(
            &folder.join(&card),
            &files,
            &[&png, &svg, &pdf, &json].map(|name| folder.join(name)),
        )?;
        let inputs: Vec<&Path> = self.data.iter().map(PathBuf::as_path).collect();
        let mut results = interrupt::guarded(|| {
            ResultFolder::open(folder, &format!("materials fit {stem}"), &inputs)
        })?;
        let provenance = Provenance {
            files,
            reading: self.reading,
            base_card: self.base.map(|card| {
                if shipped(card) {
                    card.to_owned()
                } else {
                    output::relative(Path::new(card), folder)
                }
            }),
        };
        let text = calibration::card_text(self.fit, self.tests, &provenance);
        let figures = fit_json(self.fit, self.tests);
        let picture = fit_picture(self.fit, self.tests);
        let warning = add_law(&mut results, stem, &text, &figures, (&picture, &self.style))?;
        report_files(&results.finish()?);
        Ok(warning)
    }
}

/// Adds a law or a card, its figures and its picture to a folder; returns a warning where the picture cannot be drawn.
pub fn add_law(
    results: &mut ResultFolder,
    stem: &str,
    text: &str,
    figures: &Value,
    (picture, style): (&Drawing, &PictureStyle),
) -> Result<Option<Diagnostic>, Error> {
    results.add(&format!("{stem}.toml"), text.as_bytes())?;
    results.add(&format!("{stem}.json"), format!("{figures:#}\n").as_bytes())?;
    output::write_picture(results, stem, picture, style)
}

/// What was not written by a fit to the same data, or was changed since, is never replaced by one.
fn guard(card: &Path, data: &[String], others: &[PathBuf]) -> Result<(), Error> {
    let refuse = |path: &Path, why: &str| {
        let cause = format!("a file of this name exists that was {why}; choose another --name");
        Err(Error::write(path, cause))
    };
    // Not read as an input, which nothing may replace.
    if let Ok(text) = std::fs::read_to_string(card) {
        let there = Card::parse("", "", &text).ok();
        let changed = there.as_ref().and_then(Card::changed_since_fit);
        return match there.and_then(|there| there.fit) {
            Some(fit) if fit.data != data => {
                refuse(card, &format!("fitted to {}", fit.data.join(", ")))
            }
            Some(_) if changed.is_some() => refuse(card, "changed since its fit"),
            Some(_) => Ok(()),
            None => refuse(card, "not written by a fit"),
        };
    }
    let other = others.iter().find(|path| path.exists());
    other.map_or(Ok(()), |path| refuse(path, "not written by a fit"))
}

/// The parser of a law by its name.
pub fn a_law() -> impl TypedValueParser<Value = &'static Law> {
    let names = Law::fitted().map(|law| law.name);
    PossibleValuesParser::new(names)
        .map(|name| Law::named(&name).expect("clap has found the name among the laws"))
}

/// The weighting of a record.
fn weighting(name: &str) -> Result<Weighting, Error> {
    let entry = Weighting::NAMES.iter().find(|(known, _)| *known == name);
    entry.map(|(_, weighting)| *weighting).ok_or_else(|| {
        let hint = format!(
            "it must be one of {}",
            Weighting::NAMES.map(|(known, _)| known).join(", ")
        );
        Error::input(format!("weighting {name} is not known"), hint)
    })
}

/// Fits a card again and compares.
pub fn refit(name: &str) -> Outcome {
    let card = load(name)?;
    let Some(record) = &card.fit else {
        let hint = "cards written by `gelbench materials fit` have one";
        return Err(Error::input(format!("the card {name} has no [fit]"), hint));
    };
    let folder = Path::new(name).parent().filter(|_| !shipped(name));
    let tests = together(record.data.iter().map(|file| data(file, folder, record)))?;
    let settings = FitSettings {
        weighting: weighting(&record.weighting)?,
        bounds: bounds(&record.bounds)?,
        starts: record.starts,
    };
    let fit = match &record.base_card {
        Some(base) => {
            let base = Card::load(base, folder.unwrap_or(Path::new("")))?;
            calibration::fit_softening(Base::Card(&base), &tests, &settings)?
        }
        None => {
            let terms = record.relaxation_terms.map(Terms::Exactly);
            let law = Law::of_card(&card.law_name, &card.choices);
            let law = law.expect("a card that was loaded has a known law");
            memory(terms, record.softening).fit(law, &tests, &settings)?
        }
    };
    let (text, same) = fit_message::refit(&card, &fit, &fit.fitted_tests(&tests));
    print(&text)?;
    Ok(u8::from(!same))
}

/// Test data that a card names: of a shipped card from the program itself.
fn data(file: &str, folder: Option<&Path>, record: &FitRecord) -> Result<TestData, Error> {
    let pairs = record
        .reading
        .iter()
        .filter_map(|pair| pair.split_once(": "));
    let reading = pairs
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .collect();
    match (folder, DATA.iter().find(|(known, _)| *known == file)) {
        (None, Some((name, text))) => TestData::parse(name, text, &reading),
        _ => TestData::read(&folder.unwrap_or(Path::new("")).join(file), &reading),
    }
}
