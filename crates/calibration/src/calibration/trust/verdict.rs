//! Whether the residuals of a fit are the noise of a test.

use nalgebra::{DMatrix, DVector};

use crate::calibration::regression::Rows;
use crate::statistics::{
    Curve, CurveNoise, CurveResiduals, DurbinWatson, extremes, f_tail, growing_sizes,
};

/// What the residuals are.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Answer {
    /// White noise.
    White,
    /// Noise that correlates along the curves, which the intervals take into account.
    Correlated,
    /// A smooth pattern that such noise does not produce: intervals are meaningless.
    Systematic,
    /// No more than the rounding of the file's numbers: there is no noise, and there are no intervals.
    Rounding,
}

impl Answer {
    /// The answer as text.
    pub fn words(self) -> &'static str {
        match self {
            Self::White => "white noise",
            Self::Correlated => "correlated noise",
            Self::Systematic => "systematic",
            Self::Rounding => "rounding",
        }
    }

    /// Whether intervals can be made of the residuals.
    pub fn has_intervals(self) -> bool {
        matches!(self, Self::White | Self::Correlated)
    }
}

/// The verdict on residuals, with the figures on which it is based.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// The answer.
    pub answer: Answer,
    /// Durbin and Watson's test over neighbours in the file or in strain, whichever is less probable for white noise; `None` where there
    /// are no neighbours.
    pub durbin_watson: Option<DurbinWatson>,
    /// The correlation of neighbouring residuals.
    pub of_neighbours: f64,
    /// The probability that noise follows a smooth curve as well as the residuals do; `None` where there are too few points.
    pub pattern_probability: Option<f64>,
    /// The number of independent points with the same information on the noise; all points where the residuals are not noise.
    pub effective_points: f64,
    /// The largest noise of a curve over the smallest one; 1 where they do not differ.
    pub noise_ratio: f64,
    /// Whether the other weighting would suit the noise, which the intervals take into account.
    pub suits_other_weights: bool,
}

impl Verdict {
    /// The verdict in a sentence.
    pub fn sentence(&self) -> String {
        let test = self.durbin_watson.map_or(String::new(), |test| {
            let chance = percent(test.probability);
            format!(
                " (Durbin-Watson {:.2}; probability under white noise {chance})",
                test.statistic
            )
        });
        let unequal = if self.noise_ratio > 1.0 {
            format!(
                "; in one test it is {:.1} times larger than in another, which the intervals take into account",
                self.noise_ratio
            )
        } else {
            String::new()
        };
        let pattern = percent(self.pattern_probability.unwrap_or(f64::NAN));
        match self.answer {
            Answer::White if self.durbin_watson.is_none() => {
                format!("taken as white noise: too few points to decide{unequal}")
            }
            Answer::White => format!("white noise{test}{unequal}"),
            Answer::Correlated => format!(
                "correlated noise, {:.2} between neighbours, so that the points are worth {:.1} independent ones{test}{unequal}",
                self.of_neighbours, self.effective_points
            ),
            Answer::Systematic => format!(
                "systematic, a smooth pattern that noise produces in {pattern} of cases: no intervals{test}"
            ),
            Answer::Rounding => {
                "no more than the rounding of the data: no noise, and no intervals".to_owned()
            }
        }
    }
}

/// A probability in percent.
fn percent(probability: f64) -> String {
    match 100.0 * probability {
        tiny if tiny < 1e-4 => "less than 0.0001 %".to_owned(),
        small if small < 0.1 => format!("{small:.4} %"),
        percent => format!("{percent:.1} %"),
    }
}

/// The probability below which white noise, or any noise, is rejected.
const DOUBTED: f64 = 0.01;

/// The residuals of a fit along its curves.
pub struct FitResiduals<'a> {
    /// The rows along each curve.
    pub curves: Vec<Rows>,
    /// Derivatives of the residuals with respect to the estimated parameters.
    pub design: &'a DMatrix<f64>,
    pub residual: &'a DVector<f64>,
    /// The size that the noise may have instead of being of one size.
    pub other_size: &'a DVector<f64>,
    /// The sum of squares by rounding of the stresses, and by rounding of strains and stresses.
    pub rounded: [f64; 2],
}

