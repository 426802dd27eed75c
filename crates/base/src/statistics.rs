//! Statistics, each formula written once: quantiles and tail probabilities, estimates with their intervals, robust measures of
//! scale, the inverse of normal matrices, B-splines, noise that correlates with distance or along curves.

use nalgebra::{Cholesky, DMatrix, Dyn};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use statrs::distribution::{Beta, ChiSquared, ContinuousCDF, FisherSnedecor, Normal, StudentsT};

mod correlated_regression;
mod correlation;
mod curve;
mod curve_noise;
mod durbin_watson;
mod growing_noise;
mod neighbours;
mod normal_equations;
mod random_effects;
mod ranks;
mod spline;
mod unevenness;

pub use correlated_regression::{CorrelatedNoise, CorrelatedRegression, WhiteRegression};
pub use correlation::{Correlation, Decay, Sites, Whitening};
pub use curve::Curve;
pub use curve_noise::{CurveNoise, CurveResiduals};
pub use durbin_watson::DurbinWatson;
pub use growing_noise::sizes as growing_sizes;
pub use neighbours::nearest;
pub use normal_equations::normal_equations;
pub use random_effects::RandomEffects;
pub use ranks::{quantile, rank_correlation};
pub use spline::{BSpline, Ends, LocalValues, MOST_FUNCTIONS};
pub use unevenness::Unevenness;

/// The least and the largest of some values; `[∞, −∞]` where there are none.
pub fn extremes(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY];
    let values = values.into_iter();
    values.fold(start, |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// What so many halvings leave of an interval, at whose first end a condition holds and at whose second one it does not.
pub fn bisect(ends: [f64; 2], halvings: usize, holds: impl Fn(f64) -> bool) -> [f64; 2] {
    (0..halvings).fold(ends, |[first, second], _| {
        let middle = 0.5 * (first + second);
        if holds(middle) {
            [middle, second]
        } else {
            [first, middle]
        }
    })
}

/// The value of the largest magnitude, with its sign; zero where there are none. NaN is ignored.
pub fn farthest(values: impl IntoIterator<Item = f64>) -> f64 {
    let farther = |most: f64, value: f64| {
        if value.abs() > most.abs() {
            value
        } else {
            most
        }
    };
    values.into_iter().fold(0.0, farther)
}

/// A small probability as text; one that is too small for a normal number is given as an upper bound.
pub fn small_probability(probability: f64) -> String {
    if probability < f64::MIN_POSITIVE {
        format!("less than {:.0e}", f64::MIN_POSITIVE)
    } else {
        format!("{probability:.0e}")
    }
}

/// An estimated value with its uncertainty, in the unit of the value.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// The 95 % confidence interval.
    pub interval: [f64; 2],
}

impl Estimate {
    /// An estimate whose interval reaches `reach` standard errors to either side.
    pub fn new(value: f64, standard_error: f64, reach: f64) -> Self {
        let half = reach * standard_error;
        Self {
            value,
            standard_error,
            interval: [value - half, value + half],
        }
    }

    /// The standard deviation of a normal distribution with its interval, which reaches farther than 1.96 standard errors where data
    /// are few.
    pub fn normal_deviation(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0]) / normal_reach()
    }

    /// Whether its interval holds a value.
    pub fn holds(&self, value: f64) -> bool {
        let [low, high] = self.interval;
        (low..=high).contains(&value)
    }

    /// The estimate with the end of its interval moved on the side of `by`.
    #[must_use]
    pub fn widened(mut self, by: f64) -> Self {
        let end = usize::from(by >= 0.0);
        self.interval[end] += by;
        self
    }

    /// The estimate of a value that falls as much as another may be larger than assumed, by a share; one without uncertainty stays.
    #[must_use]
    pub fn lower_by(self, growth: f64) -> Self {
        let [low, high] = self.interval;
        if low < high {
            self.widened(self.value / (1.0 + growth) - self.value)
        } else {
            self
        }
    }

    /// A value without uncertainty.
    pub fn exact(value: f64) -> Self {
        Self::new(value, 0.0, 0.0)
    }
}

