//! B-splines on intervals that are equal, or become shorter towards the ends.

/// The most functions that are not zero at one argument: those of degree 5.
pub const MOST_FUNCTIONS: usize = 6;

/// Values of the functions that are not zero at an argument; entries after those of the degree are zero.
pub type LocalValues = [f64; MOST_FUNCTIONS];

/// The knots outside of the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// At equal distances: the outermost functions extend outside of the range.
    Uniform,
    /// All at the ends of the range: the first function is one at its beginning, the last one at its end.
    Clamped,
}

/// B-splines of one degree on intervals of a range; they add up to one.
///
/// # References
/// C. de Boor, A Practical Guide to Splines (1978)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BSpline {
    low: f64,
    width: f64,
    intervals: usize,
    degree: usize,
    ends: Ends,
    /// Whether intervals become shorter towards the beginning and the end.
    graded: [bool; 2],
}

/// The exponent by which intervals become shorter towards an end.
const GRADING: f64 = 2.0;

/// The exponent of the distance from an end that weights roughness there: for a function that goes like r⁰·⁶ at the
/// end, as displacements do near a clamp, r² f″² is integrable.
const WEIGHT: i32 = 2;

impl BSpline {
    /// Splines of a degree below [`MOST_FUNCTIONS`] on `intervals` equal parts of a range.
    pub fn new([low, high]: [f64; 2], intervals: usize, degree: usize, ends: Ends) -> Self {
        assert!(
            degree < MOST_FUNCTIONS && intervals > 0,
            "a spline of degree {degree}"
        );
        Self {
            low,
            width: (high - low) / intervals as f64,
            intervals,
            degree,
            ends,
            graded: [false; 2],
        }
    }

    /// With intervals that become shorter towards the beginning and the end of the range, where these are said, with the square of the
    /// distance; functions may be rough there.
    ///
    /// # Panics
    /// Where its knots extend outside of the range.
    #[must_use]
    pub fn graded(self, graded: [bool; 2]) -> Self {
        assert!(self.ends == Ends::Clamped, "knots beyond the range");
        Self { graded, ..self }
    }

    /// Where equal parts 0 ≤ t ≤ 1 of the range end, as a share of it.
    fn position(&self, t: f64) -> f64 {
        match self.graded {
            [false, false] => t,
            [true, false] => t.powf(GRADING),
            [false, true] => 1.0 - (1.0 - t).powf(GRADING),
            [true, true] if t < 0.5 => 0.5 * (2.0 * t).powf(GRADING),
            [true, true] => 1.0 - 0.5 * (2.0 - 2.0 * t).powf(GRADING),
        }
    }

    /// The weight of roughness at a share of the range.
    fn weight(&self, share: f64) -> f64 {
        let far = [share, 1.0 - share].into_iter().zip(self.graded);
        let near = far.filter(|(_, graded)| *graded).map(|(far, _)| far);
        let least = near.fold(0.5, f64::min);
        (2.0 * least).powi(WEIGHT)
    }

    /// Number of functions.
    pub fn count(&self) -> usize {
        self.intervals + self.degree
    }

    /// A knot in intervals from the beginning of the range.
    fn knot(&self, index: usize) -> f64 {
        match self.ends {
            Ends::Uniform => index as f64 - self.degree as f64,
            Ends::Clamped => {
                let index = index.saturating_sub(self.degree).min(self.intervals);
                let intervals = self.intervals as f64;
                intervals * self.position(index as f64 / intervals)
            }
        }
    }

    /// The interval in which s lies, in intervals from the beginning of the range; outside of the range, the outermost one.
    fn interval(&self, s: f64) -> usize {
        let last = self.intervals - 1;
        match self.graded {
            [false, false] => (s.floor().max(0.0) as usize).min(last),
            _ => (0..last)
                .find(|index| s < self.knot(index + 1 + self.degree))
                .unwrap_or(last),
        }
    }

