//! The statements of a user about a field as a request to the library.

use std::path::{Path, PathBuf};

use gelbench::budget::Budget;
use gelbench::error::Error;
use gelbench::markers::{ChosenColumns, ReadSettings};
use gelbench::mesh::CellShape;
use gelbench::studies::markers::{Conditions, MeshSource, Request};
use gelbench::units::{Dimension, parse};
use gelbench_images::images::ImageFile;
use gelbench_studies::studies::images::ImageSettings;

use super::FieldQuestion;

/// A length that a user writes; nothing where the text is empty.
pub(super) fn length(what: &str, text: &str) -> Result<Option<f64>, Error> {
    if text.trim().is_empty() {
        return Ok(None);
    }
    let read = parse(text.trim(), Dimension::Length);
    read.map(Some)
        .map_err(|fault| Error::input(format!("{what} {fault}"), "such as \"2 mm\""))
}

pub(super) fn request(question: &FieldQuestion) -> Result<Request, Error> {
    let stated = length("the thickness", &question.thickness)?;
    let thickness = stated.filter(|value| *value > 0.0).ok_or_else(|| {
        Error::input(
            "the thickness at rest is not stated",
            "write it with its unit, such as \"2 mm\"",
        )
    })?;
    let columns = question
        .columns
        .split(',')
        .filter(|column| !column.trim().is_empty());
    let columns = ChosenColumns::parse(columns)?;
    let mut edges = Vec::new();
    for (name, edge) in &question.edges {
        let condition = edge.condition(name)?;
        edges.extend(condition.map(|condition| (name.clone(), condition)));
    }
    let [mask, outline] = question.mask_and_outline();
    Ok(Request {
        files: question
            .files
            .iter()
            .map(|(name, _)| PathBuf::from(name))
            .collect(),
        reading: ReadSettings {
            unit: unit(&question.unit)?,
            columns,
            downwards: question.downwards,
            ..ReadSettings::default()
        },
        images: ImageSettings {
            mask: mask.map(|mask| ImageFile::new(Path::new(mask), 0)),
            ..ImageSettings::default()
        },
        material: question.card.reference(),
        thickness,
        mesh: outline.map_or(MeshSource::Data, |lines| MeshSource::Outline(lines.into())),
        cell_size: length("the size of cells", &question.cell_size)?,
        shape: CellShape::Triangle6,
        holes: true,
        conditions: Conditions {
            edges,
            edge_gap: length("the gap to the edge", &question.edge_gap)?,
            ..Conditions::default()
        },
        forces: None,
        budget: Budget::USUAL,
    })
}

/// A unit such as `mm`, or the length of a pixel such as `0.05 mm`.
pub(super) fn unit(text: &str) -> Result<Option<f64>, Error> {
    let text = text.trim();
    let begins_with_number = text.starts_with(|first: char| first.is_ascii_digit() || first == '.');
    if text.is_empty() || begins_with_number {
        length("the unit", text)
    } else {
        length("the unit", &format!("1 {text}"))
    }
}
