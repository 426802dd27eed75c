//! The sheet whose governing equation the climb solves.

use super::forces::forces;
use super::grid::{Field, Grid};
use crate::corrector::DifferenceScheme;
use crate::corrector::sampling::{CUBIC, LINEAR, QUADRATIC};
use crate::error::SolveFault;
use crate::material::HyperelasticLaw;
use crate::material::sheet::COMPONENTS;
use crate::multigrid::Stencil;

/// Cells whose tangents are evaluated together.
const BLOCK: usize = 64;

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

    /// Assembles the operator of a grid at the displacements `u`: the stiffness of each cell from the tangent at its middle.
    pub fn linearise(self, grid: &Grid, u: &Field, stencil: &mut Stencil) -> Result<(), Inverted> {
        let Sheet { law, thickness, .. } = self;
        let admissible = stencil.assemble(|column, target| {
            let width = grid.span(0, column, column + 1);
            let line = |axis: usize, line: usize| &u.components[axis][line * u.width..][..u.width];
            let cells = u.width - 1;
            let mut gradients = [[0.0; BLOCK]; 4];
            let mut responses = [[0.0; BLOCK]; COMPONENTS];
            let mut admissible = true;
            for first in (0..cells).step_by(BLOCK) {
                let count = BLOCK.min(cells - first);
                for axis in [0, 1] {
                    let left = &line(axis, column)[first..=first + count];
                    let right = &line(axis, column + 1)[first..=first + count];
                    for cell in 0..count {
                        let height = grid.span(1, first + cell, first + cell + 1);
                        let (below, above) =
                            (left[cell] + right[cell], left[cell + 1] + right[cell + 1]);
                        let (before, after) =
                            (left[cell] + left[cell + 1], right[cell] + right[cell + 1]);
                        gradients[2 * axis][cell] = 0.5 * (after - before) / width;
                        gradients[2 * axis + 1][cell] = 0.5 * (above - below) / height;
                    }
                }
                let points = gradients.each_ref().map(|h| &h[..count]);
                let of_points = responses.each_mut().map(|values| &mut values[..count]);
                admissible &= law.responses(points, of_points, true);
                // A₁₁ A₂₁ A₃₁ A₄₁ A₂₂ A₃₂ A₄₂ A₃₃ A₄₃ A₄₄ over the components 11, 12, 21, 22.
                let [_, _, _, _, _, a0, a1, a2, a3, a4, a5, a6, a7, a8, a9] = &responses;
                for cell in 0..count {
                    let ratio = thickness * grid.span(1, first + cell, first + cell + 1) / width;
                    let inverse = thickness * thickness / ratio;
                    let quarter = 0.25 * thickness;
                    let position = first + cell + 1;
                    let values = [
                        ratio * a0[cell],
                        ratio * a2[cell],
                        ratio * a7[cell],
                        inverse * a4[cell],
                        inverse * a6[cell],
                        inverse * a9[cell],
                        quarter * a1[cell],
                        quarter * a3[cell],
                        quarter * a5[cell],
                        quarter * a8[cell],
                    ];
                    for (array, value) in target.0.iter_mut().zip(values) {
                        array[position] = value as f32;
                    }
                }
            }
            admissible
        });
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
