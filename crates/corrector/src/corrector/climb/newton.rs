//! Plain Newton on the finest grid alone, with the same multigrid: the method that the climb is compared with.

use super::{Climb, ClimbSolution, Field, Inverted, Start, Way, Work, inverted};
use crate::error::{Error, SolveFault};
use crate::problem::ClampedPlate;

/// Newton steps allowed.
const STEPS: usize = 30;
/// Halvings of a step that turns a cell inside out.
const HALVINGS: usize = 10;

impl Climb<'_> {
    /// Corrects at one stretch by Newton's method from the affine stretch, on the finest grid from the first step on,
    /// without springs and without a change from a coarser grid.
    ///
    /// ```text
    /// K(u) d = −F(u) at the free nodes,   u ← u + d,   until |d| ≤ tolerance |u − affine|
    /// ```
    ///
    /// Each linear system is solved by conjugate gradients with one V-cycle as preconditioner to a relative
    /// `linear_tolerance`.
    ///
    /// # Errors
    /// [`Error::Solve`] when no field was found.
    pub fn newton_from_affine(
        &mut self,
        stretch: f64,
        tolerance: f64,
        linear_tolerance: f64,
    ) -> Result<ClimbSolution, Error> {
        let found = self.newton(stretch, [tolerance, linear_tolerance]);
        found.map_err(|fault| Error::Solve {
            model: "corrector (Newton from the affine stretch)".into(),
            step: ClampedPlate::describe_step(stretch),
            fault,
        })
    }

    fn newton(
        &mut self,
        stretch: f64,
        [tolerance, linear_tolerance]: [f64; 2],
    ) -> Result<ClimbSolution, SolveFault> {
        let mut field = self.affine(stretch);
        let mut work = Work::default();
        let mut relative = f64::NAN;
        let mut corrections = Vec::new();
        for _ in 0..STEPS {
            let (step, own) = self.newton_step(&field, linear_tolerance)?;
            work.add(own);
            self.go(&mut field, &step, &mut work)?;
            let last = step.size();
            corrections.push(last);
            relative = last / self.departure(&field, stretch);
            if relative <= tolerance {
                let force = self.force(&field).map_err(|Inverted| inverted())?;
                work.evaluations += 1;
                return Ok(ClimbSolution {
                    field,
                    force,
                    change: None,
                    discretisation_error: f64::NAN,
                    error_is_sure: false,
                    iteration_error: last,
                    corrections,
                    work: vec![(self.grid().nodes(), work)],
                    way: Way::from_start(Start::AffineStretch, self.grid().cells()),
                });
            }
        }
        Err(SolveFault::Stalled {
            iterations: STEPS,
            residual: relative,
            tolerance,
        })
    }

    /// d with K d = −F; zero at the grips.
    fn newton_step(&mut self, field: &Field, tolerance: f64) -> Result<(Field, Work), SolveFault> {
        let finest = self.levels.len() - 1;
        self.linearise_below(finest, field)?;
        let mut right = self.forces(field).ok_or_else(inverted)?.clone();
        right.scale(-1.0);
        let sheet = self.sheet();
        let level = &mut self.levels[finest];
        let solved = level.solve_linear(sheet, field, &right, &mut self.multigrid, tolerance);
        let (mut step, mut work) = solved
            .map_err(|Inverted| inverted())?
            .ok_or(SolveFault::NotPositiveDefinite)?;
        let free = field.free();
        for component in &mut step.components {
            component[..free.start].fill(0.0);
            component[free.end..].fill(0.0);
        }
        work.linearisations += 1;
        work.evaluations += 1;
        Ok((step, work))
    }

    /// Goes along a step as far as no cell is turned inside out.
    fn go(&mut self, field: &mut Field, step: &Field, work: &mut Work) -> Result<(), SolveFault> {
        let mut length = 1.0;
        for _ in 0..HALVINGS {
            let mut there = field.clone();
            there.add(length, step);
            work.evaluations += 1;
            if self.forces(&there).is_some() {
                *field = there;
                return Ok(());
            }
            length *= 0.5;
        }
        Err(inverted())
    }

    /// The affine stretch: ux = stretch · X, uy = 0.
    fn affine(&self, stretch: f64) -> Field {
        let mut field = Field::zeros(self.grid());
        let width = field.width;
        let lines = field.components[0].chunks_exact_mut(width);
        for (line, x) in lines.zip(&self.grid().coordinates[0]) {
            line.fill(stretch * x);
        }
        field
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::corrector::DifferenceScheme;
    use crate::corrector::climb::ClimbSettings;
    use crate::material::Card;

    #[test]
    fn newton_and_the_climb_come_to_the_same_field() {
        let problem = ClampedPlate {
            size: [30.0, 10.0],
            thickness: 2.0,
            law: Card::load("pva-10", Path::new(".")).unwrap().law,
            stretches: vec![1.0],
        };
        let tight = ClimbSettings {
            tolerance: 1e-5,
            max_iterations: 60,
        };
        for scheme in [DifferenceScheme::Gauss, DifferenceScheme::Biquadratic] {
            let mut climb = Climb::even(&problem, [24, 8], scheme, tight);
            let climbed = climb.correct(1.0).unwrap();
            let newton = climb.newton_from_affine(1.0, 1e-5, 1e-4).unwrap();
            let mut difference = newton.field.clone();
            difference.add(-1.0, &climbed.field);
            let relative = difference.size() / climb.departure(&climbed.field, 1.0);
            assert!(relative < 1e-6, "{scheme:?}: {relative:e}");
            assert!(
                (newton.force / climbed.force - 1.0).abs() < 1e-6,
                "{scheme:?}"
            );
        }
    }
}
