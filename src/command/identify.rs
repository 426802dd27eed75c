//! `gelbench identify`: the functions of a spring and a dashpot from recorded force and motion.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::arguments::{Large, one_of};
use super::correct::exit_code;
use super::fit::add_law;
use super::interrupt;
use super::pictures::StyleOptions;
use super::progress::{Progress, report_files};
use super::terminal::{Outcome, Printed, print, print_report, save, warn, warn_texts};
use gelbench_base::budget::{Budget, Need};
use gelbench_base::error::Error;
use gelbench_base::units::number;
use gelbench_calibration::identification::{
    Argument, Form, Function, Identification, IdentificationSettings, Recording, Sample, Shape,
    identify, law_text,
};
use gelbench_report::output::ResultFolder;
use gelbench_report::results::{Table, identification_json, identification_picture};

/// Memory of an instant of a recording: 2.1 kB were measured with 300,000 of them.
const BYTES_OF_AN_INSTANT: f64 = 3000.0;

pub const HELP: &str = "\
The file is a table of instants with units in the heads; what it does not say can be given by options:

  # mass: 200 g
  # length: 50 mm
  time [s],extension [mm],force [N]
  0.000,0.00,0.000
  0.005,0.12,0.031

Instead of extension it may have length or stretch, which need the length at rest. Without a mass inertia is left out.

Samples:
  gelbench identify --sample spring.csv --seed 1         write a computed recording to try it out
  gelbench identify spring.csv
  gelbench identify spring.csv --stiffness polynomial-2 --damping constant
  gelbench identify gel.csv --mass \"5 g\" --length \"3 cm\" --stiffness-shape increasing";

/// What the command line says about an identification.
#[derive(Args)]
pub struct Options {
    /// The recording to identify from
    #[arg(required_unless_present = "sample")]
    data: Option<PathBuf>,
    /// The mass that the force moves
    #[arg(long, allow_hyphen_values = true)]
    mass: Option<String>,
    /// The length at rest
    #[arg(long, allow_hyphen_values = true)]
    length: Option<String>,
    /// The cross-section at rest: with it and the length, the law is a material law, for springs of any length
    #[arg(long, allow_hyphen_values = true)]
    area: Option<String>,
    /// Form of K(·): constant, polynomial-N, spline or spline-N
    #[arg(long, value_name = "FORM", default_value = "spline", value_parser = Form::parse)]
    stiffness: Form,
    /// Form of D(·)
    #[arg(long, value_name = "FORM", default_value = "spline", value_parser = Form::parse)]
    damping: Form,
    /// Known shape of K(·); free: nothing is known
    #[arg(long, default_value = "free", value_parser = one_of(&Shape::NAMES))]
    stiffness_shape: Shape,
    /// Known shape of D(·)
    #[arg(long, default_value = "free", value_parser = one_of(&Shape::NAMES))]
    damping_shape: Shape,
    /// Argument of D(·): the extension or its rate
    #[arg(long, default_value = "extension", value_parser = one_of(&Argument::NAMES))]
    damping_over: Argument,
    /// Write the law, the picture and the figures into this folder instead of output/NAME/
    #[arg(long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Write a computed recording of known functions to this file and stop
    #[arg(long, value_name = "FILE", conflicts_with = "data")]
    sample: Option<PathBuf>,
    /// Seed of the computed recording's noise
    #[arg(long, default_value_t = 1, requires = "sample")]
    seed: u64,
    #[command(flatten)]
    large: Large,
    #[command(flatten)]
    printed: Printed,
    #[command(flatten)]
    style: StyleOptions,
}

/// Identifies, prints, and writes law, picture and figures.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    if let Some(file) = options.sample {
        return write_sample(&file, options.seed);
    }
    let path = options.data.unwrap_or_default();
    let given = [
        ("mass", options.mass),
        ("length", options.length),
        ("area", options.area),
    ]
    .into_iter()
    .filter_map(|(key, value)| Some((key.to_owned(), value?)));
    let recording = Recording::read(&path, &given.collect())?;
    check_size(&path, &recording, options.large.budget())?;
    let settings = IdentificationSettings {
        forms: [options.stiffness, options.damping],
        shapes: [options.stiffness_shape, options.damping_shape],
        argument: options.damping_over,
    };
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let usual = || Path::new("output").join(&*stem);
    let folder = options.output.unwrap_or_else(usual);
    let mut results =
        interrupt::guarded(|| ResultFolder::open(&folder, &format!("identify {stem}"), &[&path]))?;
    warn(results.replaces().as_slice());
    let progress = Progress::of(0);
    let identification = identify(&recording, settings, &|what| progress.report(what))?;
    progress.report("files");
    let json = identification_json(&identification, &recording, &file_name(&path));
    let law = law_text(&identification, &recording, &file_name(&path));
    let picture = identification_picture(&identification, &recording);
    let warnings = add_law(
        &mut results,
        &stem,
        &law,
        &json,
        (&picture, &options.style.style()),
    )?;
    let files = results.finish()?;
    drop(progress);
    report_files(&files);
    print_report(|| json)?;
    warn(warnings.as_slice());
    let doubts = identification.verdict.doubts.iter();
    warn_texts(doubts.chain(&identification.warnings));
    print(&format!(
        "{}written: {} with .png and .json\n",
        message(&identification, &recording, &path),
        folder.join(format!("{stem}.toml")).display()
    ))?;
    Ok(exit_code(
        identification.verdict.answer,
        identification.verdict.is_sound(),
    ))
}

