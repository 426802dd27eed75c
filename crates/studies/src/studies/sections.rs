//! Sections that several kinds of study share: material, plate, Newton's method, tolerances.

use std::path::Path;
use std::sync::Arc;

use super::{ModelKind, other_files};
use crate::budget::{Budget, Need};
use crate::corrector::climb::ClimbSettings;
use crate::document::{self, Bound, Section, file};
use crate::error::Error;
use crate::mass_spring::LARGEST_ASPECT;
use crate::material::curve::Mode;
use crate::material::stability::{SEARCHED, stable_range};
use crate::material::{Card, HyperelasticLaw, NeoHooke, PlaneState};
use crate::problem::ClampedPlate;
use crate::solve::NewtonSettings;
use crate::units::{Dimension, implausible_sheet};

/// Cells of a plate in one direction at most; how many fit into the budget is asked besides.
pub const MOST_CELLS: usize = 100_000;

/// Stretches that a plate may be given.
pub const STRETCHES: Bound = Bound::Range(1e-9, 100.0, "greater than zero, up to 10000 %");

/// Records that a method without a memory is to correct a card which softens.
pub fn refuse_memory(corrector: &Section, method: &str) {
    let message = format!("this card softens, and {method} has no memory of the largest load");
    let hint = "write method = \"direct\", or leave out the card's `[softening]`";
    corrector.fault("method", &message, hint);
}

/// The settings of a climb.
pub fn read_climb(section: &Section) -> ClimbSettings {
    let bound = Bound::Within(1e-6, 1.0);
    ClimbSettings {
        tolerance: section.quantity("climb_tolerance", Dimension::Ratio, bound),
        ..ClimbSettings::default()
    }
}

/// The models that a study computes.
pub fn read_models(root: &Section) -> Vec<ModelKind> {
    let models = root.choices("models", &ModelKind::NAMES);
    if models.as_ref().is_some_and(Vec::is_empty) {
        let hint = "such as [\"finite-element\"], or leave the key out for all of them";
        root.fault("models", "needs at least one model", hint);
    }
    models.unwrap_or_default()
}

/// The text of a study file.
///
/// # Errors
/// [`Error::Input`] when the file cannot be read, or is a table, a mesh or a field.
pub fn read_text(path: &Path) -> Result<String, Error> {
    let hint = "`gelbench new NAME` writes a study to start from";
    let text = document::read_text(path, file::MOST_OF_A_STUDY, hint)?;
    other_files::refuse(path, &text)?;
    Ok(text)
}

