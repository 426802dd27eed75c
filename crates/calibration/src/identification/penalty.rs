//! The smoothness of K(·) and D(·): penalties on their roughness, chosen by generalised cross-validation.

use nalgebra::{DMatrix, DVector};

use super::basis::{Basis, Shape};
use crate::statistics::inverse;

/// Normal equations of the coefficients of K(·) and D(·).
#[derive(Clone, Debug)]
pub struct NormalEquations {
    /// A = Jᵀ J, over the noise.
    pub information: DMatrix<f64>,
    /// b = Jᵀ r.
    pub gradient: DVector<f64>,
    /// The residual ‖r‖² after the motion has moved.
    pub sum: f64,
}

/// Weights of the penalties of K(·) and D(·), as decimal exponents of their shares in the information.
pub type Exponents = [f64; 2];

/// The range of the exponents, and their steps.
const RANGE: [f64; 2] = [-6.0, 8.0];
const STEP: f64 = 0.5;

/// The weight of a coefficient in cross-validation: a little more than one, because cross-validation is prone to rough functions.
///
/// # References
/// Y.-J. Kim, C. Gu, J. R. Stat. Soc. B 66, 337 (2004), doi:10.1046/j.1369-7412.2003.05316.x
const INFLATION: f64 = 1.4;

/// Added to the exponent of least cross-validation: a tenth of that weight keeps the bias of the penalty small
/// compared with the standard errors, so that intervals are valid.
///
/// # References
/// P. Hall, Ann. Stat. 20, 675 (1992), doi:10.1214/aos/1176348651
const UNDERSMOOTHING: f64 = -1.0;

/// The least pivot of a matrix scaled to a unit diagonal.
const LEAST_PIVOT: f64 = 1e-7;

/// Weight of the constraint on a spline's shape, relative to its share in the information.
const SHAPE_WEIGHT: f64 = 1e6;

/// A minimum of the penalised sum of squares.
#[derive(Clone, Debug)]
pub struct PenalisedFit {
    /// The coefficients.
    pub coefficients: DVector<f64>,
    /// The penalty as a quadratic form.
    pub penalty: DMatrix<f64>,
    /// (A + P)⁻¹.
    pub inverse: DMatrix<f64>,
    /// Effective number of coefficients of either function.
    pub degrees: [f64; 2],
    /// The remaining sum of squares.
    pub sum: f64,
}

impl NormalEquations {
    /// Normal equations without data.
    pub fn new(count: usize) -> Self {
        Self {
            information: DMatrix::zeros(count, count),
            gradient: DVector::zeros(count),
            sum: 0.0,
        }
    }

    /// Adds an observation: its derivatives and its residual.
    pub fn add(&mut self, row: &DVector<f64>, residual: f64) {
        self.information.ger(1.0, row, row, 1.0);
        self.gradient.axpy(residual, row, 1.0);
        self.sum += residual * residual;
    }

    /// The minimum near `from` with given penalties; `None` where the data do not determine it.
    pub fn minimum(
        &self,
        from: &DVector<f64>,
        functions: &[Basis; 2],
        exponents: Exponents,
    ) -> Option<PenalisedFit> {
        /// Most changes of the set of differences with the wrong sign; more mean a cycle.
        const MOST: usize = 40;
        let mut result = self.solve(from, from, functions, exponents)?;
        for _ in 0..MOST {
            if functions.iter().all(|basis| basis.shape == Shape::Free) {
                break;
            }
            let next = self.solve(from, &result.coefficients, functions, exponents)?;
            let moved = (&next.coefficients - &result.coefficients).amax();
            result = next;
            if moved <= 1e-9 * result.coefficients.amax() {
                break;
            }
        }
        Some(result)
    }

    /// A minimum with the shapes enforced where the coefficients `shaped` violate them.
    fn solve(
        &self,
        from: &DVector<f64>,
        shaped: &DVector<f64>,
        functions: &[Basis; 2],
        exponents: Exponents,
    ) -> Option<PenalisedFit> {
        let size = from.len();
        let mut penalty = DMatrix::zeros(size, size);
        let mut first = 0;
        for (basis, exponent) in functions.iter().zip(exponents) {
            let count = basis.count();
            let trace = self
                .information
                .view((first, first), (count, count))
                .trace();
            let mut block = penalty.view_mut((first, first), (count, count));
            if let Some(roughness) = basis.roughness() {
                block += &roughness * (10f64.powf(exponent) * trace / roughness.trace());
            }
            if let Some(violation) =
                basis.violation(shaped.rows(first, count).into_owned().as_slice())
            {
                block += violation * (SHAPE_WEIGHT * trace / count as f64);
            }
            first += count;
        }
        let inverse = inverse(&(&self.information + &penalty), LEAST_PIVOT)?;
        let coefficients = &inverse * (&self.gradient + &self.information * from);
        let step = &coefficients - from;
        let sum =
            self.sum - 2.0 * step.dot(&self.gradient) + step.dot(&(&self.information * &step));
        let split = functions[0].count();
        let hat = &inverse * &self.information;
        let degrees = [(0, split), (split, size - split)]
            .map(|(first, count)| hat.view((first, first), (count, count)).trace());
        Some(PenalisedFit {
            coefficients,
            penalty,
            inverse,
            degrees,
            sum,
        })
    }

    /// The exponents of least (‖r‖²/N)/(1 − (m + γ p)/N)², γ = 1.4, for N observations, p effective coefficients of the functions, and m
    /// `others` of the motion, one function after the other; less [`UNDERSMOOTHING`].
    pub fn choose(
        &self,
        from: &DVector<f64>,
        functions: &[Basis; 2],
        [observations, others]: [f64; 2],
    ) -> Exponents {
        const SWEEPS: usize = 3;
        let score = |exponents: Exponents| -> f64 {
            let Some(result) = self.minimum(from, functions, exponents) else {
                return f64::INFINITY;
            };
            let used = others + INFLATION * result.degrees.iter().sum::<f64>();
            result.sum / (1.0 - used / observations).powi(2)
        };
        let mut best = (score([0.0; 2]), [0.0; 2]);
        for _ in 0..SWEEPS {
            let before = best.1;
            for (index, function) in functions.iter().enumerate() {
                if function.roughness().is_none() {
                    continue;
                }
                let steps = ((RANGE[1] - RANGE[0]) / STEP) as usize;
                for step in 0..=steps {
                    let mut exponents = best.1;
                    exponents[index] = RANGE[0] + STEP * step as f64;
                    let value = score(exponents);
                    if value < best.0 {
                        best = (value, exponents);
                    }
                }
            }
            if best.1 == before {
                break;
            }
        }
        best.1.map(|exponent| exponent + UNDERSMOOTHING)
    }
}
