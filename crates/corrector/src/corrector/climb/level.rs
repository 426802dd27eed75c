//! One grid of the climb: its equation, and the iteration that solves it.

use super::correction_history::CorrectionHistory;
use super::grid::{Field, Grid};
use super::sheet::{Inverted, Sheet};
use super::sweep::{Part, sum};
use crate::multigrid::{Multigrid, Vector};

/// Most iterations of a linear system.
const LINEAR_ITERATIONS: usize = 200;

/// Step size of a difference of F, relative to the displacements.
const DIFFERENCE: f64 = 1e-7;

/// A grid with the vectors of its iteration.
#[derive(Debug)]
pub struct Level {
    /// The grid.
    pub grid: Grid,
    /// The number of the grid among the multigrid's grids.
    pub index: usize,
    /// The nodes at which the change from the grid before is measured; all nodes where there are none.
    pub shared: Option<[Vec<usize>; 2]>,
    /// F at the field that was evaluated last, or before the last correction of an iteration.
    pub residual: Field,
    trial: Field,
    trial_residual: Field,
    direction: Field,
    correction: Field,
}

/// The stopping criteria of an iteration.
pub struct Ending<'a> {
    /// Most iterations.
    pub most: usize,
    /// The smallest eigenvalue of the preconditioned operator found on coarser grids: see [`CorrectionHistory`].
    pub weakest: f64,
    /// Whether the first correction and the remaining error are good enough.
    pub enough: &'a dyn Fn(f64, f64) -> bool,
}

impl Level {
    /// The vectors for the last one of some grids, coarse to fine.
    pub fn new(grids: &[Grid]) -> Self {
        let index = grids.len() - 1;
        let grid = grids[index].clone();
        let field = Field::zeros(&grid);
        let coarser = index.checked_sub(1).filter(|_| !grid.is_even());
        Self {
            shared: coarser.and_then(|coarser| grid.shared_with(&grids[coarser])),
            grid,
            index,
            residual: field.clone(),
            trial: field.clone(),
            trial_residual: field.clone(),
            direction: field.clone(),
            correction: field,
        }
    }

    /// The size of the change from the grid before. Where grids are graded it is the root mean square over the nodes
    /// that both have, because interpolation adds its own error elsewhere, which can be many times as large.
    pub fn size_of(&self, change: &Field) -> f64 {
        let shared = self.shared.as_ref();
        shared.map_or_else(|| change.size(), |shared| change.size_at(shared))
    }

    /// Writes F(u) in N at all nodes to [`Self::residual`]; at the grips these are the reactions.
    pub fn evaluate_residual(&mut self, sheet: Sheet, u: &Field) -> Result<(), Inverted> {
        sheet.forces(&self.grid, u, &mut self.residual)
    }

    /// Assembles the operator at `u`.
    pub fn linearise(
        &self,
        sheet: Sheet,
        u: &Field,
        multigrid: &mut Multigrid,
    ) -> Result<(), Inverted> {
        sheet.linearise(&self.grid, u, multigrid.stencil(self.index))
    }

    /// Moves the free nodes of `u` towards F(u) = 0 by conjugate gradients, whose products with the Jacobian are
    /// differences of F and whose preconditioner is one V-cycle with the operators assembled before.
    pub fn iterate(
        &mut self,
        sheet: Sheet,
        u: &mut Field,
        multigrid: &mut Multigrid,
        ending: &Ending,
    ) -> Result<CorrectionHistory, Inverted> {
        self.evaluate_residual(sheet, u)?;
        let [mut steepness, size] = self.precondition(multigrid);
        let mut correction_history = CorrectionHistory::new(size, ending.weakest);
        for component in &mut self.direction.components {
            component.fill(0.0);
        }
        let mut share = 0.0;
        for _ in 0..ending.most {
            if (ending.enough)(
                correction_history.first(),
                correction_history.remaining_error(),
            ) {
                break;
            }
            let length = self.step(sheet, u, share)?;
            let [next, size] = self.precondition(multigrid);
            share = next / steepness;
            steepness = next;
            correction_history.push(size, length, share);
        }
        u.add(-1.0, &self.correction);
        Ok(correction_history)
    }

    /// The correction z = M⁻¹ r of the residual, which is zero at the grips: r · z, and the root mean square of z over the nodes in mm.
    fn precondition(&mut self, multigrid: &mut Multigrid) -> [f64; 2] {
        let width = self.residual.width;
        let residual = &self.residual;
        let right = multigrid.right_hand_side(self.index);
        right.for_each_free_line(|line, b_x, b_y| {
            for (b, r) in [b_x, b_y].into_iter().zip(&residual.components) {
                let pairs = b[1..=width].iter_mut().zip(&r[line * width..]);
                pairs.for_each(|(b, r)| *b = *r as f32);
            }
        });
        let z: &Vector = multigrid.cycle(self.index);
        let last = z.lines().count - 1;
        let (mut product, mut squares) = (0.0, 0.0);
        for axis in [0, 1] {
            let target = &mut self.correction.components[axis][..];
            let residual = &self.residual.components[axis][..];
            let [product_of_lane, square] =
                Part::all(z.lines()).sweep([target], [residual], &|part, [target], [residual]| {
                    let lines = target.chunks_exact_mut(width);
                    let mut sums = [0.0; 2];
                    for (line, (target, r)) in lines.zip(residual.chunks_exact(width)).enumerate() {
                        let line = part.first / width + line;
                        if line == 0 || line == last {
                            continue;
                        }
                        let z = &z.line(line)[axis][1..=width];
                        for (target, z) in target.iter_mut().zip(z) {
                            *target = f64::from(*z);
                        }
                        let of_line = sum(width, |node| {
                            [target[node] * r[node], target[node] * target[node]]
                        });
                        sums = [sums[0] + of_line[0], sums[1] + of_line[1]];
                    }
                    sums
                });
            product += product_of_lane;
            squares += square;
        }
        [product, (squares / self.grid.nodes() as f64).sqrt()]
    }

