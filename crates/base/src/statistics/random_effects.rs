//! The mean of several specimens, each of which is known with an uncertainty.
//!
//! ```text
//! yᵢ = μ + bᵢ + eᵢ,   bᵢ ~ N(0, τ²),   eᵢ ~ N(0, sᵢ²),   Σ wᵢ (yᵢ − μ)² = n − 1,   wᵢ = 1/(sᵢ² + τ²)
//! ```
//!
//! # References
//! R. C. Paule, J. Mandel, J. Res. Natl. Bur. Stand. 87, 377 (1982), doi:10.6028/jres.087.022 (τ);
//! G. Knapp, J. Hartung, Stat. Med. 22, 2693 (2003), doi:10.1002/sim.1482 (the interval of μ, with n − 1 degrees of freedom)

use super::{Estimate, bisect, student_reach};

/// The mean of some specimens and their spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomEffects {
    /// μ with its standard error.
    pub mean: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// The degrees of freedom of the standard error.
    pub freedom: f64,
    /// τ, the standard deviation between specimens.
    pub between: f64,
}

impl RandomEffects {
    /// Of values with their standard errors; `None` of fewer than two.
    pub fn new(values: &[[f64; 2]]) -> Option<Self> {
        const HALVINGS: usize = 100;
        /// The least variance: sums of its inverse are finite.
        const LEAST: f64 = 1e-200;
        let freedom = values.len().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
        let plain = values.iter().map(|[y, _]| y).sum::<f64>() / values.len() as f64;
        let scatter: f64 = values.iter().map(|[y, _]| (y - plain).powi(2)).sum();
        let at = |variance: f64| {
            let weight = |error: f64| 1.0 / (error * error + variance).max(LEAST);
            let sum: f64 = values.iter().map(|[_, error]| weight(*error)).sum();
            let mean = values.iter().map(|[y, s]| weight(*s) * y).sum::<f64>() / sum;
            let square = values.iter().map(|[y, s]| weight(*s) * (y - mean).powi(2));
            (mean, sum, square.sum::<f64>())
        };
        // The weighted sum of squares falls as τ grows, and is below n − 1 where τ² is all of the scatter.
        let [_, high] = bisect([0.0, 2.0 * scatter], HALVINGS, |variance| {
            at(variance).2 > freedom
        });
        let (mean, sum, square) = at(high);
        Some(Self {
            mean,
            standard_error: ((square / freedom).max(1.0) / sum).sqrt(),
            freedom,
            between: high.sqrt(),
        })
    }

    /// μ with its 95 % interval.
    pub fn estimate(&self) -> Estimate {
        let reach = student_reach(self.freedom);
        Estimate::new(self.mean, self.standard_error, reach)
    }

    /// By how much the mean of others is larger, with the degrees of freedom of Welch and Satterthwaite.
    pub fn difference(&self, other: &Self) -> Estimate {
        let squares = [self, other].map(|effects| effects.standard_error.powi(2));
        let sum: f64 = squares.iter().sum();
        let parts = squares[0].powi(2) / self.freedom + squares[1].powi(2) / other.freedom;
        let reach = if parts > 0.0 {
            student_reach(sum * sum / parts)
        } else {
            0.0
        };
        Estimate::new(other.mean - self.mean, sum.sqrt(), reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::normal_numbers;

    /// Values that are known exactly have the mean and the standard deviation of any sample.
    #[test]
    fn values_without_errors_are_a_sample() {
        let effects = RandomEffects::new(&[[1.0, 0.0], [2.0, 0.0], [6.0, 0.0]]).unwrap();
        let deviation = 7.0_f64.sqrt();
        assert!((effects.mean - 3.0).abs() < 1e-12 && (effects.between - deviation).abs() < 1e-9);
        assert!((effects.standard_error - deviation / 3.0_f64.sqrt()).abs() < 1e-9);
        assert_eq!(RandomEffects::new(&[[1.0, 0.1]]), None);
        for number in 2..9 {
            let equal = RandomEffects::new(&vec![[0.5, 0.0]; number]).unwrap();
            assert!((equal.mean - 0.5).abs() < 1e-12 && equal.between == 0.0);
        }
    }

    /// Specimens that do not differ have the weighted mean of their errors.
    #[test]
    fn specimens_that_agree_have_no_spread() {
        let effects = RandomEffects::new(&[[1.0, 0.1], [1.1, 0.2], [0.95, 0.1]]).unwrap();
        let [w, mean] = [100.0 + 25.0 + 100.0, (100.0 + 27.5 + 95.0) / 225.0];
        assert!(effects.between < 1e-9 && (effects.mean - mean).abs() < 1e-12);
        assert!((effects.standard_error - 1.0 / f64::sqrt(w)).abs() < 1e-12);
    }

    /// Six specimens a group whose errors are a third of their spread to twice as large: the intervals hold the right mean and difference in 90
    /// to 98 % of 2,000 cases.
    #[test]
    fn intervals_hold_mean_and_difference() {
        let mut normal = normal_numbers(1);
        let mut group = |mean: f64| {
            let one = |number: u8| {
                let error = 0.1 + 0.1 * f64::from(number);
                [mean + 0.3 * normal() + error * normal(), error]
            };
            RandomEffects::new(&(0..6).map(one).collect::<Vec<_>>()).unwrap()
        };
        let mut held = [0; 2];
        for _ in 0..2000 {
            let (first, second) = (group(1.0), group(1.5));
            let pairs = [(first.estimate(), 1.0), (first.difference(&second), 0.5)];
            for (held, (estimate, right)) in held.iter_mut().zip(pairs) {
                *held += usize::from(estimate.holds(right));
            }
        }
        assert!(
            held.iter().all(|held| (1800..=1960).contains(held)),
            "{held:?}"
        );
    }
}
