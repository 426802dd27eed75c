//! A function of one number, for the stiffness K(·) of springs and the damping D(·) of dashpots.

use std::fmt;

use super::monotone_cubic::{Cubic, slopes};

/// A function f(x).
#[derive(Clone, Debug, PartialEq)]
pub enum ScalarFunction {
    /// c₀ + c₁ x + c₂ x² + …; one coefficient is a constant.
    Polynomial(Vec<f64>),
    /// Shape-preserving cubics through points, constant beyond them.
    Table(Table),
}

impl fmt::Display for ScalarFunction {
    /// `0.14 + 0.1 x + 0.2 x^2`, or `a table through (0, 0.14), (1, 0.2)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Polynomial(coefficients) => {
                let term = |(power, c): (usize, &f64)| match power {
                    0 => c.to_string(),
                    1 => format!("{c} x"),
                    _ => format!("{c} x^{power}"),
                };
                let terms: Vec<String> = coefficients.iter().enumerate().map(term).collect();
                f.write_str(&terms.join(" + "))
            }
            Self::Table(table) => {
                let points = table.points.iter().map(|[x, y]| format!("({x}, {y})"));
                write!(
                    f,
                    "a table through {}",
                    points.collect::<Vec<_>>().join(", ")
                )
            }
        }
    }
}

/// Points of a table with their slopes.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    points: Vec<[f64; 2]>,
    slopes: Vec<f64>,
    /// ∫ f x dx from the first point.
    moments: Vec<f64>,
}

/// Points and weights on 0…1 that integrate polynomials of degree 5 exactly.
const GAUSS: [[f64; 2]; 3] = [
    [0.112_701_665_379_258_31, 5.0 / 18.0],
    [0.5, 8.0 / 18.0],
    [0.887_298_334_620_741_7, 5.0 / 18.0],
];

/// Why points do not define a function.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TableFault {
    /// Fewer than two points.
    #[error("needs at least two points")]
    TooFew,
    /// A point that is not finite.
    #[error("has a point that is not finite")]
    NotFinite,
    /// A position that is not greater than the one before it.
    #[error("must ascend: {next} follows {before}")]
    NotAscending {
        /// The position.
        next: f64,
        /// The one before it.
        before: f64,
    },
}

impl ScalarFunction {
    /// A constant function.
    pub fn constant(value: f64) -> Self {
        Self::Polynomial(vec![value])
    }

    /// The cubics of Fritsch and Butland through points of ascending x.
    ///
    /// # Errors
    /// A [`TableFault`].
    pub fn table(points: Vec<[f64; 2]>) -> Result<Self, TableFault> {
        if points.len() < 2 {
            return Err(TableFault::TooFew);
        }
        if points.iter().flatten().any(|value| !value.is_finite()) {
            return Err(TableFault::NotFinite);
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            let [before, next] = [pair[0][0], pair[1][0]];
            return Err(TableFault::NotAscending { next, before });
        }
        let slopes = slopes(&points);
        let mut table = Table {
            moments: vec![0.0],
            points,
            slopes,
        };
        for piece in 1..table.points.len() {
            let [from, to] = [piece - 1, piece].map(|point| table.points[point][0]);
            let moment = table.moments[piece - 1] + table.moment(piece, from, to);
            table.moments.push(moment);
        }
        Ok(Self::Table(table))
    }

    /// f and df/dx.
    pub fn at(&self, x: f64) -> [f64; 2] {
        match self {
            Self::Polynomial(coefficients) => {
                let fold = |[value, slope]: [f64; 2], c: &f64| [value * x + c, slope * x + value];
                coefficients.iter().rev().fold([0.0; 2], fold)
            }
            Self::Table(table) => table.at(x),
        }
    }