    /// p = β p − z, and the trial u + p.
    fn turn(&mut self, u: &Field, share: f64) {
        for axis in [0, 1] {
            let direction = &mut self.direction.components[axis][..];
            let trial = &mut self.trial.components[axis][..];
            let read = [&u.components[axis][..], &self.correction.components[axis]];
            let part = Part::all(self.grid.lines());
            part.sweep([direction, trial], read, &|_, [p, trial], [u, z]| {
                let pairs = p.iter_mut().zip(trial).zip(u.iter().zip(z));
                for ((p, trial), (u, z)) in pairs {
                    *p = share * *p - z;
                    *trial = u + *p;
                }
                []
            });
        }
    }

    /// Solves K x = b at the free nodes with x = 0 at the grips, K being the Jacobian of F at `u`, by the same iteration as
    /// [`Self::iterate`]: returns x, with b − K x at the grips; `None` where K is not positive definite or `u` not admissible.
    pub fn solve_linear(
        &mut self,
        sheet: Sheet,
        u: &Field,
        b: &Field,
        multigrid: &mut Multigrid,
        tolerance: f64,
    ) -> Option<Field> {
        let mut at_rest = Field::zeros(&self.grid);
        sheet.forces(&self.grid, u, &mut at_rest).ok()?;
        let mut x = Field::zeros(&self.grid);
        let mut image = Field::zeros(&self.grid);
        self.residual.clone_from(b);
        self.residual.scale(-1.0);
        let [mut steepness, first] = self.precondition(multigrid);
        self.direction.scale(0.0);
        let mut share = 0.0;
        for _ in 0..LINEAR_ITERATIONS {
            self.turn(u, share);
            let scale = DIFFERENCE * u.size() / self.direction.size().max(f64::MIN_POSITIVE);
            self.trial.clone_from(u);
            self.trial.add(scale, &self.direction);
            let forces = sheet.forces(&self.grid, &self.trial, &mut self.trial_residual);
            forces.ok()?;
            self.trial_residual.add(-1.0, &at_rest);
            self.trial_residual.scale(1.0 / scale);
            let curvature = self.direction.product(&self.trial_residual);
            if curvature <= 0.0 {
                return None;
            }
            let length = -self.direction.product(&self.residual) / curvature;
            x.add(length, &self.direction);
            image.add(length, &self.trial_residual);
            self.residual.add(length, &self.trial_residual);
            let [next, size] = self.precondition(multigrid);
            share = next / steepness;
            steepness = next;
            if size <= tolerance * first {
                let free = u.free();
                for (axis, x) in x.components.iter_mut().enumerate() {
                    let held = (0..x.len()).filter(|node| !free.contains(node));
                    for node in held {
                        x[node] = b.components[axis][node] - image.components[axis][node];
                    }
                }
                return Some(x);
            }
        }
        None
    }

    /// Turns the direction, p = β p − z, and goes along it until the residual is orthogonal to it; returns how far.
    fn step(&mut self, sheet: Sheet, u: &mut Field, share: f64) -> Result<f64, Inverted> {
        self.turn(u, share);
        let mut length = 1.0;
        loop {
            let done = sheet.forces(&self.grid, &self.trial, &mut self.trial_residual);
            match done {
                Ok(()) => break,
                Err(Inverted) if length > 0.1 => length *= 0.5,
                Err(Inverted) => return Err(Inverted),
            }
            self.trial.clone_from(u);
            self.trial.add(length, &self.direction);
        }
        let part = Part::all(self.grid.lines());
        let (mut against, mut curvature) = (0.0, 0.0);
        for axis in [0, 1] {
            let read = [&self.direction, &self.residual, &self.trial_residual]
                .map(|field| &field.components[axis][..]);
            let [product_of_part, change] = part.sweep([], read, &|_, [], [p, r, there]| {
                sum(p.len(), |k| [p[k] * r[k], p[k] * (there[k] - r[k])])
            });
            against += product_of_part;
            curvature += change;
        }
        let share = if curvature > 0.0 {
            (-against / curvature).min(2.0)
        } else {
            1.0
        };
        for axis in [0, 1] {
            let changed = [&mut u.components[axis], &mut self.residual.components[axis]];
            let read =
                [&self.direction, &self.trial_residual].map(|field| &field.components[axis][..]);
            part.sweep(
                changed.map(|f| &mut f[..]),
                read,
                &|_, [u, r], [p, there]| {
                    for ((u, r), (p, there)) in u.iter_mut().zip(r).zip(p.iter().zip(there)) {
                        *u += share * length * p;
                        *r += share * (there - *r);
                    }
                    []
                },
            );
        }
        Ok(share * length)
    }
}
