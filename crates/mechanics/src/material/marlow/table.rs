//! Tension curves from measured tables.

use super::{Marlow, TensionCurve};
use crate::material::law::HyperelasticLaw;
use crate::material::monotone_cubic::{Cubic, slopes};
use crate::material::parameters::{Parameters, StrainMeasure, StressMeasure};

/// A measured tension curve, interpolated by cubics that rise wherever the points rise.
///
/// | card key | unit | admissible | meaning |
/// |---|---|---|---|
/// | `strain` | – | increasing, not below rest | strains of the points in the card's strain measure |
/// | `stress` | stress | a rise from rest | stresses of the points in the card's stress measure |
/// | `extrapolation` | | `"linear"`, `"none"` | beyond the last point: a straight line, or no energy |
///
/// The points are converted to nominal stress P over x = λ − 1. The stress of a first point at rest is subtracted from all
/// stresses in the card's measure (`offset = "subtract"`); where the table begins above rest, rest is added with P = 0.
/// P and dP/dx are continuous; the slopes at the points are those of Fritsch and Butland, so that the curve
/// has no overshoot.
///
/// # References
/// F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5, 300 (1984), doi:10.1137/0905021
#[derive(Clone, Debug)]
pub struct TableCurve {
    knots: Vec<Knot>,
    extrapolate: bool,
}

/// A fault in the points of a tension curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CurveFault {
    /// There are no points.
    #[error("the curve has no points")]
    Empty,
    /// A strain or a stress is not a number.
    #[error("{0} is not a finite number")]
    NotFinite(f64),
    /// The first strain is compression.
    #[error("the curve begins below rest")]
    BelowRest,
    /// Stretches do not increase.
    #[error("the strain does not increase: a stretch of {after} follows {before}")]
    NotIncreasing {
        /// A stretch.
        before: f64,
        /// The next stretch.
        after: f64,
    },
    /// The only point is the one at rest.
    #[error("the curve needs a point other than rest")]
    RestAlone,
    /// The stress falls, or is constant, over the first strain.
    #[error("the curve does not rise from rest")]
    DoesNotRise,
}

#[derive(Clone, Copy, Debug)]
struct Knot {
    x: f64,
    stress: f64,
    slope: f64,
    /// ∫ P dx from rest.
    energy: f64,
}

impl TableCurve {
    /// Reads the table of a card.
    pub fn from_card(parameters: &Parameters) -> Box<dyn HyperelasticLaw> {
        let mut points = parameters.curve();
        // Subtracted in its own measure, as for a formula.
        if let Some(&[_, at_rest]) = points.first().filter(|[strain, _]| *strain == 0.0) {
            points.iter_mut().for_each(|point| point[1] -= at_rest);
        }
        let points = nominal_points(
            &points,
            parameters.stress_measure,
            parameters.strain_measure,
        );
        let extrapolate = parameters.choice("extrapolation", &[("linear", true), ("none", false)]);
        match Self::new(&points, extrapolate) {
            Ok(curve) => Box::new(Marlow { curve }),
            Err(fault) => {
                let hint = "give increasing strains from rest on, and a stress that begins to rise";
                parameters.fault("stress", &fault.to_string(), hint);
                let knots = vec![Knot::UNREAD; 2];
                Box::new(Marlow {
                    curve: Self { knots, extrapolate },
                })
            }
        }
    }

    /// A curve through points x = λ − 1, P in MPa.
    ///
    /// # Errors
    /// A [`CurveFault`].
    pub fn new(points: &[[f64; 2]], extrapolate: bool) -> Result<Self, CurveFault> {
        let mut points = points.to_vec();
        if points.is_empty() {
            return Err(CurveFault::Empty);
        }
        if let Some(bad) = points.iter().flatten().find(|value| !value.is_finite()) {
            return Err(CurveFault::NotFinite(*bad));
        }
        let [first, at_rest] = points[0];
        if first < 0.0 {
            return Err(CurveFault::BelowRest);
        }
        if first > 0.0 {
            points.insert(0, [0.0, 0.0]);
        } else {
            points.iter_mut().for_each(|point| point[1] -= at_rest);
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            return Err(CurveFault::NotIncreasing {
                before: 1.0 + pair[0][0],
                after: 1.0 + pair[1][0],
            });
        }
        if points.len() < 2 {
            return Err(CurveFault::RestAlone);
        }
        let slopes = slopes(&points);
        if slopes[0] <= 0.0 {
            return Err(CurveFault::DoesNotRise);
        }
        let mut knots: Vec<Knot> = Vec::with_capacity(points.len());
        for ([x, stress], slope) in points.into_iter().zip(slopes) {
            let energy = knots.last().map_or(0.0, |last| {
                let h = x - last.x;
                last.energy + h * (last.stress + stress) / 2.0 + h * h * (last.slope - slope) / 12.0
            });
            knots.push(Knot {
                x,
                stress,
                slope,
                energy,
            });
        }
        Ok(Self { knots, extrapolate })
    }

