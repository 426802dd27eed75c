//! Noise whose size differs between positions, and between components.
//!
//! ```text
//! dᵢ = zᵢ − ¼ Σⱼ zⱼ                       j: the four nearest neighbours of i
//! ½ ln dx²/dy² = h₀ + h·q(xᵢ) + fᵢ,        Var f = π²/4       one component relative to the other
//! ½ ln dx²dy² = g₀ + g·q(xᵢ) + eᵢ,         Var e = π²/4       both together
//! ln (dx² e⁻ʰ⁰ + dy² eʰ⁰) = g₀ + g·q(xᵢ) + eᵢ,  Var e = π²/6  the same where h = 0: more precise
//! σx, σy ∝ exp(½ (g·q(x) ± (h₀ + h·q(x))))
//! ```
//!
//! q are the linear and quadratic terms of the position (the linear ones alone where there are few positions), and the distance along
//! each axis from the centre of the eight nearest neighbours, which is large at the margin alone. A misfit, or noise that correlates,
//! changes slowly with the position and almost cancels in differences to neighbours, except at the margin, where neighbours lie on one
//! side: where neighbours correlate, the terms of the margin are left out. The evidence is χ² = Σ (ŷ − ȳ)²/(v s²) with as many degrees
//! of freedom as q has terms; s² is Var, or the variance of the residuals where that is larger. v = Σᵢⱼ eᵢ eⱼ/Σᵢ eᵢ² over the 24
//! nearest neighbours j of i accounts for the correlation of the residuals; it is at least that of white noise.
//!
//! # References
//! A. C. Harvey, Econometrica 44, 461 (1976), doi:10.2307/1913974 (regression of the logarithms);
//! T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika 73, 625 (1986), doi:10.1093/biomet/73.3.625 (differences)

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::{chi_squared_limit, extremes, nearest, quantile};

/// The fewest positions for linear terms, and for quadratic ones.
const FEWEST: [usize; 2] = [30, 60];

/// The number of neighbours in differences, and of those whose centre shows the margin.
const NEIGHBOURS: usize = 4;
const SURROUNDING: usize = 8;

/// The correlation of neighbours above which the margin is not analysed, and the least distance from the centre of the neighbours there.
const CORRELATED: f64 = 0.3;
const MARGIN: f64 = 0.2;

/// The number of neighbours whose noise may correlate.
const CORRELATED_NEIGHBOURS: usize = 24;

/// The variance of half the sum, and of half the difference, of the logarithms of the squares of two components of white noise; that of
/// the logarithm of the sum of their squares.
const VARIANCE: f64 = PI * PI / 4.0;
const VARIANCE_OF_SUM: f64 = PI * PI / 6.0;

/// v of white noise: differences of neighbours on a square grid correlate by −0.4, their logarithms by about 0.10.
const COMMON: f64 = 1.45;

/// Probability by chance below which noise is uneven, and the least ratio of the largest deviation to the smallest that matters.
const LEVEL: f64 = 1e-4;
const LEAST: f64 = 1.25;

/// The same limits for the components, in standard errors and as a ratio.
const SIGNIFICANT: f64 = 4.0;
const LEAST_OF_COMPONENTS: f64 = 1.1;

/// The number of terms q, and of those that are used where there are few positions.
const TERMS: usize = 7;
const FEW_TERMS: usize = 4;

/// The terms of the margin.
const MARGIN_TERMS: [usize; 2] = [2, 3];

/// The largest logarithm of a ratio of deviations: with few positions, quadratic terms would extrapolate too far.
const MOST: f64 = 2.5;

/// The variation of the size of noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Unevenness {
    /// The factor of the standard deviation of each component at each position; their geometric mean is one.
    pub factors: Vec<[f64; 2]>,
}

