//! The corrective technique in time: a motion ū(t) on the nodes is brought to the nearest one that satisfies the equation
//! of motion at every three consecutive instants, Eq. 5–19 of the publication with F of order 2.
//!
//! ```text
//! F₁ = M (u₂ − 2 u₁ + u₀)/h² + β g₀ + (1 − 2β) g₁ + β g₂ + ½ (c₁₂ + c₀₁) = 0,   g = ∂Π/∂u − f(t)      [N]
//! F₀ = M (u₁ − u₀ − h u̇₀)/h² + (½ − β) g₀ + β g₁ + ½ c₀₁ = 0                        at the start, with u₀ and u̇₀
//! ```
//!
//! c₀₁ are the viscous forces at the middle of a step: at ½ (u₀ + u₁) with the rate (u₁ − u₀)/h. β = ¼ is Newmark's average
//! acceleration, β = 0 the central differences of Eq. 5; both are of second order in h.
//!
//! **Known start.** With u₀ and u̇₀ (or the first two instants), the supports and all loads, there is one equation for each
//! unknown. B is square, and lower triangular in blocks of one instant: the correction is Newton's method in time that begins at
//! ū, and its result does not depend on ū, which affects the multipliers only. [`EquationOfMotion::correct`] goes through windows
//! of time with one factor of the block on the diagonal, retained as long as it serves.
//!
//! **Unknown start.** A recorded motion has no known start: there are two equations fewer than instants at each
//! unknown, and [`EquationOfMotion::smooth`] solves the least-squares problem of Eq. 6–12. Noise that no motion of
//! the body can produce is removed: of white noise over n instants about √(2/n) remains.
//!
//! # References
//! H. Mohammadi, W. Wan: A novel numerical corrective technique to mass spring systems, Eq. 5–19;
//! N. M. Newmark, J. Eng. Mech. Div. ASCE 85, 67 (1959)

use rayon::prelude::*;

use super::{Condition, Corrector, CorrectorSettings, Linearisation};
use crate::dynamics::{Memory, Motion, StepForces, Viscosity};
use crate::error::SolveFault;
use crate::solve::vector::{add_scaled, gather, largest};
use crate::solve::{Assembly, Inadmissible, SparseRows};

mod window;

pub use window::{CorrectedMotion, CorrectionEnd, WindowSettings};

#[cfg(test)]
mod tests;

/// The name of the condition.
const NAME: &str = "equation of motion";

/// The equation of motion of a body at equal steps of time.
pub struct EquationOfMotion<'a> {
    motion: &'a Motion<'a>,
    assembly: Assembly,
    step: f64,
    weight: f64,
}

/// Forces g and their tangent at an instant, over the free unknowns.
struct Frame {
    force: Vec<f64>,
    stiffness: Vec<f64>,
    /// The largest force in N, including held unknowns: at rest the forces at free unknowns are rounding.
    size: f64,
}

/// Viscous forces of a step and their tangents by its two ends.
struct Link {
    force: Vec<f64>,
    by_ends: [Vec<f64>; 2],
}

/// Consecutive instants, linearised.
struct Interval {
    frames: Vec<Frame>,
    links: Vec<Link>,
}

/// Why the equation of motion between three instants is not valid for a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MotionFault {
    /// A support is released later than at the start.
    #[error("a support is released during the motion: begin at the release")]
    LettingGo,
    /// Stresses depend on the whole past.
    #[error("three instants do not determine the stresses of a Prony series: leave out its terms")]
    Relaxing,
    /// A free unknown has no mass.
    #[error("a free unknown has no mass: fix it, or give it a mass")]
    Massless,
}

impl<'a> EquationOfMotion<'a> {
    /// The equation of `motion` at instants from time 0 on that are `step` apart in s, with β = `weight`.
    ///
    /// # Errors
    /// [`MotionFault`] where the motion has no such equation.
    pub fn new(motion: &'a Motion<'a>, step: f64, weight: f64) -> Result<Self, MotionFault> {
        let mut releases = motion.supports.iter().filter_map(|support| support.until);
        if releases.any(|until| until > 0.0) {
            return Err(MotionFault::LettingGo);
        }
        let remembers = |viscosity: &dyn Viscosity| {
            (0..motion.energy.elements()).any(|element| viscosity.memory(element) > 0)
        };
        if motion.viscosity.is_some_and(remembers) {
            return Err(MotionFault::Relaxing);
        }
        let assembly = Assembly::new(motion.energy, &motion.held(0.0));
        if assembly
            .free()
            .iter()
            .any(|unknown| motion.mass[*unknown] <= 0.0)
        {
            return Err(MotionFault::Massless);
        }
        Ok(Self {
            motion,
            assembly,
            step,
            weight,
        })
    }

