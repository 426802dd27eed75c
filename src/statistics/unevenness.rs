//! Noise whose size differs from place to place.
//!
//! ```text
//! dᵢ = zᵢ − ¼ Σⱼ zⱼ                       j: the four nearest neighbours of i
//! ln ½|dᵢ|² = γ₀ + γ·q(xᵢ) + eᵢ,           Var e = π²/6       σ(x) ∝ exp(½ γ·q(x))
//! ```
//!
//! q are the linear and quadratic terms of the place, the linear ones alone of few places. What changes slowly from place to place, as
//! a misfit does, is hardly left in differences to neighbours. The evidence is χ² = Σ (ŷ − ȳ)²/(v π²/6) beside as many degrees of freedom as q
//! has terms. v = Σᵢⱼ eᵢ eⱼ/Σᵢ eᵢ² over the 24 nearest neighbours j of i is what neighbours have in common, at least that of white noise.
//!
//! # References
//! A. C. Harvey, Econometrica 44, 461 (1976), doi:10.2307/1913974 (regression of the logarithms);
//! T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika 73, 625 (1986), doi:10.1093/biomet/73.3.625 (differences)

use nalgebra::{DMatrix, DVector};

use super::{chi_squared_limit, extremes, nearest};

/// Fewer places tell nothing, and fewer than the second number nothing of quadratic terms.
const FEWEST: [usize; 2] = [30, 100];

/// Neighbours of a place.
const NEIGHBOURS: usize = 4;

/// The variance of the logarithm of half the square of a vector of white noise.
const VARIANCE: f64 = std::f64::consts::PI * std::f64::consts::PI / 6.0;

/// What variances of means of neighbouring logarithms grow by: differences of neighbours on a square grid correlate by −0.4, their
/// logarithms therefore by Li₂(0.16)/(π²/6) = 0.10.
const COMMON: f64 = 1.45;

/// Neighbours that may have noise in common where it correlates.
const FAR: usize = 24;

/// Probability by chance below which noise is uneven, and the least ratio of the largest deviation to the smallest that matters.
const LEVEL: f64 = 1e-4;
const LEAST: f64 = 1.25;

/// Where noise is larger or smaller than elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Unevenness {
    middle: [f64; 2],
    half: [f64; 2],
    /// Half of γ.
    slopes: Vec<f64>,
}

impl Unevenness {
    /// What vectors of noise `z` at some places show; `None` where they may be of one size.
    pub fn found(places: &[[f64; 2]], z: &[[f64; 2]]) -> Option<Self> {
        let terms = match places.len() {
            count if count < FEWEST[0] => return None,
            count if count < FEWEST[1] => 2,
            _ => 5,
        };
        let logarithms = logarithms(places, z)?;
        let sides = [0, 1].map(|axis| extremes(places.iter().map(|place| place[axis])));
        let mut found = Self {
            middle: sides.map(|[low, high]| 0.5 * (low + high)),
            half: sides.map(|[low, high]| (0.5 * (high - low)).max(f64::MIN_POSITIVE)),
            slopes: vec![0.0; terms],
        };
        let rows: Vec<[f64; 5]> = places.iter().map(|place| found.terms(*place)).collect();
        let mean = logarithms.mean();
        let centres: Vec<f64> = (0..terms)
            .map(|term| rows.iter().map(|row| row[term]).sum::<f64>() / rows.len() as f64)
            .collect();
        let design = DMatrix::from_fn(rows.len(), terms, |row, term| {
            rows[row][term] - centres[term]
        });
        let right = logarithms.map(|value| value - mean);
        let slopes = design.clone().svd(true, true).solve(&right, 1e-9).ok()?;
        let fitted = &design * &slopes;
        let common = in_common(places, &(right - &fitted)).max(COMMON);
        let statistic = fitted.norm_squared() / (common * VARIANCE);
        found.slopes = slopes.iter().map(|slope| 0.5 * slope).collect();
        let [low, high] = extremes(places.iter().map(|place| found.factor(*place)));
        let is_sure = statistic > chi_squared_limit(terms as f64, LEVEL);
        (is_sure && high > LEAST * low).then_some(found)
    }