    /// The first function that is not zero at `x`, and the derivatives of order `order` of it and the following ones; outside
    /// of the range the outermost polynomials continue.
    ///
    /// ```text
    /// Bⱼ,q = (s − tⱼ)/(tⱼ₊q − tⱼ) Bⱼ,q₋₁ + (tⱼ₊q₊₁ − s)/(tⱼ₊q₊₁ − tⱼ₊₁) Bⱼ₊₁,q₋₁     knots t, s = (x − low)/h
    /// B′ⱼ,q = q/h [Bⱼ,q₋₁/(tⱼ₊q − tⱼ) − Bⱼ₊₁,q₋₁/(tⱼ₊q₊₁ − tⱼ₊₁)]
    /// ```
    pub fn local(&self, x: f64, order: usize) -> (usize, LocalValues) {
        let s = (x - self.low) / self.width;
        let interval = self.interval(s);
        let mut values = [0.0; MOST_FUNCTIONS];
        if order > self.degree {
            return (interval, values);
        }
        values[0] = 1.0;
        for q in 1..=self.degree {
            let slope = q as f64 / self.width;
            for i in (0..=q).rev() {
                let j = interval + self.degree + i - q;
                let [from, next, to, end] =
                    [j, j + 1, j + q, j + q + 1].map(|index| self.knot(index));
                let [rising, falling] = if q > self.degree - order {
                    [slope, -slope]
                } else {
                    [s - from, end - s]
                };
                let before = if i == 0 {
                    0.0
                } else {
                    values[i - 1] / (to - from)
                };
                let after = if i == q {
                    0.0
                } else {
                    values[i] / (end - next)
                };
                values[i] = rising * before + falling * after;
            }
        }
        (interval, values)
    }

    /// The derivatives of some order of the functions that are not zero at `x`: function and value.
    pub fn derivatives(&self, x: f64, order: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let (first, values) = self.local(x, order);
        (first..).zip(values).take(self.degree + 1)
    }

