//! The start of the climb: a field on a coarse grid, near enough to be corrected there.
//!
//! The corrector does not depend on the origin of ū, so that several starts are tried in a fixed order until one can be corrected: see [`Start`].

use super::ascent::{Ascent, Equilibrium};
use super::provenance::{Provenance, Start};
use super::{Climb, Field, Grid, ONLY_GRID_TOLERANCE, START_TOLERANCE};
use crate::error::{Error, SolveFault};
use crate::mass_spring::{LARGEST_ASPECT, LatticeSettings, MassSpring};
use crate::solve::NewtonSettings;

/// The springs are a first guess, which the correction changes by some hundredths: a more exact equilibrium of them would waste time.
const SPRINGS: NewtonSettings = NewtonSettings {
    tolerance: 5e-2,
    max_iterations: 60,
};

/// Load steps that are tried where the springs are too far away.
const LOAD_STEPS: [usize; 3] = [2, 4, 8];

/// Most cells of a lattice of springs: more would take longer than the steps that follow.
const MOST_CELLS: usize = 10_000;

/// The start is far away, so that the first grid is linearised twice: the error of the first iteration relative to its first correction.
const FIRST_TOLERANCE: f64 = 0.05;

impl Climb<'_> {
    /// The corrected field on the first grid: the first of all starts that can be corrected there, or Newton's method
    /// along a path of load steps, there or on the next finer grid on which it finds an equilibrium.
    pub(super) fn first_field(&mut self, stretch: f64) -> Result<Ascent, Error> {
        for steps in [1].into_iter().chain(LOAD_STEPS) {
            if let Some(first) = self.correct_springs(steps, stretch) {
                return Ok(first);
            }
        }
        let equilibrium = self.along_load_path(self.start, stretch)?;
        self.write_operators(&equilibrium);
        let cells = self.levels[equilibrium.index].grid.cells();
        let provenance = Provenance::from_start(Start::LoadPath, cells);
        Ok(Ascent::new(equilibrium, self.ratios, provenance))
    }

    /// The springs' field at the first of so many load steps, corrected and led to the stretch on the first grid; `None` where it cannot be.
    pub(super) fn correct_springs(&mut self, steps: usize, stretch: f64) -> Option<Ascent> {
        let guess = self.springs(stretch / steps as f64)?;
        let (corrected, away) = self.load_steps(guess, steps).ok()?;
        let start = if steps == 1 {
            Start::Springs
        } else {
            Start::LoadSteps(steps)
        };
        let cells = self.levels[self.start].grid.cells();
        let provenance = Provenance {
            away,
            ..Provenance::from_start(start, cells)
        };
        Some(Ascent::new(corrected, self.ratios, provenance))
    }

    /// Corrects on the first grid in equal load steps, each from the field before, scaled with the motion of the grip;
    /// returns the last field, and the distance of the guess from the first one: see [`Provenance::away`].
    fn load_steps(
        &mut self,
        mut field: Field,
        steps: usize,
    ) -> Result<(Equilibrium, f64), SolveFault> {
        let (mut remaining_error, mut away) = (f64::NAN, f64::NAN);
        for step in 1..=steps {
            let mut guess = field.clone();
            self.weakest = 1.0;
            remaining_error = self.correct_start(&mut field)?;
            if step == 1 {
                guess.add(-1.0, &field);
                away = guess.size();
            }
            if step < steps {
                field.scale((step + 1) as f64 / step as f64);
            }
        }
        let corrected = Equilibrium {
            index: self.start,
            field,
            remaining_error,
        };
        Ok((corrected, away))
    }

    /// Corrects on the first grid; returns the remaining error in mm.
    fn correct_start(&mut self, field: &mut Field) -> Result<f64, SolveFault> {
        let alone = self.start + 1 == self.levels.len();
        let tolerance = if alone {
            ONLY_GRID_TOLERANCE
        } else {
            START_TOLERANCE
        };
        let (mut remaining_error, mut weakest) = (f64::NAN, 1.0);
        for tolerance in [tolerance.max(FIRST_TOLERANCE), tolerance] {
            self.linearise_below(self.start, field)?;
            let enough = |first: f64, remaining_error: f64| remaining_error <= tolerance * first;
            let reached = self.solve(self.start, field, &enough)?;
            (remaining_error, weakest) = (reached.remaining_error(), reached.weakest);
        }
        self.weakest = weakest;
        Ok(remaining_error)
    }

    /// The springs in equilibrium, at the nodes of the grid at which the climb begins; `None` where they have no equilibrium.
    ///
    /// The lattice has about half as many cells as the grid along both axes: the error of interpolation is small
    /// compared with that of springs. Its cells have a shape that springs can make isotropic.
    fn springs(&self, stretch: f64) -> Option<Field> {
        let grid = &self.levels[self.start].grid;
        let halves = grid.cells().map(|cells| cells.div_ceil(2).max(2));
        let cells = sound_cells(self.problem.size, halves);
        if cells[0] * cells[1] > MOST_CELLS {
            return None;
        }
        let springs = MassSpring::new(self.problem, cells, LatticeSettings::default());
        let lattice = Grid::even(self.problem.size, cells);
        let guess = stretch_per_unit(self.problem.size, &lattice, stretch);
        let model = springs.model(self.problem).guessing(guess);
        let solved = model.reach(&[stretch], SPRINGS).ok()?;
        let field = Field::of_nodes(&lattice, &solved.displacement);
        Some(field.onto(&lattice, grid))
    }
}

