//! Least-squares splines of a signal over time, with as many parts as its noise allows, and anew after every gap.

use std::ops::Range;

use crate::solve::vector::{difference, largest, norm};
use crate::solve::{Cholesky, FactorFault, SymmetricPattern};
use crate::statistics::{BSpline, Ends, LocalValues, MOST_FUNCTIONS};

/// Least number of instants for each part of a spline.
const FEWEST: usize = 4;

/// Parts of the motion for each part that cross-validation asks for in either signal alone: two derivatives of the
/// motion enter, and where they are not resolved they cause a bias. Finer parts cost little, because the equation of
/// motion couples them.
const FINER: usize = 4;

/// Parts of a spline that an interval between two instants may span: with more empty parts a spline is hardly determined, and oscillates
/// there.
const BRIDGED: f64 = 1.5;

/// Parts of the motion may become so many times as long where instants lie apart; an interval that asks for longer ones is a gap.
pub const LONGER: usize = 2;

/// Least number of instants for each part of the motion; both signals count at each instant.
pub const FEWEST_IN_MOTION: usize = 2;

/// The share of a signal's largest value below which a deviation is no evidence against a body: sensors are not more linear, and splines of
/// a motion without noise not more exact.
pub const RESOLUTION: f64 = 1e-3;

/// A spline fitted to one signal alone.
#[derive(Clone, Debug)]
pub struct SignalSpline {
    /// Equal parts of the time without gaps.
    pub intervals: usize,
    /// Standard deviation of the noise, in the signal's unit.
    pub noise: f64,
    /// Whether more parts than the sampling allows would be better.
    pub coarse: bool,
}

/// The values of a spline's functions, or of their derivatives, at each instant.
#[derive(Clone, Debug)]
pub struct SplineValues {
    /// First function and values, instant after instant.
    pub rows: Vec<(usize, LocalValues)>,
}

/// A spline over time that begins anew after every gap between instants: nothing is known of a signal there.
#[derive(Clone, Debug)]
pub struct PiecewiseSpline {
    pieces: Vec<Piece>,
}

/// A run of instants without a gap.
#[derive(Clone, Debug)]
struct Piece {
    instants: Range<usize>,
    spline: BSpline,
    /// The first of its functions among those of all pieces.
    first: usize,
}

impl PiecewiseSpline {
    /// Parts as long as `intervals` equal ones of the time without gaps, or up to `longer` times as long in a run whose instants lie apart.
    /// `None` where too few instants lie between two gaps.
    pub fn new(times: &[f64], intervals: usize, longer: usize, degree: usize) -> Option<Self> {
        let bridged = BRIDGED * longer as f64;
        let with_gaps = (times[times.len() - 1] - times[0]) / intervals as f64;
        let steps = |times: &[f64]| {
            let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
            steps.collect::<Vec<f64>>()
        };
        let recorded = steps(times).into_iter();
        let recorded: f64 = recorded.filter(|step| *step <= bridged * with_gaps).sum();
        let part = recorded / intervals as f64;
        let mut pieces = Vec::new();
        let (mut instant, mut first) = (0, 0);
        for run in times.chunk_by(|before, after| after - before <= bridged * part) {
            if run.len() < FEWEST_IN_MOTION * (degree + 1) {
                return None;
            }
            let range = [run[0], run[run.len() - 1]];
            let part = part.max(largest(&steps(run)) / BRIDGED);
            let parts = ((range[1] - range[0]) / part).round() as usize;
            let parts = parts.clamp(1, run.len() / FEWEST_IN_MOTION);
            let spline = BSpline::new(range, parts, degree, Ends::Uniform);
            pieces.push(Piece {
                instants: instant..instant + run.len(),
                spline,
                first,
            });
            instant += run.len();
            first += spline.count();
        }
        Some(Self { pieces })
    }

    /// The number of functions.
    fn count(&self) -> usize {
        self.pieces.iter().map(|piece| piece.spline.count()).sum()
    }

