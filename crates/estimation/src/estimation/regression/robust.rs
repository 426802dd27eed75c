//! Weights of markers with large residuals, and the level of the noise.
//!
//! ```text
//! dₘ = √(wₘ (rx² + ry²))/s                     distance of marker m in units of the noise s
//! Huber     ω = min(1, k/d),            k = 1.5
//! Tukey     ω = (1 − (d/c)²)²  (d < c), c = 5.1227, else 0
//! s² = median of d² s²/1.3863                  the median of χ² with two degrees of freedom
//! ```
//!
//! With normal noise both have an efficiency of about 95 %. The noise's variance in the intervals is that of an M-estimate,
//! ```text
//! v = w̄ · Σ ψ²/(2 m − tr) / (mean of ψ′)²       ψ = ω r, w̄ the mean of ω, m markers
//! ```
//! which is Σ w r²/(2 m − tr) where all ω are 1.
//!
//! # References
//! P. J. Huber, Robust Statistics (1981), section 7.6; P. J. Rousseeuw, A. M. Leroy, Robust Regression and Outlier
//! Detection (1987)

use serde::{Deserialize, Serialize};

use crate::statistics::robust_deviation;

/// How markers with large residuals are weighted.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq, Serialize)]
pub enum Robust {
    /// The same weight as all others.
    #[default]
    No,
    /// A weight that falls with the distance (Huber).
    Huber,
    /// A weight that is zero beyond a distance (Tukey's biweight).
    Tukey,
}

/// Where Huber's weight begins to fall.
const HUBER: f64 = 1.5;
/// The distance at which Tukey's weight is zero.
const TUKEY: f64 = 5.1227;
/// Known noise counts as contradicted where the markers scatter by more than this factor.
const CONTRADICTED: f64 = 2.0;

/// The level of the noise, and the trust that follows from it.
pub struct Noise {
    /// v.
    pub variance: f64,
    /// s².
    pub sound: f64,
    /// ω of each marker.
    pub trust: Vec<f64>,
}

impl Robust {
    /// The names that conditions use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("no", Self::No),
        ("huber", Self::Huber),
        ("tukey", Self::Tukey),
    ];

    /// ω and the mean of ψ′ over all directions at a distance.
    fn weight(self, distance: f64) -> [f64; 2] {
        match self {
            Self::Huber if distance > HUBER => [HUBER / distance, 0.5 * HUBER / distance],
            Self::No | Self::Huber => [1.0, 1.0],
            Self::Tukey if distance >= TUKEY => [0.0, 0.0],
            Self::Tukey => {
                let share = (distance / TUKEY).powi(2);
                let rest = 1.0 - share;
                [rest * rest, rest * (1.0 - 3.0 * share)]
            }
        }
    }

    /// v and ω from s d of all markers, where `effective` parameters were fitted. With known noise s is 1, unless the markers
    /// scatter twice as much: then they are judged by their own level, because no marker would have any weight otherwise.
    pub fn noise(self, distances: &[f64], effective: f64, known: bool) -> Noise {
        let count = distances.len() as f64;
        let freedom = (2.0 * count - effective).max(1.0);
        if self == Self::No {
            let squares: f64 = distances.iter().map(|d| d * d).sum();
            let level = if known { 1.0 } else { squares / freedom };
            let variance = level.max(f64::MIN_POSITIVE);
            return Noise {
                variance,
                sound: variance,
                trust: vec![1.0; distances.len()],
            };
        }
        let deviation =
            robust_deviation(distances.iter().copied()) * (2.0 * count / freedom).sqrt();
        let scale = if known && deviation <= CONTRADICTED {
            1.0
        } else {
            deviation
        };
        let scale = scale.max(f64::MIN_POSITIVE);
        let (mut trust, mut slope, mut squares) = (Vec::new(), 0.0, 0.0);
        for distance in distances {
            let [weight, derivative] = self.weight(distance / scale);
            squares += (weight * distance).powi(2);
            slope += derivative / count;
            trust.push(weight);
        }
        let mean = trust.iter().sum::<f64>() / count;
        let variance = mean * squares / freedom / (slope * slope);
        Noise {
            variance: variance.max(f64::MIN_POSITIVE),
            sound: scale * scale,
            trust,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::normal_numbers;

    fn distances(count: usize, noise: f64) -> Vec<f64> {
        let mut draw = normal_numbers(7);
        (0..count).map(|_| noise * draw().hypot(draw())).collect()
    }

    #[test]
    fn normal_noise_has_its_variance_at_an_efficiency_of_95_percent() {
        let normal = distances(40_000, 0.3);
        assert!((robust_deviation(normal.iter().copied()) / 0.3 - 1.0).abs() < 0.01);
        for (robust, efficiency) in [
            (Robust::No, 1.0),
            (Robust::Huber, 0.95),
            (Robust::Tukey, 0.95),
        ] {
            let noise = robust.noise(&normal, 0.0, false);
            let mean = noise.trust.iter().sum::<f64>() / normal.len() as f64;
            let computed = 0.09 / (noise.variance / mean);
            assert!(
                (computed - efficiency).abs() < 0.012,
                "{robust:?} {computed}"
            );
        }
    }

    #[test]
    fn gross_errors_hardly_move_the_level() {
        let mut mixed = distances(2000, 0.3);
        mixed[..100].iter_mut().for_each(|d| *d = 20.0);
        let level = |robust: Robust| robust.noise(&mixed, 0.0, false).variance.sqrt();
        assert!(level(Robust::No) > 3.0);
        assert!(level(Robust::Huber) < 0.4 && level(Robust::Tukey) < 0.35);
        assert!(
            Robust::Tukey.noise(&mixed, 0.0, false).trust[..100]
                .iter()
                .all(|w| *w == 0.0)
        );
    }
}
