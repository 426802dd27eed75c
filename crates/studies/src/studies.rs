//! Studies that a user runs: plates, specimens, motions, fields of markers. Each kind has a module of its own.

use std::path::{Path, PathBuf};

use web_time::Instant;

use crate::budget::Budget;
use crate::document::{Document, Faults, Key, Section};
use crate::error::{Diagnostic, Error};
use crate::material::Card;
use crate::results::{Block, Outcome, Results};
use crate::solve::{Attendance, Journal};

pub mod card;
mod findings;
pub mod images;
pub mod markers;
mod models;
pub mod motion;
pub mod other_files;
pub mod pictures;
pub mod plate;
pub mod points;
mod regions;
pub mod sections;
mod series;
pub mod specimen;
mod steps;

pub use findings::findings_of_state;
pub use models::{ModelKind, OneModel};
pub use steps::Steps;

/// Reports the progress of a computation, and may keep its equilibria in a journal.
#[derive(Clone, Copy)]
pub struct Progress<'a> {
    report: &'a dyn Fn(&str),
    journal: Option<&'a dyn Journal>,
}

impl<'a> Progress<'a> {
    /// Reports to `report`.
    pub fn to(report: &'a dyn Fn(&str)) -> Self {
        Self {
            report,
            journal: None,
        }
    }

    /// Reports nothing.
    pub fn silent() -> Self {
        Self::to(&|_| ())
    }

    /// The same with a journal: a computation that was interrupted resumes from the equilibria in it.
    pub fn kept_by(self, journal: &'a dyn Journal) -> Self {
        Self {
            journal: Some(journal),
            ..self
        }
    }

    /// Reports what is being done.
    pub fn tell(&self, what: &str) {
        (self.report)(what);
    }

    /// For a path that reports its load factors to `reached`.
    pub fn along<'b>(&self, reached: &'b dyn Fn(f64)) -> Attendance<'b>
    where
        'a: 'b,
    {
        Attendance {
            journal: self.journal,
            ..Attendance::reporting(reached)
        }
    }
}

/// A study that has been read, ready to be computed.
pub struct PreparedStudy {
    name: String,
    title: String,
    kind: &'static str,
    text: String,
    defaults: Vec<String>,
    computation: Computation,
    /// Warnings, which do not stop the work.
    pub warnings: Vec<Diagnostic>,
    /// What it writes, and where.
    pub output: OutputSettings,
    /// What the study computes, in words.
    pub about: String,
    /// The number of progress reports of its computation; zero where that is not known.
    pub progress_steps: usize,
}

/// What a study writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputSettings {
    /// The folder that receives everything; `None` where the study names none.
    pub folder: Option<PathBuf>,
    /// Whether `.vtu` and `.pvd` files are written.
    pub vtk: bool,
    /// Whether pictures are written.
    pub plots: bool,
    /// Whether reports are written.
    pub report: bool,
    /// Whether the table of the springs is written.
    pub springs: bool,
}

/// The file with the springs of a lattice.
pub const SPRINGS_TABLE: &str = "springs.csv";

impl Default for OutputSettings {
    fn default() -> Self {
        Self {
            folder: None,
            vtk: true,
            plots: true,
            report: true,
            springs: true,
        }
    }
}

impl OutputSettings {
    fn read(section: &Section) -> Self {
        let folder = section.text("folder");
        let settings = Self {
            folder: (!folder.is_empty()).then(|| PathBuf::from(folder)),
            vtk: section.flag_or(true, "vtk"),
            plots: section.flag("plots"),
            report: section.flag("report"),
            springs: section.flag("springs"),
        };
        section.unknown_keys();
        settings
    }

    /// Takes from an outcome what is not written.
    fn apply(&self, outcome: &mut Outcome) {
        if !self.vtk {
            outcome.explored = std::mem::take(&mut outcome.grids);
        }
        if !self.springs {
            outcome.files.retain(|(name, _)| name != SPRINGS_TABLE);
        }
        if !self.plots {
            outcome.figures.clear();
            outcome
                .blocks
                .retain(|block| !matches!(block, Block::Figure(..)));
        }
    }
}

