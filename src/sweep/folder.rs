//! The folder of a sweep: each run is kept as soon as it ends, and parts computed by several jobs are combined.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::panicking;

use super::plan::Run;
use super::{Row, Setting, Sweep, blocks, figures, json, read, write};
use gelbench_base::document::inputs::noted;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_report::output::{ANOTHER_FOLDER, ResultFolder, Unfinished, identity, write_document};
use gelbench_studies::studies::name;

/// The file with a line for each run.
const TABLE: &str = "sweep.csv";

/// The statistics of all figures, for machines.
const REPORT: &str = "sweep.json";

/// One part of the runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    part: usize,
    parts: usize,
}

impl Shard {
    /// The part `part`, from 1 on, of so many; `None` if there is no such part.
    pub fn new(part: usize, parts: usize) -> Option<Self> {
        (1..=parts).contains(&part).then_some(Self { part, parts })
    }

    /// Whether a run belongs to it: every `parts`-th one does.
    pub fn holds(self, run: &Run) -> bool {
        (run.number - 1) % self.parts == self.part - 1
    }

    fn folder(self, root: &Path) -> PathBuf {
        root.join(format!("part_{}_of_{}", self.part, self.parts))
    }
}

/// The runs, and where they come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// All runs are computed.
    Whole,
    /// The runs of one part are computed, into a folder of their own.
    Shard(Shard),
    /// The tables of so many parts are combined.
    Join(usize),
}

/// A sweep that is computed into a folder.
pub struct SweepFolder<'a> {
    sweep: &'a Sweep,
    share: Share,
    root: PathBuf,
    runs: Vec<Run>,
    results: ResultFolder,
}

impl AsRef<ResultFolder> for SweepFolder<'_> {
    fn as_ref(&self) -> &ResultFolder {
        &self.results
    }
}

impl<'a> SweepFolder<'a> {
    /// Opens the folder, with the runs that the same sweep by the same `program` has left when it was interrupted.
    /// The results follow from the files `inputs`, and must not replace them.
    ///
    /// # Errors
    /// [`Error::Input`] with the faults of the sweep and of the study; [`Error::Write`] as in [`ResultFolder::resume`].
    pub fn open(
        sweep: &'a Sweep,
        share: Share,
        root: &Path,
        inputs: &[&Path],
        program: Option<&Path>,
    ) -> Result<Self, Error> {
        let mut runs = sweep.runs()?;
        let mut folder = root.to_owned();
        if let Share::Shard(shard) = share {
            runs.retain(|run| shard.holds(run));
            folder = shard.folder(root);
        }
        let (ready, files) = noted(|| {
            let ready = sweep.study.read();
            sweep.read_files();
            ready
        });
        ready?;
        let identity = identity(&format!("{sweep:?} {share:?}"), &files, program);
        Ok(Self {
            sweep,
            share,
            root: root.to_owned(),
            runs,
            results: ResultFolder::resume(&folder, "sweep", inputs, &identity)?,
        })
    }

    /// A warning where the folder contains other results of sweeps: those of another study or of other keys.
    pub fn replaces(&self) -> Option<Diagnostic> {
        let other_study = self.results.replaces();
        other_study.or_else(|| {
            let position = self.results.path();
            has_another(self.sweep, &self.runs, position).then(|| {
                let message = format!(
                    "{} contains another sweep: it is replaced",
                    position.display()
                );
                Diagnostic::warning("", message).hint(ANOTHER_FOLDER)
            })
        })
    }

    /// The number of runs, computed or not.
    pub fn count(&self) -> usize {
        self.runs.len()
    }

    /// Computes the runs, or combines them; each is kept as soon as it ends. `ended` is called with the number of each, including those
    /// that an earlier sweep has left; `attend` is that of [`Sweep::compute`]. Where it unwinds, the kept runs stay for a later start.
    ///
    /// # Errors
    /// Those of [`Sweep::compute`], and [`Error::Write`].
    pub fn rows(
        &mut self,
        ended: &(dyn Fn(usize) + Sync),
        attend: &(dyn Fn() + Sync),
    ) -> Result<Vec<Row>, Error> {
        if let Share::Join(parts) = self.share {
            return self.of_parts(parts);
        }
        let _parts_stay = PartsStay(self.results.unfinished());
        let results = &mut self.results;
        let kept = self.runs.iter();
        let kept = kept.filter_map(|run| results.kept::<Row>(&run.number.to_string()));
        let done: HashMap<usize, Row> = kept.map(|row| (row.number, row)).collect();
        done.keys().for_each(|number| ended(*number));
        let results = Mutex::new(results);
        let keep = |row: &Row| {
            let mut folder = results.lock().unwrap_or_else(PoisonError::into_inner);
            folder.keep(&row.number.to_string(), row)?;
            drop(folder);
            ended(row.number);
            Ok(())
        };
        self.sweep.compute(&self.runs, done, &keep, attend)
    }

