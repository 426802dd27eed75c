//! The motion from which both signals follow.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::basis::{Basis, Form, Shape};
use super::penalty::NormalEquations;
use super::recording::Recording;
use super::smoothing::{BandMatrix, SplineValues};
use crate::solve::FactorFault;
use crate::statistics::LocalValues;

/// The argument of D(·).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Argument {
    /// The extension in mm.
    #[default]
    Extension,
    /// Its rate in mm/s.
    Rate,
}

impl Argument {
    /// The names that the command line uses.
    pub const NAMES: [(&'static str, Self); 2] =
        [("extension", Self::Extension), ("rate", Self::Rate)];
}

/// Both signals with their noise, and the motion's spline with its derivatives at all instants.
pub struct Joint<'a> {
    pub recording: &'a Recording,
    /// The instants between gaps, over each of which the motion has a spline of its own.
    pub runs: Vec<Range<usize>>,
    /// Whether the motion's spline has less than half of the wanted parts, because too few instants lie between some gaps.
    pub is_bridged: bool,
    /// Values, first and second derivatives.
    pub orders: [SplineValues; 3],
    /// Standard deviations of extension and force.
    pub noise: [f64; 2],
    /// K(·) and D(·).
    pub functions: [Basis; 2],
    pub argument: Argument,
}

/// Coefficients of the motion, and of K(·) and D(·) one after the other.
#[derive(Clone, Debug)]
pub struct State {
    pub motion: Vec<f64>,
    pub functions: DVector<f64>,
}

/// The forces at an instant.
pub struct Instant {
    pub extension: f64,
    pub rate: f64,
    pub acceleration: f64,
    /// Force in N that the state requires.
    pub force: f64,
    /// ∂force/∂extension and ∂force/∂rate.
    slopes: [f64; 2],
    /// ∂force/∂coefficient of K(·) and D(·).
    by_functions: DVector<f64>,
}

/// The derivatives of extension and force with respect to one more parameter, instant after instant, over the noise.
pub type Column = Vec<[f64; 2]>;

/// The equations of one Gauss–Newton step.
pub struct JointEquations {
    /// The equations after elimination of the motion.
    pub reduced: NormalEquations,
    /// H⁻¹ G and H⁻¹ g of the motion.
    by_functions: DMatrix<f64>,
    by_data: DVector<f64>,
}

impl JointEquations {
    /// The step of the motion that belongs to a step of the functions.
    pub fn motion_step(&self, functions: &DVector<f64>) -> DVector<f64> {
        &self.by_data - &self.by_functions * functions
    }
}

impl Joint<'_> {
    /// The state with this motion and without forces.
    pub fn state(&self, motion: Vec<f64>) -> State {
        let coefficients = self.functions.iter().map(Basis::count).sum();
        State {
            motion,
            functions: DVector::zeros(coefficients),
        }
    }

    /// The same with polynomials instead of splines.
    pub fn with_polynomials(&self) -> Self {
        const DEGREE: usize = 3;
        let functions = self.functions.map(|basis| match basis.form {
            Form::Spline(_) => Basis {
                form: Form::Polynomial(DEGREE),
                shape: Shape::Free,
                ..basis
            },
            Form::Constant | Form::Polynomial(_) => basis,
        });
        Self {
            runs: self.runs.clone(),
            orders: self.orders.clone(),
            functions,
            ..*self
        }
    }

    /// The forces at an instant: m ẍ + D ẋ + K x and its derivatives.
    pub fn instant(&self, instant: usize, state: &State) -> Instant {
        let [x, v, a] = [0, 1, 2].map(|order| self.orders[order].value(instant, &state.motion));
        let (stiffness, damping) = (&self.functions[0], &self.functions[1]);
        let argument = if self.argument == Argument::Rate {
            v
        } else {
            x
        };
        let [k, k_slope] = [0, 1].map(|order| stiffness.values(x, order));
        let [d, d_slope] = [0, 1].map(|order| damping.values(argument, order));
        let split = stiffness.count();
        let [of_k, of_d] = [(0, split), (split, damping.count())]
            .map(|(first, count)| state.functions.rows(first, count));
        let mut slopes = [of_k.dot(&k) + of_k.dot(&k_slope) * x, of_d.dot(&d)];
        slopes[usize::from(self.argument == Argument::Rate)] += of_d.dot(&d_slope) * v;
        let force = self.recording.mass * a + of_k.dot(&k) * x + of_d.dot(&d) * v;
        let mut by_functions = DVector::zeros(state.functions.len());
        by_functions.rows_mut(0, split).copy_from(&(k * x));
        by_functions
            .rows_mut(split, damping.count())
            .copy_from(&(d * v));
        Instant {
            extension: x,
            rate: v,
            acceleration: a,
            force,
            slopes,
            by_functions,
        }
    }