impl FitResiduals<'_> {
    /// The verdict, and the noise; `None` where nothing is estimated, or there are no degrees of freedom.
    pub fn judge(&self) -> Option<(Verdict, CurveNoise)> {
        let estimates = self.design.ncols();
        if estimates == 0 || self.design.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let steady = Steady::of(&self.curves, self.design, self.other_size);
        let (curves, design) = (&steady.curves, &steady.design);
        let orders = orders(curves);
        let grown = self.grown(&orders, &steady.other_size);
        let suits_other_weights = grown.is_some();
        let grown = grown.unwrap_or_else(|| DVector::from_element(self.residual.len(), 1.0));
        let (of_curves, noise_ratio) = self.sizes(&grown);
        let sizes = grown.component_mul(&of_curves);
        let residuals = CurveResiduals {
            design,
            residual: self.residual,
            orders: &orders,
            sizes: &sizes,
        };
        let noise = residuals.noise()?;
        let tests = orders
            .iter()
            .filter_map(|curves| DurbinWatson::new(design, self.residual, curves));
        let doubt = tests.min_by(|a, b| a.probability.total_cmp(&b.probability));
        let correlated =
            doubt.is_some_and(|test| test.probability * (orders.len() as f64) < DOUBTED);
        let functions = smooth_functions(curves, self.residual.len(), estimates);
        let pattern = residuals.pattern(&functions);
        let answer = match (self.is_rounding(), pattern) {
            (true, _) => Answer::Rounding,
            (_, Some(probability)) if probability < DOUBTED => Answer::Systematic,
            _ if correlated => Answer::Correlated,
            _ => Answer::White,
        };
        let effective_points = match answer {
            Answer::White | Answer::Correlated => noise.independent(),
            Answer::Systematic | Answer::Rounding => self.residual.len() as f64,
        };
        let verdict = Verdict {
            answer,
            durbin_watson: doubt,
            of_neighbours: noise.of_neighbours(),
            pattern_probability: pattern,
            effective_points,
            noise_ratio,
            suits_other_weights,
        };
        Some((verdict, noise))
    }

    /// The sizes of noise that changes along the curves, in the order in which neighbours are the nearest.
    fn grown(&self, orders: &[Vec<Curve>], other: &DVector<f64>) -> Option<DVector<f64>> {
        let rough = |curves: &&Vec<Curve>| {
            let pairs = curves.iter().flat_map(|curve| curve.rows.windows(2));
            pairs.fold(0.0, |sum, pair| {
                sum + (self.residual[pair[1]] - self.residual[pair[0]]).powi(2)
            })
        };
        let curves = orders.iter().min_by(|a, b| rough(a).total_cmp(&rough(b)))?;
        let rows: Vec<Vec<usize>> = curves.iter().map(|curve| curve.rows.clone()).collect();
        growing_sizes(&rows, self.residual, other)
    }

    /// The size of the noise of every row relative to that of all, after division by the sizes that change along the curves: one size for each
    /// curve where curves differ significantly, else 1; and the ratio of the largest to the smallest size.
    fn sizes(&self, grown: &DVector<f64>) -> (DVector<f64>, f64) {
        let rows = self.residual.len();
        let even = self.residual.component_div(grown);
        let share = 1.0 - self.design.ncols() as f64 / rows as f64;
        let mean = even.norm_squared() / rows as f64;
        let of_curve = |curve: &Rows| {
            let scaled = curve.iter().map(|(row, _)| even[*row].powi(2));
            (scaled.sum::<f64>() / curve.len() as f64, curve.len() as f64)
        };
        let squares: Vec<(f64, f64)> = self.curves.iter().map(of_curve).collect();
        let pairs = squares
            .iter()
            .flat_map(|a| squares.iter().map(move |b| (a, b)));
        // All pairs are looked at.
        let by_chance = pairs.map(|((a, n), (b, m))| f_tail([share * n, share * m], a / b));
        let least = by_chance.fold(1.0, f64::min) * squares.len().pow(2) as f64;
        let mut sizes = DVector::from_element(rows, 1.0);
        if !(least < DOUBTED && squares.iter().all(|(square, _)| *square > 0.0)) {
            return (sizes, 1.0);
        }
        for (curve, (square, _)) in self.curves.iter().zip(&squares) {
            for (row, _) in curve {
                sizes[*row] = (square / mean).sqrt();
            }
        }
        let [low, high] = extremes(sizes.iter().copied());
        (sizes, high / low)
    }

    /// Whether the residuals are about as large as rounding leaves them, or smaller. Rounded strains count only where the residuals
    /// are not far smaller than they make them: else the strains are more exact than they are written.
    fn is_rounding(&self) -> bool {
        const FACTOR: f64 = 2.0;
        const FAR: f64 = 0.3;
        let freedom = self.residual.len() - self.design.ncols();
        let share = freedom as f64 / self.residual.len() as f64;
        let [stresses, both] = self.rounded.map(|one| share * one);
        let square = self.residual.norm_squared();
        square <= FACTOR * stresses || (FAR * both..=FACTOR * both).contains(&square)
    }
}