    /// P, dP/dx and the energy at x ≥ 0, and P/x without cancellation.
    fn evaluate(&self, x: f64) -> ([f64; 3], f64) {
        let last = self.knots[self.knots.len() - 1];
        if x > last.x {
            if !self.extrapolate {
                return ([f64::NAN, f64::NAN, f64::INFINITY], f64::NAN);
            }
            let over = x - last.x;
            let stress = last.stress + over * last.slope;
            let energy = last.energy + over * (last.stress + stress) / 2.0;
            return ([stress, last.slope, energy], stress / x);
        }
        let next = self.knots.partition_point(|knot| knot.x < x).max(1);
        let from = self.knots[next - 1];
        let (piece, s) = (self.piece(next), x - from.x);
        let stress = piece.value(s);
        let energy = from.energy + piece.integral(s);
        let secant = match next {
            1 => piece.secant(s),
            _ => stress / x,
        };
        ([stress, piece.slope(s), energy], secant)
    }

    /// The cubic that ends at a knot.
    fn piece(&self, end: usize) -> Cubic {
        let knots = [self.knots[end - 1], self.knots[end]];
        let points = knots.map(|knot| [knot.x, knot.stress]);
        Cubic::new(points, knots.map(|knot| knot.slope))
    }
}

impl Knot {
    /// Of a curve that could not be read.
    const UNREAD: Self = Self {
        x: f64::NAN,
        stress: f64::NAN,
        slope: f64::NAN,
        energy: f64::NAN,
    };
}

impl TensionCurve for TableCurve {
    fn secant(&self, x: f64) -> (f64, f64) {
        let ([_, slope, _], secant) = self.evaluate(x);
        if x > 0.0 && x >= self.knots[1].x {
            return (secant, (slope - secant) / x);
        }
        (secant, self.piece(1).secant_slope(x))
    }

    fn energy(&self, x: f64) -> f64 {
        self.evaluate(x).0[2]
    }
}

/// Points (strain, stress) of some measures as (λ − 1, nominal stress).
pub fn nominal_points(
    points: &[[f64; 2]],
    stress_measure: StressMeasure,
    strain_measure: StrainMeasure,
) -> Vec<[f64; 2]> {
    let convert = |[strain, stress]: &[f64; 2]| {
        let x = strain_measure.to_nominal(*strain);
        [x, stress_measure.to_nominal(*stress, x)]
    };
    points.iter().map(convert).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::HyperelasticLaw;

    const POINTS: [[f64; 2]; 6] = [
        [0.0, 0.002],
        [0.1, 0.022],
        [0.25, 0.04],
        [0.6, 0.11],
        [0.8, 0.11],
        [1.2, 0.4],
    ];

    #[test]
    fn the_law_goes_through_the_points_and_rises_where_they_rise() {
        let law = Marlow {
            curve: TableCurve::new(&POINTS, true).unwrap(),
        };
        let stress = |x: f64| law.tension([1.0, 0.0], x).nominal_stress;
        for [x, p] in POINTS {
            assert!((stress(x) - (p - 0.002)).abs() < 1e-15, "{x}");
        }
        let mut last = 0.0;
        for i in 1..=1500 {
            let next = stress(f64::from(i) * 1e-3);
            assert!(next >= last - 1e-15, "falls at {i}");
            last = next;
        }
    }

    #[test]
    fn stress_and_slope_are_derivatives_and_continuous() {
        let curve = TableCurve::new(&POINTS, true).unwrap();
        for x in [0.03, 0.1, 0.17, 0.25, 0.5, 0.7, 1.0, 1.2, 1.5] {
            let [stress, slope, _] = curve.evaluate(x).0;
            let step = 1e-6;
            let [before, after] = [x - step, x + step].map(|x| curve.evaluate(x).0);
            assert!(
                ((after[2] - before[2]) / (2.0 * step) - stress).abs() < 1e-9,
                "{x}"
            );
            assert!(
                ((after[0] - before[0]) / (2.0 * step) - slope).abs() < 1e-5,
                "{x}"
            );
        }
    }

    #[test]
    fn bad_tables_are_refused_with_a_reason() {
        let reason = |points: &[[f64; 2]]| TableCurve::new(points, true).unwrap_err().to_string();
        assert!(reason(&[]).contains("no points"));
        assert!(reason(&[[0.0, 0.0]]).contains("other than rest"));
        assert!(reason(&[[0.2, 0.1], [0.1, 0.2]]).contains("does not increase"));
        assert!(reason(&[[0.1, -0.1], [0.2, -0.2]]).contains("rise"));
        assert!(reason(&[[0.1, f64::NAN]]).contains("finite"));
        let ends = TableCurve::new(&POINTS, false).unwrap();
        assert!(!ends.energy(1.21).is_finite() && ends.energy(1.2).is_finite());
    }
}
