//! Least-squares splines of a signal over time, with as many parts as its noise allows.

use crate::solve::vector::{difference, largest, norm};
use crate::solve::{Cholesky, FactorFault, SymmetricPattern};
use crate::statistics::{BSpline, Ends, LocalValues, MOST_FUNCTIONS};

/// Least number of instants for each part of a spline.
const FEWEST: usize = 4;

/// Parts of the motion for each part that cross-validation asks for in either signal alone: two derivatives of the
/// motion enter, and where they are not resolved they cause a bias. Finer parts cost little, because the equation of
/// motion couples them.
const FINER: usize = 4;

/// Parts of the motion that the longest interval between two instants may span: with more empty parts a spline is hardly determined, and oscillates
/// there.
const BRIDGED: f64 = 1.5;

/// The share of a signal's largest value below which a deviation is no evidence against a body: sensors are not more linear, and splines of
/// a motion without noise not more exact.
pub const RESOLUTION: f64 = 1e-3;

/// A spline fitted to one signal alone.
#[derive(Clone, Debug)]
pub struct SignalSpline {
    /// Equal parts of the duration.
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

impl SplineValues {
    /// Derivatives of some order at all `times`.
    pub fn new(spline: &BSpline, times: &[f64], order: usize) -> Self {
        Self {
            rows: times.iter().map(|t| spline.local(*t, order)).collect(),
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

/// The coefficients of the spline nearest to `signal`.
///
/// # Errors
/// [`FactorFault`] when the instants leave gaps of several parts.
pub fn nearest(spline: &BSpline, times: &[f64], signal: &[f64]) -> Result<Vec<f64>, FactorFault> {
    let sampled = SplineValues::new(spline, times, 0);
    let mut matrix = BandMatrix::new(spline.count())?;
    let mut right = vec![0.0; spline.count()];
    for ((first, row), value) in sampled.rows.iter().zip(signal) {
        matrix.add(*first, row);
        for (sum, b) in right[*first..].iter_mut().zip(row) {
            *sum += b * value;
        }
    }
    matrix.factorise()?.solve(&right)
}

/// The number of equal parts for which generalised cross-validation, (‖y − ŷ‖²/n)/(1 − p/n)² with p functions, is
/// least, and the noise √(‖y − ŷ‖²/(n − p)) of the residuals.
pub fn smooth(times: &[f64], signal: &[f64], degree: usize) -> Option<SignalSpline> {
    let n = times.len() as f64;
    let range = [times[0], times[times.len() - 1]];
    let mut best: Option<(f64, usize, f64)> = None;
    let (mut intervals, most) = (2, times.len() / FEWEST);
    while intervals <= most {
        let spline = BSpline::new(range, intervals, degree, Ends::Uniform);
        if let Ok(coefficients) = nearest(&spline, times, signal) {
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

/// The parts of the motion that the longest interval between two instants allows.
pub fn bridged_parts(times: &[f64]) -> usize {
    let intervals = times.windows(2).map(|pair| pair[1] - pair[0]);
    let longest = intervals.fold(f64::MIN_POSITIVE, f64::max);
    ((BRIDGED * (times[times.len() - 1] - times[0]) / longest) as usize).max(1)
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

    #[test]
    fn instants_with_a_gap_take_a_spline_that_bridges_it() {
        let mut times: Vec<f64> = (0..200).map(f64::from).collect();
        times.retain(|t| !(60.0..90.0).contains(t));
        let signal: Vec<f64> = times.iter().map(|t| (0.02 * t).sin()).collect();
        assert!(smooth(&times, &signal, 5).is_some());
        let fine = BSpline::new([0.0, 199.0], 60, 5, Ends::Uniform);
        assert!(nearest(&fine, &times, &signal).is_err());
    }
}