    /// The instants of each piece.
    pub fn runs(&self) -> Vec<Range<usize>> {
        let pieces = self.pieces.iter();
        pieces.map(|piece| piece.instants.clone()).collect()
    }
}

impl SplineValues {
    /// Derivatives of some order at all `times`, those of the spline's pieces.
    pub fn new(spline: &PiecewiseSpline, times: &[f64], order: usize) -> Self {
        let rows = spline.pieces.iter().flat_map(|piece| {
            times[piece.instants.clone()].iter().map(move |t| {
                let (first, values) = piece.spline.local(*t, order);
                (piece.first + first, values)
            })
        });
        Self {
            rows: rows.collect(),
        }
    }

    /// The sum of functions with these coefficients at an instant.
    pub fn value(&self, instant: usize, coefficients: &[f64]) -> f64 {
        let (first, values) = &self.rows[instant];
        let local = coefficients[*first..].iter();
        local.zip(values).map(|(c, value)| c * value).sum()
    }
}

/// A symmetric matrix of B-splines: sums of products of neighbouring functions.
pub struct BandMatrix {
    cholesky: Cholesky,
    values: Vec<f64>,
}

impl BandMatrix {
    /// The zero matrix for `count` functions.
    ///
    /// # Errors
    /// [`FactorFault`] when there is no memory for it.
    pub fn new(count: usize) -> Result<Self, FactorFault> {
        let columns = (0..count).map(|column| {
            (column..column + MOST_FUNCTIONS)
                .filter(|row| *row < count)
                .collect()
        });
        let pattern = SymmetricPattern::new(columns);
        let order: Vec<usize> = (0..count).collect();
        Ok(Self {
            values: vec![0.0; pattern.entries()],
            cholesky: Cholesky::analyse_in_order(pattern, &order)?,
        })
    }

    /// Adds the square of a row.
    pub fn add(&mut self, first: usize, row: &LocalValues) {
        for (i, a) in row.iter().enumerate() {
            for (j, b) in row.iter().enumerate().skip(i) {
                // Rows of lower degrees end with zeros, whose columns may lie after the last function.
                let product = a * b;
                if product == 0.0 {
                    continue;
                }
                if let Some(position) = self.cholesky.pattern().position(first + j, first + i) {
                    self.values[position] += product;
                }
            }
        }
    }

    /// Factorises the matrix.
    ///
    /// # Errors
    /// [`FactorFault`] when the rows leave a function undetermined.
    pub fn factorise(mut self) -> Result<Cholesky, FactorFault> {
        self.cholesky.factorise(&self.values)?;
        Ok(self.cholesky)
    }
}

/// The spline of [`PiecewiseSpline::new`], and its coefficients nearest to `signal`; `None` where the instants do not determine it.
pub fn nearest(
    times: &[f64],
    signal: &[f64],
    (intervals, longer): (usize, usize),
    degree: usize,
) -> Option<(PiecewiseSpline, Vec<f64>)> {
    let spline = PiecewiseSpline::new(times, intervals, longer, degree)?;
    let sampled = SplineValues::new(&spline, times, 0);
    let mut matrix = BandMatrix::new(spline.count()).ok()?;
    let mut right = vec![0.0; spline.count()];
    for ((first, row), value) in sampled.rows.iter().zip(signal) {
        matrix.add(*first, row);
        for (sum, b) in right[*first..].iter_mut().zip(row) {
            *sum += b * value;
        }
    }
    let coefficients = matrix.factorise().ok()?.solve(&right).ok()?;
    Some((spline, coefficients))
}