/// The plate of a section without its stretches, and the cells of its lattice.
pub fn read_plate(section: &Section<'_>, card: Option<&Card>) -> (ClampedPlate, [usize; 2]) {
    let length = |key| section.quantity(key, Dimension::Length, Bound::SIZE);
    let size = [length("length"), length("width")];
    let thickness = length("thickness");
    let cells = section.count_pair("cells", 2, MOST_CELLS);
    let cells =
        cells.filter(|cells| section.affords("cells", need_of_cells(*cells, 2.0, 1), "take fewer"));
    if let Some(cells) = cells {
        check_aspect(section, size, cells);
    }
    check_thickness(section, thickness, size, card);
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

/// Warns of a thickness that is implausible for a thin sheet.
pub fn check_thickness(section: &Section<'_>, thickness: f64, size: [f64; 2], card: Option<&Card>) {
    let is_thin = card.is_none_or(|card| card.law.plane_state() == PlaneState::Stress);
    if let Some(message) = implausible_sheet(size, thickness).filter(|_| is_thin) {
        let hint = "check the units of all lengths (of a mesh `file_unit`); a body that cannot strain across its thickness is in plane strain";
        section.warning("thickness", &message, hint);
    }
}

/// The need of some states on a mesh of `cells` with a number of unknowns a cell.
pub fn need_of_cells(cells: [usize; 2], unknowns: f64, states: usize) -> Need {
    let all = cells[0] as f64 * cells[1] as f64;
    Need::of_states(unknowns * all, states as f64).on_cells(all)
}

/// Refuses long cells, of which springs cannot make an isotropic lattice.
fn check_aspect(section: &Section<'_>, size: [f64; 2], cells: [usize; 2]) {
    let aspect = aspect(size, cells);
    if aspect > LARGEST_ASPECT {
        let [along, across] = nearly_square_cells(size, cells[0], 2);
        section.fault(
            "cells",
            &format!("the sides of a cell have the ratio {aspect:.2}; springs need less than √3"),
            &format!("take [{along}, {across}]"),
        );
    }
}

/// The longer side of a cell over the shorter one.
fn aspect(size: [f64; 2], cells: [usize; 2]) -> f64 {
    let sides = [0, 1].map(|axis| size[axis] / cells[axis] as f64);
    (sides[0] / sides[1]).max(sides[1] / sides[0])
}

/// The multiples of two numbers next to some numbers of cells, of which springs can make a lattice.
pub fn multiples_of_cells(size: [f64; 2], cells: [usize; 2], multiples: [usize; 2]) -> [usize; 2] {
    let both = |axis: usize| {
        let (n, of) = (cells[axis], multiples[axis]);
        let most = MOST_CELLS - MOST_CELLS % of;
        [n.next_multiple_of(of).min(most), (n - n % of).max(of)]
    };
    let [[up_x, down_x], [up_y, down_y]] = [both(0), both(1)];
    let (up, down) = ([up_x, up_y], [down_x, down_y]);
    let nearest = [up, [up[0], down[1]], [down[0], up[1]], down];
    let mut usable = nearest.into_iter().filter(|cells| {
        aspect(size, *cells) < LARGEST_ASPECT && cells[0] * cells[1] <= Budget::USUAL.cells as usize
    });
    usable
        .next()
        .unwrap_or_else(|| nearly_square_cells(size, cells[0], multiples[0].max(multiples[1])))
}

/// Multiples of a number of nearly square cells, about as many along the plate as are wanted and no more than a study may have.
fn nearly_square_cells(size: [f64; 2], along: usize, of: usize) -> [usize; 2] {
    let next = |number: f64| {
        let count = (number / of as f64).round().max(1.0) as usize;
        of * count.min(MOST_CELLS / of)
    };
    let ratio = size[0] / size[1];
    let most = (0.95 * Budget::USUAL.cells * ratio).sqrt();
    let most = most.min(0.98 * MOST_CELLS as f64 * ratio.min(1.0));
    let across = next((along.max(of) as f64).min(most) / ratio);
    [next(ratio * across as f64), across]
}

/// Warns of stretches outside the range of the card, or beyond the stability of its law.
pub fn check_range(section: &Section<'_>, key: &'static str, stretches: &[f64], card: &Card) {
    let stable = stable_range(&*card.law, Mode::Uniaxial);
    for stretch in stretches {
        check_stretch(section, key, *stretch, card, stable);
    }
}

fn check_stretch(
    section: &Section<'_>,
    key: &'static str,
    stretch: f64,
    card: &Card,
    [low, high]: [f64; 2],
) {
    let end = if stretch > 0.0 {
        (1.0 + stretch > high && high < SEARCHED[1]).then_some(("tension", "up", high))
    } else {
        (1.0 + stretch < low && low > SEARCHED[0]).then_some(("compression", "down", low))
    };
    if let Some((test, direction, end)) = end {
        section.warning(
            key,
            &format!(
                "{} is beyond the stable range of the card `{}`",
                ClampedPlate::describe_step(stretch),
                card.name
            ),
            &format!(
                "in uniaxial {test} it is stable {direction} to {:.0} % stretch",
                100.0 * (end - 1.0)
            ),
        );
    }
    if !card.covers(1.0 + stretch) {
        // Without the sign of a zero.
        let percent = |lambda: f64| (100.0 * (lambda - 1.0)).round() + 0.0;
        let [low, high] = card.stretch_range.map(percent);
        let step = ClampedPlate::describe_step(stretch);
        section.warning(
            key,
            &format!("{step} is outside the range of the card `{}`", card.name),
            &format!("it was calibrated from {low:.0} to {high:.0} % stretch"),
        );
    }
}

/// How a model is solved.
pub fn read_newton(section: &Section<'_>) -> NewtonSettings {
    NewtonSettings {
        tolerance: section.number("tolerance", Bound::Within(1e-13, 1e-2)),
        max_iterations: section.count("max_iterations", 1, 1000),
    }
}

/// The requirements on the corrected field at every load factor, in percent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Largest deviation in displacement.
    pub displacement_percent: f64,
    /// Largest deviation in the departure from affine; `None` where the study compares with no affine field.
    pub departure_percent: Option<f64>,
    /// Largest deviation in force.
    pub force_percent: f64,
    /// Smallest correction of the departure from affine.
    pub correction_percent: f64,
}

impl Tolerances {
    /// Reads the section; `affine` where the study compares with the affine field too.
    pub fn read(section: &Section, affine: bool) -> Self {
        let percent = |key| 100.0 * section.quantity(key, Dimension::Ratio, Bound::Positive);
        let tolerances = Self {
            displacement_percent: percent("displacement"),
            departure_percent: affine.then(|| percent("departure")),
            force_percent: percent("force"),
            correction_percent: percent("correction"),
        };
        section.unknown_keys();
        tolerances
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn advise(size: [f64; 2], along: usize, of: usize) {
        let cells = nearly_square_cells(size, along, of);
        let case = format!("{size:?}, {along}, {of}: {cells:?}");
        assert!(aspect(size, cells) < LARGEST_ASPECT, "{case}");
        let fits = |n: &usize| n.is_multiple_of(of) && *n <= MOST_CELLS;
        assert!(cells.iter().all(fits), "{case}");
        let all = cells[0] * cells[1];
        assert!(all <= Budget::USUAL.cells as usize, "{case}");
    }

    #[test]
    fn advised_numbers_of_cells_are_accepted() {
        for length in [1.0, 3.0, 10.0, 37.0, 150.0, 700.0] {
            for width in [1.0, 2.5, 10.0, 50.0, 333.0] {
                for along in [2, 3, 7, 20, 61, 500, 2000] {
                    for of in [2, 6] {
                        advise([length, width], along, of);
                    }
                }
            }
        }
    }
}