    /// Corrects a recorded motion with an unknown start: all unknowns at all instants, of which `data` are measured
    /// and `start` is a guess without noise. Windows of so many `instants` are corrected independently.
    ///
    /// # Errors
    /// A [`SolveFault`] when some instants have no solution that is found.
    ///
    /// # Panics
    /// When `data` and `start` have different numbers of instants.
    pub fn smooth(
        &self,
        data: &[Vec<f64>],
        start: &[Vec<f64>],
        instants: usize,
        settings: CorrectorSettings,
    ) -> Result<Vec<Vec<f64>>, SolveFault> {
        assert_eq!(data.len(), start.len(), "a guess for every instant");
        let count = data.len();
        let mut smoothed = Vec::with_capacity(count);
        while smoothed.len() < count {
            let first = smoothed.len();
            let rest = count - first;
            // A remainder of one or two instants would have no equation.
            let count = if rest < instants + 3 { rest } else { instants };
            let stacked = |fields: &[Vec<f64>]| -> Vec<f64> {
                fields[first..first + count]
                    .iter()
                    .flat_map(|field| self.free(field))
                    .collect()
            };
            let size = count * self.assembly.free().len();
            let condition = StackedEquations {
                equation: self,
                first,
                instants: count,
            };
            let corrector = Corrector::new(vec![Box::new(condition)], vec![1.0; size], settings);
            let correction = corrector.correct(&stacked(data), &stacked(start))?;
            let fields = correction
                .field()
                .chunks_exact(self.assembly.free().len())
                .enumerate();
            smoothed.extend(fields.map(|(i, field)| self.all_unknowns(first + i, field)));
        }
        Ok(smoothed)
    }

    fn time(&self, instant: usize) -> f64 {
        self.step * instant as f64
    }

    /// The free unknowns of a field.
    fn free(&self, field: &[f64]) -> Vec<f64> {
        gather(self.assembly.free(), field)
    }

    /// The whole field of an instant from its free unknowns.
    fn all_unknowns(&self, instant: usize, free: &[f64]) -> Vec<f64> {
        let size = self.motion.energy.unknowns();
        let (mut field, mut rate, mut second) = (vec![0.0; size], vec![0.0; size], vec![0.0; size]);
        let time = self.time(instant);
        self.motion
            .impose(time, time, [&mut field, &mut rate, &mut second]);
        for (unknown, value) in self.assembly.free().iter().zip(free) {
            field[*unknown] = *value;
        }
        field
    }

    /// Consecutive instants and the steps between them; the first instant has the number `first`.
    fn linearise(&self, first: usize, states: &[Vec<f64>]) -> Result<Interval, Inadmissible> {
        let numbered: Vec<_> = states.iter().enumerate().collect();
        let fields: Vec<Vec<f64>> = numbered
            .par_iter()
            .map(|(i, state)| self.all_unknowns(first + i, state))
            .collect();
        let frames = fields.par_iter().enumerate();
        let frames = frames
            .map(|(i, field)| self.frame(first + i, field))
            .collect::<Result<_, _>>()?;
        let links = fields
            .par_windows(2)
            .map(|pair| self.link(&pair[0], &pair[1]));
        Ok(Interval {
            frames,
            links: links.collect::<Result<_, _>>()?,
        })
    }

    fn frame(&self, instant: usize, field: &[f64]) -> Result<Frame, Inadmissible> {
        let (mut residual, mut stiffness) = (vec![0.0; field.len()], Vec::new());
        self.assembly
            .linearise(self.motion.energy, field, &mut residual, &mut stiffness)?;
        let external = self.motion.external_forces(self.time(instant));
        let free = self.assembly.free().iter();
        Ok(Frame {
            size: largest(&residual),
            force: free.map(|i| residual[*i] - external[*i]).collect(),
            stiffness,
        })
    }

    fn link(&self, from: &[f64], to: &[f64]) -> Result<Link, Inadmissible> {
        let size = self.assembly.free().len();
        let empty = || vec![0.0; self.assembly.pattern().entries()];
        let Some(viscosity) = self.motion.viscosity else {
            return Ok(Link {
                force: vec![0.0; size],
                by_ends: [empty(), empty()],
            });
        };
        let pairs = || from.iter().zip(to);
        let middle: Vec<f64> = pairs().map(|(a, b)| 0.5 * (a + b)).collect();
        let rate: Vec<f64> = pairs().map(|(a, b)| (b - a) / self.step).collect();
        let mut force = vec![0.0; from.len()];
        let mut by_end = |by_rate: f64| -> Result<Vec<f64>, Inadmissible> {
            let forces = StepForces {
                energy: self.motion.energy,
                viscosity: Some(viscosity),
                velocity: &rate,
                memory: &Memory::default(),
                elapsed: self.step,
                elastic: false,
                by_displacement: 0.5,
                by_velocity: by_rate,
            };
            let mut values = Vec::new();
            self.assembly
                .linearise(&forces, &middle, &mut force, &mut values)?;
            Ok(values)
        };
        let by_ends = [by_end(-1.0 / self.step)?, by_end(1.0 / self.step)?];
        Ok(Link {
            force: self.free(&force),
            by_ends,
        })
    }

