//! The fields that everything is compared with.

use crate::compare::{departure_percent, displacement_percent};
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::error::Error;
use crate::mass_spring::MassSpring;
use crate::validation::plate::Plate;

/// The grips alone: fewer conditions than unknowns.
pub const GRIPS: KnownConditions = KnownConditions {
    grips: true,
    free_edges: false,
};

/// A plate's fields at the nodes of its lattice.
pub struct Fields<'a> {
    pub plate: &'a Plate,
    pub lattice: MassSpring,
    pub uncorrected: Vec<f64>,
    pub reference: Vec<f64>,
    pub affine: Vec<f64>,
    /// With everything known.
    pub corrected: CorrectedState,
}

impl<'a> Fields<'a> {
    pub fn new(plate: &'a Plate) -> Result<Self, Error> {
        let lattice = plate.lattice();
        let uncorrected = plate.solve(&lattice)?.displacement;
        Ok(Self {
            plate,
            reference: plate.reference(&lattice)?,
            affine: plate.problem.affine(&lattice.mesh, plate.stretch()),
            corrected: plate.corrected(&lattice, &uncorrected)?,
            uncorrected,
            lattice,
        })
    }

    /// Corrects data with some known conditions.
    pub fn correct(&self, data: &[f64], known: KnownConditions) -> Result<CorrectedState, Error> {
        let corrector = self.plate.corrector(&self.lattice);
        corrector.correct(data, self.plate.stretch(), known)
    }

    /// Departure from affine in relative L2, in %.
    pub fn departure(&self, field: &[f64]) -> f64 {
        departure_percent(&self.lattice.mesh, field, &self.reference, &self.affine)
    }

    /// Departure from affine of each iterate, the data first, in %.
    pub fn departures(&self, corrected: &CorrectedState) -> Vec<f64> {
        let steps = corrected.steps.iter();
        steps.map(|step| self.departure(&step.field)).collect()
    }

    /// Displacement in relative L2, in %.
    pub fn displacement(&self, field: &[f64]) -> f64 {
        displacement_percent(&self.lattice.mesh, field, &self.reference)
    }

    /// Distance to the corrected field in relative L2.
    pub fn far(&self, field: &[f64]) -> f64 {
        let corrected = &self.corrected.state.displacement;
        displacement_percent(&self.lattice.mesh, field, corrected) / 100.0
    }
}
