//! The study file of a plate: a strip between two grips, with keys of its own.
//!
//! Every default stands in `plate/default.toml`, which is also what `gelbench new` writes.

use std::path::Path;

use crate::budget::Need;
use crate::corrector::{CorrectorSettings, DifferenceScheme};
use crate::document::{Bound, Section, name_of};
use crate::finite_element::Element;
use crate::mass_spring::LatticeSettings;
use crate::material::Card;
use crate::problem::ClampedPlate;
use crate::solve::LinearSolver;
use crate::studies::card::read_card;
use crate::studies::pictures::Pictures;
use crate::studies::sections::{
    MOST_CELLS, Tolerances, check_range, multiples_of_cells, need_of_cells, read_climb,
    read_models, read_newton, read_plate, refuse_memory,
};
use crate::studies::specimen::{
    Along, GridCorrection, GridElements, Outline, PlateGrids, Specimen, check_extensometer,
    read_measured_curve, read_measurements,
};
use crate::units::Dimension;

/// Stretches that a plate may be given, compressions included.
const WITH_COMPRESSIONS: Bound = Bound::Range(-0.95, 100.0, "from −95 % to 10000 %");
/// The smallest stretch that counts as one.
const SMALLEST: f64 = 1e-9;

/// Cells across a plate that automatic finite elements have at most for graded corrected fields.
const MOST_ACROSS: f64 = 160.0;

/// How much smaller cells may become towards the corners.
const GRADINGS: Bound = Bound::Within(1.0, 4.0);

/// Reads a study; `None` where it has faults, which are recorded.
pub fn read(root: &Section<'_>, folder: &Path) -> Option<Specimen> {
    let material = root.section("material");
    let card = read_card(&material, folder);
    material.unknown_keys();
    let plate = root.section("plate");
    let (problem, cells) = read_plate(&plate, card.as_ref());
    plate.unknown_keys();
    let stretches = read_stretches(&root.section("load"), card.as_ref(), cells);
    let problem = ClampedPlate {
        stretches,
        ..problem
    };
    let section = root.section("mass_spring");
    let lattice = LatticeSettings {
        area_term: section.flag("area_term"),
    };
    let springs_newton = read_newton(&section);
    section.unknown_keys();
    let correction = read_corrector(&root.section("corrector"), &plate, problem.size, cells);
    let is_graded = correction.is_some_and(|correction| correction.is_graded());
    let section = root.section("finite_element");
    let elements = read_elements(&section, &problem, cells, is_graded);
    let elements_newton = read_newton(&section);
    let linear_solver = section.choice("method", &LinearSolver::NAMES);
    section.unknown_keys();
    if problem.law.softening().is_some() {
        check_memory(root, lattice, correction);
    }
    let tolerances = Tolerances::read(&root.section("tolerances"), true);
    let section = root.section("pictures");
    let pictures = Pictures::read(&section, "factors", Dimension::Ratio, &problem.stretches);
    let models = read_models(root);
    let outline = outline(problem.size, cells, lattice, correction.zip(elements));
    let measurements = read_measurements(root, outline.as_ref());
    let measured_curve = read_measured_curve(root, folder, Some(problem.size[0]));
    let (card, outline) = (card?, outline?);
    warn_of_own_reference(root, &outline);
    let usual = Specimen::of("plate", card, problem.boundary_problem(), outline, "right");
    let specimen = Specimen {
        measurements,
        measured_curve,
        along: Along::Stretch,
        factors: problem.stretches,
        models,
        springs_newton,
        elements_newton,
        tolerances,
        linear_solver: linear_solver?,
        pictures,
        ..usual
    };
    check_extensometer(root, &specimen);
    Some(specimen)
}

/// The outline of a plate; `None` where a part of it could not be read.
fn outline(
    size: [f64; 2],
    cells: [usize; 2],
    lattice: LatticeSettings,
    grids: Option<(GridCorrection, GridElements)>,
) -> Option<Outline> {
    // What cannot be read is NaN.
    let (correction, elements) = grids.filter(|_| size.iter().all(|side| *side > 0.0))?;
    Some(Outline::Grid(PlateGrids {
        size,
        cells,
        lattice,
        correction,
        elements,
    }))
}