/// Faults are reported before anything is computed.
const SOUND: &str = "a study without faults";

/// The computation of a study.
pub type Computation = Box<dyn FnOnce(Progress) -> Result<Outcome, Error>>;

/// Reads the studies of a kind.
pub type Prepare = fn(&Section, &Path) -> Computation;

/// A kind of study, without the code that computes it.
pub struct Kind {
    /// The key `kind` of its studies.
    pub name: &'static str,
    /// The text of its built-in study, whose values are the defaults.
    pub study: &'static str,
    /// The path of that study.
    pub file: &'static str,
    /// Path and text of the built-in study of a shape, whose values are the defaults of studies with a `[specimen]`.
    pub of_shape: Option<(&'static str, &'static str)>,
    /// Whether `--quick` leaves it out.
    pub slow: bool,
}

/// The kinds of studies that are a user's own, with the words before the card's title in the title of an untitled one. Studies of other
/// kinds have the title of their built-in study, and write what a case of the validation writes.
const UNTITLED: [(&str, &str); 3] = [
    ("plate", "Clamped plate"),
    ("specimen", "Specimen"),
    ("motion", "Moving plate"),
];

impl Kind {
    /// The built-in study whose values are the defaults of a study.
    fn defaults(&self, study: &Document, faults: &Faults) -> Document<'static> {
        let root = study.root(None, faults);
        match self.of_shape.filter(|_| root.is_of("specimen")) {
            Some((file, text)) => Document::parse(file, text, faults),
            None => Document::parse(self.file, self.study, faults),
        }
    }

    /// Reads a study of this kind with `prepare`, within a budget.
    ///
    /// # Errors
    /// [`Error::Input`] with every fault.
    pub fn read(
        &self,
        prepare: Prepare,
        file: &Path,
        text: &str,
        budget: Budget,
    ) -> Result<PreparedStudy, Error> {
        let read = self.read_with(file, text, budget, prepare)?;
        Ok(PreparedStudy::new(self, name(file), text, read))
    }

    /// The value that `read` returns for a study without faults.
    fn load<T>(
        &self,
        file: &Path,
        text: &str,
        budget: Budget,
        read: impl FnOnce(&Section, &Path) -> Option<T>,
    ) -> Result<Loaded<T>, Error> {
        let read = self.read_with(file, text, budget, read)?;
        Ok(read.map(|content| content.expect(SOUND)))
    }

    /// The keys that are looked up when `read` reads a text.
    pub fn keys<T>(&self, text: &str, read: impl FnOnce(&Section, &Path) -> T) -> Vec<Key> {
        let faults = Faults::default();
        let document = Document::parse("", text, &faults);
        let defaults = self.defaults(&document, &faults);
        let root = document.root(Some(&defaults), &faults);
        root.text("kind");
        self.title(&root, text, Path::new("."));
        drop(read(&root, Path::new(".")));
        self.output(&root);
        faults.keys()
    }

    /// What the study writes.
    fn output(&self, root: &Section) -> OutputSettings {
        if UNTITLED.iter().any(|(kind, _)| *kind == self.name) {
            OutputSettings::read(&root.section("output"))
        } else {
            OutputSettings::default()
        }
    }

    /// The title of the study: for a plate, a specimen or a motion without a title, that of its materials; for the others, that of their built-in study.
    fn title(&self, root: &Section, text: &str, folder: &Path) -> String {
        let Some((_, what)) = UNTITLED.iter().find(|(kind, _)| *kind == self.name) else {
            return root.heading("title");
        };
        root.stated("title", Section::heading).unwrap_or_else(|| {
            // Faults of the card are reported where the study is read.
            let faults = Faults::default();
            let document = Document::parse("", text, &faults);
            let defaults = self.defaults(&document, &faults);
            let root = document.root(Some(&defaults), &faults);
            let sections = root.section_or_sections("material");
            let cards = sections.iter().map(|section| section.text("card"));
            let cards: Vec<Card> = cards
                .filter_map(|name| Card::load(&name, folder).ok())
                .collect();
            Card::title_of(what, &cards)
        })
    }

    /// Reads a study of this kind with `read`.
    fn read_with<T>(
        &self,
        file: &Path,
        text: &str,
        budget: Budget,
        read: impl FnOnce(&Section, &Path) -> T,
    ) -> Result<Loaded<T>, Error> {
        let folder = file.parent().unwrap_or(Path::new("."));
        let file = file.display().to_string();
        let faults = Faults::within(budget);
        let (title, content, output) = {
            let document = Document::parse(&file, text, &faults);
            let defaults = self.defaults(&document, &faults);
            let root = document.root(Some(&defaults), &faults);
            root.text("kind");
            let title = self.title(&root, text, folder);
            let content = read(&root, folder);
            let output = self.output(&root);
            root.unknown_keys();
            (title, content, output)
        };
        let defaults = faults.defaults();
        let warnings = faults.finish()?;
        Ok(Loaded {
            title,
            content,
            output,
            defaults,
            warnings,
        })
    }
}

