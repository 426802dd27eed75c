//! One grid alone, slow and robust: Newton's method with a sparse factor along a path of load steps.
//!
//! The equation is exactly that of [`forces`](super::forces): the same energy, sampled at the same points. In
//! contrast to the climb's iteration there are a line search by the energy that keeps J > 0 everywhere, tangents that
//! are shifted where they are not positive definite, load steps that are halved where they fail, and a diagnosis of
//! why a path ends.

use super::Climb;
use super::grid::{Field, Grid};
use super::start::contracted_stretch;
use crate::error::{Error, SolveFault};
use crate::problem::ClampedPlate;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::{
    Assembly, Attendance, LinearSolver, Loading, NewtonSettings, PathEnd, Potential, Stage, State,
    Tangent, compliance, follow,
};

/// The remaining residual of Newton's method, relative to the largest reaction.
const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-9,
    max_iterations: 60,
};

/// An equilibrium on one grid.
pub(super) struct Equilibrium {
    /// The number of its grid among those of the climb.
    pub index: usize,
    /// The displacements in mm.
    pub field: Field,
    /// The remaining error of Newton's method in mm: its relative residual as a share of the displacements.
    pub left: f64,
}

/// A grid's plate between its grips; the load factor is the share of the stretch, so that the sign of the stretch does not matter.
struct GridLoading<'a> {
    problem: &'a ClampedPlate,
    grid: &'a Grid,
    energy: &'a SheetEnergy,
    stretch: f64,
}

impl GridLoading<'_> {
    fn on_left(&self, node: usize) -> bool {
        node < self.grid.lines().nodes
    }

    fn on_right(&self, node: usize) -> bool {
        node >= self.grid.nodes() - self.grid.lines().nodes
    }

    fn place(&self, node: usize) -> [f64; 2] {
        let nodes = self.grid.lines().nodes;
        let [x, y] = &self.grid.coordinates;
        [x[node / nodes], y[node % nodes]]
    }
}

impl Loading for GridLoading<'_> {
    fn held(&self) -> Vec<bool> {
        let unknowns = 0..2 * self.grid.nodes();
        unknowns
            .map(|unknown| self.on_left(unknown / 2) || self.on_right(unknown / 2))
            .collect()
    }

    fn impose(&self, factor: f64, displacement: &mut [f64]) {
        for (node, u) in displacement.chunks_exact_mut(2).enumerate() {
            if self.on_left(node) {
                u.fill(0.0);
            } else if self.on_right(node) {
                u.copy_from_slice(&[factor * self.stretch * self.problem.size[0], 0.0]);
            }
        }
    }

    fn potential<'a>(&'a self, _: f64, _: &'a [f64]) -> Box<dyn Potential + 'a> {
        Box::new(self.energy)
    }

    /// The state before, scaled with the grip's motion, or the contracted stretch.
    fn guess(&self, factor: f64, previous: Option<&State>) -> Option<Vec<f64>> {
        // The state at rest cannot be scaled.
        Some(match previous.filter(|own| own.factor != 0.0) {
            Some(previous) => {
                let ratio = factor / previous.factor;
                previous.displacement.iter().map(|u| ratio * u).collect()
            }
            None => {
                let field = contracted_stretch(self.problem.size, self.grid, factor * self.stretch);
                field.to_nodes()
            }
        })
    }

    fn describe(&self, element: usize) -> String {
        let unknowns = self.energy.element_unknowns(element);
        let [[x, y], [to_x, to_y]] = [unknowns[0], unknowns[unknowns.len() - 1]]
            .map(|unknown| self.place(unknown as usize / 2));
        let (x, y) = (0.5 * (x + to_x), 0.5 * (y + to_y));
        format!("cell {element} near ({x:.1}, {y:.1}) mm")
    }

    fn describe_unknown(&self, unknown: usize) -> String {
        let [x, y] = self.place(unknown / 2);
        let axis = ["x", "y"][unknown % 2];
        format!("node {} ({x:.1}, {y:.1}) mm along {axis}", unknown / 2)
    }
}

impl Climb<'_> {
    /// The equilibrium on the first grid, from a given one upward, on which one can be found.
    ///
    /// # Errors
    /// [`Error::Solve`] with the reason on the finest grid.
    pub(super) fn along_load_path(&self, from: usize, stretch: f64) -> Result<Equilibrium, Error> {
        let mut last = None;
        for index in from..self.levels.len() {
            match self.load_path(index, stretch) {
                Ok(found) => return Ok(found),
                Err(end) => last = Some(end),
            }
        }
        let end = last.expect("one grid at least");
        Err(Error::Solve {
            model: "corrector (climb)".into(),
            step: format!(
                "{} (reached {} %)",
                ClampedPlate::describe_step(stretch),
                ClampedPlate::percent(end.reached() * stretch)
            ),
            fault: end.fault,
        })
    }

    /// Assembles the operators of its grid and of all coarser ones at an equilibrium. Where that fails, finer grids
    /// are iterated with the earlier operators, or solved along a path of load steps too.
    pub(super) fn write_operators(&mut self, found: &Equilibrium) {
        self.linearise_below(found.index, &found.field).ok();
    }

    fn load_path(&self, index: usize, stretch: f64) -> Result<Equilibrium, PathEnd> {
        let grid = &self.levels[index].grid;
        let energy = self.scheme.energy_between(self.problem, &grid.coordinates);
        let loading = GridLoading {
            problem: self.problem,
            grid,
            energy: &energy,
            stretch,
        };
        let state = follow(&loading, &[1.0], NEWTON, Attendance::told(&|_| ()))?.remove(0);
        let field = Field::of_nodes(grid, &state.displacement);
        let residual = state.convergence.residuals.last();
        Ok(Equilibrium {
            index,
            left: residual.map_or(0.0, |left| left * field.size()),
            field,
        })
    }

    /// x with K x = b at the free nodes of the finest grid and −K x + b at the grips, by a sparse factor of the
    /// Jacobian K at `u`.
    ///
    /// # Errors
    /// A [`SolveFault`] when K cannot be factorised.
    pub(super) fn solve_by_factor(&self, u: &Field, b: &Field) -> Result<Field, SolveFault> {
        let grid = self.grid();
        let energy = self.scheme.energy_between(self.problem, &grid.coordinates);
        let loading = GridLoading {
            problem: self.problem,
            grid,
            energy: &energy,
            stretch: 0.0,
        };
        let (u, b) = (u.to_nodes(), b.to_nodes());
        let mut tangent = Tangent::new(&energy, &loading.held(), LinearSolver::Direct)?;
        let mut x = compliance(&mut tangent, &loading, Stage::first(1.0), &u, &b)?;
        let mut image = vec![0.0; x.len()];
        let product = Assembly::add_product(&energy, &u, &x, &mut image);
        product.map_err(|fault| SolveFault::Inverted {
            element: loading.describe(fault.element),
        })?;
        for (unknown, held) in loading.held().into_iter().enumerate() {
            if held {
                x[unknown] = b[unknown] - image[unknown];
            }
        }
        Ok(Field::of_nodes(grid, &x))
    }
}
