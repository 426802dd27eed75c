//! The plate of a study: its material, its size, its cells and its stretches.

use std::path::Path;
use std::sync::Arc;

use crate::document::{Bound, Section};
use crate::error::Error;
use crate::mass_spring::LARGEST_ASPECT;
use crate::material::curve::Mode;
use crate::material::parameters::OffsetTreatment;
use crate::material::stability::{SEARCHED, stable_range};
use crate::material::{Card, HyperelasticLaw, NeoHooke};
use crate::problem::Problem;
use crate::units::Dimension;

/// Most cells of a mesh in one direction, and in all: more than this would not fit into common memories.
const MOST_CELLS: usize = 2000;
const MOST_CELLS_IN_ALL: usize = 200_000;

/// Lengths that a plate may have, in mm: from a micrometre to a kilometre.
const LENGTHS: Bound = Bound::Range(1e-3, 1e6, "greater than zero, from 1 µm to 1 km");
/// Stretches that a plate may be given.
pub(super) const STRETCHES: Bound = Bound::Range(1e-9, 100.0, "greater than zero, up to 10000 %");

/// The card under `card` of a section, looked for relative to `folder`; nothing when it is no card to work
/// with, which is recorded as a fault.
pub fn read_card(section: &Section<'_>, folder: &Path) -> Option<Card> {
    const KEY: &str = "card";
    let name = section.text(KEY);
    match Card::load(&name, folder) {
        Ok(card) if card.offset == OffsetTreatment::Keep => {
            section.fault(
                KEY,
                "this card keeps a stress at rest and cannot drive a model",
                "set `offset = \"subtract\"` in the card",
            );
            None
        }
        Ok(card) if card.law.shear_modulus() <= 0.0 => {
            section.fault(
                KEY,
                &format!(
                    "this card's law is unstable from rest: its shear modulus is {:.4} MPa",
                    card.law.shear_modulus()
                ),
                "choose another law; see `gelbench materials show`",
            );
            None
        }
        Ok(card) => Some(card),
        Err(Error::Input(found)) => {
            for fault in found {
                match fault.place {
                    Some(_) => section.add(fault),
                    None => section.fault(KEY, &fault.message, fault.hint.as_deref().unwrap_or("")),
                }
            }
            None
        }
        Err(other) => {
            section.fault(KEY, &other.to_string(), "choose another card");
            None
        }
    }
}

/// The plate of a section without its stretches, and the cells of its lattice.
pub fn read_plate(section: &Section<'_>, card: Option<&Card>) -> (Problem, [usize; 2]) {
    let length = |key| section.quantity(key, Dimension::Length, LENGTHS);
    let size = [length("length"), length("width")];
    let thickness = length("thickness");
    let cells = read_cells(section, 2);
    if let Some(cells) = cells {
        check_aspect(section, size, cells);
    }
    let law: Arc<dyn HyperelasticLaw> = match card {
        Some(card) => Arc::clone(&card.law),
        None => Arc::new(NeoHooke { c10: 1.0 }),
    };
    let problem = Problem {
        size,
        thickness,
        law,
        stretches: Vec::new(),
    };
    (problem, cells.unwrap_or([2, 2]))
}

/// The cells of a mesh, not too many in all.
pub(super) fn read_cells(section: &Section<'_>, fewest: usize) -> Option<[usize; 2]> {
    let cells = section.count_pair("cells", fewest, MOST_CELLS)?;
    if cells[0] * cells[1] > MOST_CELLS_IN_ALL {
        section.fault(
            "cells",
            &format!("{} cells are too many", cells[0] * cells[1]),
            &format!("take at most {MOST_CELLS_IN_ALL}"),
        );
        return None;
    }
    Some(cells)
}

/// Springs cannot make a lattice of long cells isotropic.
fn check_aspect(section: &Section<'_>, size: [f64; 2], cells: [usize; 2]) {
    let sides = [0, 1].map(|axis| size[axis] / cells[axis] as f64);
    let aspect = (sides[0] / sides[1]).max(sides[1] / sides[0]);
    if aspect > LARGEST_ASPECT {
        let across = (size[1] * cells[0] as f64 / size[0]).round().max(2.0);
        let along = (size[0] * across / size[1]).round().max(2.0);
        section.fault(
            "cells",
            &format!("the sides of a cell have the ratio {aspect:.2}; springs need less than √3"),
            &format!("take [{along}, {across}]"),
        );
    }
}

/// Warns of a stretch outside the range of the card, or beyond the stability of its law.
pub fn check_range(section: &Section<'_>, key: &'static str, stretch: f64, card: &Card) {
    let stable = stable_range(&*card.law, Mode::Uniaxial)[1];
    if 1.0 + stretch > stable && stable < SEARCHED[1] {
        section.warning(
            key,
            &format!(
                "{} is beyond the stability of the card `{}`",
                Problem::describe_step(stretch),
                card.name
            ),
            &format!(
                "in uniaxial tension it is stable up to {:.0} % stretch",
                100.0 * (stable - 1.0)
            ),
        );
    }
    if !card.covers(1.0 + stretch) {
        let [low, high] = card.stretch_range.map(|lambda| 100.0 * (lambda - 1.0));
        let step = Problem::describe_step(stretch);
        section.warning(
            key,
            &format!("{step} is outside the range of the card `{}`", card.name),
            &format!("it was calibrated from {low:.0} to {high:.0} % stretch"),
        );
    }
}

/// One stretch, as a ratio or in percent.
pub fn read_stretch(section: &Section<'_>, key: &'static str) -> f64 {
    section.quantity(key, Dimension::Ratio, STRETCHES)
}
