//! The three models of a specimen.

use super::end::End;
use super::lattice::OnLattice;
use super::reference::Reference;
use crate::error::Error;
use crate::problem::Solution;
use crate::results::models::{CORRECTED, FINITE_ELEMENTS, MASS_SPRING, ModelStyle};
use crate::studies::Progress;
use crate::studies::specimen::problem::Specimen;

/// The three models of a specimen, each as far as its path goes.
pub struct Models {
    /// The finite elements.
    pub reference: Reference,
    /// Springs and corrected springs.
    pub on_lattice: OnLattice,
}

/// A model's solution with its names for people and for files.
pub struct NamedSolution<'a> {
    /// For people.
    pub name: &'static str,
    /// What its files begin with, and its key in reports for machines.
    pub file: &'static str,
    /// The solution.
    pub solution: &'a Solution,
}

impl Models {
    /// Solves them all, each as far as its path goes.
    ///
    /// # Errors
    /// [`Error::Input`] when a group of a mesh cannot be held or loaded as the study says.
    pub fn solve(
        specimen: &Specimen,
        ends: &mut Vec<End>,
        progress: Progress,
    ) -> Result<Self, Error> {
        progress.tell(FINITE_ELEMENTS.name);
        let reference = Reference::solve(specimen, ends, progress)?;
        let on_lattice = OnLattice::solve(specimen, ends, progress)?;
        Ok(Self {
            reference,
            on_lattice,
        })
    }

    /// Springs, corrected springs, finite elements.
    pub fn named(&self) -> [NamedSolution<'_>; 3] {
        let named = |style: ModelStyle, solution| NamedSolution {
            name: style.name,
            file: style.key,
            solution,
        };
        [
            named(MASS_SPRING, &self.on_lattice.uncorrected),
            named(CORRECTED, &self.on_lattice.corrected),
            named(FINITE_ELEMENTS, &self.reference.finest),
        ]
    }

    /// How many load factors at least one model has reached.
    pub fn reached(&self) -> usize {
        let reached = self.named().map(|model| model.solution.reached());
        reached.into_iter().max().unwrap_or(0)
    }
}
