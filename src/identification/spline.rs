//! Uniform B-splines.

/// The highest degree in use.
pub const MOST: usize = 5;

/// Values of the functions that are not zero at a place; those behind `degree` are zero.
pub type Local = [f64; MOST + 1];

/// B-splines of one degree on equal intervals, also at the ends, where they reach beyond the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformSpline {
    low: f64,
    width: f64,
    intervals: usize,
    degree: usize,
}

impl UniformSpline {
    /// Splines of `degree` (at most [`MOST`]) on `intervals` equal parts of a range.
    pub fn new([low, high]: [f64; 2], intervals: usize, degree: usize) -> Self {
        assert!(
            degree <= MOST && intervals > 0,
            "a spline of degree {degree}"
        );
        Self {
            low,
            width: (high - low) / intervals as f64,
            intervals,
            degree,
        }
    }

    /// Number of functions.
    pub fn count(&self) -> usize {
        self.intervals + self.degree
    }

    /// The first function that is not zero at `x`, and the derivatives of some order of it and the next ones; beyond
    /// the range the outermost polynomials go on.
    ///
    /// ```text
    /// Bⱼ,q = (s + q − i)/q Bⱼ₋₁,q₋₁ + (i + 1 − s)/q Bⱼ,q₋₁     interval k, s ∈ [0, 1] within it, i = j − k
    /// B′ⱼ,q = (Bⱼ₋₁,q₋₁ − Bⱼ,q₋₁)/h
    /// ```
    pub fn local(&self, x: f64, order: usize) -> (usize, Local) {
        let place = (x - self.low) / self.width;
        let interval = (place.floor().max(0.0) as usize).min(self.intervals - 1);
        let s = place - interval as f64;
        let mut values = [0.0; MOST + 1];
        if order > self.degree {
            return (interval, values);
        }
        values[0] = 1.0;
        for q in 1..=self.degree {
            let differentiate = q > self.degree - order;
            for i in (0..=q).rev() {
                let before = if i == 0 { 0.0 } else { values[i - 1] };
                let own = if i == q { 0.0 } else { values[i] };
                values[i] = if differentiate {
                    (before - own) / self.width
                } else {
                    ((s + (q - i) as f64) * before + ((i + 1) as f64 - s) * own) / q as f64
                };
            }
        }
        (interval, values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_sum_up_to_one_and_reproduce_their_derivatives() {
        for degree in [1, 3, 5] {
            let spline = UniformSpline::new([-1.0, 2.0], 7, degree);
            for x in [-1.2, -1.0, -0.3, 0.77, 1.999, 2.0, 2.1] {
                let sum = |order| spline.local(x, order).1.iter().sum::<f64>();
                assert!((sum(0) - 1.0).abs() < 1e-13 && sum(1).abs() < 1e-11);
                for order in 0..degree.min(2) {
                    let [(from, up), (_, down), (_, slope)] =
                        [(x + 1e-6, order), (x - 1e-6, order), (x, order + 1)]
                            .map(|(x, order)| spline.local(x, order));
                    if spline.local(x - 1e-6, 0).0 != from {
                        continue;
                    }
                    for i in 0..=degree {
                        let difference = (up[i] - down[i]) / 2e-6;
                        assert!((difference - slope[i]).abs() < 1e-6 * (1.0 + slope[i].abs()));
                    }
                }
            }
        }
    }

    #[test]
    fn straight_lines_are_reproduced() {
        let spline = UniformSpline::new([0.0, 4.0], 4, 3);
        let line = |x: f64| -> f64 {
            let (first, values) = spline.local(x, 0);
            // Function j has its middle at j − 1.
            (0..4).map(|i| values[i] * ((first + i) as f64 - 1.0)).sum()
        };
        for x in [0.0, 0.4, 2.5, 4.0] {
            assert!((line(x) - x).abs() < 1e-13);
        }
    }
}
