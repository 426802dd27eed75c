//! Noise whose size differs from place to place, and from component to component.
//!
//! ```text
//! dᵢ = zᵢ − ¼ Σⱼ zⱼ                       j: the four nearest neighbours of i
//! Vᵢ = 2 meanⱼ γ(rᵢⱼ) − meanⱼₖ γ(rⱼₖ)      of noise of one size with the variogram γ
//! ½ ln dx²dy²/V² = g₀ + g·q(xᵢ) + eᵢ,      Var e = π²/4       both components together
//! ½ ln dx²/dy² = h₀ + h·q(xᵢ) + fᵢ,        Var f = π²/4       one beside the other
//! σx, σy ∝ exp(½ (g·q(x) ± (h₀ + h·q(x))))
//! ```
//!
//! q are the linear and quadratic terms of the place, the linear ones alone of few places, and how far a place lies out of the
//! middle of its eight nearest neighbours along each axis, which is nothing but at the margin. What changes slowly from place to
//! place, as a misfit or noise that correlates, is hardly left in differences to neighbours, but more at the margin, where these lie
//! on one side: V, by the variogram of all places, holds that. The evidence is χ² = Σ (ŷ − ȳ)²/(v s²), s² = π²/4 or what is
//! left, beside as many degrees of freedom as q has terms. v = Σᵢⱼ eᵢ eⱼ/Σᵢ eᵢ² over the 24 nearest neighbours j of i is what
//! neighbours have in common, at least that of white noise.
//!
//! # References
//! A. C. Harvey, Econometrica 44, 461 (1976), doi:10.2307/1913974 (regression of the logarithms);
//! T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika 73, 625 (1986), doi:10.1093/biomet/73.3.625 (differences)

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::{chi_squared_limit, extremes, nearest, quantile};

/// Fewer places tell nothing, and fewer than the second number nothing of quadratic terms.
const FEWEST: [usize; 2] = [30, 60];

/// Neighbours of a place that differences are taken to, and those whose middle it may lie out of.
const NEIGHBOURS: usize = 4;
const AROUND: usize = 8;

/// Neighbours that may have noise in common where it correlates.
const FAR: usize = 24;

/// The variance of half the sum, and of half the difference, of the logarithms of the squares of two components of white noise.
const VARIANCE: f64 = PI * PI / 4.0;

/// What variances of means of neighbouring logarithms grow by: differences of neighbours on a square grid correlate by −0.4, their
/// logarithms by about 0.10.
const COMMON: f64 = 1.45;

/// Probability by chance below which noise is uneven, and the least ratio of the largest deviation to the smallest that matters.
const LEVEL: f64 = 1e-4;
const LEAST: f64 = 1.25;

/// The same of the components, in standard errors and as a ratio.
const SURE: f64 = 4.0;
const LEAST_OF_COMPONENTS: f64 = 1.1;

/// Terms of a place, the first of which are asked for where places are few.
const TERMS: usize = 7;
const FEW_TERMS: usize = 4;

/// The largest logarithm of a ratio of deviations; quadratic terms reach far where places are few.
const MOST: f64 = 2.5;

/// How much larger or smaller noise is than elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Unevenness {
    /// The factor of the standard deviation of each component at each place; their geometric mean is one.
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
        let around = nearest(&own, FAR);
        let differences = differences(&around, &z)?;
        let expected = expected(&own, &around, &z)?;
        let along = |axis: usize| {
            let squares = differences.iter().zip(&expected);
            logarithms(squares.map(|(own, expected)| own[axis] * own[axis] / expected))
        };
        let (x, y) = (along(0), along(1));
        let (together, apart) = (0.5 * (&x + &y), 0.5 * (x - y));
        let own_terms = terms(&own, &own)?;
        let sizes = slopes(&around, &own_terms, &together);
        let ratios = slopes(&around, &own_terms, &apart);
        let ratio = mean_apart(&around, &apart);
        if sizes.is_none() && ratios.is_none() && ratio.is_none() {
            return None;
        }
        let sites = terms(places, &own)?;
        let sizes = sizes.map_or_else(|| vec![0.0; sites.len()], |slopes| at(&slopes, &sites));
        let ratios = match (ratios, ratio) {
            (Some(slopes), _) => {
                // The mean of the sound ones is that of their logarithms.
                let off =
                    apart.mean() - at(&slopes, &own_terms).iter().sum::<f64>() / own.len() as f64;
                at(&slopes, &sites)
                    .into_iter()
                    .map(|own| own + off)
                    .collect()
            }
            (None, ratio) => vec![ratio.unwrap_or(0.0); sites.len()],
        };
        let pairs = sizes.into_iter().zip(ratios);
        let [x, y]: [Vec<f64>; 2] = {
            let (x, y) = pairs
                .map(|(size, ratio)| (size + ratio, size - ratio))
                .unzip();
            [x, y].map(bounded)
        };
        let mean = x.iter().chain(&y).sum::<f64>() / (2.0 * x.len() as f64);
        let factors = x.iter().zip(&y);
        Some(Self {
            factors: factors
                .map(|(x, y)| [x, y].map(|own| (0.5 * (own - mean)).exp()))
                .collect(),
        })
    }
}

