//! What is known of a specimen besides its displacements: a file, completed by the command line.
//!
//! ```toml
//! title = "Strip, test 12"   # of the report
//! noise = "0.1 mm"           # standard deviation of each component; estimated where it is left out
//! robust = "tukey"           # "no", "huber" or "tukey"
//!
//! [[edges]]                  # edges that are not named: holes are free, outer edges move in an unknown smooth way
//! names = ["top", "bottom"]
//! condition = "free"         # "free", "known", "rigid" (moved by unknown amounts) or "unknown"
//!
//! [[edges]]
//! names = ["left"]
//! condition = "known"
//! ux = "0 mm"                # an axis that is left out is free
//! uy = "0 mm"
//! ```

use std::path::Path;

use crate::corrector::measured::{EdgeCondition, Knowledge, Robust};
use crate::document::{Bound, Document, Faults, Section};
use crate::error::{Diagnostic, Error, suggestion};
use crate::mesh::Mesh;
use crate::study;
use crate::units::Dimension;

/// An edge by its name, with what is known of it.
pub type EdgesByName = Vec<(String, EdgeCondition)>;

/// What is known besides the displacements.
#[derive(Clone, Debug, Default)]
pub struct Conditions {
    /// Heading of the report; empty where it is not given.
    pub title: String,
    /// The edges.
    pub edges: EdgesByName,
    /// Standard deviation of each component of the displacement in mm.
    pub noise: Option<f64>,
    /// How markers that are far off are weighted.
    pub robust: Robust,
}

#[derive(Clone, Copy)]
enum Kind {
    Free,
    Known,
    Rigid,
    Unknown,
}

const KINDS: [(&str, Kind); 4] = [
    ("free", Kind::Free),
    ("known", Kind::Known),
    ("rigid", Kind::Rigid),
    ("unknown", Kind::Unknown),
];

impl Conditions {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Input`] with all of its faults.
    pub fn of_file(path: &Path) -> Result<Self, Error> {
        let text = study::read(path)?;
        let faults = Faults::default();
        let document = Document::parse(&path.display().to_string(), &text, &faults);
        let conditions = read(&document.root(None, &faults));
        drop(document);
        faults.finish()?;
        Ok(conditions)
    }

    /// Whether the mesh has the edges that are named, each once.
    ///
    /// # Errors
    /// [`Error::Input`] with every name that is wrong.
    pub fn check(&self, mesh: &Mesh) -> Result<(), Error> {
        let known: Vec<&str> = mesh.groups().keys().map(String::as_str).collect();
        let mut faults = Vec::new();
        for (index, (name, _)) in self.edges.iter().enumerate() {
            if !known.contains(&&**name) {
                let hint = suggestion(name, &known, "its edges:");
                let fault = Diagnostic::error("", format!("the mesh has no edge `{name}`"));
                faults.push(fault.hint(hint));
            }
            if self.edges[..index].iter().any(|(other, _)| other == name) {
                let fault = Diagnostic::error("", format!("the edge `{name}` has two conditions"));
                faults.push(fault.hint("name it once"));
            }
        }
        match faults.is_empty() {
            true => Ok(()),
            false => Err(Error::Input(faults)),
        }
    }

    /// As the estimate takes it.
    pub fn knowledge(&self) -> Knowledge {
        Knowledge {
            edges: self.edges.clone(),
            noise: self.noise,
            robust: self.robust,
        }
    }
}

fn read(root: &Section) -> Conditions {
    let mut conditions = Conditions::default();
    if root.has("title") {
        conditions.title = root.heading("title");
    }
    if root.has("noise") {
        conditions.noise = Some(root.quantity("noise", Dimension::Length, Bound::Positive));
    }
    if root.has("robust") {
        conditions.robust = root.choice("robust", &Robust::NAMES).unwrap_or_default();
    }
    if root.has("edges") {
        for section in root.tables("edges") {
            let names = section.texts("names");
            let condition = condition(&section);
            conditions
                .edges
                .extend(names.into_iter().map(|name| (name, condition)));
            section.unknown_keys();
        }
    }
    root.unknown_keys();
    conditions
}

fn condition(section: &Section) -> EdgeCondition {
    let along = |key: &'static str| {
        let has = section.has(key);
        has.then(|| section.quantity(key, Dimension::Length, Bound::Any))
    };
    match section.choice("condition", &KINDS) {
        Some(Kind::Known) => {
            let displacement = [along("ux"), along("uy")];
            if displacement == [None, None] {
                let hint = "add ux = \"5 mm\", uy = \"0 mm\", or one of them";
                section.fault("condition", "a known edge needs its displacement", hint);
            }
            EdgeCondition::Known(displacement)
        }
        Some(Kind::Rigid) => EdgeCondition::Rigid,
        Some(Kind::Unknown) => EdgeCondition::Unknown,
        Some(Kind::Free) | None => EdgeCondition::Free,
    }
}
