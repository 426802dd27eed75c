//! The Lagrange multipliers of a climbed field.

use super::{Climb, ClimbSolution, Field, at_stretch};
use crate::error::{Error, SolveFault};

/// The multipliers' iteration ends at this share of its first correction.
const TOLERANCE: f64 = 1e-7;

impl Climb<'_> {
    /// ψ of the correction of ū to u, as a field at the nodes:
    ///
    /// ```text
    /// Bᵀ ψ = ū − u,   B = [K; 1 at the grips]
    /// free nodes   K ψ = ū − u                              [mm²/N]
    /// grips        ψ = (ū − u) − K ψ                           [mm]
    /// ```
    ///
    /// ux, uy of node after node both in `data` and in the result.
    ///
    /// # Errors
    /// [`Error::Solve`] when the equation cannot be solved at the corrected field.
    pub fn multipliers(
        &mut self,
        data: &[f64],
        climbed: &ClimbSolution,
        stretch: f64,
    ) -> Result<Vec<f64>, Error> {
        let multipliers = self.solve_multipliers(data, &climbed.field);
        let multipliers = multipliers.map(|field| field.to_nodes());
        multipliers.map_err(at_stretch("multipliers", stretch))
    }

    /// Solves for the multipliers by the iteration, or by a sparse factor where the iteration does not converge.
    fn solve_multipliers(&mut self, data: &[f64], corrected: &Field) -> Result<Field, SolveFault> {
        let mut difference = Field::of_nodes(self.grid(), data);
        difference.add(-1.0, corrected);
        match self.iterate_multipliers(&difference, corrected) {
            Some(multipliers) => Ok(multipliers),
            None => self.solve_by_factor(corrected, &difference),
        }
    }

    fn iterate_multipliers(&mut self, difference: &Field, corrected: &Field) -> Option<Field> {
        let finest = self.levels.len() - 1;
        self.linearise_below(finest, corrected).ok()?;
        let sheet = self.sheet();
        let (level, multigrid) = (&mut self.levels[finest], &mut self.multigrid);
        level.solve_linear(sheet, corrected, difference, multigrid, TOLERANCE)
    }
}
