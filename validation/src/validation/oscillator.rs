//! A damped oscillator, its difference equations, and the regression of its constants.
//!
//! ```text
//! ü + c u̇ + k u = 0,   u(t) = e^(−c t/2) (a cos ω t + b sin ω t),   ω² = k − c²/4
//!
//! order 2     u₋ − 2 u₀ + u₊ + ½ c h (u₊ − u₋) + k h² u₀ = 0
//! order 4     u₋ − 2 u₀ + u₊ + k h² (u₋ + 10 u₀ + u₊)/12 = 0                         (Numerov, c = 0)
//! ```
//!
//! Both are D u + k M u + c G u = 0 with matrices D, M, G that have one row for each inner instant.
//!
//! # References
//! B. Numerov, Mon. Not. R. Astron. Soc. 84, 592 (1924), doi:10.1093/mnras/84.8.592

use nalgebra::DMatrix;

use crate::corrector::{
    Condition, Corrector, CorrectorSettings, Factor, Function, Linear, Linearisation, Solver,
};
use crate::error::SolveFault;
use crate::solve::SparseRows;
use crate::statistics::Estimate;

/// A motion, sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// k in 1/s².
    pub stiffness: f64,
    /// c in 1/s.
    pub damping: f64,
    /// Amplitude at the start in mm; the velocity there is zero without damping.
    pub amplitude: f64,
    /// Duration in s.
    pub duration: f64,
    /// Instants, the first and the last included.
    pub points: usize,
}

impl Motion {
    /// Time between instants in s.
    pub fn step(&self) -> f64 {
        self.duration / (self.points - 1) as f64
    }

    /// The instants in s.
    pub fn times(&self) -> Vec<f64> {
        (0..self.points).map(|i| i as f64 * self.step()).collect()
    }

    /// The displacement in mm, with a = `amplitude` and b = 0.
    pub fn displacement(&self) -> Vec<f64> {
        self.general(self.amplitude, 0.0)
    }

    fn general(&self, a: f64, b: f64) -> Vec<f64> {
        let omega = (self.stiffness - 0.25 * self.damping.powi(2)).sqrt();
        let value = |t: f64| {
            let (sin, cos) = (omega * t).sin_cos();
            (-0.5 * self.damping * t).exp() * (a * cos + b * sin)
        };
        self.times().into_iter().map(value).collect()
    }

    /// The smallest standard deviation that an unbiased estimate of k (and of c, where there is damping)
    /// can have from data with white noise of standard deviation `noise`: the Cramér–Rao bound, from the
    /// Fisher information of a, b, k and c.
    pub fn bounds(&self, noise: f64) -> Option<Vec<f64>> {
        let difference = |up: Vec<f64>, down: Vec<f64>, step: f64| -> Vec<f64> {
            up.iter()
                .zip(&down)
                .map(|(up, down)| (up - down) / (2.0 * step))
                .collect()
        };
        let step = 1e-5;
        let with = |stiffness: f64, damping: f64| {
            Self {
                stiffness,
                damping,
                ..*self
            }
            .displacement()
        };
        let (k, c) = (self.stiffness, self.damping);
        let mut columns = vec![
            difference(with(k + step, c), with(k - step, c), step),
            self.general(1.0, 0.0),
            self.general(0.0, 1.0),
        ];
        if c > 0.0 {
            columns.insert(1, difference(with(k, c + step), with(k, c - step), step));
        }
        let sensitivity = DMatrix::from_fn(self.points, columns.len(), |i, j| columns[j][i]);
        let information = sensitivity.transpose() * &sensitivity / (noise * noise);
        let covariance = information.try_inverse()?;
        let constants = if c > 0.0 { 2 } else { 1 };
        Some((0..constants).map(|i| covariance[(i, i)].sqrt()).collect())
    }
}

/// The difference equations on a grid of instants.
#[derive(Clone, Debug)]
pub struct Differences {
    /// D, M and G.
    operators: [SparseRows; 3],
    points: usize,
}

impl Differences {
    /// Equations for `points` instants `step` apart, of order 2, or of order 4 without damping.
    pub fn new(points: usize, step: f64, order: usize) -> Self {
        let square = step * step;
        let mass = if order == 4 {
            [1.0, 10.0, 1.0].map(|m| m * square / 12.0)
        } else {
            [0.0, square, 0.0]
        };
        let stencils = [[1.0, -2.0, 1.0], mass, [-0.5 * step, 0.0, 0.5 * step]];
        let operator = |stencil: [f64; 3]| {
            let mut rows = SparseRows::new(points);
            for first in 0..points - 2 {
                rows.push((0..3).map(|i| (first + i, stencil[i])));
            }
            rows
        };
        Self {
            operators: stencils.map(operator),
            points,
        }
    }

