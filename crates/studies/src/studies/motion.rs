//! A plate in motion: springs with dashpots, corrected in time, compared with finite elements, from one study.

use std::path::Path;

use crate::budget::Budget;
use crate::document::Section;
use crate::dynamics::{Dashpots, SheetViscosity, TimeSettings, Viscosity};
use crate::error::Error;
use crate::finite_element::FiniteElements;
use crate::mass_spring::{DashpotLaw, MassSpring};
use crate::material::softened_law::check_memory;
use crate::results::Outcome;
use crate::results::models::{FINITE_ELEMENTS, MASS_SPRING};
use crate::studies::{Computation, Kind, Loaded, Progress, SOUND};
use crate::units::number;

mod between;
mod corrected;
mod deviations;
mod files;
mod functions;
mod headline;
mod outcome;
mod plates;
mod problem;
mod read;
mod solution;
mod statement;
mod timing;
mod warnings;

use deviations::OwnError;
pub use problem::MovingPlate;
use solution::ModelMotion;

/// The `kind` of these studies.
pub const KIND: &str = "motion";

/// A motion's study: its title, the moving plate, and warnings.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<Loaded<MovingPlate>, Error> {
    case.load(file, text, budget, read::read)
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let plate = read::read(root, folder);
    Box::new(move |progress| compute(&plate.expect(SOUND), progress))
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
    let dashpots = damped.then_some(&dashpots as &dyn Viscosity);
    let model = springs.model(&plate.problem);
    let told = |time: f64| progress.tell(&plate.at(MASS_SPRING.name, time));
    let springs_moved = plate.moved(MASS_SPRING, &model, dashpots, plate.time, &told)?;
    let (_, cells) = plate.element;
    let elements_moved = plate.elements_moved(cells, plate.time, progress, FINITE_ELEMENTS.name)?;
    let own_error = OwnError::of(plate, &elements_moved, progress);
    let corrected = plate.correct(&springs_moved, progress)?;
    let models = [springs_moved, elements_moved];
    Ok(outcome::outcome(
        plate,
        &models,
        own_error.as_ref(),
        &corrected,
    ))
}

impl MovingPlate {
    /// The motion of finite elements of the study's kind with so many cells; `what` is what progress calls it.
    fn elements_moved(
        &self,
        cells: [usize; 2],
        time: TimeSettings,
        progress: Progress,
        what: &str,
    ) -> Result<ModelMotion, Error> {
        let elements = FiniteElements::new(&self.problem, cells, self.element.0);
        let sheet = SheetViscosity::new(elements.energy(), &self.viscosity);
        let sheet = (!self.viscosity.is_none()).then_some(&sheet as &dyn Viscosity);
        let model = elements.model(&self.problem);
        let told = |now: f64| progress.tell(&self.at(what, now));
        self.moved(FINITE_ELEMENTS, &model, sheet, time, &told)
    }

    /// The progress of a computation.
    fn at(&self, what: &str, time: f64) -> String {
        format!(
            "{what}, {} of {} s",
            number(time),
            number(self.time.duration)
        )
    }
}