impl Unevenness {
    /// The unevenness of vectors of noise at some positions, which are `None` at unsound positions; `None` where all may be of one size.
    pub fn of(positions: &[[f64; 2]], noise: &[Option<[f64; 2]>]) -> Option<Self> {
        let sound = positions.iter().zip(noise);
        let (places, z): (Vec<_>, Vec<_>) = sound
            .filter_map(|(position, z)| Some((*position, (*z)?)))
            .unzip();
        let information = Information::of(&places, &z)?;
        let log_ratios = information.logarithms(VARIANCE, |x, y| 0.5 * (x / y).ln());
        let ratios = information.slopes(&log_ratios);
        let ratio = information.mean_log_ratio(&log_ratios);
        let by = ratio.unwrap_or(0.0).exp();
        let log_sizes = match ratios {
            Some(_) => information.logarithms(VARIANCE, |x, y| 0.5 * (x * y).ln()),
            None => information.logarithms(VARIANCE_OF_SUM, |x, y| (x / by + y * by).ln()),
        };
        let sizes = information.slopes(&log_sizes);
        if sizes.is_none() && ratios.is_none() && ratio.is_none() {
            return None;
        }
        let around = nearest(positions, SURROUNDING);
        let sites = sites(positions, &around, &places, information.margin)?;
        let nothing = [0.0; TERMS];
        let sizes = at(&sizes.unwrap_or(nothing), &sites);
        // The mean of the logarithms of the ratios, where it is significant.
        let off = match &ratios {
            Some(slopes) => log_ratios.values.mean() - mean(&at(slopes, &information.sites)),
            None => ratio.unwrap_or(0.0),
        };
        let ratios = at(&ratios.unwrap_or(nothing), &sites);
        let pairs = sizes.iter().zip(&ratios);
        let (x, y) = pairs
            .map(|(size, ratio)| (size + ratio + off, size - ratio - off))
            .unzip();
        let [x, y] = [x, y].map(bounded);
        let middle = 0.5 * (mean(&x) + mean(&y));
        let components = x.iter().zip(&y);
        let factors =
            components.map(|(x, y)| [x, y].map(|logarithm| (0.5 * (logarithm - middle)).exp()));
        Some(Self {
            factors: factors.collect(),
        })
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The information in differences to neighbours.
struct Information {
    /// Whether the margin is analysed.
    margin: bool,
    /// q of the positions that are used.
    sites: Vec<[f64; TERMS]>,
    /// Their neighbours.
    around: Vec<Vec<usize>>,
    /// dx² and dy².
    squares: [DVector<f64>; 2],
}

/// Logarithms, and the variance that they have of white noise.
struct Logarithms {
    values: DVector<f64>,
    variance: f64,
}

impl Information {
    /// The differences at sound positions; `None` where these are too few, or have no noise.
    fn of(positions: &[[f64; 2]], z: &[[f64; 2]]) -> Option<Self> {
        if positions.len() < FEWEST[0] {
            return None;
        }
        let around = nearest(positions, CORRELATED_NEIGHBOURS);
        let differences = differences(&around, z)?;
        let margin = correlation(&around, z) < CORRELATED;
        let all = sites(positions, &around, positions, true)?;
        let is_inside =
            |index: &usize| all[*index][MARGIN_TERMS[0]].max(all[*index][MARGIN_TERMS[1]]) < MARGIN;
        let candidates = (0..positions.len()).filter(|index| margin || is_inside(index));
        let chosen: Vec<usize> = candidates.collect();
        if chosen.len() < FEWEST[0] {
            return None;
        }
        let squares = |axis: usize| {
            let squares = chosen.iter().map(|index| differences[*index][axis].powi(2));
            above_rounding(squares.collect())
        };
        let places: Vec<[f64; 2]> = chosen.iter().map(|index| positions[*index]).collect();
        Some(Self {
            margin,
            sites: chosen
                .iter()
                .map(|index| with_margin(all[*index], margin))
                .collect(),
            around: if places.len() == positions.len() {
                around
            } else {
                nearest(&places, CORRELATED_NEIGHBOURS)
            },
            squares: [0, 1].map(squares),
        })
    }

    /// Logarithms as a function of dx² and dy².
    fn logarithms(&self, variance: f64, of: impl Fn(f64, f64) -> f64) -> Logarithms {
        let [x, y] = &self.squares;
        Logarithms {
            values: x.zip_map(y, of),
            variance,
        }
    }

    /// g or h where it is significant; quadratic terms are zero where there are few positions.
    fn slopes(&self, logarithms: &Logarithms) -> Option<[f64; TERMS]> {
        let sites = &self.sites;
        let count = if sites.len() < FEWEST[1] {
            FEW_TERMS
        } else {
            TERMS
        };
        let middle = |term: usize| mean(&sites.iter().map(|site| site[term]).collect::<Vec<_>>());
        let means: Vec<f64> = (0..count).map(middle).collect();
        let design = DMatrix::from_fn(sites.len(), count, |site, term| {
            sites[site][term] - means[term]
        });
        let values = &logarithms.values;
        let right = values.add_scalar(-values.mean());
        let coefficients = design.clone().svd(true, true).solve(&right, 1e-9).ok()?;
        let fitted = &design * &coefficients;
        let statistic =
            fitted.norm_squared() / self.variance(&(right - &fitted), logarithms.variance);
        let mut slopes = [0.0; TERMS];
        slopes[..count].copy_from_slice(coefficients.as_slice());
        let [low, high] = extremes(at(&slopes, sites));
        let is_significant = statistic > chi_squared_limit(count as f64, LEVEL);
        (is_significant && high - low > 2.0 * LEAST.ln()).then_some(slopes)
    }

    /// The mean of ln σx/σy, where it is significantly different from zero.
    fn mean_log_ratio(&self, log_ratios: &Logarithms) -> Option<f64> {
        let mean = log_ratios.values.mean();
        let residuals = log_ratios.values.add_scalar(-mean);
        let error =
            (self.variance(&residuals, log_ratios.variance) / residuals.len() as f64).sqrt();
        let is_significant =
            mean.abs() > SIGNIFICANT * error && mean.abs() > LEAST_OF_COMPONENTS.ln();
        is_significant.then_some(mean)
    }

    /// v s², from the residuals. Gross errors spread logarithms more widely than noise does.
    fn variance(&self, residuals: &DVector<f64>, least: f64) -> f64 {
        let products = self.around.iter().enumerate().map(|(index, others)| {
            let adjacent = others.iter().map(|other| residuals[*other]).sum::<f64>();
            residuals[index] * (residuals[index] + adjacent)
        });
        let square = residuals.norm_squared();
        let common = share(products.sum::<f64>(), square).max(COMMON);
        common * (square / residuals.len() as f64).max(least)
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

/// Logarithms of variances, limited from below by their 10 % quantile and from above relative to it: the lowest ones lie where few positions
/// determine them, and would have the largest influence.
fn bounded(logarithms: Vec<f64>) -> Vec<f64> {
    const FEW: f64 = 0.1;
    let mut sorted = logarithms.clone();
    sorted.sort_by(f64::total_cmp);
    let least = quantile(&sorted, FEW);
    let most = least + 2.0 * MOST;
    logarithms
        .into_iter()
        .map(|logarithm| logarithm.clamp(least, most))
        .collect()
}

/// q of positions, relative to the range of the sound ones; `None` where it is not a number.
fn sites(
    positions: &[[f64; 2]],
    around: &[Vec<usize>],
    sound: &[[f64; 2]],
    margin: bool,
) -> Option<Vec<[f64; TERMS]>> {
    let sides = [0, 1].map(|axis| extremes(sound.iter().map(|position| position[axis])));
    let of_place = |(position, others): (&[f64; 2], &Vec<usize>)| {
        let [x, y] = [0, 1].map(|axis| {
            let [low, high] = sides[axis];
            share(2.0 * position[axis] - low - high, high - low)
        });
        let others = &others[..others.len().min(SURROUNDING)];
        let [out_x, out_y] = off_centre(positions, *position, others);
        with_margin([x, y, out_x, out_y, x * x, x * y, y * y], margin)
    };
    let all: Vec<_> = positions.iter().zip(around).map(of_place).collect();
    all.iter()
        .flatten()
        .all(|term| term.is_finite())
        .then_some(all)
}

/// The distance of a position from the centre of its neighbours along each axis, over their mean distance.
fn off_centre(positions: &[[f64; 2]], [x, y]: [f64; 2], others: &[usize]) -> [f64; 2] {
    let away = others
        .iter()
        .map(|other| [positions[*other][0] - x, positions[*other][1] - y]);
    let (sum, far) = away.fold(([0.0; 2], 0.0), |(sum, far), [x, y]| {
        ([sum[0] + x, sum[1] + y], far + x.hypot(y))
    });
    sum.map(|sum: f64| share(sum.abs(), far))
}

/// A ratio; zero where the denominator is not positive.
fn share(part: f64, total: f64) -> f64 {
    if total > 0.0 { part / total } else { 0.0 }
}

/// dᵢ; `None` where a component has no noise at all.
fn differences(around: &[Vec<usize>], z: &[[f64; 2]]) -> Option<Vec<[f64; 2]>> {
    let pairs = around.iter().zip(z);
    let differences = pairs.map(|(others, vector)| {
        let others = &others[..NEIGHBOURS];
        [0, 1].map(|axis| {
            let adjacent = others.iter().map(|other| z[*other][axis]).sum::<f64>();
            vector[axis] - adjacent / NEIGHBOURS as f64
        })
    });
    let differences: Vec<[f64; 2]> = differences.collect();
    let is_some = |axis: usize| differences.iter().any(|vector| vector[axis] != 0.0);
    let all = differences.iter().flatten();
    (is_some(0) && is_some(1) && all.clone().all(|component| component.is_finite()))
        .then_some(differences)
}

/// The correlation of neighbours, of both components together.
fn correlation(around: &[Vec<usize>], z: &[[f64; 2]]) -> f64 {
    let of_place = |(others, vector): (&Vec<usize>, &[f64; 2])| -> f64 {
        let others = others[..NEIGHBOURS].iter();
        let products = others.map(|other| vector[0] * z[*other][0] + vector[1] * z[*other][1]);
        products.sum::<f64>() / NEIGHBOURS as f64
    };
    let squares = z.iter().map(|[x, y]| x * x + y * y);
    share(around.iter().zip(z).map(of_place).sum(), squares.sum())
}

/// The terms of a site; those of the margin are zero where it is not analysed.
fn with_margin(mut site: [f64; TERMS], margin: bool) -> [f64; TERMS] {
    if !margin {
        MARGIN_TERMS.into_iter().for_each(|term| site[term] = 0.0);
    }
    site
}

/// Squares above zero, which have logarithms: rounded values may equal their neighbours.
fn above_rounding(squares: Vec<f64>) -> DVector<f64> {
    const LEAST: f64 = 1e-4;
    let squares = DVector::from_vec(squares);
    let floor = LEAST * squares.mean();
    squares.map(|square| square.max(floor))
}

#[cfg(test)]
mod tests;
