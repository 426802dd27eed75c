//! The plate of a motion's study.

use std::sync::Arc;

use crate::corrector::{CorrectorSettings, DifferenceScheme};
use crate::document::Section;
use crate::finite_element::Element;
use crate::mass_spring::LatticeSettings;
use crate::material::Card;
use crate::problem::ClampedPlate;
use crate::studies::sections;
use crate::studies::specimen::{GridCorrection, GridElements, Outline, PlateGrids, Specimen};

/// A plate between two grips, on grids of lines.
pub fn read_plate(
    root: &Section,
    card: Option<&Card>,
    lattice: LatticeSettings,
) -> Option<Specimen> {
    let plate = root
        .section("plate")
        .requiring(&["length", "width", "thickness"]);
    let (problem, cells) = sections::read_plate(&plate, card);
    plate.unknown_keys();
    let (element, of_elements) = read_element(&root.section("finite_element"))?;
    let card = card?.clone();
    let problem = ClampedPlate {
        law: Arc::clone(&card.law),
        ..problem
    };
    if problem.size.iter().any(|side| !side.is_finite()) {
        return None; // A missing measure was reported when it was read.
    }
    // Differences of second order where the numbers of cells allow them.
    let pairs = DifferenceScheme::Biquadratic.side();
    let scheme = if cells.iter().all(|count| count.is_multiple_of(pairs)) {
        DifferenceScheme::Biquadratic
    } else {
        DifferenceScheme::Gauss
    };
    let grids = PlateGrids {
        size: problem.size,
        cells,
        lattice,
        correction: GridCorrection {
            scheme,
            grading: 1.0,
            climb: None,
            direct: CorrectorSettings::default(),
        },
        elements: GridElements {
            element,
            cells: of_elements,
            grading: 1.0,
        },
    };
    let outline = Outline::Grid(grids);
    Some(Specimen::of(
        "plate",
        card,
        problem.boundary_problem(),
        outline,
        "right",
    ))
}

/// The finite element, and how many.
fn read_element(section: &Section) -> Option<(Element, [usize; 2])> {
    let element = section.choice("element", &Element::NAMES);
    let cells = section.count_pair("cells", 1, sections::MOST_CELLS);
    section.unknown_keys();
    element.zip(cells)
}
