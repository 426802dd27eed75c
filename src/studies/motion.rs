//! A plate in motion: springs with dashpots, corrected in time, compared with finite elements, from one study.

use std::path::Path;

use crate::budget::Budget;
use crate::document::Section;
use crate::dynamics::{Dashpots, SheetViscosity, Viscosity};
use crate::error::{Diagnostic, Error};
use crate::finite_element::FiniteElements;
use crate::mass_spring::{DashpotLaw, MassSpring};
use crate::material::softened_law::check_memory;
use crate::results::Outcome;
use crate::studies::{Computation, Kind, Progress};

mod between;
mod corrected;
mod files;
mod functions;
mod outcome;
mod plates;
mod problem;
mod read;
mod solution;
mod statement;
mod timing;

pub use problem::MovingPlate;

/// The `kind` of these studies.
pub const KIND: &str = "motion";

/// A motion's study: its title, the plate that moves, and what deserves attention.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<(String, MovingPlate, Vec<Diagnostic>), Error> {
    case.load(file, text, budget, read::read)
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let plate = read::read(root, folder);
    Box::new(move |progress| {
        plate.map_or(Ok(Outcome::default()), |plate| compute(&plate, progress))
    })
}

/// Moves the plate by springs and finite elements, and corrects the springs; its material may be that of
/// [`MovingPlate::with_card`].
///
/// # Errors
/// [`Error::Solve`] where a model has no solution.
pub fn compute(plate: &MovingPlate, progress: Progress) -> Result<Outcome, Error> {
    check_memory(&*plate.problem.law, "a motion in time")?;
    let springs = MassSpring::new(&plate.problem, plate.cells, plate.lattice)
        .with_spring_law(plate.springs.clone());
    let dashpots = Dashpots::new(&springs, &plate.dashpots);
    let damped = match &plate.dashpots {
        DashpotLaw::Material(material) => !material.is_none(),
        DashpotLaw::Viscosity { .. } => true,
    };
    progress.tell("mass-spring");
    let dashpots = damped.then_some(&dashpots as &dyn Viscosity);
    let model = springs.model(&plate.problem);
    let springs_moved = plate.moved(["mass-spring", "mass_spring"], &model, dashpots)?;
    progress.tell("finite elements");
    let (element, cells) = plate.element;
    let elements = FiniteElements::new(&plate.problem, cells, element);
    let sheet = SheetViscosity::new(elements.energy(), &plate.viscosity);
    let sheet = (!plate.viscosity.is_none()).then_some(&sheet as &dyn Viscosity);
    let model = elements.model(&plate.problem);
    let elements_moved = plate.moved(["finite elements", "finite_element"], &model, sheet)?;
    progress.tell("corrector");
    let corrected = plate.corrected(&springs_moved)?;
    Ok(outcome::outcome(
        plate,
        &[springs_moved, elements_moved],
        &corrected,
    ))
}