/// g·q at sites.
fn at(slopes: &[f64; TERMS], sites: &[[f64; TERMS]]) -> Vec<f64> {
    let of_site = |site: &[f64; TERMS]| {
        slopes
            .iter()
            .zip(site)
            .map(|(slope, term)| slope * term)
            .sum()
    };
    sites.iter().map(of_site).collect()
}

/// Logarithms of variances that do not fall below those of nine tenths: the least ones are where few places tell of them, and would have the
/// largest say.
fn bounded(logarithms: Vec<f64>) -> Vec<f64> {
    const FEW: f64 = 0.1;
    let mut sorted = logarithms.clone();
    sorted.sort_by(f64::total_cmp);
    let least = quantile(&sorted, FEW);
    let most = least + 2.0 * MOST;
    logarithms
        .into_iter()
        .map(|own| own.clamp(least, most))
        .collect()
}

/// q of places, relative to those that are sound; `None` where it is no number.
fn terms(places: &[[f64; 2]], sound: &[[f64; 2]]) -> Option<Vec<[f64; TERMS]>> {
    let sides = [0, 1].map(|axis| extremes(sound.iter().map(|place| place[axis])));
    let around = nearest(places, AROUND).into_iter().enumerate();
    let of_place = |(own, others): (usize, Vec<usize>)| {
        let place = places[own];
        let [x, y] = [0, 1].map(|axis| {
            let [low, high] = sides[axis];
            share(2.0 * place[axis] - low - high, high - low)
        });
        let [out_x, out_y] = out_of_the_middle(places, place, &others);
        [x, y, out_x, out_y, x * x, x * y, y * y]
    };
    let all: Vec<_> = around.map(of_place).collect();
    all.iter()
        .flatten()
        .all(|term| term.is_finite())
        .then_some(all)
}

/// How far a place lies out of the middle of its neighbours along each axis, over their mean distance.
fn out_of_the_middle(places: &[[f64; 2]], [x, y]: [f64; 2], others: &[usize]) -> [f64; 2] {
    let away = others
        .iter()
        .map(|other| [places[*other][0] - x, places[*other][1] - y]);
    let (sum, far) = away.fold(([0.0; 2], 0.0), |(sum, far), [x, y]| {
        ([sum[0] + x, sum[1] + y], far + x.hypot(y))
    });
    sum.map(|sum: f64| share(sum.abs(), far))
}

/// A ratio; of nothing, nothing.
fn share(part: f64, whole: f64) -> f64 {
    match whole > 0.0 {
        true => part / whole,
        false => 0.0,
    }
}

/// g, where chance would hardly make it; quadratic terms are none where places are few.
fn slopes(
    around: &[Vec<usize>],
    sites: &[[f64; TERMS]],
    logarithms: &DVector<f64>,
) -> Option<[f64; TERMS]> {
    let count = match sites.len() < FEWEST[1] {
        true => FEW_TERMS,
        false => TERMS,
    };
    let mean = |term: usize| sites.iter().map(|site| site[term]).sum::<f64>() / sites.len() as f64;
    let means: Vec<f64> = (0..count).map(mean).collect();
    let design = DMatrix::from_fn(sites.len(), count, |site, term| {
        sites[site][term] - means[term]
    });
    let right = logarithms.add_scalar(-logarithms.mean());
    let found = design.clone().svd(true, true).solve(&right, 1e-9).ok()?;
    let fitted = &design * &found;
    let left = right - &fitted;
    // Gross errors spread logarithms wider than noise does.
    let variance = (left.norm_squared() / left.len() as f64).max(VARIANCE);
    let statistic = fitted.norm_squared() / (in_common(around, &left) * variance);
    let mut slopes = [0.0; TERMS];
    slopes[..count].copy_from_slice(found.as_slice());
    let [low, high] = extremes(at(&slopes, sites));
    let is_sure = statistic > chi_squared_limit(count as f64, LEVEL);
    (is_sure && high - low > 2.0 * LEAST.ln()).then_some(slopes)
}

/// The mean of ln σx/σy, where it is surely not nothing.
fn mean_apart(around: &[Vec<usize>], apart: &DVector<f64>) -> Option<f64> {
    let mean = apart.mean();
    let left = apart.add_scalar(-mean);
    let variance = (left.norm_squared() / left.len() as f64).max(VARIANCE);
    let error = (in_common(around, &left) * variance / apart.len() as f64).sqrt();
    let is_sure = mean.abs() > SURE * error && mean.abs() > LEAST_OF_COMPONENTS.ln();
    is_sure.then_some(mean)
}