/// Warns of finite elements that solve the corrected field's own equations.
fn warn_of_own_reference(root: &Section, outline: &Outline) {
    let Outline::Grid(grids) = outline else {
        return;
    };
    if grids.is_own_reference() {
        root.section("finite_element").warning(
            "cells",
            "with these settings the finite elements solve the corrected field's own equations on the same nodes and cannot judge it",
            "leave out `cells` and `grading`, which then suit the lattice, or take finer ones",
        );
    }
}

/// Refuses options that cannot follow a material that softens.
fn check_memory(root: &Section, lattice: LatticeSettings, corrector: Option<GridCorrection>) {
    if lattice.area_term {
        let message = "the area term of the lattice does not soften with the card's material";
        let hint = "leave out `area_term`: the springs soften";
        root.section("mass_spring")
            .fault("area_term", message, hint);
    }
    if corrector.is_some_and(|corrector| corrector.climb.is_some()) {
        refuse_memory(&root.section("corrector"), "the climb");
    }
}

fn read_corrector(
    section: &Section<'_>,
    plate: &Section<'_>,
    size: [f64; 2],
    cells: [usize; 2],
) -> Option<GridCorrection> {
    let scheme = section.choice("scheme", &DifferenceScheme::NAMES);
    if let Some(scheme) = scheme {
        check_multiples(plate, scheme, size, cells);
    }
    let grading = section.number_or("automatic", "grading", GRADINGS);
    let climb = section.choice("method", &[("climb", true), ("direct", false)]);
    let settings = read_climb(section);
    let direct = CorrectorSettings {
        tolerance: section.number("tolerance", Bound::Within(1e-13, 1e-2)),
        max_steps: section.count("max_steps", 1, 1000),
        ..CorrectorSettings::default()
    };
    section.unknown_keys();
    Some(GridCorrection {
        scheme: scheme?,
        grading: grading.unwrap_or(scheme?.grading()),
        climb: climb?.then_some(settings),
        direct,
    })
}

fn read_elements(
    section: &Section<'_>,
    plate: &ClampedPlate,
    lattice: [usize; 2],
    is_graded: bool,
) -> Option<GridElements> {
    let element = section.choice("element", &Element::NAMES);
    let unknowns = match element {
        Some(Element::Q1) => 2.0,
        _ => 8.0,
    };
    let states = plate.stretches.len();
    let need = |cells| need_of_cells(cells, unknowns, states);
    let cells = read_reference_cells(section, || {
        let wanted = reference_cells(plate.size, lattice, is_graded);
        match section.excess(need(wanted)) {
            // Finite elements that cannot judge the field fully are better than none.
            Some(_) => reference_cells(plate.size, lattice, false),
            None => wanted,
        }
    });
    section.affords("cells", need(cells), "take fewer");
    Some(GridElements {
        grading: section.number("grading", GRADINGS),
        element: element?,
        cells,
    })
}

/// The cells that a study gives, or those that suit its lattice.
fn read_reference_cells(section: &Section<'_>, automatic: impl Fn() -> [usize; 2]) -> [usize; 2] {
    const KEY: &str = "cells";
    let given = section.count_pair_or("automatic", KEY, [4, MOST_CELLS]);
    let Some(cells) = given.flatten() else {
        return automatic();
    };
    if cells.iter().any(|cells| cells % 4 != 0) {
        let [x, y] = cells.map(|cells| cells.next_multiple_of(4));
        section.fault(
            KEY,
            "must be multiples of 4: the error is estimated from meshes with half and a quarter as many cells",
            &format!("the next are [{x}, {y}]"),
        );
    }
    cells
}