    /// ∫ f(s) s ds from 0 to x.
    pub fn moment(&self, x: f64) -> f64 {
        match self {
            Self::Polynomial(coefficients) => {
                let terms = coefficients.iter().zip(2..);
                let term = |(c, power): (&f64, i32)| c * x.powi(power) / f64::from(power);
                terms.map(term).sum()
            }
            Self::Table(table) => table.moment_from_first(x) - table.moment_from_first(0.0),
        }
    }
}

impl Table {
    /// The index of the end point of the piece that contains x, from 1 on.
    fn piece(&self, x: f64) -> usize {
        let next = self.points.partition_point(|point| point[0] < x);
        next.clamp(1, self.points.len() - 1)
    }

    fn at(&self, x: f64) -> [f64; 2] {
        let [first, last] = [self.points[0], self.points[self.points.len() - 1]];
        if x < first[0] {
            return [first[1], 0.0];
        }
        if x > last[0] {
            return [last[1], 0.0];
        }
        let piece = self.piece(x);
        let points = [self.points[piece - 1], self.points[piece]];
        let cubic = Cubic::new(points, [self.slopes[piece - 1], self.slopes[piece]]);
        let s = x - points[0][0];
        [cubic.value(s), cubic.slope(s)]
    }

    /// ∫ f x dx within one piece.
    fn moment(&self, piece: usize, from: f64, to: f64) -> f64 {
        debug_assert!(self.piece(0.5 * (from + to)) == piece || from == to);
        let term = |[position, weight]: [f64; 2]| {
            let x = from + position * (to - from);
            weight * self.at(x)[0] * x
        };
        (to - from) * GAUSS.map(term).iter().sum::<f64>()
    }

    fn moment_from_first(&self, x: f64) -> f64 {
        let [first, last] = [self.points[0], self.points[self.points.len() - 1]];
        let outside = |[end, value]: [f64; 2]| 0.5 * value * (x * x - end * end);
        if x <= first[0] {
            outside(first)
        } else if x > last[0] {
            self.moments[self.points.len() - 1] + outside(last)
        } else {
            let piece = self.piece(x);
            self.moments[piece - 1] + self.moment(piece, self.points[piece - 1][0], x)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_and_moments_belong_to_the_function() {
        let table = vec![[-0.5, 2.0], [-0.1, 1.0], [0.2, 1.5], [0.6, 1.5], [1.0, 4.0]];
        let functions = [
            ScalarFunction::Polynomial(vec![2.0, -0.3, 0.7]),
            ScalarFunction::table(table).unwrap(),
        ];
        let step = 1e-5;
        for function in functions {
            assert_eq!(function.moment(0.0), 0.0);
            for x in [-0.8, -0.3, -0.05, 0.1, 0.4, 0.9, 1.3] {
                let slope = |f: &dyn Fn(f64) -> f64| (f(x + step) - f(x - step)) / (2.0 * step);
                let [value, rise] = function.at(x);
                assert!((slope(&|x| function.at(x)[0]) - rise).abs() < 1e-8, "{x}");
                assert!(
                    (slope(&|x| function.moment(x)) - value * x).abs() < 1e-8,
                    "{x}"
                );
            }
        }
    }

    #[test]
    fn a_table_keeps_its_shape_and_bad_ones_are_refused() {
        let points = vec![[0.0, 1.0], [1.0, 1.0], [2.0, 5.0], [4.0, 6.0]];
        let table = ScalarFunction::table(points).unwrap();
        let mut last = 1.0;
        for i in 0..=400 {
            let now = table.at(0.01 * f64::from(i))[0];
            assert!(now >= last - 1e-14, "falls at {i}");
            last = now;
        }
        assert_eq!(table.at(9.0), [6.0, 0.0]);
        let reason = |points: Vec<[f64; 2]>| ScalarFunction::table(points).unwrap_err().to_string();
        assert!(reason(vec![[0.0, 1.0]]).contains("two points"));
        assert!(reason(vec![[0.0, 1.0], [0.0, 2.0]]).contains("ascend"));
        assert!(reason(vec![[0.0, 1.0], [1.0, f64::NAN]]).contains("finite"));
    }
}
