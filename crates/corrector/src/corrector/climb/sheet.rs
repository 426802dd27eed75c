//! The sheet whose governing equation the climb solves.

use super::forces::forces;
use super::grid::{Field, Grid};
use crate::corrector::DifferenceScheme;
use crate::corrector::sampling::{CUBIC, LINEAR, QUADRATIC};
use crate::error::SolveFault;
use crate::material::HyperelasticLaw;

/// The sheet whose equation is solved.
#[derive(Clone, Copy, Debug)]
pub struct Sheet<'a> {
    /// The material.
    pub law: &'a dyn HyperelasticLaw,
    /// Thickness in mm.
    pub thickness: f64,
    /// Its difference scheme.
    pub scheme: DifferenceScheme,
}

impl Sheet<'_> {
    /// F(u) in N at all nodes of a grid.
    pub fn forces(self, grid: &Grid, u: &Field, target: &mut Field) -> Result<(), Inverted> {
        let Sheet { law, thickness, .. } = self;
        let admissible = match self.scheme {
            DifferenceScheme::Gauss => forces(law, thickness, grid, &LINEAR, u, target),
            DifferenceScheme::Biquadratic => forces(law, thickness, grid, &QUADRATIC, u, target),
            DifferenceScheme::Bicubic => forces(law, thickness, grid, &CUBIC, u, target),
        };
        admissible.then_some(()).ok_or(Inverted)
    }
}

/// A field turned a cell inside out: J is not positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inverted;

impl From<Inverted> for SolveFault {
    fn from(_: Inverted) -> Self {
        Self::Inverted {
            element: "a cell on the way; use the direct method or more cells".into(),
        }
    }
}
