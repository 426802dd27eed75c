//! `gelbench sweep`: many runs of one study.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use clap::{Args, ValueEnum};

use super::identity;
use super::interrupt;
use super::large::Large;
use super::progress::{Progress, tell_files};
use super::terminal::{Outcome, Printed, print, print_report, warn};
use crate::error::Error;
use crate::output::{self, ResultFolder};
use crate::studies::name;
use crate::studies::sections::read_text;
use crate::sweep::{
    self, BaseStudy, FittedParameters, Method, Row, Run, Sampling, Sweep, Variable,
};
use crate::validation;

/// The file with a line for each run.
const TABLE: &str = "sweep.csv";

/// What stands below the help.
pub const HELP: &str = "\
A key's parts have dots between them, places of lists count from 0, and parameters of the study's card are material.KEY:
  --vary \"material.c10=0.04..0.06 MPa:20\"   20 values, evenly
  --vary \"plate.thickness=1 mm,2 mm\"        these values
  --vary \"material.c10=0.05+-0.002 MPa\"     normal, with mean and standard deviation; needs --samples
  --vary \"plate.width=45..55 mm\"            uniform; needs --samples
Every combination is run. A sweep that was broken off goes on where it was when it is started again.

Samples:
  gelbench sweep examples/pva_plate.toml --vary \"plate.thickness=1..3 mm:5\"
  gelbench sweep plate.toml --fit output/materials/gel-yeoh.json --samples 256
  gelbench sweep plate.toml --vary … --shard $SLURM_ARRAY_TASK_ID/100     one of a hundred jobs
  gelbench sweep plate.toml --vary … --join 100                           their tables together";

#[derive(Args, Debug)]
pub struct Options {
    /// The study
    study: PathBuf,
    /// A key with its values; given once for each
    #[arg(long, value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// Draw the parameters of the study's card from a fit: the JSON file of `materials fit`
    #[arg(long, value_name = "FILE")]
    fit: Option<PathBuf>,
    /// How many points of the distributions are drawn
    #[arg(long, value_name = "COUNT")]
    samples: Option<usize>,
    /// How they are drawn
    #[arg(long, value_enum, default_value = "sobol")]
    method: Drawing,
    /// What tells one drawing from another
    #[arg(long, default_value_t = 1)]
    seed: u32,
    /// Compute only the runs of one part of so many, into a folder of their own
    #[arg(long, value_name = "PART/PARTS", value_parser = shard, conflicts_with = "join")]
    shard: Option<Shard>,
    /// Put the tables of so many parts together
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
    /// Sobol's sequence, scrambled: more even than chance
    Sobol,
    /// By chance
    Random,
}

/// One part of the runs.
#[derive(Clone, Copy, Debug)]
struct Shard {
    part: usize,
    parts: usize,
}

fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/');
    let numbers = numbers.and_then(|(part, parts)| Some((part.parse().ok()?, parts.parse().ok()?)));
    match numbers {
        Some((part, parts)) if (1..=parts).contains(&part) => Ok(Shard { part, parts }),
        _ => Err("write PART/PARTS with a part from 1 on, such as 3/100".to_owned()),
    }
}

impl Shard {
    fn folder(self, whole: &Path) -> PathBuf {
        whole.join(format!("part_{}_of_{}", self.part, self.parts))
    }

    fn holds(self, run: &Run) -> bool {
        (run.number - 1) % self.parts == self.part - 1
    }
}

/// Computes, prints, and writes.
pub fn run(options: Options) -> Outcome {
    options.printed.choose();
    let sweep = sweep(&options)?;
    let mut runs = sweep.runs()?;
    let whole = options
        .output
        .clone()
        .unwrap_or_else(|| Path::new("output").join(format!("{}_sweep", name(&options.study))));
    let folder = options
        .shard
        .map_or(whole.clone(), |shard| shard.folder(&whole));
    if let Some(shard) = options.shard {
        runs.retain(|run| shard.holds(run));
    }
    // Faults of the study itself are told before anything is computed.
    let study = &sweep.study;
    validation::read_given(&study.path, study.text.clone(), study.budget)?;
    sweep.read_files();
    let said = format!("{sweep:?} {:?}", options.shard);
    let inputs: Vec<&Path> = std::iter::once(&*options.study)
        .chain(options.fit.as_deref())
        .collect();
    let mut results = ResultFolder::resume(&folder, "sweep", &inputs, &identity::of(&said))?;
    interrupt::guard(&results);
    let rows = match options.join {
        Some(parts) => joined(&sweep, &runs, &whole, parts)?,
        None => {
            let (rows, taken) = computed(&sweep, &runs, results)?;
            results = taken;
            rows
        }
    };
    write(&sweep, &rows, &mut results)?;
    let files = results.finish()?;
    tell_files(&files);
    let keys = sweep.keys();
    print_report(|| sweep::json(&keys, &rows))?;
    let failed = rows.iter().filter(|row| !row.fault.is_empty()).count();
    let failures = match failed {
        0 => String::new(),
        failed => {
            format!("{failed} of them without a solution somewhere, see the column `fault`; ")
        }
    };
    let (count, place) = (files.len(), folder.display());
    print(&format!(
        "{} runs; {failures}{count} files in {place}\n",
        rows.len()
    ))?;
    Ok(u8::from(failed > 0))
}

