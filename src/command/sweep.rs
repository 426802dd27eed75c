//! `gelbench sweep`: many runs of one study.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::arguments::Large;
use super::conclusion::open_page;
use super::interrupt;
use super::progress::{Progress, report_files};
use super::terminal::{Outcome, Printed, print, print_report, warn, warn_texts};
use crate::sweep::{
    self, BaseStudy, FittedParameters, Method, Points, Sampling, Shard, Share, Sweep, SweepFolder,
    Variable,
};
use gelbench_base::document::{self, file};
use gelbench_base::error::Error;
use gelbench_studies::studies::name;
use gelbench_studies::studies::sections::read_text;

/// What stands below the help.
pub const HELP: &str = "A key's parts have dots between them, places of lists count from 0, and parameters of the study's card are material.KEY,
of a list of cards material.0.KEY:
  --vary \"material.c10=0.04..0.06 MPa:20\"   20 values, evenly
  --vary \"plate.thickness=1 mm,2 mm\"        these values
  --vary \"material.c10=0.05+-0.002 MPa\"     normal, with mean and standard deviation; needs --samples
  --vary \"plate.width=45..55 mm\"            uniform; needs --samples
Every combination is run. An interrupted sweep continues where it stopped when it is started again.

Samples:
  gelbench sweep examples/pva_plate.toml --vary \"plate.thickness=1..3 mm:5\"
  gelbench sweep plate.toml --fit output/materials/gel-yeoh.json --samples 256
  gelbench sweep plate.toml --vary … --shard $SLURM_ARRAY_TASK_ID/100     one of a hundred jobs
  gelbench sweep plate.toml --vary … --join 100                           their tables together";

#[derive(Args, Debug)]
pub struct Options {
    /// The study
    study: PathBuf,
    /// A key with its values; repeat it for each key
    #[arg(long, value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// Draw the parameters of the study's card from a fit: the JSON file of `materials fit`
    #[arg(long, value_name = "FILE")]
    fit: Option<PathBuf>,
    /// Points chosen by another program: a table with a column for each key, such as `plate.width [mm]`
    #[arg(long, value_name = "FILE", conflicts_with_all = ["fit", "samples"])]
    points: Option<PathBuf>,
    /// Number of points drawn from the distributions
    #[arg(long, value_name = "COUNT")]
    samples: Option<usize>,
    /// Sampling method
    #[arg(long, value_enum, default_value = "sobol")]
    method: Drawing,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// Compute only the runs of this part, such as 3/100, into a folder of its own
    #[arg(long, value_name = "PART/PARTS", value_parser = shard, conflicts_with = "join")]
    shard: Option<Shard>,
    /// Join the tables of this many parts
    #[arg(long, value_name = "PARTS")]
    join: Option<usize>,
    /// Write into this folder instead of output/STUDY_sweep
    #[arg(long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    large: Large,
    #[command(flatten)]
    printed: Printed,
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Drawing {
    /// Scrambled Sobol' sequence: more even than random points
    Sobol,
    /// Independent random points
    Random,
}

fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/');
    let numbers = numbers.and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
    let shard = numbers.and_then(|(part, parts)| Shard::new(part, parts));
    shard.ok_or_else(|| "write PART/PARTS with a part from 1 on, such as 3/100".to_owned())
}

/// Computes, prints, and writes.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    let sweep = sweep(&options)?;
    let share = match (options.shard, options.join) {
        (Some(shard), _) => Share::Shard(shard),
        (None, Some(parts)) => Share::Join(parts),
        (None, None) => Share::Whole,
    };
    let usual = Path::new("output").join(format!("{}_sweep", name(&options.study)));
    let root = match (&options.output, share) {
        (Some(given), _) => given.clone(),
        (None, Share::Whole) => sweep::free_folder(&sweep, usual)?,
        (None, _) => usual,
    };
    let others = [options.fit.as_deref(), options.points.as_deref()];
    let inputs: Vec<&Path> = std::iter::once(&*options.study)
        .chain(others.into_iter().flatten())
        .collect();
    let program = std::env::current_exe().ok();
    let open = || SweepFolder::open(&sweep, share, &root, &inputs, program.as_deref());
    let mut folder = interrupt::guarded(open)?;
    warn(folder.replaces().as_slice());
    let progress = Progress::of(folder.count() as u64);
    progress.report("studies of all runs, read and checked before the first");
    let ended = |number: usize| {
        progress.report(&format!("run {number}"));
        progress.advance();
    };
    let rows = folder.rows(&ended, &|| ())?;
    drop(progress);
    let position = folder.as_ref().path().to_owned();
    let (files, warnings) = folder.finish(&rows)?;
    warn(&warnings);
    warn_texts(sweep::cautions(&rows));
    report_files(&files);
    let keys = sweep.keys();
    print_report(|| sweep::json(&keys, &rows))?;
    let failed = rows.iter().filter(|row| !row.fault.is_empty()).count();
    let failures = match failed {
        0 => String::new(),
        failed => {
            format!("{failed} of them without a solution somewhere, see the column `fault`; ")
        }
    };
    print(&format!(
        "{} runs; {failures}{} files in {}\n{}",
        rows.len(),
        files.len(),
        position.display(),
        open_page(&position)
    ))?;
    Ok(u8::from(failed > 0))
}

/// The sweep that the options describe.
fn sweep(options: &Options) -> Result<Sweep, Error> {
    let variables = options.vary.iter().map(|text| Variable::parse(text));
    let variables = variables.collect::<Result<_, _>>()?;
    let fitted = options.fit.as_deref().map(|path| {
        let hint = "`gelbench materials fit` writes it beside the card";
        let text = document::read_text(path, file::MOST_OF_DATA, hint)?;
        Ok::<_, Error>(FittedParameters::parse(&path.display().to_string(), &text)?)
    });
    let points = options.points.as_deref().map(|path| {
        let table = document::read_text(path, file::MOST_OF_DATA, Points::HINT)?;
        Points::parse(path, table.as_bytes())
    });
    Ok(Sweep {
        study: BaseStudy {
            path: options.study.clone(),
            text: read_text(&options.study)?,
            files: Vec::new(),
            budget: options.large.budget(),
        },
        variables,
        points: points.transpose()?,
        fitted: fitted.transpose()?,
        sampling: Sampling {
            samples: options.samples,
            method: match options.method {
                Drawing::Sobol => Method::Sobol,
                Drawing::Random => Method::Random,
            },
            seed: options.seed,
        },
    })
}