    /// D + k M + c G, over so many columns.
    fn combined(&self, constants: &[f64], columns: usize) -> SparseRows {
        let factors = [1.0, constants[0], constants.get(1).copied().unwrap_or(0.0)];
        let mut rows = SparseRows::new(columns);
        for row in 0..self.points - 2 {
            let parts = self.operators.iter().zip(factors);
            let entries = parts.flat_map(|(operator, factor)| {
                operator
                    .row(row)
                    .iter()
                    .map(move |(column, value)| (*column, factor * value))
            });
            rows.push(entries.collect::<Vec<_>>());
        }
        rows
    }

    /// D u + k M u.
    pub fn residual(&self, u: &[f64], stiffness: f64) -> Vec<f64> {
        self.combined(&[stiffness], self.points).multiply(u)
    }

    /// The corrector with known constants.
    pub fn known(&self, constants: &[f64], settings: CorrectorSettings) -> Corrector<'static> {
        let rows = self.combined(constants, self.points);
        let zeros = vec![0.0; rows.len()];
        let motion: Box<dyn Condition> = Box::new(Linear::new("equation of motion", rows, zeros));
        Corrector::new(vec![motion], vec![1.0; self.points], settings)
    }

    /// The corrector with so many unknown constants behind the field: k, or k and c.
    pub fn unknown(&self, constants: usize, settings: CorrectorSettings) -> Corrector<'static> {
        let (oscillator, other) = (self.clone(), self.clone());
        let n = self.points;
        let function = Function::new("equation of motion", n - 2, move |z| {
            oscillator.linearise(z, constants)
        });
        let function = function.with_curvature(move |z, psi| other.curvature(z.len(), psi));
        let mut weights = vec![1.0; n];
        weights.extend(vec![0.0; constants]);
        Corrector::new(vec![Box::new(function)], weights, settings)
    }

    fn linearise(&self, z: &[f64], constants: usize) -> Linearisation {
        let (u, constants) = (&z[..self.points], &z[self.points..self.points + constants]);
        let by_field = self.combined(constants, z.len());
        let by_constant: Vec<Vec<f64>> = self.operators[1..]
            .iter()
            .map(|operator| operator.multiply(u))
            .collect();
        let mut jacobian = SparseRows::new(z.len());
        for row in 0..by_field.len() {
            let more = by_constant.iter().take(constants.len()).enumerate();
            let more = more.map(|(index, values)| (self.points + index, values[row]));
            jacobian.push(by_field.row(row).iter().copied().chain(more));
        }
        let mut padded = u.to_vec();
        padded.resize(z.len(), 0.0);
        Linearisation {
            values: by_field.multiply(&padded),
            jacobian,
        }
    }

    /// ∂²/∂u∂k of ψᵀ (D + k M + c G) u is Mᵀ ψ, and so on.
    fn curvature(&self, size: usize, psi: &[f64]) -> SparseRows {
        let mut rows = vec![Vec::new(); size];
        for (index, operator) in self.operators[1..]
            .iter()
            .enumerate()
            .take(size - self.points)
        {
            let constant = self.points + index;
            for (unknown, value) in operator.multiply_transposed(psi).into_iter().enumerate() {
                rows[unknown].push((constant, value));
                rows[constant].push((unknown, value));
            }
        }
        let mut curvature = SparseRows::new(size);
        rows.into_iter().for_each(|row| curvature.push(row));
        curvature
    }
}

/// Finds the constants of a motion together with the motion.
pub struct Regression {
    differences: Differences,
    settings: CorrectorSettings,
    constants: usize,
    /// Values of k that are tried first: a start that needs no guess.
    starts: Vec<f64>,
}

impl Regression {
    /// A regression of `constants` constants; k is first looked for between the slowest motion that the
    /// duration shows and the fastest that the instants resolve well.
    pub fn new(
        differences: Differences,
        step: f64,
        constants: usize,
        settings: CorrectorSettings,
    ) -> Self {
        let duration = step * (differences.points - 1) as f64;
        let spacing = std::f64::consts::PI / (2.0 * duration);
        let fastest = std::f64::consts::PI / (8.0 * step);
        let frequencies = (1..)
            .map(|i| f64::from(i) * spacing)
            .take_while(|omega| *omega < fastest);
        Self {
            starts: frequencies.map(|omega| omega * omega).collect(),
            differences,
            settings,
            constants,
        }
    }

