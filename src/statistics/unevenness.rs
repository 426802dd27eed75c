//! Noise whose size differs from place to place, and from component to component.
//!
//! ```text
//! dᵢ = zᵢ − ¼ Σⱼ zⱼ                       j: the four nearest neighbours of i
//! ln ½|dᵢ|² = γ₀ + γ·q(xᵢ) + eᵢ,           Var e = π²/6       σ(x) ∝ exp(½ γ·q(x))
//! mean of ln(dx²/dy²) = 2 ln σx/σy,        variance π²/N
//! ```
//!
//! q are the linear and quadratic terms of the place, the linear ones alone of few places, and how far a place lies out of the middle of its
//! eight nearest neighbours along each axis, which is nothing but at the margin. What changes slowly from place to place, as
//! a misfit does, is hardly left in differences to neighbours. The evidence is χ² = Σ (ŷ − ȳ)²/(v s²), s² = π²/6 or what is left, beside as many degrees of freedom as q
//! has terms. v = Σᵢⱼ eᵢ eⱼ/Σᵢ eᵢ² over the 24 nearest neighbours j of i is what neighbours have in common, at least that of white noise.
//!
//! # References
//! A. C. Harvey, Econometrica 44, 461 (1976), doi:10.2307/1913974 (regression of the logarithms);
//! T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika 73, 625 (1986), doi:10.1093/biomet/73.3.625 (differences)

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::{chi_squared_limit, extremes, nearest};

/// Fewer places tell nothing, and fewer than the second number nothing of quadratic terms.
const FEWEST: [usize; 2] = [30, 60];

/// Neighbours of a place that differences are taken to, and those whose middle it may lie out of.
const NEIGHBOURS: usize = 4;
const AROUND: usize = 8;

/// The variance of the logarithm of half the square of a vector of white noise.
const VARIANCE: f64 = PI * PI / 6.0;

/// What variances of means of neighbouring logarithms grow by: differences of neighbours on a square grid correlate by −0.4, their
/// logarithms therefore by Li₂(0.16)/(π²/6) = 0.10.
const COMMON: f64 = 1.45;

/// Neighbours that may have noise in common where it correlates.
const FAR: usize = 24;

/// Probability by chance below which noise is uneven, and the least ratio of the largest deviation to the smallest that matters.
const LEVEL: f64 = 1e-4;
const LEAST: f64 = 1.25;

/// The same of the components, in standard errors and as a ratio.
const SURE: f64 = 4.0;
const LEAST_OF_COMPONENTS: f64 = 1.1;

/// Terms of a place.
const TERMS: usize = 7;

/// How much larger or smaller noise is than elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Unevenness {
    /// The factor of the standard deviation of each component at each place.
    pub factors: Vec<[f64; 2]>,
}

impl Unevenness {
    /// What vectors of noise show at some places, `None` at those that are not sound; `None` where all may be of one size.
    pub fn found(places: &[[f64; 2]], noise: &[Option<[f64; 2]>]) -> Option<Self> {
        let sound = places.iter().zip(noise);
        let (own, z): (Vec<_>, Vec<_>) =
            sound.filter_map(|(place, z)| Some((*place, (*z)?))).unzip();
        if own.len() < FEWEST[0] {
            return None;
        }
        let differences = differences(&own, &z)?;
        let squares = differences.iter().map(|[x, y]| 0.5 * (x * x + y * y));
        let sites: Vec<[f64; TERMS]> = terms(&own, &own);
        let slopes = slopes(&own, &sites, &logarithms(squares));
        let ratio = ratio_of_components(&differences);
        if slopes.is_none() && ratio.is_none() {
            return None;
        }
        let slopes = slopes.unwrap_or([0.0; TERMS]);
        let ratio = ratio.unwrap_or(1.0).sqrt();
        let factors = terms(places, &own).into_iter().map(|terms| {
            let factor = factor(&slopes, &terms);
            [factor * ratio, factor / ratio]
        });
        Some(Self {
            factors: factors.collect(),
        })
    }
}

/// exp(½ γ·q).
fn factor(slopes: &[f64; TERMS], terms: &[f64; TERMS]) -> f64 {
    // Quadratic terms reach far where places are few.
    const MOST: f64 = 3.0;
    let logarithm: f64 = slopes
        .iter()
        .zip(terms)
        .map(|(slope, term)| slope * term)
        .sum();
    (0.5 * logarithm).clamp(-MOST, MOST).exp()
}

/// q of places, relative to those that are sound.
fn terms(places: &[[f64; 2]], sound: &[[f64; 2]]) -> Vec<[f64; TERMS]> {
    let sides = [0, 1].map(|axis| extremes(sound.iter().map(|place| place[axis])));
    let around = nearest(places, AROUND).into_iter().zip(places);
    let of_place = |(others, place): (Vec<usize>, &[f64; 2])| {
        let [x, y] = [0, 1].map(|axis| {
            let [low, high] = sides[axis];
            (2.0 * place[axis] - low - high) / (high - low).max(f64::MIN_POSITIVE)
        });
        let away = others
            .iter()
            .map(|other| [0, 1].map(|axis| places[*other][axis] - place[axis]));
        let (sum, far) = away.fold(([0.0; 2], 0.0), |(sum, far), [x, y]| {
            ([sum[0] + x, sum[1] + y], far + x.hypot(y))
        });
        let [out_x, out_y] = sum.map(|sum| sum.abs() / far);
        [x, y, out_x, out_y, x * x, x * y, y * y]
    };
    around.map(of_place).collect()
}

