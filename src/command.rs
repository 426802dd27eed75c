//! The command line. Nothing else prints or decides on an exit code.
//!
//! | code | meaning |
//! |---|---|
//! | 0 | done, and every requirement of the study is met |
//! | 1 | done, but a requirement is not met, or the reference is too coarse to judge it |
//! | 2 | the study, a card or the command line is wrong |
//! | 3 | a model has no solution that could be found; what the others have is written |
//! | 4 | a file could not be written |
//! | 5 | measured data are not explained by the law and the conditions |
//! | 70 | a fault of the program itself |
//! | 130 | interrupted |

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use crate::kinds;
use arguments::Large;
use conclusion::finish;
use gelbench_base::budget::Budget;
use gelbench_base::document::inputs;
use gelbench_base::error::Error;
use gelbench_report::output;
use gelbench_report::output::ResultFolder;
use gelbench_studies::studies::{self, name};
use gelbench_validation::validation;
use journal::FolderJournal;
use progress::{Progress, Shown};
use reference::FileKind;
use terminal::{Outcome, Printed, complain, print, warn};

mod arguments;
mod compare;
mod conclusion;
mod containment;
mod convert;
mod correct;
mod export;
mod fit;
mod fit_message;
mod group;
mod identify;
mod images;
mod interrupt;
mod journal;
mod materials;
mod message;
mod new_card;
mod parameter_bounds;
mod pictures;
mod progress;
mod reference;
mod schema;
mod shell;
mod sweep;
mod terminal;
mod test_reading;
mod validate;
mod workbench;