/// The name of a study: that of its file, without the extension.
pub fn name(file: &Path) -> String {
    let stem = file.file_stem();
    stem.map_or_else(String::new, |stem| stem.to_string_lossy().into())
}

/// A name as the begin of the names of files.
fn file_stem(name: &str) -> String {
    let letter = |letter: char| match letter {
        '-' | '_' | '.' => letter,
        _ if letter.is_alphanumeric() => letter,
        _ => '_',
    };
    name.chars().map(letter).collect()
}

/// A study that was read.
pub struct Loaded<T> {
    /// Its title.
    pub title: String,
    /// The value that its reader returned.
    pub content: T,
    /// What it writes.
    pub output: OutputSettings,
    /// The keys that it does not state, with the defaults used.
    pub defaults: Vec<String>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

impl<T> Loaded<T> {
    /// The same with what is made of the reader's value.
    fn map<U>(self, make: impl FnOnce(T) -> U) -> Loaded<U> {
        Loaded {
            title: self.title,
            content: make(self.content),
            output: self.output,
            defaults: self.defaults,
            warnings: self.warnings,
        }
    }
}

impl PreparedStudy {
    fn new(kind: &Kind, name: String, text: &str, read: Loaded<Computation>) -> Self {
        Self {
            name,
            title: read.title,
            kind: kind.name,
            text: text.to_owned(),
            defaults: read.defaults,
            computation: read.content,
            warnings: read.warnings,
            output: read.output,
            about: format!("a study of the kind {}", kind.name),
            progress_steps: 0,
        }
    }

    /// Values of specimen, material and load that were used because the study does not state them, as `plate.length = "150 mm"`.
    pub fn physical_defaults(&self) -> impl Iterator<Item = &str> {
        const PHYSICAL: [&str; 3] = ["material.", "plate.", "load."];
        let is_physical = |key: &&str| PHYSICAL.iter().any(|table| key.starts_with(table));
        self.defaults.iter().map(String::as_str).filter(is_physical)
    }

    /// Computes the study.
    ///
    /// # Errors
    /// [`Error::Solve`] when a model has no solution.
    pub fn compute(self, progress: Progress) -> Result<Results, Error> {
        let start = Instant::now();
        let mut outcome = (self.computation)(progress)?;
        self.output.apply(&mut outcome);
        Ok(Results {
            name: self.name,
            title: self.title,
            kind: self.kind,
            text: self.text,
            defaults: self.defaults,
            read_warnings: self.warnings.iter().map(ToString::to_string).collect(),
            outcome,
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}
