//! The forms that K(·) and D(·) can take.

use nalgebra::{DMatrix, DVector};

use crate::statistics::{BSpline, Ends};

/// The form of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// One number.
    Constant,
    /// A polynomial of this degree.
    Polynomial(usize),
    /// A cubic spline on this number of equal parts, with a penalty on its roughness.
    Spline(usize),
}

impl Form {
    /// Highest degree of a polynomial, and fewest and most parts of a spline.
    const LIMITS: [usize; 3] = [6, 4, 60];

    /// Parts of a spline where none are stated: more only cost time, because the penalty keeps it smooth.
    pub const SPLINE: Self = Self::Spline(12);

    /// Reads `constant`, `polynomial-N`, `spline` or `spline-N`.
    ///
    /// # Errors
    /// [`UnknownForm`].
    pub fn parse(text: &str) -> Result<Self, UnknownForm> {
        let [degree, fewest, most] = Self::LIMITS;
        let number = |prefix: &str| text.strip_prefix(prefix)?.parse::<usize>().ok();
        match (text, number("polynomial-"), number("spline-")) {
            ("constant", ..) => Ok(Self::Constant),
            ("spline", ..) => Ok(Self::SPLINE),
            (_, Some(order), _) if (1..=degree).contains(&order) => Ok(Self::Polynomial(order)),
            (_, _, Some(parts)) if (fewest..=most).contains(&parts) => Ok(Self::Spline(parts)),
            _ => Err(UnknownForm),
        }
    }
}

/// A text that is not the name of a [`Form`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "it must be constant, polynomial-1 to polynomial-{}, spline, or spline-{} to spline-{}",
    Form::LIMITS[0], Form::LIMITS[1], Form::LIMITS[2]
)]
pub struct UnknownForm;

/// Prior knowledge of a spline's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// No prior knowledge.
    #[default]
    Free,
    /// It nowhere falls.
    Increasing,
    /// It nowhere rises.
    Decreasing,
}

impl Shape {
    /// The names that the command line uses.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("free", Self::Free),
        ("increasing", Self::Increasing),
        ("decreasing", Self::Decreasing),
    ];
}

/// A function's basis over the range of its argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// The form.
    pub form: Form,
    /// Prior knowledge of the shape.
    pub shape: Shape,
    /// The range of the argument that the data cover.
    pub range: [f64; 2],
}

impl Basis {
    /// Number of coefficients.
    pub fn count(&self) -> usize {
        match self.form {
            Form::Constant => 1,
            Form::Polynomial(degree) => degree + 1,
            Form::Spline(_) => self.spline().count(),
        }
    }

    fn spline(&self) -> BSpline {
        let intervals = match self.form {
            Form::Spline(intervals) => intervals,
            Form::Constant | Form::Polynomial(_) => 1,
        };
        BSpline::new(self.range, intervals, 3, Ends::Uniform)
    }

    /// The argument at which the powers of a polynomial are one.
    pub fn scale(&self) -> f64 {
        self.range[0].abs().max(self.range[1].abs())
    }

    /// Values (order 0) or slopes (order 1) of all functions at `x`.
    pub fn values(&self, x: f64, order: usize) -> DVector<f64> {
        let mut values = DVector::zeros(self.count());
        if let Form::Spline(_) = self.form {
            let (first, local) = self.spline().local(x, order);
            values.rows_mut(first, 4).copy_from_slice(&local[..4]);
            return values;
        }
        let s = x / self.scale();
        for power in order..self.count() {
            let exponent = i32::try_from(power - order).unwrap_or(i32::MAX);
            let slope = if order == 0 {
                1.0
            } else {
                power as f64 / self.scale()
            };
            values[power] = slope * s.powi(exponent);
        }
        values
    }

    /// The roughness of a spline, Σ (Δ³θ)², as a quadratic form; `None` for the other forms.
    pub fn roughness(&self) -> Option<DMatrix<f64>> {
        matches!(self.form, Form::Spline(_)).then(|| {
            let third = differences(self.count(), &[-1.0, 3.0, -3.0, 1.0]);
            third.transpose() * third
        })
    }

    /// The penalty that forces a spline into its shape: the square of every first difference of the wrong sign.
    pub fn violation(&self, coefficients: &[f64]) -> Option<DMatrix<f64>> {
        let sign = match self.shape {
            Shape::Free => return None,
            Shape::Increasing => 1.0,
            Shape::Decreasing => -1.0,
        };
        let mut first = differences(self.count(), &[-1.0, 1.0]);
        for (row, pair) in coefficients.windows(2).enumerate() {
            if sign * (pair[1] - pair[0]) >= 0.0 {
                first.row_mut(row).fill(0.0);
            }
        }
        Some(first.transpose() * first)
    }
}

fn differences(count: usize, stencil: &[f64]) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(count + 1 - stencil.len(), count);
    for row in 0..rows.nrows() {
        for (i, value) in stencil.iter().enumerate() {
            rows[(row, row + i)] = *value;
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_are_read_and_impossible_ones_refused() {
        assert_eq!(Form::parse("polynomial-3"), Ok(Form::Polynomial(3)));
        assert_eq!(Form::parse("spline"), Ok(Form::SPLINE));
        assert_eq!(Form::parse("spline-20"), Ok(Form::Spline(20)));
        for wrong in [
            "polynomial-0",
            "polynomial-7",
            "spline-3",
            "cubic",
            "spline-x",
        ] {
            assert!(Form::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn slopes_are_derivatives_of_values() {
        for form in [Form::Constant, Form::Polynomial(4), Form::Spline(6)] {
            let basis = Basis {
                form,
                shape: Shape::Free,
                range: [-2.0, 5.0],
            };
            for x in [-1.9, 0.1, 3.3] {
                let difference = (basis.values(x + 1e-6, 0) - basis.values(x - 1e-6, 0)) / 2e-6;
                assert!((difference - basis.values(x, 1)).amax() < 1e-8, "{form:?}");
            }
        }
    }

    #[test]
    fn parabolas_are_not_rough_and_only_wrong_differences_count() {
        let basis = Basis {
            form: Form::Spline(3),
            shape: Shape::Increasing,
            range: [0.0, 1.0],
        };
        let parabola = DVector::from_fn(6, |i, _| (i * i) as f64);
        let form = |matrix: DMatrix<f64>, at: &DVector<f64>| (at.transpose() * matrix * at)[0];
        assert!(form(basis.roughness().unwrap(), &parabola).abs() < 1e-12);
        let bent = DVector::from_vec(vec![0.0, 2.0, 1.5, 3.0, 3.0, 2.0]);
        assert!(form(basis.roughness().unwrap(), &bent) > 1.0);
        let violation = basis.violation(bent.as_slice()).unwrap();
        assert!((form(violation, &bent) - 1.25).abs() < 1e-14);
    }
}