    /// Factors of the undamped equations, one for each start.
    ///
    /// # Errors
    /// [`SolveFault`] when one cannot be factorised.
    pub fn factors(&self) -> Result<Vec<Factor>, SolveFault> {
        let zero = vec![0.0; self.differences.points];
        let factor = |k: &f64| {
            let settings = CorrectorSettings {
                solver: Solver::Cholesky,
                ..self.settings
            };
            self.differences.known(&[*k], settings).factor(&zero)
        };
        self.starts.iter().map(factor).collect()
    }

    /// The constants k, and c where it is looked for, of the motion nearest to `data`, with retained
    /// `factors`.
    ///
    /// # Errors
    /// A [`SolveFault`] when the steps do not converge.
    pub fn fit(&self, data: &[f64], factors: &mut [Factor]) -> Result<Vec<Estimate>, SolveFault> {
        let mut best = (f64::INFINITY, self.starts[0], data.to_vec());
        for (k, factor) in self.starts.iter().zip(factors) {
            let values: Vec<f64> = factor.jacobian().multiply(data);
            let projection = factor.project(&values, &vec![0.0; data.len()]);
            let step = projection?.step;
            let distance: f64 = step.iter().map(|d| d * d).sum();
            if distance < best.0 {
                let field = data.iter().zip(&step).map(|(u, d)| u + d).collect();
                best = (distance, *k, field);
            }
        }
        let corrector = self.differences.unknown(self.constants, self.settings);
        let extended = |field: &[f64], k: f64| -> Vec<f64> {
            let constants = [k, 0.0].into_iter().take(self.constants);
            field.iter().copied().chain(constants).collect()
        };
        let (data, start) = (extended(data, 0.0), extended(&best.2, best.1));
        let correction = corrector.correct(&data, &start)?;
        let first = self.differences.points;
        let estimates =
            (first..first + self.constants).map(|i| corrector.estimate(&data, &correction, i));
        estimates.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_differences_hold_for_the_exact_motion_to_their_order() {
        let motion = |points| Motion {
            stiffness: 2.0,
            damping: 0.0,
            amplitude: 1.0,
            duration: 5.0,
            points,
        };
        for (order, factor) in [(2, 4.0), (4, 16.0)] {
            let defect = |points| {
                let motion = motion(points);
                let differences = Differences::new(points, motion.step(), order);
                let residual = differences.residual(&motion.displacement(), motion.stiffness);
                residual.iter().fold(0.0, |most: f64, r| most.max(r.abs())) / motion.step().powi(2)
            };
            let ratio = defect(51) / defect(101);
            assert!(
                (ratio / factor - 1.0).abs() < 0.05,
                "order {order}: {ratio}"
            );
        }
    }

    #[test]
    fn jacobian_and_curvature_are_derivatives() {
        let (points, constants) = (12, 2);
        let differences = Differences::new(points, 0.2, 2);
        let z: Vec<f64> = (0..points + constants)
            .map(|i| (1.3 * i as f64).sin())
            .collect();
        let psi: Vec<f64> = (0..points - 2).map(|i| (0.7 * i as f64).cos()).collect();
        let direction: Vec<f64> = (0..z.len()).map(|i| (2.1 * i as f64).cos()).collect();
        let at = |step: f64| {
            let moved: Vec<f64> = z
                .iter()
                .zip(&direction)
                .map(|(z, d)| z + step * d)
                .collect();
            differences.linearise(&moved, constants)
        };
        let (up, down) = (at(1e-4), at(-1e-4));
        let close = |up: &[f64], down: &[f64], expected: &[f64]| {
            let slopes = up.iter().zip(down).map(|(up, down)| (up - down) / 2e-4);
            slopes
                .zip(expected)
                .all(|(slope, expected)| (slope - expected).abs() < 1e-8)
        };
        let jacobian = differences.linearise(&z, constants).jacobian;
        assert!(close(
            &up.values,
            &down.values,
            &jacobian.multiply(&direction)
        ));
        let curvature = differences.curvature(z.len(), &psi).multiply(&direction);
        let [up, down] = [up, down].map(|end| end.jacobian.multiply_transposed(&psi));
        assert!(close(&up, &down, &curvature));
    }
}