    /// The residuals of both signals, over their noise.
    fn residuals(&self, instant: usize, at: &Instant) -> [f64; 2] {
        [
            (self.recording.extension[instant] - at.extension) / self.noise[0],
            (self.recording.force[instant] - at.force) / self.noise[1],
        ]
    }

    /// Sum of squares of all residuals, over the noise.
    pub fn sum_of_squares(&self, state: &State) -> f64 {
        let square = |instant| -> f64 {
            let residuals = self.residuals(instant, &self.instant(instant, state));
            residuals[0] * residuals[0] + residuals[1] * residuals[1]
        };
        (0..self.recording.times.len()).map(square).sum()
    }

    /// The normal equations with a fixed motion: K(·) and D(·) by linear least squares.
    pub fn with_motion_fixed(&self, state: &State) -> NormalEquations {
        let count = state.functions.len();
        let mut reduced = NormalEquations::new(count);
        for instant in 0..self.recording.times.len() {
            let at = self.instant(instant, state);
            let [_, residual] = self.residuals(instant, &at);
            reduced.add(&(&at.by_functions / self.noise[1]), residual);
        }
        reduced
    }

    /// The normal equations of motion and functions, with `more` parameters after those of the functions,
    ///
    /// ```text
    /// [H G; Gᵀ F] [δc; δθ] = [g; h]      reduced to      (F − Gᵀ H⁻¹ G) δθ = h − Gᵀ H⁻¹ g
    /// ```
    ///
    /// # Errors
    /// [`FactorFault`] when the instants do not determine the motion.
    pub fn linearise(&self, state: &State, more: &[Column]) -> Result<JointEquations, FactorFault> {
        let motions = state.motion.len();
        let count = state.functions.len() + more.len();
        let mut reduced = NormalEquations::new(count);
        let mut matrix = BandMatrix::new(motions)?;
        let mut coupling = DMatrix::zeros(motions, count);
        let mut pull = vec![0.0; motions];
        for instant in 0..self.recording.times.len() {
            let at = self.instant(instant, state);
            let residuals = self.residuals(instant, &at);
            let (first, by_motion) = self.by_motion(instant, &at);
            let by_others = self.by_others(instant, &at, more);
            for (row, residual) in by_others.iter().zip([residuals[1], residuals[0]]) {
                reduced.add(row, residual);
            }
            if more.is_empty() {
                reduced.sum += residuals[0] * residuals[0];
            }
            for (row, residual) in by_motion.iter().zip(residuals) {
                matrix.add(first, row);
                for (sum, value) in pull[first..].iter_mut().zip(row) {
                    *sum += value * residual;
                }
            }
            for (by_motion, by_others) in by_motion.iter().rev().zip(&by_others) {
                for (row, value) in by_motion.iter().enumerate().take(motions - first) {
                    let mut target = coupling.row_mut(first + row);
                    target += *value * by_others.transpose();
                }
            }
        }
        let elimination = matrix.factorise()?;
        let by_data = DVector::from_vec(elimination.solve(&pull)?);
        let mut by_functions = DMatrix::zeros(motions, count);
        for (index, column) in coupling.column_iter().enumerate() {
            let solved = elimination.solve(column.as_slice())?;
            by_functions.column_mut(index).copy_from_slice(&solved);
        }
        reduced.information -= coupling.transpose() * &by_functions;
        reduced.gradient -= coupling.transpose() * &by_data;
        reduced.sum -= DVector::from_vec(pull).dot(&by_data);
        Ok(JointEquations {
            reduced,
            by_functions,
            by_data,
        })
    }

    /// The derivatives of force, and of extension where there are more parameters, with respect to the functions'
    /// coefficients and these, over the noise: the functions alone do not move the extension.
    fn by_others(&self, instant: usize, at: &Instant, more: &[Column]) -> Vec<DVector<f64>> {
        let functions = &at.by_functions / self.noise[1];
        if more.is_empty() {
            return vec![functions];
        }
        let with_more = |functions: DVector<f64>, signal: usize| {
            let more = more.iter().map(|column| column[instant][signal]);
            let all: Vec<f64> = functions.iter().copied().chain(more).collect();
            DVector::from_vec(all)
        };
        let none = DVector::zeros(functions.len());
        vec![with_more(functions, 1), with_more(none, 0)]
    }

    /// The derivatives of extension and force with respect to the motion's coefficients, over the noise.
    fn by_motion(&self, instant: usize, at: &Instant) -> (usize, [LocalValues; 2]) {
        let [x, v, a] = [0, 1, 2].map(|order: usize| &self.orders[order].rows[instant].1);
        let mut rows = [LocalValues::default(); 2];
        for i in 0..x.len() {
            rows[0][i] = x[i] / self.noise[0];
            let force = self.recording.mass * a[i] + at.slopes[0] * x[i] + at.slopes[1] * v[i];
            rows[1][i] = force / self.noise[1];
        }
        (self.orders[0].rows[instant].0, rows)
    }
}