/// The cells of biquadratic elements, graded by 2, that can judge a lattice. Their error falls with the third power of their
/// number n over the shorter side, that of a lattice with the 1.5th power of its own number m:
///
/// ```text
/// n = max(√(40 m), min(40, 2 √(20 m))),   n √(long/short) over the longer side
/// ```
///
/// so that it is 1/100 and less of the lattice's on plates of 1:1 to 20:1 with 4 to 80 cells across. Between the grips a
/// long plate is nearly in uniaxial tension: over the longer side the cells need not be square. On graded cells the corrected field's
/// error falls with the third power too: n = 2.4 m there, up to [`MOST_ACROSS`].
fn reference_cells(size: [f64; 2], lattice: [usize; 2], is_graded: bool) -> [usize; 2] {
    let short = if size[0] < size[1] { 0 } else { 1 };
    let m = lattice[short] as f64;
    let equal = (40.0 * m).sqrt().max(40.0_f64.min(2.0 * (20.0 * m).sqrt()));
    let n = if is_graded {
        equal.max(MOST_ACROSS.min(2.4 * m))
    } else {
        equal
    };
    let over = |axis: usize| (n * (size[axis] / size[short]).sqrt()).ceil() as usize;
    [0, 1].map(|axis| over(axis).next_multiple_of(4).min(MOST_CELLS))
}

/// The stretches of a plate: at least one, all of one sign, from small to large, as a path from rest takes them.
fn read_stretches(section: &Section<'_>, card: Option<&Card>, cells: [usize; 2]) -> Vec<f64> {
    const KEY: &str = "stretches";
    let stretches = section.stretches(KEY, WITH_COMPRESSIONS);
    section.unknown_keys();
    let unknowns = 2.0 * cells[0] as f64 * cells[1] as f64;
    let need = Need::of_states(unknowns, stretches.len() as f64);
    if !section.affords(KEY, need, "take fewer") {
        return stretches;
    }
    if stretches.is_empty() {
        let hint = "such as [\"15 %\", \"30 %\"]";
        section.fault(KEY, "needs at least one stretch", hint);
    }
    if stretches.iter().any(|stretch| stretch.is_nan()) {
        return stretches;
    }
    let remembers = card.is_some_and(|card| card.law.softening().is_some());
    if stretches.iter().any(|stretch| stretch.abs() < SMALLEST) {
        let hint = if remembers {
            "at rest there is nothing to solve; to unload, take a small one, such as \"0.1 %\""
        } else {
            "at rest there is nothing to solve; leave it out"
        };
        section.fault(KEY, "must not contain zero, or less than 1e-9", hint);
        return stretches;
    }
    let one_sign = stretches.iter().all(|stretch| stretch * stretches[0] > 0.0);
    let repeated = |pair: &[f64]| pair[1] == pair[0];
    if !one_sign {
        let hint = "every path begins at rest: write one study for the tension and one for the compression";
        section.fault(KEY, "must all have the same sign", hint);
    } else if remembers && stretches.windows(2).any(repeated) {
        let hint =
            "a material that softens may be unloaded and loaded again: leave out repetitions";
        section.fault(KEY, "must differ from one to the next", hint);
    } else if !remembers
        && stretches
            .windows(2)
            .any(|pair| pair[1].abs() <= pair[0].abs())
    {
        let hint = "sort them by size and leave out repetitions; only a card with `[softening]` depends on the loading history";
        section.fault(KEY, "must go from small to large", hint);
    }
    if let Some(card) = card {
        check_range(section, KEY, &stretches, card);
    }
    stretches
}

/// A scheme that takes cells together needs multiples of them, the bicubic one an even number of elements along X, so that nodes lie in
/// the middle of the plate, where its width is measured.
fn check_multiples(plate: &Section, scheme: DifferenceScheme, size: [f64; 2], cells: [usize; 2]) {
    let (multiples, wanted) = match scheme {
        DifferenceScheme::Gauss => return,
        DifferenceScheme::Biquadratic => ([2, 2], "even numbers of cells"),
        DifferenceScheme::Bicubic => (
            [6, 3],
            "a multiple of 6 cells along the length and of 3 along the width",
        ),
    };
    let unfit = (0..2).find(|axis| !cells[*axis].is_multiple_of(multiples[*axis]));
    if let Some(axis) = unfit {
        let name = name_of(&DifferenceScheme::NAMES, scheme);
        let [x, y] = multiples_of_cells(size, cells, multiples);
        let fault = match scheme {
            DifferenceScheme::Biquadratic => "odd",
            _ => "none",
        };
        plate.fault(
            "cells",
            &format!(
                "the scheme \"{name}\" needs {wanted}, and {} is {fault}",
                cells[axis]
            ),
            &format!("take [{x}, {y}], or scheme = \"gauss\" under [corrector]"),
        );
    }
}

#[cfg(test)]
mod tests;