    fn of_parts(&self, parts: usize) -> Result<Vec<Row>, Error> {
        let keys = self.sweep.keys();
        let (mut rows, mut missing) = (Vec::new(), Vec::new());
        for shard in (1..=parts).filter_map(|part| Shard::new(part, parts)) {
            let path = shard.folder(&self.root).join(TABLE);
            match fs::read(&path) {
                Ok(bytes) => rows.extend(read(&path, &keys, &bytes)?),
                Err(_) => missing.push(shard.part.to_string()),
            }
        }
        if !missing.is_empty() {
            let missing = missing.join(", ");
            return Err(Error::input(
                format!("missing parts of {parts}: {missing}"),
                "compute each with --shard PART/PARTS first",
            ));
        }
        join(&self.runs, rows)
    }

    /// Writes the table, the report and the pictures of rows; the files, and a warning for each picture that cannot be drawn.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(mut self, rows: &[Row]) -> Result<(Vec<PathBuf>, Vec<Diagnostic>), Error> {
        let (keys, folder) = (self.sweep.keys(), &mut self.results);
        folder.add(TABLE, &write(&keys, rows))?;
        let report = format!("{:#}\n", json(&keys, rows));
        folder.add(REPORT, report.as_bytes())?;
        let title = format!("Many runs of {}", name(&self.sweep.study.path));
        let figures = figures(&keys, rows, self.sweep.study.steps_run_along());
        let blocks = blocks(&title, &keys, rows, &figures);
        let warnings = write_document(folder, "report", &blocks, &figures)?;
        Ok((self.results.finish()?, warnings))
    }
}

/// The folder of a name, or with a number after its name the first one that holds no other sweep.
///
/// # Errors
/// [`Error::Input`] with the faults of the sweep.
pub fn free_folder(sweep: &Sweep, usual: PathBuf) -> Result<PathBuf, Error> {
    let runs = sweep.runs()?;
    let (mut folder, mut number) = (usual.clone(), 1);
    while has_another(sweep, &runs, &folder) {
        number += 1;
        let mut name = usual.as_os_str().to_owned();
        name.push(format!("_{number}"));
        folder = PathBuf::from(name);
    }
    Ok(folder)
}

/// Whether a folder has the table of a sweep over other keys or values.
fn has_another(sweep: &Sweep, runs: &[Run], folder: &Path) -> bool {
    let path = folder.join(TABLE);
    fs::read(&path).is_ok_and(|bytes| {
        let rows = read(&path, &sweep.keys(), &bytes);
        rows.and_then(|rows| join(runs, rows)).is_err()
    })
}

/// The rows of all parts in the order of the runs.
///
/// # Errors
/// [`Error::Input`] where they are not those of these runs.
pub fn join(runs: &[Run], mut rows: Vec<Row>) -> Result<Vec<Row>, Error> {
    rows.sort_by_key(|row| row.number);
    let same = rows.len() == runs.len()
        && rows.iter().zip(runs).all(|(row, run)| {
            let mut pairs = row.settings.iter().zip(&run.settings);
            let alike =
                |a: &Setting, b: &Setting| a.plain_text() == b.plain_text() && a.unit() == b.unit();
            row.number == run.number && pairs.all(|(a, b)| alike(a, b))
        });
    if same {
        Ok(rows)
    } else {
        Err(Error::input(
            "the parts are not those of this sweep",
            "give the same --vary, --points, --fit, --samples, --method and --seed as with --shard",
        ))
    }
}

/// Leaves the kept runs in place where a computation is interrupted by unwinding.
struct PartsStay(Arc<Unfinished>);

impl Drop for PartsStay {
    fn drop(&mut self) {
        if panicking() {
            drop(self.0.break_off());
        }
    }
}