    /// The standard deviation at a place over that in the middle.
    pub fn factor(&self, place: [f64; 2]) -> f64 {
        // Quadratic terms reach far where places are few.
        const MOST: f64 = 3.0;
        let terms = self.terms(place).into_iter().zip(&self.slopes);
        let logarithm: f64 = terms.map(|(term, slope)| term * slope).sum();
        logarithm.clamp(-MOST, MOST).exp()
    }

    fn terms(&self, place: [f64; 2]) -> [f64; 5] {
        let [x, y] = [0, 1].map(|axis| (place[axis] - self.middle[axis]) / self.half[axis]);
        [x, y, x * x, x * y, y * y]
    }
}

/// v.
fn in_common(places: &[[f64; 2]], left: &DVector<f64>) -> f64 {
    let around = nearest(places, FAR).into_iter().enumerate();
    let products = around.map(|(own, others)| {
        let beside = others.iter().map(|other| left[*other]).sum::<f64>();
        left[own] * (left[own] + beside)
    });
    products.sum::<f64>() / left.norm_squared()
}

/// ln ½|dᵢ|²; `None` where there is no noise at all.
fn logarithms(places: &[[f64; 2]], z: &[[f64; 2]]) -> Option<DVector<f64>> {
    let around = nearest(places, NEIGHBOURS).into_iter().zip(z);
    let squares = around.map(|(others, own)| {
        let count = others.len() as f64;
        let difference = [0, 1].map(|axis| {
            let beside = others.iter().map(|other| z[*other][axis]).sum::<f64>();
            own[axis] - beside / count
        });
        0.5 * (difference[0].powi(2) + difference[1].powi(2))
    });
    let squares: Vec<f64> = squares.collect();
    let whole = squares.iter().sum::<f64>() / squares.len() as f64;
    // Rounded values may have no difference to their neighbours at all.
    let floor = 1e-4 * whole;
    (whole > 0.0 && whole.is_finite()).then(|| {
        DVector::from_iterator(squares.len(), squares.iter().map(|own| own.max(floor).ln()))
    })
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    fn grid([columns, rows]: [usize; 2]) -> Vec<[f64; 2]> {
        let places = (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j)));
        places
            .map(|(i, j)| [1e3 + 2.0 * i as f64, 3.0 * j as f64])
            .collect()
    }

    fn noise(seed: u64, places: &[[f64; 2]], size: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        places
            .iter()
            .map(|place| [normal(), normal()].map(|value| value * size(*place)))
            .collect()
    }

    #[test]
    fn even_noise_is_hardly_ever_uneven() {
        for cells in [[8, 5], [20, 10], [40, 20]] {
            let places = grid(cells);
            let alarms = (0..400).filter(|seed| {
                let z = noise(*seed, &places, |_| 0.3);
                Unevenness::found(&places, &z).is_some()
            });
            let alarms = alarms.count();
            assert!(alarms <= 1, "{cells:?}: {alarms} of 400");
        }
    }

    /// Noise that grows fourfold along the sheet, or towards its edges, is found with its size.
    #[test]
    fn noise_that_grows_is_found() {
        let places = grid([40, 20]);
        let along = |[x, _]: [f64; 2]| 4.0_f64.powf((x - 1e3) / 78.0);
        let outwards = |[x, y]: [f64; 2]| {
            let [x, y] = [(x - 1039.0) / 39.0, (y - 28.5) / 28.5];
            1.0 + x * x + y * y
        };
        let sizes: [&dyn Fn([f64; 2]) -> f64; 2] = [&along, &outwards];
        for size in sizes {
            for seed in 0..20 {
                let z = noise(seed, &places, size);
                let found = Unevenness::found(&places, &z).expect("uneven");
                let far = places
                    .iter()
                    .map(|place| found.factor(*place) / size(*place));
                let [low, high] = extremes(far);
                assert!(high / low < 2.0, "{seed}: {low} {high}");
            }
        }
    }

    /// A smooth misfit much larger than the noise is not taken for noise.
    #[test]
    fn a_misfit_is_not_taken_for_noise() {
        let places = grid([40, 20]);
        for seed in 0..20 {
            let mut z = noise(seed, &places, |_| 1.0);
            for (own, [x, y]) in z.iter_mut().zip(&places) {
                own[0] += 6.0 * (((x - 1e3) / 25.0).powi(2) * -1.0).exp();
                own[1] += 3.0 * (y / 30.0).sin();
            }
            assert_eq!(Unevenness::found(&places, &z), None, "{seed}");
        }
    }
}
