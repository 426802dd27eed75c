//! The displacement in a subset: a polynomial about its centre.

use nalgebra::{Matrix2, Vector2};

/// The degree of the displacement in a subset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// Displacement and its gradient.
    #[default]
    Affine,
    /// Its second derivatives too.
    Quadratic,
}

impl Order {
    /// Their names.
    pub const NAMES: [(&'static str, Self); 2] =
        [("affine", Self::Affine), ("quadratic", Self::Quadratic)];

    /// Number of functions φ.
    pub fn functions(self) -> usize {
        match self {
            Self::Affine => 3,
            Self::Quadratic => 6,
        }
    }
}

/// The degree of each function φ.
pub(super) const DEGREES: [i32; 6] = [0, 1, 1, 2, 2, 2];

/// 1, x, y, x², xy, y².
#[inline]
pub(super) fn functions(x: f64, y: f64) -> [f64; 6] {
    [1.0, x, y, x * x, x * y, y * y]
}

/// u(d) = Σ pₖ φₖ(d) in pixels, d the distance from the subset's centre in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Warp {
    /// p₀ … p₅ by x and y.
    pub terms: [[f64; 2]; 6],
}

impl Warp {
    /// A displacement and its gradient ∂u/∂X.
    pub fn affine(displacement: [f64; 2], gradient: Matrix2<f64>) -> Self {
        let mut terms = [[0.0; 2]; 6];
        terms[0] = displacement;
        terms[1] = gradient.column(0).into_owned().into();
        terms[2] = gradient.column(1).into_owned().into();
        Self { terms }
    }

    /// The displacement at the centre.
    pub fn displacement(&self) -> [f64; 2] {
        self.terms[0]
    }

    /// F = 1 + ∂u/∂X at the centre.
    pub fn deformation_gradient(&self) -> Matrix2<f64> {
        Matrix2::identity()
            + Matrix2::from_columns(&[Vector2::from(self.terms[1]), Vector2::from(self.terms[2])])
    }

    /// ∂u/∂X at the centre.
    pub fn gradient(&self) -> Matrix2<f64> {
        self.deformation_gradient() - Matrix2::identity()
    }

    /// The number of functions that it is made of.
    pub fn functions(&self) -> usize {
        if self.terms[3..].iter().flatten().any(|term| *term != 0.0) {
            Order::Quadratic.functions()
        } else {
            Order::Affine.functions()
        }
    }

    /// The quadratic displacement that takes given values, in pixels, on three by three points about the centre: `value` gives them by steps of `half` to
    /// the right and down.
    pub fn sampled(half: f64, value: impl Fn(f64, f64) -> [f64; 2]) -> Self {
        let at = |x: f64, y: f64| Vector2::from(value(x, y));
        let [middle, left, right] = [at(0.0, 0.0), at(-1.0, 0.0), at(1.0, 0.0)];
        let [up, down] = [at(0.0, -1.0), at(0.0, 1.0)];
        let twist = at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0);
        let terms = [
            middle,
            (right - left) / (2.0 * half),
            (down - up) / (2.0 * half),
            (right + left - 2.0 * middle) / (2.0 * half * half),
            twist / (4.0 * half * half),
            (down + up - 2.0 * middle) / (2.0 * half * half),
        ];
        Self {
            terms: terms.map(Into::into),
        }
    }

    /// The displacement at a distance from the centre, with so many functions.
    #[inline]
    pub fn at(&self, x: f64, y: f64, count: usize) -> [f64; 2] {
        let values = functions(x, y);
        let mut sum = [0.0; 2];
        for (term, value) in self.terms.iter().zip(values).take(count) {
            sum[0] += term[0] * value;
            sum[1] += term[1] * value;
        }
        sum
    }

    /// The same field about another centre, as an affine one.
    pub fn moved(&self, x: f64, y: f64) -> Self {
        let slope = |along: usize| {
            let [a, b, c] = [self.terms[3], self.terms[4], self.terms[5]];
            let second = |axis: usize| match along {
                0 => 2.0 * a[axis] * x + b[axis] * y,
                _ => b[axis] * x + 2.0 * c[axis] * y,
            };
            [0, 1].map(|axis| self.terms[1 + along][axis] + second(axis))
        };
        let mut terms = [[0.0; 2]; 6];
        terms[0] = self.at(x, y, 6);
        (terms[1], terms[2]) = (slope(0), slope(1));
        Self { terms }
    }

    /// A field of an image that is larger by a factor.
    pub fn scaled(&self, factor: f64) -> Self {
        let mut terms = self.terms;
        for (term, degree) in terms.iter_mut().zip(DEGREES) {
            *term = term.map(|value| value * factor.powi(1 - degree));
        }
        Self { terms }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_field_is_found_from_its_samples() {
        let truth = Warp {
            terms: [
                [3.0, -1.0],
                [0.1, 0.02],
                [-0.3, 0.2],
                [1e-3, -2e-3],
                [4e-3, 0.0],
                [0.0, 5e-3],
            ],
        };
        let half = 8.0;
        let sampled = Warp::sampled(half, |x, y| truth.at(half * x, half * y, 6));
        for (computed, term) in sampled
            .terms
            .iter()
            .flatten()
            .zip(truth.terms.iter().flatten())
        {
            assert!((computed - term).abs() < 1e-14);
        }
        assert_eq!((sampled.functions(), Warp::default().functions()), (6, 3));
    }
}
