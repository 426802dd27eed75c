//! The statements of a study for the report and for machines: specimen, supports, loads.

use serde_json::{Map, Value, json};

use super::problem::{PlateGrids, Specimen};
use crate::material::Card;
use crate::problem::{Drive, Load, Support};
use crate::results::{Block, object};
use crate::units::Linear;

/// The specimen, its supports and loads.
pub fn blocks(specimen: &Specimen) -> Vec<Block> {
    let problem = &specimen.problem;
    let row = |group: &String, text: String| vec![format!("`{group}`"), text];
    let supports = problem.supports.iter();
    let supports = supports.map(|(group, support)| row(group, support_words(support)));
    let loads = problem.loads.iter();
    let loads: Vec<_> = loads
        .map(|(group, load)| row(group, load_words(load)))
        .collect();
    let of_card = |card: &Card| format!("{}: the card `{}`", card.describe_sheet(), card.name);
    let material = specimen.cards().words(&specimen.outline.coarse(), of_card);
    let text = format!(
        "The specimen is {}, {} mm thick at rest, of {}. Displacements, rotations, forces, tractions and pressures below are those at \
         {} and are proportional to it; the path is {}.",
        specimen.outline.describe(),
        problem.thickness,
        material,
        specimen.along.describe(1.0),
        specimen.along.list(specimen.factors.iter().copied()),
    );
    let mut blocks = vec![
        Block::Heading(2, "Specimen, supports and loads".into()),
        Block::Paragraph(text),
        Block::table(&["supported group", "support"], supports),
    ];
    blocks.push(if loads.is_empty() {
        Block::Paragraph(
            "There are no loads besides the motions and forces of the supports.".into(),
        )
    } else {
        Block::table(&["loaded group", "load"], loads)
    });
    blocks
}

/// The specimen, its supports and loads, for machines.
pub fn json(specimen: &Specimen) -> Map<String, Value> {
    let problem = &specimen.problem;
    let supports = problem.supports.iter();
    let supports =
        supports.map(|(group, support)| json!({ "group": group, "says": support_words(support) }));
    let loads = problem.loads.iter();
    let loads = loads.map(|(group, load)| json!({ "group": group, "says": load_words(load) }));
    let mut all = object(json!({
        "specimen": specimen.outline.describe(),
        "thickness_mm": problem.thickness,
        "supports": supports.collect::<Vec<_>>(),
        "loads": loads.collect::<Vec<_>>(),
        (format!("{}s", specimen.along.column())): specimen.factors,
    }));
    if let Some(grids) = specimen.grids() {
        all.extend(grids_json(grids));
    }
    all
}

/// The measures and grids of a plate.
fn grids_json(grids: &PlateGrids) -> Map<String, Value> {
    let elements = &grids.elements;
    object(json!({
        "length_mm": grids.size[0],
        "width_mm": grids.size[1],
        "cells": grids.cells,
        "corrector": { "grading": grids.correction.grading },
        "reference": { "element": elements.element.name(), "cells": elements.cells, "grading": elements.grading },
    }))
}

/// A description of a support.
pub fn support_words(support: &Support) -> String {
    match *support {
        Support::Displacement([Some(0.0), Some(0.0)]) => "clamped: ux = uy = 0".into(),
        Support::Displacement(displacement) => {
            let axis = |(name, given): (&str, Option<f64>)| match given {
                Some(value) => format!("{name} = {value} mm"),
                None => format!("{name} is free"),
            };
            let axes = ["ux", "uy"].into_iter().zip(displacement).map(axis);
            format!("displaced: {}", axes.collect::<Vec<_>>().join(", "))
        }
        Support::LinearDisplacement(field) => {
            let axis = |(name, given): (&str, Option<Linear>)| match given {
                Some(Linear {
                    at_origin,
                    slope: [x, y],
                }) => {
                    format!("{name} = {at_origin} mm + {x} X + {y} Y")
                }
                None => format!("{name} is free"),
            };
            let axes = ["ux", "uy"].into_iter().zip(field).map(axis);
            let axes = axes.collect::<Vec<_>>().join(", ");
            format!("displaced: {axes}, with the place X, Y at rest in mm")
        }
        Support::Radial {
            centre: [x, y],
            displacement,
        } => {
            format!("displaced by {displacement} mm away from ({x}, {y}) mm")
        }
        Support::Roller => {
            "slides along its straight line without friction, an axis of symmetry".into()
        }
        Support::Rotation {
            centre: [x, y],
            angle,
        } => format!(
            "rotated rigidly by {:.6}° about ({x}, {y}) mm",
            angle.to_degrees()
        ),
        Support::Grip(drives) => {
            let axis = |(name, drive)| match drive {
                Drive::Displacement(value) => format!("displaced along {name} by {value} mm"),
                Drive::Force(0.0) => format!("free to move along {name}"),
                Drive::Force(value) => format!("pulled along {name} by {value} N"),
            };
            let axes = ["x", "y"].into_iter().zip(drives).map(axis);
            let axes = axes.collect::<Vec<_>>().join(", ");
            format!("in a rigid grip that does not turn: {axes}")
        }
    }
}

/// A description of a load.
pub fn load_words(load: &Load) -> String {
    match *load {
        Load::Traction([x, y]) => {
            format!("a traction of ({x}, {y}) MPa on the area at rest, of constant direction")
        }
        Load::Pressure(pressure) => format!(
            "a pressure of {pressure} MPa that stays normal to the deformed edges, on the thickness at rest"
        ),
        Load::Force([x, y]) => {
            format!("a force of ({x}, {y}) N, spread evenly over the group, of constant direction")
        }
    }
}
