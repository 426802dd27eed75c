//! Cubic B-splines on 0…1 with equal spans, open at both ends.

const DEGREE: usize = 3;

/// The functions N₀ … N₍ₙ₊₂₎ of a number n of equal spans; they sum up to one, the first is one at 0, the last at 1.
///
/// # References
/// C. de Boor, A Practical Guide to Splines (1978)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spline {
    /// Number of spans.
    pub spans: usize,
}

impl Spline {
    /// Number of functions.
    pub fn functions(self) -> usize {
        self.spans + DEGREE
    }

    fn knot(self, index: usize) -> f64 {
        let span = index.saturating_sub(DEGREE).min(self.spans);
        span as f64 / self.spans as f64
    }

    fn span(self, t: f64) -> usize {
        ((t * self.spans as f64) as usize).min(self.spans - 1)
    }

    /// The derivative of an order of the functions that are not zero at `t`: function and value.
    pub fn derivatives(self, t: f64, order: usize) -> Vec<(usize, f64)> {
        let span = self.span(t);
        let functions = span..=span + DEGREE;
        let value = |function| self.derivative(function, DEGREE, order, t);
        functions
            .map(|function| (function, value(function)))
            .collect()
    }

    /// The recursion of Cox and de Boor, and that of its derivatives.
    fn derivative(self, index: usize, degree: usize, order: usize, t: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(index == self.span(t) + DEGREE));
        }
        let knot = |offset: usize| self.knot(index + offset);
        let (rise, fall) = (knot(degree) - knot(0), knot(degree + 1) - knot(1));
        let (up, down, order) = match order {
            0 => (t - knot(0), knot(degree + 1) - t, 0),
            _ => (degree as f64, -(degree as f64), order - 1),
        };
        let part = |index: usize, width: f64, factor: f64| match width > 0.0 {
            true => factor / width * self.derivative(index, degree - 1, order, t),
            false => 0.0,
        };
        part(index, rise, up) + part(index + 1, fall, down)
    }

    /// Rows r with Σ (r·q)² = ∫₀¹ f″² dt for f = Σ qₖ Nₖ.
    pub fn roughness(self) -> Vec<Vec<(usize, f64)>> {
        let width = 1.0 / self.spans as f64;
        let offset = 0.5 / 3.0_f64.sqrt();
        let places = (0..self.spans)
            .flat_map(|span| [0.5 - offset, 0.5 + offset].map(|part| (span as f64 + part) * width));
        let row = |t: f64| {
            let derivatives = self.derivatives(t, 2).into_iter();
            derivatives
                .map(|(function, value)| (function, (0.5 * width).sqrt() * value))
                .collect()
        };
        places.map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of t³ by its blossom: the product of three knots.
    fn cube(spline: Spline) -> Vec<f64> {
        let coefficient = |k: usize| (1..=DEGREE).map(|i| spline.knot(k + i)).product();
        (0..spline.functions()).map(coefficient).collect()
    }

    #[test]
    fn cubic_polynomials_and_their_roughness_are_exact() {
        for spans in [1, 2, 5] {
            let spline = Spline { spans };
            let q = cube(spline);
            for t in [0.0, 0.13, 0.5, 0.77, 1.0_f64] {
                let sum = |order: usize| -> f64 {
                    let functions = spline.derivatives(t, order).into_iter();
                    functions.map(|(k, value)| q[k] * value).sum()
                };
                assert!((sum(0) - t.powi(3)).abs() < 1e-14);
                assert!((sum(1) - 3.0 * t * t).abs() < 1e-12);
                assert!((sum(2) - 6.0 * t).abs() < 1e-11);
            }
            let rows = spline.roughness().into_iter();
            let sum: f64 = rows
                .map(|row| row.iter().map(|(k, r)| r * q[*k]).sum::<f64>().powi(2))
                .sum();
            assert!((sum - 12.0).abs() < 1e-10, "{sum}");
        }
    }

    #[test]
    fn the_end_functions_are_one_at_the_ends() {
        let spline = Spline { spans: 4 };
        let ends = [(0.0, 0), (1.0, spline.functions() - 1)];
        for (t, function) in ends {
            let values = spline.derivatives(t, 0);
            assert!(
                values
                    .iter()
                    .all(|(k, value)| *value == f64::from(u8::from(*k == function)))
            );
        }
    }
}
