//! A sheet of any shape in motion: springs with dashpots, corrected in time, compared with finite elements, from one study.

use std::path::Path;

use crate::budget::Budget;
use crate::document::Section;
use crate::dynamics::{Dashpots, SheetViscosity, TimeSettings, Viscosity};
use crate::error::Error;
use crate::mass_spring::DashpotLaw;
use crate::material::softened_law::check_memory;
use crate::mesh::Mesh;
use crate::results::Outcome;
use crate::results::models::{FINITE_ELEMENTS, MASS_SPRING};
use crate::studies::{
    Computation, Kind, Loaded, ModelKind, PreparedStudy, Progress, SOUND, file_stem,
};
use crate::units::number;

mod between;
mod corrected;
mod deviations;
mod files;
mod functions;
mod headline;
mod outcome;
mod problem;
mod read;
mod solution;
mod statement;
mod timing;

use deviations::DiscretisationError;
pub use problem::MovingSheet;
use solution::{ModelMotion, Motions};

/// The `kind` of these studies.
pub const KIND: &str = "motion";

/// A motion's study: its title, the moving sheet, and warnings.
///
/// # Errors
/// [`Error::Input`] with every fault.
pub fn load(
    case: &Kind,
    file: &Path,
    text: &str,
    budget: Budget,
) -> Result<Loaded<MovingSheet>, Error> {
    case.load(file, text, budget, read::read)
}

/// A motion that was read, ready to be computed.
pub fn ready(kind: &Kind, name: String, text: &str, loaded: Loaded<MovingSheet>) -> PreparedStudy {
    let about = loaded.content.describe();
    let stem = file_stem(&name);
    let read = loaded.map(|mut sheet| -> Computation {
        sheet.specimen.name = stem;
        Box::new(move |progress| compute(&sheet, progress))
    });
    PreparedStudy {
        about,
        ..PreparedStudy::new(kind, name, text, read)
    }
}

/// Reads a study of this kind.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let sheet = read::read(root, folder);
    Box::new(move |progress| compute(&sheet.expect(SOUND), progress))
}

/// Moves the sheet by springs and finite elements, and corrects the springs; its material may be that of
/// [`MovingSheet::with_card`].
///
/// # Errors
/// [`Error::Solve`] where a model has no solution.
pub fn compute(sheet: &MovingSheet, progress: Progress) -> Result<Outcome, Error> {
    check_memory(&*sheet.specimen.problem.law, "a motion in time")?;
    let springs = sheet.springs_moved(progress)?;
    let mesh = sheet.elements_mesh(0).expect("the mesh of the study");
    let elements = sheet.elements_moved(&mesh, sheet.time, progress, FINITE_ELEMENTS.name)?;
    let own_error = DiscretisationError::of(sheet, &elements, progress);
    let correction = sheet.correct(&springs, progress)?;
    let motions = Motions::new(sheet, springs, elements, correction);
    Ok(outcome::outcome(sheet, &motions, own_error.as_ref()))
}

impl MovingSheet {
    /// The motion of the springs with their dashpots.
    fn springs_moved(&self, progress: Progress) -> Result<ModelMotion, Error> {
        let springs = self.lattice();
        let dashpots = Dashpots::new(&springs, &self.dashpots);
        let damped = match &self.dashpots {
            DashpotLaw::Material(material) => !material.is_none(),
            DashpotLaw::Viscosity { .. } => true,
        };
        let dashpots = damped.then_some(&dashpots as &dyn Viscosity);
        let name = format!("mass-spring ({})", springs.mesh.describe());
        let model = self.specimen.on(&springs.mesh, springs.potential())?;
        let model = model.named(name);
        let model = model.describing(|element| springs.describe_element(element));
        let report = |now: f64| progress.tell(&self.at(MASS_SPRING.name, now));
        self.moved(ModelKind::MassSpring, &model, dashpots, self.time, &report)
    }

    /// The motion of the study's finite elements on a mesh; `what` is what progress calls it.
    fn elements_moved(
        &self,
        mesh: &Mesh,
        time: TimeSettings,
        progress: Progress,
        what: &str,
    ) -> Result<ModelMotion, Error> {
        let energy = self.specimen.problem.finite_elements(mesh);
        let sheet = SheetViscosity::new(&energy, &self.viscosity);
        let sheet = (!self.viscosity.is_none()).then_some(&sheet as &dyn Viscosity);
        let model = self.specimen.on(mesh, &energy)?;
        let model = model.named(format!("finite elements ({})", mesh.describe()));
        let report = |now: f64| progress.tell(&self.at(what, now));
        self.moved(ModelKind::FiniteElement, &model, sheet, time, &report)
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
