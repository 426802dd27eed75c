//! The statements of a file of conditions.

use std::path::Path;

use super::area::Area;
use super::conditions::{Conditions, measured_force};
use super::machine::{ForceColumn, FrameClock};
use super::specimen_file::SpecimenFile;
use crate::document::{Bound, Document, Faults, Key, Section};
use crate::error::Error;
use crate::estimation::{EdgeCondition, MeasuredForce, Physics, Robust, Unnamed};
use crate::material::{Card, PlaneState};
use crate::studies::card::read_card;
use crate::studies::sections;
use crate::units::Dimension;

/// The conditions of edges by their names; the displacements of a known one follow.
const CONDITIONS: [(&str, EdgeCondition); 4] = [
    ("free", EdgeCondition::Free),
    ("known", EdgeCondition::Known([None; 2])),
    ("rigid", EdgeCondition::Rigid),
    ("unknown", EdgeCondition::Unknown),
];

impl Conditions {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Input`] with all of its faults.
    pub fn of_file(path: &Path) -> Result<Self, Error> {
        Self::parse(&path.display().to_string(), &sections::read_text(path)?)
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// As [`Self::of_file`].
    pub fn parse(file: &str, text: &str) -> Result<Self, Error> {
        let faults = Faults::default();
        let folder = Path::new(file).parent().unwrap_or(Path::new("."));
        let conditions = read(
            &Document::parse(file, text, &faults).root(None, &faults),
            folder,
        );
        faults.finish()?;
        Ok(conditions)
    }
}

/// The keys that are asked for when a text is read.
pub fn keys(text: &str) -> Vec<Key> {
    let faults = Faults::default();
    let document = Document::parse("", text, &faults);
    read(&document.root(None, &faults), Path::new("."));
    drop(document);
    faults.keys()
}

/// The relation of the frames' times to those of the testing machine.
fn clock(root: &Section) -> FrameClock {
    let time = |key, bound| root.optional_quantity(key, Dimension::Time, bound);
    FrameClock {
        interval: time("frame_interval", Bound::Positive),
        offset: time("clock_offset", Bound::Any).unwrap_or_default(),
    }
}

/// Reads all keys; faults are recorded.
fn read(root: &Section, folder: &Path) -> Conditions {
    let length = |key, bound| root.optional_quantity(key, Dimension::Length, bound);
    let scale_bound = Bound::Within(0.0, 0.5);
    let mut conditions = Conditions {
        title: root.stated("title", Section::heading).unwrap_or_default(),
        noise: length("noise", Bound::Positive),
        edge_gap: length("edge_gap", Bound::NonNegative),
        scale_deviation: root
            .optional_quantity("scale_error", Dimension::Ratio, scale_bound)
            .unwrap_or_default(),
        clock: clock(root),
        robust: root.optional_choice("robust", &Robust::NAMES),
        physics: root
            .optional_choice("physics", &Physics::NAMES)
            .unwrap_or_default(),
        unnamed: root
            .optional_choice("unnamed", &Unnamed::NAMES)
            .unwrap_or_default(),
        sheet: root.optional_choice("sheet", &PlaneState::NAMES),
        fit: root.optional_texts("fit"),
        specimen: root
            .stated("specimen", Section::section)
            .map(|section| SpecimenFile::read(&section)),
        ..Conditions::default()
    };
    for section in &root.optional_tables("force") {
        if section.has("column") && !section.has("force") {
            conditions.force_columns.push(force_column(section));
        } else {
            conditions.forces.push(force(section));
        }
    }
    for section in root.optional_tables("material") {
        conditions.regions.extend(region(section, folder));
    }
    for section in &root.optional_tables("edges") {
        read_edges(section, &mut conditions);
    }
    root.unknown_keys();
    conditions
}

fn region(section: Section, folder: &Path) -> Option<(String, Card)> {
    let section = section.requiring(&["on", "card"]);
    let card = read_card(&section, folder);
    let region = section.text("on");
    section.unknown_keys();
    Some((region, card?))
}

/// Adds some edges with their condition, and the area of a pad.
fn read_edges(section: &Section, conditions: &mut Conditions) {
    let names = section.texts("names");
    let condition = condition(section);
    if section.has("area") {
        conditions.areas.extend(area(section, &names));
    }
    let edges = names.into_iter().map(|name| (name, condition));
    conditions.edges.extend(edges);
    section.unknown_keys();
}

/// The area of a pad, and the only name that it has.
fn area(section: &Section, names: &[String]) -> Option<(String, Area)> {
    let lengths = section.quantities("area", Dimension::Length, Bound::Any);
    let area = Area::of(&lengths);
    let hint = "write x and y of the lower left and of the upper right corner, or x, y and the radius of a disc";
    match (area, names) {
        (Some(area), [name]) => return Some((name.clone(), area)),
        (None, _) => section.fault("area", "must be a rectangle or a disc", hint),
        _ => section.fault(
            "names",
            "must be one name where there is an area",
            "give each pad a section of its own",
        ),
    }
    None
}

/// A force that stands in a column of a testing machine's table.
fn force_column(section: &Section) -> ForceColumn {
    let (edge, axis) = edge_and_axis(section);
    let column = ForceColumn {
        edge,
        axis,
        column: section.text("column"),
        standard_deviation: deviation(section),
    };
    section.unknown_keys();
    column
}

fn edge_and_axis(section: &Section) -> (String, usize) {
    let edge = section.text("edge");
    let axis = section.choice("axis", &[("x", 0), ("y", 1)]);
    (edge, axis.unwrap_or(0))
}

fn deviation(section: &Section) -> Option<f64> {
    section.optional_quantity("standard_deviation", Dimension::Force, Bound::Positive)
}

fn force(section: &Section) -> (Option<usize>, MeasuredForce) {
    let (edge, axis) = edge_and_axis(section);
    if section.has("column") {
        section.text("column");
        let hint = "leave out the column, or the force";
        section.fault("column", "must not be given together with a force", hint);
    }
    let force = section.quantity("force", Dimension::Force, Bound::Any);
    let deviation = deviation(section);
    let frame = section.stated("frame", |_, key| section.count(key, 0, usize::MAX >> 1));
    section.unknown_keys();
    (frame, measured_force(&edge, axis, force, deviation))
}

fn condition(section: &Section) -> EdgeCondition {
    let along = |key| section.optional_quantity(key, Dimension::Length, Bound::Any);
    match section.choice("condition", &CONDITIONS) {
        Some(EdgeCondition::Known(_)) => {
            let displacement = [along("ux"), along("uy")];
            if displacement == [None, None] {
                let hint = "add ux = \"5 mm\", uy = \"0 mm\", or one of them";
                section.fault("condition", "`known` needs a displacement", hint);
            }
            EdgeCondition::Known(displacement)
        }
        condition => condition.unwrap_or(EdgeCondition::Free),
    }
}