/// Half the width of a 95 % interval in standard errors where the noise is known.
pub fn normal_reach() -> f64 {
    Normal::standard().inverse_cdf(0.975)
}

/// The quantile of the standard normal distribution for a probability.
pub fn normal_quantile(probability: f64) -> f64 {
    Normal::standard().inverse_cdf(probability)
}

/// Independent standard normal numbers, the same on every machine and in every run for one seed.
pub fn normal_numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    move || -> f64 { StandardNormal.sample(&mut random) }
}

/// P(|z| > x) for a standard normal number z.
pub fn normal_tail(x: f64) -> f64 {
    2.0 * Normal::standard().sf(x.abs())
}

/// Half the width of a 95 % interval in standard errors where the noise is estimated with so many degrees of freedom;
/// NaN where there are none.
pub fn student_reach(freedom: f64) -> f64 {
    student(freedom, |law| law.inverse_cdf(0.975))
}

/// P(t > x) for Student's t with so many degrees of freedom; NaN where there are none.
pub fn student_tail(freedom: f64, x: f64) -> f64 {
    student(freedom, |law| law.sf(x))
}

fn student(freedom: f64, value: impl Fn(StudentsT) -> f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, value)
}

/// P(F > ratio) for the ratio of two variances with so many degrees of freedom; NaN where either has none, or where both variances are zero.
pub fn f_tail(freedoms: [f64; 2], ratio: f64) -> f64 {
    match FisherSnedecor::new(freedoms[0], freedoms[1]) {
        Ok(law) if ratio.is_finite() => law.sf(ratio),
        Ok(_) if ratio == f64::INFINITY => 0.0,
        _ => f64::NAN,
    }
}

/// The value that χ² with so many degrees of freedom exceeds with a probability; NaN where there are none.
pub fn chi_squared_limit(freedom: f64, probability: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |law| law.inverse_cdf(1.0 - probability))
}

/// Cochran's Q of values with their variances, Σ (p − p̄)²/s² about their weighted mean p̄: χ² with one degree of freedom fewer than
/// values where all are equal except for their errors.
pub fn cochran(values: &[[f64; 2]]) -> f64 {
    let weight: f64 = values.iter().map(|[_, variance]| 1.0 / variance).sum();
    let mean = values
        .iter()
        .map(|[value, variance]| value / variance)
        .sum::<f64>()
        / weight;
    let square = |[value, variance]: &[f64; 2]| (value - mean).powi(2) / variance;
    values.iter().map(square).sum()
}

/// The corrected Akaike information criterion, −2 ln L + 2k + 2k(k + 1)/(n − k − 1), of k fitted values and n independent ones; infinite
/// where there are too few.
///
/// # References
/// C. M. Hurvich, C.-L. Tsai, Biometrika 76, 297 (1989), doi:10.1093/biomet/76.2.297
pub fn corrected_akaike_criterion(deviance: f64, k: f64, n: f64) -> f64 {
    let freedom = n - k - 1.0;
    if freedom > 0.0 {
        deviance + 2.0 * k + 2.0 * k * (k + 1.0) / freedom
    } else {
        f64::INFINITY
    }
}

/// P(b ≤ x) for a number b with the beta distribution of these shapes; NaN where the shapes are invalid.
pub fn beta_cumulated(shapes: [f64; 2], x: f64) -> f64 {
    Beta::new(shapes[0], shapes[1]).map_or(f64::NAN, |law| law.cdf(x))
}

