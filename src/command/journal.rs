//! Equilibria that a run stores in its folder, to go on from after an interruption.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use gelbench_base::error::{Diagnostic, Error};
use gelbench_mechanics::solve::{Journal, Milestone};
use gelbench_report::output::ResultFolder;

/// How much work may be lost when the run is killed, besides the load factor that is being solved; states found in less time are
/// not written.
const WORTH_A_FILE: Duration = Duration::from_secs(2);

/// Equilibria with the number of their path.
type Milestones = Vec<(usize, Milestone)>;

/// The equilibria of a run, path by path in the order in which it follows them, which is the same on every run.
pub struct FolderJournal {
    folder: RefCell<ResultFolder>,
    /// What a run before has found, by the number of the path.
    before: RefCell<BTreeMap<usize, Vec<Milestone>>>,
    /// How many equilibria that were.
    count: usize,
    /// How many paths were begun.
    paths: Cell<usize>,
    /// What is not written yet.
    milestones: RefCell<Milestones>,
    /// How many parts are written.
    parts: Cell<usize>,
    written: Cell<Instant>,
    /// Why a part could not be written.
    fault: RefCell<Option<Error>>,
}

impl FolderJournal {
    /// Reads the equilibria that a former run has left in a folder.
    pub fn open(mut folder: ResultFolder) -> Self {
        let mut before: BTreeMap<usize, Vec<Milestone>> = BTreeMap::new();
        let mut parts = 0;
        while let Some(milestones) = folder.kept::<Milestones>(&parts.to_string()) {
            for (path, milestone) in milestones {
                before.entry(path).or_default().push(milestone);
            }
            parts += 1;
        }
        Self {
            folder: RefCell::new(folder),
            count: before.values().map(Vec::len).sum(),
            before: RefCell::new(before),
            paths: Cell::new(0),
            milestones: RefCell::default(),
            parts: Cell::new(parts),
            written: Cell::new(Instant::now()),
            fault: RefCell::new(None),
        }
    }

    /// The warning that a run goes on from an earlier one.
    pub fn warning(&self) -> Option<Diagnostic> {
        let message = format!(
            "the run continues from {} equilibria that it had found before it was interrupted; the times cover only the rest",
            self.count
        );
        (self.count > 0).then(|| Diagnostic::warning("", message))
    }

    /// The folder, for the results, and a word where equilibria could not be kept.
    pub fn close(self) -> (ResultFolder, Option<Diagnostic>) {
        let fault_text = |fault| {
            let message = format!(
                "equilibria could not be stored for continuing an interrupted run: {fault}"
            );
            Diagnostic::warning("", message)
        };
        (
            self.folder.into_inner(),
            self.fault.into_inner().map(fault_text),
        )
    }

    /// Writes the equilibria that are not written yet, unless that has failed before.
    fn write(&self) {
        let (part, milestones) = (self.parts.get(), self.milestones.take());
        if self.fault.borrow().is_some() {
            return;
        }
        let kept = self
            .folder
            .borrow_mut()
            .keep(&part.to_string(), &milestones);
        self.fault.replace(kept.err());
        self.parts.set(part + 1);
        self.written.set(Instant::now());
    }
}

impl Journal for FolderJournal {
    fn begin(&self) -> Vec<Milestone> {
        let path = self.paths.get();
        self.paths.set(path + 1);
        self.before.borrow_mut().remove(&path).unwrap_or_default()
    }

    fn keep(&self, milestone: Milestone) {
        let path = self.paths.get() - 1;
        self.milestones.borrow_mut().push((path, milestone));
        if self.written.get().elapsed() >= WORTH_A_FILE {
            self.write();
        }
    }
}