/// The sweep that is asked for.
fn sweep(options: &Options) -> Result<Sweep, Error> {
    let variables = options.vary.iter().map(|text| Variable::parse(text));
    let variables = variables
        .collect::<Result<_, _>>()
        .map_err(|fault| Error::Input(vec![fault]))?;
    let fitted = options.fit.as_deref().map(|path| {
        let text = read_text(path)?;
        let read = FittedParameters::parse(&path.display().to_string(), &text);
        read.map_err(|fault| Error::Input(vec![fault]))
    });
    Ok(Sweep {
        study: BaseStudy {
            path: options.study.clone(),
            text: read_text(&options.study)?,
            budget: options.large.budget(),
        },
        variables,
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

/// Computes runs; each is kept as soon as it ends.
fn computed(
    sweep: &Sweep,
    runs: &[Run],
    mut results: ResultFolder,
) -> Result<(Vec<Row>, ResultFolder), Error> {
    let kept = runs
        .iter()
        .filter_map(|run| results.kept::<Row>(&run.number.to_string()));
    let done: HashMap<usize, Row> = kept.map(|row| (row.number, row)).collect();
    let progress = Progress::of(runs.len() as u64);
    progress.tell("runs");
    done.iter().for_each(|_| progress.advance());
    let results = Mutex::new(results);
    let keep = |row: &Row| {
        let mut folder = results.lock().unwrap_or_else(PoisonError::into_inner);
        progress.tell(&format!("run {}", row.number));
        progress.advance();
        folder.keep(&row.number.to_string(), row)
    };
    let rows = sweep.compute(runs, done, &keep)?;
    drop(progress);
    Ok((
        rows,
        results.into_inner().unwrap_or_else(PoisonError::into_inner),
    ))
}

/// The rows of all parts, which have to be there and be those of this sweep.
fn joined(sweep: &Sweep, runs: &[Run], whole: &Path, parts: usize) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let mut missing = Vec::new();
    for part in 1..=parts {
        let path = Shard { part, parts }.folder(whole).join(TABLE);
        match fs::read(&path) {
            Ok(bytes) => rows.extend(sweep::read(&path, sweep.keys().len(), &bytes)?),
            Err(_) => missing.push(part.to_string()),
        }
    }
    if !missing.is_empty() {
        return Err(Error::input(
            format!(
                "parts of {parts} that are not there: {}",
                missing.join(", ")
            ),
            "compute each with --shard PART/PARTS first",
        ));
    }
    rows.sort_by_key(|row| row.number);
    let same = rows.len() == runs.len()
        && rows.iter().zip(runs).all(|(row, run)| {
            let pairs = row.settings.iter().zip(&run.settings);
            row.number == run.number && pairs.into_iter().all(|(a, b)| a.words() == b.words())
        });
    match same {
        true => Ok(rows),
        false => Err(Error::input(
            "the parts are not those of this sweep",
            "give the same --vary, --fit, --samples, --method and --seed as with --shard",
        )),
    }
}

fn write(sweep: &Sweep, rows: &[Row], folder: &mut ResultFolder) -> Result<(), Error> {
    let keys = sweep.keys();
    folder.add(TABLE, &sweep::write(&keys, rows))?;
    let report = format!("{:#}\n", sweep::json(&keys, rows));
    folder.add("sweep.json", report.as_bytes())?;
    let title = format!("Many runs of {}", name(&sweep.study.path));
    let blocks = sweep::blocks(&title, &keys, rows);
    let figures = sweep::figures(&keys, rows, "stretch, load factor, or time in s");
    warn(&output::write_document(
        folder, "report", &blocks, &figures,
    )?);
    Ok(())
}