    /// Rows r with Σ (r·q)² = ∫ w f″² dx for a cubic f = Σ qₖ Bₖ: two Gauss points in each interval. w is one, and where intervals
    /// become shorter the square of the distance from the end over half of the range.
    pub fn roughness(&self) -> impl Iterator<Item = Vec<(usize, f64)>> + use<> {
        let spline = *self;
        let offset = 0.5 / 3.0_f64.sqrt();
        let points = (0..self.intervals).flat_map(move |interval| {
            let [from, to] = [0, 1].map(|end| spline.knot(interval + end + spline.degree));
            let point = move |part: f64| (from + part * (to - from), to - from);
            [0.5 - offset, 0.5 + offset].map(point)
        });
        points.map(move |(s, length)| {
            let second = spline.derivatives(spline.low + s * spline.width, 2);
            let share = s / spline.intervals as f64;
            let weight = (0.5 * length * spline.width * spline.weight(share)).sqrt();
            second.map(|(k, value)| (k, weight * value)).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_add_up_to_one_and_their_derivatives_are_differences() {
        let both = [Ends::Uniform, Ends::Clamped];
        let all = [1, 3, 5]
            .into_iter()
            .flat_map(|d| both.map(|ends| (d, ends)));
        let equal = all.map(|(degree, ends)| BSpline::new([-1.0, 2.0], 7, degree, ends));
        let graded = [[true, false], [false, true], [true; 2]];
        let cubic = BSpline::new([-1.0, 2.0], 7, 3, Ends::Clamped);
        for spline in equal.chain(graded.map(|ends| cubic.graded(ends))) {
            let degree = spline.degree;
            for x in [-1.2, -1.0, -0.3, 0.77, 1.999, 2.0, 2.1] {
                let sum = |order| spline.local(x, order).1.iter().sum::<f64>();
                assert!((sum(0) - 1.0).abs() < 1e-11 && sum(1).abs() < 1e-10);
                for order in 0..degree.min(2) {
                    let [(from, up), (_, down), (_, slope)] =
                        [(x + 1e-6, order), (x - 1e-6, order), (x, order + 1)]
                            .map(|(x, order)| spline.local(x, order));
                    if spline.local(x - 1e-6, 0).0 != from {
                        continue;
                    }
                    for i in 0..=degree {
                        let difference = (up[i] - down[i]) / 2e-6;
                        assert!((difference - slope[i]).abs() < 1e-5 * (1.0 + slope[i].abs()));
                    }
                }
            }
        }
    }

    #[test]
    fn straight_lines_are_reproduced() {
        let spline = BSpline::new([0.0, 4.0], 4, 3, Ends::Uniform);
        // Function j has its middle at j − 1.
        let line = |x: f64| -> f64 {
            let terms = spline.derivatives(x, 0);
            terms.map(|(k, value)| value * (k as f64 - 1.0)).sum()
        };
        for x in [0.0, 0.4, 2.5, 4.0] {
            assert!((line(x) - x).abs() < 1e-13);
        }
    }

    /// Coefficients of t³ by its blossom: the product of three knots.
    fn cube(spline: BSpline) -> Vec<f64> {
        let coefficient = |k: usize| {
            let knots = (1..=spline.degree).map(|i| spline.width * spline.knot(k + i));
            knots.product()
        };
        (0..spline.count()).map(coefficient).collect()
    }

    #[test]
    fn cubic_polynomials_and_their_roughness_are_exact() {
        for intervals in [1, 2, 5] {
            let spline = BSpline::new([0.0, 1.0], intervals, 3, Ends::Clamped);
            let q = cube(spline);
            for t in [0.0, 0.13, 0.5, 0.77, 1.0_f64] {
                let sum = |order: usize| -> f64 {
                    let functions = spline.derivatives(t, order);
                    functions.map(|(k, value)| q[k] * value).sum()
                };
                assert!((sum(0) - t.powi(3)).abs() < 1e-14);
                assert!((sum(1) - 3.0 * t * t).abs() < 1e-12);
                assert!((sum(2) - 6.0 * t).abs() < 1e-11);
            }
            let squares = spline.roughness().map(|row| {
                let terms = row.iter().map(|(k, r)| r * q[*k]);
                terms.sum::<f64>().powi(2)
            });
            let sum: f64 = squares.sum();
            assert!((sum - 12.0).abs() < 1e-10, "{sum}");
        }
    }

    /// ∫ (2x)² (2)² dx of f = x² up to the middle, and twice the same of both ends: 2/3 each, by two Gauss points but for their error.
    #[test]
    fn roughness_counts_less_at_graded_ends_and_straight_lines_have_none() {
        let spline = BSpline::new([0.0, 1.0], 8, 3, Ends::Clamped);
        let sum = |spline: BSpline, of: fn([f64; 3]) -> f64| -> f64 {
            let coefficient = |k: usize| of([1, 2, 3].map(|i| spline.width * spline.knot(k + i)));
            let q: Vec<f64> = (0..spline.count()).map(coefficient).collect();
            let rows = spline.roughness();
            let squares = rows.map(|row| row.iter().map(|(k, r)| r * q[*k]).sum::<f64>().powi(2));
            squares.sum()
        };
        // The blossoms of x and of x².
        let line = |[a, b, c]: [f64; 3]| (a + b + c) / 3.0;
        let square = |[a, b, c]: [f64; 3]| (a * b + a * c + b * c) / 3.0;
        for ends in [[true, false], [false, true], [true; 2]] {
            let graded = spline.graded(ends);
            assert!(sum(graded, line) < 1e-20);
            let actual = sum(graded, square);
            let exact = match ends {
                [true, true] => 4.0 / 3.0,
                _ => 2.0 / 3.0 + 2.0,
            };
            assert!(
                (actual / exact - 1.0).abs() < 0.02,
                "{ends:?}: {actual} {exact}"
            );
        }
    }

    #[test]
    fn clamped_end_functions_are_one_at_the_ends() {
        let spline = BSpline::new([0.0, 1.0], 4, 3, Ends::Clamped);
        for (t, function) in [(0.0, 0), (1.0, spline.count() - 1)] {
            let mut values = spline.derivatives(t, 0);
            assert!(values.all(|(k, value)| value == f64::from(u8::from(k == function))));
        }
    }
}
