//! The effect on an estimate of noise that is correlated, or that differs from the stated noise.
//!
//! ```text
//! Cov(p) = M⁻¹ (τ² ÃᵀRÃ + S) M⁻¹,   Ã = √(W/v) A                  M⁻¹ where the noise is white: R = 1, τ² = 1
//! ```
//!
//! The field remains the one nearest to the data; only its covariance follows the noise that was found.

use super::input::Observations;
use super::judge::Judgement;
use super::outcome::MarkerEstimate;
use super::regression::MarkerRows;
use super::search::NearestField;
use crate::error::Error;
use crate::statistics::{Sites, Unevenness, extremes, robust_deviation};

/// Noise that differs from the stated noise by more than this factor contradicts it, if also by four standard errors.
const OFF: f64 = 1.25;

/// Standardised residual from which on a marker is a gross error, even where noise is larger than elsewhere.
const GROSS: f64 = 8.0;

/// How often weights are adapted to noise that varies over the sheet.
const ROUNDS: usize = 3;

/// Noise of the markers that differs from the assumed noise.
#[derive(Clone, Debug, Default)]
pub struct OtherNoise {
    /// The ratio of the markers' scatter to their stated noise, where they contradict it by its size or by its variation.
    pub ratio: Option<f64>,
    /// How it varies over the sheet.
    pub unevenness: Option<Unevenness>,
}

/// A search with the noise of the data: where they contradict the stated noise its size is estimated, and markers where
/// noise is larger have less weight. Also returns the ratio of the scatter to the stated noise, where that is contradicted.
///
/// # Errors
/// As the search.
pub fn with_observed_noise<T>(
    observations: &mut Observations,
    search: impl Fn(&Observations) -> Result<(T, OtherNoise), Error>,
) -> Result<(T, Option<f64>), Error> {
    let mut ratio = None;
    loop {
        let (result, other) = search(observations)?;
        if !observations.adapt_to(&other) {
            return Ok((result, ratio));
        }
        ratio = ratio.or(other.ratio);
    }
}

/// Whether a marker's noise is representative of that of others.
fn is_sound(marker: &Option<MarkerEstimate>) -> bool {
    marker
        .as_ref()
        .is_some_and(|marker| marker.standardised_residual < GROSS)
}

impl OtherNoise {
    /// Whether the noise is as assumed.
    pub fn is_none(&self) -> bool {
        self.ratio.is_none() && self.unevenness.is_none()
    }
}

impl Observations {
    /// Adapts the weights to other noise; returns whether there is any.
    fn adapt_to(&mut self, other: &OtherNoise) -> bool {
        if other.is_none() {
            return false;
        }
        self.known_noise = false;
        if let Some(unevenness) = &other.unevenness {
            self.reweighted += 1;
            let factors = unevenness.factors.iter().flatten();
            for (weight, factor) in self.weights.iter_mut().zip(factors) {
                *weight /= factor * factor;
            }
        }
        true
    }
}

