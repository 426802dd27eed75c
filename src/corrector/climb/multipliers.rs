//! The Lagrange multipliers of a climbed field.

use super::{Climb, Field, Inverted, inverted};
use crate::error::SolveFault;

/// The multipliers' iteration ends at this share of its first correction.
const TOLERANCE: f64 = 1e-7;

impl Climb<'_> {
    /// ψ of the correction of ū to u, as a field of the nodes:
    ///
    /// ```text
    /// Bᵀ ψ = ū − u,   B = [K; 1 at the grips]
    /// free nodes   K ψ = ū − u                              [mm²/N]
    /// grips        ψ = (ū − u) − K ψ                           [mm]
    /// ```
    ///
    /// # Errors
    /// A [`SolveFault`] when the corrected field is not admissible or the iteration stalls.
    pub fn multipliers(&mut self, data: &Field, corrected: &Field) -> Result<Field, SolveFault> {
        let finest = self.levels.len() - 1;
        self.linearise_below(finest, corrected)?;
        let sheet = self.sheet();
        let mut difference = data.clone();
        difference.add(-1.0, corrected);
        let level = &mut self.levels[finest];
        let solved = level.solve_linear(
            sheet,
            corrected,
            &difference,
            &mut self.multigrid,
            TOLERANCE,
        );
        let solved = solved.map_err(|Inverted| inverted())?;
        solved
            .map(|(multipliers, _)| multipliers)
            .ok_or(SolveFault::NotPositiveDefinite)
    }
}