/// v.
fn in_common(around: &[Vec<usize>], left: &DVector<f64>) -> f64 {
    let products = around.iter().enumerate().map(|(own, others)| {
        let beside = others.iter().map(|other| left[*other]).sum::<f64>();
        left[own] * (left[own] + beside)
    });
    share(products.sum::<f64>(), left.norm_squared()).max(COMMON)
}

/// dᵢ; `None` where a component has no noise at all.
fn differences(around: &[Vec<usize>], z: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let pairs = around.iter().zip(z);
    let differences = pairs.map(|(others, own)| {
        let others = &others[..NEIGHBOURS];
        [0, 1].map(|axis| {
            let beside = others.iter().map(|other| z[*other][axis]).sum::<f64>();
            own[axis] - beside / NEIGHBOURS as f64
        })
    });
    let differences: Vec<[f64; 2]> = differences.collect();
    let is_some = |axis: usize| differences.iter().any(|own| own[axis] != 0.0);
    let all = differences.iter().flatten();
    (is_some(0) && is_some(1) && all.clone().all(|own| own.is_finite())).then_some(differences)
}

/// Vᵢ with the variogram of both components of all places together.
fn expected(places: &[[f64; 2]], around: &[Vec<usize>], z: &[[f64; 2]]) -> Option<Vec<f64>> {
    let variogram = Variogram::new(places, around, z)?;
    let of_place = |(own, others): (usize, &Vec<usize>)| {
        let others = &others[..NEIGHBOURS];
        let count = others.len() as f64;
        let far = others
            .iter()
            .map(|other| variogram.between(places, own, *other));
        let beside = others.iter().flat_map(|one| {
            let variogram = &variogram;
            others
                .iter()
                .map(move |other| variogram.between(places, *one, *other))
        });
        2.0 * far.sum::<f64>() / count - beside.sum::<f64>() / (count * count)
    };
    let all: Vec<f64> = around.iter().enumerate().map(of_place).collect();
    let least = 0.1 * all.iter().sum::<f64>() / all.len() as f64;
    (least > 0.0).then(|| all.iter().map(|own| own.max(least)).collect())
}

/// γ in classes of distance.
struct Variogram {
    width: f64,
    classes: Vec<f64>,
}

impl Variogram {
    /// Of pairs of near neighbours; `None` where all places are one.
    fn new(places: &[[f64; 2]], around: &[Vec<usize>], z: &[[f64; 2]]) -> Option<Self> {
        /// Classes in a mean distance of nearest neighbours.
        const IN_SPACING: f64 = 4.0;
        const CLASSES: usize = 24;
        let nearest = around.iter().enumerate();
        let nearest: f64 = nearest
            .map(|(own, others)| distance(places, own, others[0]))
            .sum();
        let width = nearest / (IN_SPACING * places.len() as f64);
        if !(width > 0.0 && width.is_finite()) {
            return None;
        }
        let mut sums = [(0.0, 0.0); CLASSES];
        for (own, others) in around.iter().enumerate() {
            for other in others {
                let class = (distance(places, own, *other) / width).round() as usize;
                let (sum, pairs) = &mut sums[class.min(CLASSES - 1)];
                let squares = [0, 1].map(|axis| (z[own][axis] - z[*other][axis]).powi(2));
                *sum += 0.5 * (squares[0] + squares[1]);
                *pairs += 1.0;
            }
        }
        // A class without pairs has the value of the one before.
        let mut last = 0.0;
        let classes = sums.map(|(sum, pairs)| {
            if pairs > 0.0 {
                last = sum / pairs;
            }
            last
        });
        Some(Self {
            width,
            classes: classes.to_vec(),
        })
    }

    /// γ between two places, none of a place and itself.
    fn between(&self, places: &[[f64; 2]], one: usize, other: usize) -> f64 {
        if one == other {
            return 0.0;
        }
        let class = (distance(places, one, other) / self.width).round() as usize;
        self.classes[class.min(self.classes.len() - 1)]
    }
}

fn distance(places: &[[f64; 2]], one: usize, other: usize) -> f64 {
    let ([a, b], [c, d]) = (places[one], places[other]);
    (a - c).hypot(b - d)
}

/// Logarithms of squares. Rounded values may have no difference to their neighbours at all.
fn logarithms(squares: impl Iterator<Item = f64>) -> DVector<f64> {
    const LEAST: f64 = 1e-4;
    let squares = DVector::from_vec(squares.collect());
    let floor = LEAST * squares.mean();
    squares.map(|own| own.max(floor).ln())
}

#[cfg(test)]
mod tests;