impl NearestField<'_> {
    /// The noise of the markers where it differs from the assumed noise.
    pub(super) fn other_noise(&self, markers: &[Option<MarkerEstimate>]) -> OtherNoise {
        let uneven = self.unevenness(markers);
        let unevenness = uneven.filter(|_| !self.is_mesh_error(markers));
        OtherNoise {
            ratio: self.contradicted_noise(markers, unevenness.is_some()),
            unevenness,
        }
    }

    /// Whether a large part of the markers' residuals is the discretisation error or rounding, which are no noise.
    fn is_mesh_error(&self, markers: &[Option<MarkerEstimate>]) -> bool {
        const MUCH: f64 = 0.2;
        const ROUNDING: f64 = 1e-6;
        let observations = self.observations();
        let size = |values: &dyn Fn(usize) -> f64| {
            let all = observations.chosen.iter().enumerate();
            let sound = all.filter(|(_, index)| is_sound(&markers[**index]));
            let rows = sound.flat_map(|(row, _)| [2 * row, 2 * row + 1]);
            let squares = rows.map(|row| observations.weights[row] * values(row).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let residual = size(&|row| self.fit.residual[row]);
        if residual <= ROUNDING * size(&|row| observations.displacements[row / 2][row % 2]) {
            return true;
        }
        let mesh_error = self.mesh_error();
        mesh_error.is_some_and(|error| size(&|row| error.markers[row]) > MUCH * residual)
    }

    /// The variation of the markers' noise over the sheet; outliers count, except gross errors.
    fn unevenness(&self, markers: &[Option<MarkerEstimate>]) -> Option<Unevenness> {
        let observations = self.observations();
        if observations.reweighted >= ROUNDS {
            return None;
        }
        let estimates = observations.chosen.iter().map(|index| &markers[*index]);
        let residuals = estimates.enumerate().map(|(index, marker)| {
            is_sound(marker).then(|| {
                [0, 1].map(|axis| {
                    let row = 2 * index + axis;
                    observations.weights[row].sqrt() * self.fit.residual[row]
                })
            })
        });
        Unevenness::of(&observations.positions, &residuals.collect::<Vec<_>>())
    }

    /// The ratio of the markers' scatter to their stated noise, from the median of the standardised residuals, where
    /// it is far from one or the noise varies over the sheet (`other`).
    fn contradicted_noise(&self, markers: &[Option<MarkerEstimate>], other: bool) -> Option<f64> {
        // The standard error of ln of a deviation from the median.
        const ERROR: f64 = 0.72;
        const SURE: f64 = 4.0;
        let all = markers.iter().flatten();
        let lengths: Vec<f64> = all.map(|marker| marker.standardised_residual).collect();
        if !self.observations().known_noise || lengths.is_empty() {
            return None;
        }
        let sure = SURE * ERROR / (lengths.len() as f64).sqrt();
        let ratio = self.variances.sound.sqrt() * robust_deviation(lengths);
        (other || ratio.ln().abs() > OFF.ln().max(sure)).then_some(ratio)
    }

    /// The least and the largest standard deviation of the noise of markers along x and along y in mm, where the weights have followed the data.
    pub(super) fn deviations(&self, variance_ratio: f64) -> Option<[[f64; 2]; 2]> {
        let observations = self.observations();
        let along = |axis: usize| {
            let weights = observations.weights.iter().skip(axis).step_by(2);
            extremes(weights.map(|weight| (variance_ratio * self.variances.sound / weight).sqrt()))
        };
        (observations.reweighted > 0).then(|| [0, 1].map(along))
    }

    /// The standard deviation in mm of white noise for a marker of mean weight.
    pub(super) fn deviation(&self) -> f64 {
        let weights = &self.observations().weights;
        (self.variances.sound * weights.len() as f64 / weights.iter().sum::<f64>()).sqrt()
    }

    /// Sets the covariance under the noise that was found, and adds the bias of smoothing; returns the degrees of freedom of the noise's size
    /// where it is correlated.
    pub(super) fn widen(&mut self, judged: &Judgement) -> Option<f64> {
        let smoothing_bias = self.smoothing_bias();
        let freedom = self.include_noise(judged);
        self.fit.covariance += smoothing_bias;
        freedom
    }

    /// Sets the covariance under the noise that was found, among several the one with the largest variance at the markers; returns the degrees
    /// of freedom of its size where it is correlated.
    fn include_noise(&mut self, judged: &Judgement) -> Option<f64> {
        const LEAST: f64 = 3.0;
        let observations = self.observations();
        let sites = Sites::new(observations.positions.clone());
        let rows = MarkerRows {
            design: &self.linear.design,
            weights: &observations.weights,
            variances: &self.variances,
        };
        let (covariance_before, information) = (&self.fit.covariance, rows.information());
        let widened = judged.noises.iter().map(|noise| {
            let middle = rows.spread(noise, &sites) + &self.fit.held;
            let covariance = covariance_before * middle * covariance_before;
            (covariance.dot(&information), covariance, noise)
        });
        let (_, covariance, noise) = widened.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let independent = noise.correlation.independent(sites.positions());
        self.fit.covariance = covariance;
        Some((2.0 * independent - self.fit.effective).max(LEAST))
    }
}