/// The given cells where the ratio of their sides suits springs, otherwise about as many that are nearly square.
fn sound_cells(size: [f64; 2], cells: [usize; 2]) -> [usize; 2] {
    let [hx, hy] = [0, 1].map(|axis| size[axis] / cells[axis] as f64);
    if (hx / hy).max(hy / hx) <= LARGEST_ASPECT {
        return cells;
    }
    let side = (hx * hy).sqrt().min(size[1]).min(0.5 * size[0]);
    let across = (size[1] / side).round();
    let along = (size[0] * across / size[1]).round().max(2.0);
    [along as usize, across as usize]
}

/// The affine stretch along X, and across a contraction as of a strip, λ^(−1/2), that the grips hold back:
///
/// ```text
/// ux = (λ − 1) X,   uy = (λ^(−1/2) − 1) g(X) h(Y − W/2)
/// g(X) = 1 − cosh(4 (X − L/2)/W)/cosh(2 L/W)           nothing at the grips, 1 far from both
/// h(η) = sinh(2 η/L)/(2/L cosh(W/L))                   η in a narrow plate, next to nothing inside a wide one
/// ```
///
/// It turns no cell inside out on any grid: ux is of X alone, and y grows with Y because 0 ≤ g < 1 and 0 < h′ ≤ 1.
fn contracted_stretch(size: [f64; 2], grid: &Grid, stretch: f64) -> Field {
    let [length, width] = size;
    let contraction = (1.0 + stretch).max(f64::MIN_POSITIVE).powf(-0.5) - 1.0;
    let held = |x: f64| 1.0 - cosh_ratio(4.0 * (x - 0.5 * length) / width, 2.0 * length / width);
    let across = |eta: f64| {
        let (along, edge) = (2.0 * eta / length, width / length);
        0.5 * length * sinh_over_cosh(along, edge)
    };
    let mut field = Field::zeros(grid);
    let [x, y] = &grid.coordinates;
    let [u_x, u_y] = &mut field.components;
    let lines = u_x
        .chunks_exact_mut(y.len())
        .zip(u_y.chunks_exact_mut(y.len()));
    for (x, (u_x, u_y)) in x.iter().zip(lines) {
        u_x.fill(stretch * x);
        for (y, u_y) in y.iter().zip(u_y) {
            *u_y = contraction * held(*x) * across(y - 0.5 * width);
        }
    }
    field
}

/// The contracted stretch per unit of stretch, at the nodes: the first guess of a path to a stretch.
pub(super) fn stretch_per_unit(size: [f64; 2], grid: &Grid, stretch: f64) -> Vec<f64> {
    let mut guess = contracted_stretch(size, grid, stretch);
    guess.scale(if stretch == 0.0 { 1.0 } else { 1.0 / stretch });
    guess.to_nodes()
}

/// cosh a/cosh b for |a| ≤ b, however large they are.
fn cosh_ratio(a: f64, b: f64) -> f64 {
    let a = a.abs();
    (a - b).exp() * (1.0 + (-2.0 * a).exp()) / (1.0 + (-2.0 * b).exp())
}

/// sinh a/cosh b for |a| ≤ b, however large they are.
fn sinh_over_cosh(a: f64, b: f64) -> f64 {
    let size = a.abs();
    a.signum() * (size - b).exp() * -(-2.0 * size).exp_m1() / (1.0 + (-2.0 * b).exp())
}

#[cfg(test)]
mod tests;
