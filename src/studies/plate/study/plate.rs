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
use crate::problem::ClampedPlate;
use crate::units::Dimension;

/// Most cells of a mesh in one direction, and in all: more than this would not fit into common memories.
pub(super) const MOST_CELLS: usize = 2000;
const MOST_CELLS_IN_ALL: usize = 200_000;

/// Lengths that a plate may have, in mm: from a micrometre to a kilometre.
const LENGTHS: Bound = Bound::Range(1e-3, 1e6, "greater than zero, from 1 µm to 1 km");
/// Stretches that a plate may be given.
const STRETCHES: Bound = Bound::Range(1e-9, 100.0, "greater than zero, up to 10000 %");
/// The same with compressions, and the smallest that is none.
const WITH_COMPRESSIONS: Bound = Bound::Range(-0.95, 100.0, "from −95 % to 10000 %");
const SMALLEST: f64 = 1e-9;

/// The card under `card` of a section, looked for relative to `folder`; nothing when it is no card to work
/// with, which is recorded as a fault.
pub fn read_card(section: &Section<'_>, folder: &Path) -> Option<Card> {
    const KEY: &str = "card";
    let name = section.text(KEY);
    if name.is_empty() && !section.has(KEY) {
        return None; // told already
    }
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
pub fn read_plate(section: &Section<'_>, card: Option<&Card>) -> (ClampedPlate, [usize; 2]) {
    let length = |key| section.quantity(key, Dimension::Length, LENGTHS);
    let size = [length("length"), length("width")];
    let thickness = length("thickness");
    let cells = section.count_pair("cells", 2, MOST_CELLS);
    let cells = cells.filter(|cells| check_cells(section, *cells));
    if let Some(cells) = cells {
        check_aspect(section, size, cells);
    }
    let law: Arc<dyn HyperelasticLaw> = match card {
        Some(card) => Arc::clone(&card.law),
        None => Arc::new(NeoHooke { c10: 1.0 }),
    };
    let problem = ClampedPlate {
        size,
        thickness,
        law,
        stretches: Vec::new(),
    };
    (problem, cells.unwrap_or([2, 2]))
}

/// Records the fault of a mesh with too many cells in all; whether it has not.
pub(super) fn check_cells(section: &Section<'_>, cells: [usize; 2]) -> bool {
    let all = cells[0] * cells[1];
    if all > MOST_CELLS_IN_ALL {
        let hint = format!("take at most {MOST_CELLS_IN_ALL}");
        section.fault("cells", &format!("{all} cells are too many"), &hint);
    }
    all <= MOST_CELLS_IN_ALL
}

/// The cells of biquadratic elements, graded by 2, that can judge a lattice. Their error falls with the third power of their
/// number n over the shorter side, that of a lattice with the 1.5th power of its own number m:
///
/// ```text
/// n = max(√(40 m), min(40, 2 √(20 m))),   n √(long/short) over the longer side
/// ```
///
/// so that it is 1/100 and less of the lattice's on plates of 1:1 to 20:1 with 4 to 80 cells across. Between the grips a
/// long plate is nearly in uniaxial tension: over the longer side the cells need not be square.
pub(super) fn reference_cells(size: [f64; 2], lattice: [usize; 2]) -> [usize; 2] {
    let short = if size[0] < size[1] { 0 } else { 1 };
    let m = lattice[short] as f64;
    let n = (40.0 * m).sqrt().max(40.0_f64.min(2.0 * (20.0 * m).sqrt()));
    let over = |axis: usize| (n * (size[axis] / size[short]).sqrt()).ceil() as usize;
    [0, 1].map(|axis| over(axis).next_multiple_of(4).min(MOST_CELLS))
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

/// The stretches of a plate: at least one, all of one sign, from small to large, as a path from rest takes them.
pub(super) fn read_stretches(section: &Section<'_>, card: Option<&Card>) -> Vec<f64> {
    const KEY: &str = "stretches";
    let stretches = section.quantities(KEY, Dimension::Ratio, WITH_COMPRESSIONS);
    section.unknown_keys();
    if stretches.is_empty() {
        let hint = "such as [\"15 %\", \"30 %\"]";
        section.fault(KEY, "needs at least one stretch", hint);
    }
    if stretches.iter().any(|stretch| stretch.is_nan()) {
        return stretches;
    }
    if stretches.iter().any(|stretch| stretch.abs() < SMALLEST) {
        let hint = "at rest there is nothing to solve; leave it out";
        section.fault(KEY, "must not hold zero", hint);
        return stretches;
    }
    let one_sign = stretches.iter().all(|stretch| stretch * stretches[0] > 0.0);
    if !one_sign {
        let hint = "every path begins at rest: write one study for the tension and one for the compression";
        section.fault(KEY, "must have one sign", hint);
    } else if stretches
        .windows(2)
        .any(|pair| pair[1].abs() <= pair[0].abs())
    {
        let hint = "sort them by their size and leave out repetitions";
        section.fault(KEY, "must go from small to large", hint);
    }
    for (stretch, card) in stretches.iter().zip(card.into_iter().cycle()) {
        check_range(section, KEY, *stretch, card);
    }
    stretches
}

/// Warns of a stretch outside the range of the card, or beyond the stability of its law.
pub fn check_range(section: &Section<'_>, key: &'static str, stretch: f64, card: &Card) {
    let [low, high] = stable_range(&*card.law, Mode::Uniaxial);
    let end = if stretch > 0.0 {
        (1.0 + stretch > high && high < SEARCHED[1]).then_some(("tension", "up", high))
    } else {
        (1.0 + stretch < low && low > SEARCHED[0]).then_some(("compression", "down", low))
    };
    if let Some((test, way, end)) = end {
        section.warning(
            key,
            &format!(
                "{} is beyond the stability of the card `{}`",
                ClampedPlate::describe_step(stretch),
                card.name
            ),
            &format!(
                "in uniaxial {test} it is stable {way} to {:.0} % stretch",
                100.0 * (end - 1.0)
            ),
        );
    }
    if !card.covers(1.0 + stretch) {
        let [low, high] = card.stretch_range.map(|lambda| 100.0 * (lambda - 1.0));
        let step = ClampedPlate::describe_step(stretch);
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
