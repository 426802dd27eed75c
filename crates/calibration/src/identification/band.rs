//! The uncertainty of an identified function.
//!
//! With the penalty taken as prior knowledge of the function, its coefficients have the covariance s² (A + P)⁻¹,
//! which includes the bias of the penalty. Intervals are valid at one argument; the band is valid at all arguments of
//! both functions together: its half width is c standard errors with
//!
//! ```text
//! Σ [κ/π (1 + c²/ν)^(−ν/2) + P(|t_ν| > c)] = 5 %        κ = ∫ ‖d(l/‖l‖)/dx‖ dx,  l lᵀ = b(x)ᵀ Cov b(x)
//! ```
//!
//! # References
//! D. Nychka, J. Am. Stat. Assoc. 83, 1134 (1988), doi:10.1080/01621459.1988.10478711;
//! J. Sun, C. R. Loader, Ann. Stat. 22, 1328 (1994), doi:10.1214/aos/1176325631

use nalgebra::{DMatrix, DVector};

use super::basis::{Basis, Form};
use crate::statistics::{Estimate, bisect, larger, student_reach, student_tail};

/// An identified function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its basis.
    pub basis: Basis,
    /// Its coefficients.
    pub coefficients: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Effective number of coefficients.
    pub degrees: f64,
    /// Half widths in standard errors: of the 95 % interval at one argument and of the 95 % band.
    pub reach: [f64; 2],
}

impl Function {
    /// Coefficients of a constant or a polynomial in powers of x, with their uncertainty.
    pub fn powers(&self) -> Vec<Estimate> {
        let scale = self.basis.scale();
        let estimate = |power: usize| {
            let unit = scale.powi(-i32::try_from(power).unwrap_or(i32::MAX));
            let value = self.coefficients[power] * unit;
            let standard_error = larger(self.covariance[(power, power)], 0.0).sqrt() * unit;
            self.estimate(value, standard_error)
        };
        match self.basis.form {
            Form::Spline(_) => Vec::new(),
            Form::Constant | Form::Polynomial(_) => (0..self.basis.count()).map(estimate).collect(),
        }
    }

    /// Removes standard errors, intervals and bands, which are meaningless where the recording is not explained.
    pub fn withhold_intervals(&mut self) {
        self.covariance.fill(f64::NAN);
        self.reach = [f64::NAN; 2];
    }

    fn estimate(&self, value: f64, standard_error: f64) -> Estimate {
        Estimate::new(value, standard_error, self.reach[0])
    }

    /// The value at `x` with its standard error and its 95 % interval at this argument alone.
    pub fn at(&self, x: f64) -> Estimate {
        let value = self.coefficients.dot(&self.basis.values(x, 0));
        self.estimate(value, larger(self.product(x, x), 0.0).sqrt())
    }

    /// The 95 % band at `x`, which is valid at all arguments of both functions together.
    pub fn band(&self, x: f64) -> [f64; 2] {
        let at = self.at(x);
        [-1.0, 1.0].map(|sign| at.value + sign * self.reach[1] * at.standard_error)
    }

    /// Evenly spaced arguments over the range of the data.
    pub fn positions(&self, count: usize) -> Vec<f64> {
        let [low, high] = self.basis.range;
        let position = |i: usize| low + (high - low) * i as f64 / (count - 1) as f64;
        (0..count).map(position).collect()
    }

    fn product(&self, x: f64, y: f64) -> f64 {
        let [x, y] = [x, y].map(|position| self.basis.values(position, 0));
        x.dot(&(&self.covariance * y))
    }

    /// κ: the length of the curve of unit vectors that the function's errors follow.
    fn length(&self) -> f64 {
        const STEPS: usize = 400;
        let positions = self.positions(STEPS + 1);
        let angle = |pair: &[f64]| {
            let squares = self.product(pair[0], pair[0]) * self.product(pair[1], pair[1]);
            let cosine = self.product(pair[0], pair[1]) / squares.sqrt();
            (2.0 - 2.0 * cosine).max(0.0).sqrt()
        };
        positions.windows(2).map(angle).sum()
    }
}

/// Half widths of interval and band in standard errors.
pub fn reach(functions: &[Function; 2], freedom: f64) -> Option<[f64; 2]> {
    const MISSED: f64 = 0.05;
    let point = student_reach(freedom);
    if point.is_nan() {
        return None;
    }
    let lengths = functions.each_ref().map(Function::length);
    let missed = |c: f64| -> f64 {
        let tube = (1.0 + c * c / freedom).powf(-0.5 * freedom) / std::f64::consts::PI;
        lengths
            .iter()
            .map(|length| length * tube + 2.0 * student_tail(freedom, c))
            .sum()
    };
    let [_, band] = bisect([1.0, 40.0], 100, |c| missed(c) > MISSED);
    Some([point, band])
}