/// The larger of two numbers; NaN where one of them is NaN.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// The median, the upper one of the middle two; NaN without values.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    let middle = values.len() / 2;
    if values.is_empty() {
        f64::NAN
    } else {
        *values.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// The standard deviation of each component of normal noise in a plane, from the median of its lengths, which gross
/// errors hardly affect: the median of χ² with two degrees of freedom is 2 ln 2.
pub fn robust_deviation(lengths: impl IntoIterator<Item = f64>) -> f64 {
    let squares = lengths.into_iter().map(|length| length * length);
    (median(squares) / (2.0 * std::f64::consts::LN_2)).sqrt()
}

/// The inverse of a positive definite matrix, computed with the matrix scaled to a unit diagonal; `None` where a pivot of the
/// scaled matrix is below `least`.
pub fn inverse(matrix: &DMatrix<f64>, least: f64) -> Option<DMatrix<f64>> {
    let scales = matrix.diagonal().map(|entry| entry.sqrt().recip());
    if scales.iter().any(|scale| !scale.is_finite()) {
        return None;
    }
    let scaled =
        |matrix: &DMatrix<f64>| matrix.map_with_location(|i, j, x| scales[i] * x * scales[j]);
    let factor = scaled(matrix).cholesky()?;
    let pivots = factor.l_dirty().diagonal();
    let determined = pivots.iter().all(|pivot| *pivot >= least);
    determined.then(|| scaled(&inverse_of(&factor)))
}

/// M⁻¹ = L⁻ᵀL⁻¹ from the factor M = LLᵀ, a third of the time of a solution for every unit vector.
pub fn inverse_of(factor: &Cholesky<f64, Dyn>) -> DMatrix<f64> {
    let lower = factor.l_dirty();
    let count = lower.nrows();
    let mut inverse = DMatrix::identity(count, count);
    for column in 0..count {
        let rest = count - column;
        let block = lower.view((column, column), (rest, rest));
        let mut below = inverse.view_mut((column, column), (rest, 1));
        block.solve_lower_triangular_unchecked_mut(&mut below);
    }
    inverse.transpose() * inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_probability_is_told_as_zero() {
        assert_eq!(small_probability(3.4e-12), "3e-12");
        assert_eq!(small_probability(0.0), "less than 2e-308");
    }

    #[test]
    fn only_intervals_become_wider() {
        let lower = Estimate::new(2.0, 0.1, 2.0).lower_by(0.25);
        assert!((lower.interval[0] - 1.4).abs() < 1e-12 && lower.interval[1] == 2.2);
        assert_eq!(Estimate::exact(2.0).lower_by(0.25), Estimate::exact(2.0));
    }

    /// Tables of Student, F and χ² at their usual levels.
    #[test]
    fn quantiles_are_those_of_the_tables() {
        assert!((normal_reach() - 1.959_964).abs() < 1e-6);
        assert!((student_reach(10.0) - 2.228_139).abs() < 1e-6);
        assert!((student_tail(10.0, 2.228_139) - 0.025).abs() < 1e-6);
        assert!((f_tail([3.0, 20.0], 3.098_391) - 0.05).abs() < 1e-6);
        assert!(
            f_tail([3.0, 20.0], f64::NAN).is_nan() && f_tail([3.0, 20.0], f64::INFINITY) == 0.0
        );
        assert!((chi_squared_limit(2.0, 0.05) - 5.991_465).abs() < 1e-6);
        assert!(student_reach(0.0).is_nan() && chi_squared_limit(0.0, 0.1).is_nan());
    }

    #[test]
    fn the_median_is_the_upper_one_of_the_middle_two() {
        assert_eq!(median([3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median([4.0, 1.0, 3.0, 2.0]), 3.0);
        assert!(median([]).is_nan());
    }

    #[test]
    fn inverses_of_badly_scaled_matrices_are_exact_and_singular_ones_refused() {
        let matrix = DMatrix::from_row_slice(2, 2, &[4e12, 1.0, 1.0, 1e-12]);
        let unit = inverse(&matrix, 1e-7).unwrap() * &matrix;
        assert!((unit - DMatrix::identity(2, 2)).amax() < 1e-3);
        let singular = DMatrix::from_row_slice(2, 2, &[1.0, 1.0, 1.0, 1.0]);
        assert!(inverse(&singular, 1e-7).is_none());
        assert!(inverse(&-matrix, 1e-7).is_none());
    }
}
