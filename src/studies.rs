//! What a user runs: plates, specimens, motions, fields of markers. Each kind has a module of its own.

use std::path::Path;
use std::time::Instant;

use crate::document::{Document, Faults, Section};
use crate::error::{Diagnostic, Error};
use crate::results::{Computed, Outcome};

pub mod markers;
pub mod motion;
pub mod plate;
pub mod sections;
pub mod specimen;

/// Reports what is being done.
pub type Progress<'a> = &'a dyn Fn(&str);

/// A study of a case that has been read, ready to be computed.
pub struct Ready {
    title: String,
    kind: &'static str,
    text: String,
    defaults: Vec<String>,
    prepared: Prepared,
    /// What deserves attention but does not stop the work.
    pub warnings: Vec<Diagnostic>,
}

/// The computation of a case.
pub type Prepared = Box<dyn FnOnce(Progress) -> Result<Outcome, Error>>;

/// A kind of study.
pub struct Kind {
    /// The `kind` of its studies.
    pub kind: &'static str,
    /// The study that comes along; its keys are the defaults.
    pub study: &'static str,
    /// Where that study stands.
    pub file: &'static str,
    /// Whether `--quick` leaves it out.
    pub slow: bool,
    /// Reads one.
    pub prepare: fn(&Section, &Path) -> Prepared,
}

impl Kind {
    /// Reads a study of this case.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault.
    pub fn read(&self, file: &Path, text: &str) -> Result<Ready, Error> {
        let read = self.read_with(file, text, self.prepare)?;
        Ok(Ready {
            title: read.title,
            kind: self.kind,
            text: text.to_owned(),
            defaults: read.defaults,
            prepared: read.made,
            warnings: read.warnings,
        })
    }

    /// What `read` makes of a study of this case.
    fn read_with<T>(
        &self,
        file: &Path,
        text: &str,
        read: impl FnOnce(&Section, &Path) -> T,
    ) -> Result<Read<T>, Error> {
        let folder = file.parent().unwrap_or(Path::new("."));
        let file = file.display().to_string();
        let faults = Faults::default();
        let (title, made) = {
            let defaults = Document::parse(self.file, self.study, &faults);
            let document = Document::parse(&file, text, &faults);
            let root = document.root(Some(&defaults), &faults);
            root.text("kind");
            let title = root.heading("title");
            let made = read(&root, folder);
            root.unknown_keys();
            (title, made)
        };
        let defaults = faults.defaults();
        let warnings = faults.finish()?;
        Ok(Read {
            title,
            made,
            defaults,
            warnings,
        })
    }
}

/// What was read of a study.
struct Read<T> {
    title: String,
    made: T,
    /// The keys that it does not hold, with the defaults that they took.
    defaults: Vec<String>,
    warnings: Vec<Diagnostic>,
}

impl Ready {
    /// Computes the study.
    ///
    /// # Errors
    /// [`Error::Solve`] when a model has no solution.
    pub fn compute(self, progress: Progress) -> Result<Computed, Error> {
        let start = Instant::now();
        let outcome = (self.prepared)(progress)?;
        Ok(Computed {
            title: self.title,
            kind: self.kind,
            text: self.text,
            defaults: self.defaults,
            outcome,
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}
