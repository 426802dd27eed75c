//! One grid alone, slow and robust: Newton's method with a sparse factor along a path of load steps.
//!
//! The equation is exactly that of [`forces`](super::forces): the same energy, sampled at the same points. In
//! contrast to the climb's iteration there are a line search by the energy that keeps J > 0 everywhere, tangents that
//! are shifted where they are not positive definite, load steps that are halved where they fail, and a diagnosis of
//! why a path ends.

use super::ascent::Equilibrium;
use super::grid::{Field, Grid};
use super::start::stretch_per_unit;
use super::{Climb, NAME};
use crate::error::{Error, SolveFault};
use crate::mesh::Mesh;
use crate::problem::Model;
use crate::problem::sheet_energy::SheetEnergy;
use crate::solve::{
    Assembly, LinearSolver, Loading, NewtonSettings, Potential, Tangent, compliance,
};

/// The remaining residual of Newton's method, relative to the largest reaction.
const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-9,
    max_iterations: 60,
};

/// The scheme's plate on a grid.
struct GridPlate<'a> {
    grid: &'a Grid,
    mesh: Mesh,
    energy: SheetEnergy,
}

impl GridPlate<'_> {
    fn describe(&self, element: usize) -> String {
        let unknowns = self.energy.element_unknowns(element);
        let [[x, y], [to_x, to_y]] = [unknowns[0], unknowns[unknowns.len() - 1]]
            .map(|unknown| self.mesh.nodes[unknown as usize / 2]);
        let (x, y) = (0.5 * (x + to_x), 0.5 * (y + to_y));
        format!("cell {element} near ({x:.1}, {y:.1}) mm")
    }
}

impl Climb<'_> {
    /// The equilibrium on the first grid, from a given one upward, on which one can be found.
    pub(super) fn along_load_path(&self, from: usize, stretch: f64) -> Result<Equilibrium, Error> {
        let mut equilibrium = self.load_path(from, stretch);
        for index in from + 1..self.levels.len() {
            if equilibrium.is_ok() {
                break;
            }
            equilibrium = self.load_path(index, stretch);
        }
        equilibrium
    }

    /// Assembles the operators of its grid and of all coarser ones at an equilibrium. Where that fails, finer grids
    /// are iterated with the earlier operators, or solved along a path of load steps too.
    pub(super) fn write_operators(&mut self, equilibrium: &Equilibrium) {
        self.linearise_below(equilibrium.index, &equilibrium.field)
            .ok();
    }

    fn plate_on<'a>(&self, grid: &'a Grid) -> GridPlate<'a> {
        GridPlate {
            grid,
            mesh: grid.mesh(1),
            energy: self.scheme.energy_between(self.problem, &grid.coordinates),
        }
    }

    /// The problem on a grid's plate; a path to a stretch begins at the contracted stretch.
    fn model<'a>(&self, plate: &'a GridPlate, stretch: f64) -> Model<'a> {
        let guess = stretch_per_unit(self.problem.size, plate.grid, stretch);
        let model = self.problem.on(&plate.mesh, &plate.energy);
        model
            .named(NAME)
            .describing(|element| plate.describe(element))
            .guessing(guess)
    }

    fn load_path(&self, index: usize, stretch: f64) -> Result<Equilibrium, Error> {
        let plate = self.plate_on(&self.levels[index].grid);
        let state = self.model(&plate, stretch).reach(&[stretch], NEWTON)?;
        let field = Field::of_nodes(plate.grid, &state.displacement);
        let residual = state.convergence.residuals.last();
        Ok(Equilibrium {
            index,
            remaining_error: residual.map_or(0.0, |remaining_error| remaining_error * field.size()),
            field,
        })
    }

    /// x with K x = b at the free nodes of the finest grid and −K x + b at the grips, by a sparse factor of the
    /// Jacobian K at `u`.
    pub(super) fn solve_by_factor(&self, u: &Field, b: &Field) -> Result<Field, SolveFault> {
        let plate = self.plate_on(self.grid());
        let model = self.model(&plate, 0.0);
        let held = model.held();
        let (u, b) = (u.to_nodes(), b.to_nodes());
        let mut tangent = Tangent::new(&plate.energy, &held, LinearSolver::Direct)?;
        let mut x = compliance(&mut tangent, &model, &u, &b)?;
        let mut image = vec![0.0; x.len()];
        let product = Assembly::add_product(&plate.energy, &u, &x, &mut image);
        product.map_err(|fault| fault.named(|element| plate.describe(element)))?;
        for (unknown, held) in held.into_iter().enumerate() {
            if held {
                x[unknown] = b[unknown] - image[unknown];
            }
        }
        Ok(Field::of_nodes(plate.grid, &x))
    }
}