/// The number of equal parts for which generalised cross-validation, (‖y − ŷ‖²/n)/(1 − p/n)² with p functions, is
/// least, and the noise √(‖y − ŷ‖²/(n − p)) of the residuals.
pub fn smooth(times: &[f64], signal: &[f64], degree: usize) -> Option<SignalSpline> {
    let n = times.len() as f64;
    let mut best: Option<(f64, usize, f64)> = None;
    let (mut intervals, most) = (2, times.len() / FEWEST);
    while intervals <= most {
        if let Some((spline, coefficients)) = nearest(times, signal, (intervals, 1), degree) {
            let sampled = SplineValues::new(&spline, times, 0);
            let rows = signal.iter().enumerate();
            let squares = rows.map(|(i, y)| (y - sampled.value(i, &coefficients)).powi(2));
            let free = n - spline.count() as f64;
            let variance = squares.sum::<f64>() / free;
            let score = variance * n / free;
            if best.is_none_or(|(least, ..)| score < least) {
                best = Some((score, intervals, variance.sqrt()));
            }
        }
        intervals += 1 + intervals / 8;
    }
    let (_, intervals, noise) = best?;
    // Without noise any number of parts would do better with more.
    let coarse = intervals + intervals / 8 + 1 > most && noise > RESOLUTION * largest(signal);
    Some(SignalSpline {
        intervals,
        noise,
        coarse,
    })
}

/// The parts of the motion that both signals ask for.
pub fn wanted_parts(extension: &SignalSpline, force: &SignalSpline) -> usize {
    FINER * extension.intervals.max(force.intervals)
}

/// Whether the residuals of a signal are larger than sensors are linear and splines exact.
pub fn exceeds_resolution(measured: &[f64], fitted: &[f64]) -> bool {
    let size = norm(&difference(measured, fitted)) / (measured.len() as f64).sqrt();
    size > RESOLUTION * largest(measured)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::normal_numbers;

    #[test]
    fn the_noise_of_a_signal_is_found() {
        let times: Vec<f64> = (0..800).map(|i| 0.01 * f64::from(i)).collect();
        let mut normal = normal_numbers(3);
        let signal: Vec<f64> = times
            .iter()
            .map(|t| (3.0 * t + 0.2 * t * t).sin() + 0.05 * normal())
            .collect();
        let actual = smooth(&times, &signal, 5).unwrap();
        assert!((actual.noise / 0.05 - 1.0).abs() < 0.08, "{actual:?}");
        assert!(
            (6..60).contains(&actual.intervals) && !actual.coarse,
            "{actual:?}"
        );
    }

    /// The noise of a signal is that of its runs, however long the gap between them.
    #[test]
    fn a_gap_changes_neither_the_parts_nor_the_noise() {
        let mut moving: Vec<f64> = (0..800).map(|i| 0.01 * f64::from(i)).collect();
        moving.retain(|t| !(3.0..3.8).contains(t));
        let mut normal = normal_numbers(3);
        let signal = moving.iter().map(|t| (9.0 * t).sin() + 0.05 * normal());
        let signal: Vec<f64> = signal.collect();
        for pause in [0.0, 500.0] {
            let later = |t: &f64| if *t > 3.4 { t + pause } else { *t };
            let times: Vec<f64> = moving.iter().map(later).collect();
            let actual = smooth(&times, &signal, 5).unwrap();
            assert!((actual.noise / 0.05 - 1.0).abs() < 0.08, "{actual:?}");
            let (spline, coefficients) = nearest(&times, &signal, (60, 1), 5).unwrap();
            assert_eq!(spline.runs(), [0..300, 300..720]);
            let sampled = SplineValues::new(&spline, &times, 1);
            for (i, t) in moving.iter().enumerate().skip(10).step_by(40) {
                let (rate, exact) = (sampled.value(i, &coefficients), 9.0 * (9.0 * t).cos());
                assert!((rate - exact).abs() < 2.0, "{t}: {rate} {exact}");
            }
        }
        // Too few instants lie between two gaps for a motion to be known there.
        let mut lonely = moving;
        lonely.retain(|t| !(3.85..4.5).contains(t));
        assert!(PiecewiseSpline::new(&lonely, 60, 1, 5).is_none());
        assert!(PiecewiseSpline::new(&lonely, 5, 1, 5).is_some());
    }
}
