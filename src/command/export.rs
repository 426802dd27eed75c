//! `gelbench export`: a study as the input file of another code.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::choice::one_of;
use super::large::Large;
use super::terminal::{Outcome, print, save, warn};
use crate::error::{Diagnostic, Error};
use crate::kinds;
use crate::material::Code;
use crate::output;
use crate::output::export::{Export, InputFile};
use crate::studies::sections;
use crate::studies::specimen;
use crate::studies::specimen::Specimen;

/// Which of the three finite-element meshes of a study goes out.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Level {
    /// The coarsest
    Coarse,
    /// The middle one
    Middle,
    /// The finest of the three; `run` of a specimen may refine it once more if it is too coarse to judge the tolerances
    Fine,
}

/// What the command line says about an export.
#[derive(Args)]
pub struct Options {
    /// The study file, of kind plate or specimen
    pub study: PathBuf,
    /// The code to write for
    #[arg(long = "to", value_name = "CODE", value_parser = one_of(&Code::NAMES))]
    pub code: Code,
    /// File to write, or folder for it, instead of one in output/
    #[arg(long, value_name = "FILE|FOLDER")]
    pub output: Option<PathBuf>,
    /// Which of the three finite-element meshes to write
    #[arg(long = "mesh", value_enum, default_value = "fine")]
    pub level: Level,
    /// Bulk modulus over the initial shear modulus, for CalculiX and FEBio
    #[arg(long, value_name = "RATIO", default_value_t = 1000.0)]
    pub bulk_ratio: f64,
    #[command(flatten)]
    pub large: Large,
}

/// Writes the file.
pub fn run(options: &Options) -> Outcome {
    if !(options.bulk_ratio >= 10.0 && options.bulk_ratio <= 1e8) {
        let message = format!("a bulk ratio of {} is not possible", options.bulk_ratio);
        return Err(Error::input(
            message,
            "it lies between 10 and 1e8; 1000 is usual",
        ));
    }
    let path = &options.study;
    let text = sections::read_text(path)?;
    let read = kinds::read_sheet(path, &text, options.large.budget())?;
    warn(&read.warnings);
    let written = input_file(&read.title, &read.made, options)?;
    let stem = path
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into());
    let code = options.code;
    let name = format!("{stem}_{}.{}", code.key(), code.ending());
    let target = match &options.output {
        Some(folder) if folder.is_dir() => folder.join(name),
        Some(file) => file.clone(),
        None => Path::new("output").join(&stem).join(name),
    };
    output::refuse_inputs(&target, &[path])?;
    save(&target, written.text.as_bytes())?;
    for remark in written.remarks {
        warn(&[Diagnostic::warning("", remark)]);
    }
    print(&format!("{} for {}\n", target.display(), code.name()))?;
    Ok(0)
}

/// The problem in the other code's words, on the mesh that is asked for.
fn input_file(title: &str, specimen: &Specimen, options: &Options) -> Result<InputFile, Error> {
    let mesh = match (specimen.refinement, options.level) {
        (_, Level::Fine) => specimen::finest_mesh(specimen)?,
        (None, level) => specimen.outline.reference_mesh(level as usize),
        (Some(_), _) => {
            let message = "a study with `adaptive = true` has one mesh, the refined one";
            return Err(Error::input(message, "leave out --mesh"));
        }
    };
    let export = Export {
        title,
        problem: &specimen.problem,
        card: &specimen.card,
        regions: &specimen.regions,
        mesh: &mesh,
        factors: &specimen.factors,
        bulk_ratio: options.bulk_ratio,
    };
    export.input_file(options.code)
}