    /// The terms of a row's equation for each instant: its number, and the factors of M u/h² and of g. Row 0 is the start.
    fn terms(&self, row: usize) -> Vec<(usize, f64, f64)> {
        let beta = self.weight;
        match row {
            0 => vec![(0, -1.0, 0.5 - beta), (1, 1.0, beta)],
            _ => vec![
                (row - 1, 1.0, beta),
                (row, -2.0, 1.0 - 2.0 * beta),
                (row + 1, 1.0, beta),
            ],
        }
    }

    /// F of a row; without the start's velocity.
    fn value(&self, row: usize, interval: &Interval, states: &[Vec<f64>]) -> Vec<f64> {
        let mut sum = vec![0.0; self.assembly.free().len()];
        for (instant, inertia, elastic) in self.terms(row) {
            let pairs = states[instant].iter().zip(&interval.frames[instant].force);
            for ((sum, unknown), (u, force)) in sum.iter_mut().zip(self.assembly.free()).zip(pairs)
            {
                *sum += inertia * self.inertia(*unknown) * u + elastic * force;
            }
        }
        for link in row.saturating_sub(1)..=row {
            add_scaled(&mut sum, 0.5, &interval.links[link].force);
        }
        sum
    }

    /// ∂F/∂u of a row with respect to one of its instants, on the pattern of the stiffness: symmetric.
    fn block(&self, row: usize, instant: usize, interval: &Interval) -> Vec<f64> {
        let mut terms = self.terms(row).into_iter();
        let Some((_, inertia, elastic)) = terms.find(|term| term.0 == instant) else {
            return vec![0.0; self.assembly.pattern().entries()];
        };
        let mut values: Vec<f64> = interval.frames[instant]
            .stiffness
            .iter()
            .map(|k| elastic * k)
            .collect();
        for link in row.saturating_sub(1)..=row {
            if let Some(end) = instant.checked_sub(link).filter(|end| *end < 2) {
                add_scaled(&mut values, 0.5, &interval.links[link].by_ends[end]);
            }
        }
        let diagonal = self.assembly.pattern().diagonal();
        for (unknown, position) in self.assembly.free().iter().zip(diagonal) {
            values[*position] += inertia * self.inertia(*unknown);
        }
        values
    }

    /// M/h² of an unknown.
    fn inertia(&self, unknown: usize) -> f64 {
        self.motion.mass[unknown] / (self.step * self.step)
    }
}

/// The equations of consecutive instants, one above the other, over the free unknowns of all its instants.
struct StackedEquations<'a> {
    equation: &'a EquationOfMotion<'a>,
    first: usize,
    instants: usize,
}

impl StackedEquations<'_> {
    fn states(&self, field: &[f64]) -> Vec<Vec<f64>> {
        let size = self.equation.assembly.free().len();
        field.chunks_exact(size).map(<[f64]>::to_vec).collect()
    }
}

impl Condition for StackedEquations<'_> {
    fn name(&self) -> &str {
        NAME
    }

    fn rows(&self) -> usize {
        (self.instants - 2) * self.equation.assembly.free().len()
    }

    fn linearise(&self, field: &[f64]) -> Result<Linearisation, Inadmissible> {
        let (equation, states) = (self.equation, self.states(field));
        let size = equation.assembly.free().len();
        let interval = equation.linearise(self.first, &states)?;
        let (mut values, mut jacobian) = (Vec::new(), SparseRows::new(field.len()));
        for row in 1..self.instants - 1 {
            values.extend(equation.value(row, &interval, &states));
            let blocks = [row - 1, row, row + 1].map(|instant| {
                let block = equation.block(row, instant, &interval);
                (instant, equation.assembly.pattern().full_rows(&block))
            });
            for unknown in 0..size {
                let entries = blocks.iter().flat_map(|(instant, rows)| {
                    rows[unknown]
                        .iter()
                        .map(move |(column, value)| (instant * size + column, *value))
                });
                jacobian.push(entries);
            }
        }
        Ok(Linearisation { values, jacobian })
    }
}