/// γ, where chance would hardly make it; quadratic terms are none where places are few.
fn slopes(
    places: &[[f64; 2]],
    sites: &[[f64; TERMS]],
    logarithms: &DVector<f64>,
) -> Option<[f64; TERMS]> {
    let count = match places.len() < FEWEST[1] {
        true => 4,
        false => TERMS,
    };
    let means: Vec<f64> = (0..count)
        .map(|term| sites.iter().map(|site| site[term]).sum::<f64>() / sites.len() as f64)
        .collect();
    let design = DMatrix::from_fn(sites.len(), count, |site, term| {
        sites[site][term] - means[term]
    });
    let right = logarithms.add_scalar(-logarithms.mean());
    let found = design.clone().svd(true, true).solve(&right, 1e-9).ok()?;
    let fitted = &design * &found;
    let left = right - &fitted;
    let common = in_common(places, &left).max(COMMON);
    // Gross errors spread logarithms wider than noise does.
    let variance = (left.norm_squared() / left.len() as f64).max(VARIANCE);
    let statistic = fitted.norm_squared() / (common * variance);
    let mut slopes = [0.0; TERMS];
    slopes[..count].copy_from_slice(found.as_slice());
    let [low, high] = extremes(sites.iter().map(|site| factor(&slopes, site)));
    let is_sure = statistic > chi_squared_limit(count as f64, LEVEL);
    (is_sure && high > LEAST * low).then_some(slopes)
}

/// σx/σy, where it is surely not one.
fn ratio_of_components(differences: &[[f64; 2]]) -> Option<f64> {
    let of_axis = |axis: usize| logarithms(differences.iter().map(|own| own[axis] * own[axis]));
    let mean = (of_axis(0) - of_axis(1)).mean();
    let error = PI * (COMMON / differences.len() as f64).sqrt();
    let is_sure = mean.abs() > SURE * error && mean.abs() > 2.0 * LEAST_OF_COMPONENTS.ln();
    is_sure.then(|| (0.5 * mean).exp())
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

/// dᵢ; `None` where there is no noise at all.
fn differences(places: &[[f64; 2]], z: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let around = nearest(places, NEIGHBOURS).into_iter().zip(z);
    let differences = around.map(|(others, own)| {
        let count = others.len() as f64;
        [0, 1].map(|axis| {
            let beside = others.iter().map(|other| z[*other][axis]).sum::<f64>();
            own[axis] - beside / count
        })
    });
    let differences: Vec<[f64; 2]> = differences.collect();
    let is_some = |axis: usize| differences.iter().any(|own| own[axis] != 0.0);
    let all = differences.iter().flatten();
    (is_some(0) && is_some(1) && all.clone().all(|own| own.is_finite())).then_some(differences)
}

/// Logarithms of squares. Rounded values may have no difference to their neighbours at all.
fn logarithms(squares: impl Iterator<Item = f64>) -> DVector<f64> {
    const LEAST: f64 = 1e-4;
    let squares = DVector::from_iterator(squares.size_hint().0, squares);
    let floor = LEAST * squares.mean();
    squares.map(|own| own.max(floor).ln())
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

    fn noise(
        seed: u64,
        places: &[[f64; 2]],
        size: impl Fn([f64; 2]) -> f64,
    ) -> Vec<Option<[f64; 2]>> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        places
            .iter()
            .map(|place| Some([normal(), normal()].map(|value| value * size(*place))))
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
        let margin = |[_, y]: [f64; 2]| if y % 57.0 == 0.0 { 3.0 } else { 1.0 };
        let sizes: [&dyn Fn([f64; 2]) -> f64; 3] = [&along, &outwards, &margin];
        for size in sizes {
            for seed in 0..20 {
                let z = noise(seed, &places, size);
                let found = Unevenness::found(&places, &z).expect("uneven");
                let pairs = places.iter().zip(&found.factors);
                let mut far: Vec<f64> = pairs.map(|(place, [x, _])| x / size(*place)).collect();
                far.sort_by(f64::total_cmp);
                let [low, high] = [far[40], far[760]];
                assert!(high / low < 2.0, "{seed}: {low} {high}");
            }
        }
    }

    /// As of ultrasound, which sees along its beam better than across.
    #[test]
    fn components_of_different_noise_are_found() {
        let places = grid([20, 10]);
        for seed in 0..20 {
            let mut z = noise(seed, &places, |_| 1.0);
            z.iter_mut().flatten().for_each(|own| own[1] *= 0.2);
            let found = Unevenness::found(&places, &z).expect("uneven");
            let [x, y] = found.factors[0];
            assert!((x / y / 5.0 - 1.0).abs() < 0.3, "{seed}: {x} {y}");
        }
    }

    /// A smooth misfit much larger than the noise is not taken for noise.
    #[test]
    fn a_misfit_is_not_taken_for_noise() {
        let places = grid([40, 20]);
        for seed in 0..20 {
            let mut z = noise(seed, &places, |_| 1.0);
            for (own, [x, y]) in z.iter_mut().flatten().zip(&places) {
                own[0] += 6.0 * (((x - 1e3) / 25.0).powi(2) * -1.0).exp();
                own[1] += 3.0 * (y / 30.0).sin();
            }
            assert_eq!(Unevenness::found(&places, &z), None, "{seed}");
        }
    }
}
