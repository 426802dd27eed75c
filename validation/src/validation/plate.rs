//! What the cases of the plate share: one stretch of a clamped plate, its lattice and its reference.

use std::path::Path;

use super::case::failed;
use crate::corrector::plate::{CorrectedState, KnownConditions};
use crate::corrector::{CorrectorSettings, DifferenceScheme, PlateCorrector, Solver};
use crate::document::{Bound, Section};
use crate::error::{Error, SolveFault};
use crate::finite_element::{Element, FiniteElements};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::problem::ClampedPlate;
use crate::solve::NewtonSettings;
use crate::solve::State;
use crate::studies::card::read_card;
use crate::studies::sections;
use crate::units::Dimension;

/// The plate of a case, read from its `[plate]` section.
#[derive(Clone, Debug)]
pub struct Plate {
    /// The problem with one stretch.
    pub problem: ClampedPlate,
    /// Cells of the lattice.
    pub cells: [usize; 2],
}

/// How every model of a case is solved.
pub const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// How every correction of a case is computed.
pub const CORRECTOR: CorrectorSettings = CorrectorSettings {
    tolerance: 1e-10,
    movement: 1e-9,
    max_steps: 60,
    solver: Solver::Automatic,
};

/// The standard deviations of noise in mm that a case goes through; at least one.
pub fn read_noise(section: &Section) -> Vec<f64> {
    let noise = section.quantities("noise", Dimension::Length, Bound::Positive);
    if noise.is_empty() {
        section.fault("noise", "needs at least one value", "such as [\"0.5 mm\"]");
    }
    noise
}

impl Plate {
    /// Reads the section; a card given by a path is looked for relative to `folder`.
    pub fn read(root: &Section<'_>, folder: &Path) -> Self {
        let section = root.section("plate");
        let card = read_card(&section, folder);
        let (problem, cells) = sections::read_plate(&section, card.as_ref());
        let stretch = section.stretch("stretch", sections::STRETCHES);
        if let Some(card) = card.filter(|_| stretch > 0.0) {
            sections::check_range(&section, "stretch", &[stretch], &card);
        }
        section.unknown_keys();
        let stretches = vec![stretch];
        Self {
            problem: ClampedPlate {
                stretches,
                ..problem
            },
            cells,
        }
    }

    /// The stretch.
    pub fn stretch(&self) -> f64 {
        self.problem.stretches[0]
    }

    /// The regular lattice.
    pub fn lattice(&self) -> MassSpring {
        MassSpring::new(
            &self.problem,
            self.cells,
            LatticeSettings { area_term: false },
        )
    }

    /// A lattice in equilibrium.
    pub fn solve(&self, lattice: &MassSpring) -> Result<State, Error> {
        Ok(lattice.solve(&self.problem, NEWTON, &|_| ())?.remove(0))
    }

    /// Finite elements in equilibrium.
    pub fn finite_elements(
        &self,
        cells: [usize; 2],
        element: Element,
    ) -> Result<(FiniteElements, State), Error> {
        let model = FiniteElements::new(&self.problem, cells, element);
        let solution = model.solve(&self.problem, NEWTON, &|_| ())?.remove(0);
        Ok((model, solution))
    }

    /// The converged field at the nodes of the lattice: Q2 elements on twice as many cells.
    pub fn reference(&self, lattice: &MassSpring) -> Result<Vec<f64>, Error> {
        let (model, solution) = self.finite_elements(self.cells.map(|n| 2 * n), Element::Q2)?;
        Ok(model
            .mesh
            .displacement_on(&solution.displacement, &lattice.mesh))
    }

    /// The corrector on the nodes of a lattice.
    pub fn corrector<'a>(&'a self, lattice: &'a MassSpring) -> PlateCorrector<'a> {
        PlateCorrector::new(
            &self.problem,
            &lattice.mesh,
            DifferenceScheme::Gauss,
            CORRECTOR,
        )
    }

    /// The fully corrected field.
    pub fn corrected(&self, lattice: &MassSpring, data: &[f64]) -> Result<CorrectedState, Error> {
        let corrector = self.corrector(lattice);
        corrector.correct(data, self.stretch(), KnownConditions::ALL)
    }

    /// A failed correction as an error.
    pub fn fault(&self, fault: SolveFault) -> Error {
        failed("corrector", &ClampedPlate::describe_step(self.stretch()))(fault)
    }
}
