//! `gelbench export`: a study as the input file of another code, or its lattice as a scene of SOFA.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::arguments::{Large, one_of};
use super::terminal::{Outcome, print, save, warn, warn_texts};
use crate::kinds;
use gelbench_base::error::Error;
use gelbench_mechanics::material::Code;
use gelbench_report::output;
use gelbench_report::output::export::{Export, InputFile, Scene};
use gelbench_studies::studies::sections;
use gelbench_studies::studies::specimen;
use gelbench_studies::studies::specimen::Specimen;

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

/// What is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// The finite elements, for a code.
    Elements(Code),
    /// The lattice of springs, for SOFA.
    Sofa,
}

const TARGETS: [(&str, Target); 4] = [
    ("abaqus", Target::Elements(Code::Abaqus)),
    ("calculix", Target::Elements(Code::CalculiX)),
    ("febio", Target::Elements(Code::FeBio)),
    ("sofa", Target::Sofa),
];

impl Target {
    /// The name that the command line uses, and the extension of the files.
    fn key_and_ending(self) -> [&'static str; 2] {
        match self {
            Self::Elements(code) => [code.key(), code.ending()],
            Self::Sofa => ["sofa", "scn"],
        }
    }

    /// The code's name as its makers write it.
    fn name(self) -> &'static str {
        match self {
            Self::Elements(code) => code.name(),
            Self::Sofa => "SOFA",
        }
    }
}

/// What the command line says about an export.
#[derive(Args)]
pub struct Options {
    /// The study file, of kind plate or specimen
    pub study: PathBuf,
    /// The code to write for: finite elements, or for SOFA the lattice of springs
    #[arg(long = "to", value_name = "CODE", value_parser = one_of(&TARGETS))]
    pub target: Target,
    /// File to write, or folder for it, instead of one in output/
    #[arg(long, value_name = "FILE|FOLDER")]
    pub output: Option<PathBuf>,
    /// Which of the three finite-element meshes to write; not for SOFA
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
    let written = match options.target {
        Target::Elements(code) => input_file(&read.title, &read.content, code, options)?,
        Target::Sofa => scene(&read.title, &read.content)?,
    };
    let stem = path
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into());
    let [key, ending] = options.target.key_and_ending();
    let name = format!("{stem}_{key}.{ending}");
    let target = match &options.output {
        Some(folder) if folder.is_dir() => folder.join(name),
        Some(file) => file.clone(),
        None => Path::new("output").join(&stem).join(name),
    };
    output::refuse_inputs(&target, &[path])?;
    save(&target, written.text.as_bytes())?;
    warn_texts(written.remarks);
    let name = options.target.name();
    print(&format!("{} for {name}\n", target.display()))?;
    Ok(0)
}

/// The problem in the other code's keywords, on the chosen mesh.
fn input_file(
    title: &str,
    specimen: &Specimen,
    code: Code,
    options: &Options,
) -> Result<InputFile, Error> {
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
    export.input_file(code)
}

/// The lattice of the study as a scene.
fn scene(title: &str, specimen: &Specimen) -> Result<InputFile, Error> {
    let scene = Scene {
        title,
        problem: &specimen.problem,
        card: &specimen.card,
        regions: &specimen.regions,
        springs: &specimen.springs(),
        factors: &specimen.factors,
    };
    scene.input_file()
}