/// Refuses a recording that is larger than the budget.
fn check_size(path: &Path, recording: &Recording, budget: Budget) -> Result<(), Error> {
    let need = Need {
        bytes: BYTES_OF_AN_INSTANT * recording.times.len() as f64,
        ..Need::default()
    };
    budget.afford(need).map_err(|excess| {
        let what = format!("{}: {} instants", path.display(), recording.times.len());
        Error::input(
            format!("{what}: this {excess}"),
            excess.remedy("take every other instant"),
        )
    })
}

/// Writes a computed recording.
fn write_sample(file: &Path, seed: u64) -> Outcome {
    let sample = Sample {
        seed,
        ..Sample::default()
    };
    save(file, sample.csv().as_bytes())?;
    print(&format!("{} written\n", file.display()))?;
    Ok(0)
}

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn message(identification: &Identification, recording: &Recording, path: &Path) -> String {
    let mut text = format!(
        "{}: {} instants\n{}noise: {} mm in the extension, {} N in the force\nmisfit: {} (1 where force, motion and forms fit together)\n",
        path.display(),
        recording.times.len(),
        verdict(identification),
        number(identification.noise[0]),
        number(identification.noise[1]),
        number(identification.misfit)
    );
    for (index, (symbol, unit, function)) in identification.functions().into_iter().enumerate() {
        let rate = index == 1 && identification.settings.argument == Argument::Rate;
        let (argument, of) = if rate {
            ("rate [mm/s]", "mm/s")
        } else {
            ("extension [mm]", "mm")
        };
        let _ = write!(
            text,
            "\n{symbol}(·) in {unit}, {} effective coefficients\n",
            number(function.degrees)
        );
        text += &powers(function, of);
        text += &curve(function, argument);
    }
    text
}

/// The verdict with its reasons.
fn verdict(identification: &Identification) -> String {
    let mut text = format!("verdict: {}\n", identification.verdict.words());
    for reason in &identification.verdict.reasons {
        let _ = writeln!(text, "  {reason}");
    }
    if !identification.is_explained() {
        text += "  no standard errors, intervals and bands are given: they would mean nothing\n";
    }
    text
}

/// The coefficients of constants and polynomials.
fn powers(function: &Function, unit: &str) -> String {
    let mut text = String::new();
    for (power, estimate) in function.powers().into_iter().enumerate() {
        let [low, high] = estimate.interval.map(number);
        let per = if power == 0 {
            String::new()
        } else {
            format!(" per ({unit})^{power}")
        };
        let value = number(estimate.value);
        let error = number(estimate.standard_error);
        let _ = if estimate.standard_error.is_nan() {
            writeln!(text, "  {value}{per}")
        } else {
            writeln!(text, "  {value} ± {error}{per}   95 % {low} … {high}")
        };
    }
    text
}

fn curve(function: &Function, argument: &str) -> String {
    const PLACES: usize = 7;
    let error = function.at(function.basis.range[0]).standard_error;
    let has_intervals = error.is_finite();
    let ends = |[low, high]: [f64; 2]| format!("{} … {}", number(low), number(high));
    let table = Table::of(function.positions(PLACES))
        .column(argument, |x| format!("{x:.3}"))
        .column("value", |x| number(function.at(*x).value))
        .column_if(has_intervals, "standard error", |x| {
            number(function.at(*x).standard_error)
        })
        .column_if(has_intervals, "95 % pointwise", |x| {
            ends(function.at(*x).interval)
        })
        .column_if(has_intervals, "95 % band", |x| ends(function.band(*x)));
    textwrap::indent(&table.block().plain(), "  ")
}