/// The curves without the noise of their strains: where the strain of a test jitters about one that grows or falls, its values are sorted, and
/// with them the derivatives and the sizes of the noise. Otherwise the residuals, which include the noise of the strain, would be a function
/// of the strain.
struct Steady {
    curves: Vec<Rows>,
    design: DMatrix<f64>,
    other_size: DVector<f64>,
}

impl Steady {
    fn of(curves: &[Rows], design: &DMatrix<f64>, other_size: &DVector<f64>) -> Self {
        let mut steady = Self {
            curves: curves.to_vec(),
            design: design.clone(),
            other_size: other_size.clone(),
        };
        for curve in &mut steady.curves {
            let Some(sorted) = in_order(curve) else {
                continue;
            };
            for ((row, strain), (source, value)) in curve.iter_mut().zip(sorted) {
                *strain = value;
                steady.design.set_row(*row, &design.row(source));
                steady.other_size[*row] = other_size[source];
            }
        }
        steady
    }
}

/// The rows of a curve by their strains, in the direction in which they follow one another; `None` where they do not jitter, or turn back
/// by more.
fn in_order(curve: &Rows) -> Option<Rows> {
    /// Of the range of strain.
    const JITTER: f64 = 0.05;
    let mut sorted = curve.clone();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (first, last) = (curve.first()?.1, curve.last()?.1);
    if last < first {
        sorted.reverse();
    }
    let range = (sorted.last()?.1 - sorted.first()?.1).abs();
    let pairs = || curve.iter().zip(&sorted);
    let jitters = pairs().any(|(a, b)| a.0 != b.0);
    let is_steady = pairs().all(|(a, b)| (a.1 - b.1).abs() <= JITTER * range);
    (jitters && is_steady).then_some(sorted)
}

/// The rows in the order of the file, and in the order of strain where that is another one or far from even.
fn orders(curves: &[Rows]) -> Vec<Vec<Curve>> {
    const EVEN: f64 = 2.0;
    let file = |rows: &Rows| Curve::even(rows.iter().map(|(row, _)| *row).collect());
    let files: Vec<Curve> = curves.iter().map(file).collect();
    let strains: Vec<Curve> = curves.iter().cloned().map(Curve::by_position).collect();
    let alike = |(a, b): (&Curve, &Curve)| {
        let falling = || b.rows.iter().rev().eq(&a.rows);
        let even = b.gaps.iter().all(|gap| (1.0 / EVEN..=EVEN).contains(gap));
        even && (a.rows == b.rows || falling())
    };
    if files.iter().zip(&strains).all(alike) {
        vec![files]
    } else {
        vec![files, strains]
    }
}

/// Legendre polynomials of the strain along each curve, a column each. Their number grows with the points of the curve, up to four more than
/// there are estimates: the law can follow the first ones.
fn smooth_functions(curves: &[Rows], rows: usize, estimates: usize) -> DMatrix<f64> {
    const MORE: usize = 4;
    const POINTS_EACH: usize = 3;
    let mut columns = Vec::new();
    for curve in curves {
        let count = (estimates + MORE).min(curve.len() / POINTS_EACH);
        let [low, high] = extremes(curve.iter().map(|(_, x)| *x));
        if high <= low {
            continue;
        }
        for degree in 0..count {
            let mut column = DVector::zeros(rows);
            for (row, x) in curve {
                column[*row] = legendre(degree, (2.0 * x - low - high) / (high - low));
            }
            columns.push(column);
        }
    }
    if columns.is_empty() {
        DMatrix::zeros(rows, 0)
    } else {
        DMatrix::from_columns(&columns)
    }
}

/// (n + 1) Pₙ₊₁ = (2n + 1) x Pₙ − n Pₙ₋₁.
fn legendre(degree: usize, x: f64) -> f64 {
    let (mut before, mut value) = (0.0, 1.0);
    for n in 0..degree {
        let n = n as f64;
        (before, value) = (
            value,
            ((2.0 * n + 1.0) * x * value - n * before) / (n + 1.0),
        );
    }
    value
}
