//! The lattice at which the climb begins: few springs, corrected.

use std::sync::Arc;

use super::{Climb, Field, Grid, START_TOLERANCE, Work, at_stretch};
use crate::error::{Error, SolveFault};
use crate::mass_spring::{LatticeSettings, MassSpring};
use crate::problem::Problem;
use crate::solve::NewtonSettings;

/// The springs are a first guess.
const SPRINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-2,
    max_iterations: 60,
};

/// Load steps that are tried where the springs are too far away.
const LOAD_STEPS: [usize; 4] = [2, 4, 8, 16];

impl Climb<'_> {
    /// The corrected field on the lattice of springs, and what it took. Where the springs are too far from it,
    /// it is approached by load steps.
    pub(super) fn first_field(
        &mut self,
        stretch: f64,
    ) -> Result<(Field, Vec<(usize, Work)>), Error> {
        let springs = self.springs(stretch)?;
        let mut found = self.correct_start(springs);
        for steps in LOAD_STEPS {
            if found.is_ok() {
                break;
            }
            found = self.load_steps(stretch, steps)?;
        }
        let (field, work) = found.map_err(at_stretch(stretch))?;
        Ok((field, vec![(self.levels[self.start].grid.nodes(), work)]))
    }

    /// Corrects on the lattice of springs: two linearisations, because the springs are far away.
    fn correct_start(&mut self, mut field: Field) -> Result<(Field, Work), SolveFault> {
        let mut work = Work::default();
        for _ in 0..2 {
            self.linearise_below(self.start, &field)?;
            let enough = |first: f64, left: f64| left <= START_TOLERANCE * first;
            work.add(self.solve(self.start, &mut field, &enough)?.work);
        }
        Ok((field, work))
    }

    /// The same in equal load steps, each from the field before, scaled with the motion of the grip.
    pub(super) fn load_steps(
        &mut self,
        stretch: f64,
        steps: usize,
    ) -> Result<Result<(Field, Work), SolveFault>, Error> {
        let mut field = self.springs(stretch / steps as f64)?;
        let mut all = Work::default();
        for step in 1..=steps {
            match self.correct_start(field) {
                Ok((found, work)) => {
                    field = found;
                    all.add(work);
                }
                Err(fault) => return Ok(Err(fault)),
            }
            if step < steps {
                let ratio = (step + 1) as f64 / step as f64;
                for component in &mut field.components {
                    component.iter_mut().for_each(|u| *u *= ratio);
                }
            }
        }
        Ok(Ok((field, all)))
    }

    /// The springs in equilibrium, at the nodes of the grid at which the climb begins.
    fn springs(&self, stretch: f64) -> Result<Field, Error> {
        let grid = &self.levels[self.start].grid;
        let lines = grid.lines();
        let cells = [lines.count - 1, lines.nodes - 1];
        let problem = Problem {
            size: self.problem.size,
            thickness: self.problem.thickness,
            law: Arc::clone(&self.problem.law),
            stretches: vec![stretch],
        };
        let springs = MassSpring::new(&problem, cells, LatticeSettings { area_term: false });
        let solved = springs.solve(&problem, SPRINGS, &|_| ())?;
        let lattice = Grid::even(self.problem.size, cells);
        let field = Field::of_nodes(&lattice, &solved[0].displacement);
        Ok(field.onto(&lattice, grid))
    }
}