const SAMPLES: &str = "Samples:
  gelbench new my_plate                      write my_plate.toml, a commented study
  gelbench keys specimen                     every key of a kind of studies
  gelbench check my_plate.toml               read it and report every fault
  gelbench run my_plate.toml                 compute it and write output/my_plate/
  gelbench export my_plate.toml --to abaqus  write it as the input file of another code
  gelbench compare my_plate.toml abaqus.vtu  compare its models with a field of another program
  gelbench identify spring.csv               spring and dashpot functions from recorded force and motion
  gelbench track frames/*.tif …              follow the pattern on a specimen through camera images
  gelbench correct markers.csv …             make measured displacements satisfy the physics, or those of images
  gelbench sweep my_plate.toml --vary …      compute it many times with some keys changed
  gelbench workbench my_plate.toml           open it in the window, if that is installed
  gelbench validate                          reproduce the publication's claims, write output/validation/REPORT.md
  gelbench materials list                    the cards that are included
  gelbench materials show pva-10             one card with its moduli and its source
  gelbench materials new --law neo-hooke --young \"20 kPa\" --poisson 0.45    a card of what is known
  gelbench materials fit tensile.csv --all   fit all laws to a measured curve, write the nearest that is stable and identifiable

Exit codes: 0 done, 1 a requirement of the study is not met, 2 wrong input, 3 no solution, 4 cannot write,\n5 measured data are not explained, 70 a fault of gelbench itself, 130 interrupted.";

#[derive(Parser)]
#[command(version, about, after_help = SAMPLES)]
struct Arguments {
    /// Show no progress
    #[arg(long, global = true)]
    quiet: bool,
    /// Show every step of the work as a line, and every file that is written
    #[arg(long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Compute studies and write VTK files, pictures and reports
    #[command(after_help = "Sample: gelbench run examples/pva_plate.toml --output /tmp/plate")]
    Run {
        /// The study files, computed one after the other
        #[arg(required = true, value_name = "STUDY")]
        studies: Vec<PathBuf>,
        /// Write into this folder instead of the one that the study names; of several studies, into a folder of it for each
        #[arg(long, value_name = "FOLDER")]
        output: Option<PathBuf>,
        #[command(flatten)]
        large: Large,
        #[command(flatten)]
        printed: Printed,
    },
    /// Read studies and their cards and report every fault, without computing
    #[command(after_help = "Sample: gelbench check examples/pva_plate.toml")]
    Check {
        /// The study files
        #[arg(required = true, value_name = "STUDY")]
        studies: Vec<PathBuf>,
        #[command(flatten)]
        large: Large,
    },
    /// Compare the models of a study with a displacement field from another program
    #[command(
        after_help = "Sample: gelbench compare examples/dog_bone.toml dog_bone.frd --factor 0.5"
    )]
    Compare(compare::Options),
    /// Make a measured displacement field satisfy the physics; stresses, forces and their uncertainty follow
    #[command(
        after_help = "Sample: gelbench correct examples/measured_plate.csv --material pva-10 --thickness \"2 mm\" \\\n  \
                      --study examples/measured_plate.toml"
    )]
    Correct(Box<correct::Options>),
    /// Follow the pattern on a specimen through camera images; displacements and their standard deviations as markers
    Track(Box<images::TrackOptions>),
    /// Write a study as the input file of Abaqus, CalculiX or FEBio, or its springs as a scene of SOFA
    #[command(
        after_help = "Sample: gelbench export examples/dog_bone.toml --to calculix --output dog_bone.inp"
    )]
    Export(export::Options),
    /// Find the functions K(·) and D(·) of a spring and a dashpot from recorded force and motion
    #[command(after_help = identify::HELP)]
    Identify(Box<identify::Options>),
    /// Write a commented study to start from
    #[command(
        after_help = "Samples:\n  gelbench new my_plate    writes my_plate.toml\n  gelbench new my_strip --kind specimen"
    )]
    New {
        /// Name of the file; `.toml` is appended if missing
        name: PathBuf,
        /// Kind of the file
        #[arg(long, value_enum, default_value = "plate")]
        kind: FileKind,
    },
    /// Print every key of studies and cards with unit, range and default
    #[command(after_help = "Sample: gelbench keys specimen")]
    Keys {
        /// A kind of files; all if omitted
        kind: Option<FileKind>,
    },
    /// Print the JSON Schema of a kind of files, with which editors complete and check them
    #[command(
        after_help = "Sample: gelbench schema specimen > specimen.schema.json\n\nThe first line `#:schema specimen.schema.json` of a study makes taplo and its editors use it."
    )]
    Schema {
        /// The kind of files
        kind: FileKind,
    },
    /// Reproduce the publication's claims and the comparisons with other codes
    ///
    /// Writes REPORT.md with its pictures, REPORT.html and the times to output/validation/; some cases write to a
    /// subfolder.
    #[command(after_help = "Sample: gelbench validate vibrating-spring --output /tmp/validation")]
    Validate {
        /// Cases to compute; all if omitted
        cases: Vec<String>,
        /// Skip the slow cases
        #[arg(long)]
        quick: bool,
        /// Compute the fields measured by other groups (the case real-measurements)
        #[arg(long)]
        field: bool,
        /// Write the report into this folder
        #[arg(long, value_name = "FOLDER")]
        output: Option<PathBuf>,
        #[command(flatten)]
        printed: Printed,
    },
    /// Compute a study many times with some of its keys varied
    #[command(after_help = sweep::HELP)]
    Sweep(Box<sweep::Options>),
    /// Print the completion script of a shell
    #[command(
        after_help = "Sample: gelbench completions bash > ~/.local/share/bash-completion/completions/gelbench"
    )]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write the pages of the manual
    #[command(after_help = "Sample: gelbench man --output ~/.local/share/man/man1")]
    Man {
        /// Write into this folder
        #[arg(long, value_name = "FOLDER", default_value = "output/man")]
        output: PathBuf,
    },
    /// Open the workbench, with sheets to pull by hand, if the program `gelbench-workbench` is installed
    #[command(after_help = "Sample: gelbench workbench examples/pva_plate.toml")]
    Workbench {
        /// Studies, cards, tests and measured fields to open
        files: Vec<PathBuf>,
    },
    /// Show material cards, fit laws to measured curves, convert test data
    Materials {
        #[command(subcommand)]
        command: materials::Materials,
    },
}

/// Runs the command with the arguments of the process.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(usage) => {
            let code = u8::try_from(usage.exit_code()).unwrap_or(2);
            // A closed pipe is no reason to complain about a help text.
            let _ = usage.print();
            return ExitCode::from(code);
        }
    };
    match (arguments.quiet, arguments.verbose) {
        (true, _) => progress::show(Shown::Nothing),
        (_, true) => progress::show(Shown::EveryStep),
        _ => {}
    }
    inputs::remember();
    interrupt::attend();
    ExitCode::from(containment::contained(|| perform(arguments.command)))
}

/// Performs a command and returns the exit code.
fn perform(command: Command) -> u8 {
    let outcome = match command {
        Command::Run {
            studies,
            output,
            large,
            printed,
        } => {
            printed.choose();
            run_studies(&studies, output.as_deref(), large.budget())
        }
        Command::Check { studies, large } => each(&studies, |study| check(study, large.budget())),
        Command::Compare(options) => compare::run(options),
        Command::Correct(options) => correct::run(*options),
        Command::Track(options) => images::track(*options),
        Command::Export(options) => export::run(&options),
        Command::Identify(options) => identify::run(*options),
        Command::New { name, kind } => reference::write(name, kind),
        Command::Keys { kind } => reference::print_keys(kind),
        Command::Schema { kind } => schema::print_schema(kind),
        Command::Completions { shell } => shell::completions(shell, &mut Arguments::command()),
        Command::Man { output } => shell::manual(&output, &mut Arguments::command()),
        Command::Sweep(options) => sweep::run(*options),
        Command::Validate {
            mut cases,
            quick,
            field,
            output,
            printed,
        } => {
            printed.choose();
            cases.extend(field.then(|| validation::REAL_MEASUREMENTS.to_owned()));
            validate::run(&cases, quick, output)
        }
        Command::Workbench { files } => workbench::open(&files),
        Command::Materials { command } => materials::run(command),
    };
    exit_code(outcome)
}

/// The exit code of a command, whose fault is printed.
fn exit_code(outcome: Outcome) -> u8 {
    outcome.unwrap_or_else(|error| {
        complain(&error);
        error.exit_code()
    })
}

/// Performs a command on each of some studies, even if it fails on others; the exit code is the largest of theirs.
fn each(studies: &[PathBuf], perform: impl Fn(&Path) -> Outcome) -> Outcome {
    let codes = studies.iter().map(|study| exit_code(perform(study)));
    Ok(codes.max().unwrap_or_default())
}

/// Computes studies one after the other; several need folders of their own.
fn run_studies(studies: &[PathBuf], folder: Option<&Path>, budget: Budget) -> Outcome {
    let [_, _, ..] = studies else {
        return each(studies, |study| {
            run_study(study, folder.map(Path::to_owned), budget)
        });
    };
    let mut names: Vec<String> = studies.iter().map(|study| name(study)).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        let message = format!("two studies have the name `{}` and one folder", pair[0]);
        return Err(Error::input(
            message,
            "run them by themselves, each with --output",
        ));
    }
    each(studies, |study| {
        print(&format!("\n{}:\n", study.display()))?;
        run_study(study, folder.map(|folder| folder.join(name(study))), budget)
    })
}

/// Computes a study of any kind and writes what it finds.
fn run_study(path: &Path, folder: Option<PathBuf>, budget: Budget) -> Outcome {
    let mut ready = kinds::read(path, budget)?;
    let usual = || Path::new("output").join(name(path));
    let folder = folder
        .or_else(|| ready.output.folder.clone())
        .unwrap_or_else(usual);
    let identity = interrupt::identity(&format!("{path:?} {budget:?}"));
    let results_folder =
        interrupt::guarded(|| ResultFolder::resume(&folder, "run", &[path], &identity))?;
    ready.warnings.extend(results_folder.replaces());
    let journal = FolderJournal::open(results_folder);
    ready.warnings.extend(journal.warning());
    warn(&ready.warnings);
    let progress = Progress::of(ready.progress_steps as u64);
    let counted = ready.progress_steps > 0;
    let with_report = ready.output.report;
    let report = |what: &str| {
        progress.report(what);
        if counted {
            progress.advance();
        }
    };
    let results = ready.compute(studies::Progress::to(&report).kept_by(&journal))?;
    let (mut results_folder, fault) = journal.close();
    progress.report("files");
    let warnings = output::write(&results, with_report, &mut results_folder)?;
    drop(progress);
    warn(&warnings);
    warn(fault.as_slice());
    finish(results_folder, results)
}

fn check(path: &Path, budget: Budget) -> Outcome {
    let ready = kinds::read(path, budget)?;
    warn(&ready.warnings);
    print(&format!("{}: no faults; {}\n", path.display(), ready.about))?;
    let taken: Vec<&str> = ready.physical_defaults().collect();
    if !taken.is_empty() {
        print(&format!(
            "defaults where the study states nothing: {}\n",
            taken.join(", ")
        ))?;
    }
    Ok(0)
}
