//! The uncertainty of a least-squares fit to curves where the noise may correlate along them.
//!
//! ```text
//! Cov(β) = s² P S R S Pᵀ,   P = (JᵀJ)⁻¹Jᵀ,   s² = rᵀ(R⁻¹ − R⁻¹J (JᵀR⁻¹J)⁻¹ JᵀR⁻¹) r/ν,   ν = n − k
//! w(R) ∝ w₀(R) (det R det JᵀR⁻¹J (s²)^ν)^(−½)                   restricted likelihood, Σ w = 1
//! Σ w(R) P(|t_ν| > h/√(aᵀ Cov a)) = 5 %                         h: half the width of the 95 % interval of aᵀβ
//! L = Σ w₀(R) (det S R S)^(−½) (s² ν/n)^(−n/2)                       likelihood, by which laws are compared
//! ```
//!
//! S are the sizes of the noise of the rows, which differ from curve to curve; in s² and w, J and r stand for S⁻¹J and S⁻¹r.
//!
//! A short curve does not determine how far its noise correlates, and the likeliest length is too short on average: intervals
//! that take it as known cover the truth too seldom. Therefore all noises are averaged: white noise, and exponential correlations
//! whose lengths reach from less than a gap between points to twice the longest curve, each with its weight from the residuals.
//! Distance is counted in points as they follow one another, and in strain where that differs.
//!
//! # References
//! D. A. Harville, J. Am. Stat. Assoc. 72, 320 (1977), doi:10.1080/01621459.1977.10480998;
//! J. O. Berger, V. De Oliveira, B. Sansó, J. Am. Stat. Assoc. 96, 1361 (2001), doi:10.1198/016214501753382282

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::correlation::{Correlation, Decay};
use super::curve::{Curve, NoiseAlong};
use super::{f_tail, student_reach, student_tail};

/// The prior weight of white noise, and of noise with these correlated shares together, over all lengths. Over
/// thousands of points a correlated share of a thousandth is distinguished from none.
const WHITE: f64 = 0.5;
const CORRELATED: [(f64, f64); 4] = [(0.999_99, 0.2), (0.999, 0.15), (0.97, 0.05), (0.6, 0.1)];

/// The shortest length in gaps, the factor to the next one, and the longest over the points of the longest curve.
const SHORTEST: f64 = 0.4;
const STEP: f64 = 1.7;
const LONGEST: f64 = 2.0;

/// Weights below this are left out.
const LEAST: f64 = 1e-5;

/// The residuals of a least-squares fit along curves.
pub struct CurveResiduals<'a> {
    /// J: a row for each residual.
    pub design: &'a DMatrix<f64>,
    /// r.
    pub residual: &'a DVector<f64>,
    /// Orders in which all rows follow one another on curves.
    pub orders: &'a [Vec<Curve>],
    /// The standard deviation of the noise of each row relative to that of all.
    pub sizes: &'a DVector<f64>,
}

/// Possible noise of residuals.
#[derive(Clone, Copy)]
struct Candidate {
    order: usize,
    correlation: Correlation,
    weight: f64,
}

/// One noise with its weight and the covariance of the estimates under it.
#[derive(Clone, Debug)]
struct Part {
    weight: f64,
    covariance: DMatrix<f64>,
    correlation: Correlation,
    independent: f64,
}

/// The uncertainty of the estimates under the noise along curves.
#[derive(Clone, Debug)]
pub struct CurveNoise {
    parts: Vec<Part>,
    freedom: f64,
    /// −2 ln L.
    deviance: f64,
}

/// Columns of unit length and different directions, and the matrix that maps values along them back to estimates.
struct Basis {
    columns: DMatrix<f64>,
    back: DMatrix<f64>,
}

impl Basis {
    /// J = Q S: columns Q and back = S⁻¹; directions that J does not determine at all become huge.
    fn new(design: &DMatrix<f64>) -> Option<Self> {
        const LEAST: f64 = 1e-14;
        let mut scaled = design.clone();
        let mut scales = Vec::new();
        for mut column in scaled.column_iter_mut() {
            let scale = column.norm().max(f64::MIN_POSITIVE);
            column /= scale;
            scales.push(scale);
        }
        let qr = scaled.qr();
        let singular = qr.r().svd(true, true);
        let (u, v) = (singular.u?, singular.v_t?);
        let values = &singular.singular_values;
        let back = DMatrix::from_fn(scales.len(), scales.len(), |i, j| {
            v[(j, i)] / values[j].max(LEAST) / scales[i]
        });
        Some(Self {
            columns: qr.q() * u,
            back,
        })
    }
}

/// The triangle of the QR factorisation of a whitened regression; its last column is the residual.
struct Triangle {
    triangle: DMatrix<f64>,
    log_determinant: f64,
    rows: usize,
}

impl Triangle {
    fn new(noise: NoiseAlong, columns: &DMatrix<f64>) -> Self {
        let (white, log_determinant) = noise.whitened(columns);
        Self {
            rows: white.nrows(),
            triangle: white.qr().r(),
            log_determinant,
        }
    }

    /// The sum of squares of the residual after the fit of the first `columns` columns.
    fn residual_square(&self, columns: usize) -> f64 {
        let last = self.triangle.ncols() - 1;
        let below = self.triangle.column(last).rows_range(columns..).norm();
        below.powi(2).max(f64::MIN_POSITIVE)
    }

    /// ln of the restricted likelihood with all columns.
    fn log_likelihood(&self, freedom: f64) -> f64 {
        let columns = self.triangle.ncols() - 1;
        let diagonal = self.triangle.diagonal();
        let pivots = diagonal.rows(0, columns);
        let design: f64 = pivots.iter().map(|pivot| pivot.abs().ln()).sum();
        -0.5 * self.log_determinant - design - 0.5 * freedom * self.residual_square(columns).ln()
    }

    /// ln of the unrestricted likelihood after the fit of the first `columns` columns.
    fn log_unrestricted(&self, columns: usize) -> f64 {
        let rows = self.rows as f64;
        -0.5 * self.log_determinant - 0.5 * rows * (self.residual_square(columns) / rows).ln()
    }
}

impl CurveResiduals<'_> {
    /// The uncertainty of the estimates; `None` where there are no more rows than estimates.
    pub fn noise(&self) -> Option<CurveNoise> {
        let rows = self.design.nrows();
        let estimates = self.design.ncols();
        let freedom = rows.checked_sub(estimates).filter(|freedom| *freedom > 0)? as f64;
        let basis = Basis::new(self.design)?;
        let columns = self.standardised(&with_last(&basis.columns, self.residual));
        // S times the columns.
        let sized = basis
            .columns
            .map_with_location(|row, _, value| value * self.sizes[row]);
        let part = |candidate: &Candidate| {
            let noise = self.along(candidate);
            let triangle = Triangle::new(noise, &columns);
            let spread = sized.tr_mul(&noise.product(&sized));
            let variance = triangle.residual_square(estimates) / freedom;
            let part = Part {
                weight: candidate.weight,
                covariance: &basis.back * spread * basis.back.transpose() * variance,
                correlation: candidate.correlation,
                independent: noise.independent(),
            };
            let likelihoods = [
                triangle.log_likelihood(freedom),
                triangle.log_unrestricted(estimates),
            ];
            (part, likelihoods)
        };
        let parts: Vec<(Part, [f64; 2])> = self.candidates().par_iter().map(part).collect();
        let weights = shares(parts.iter().map(|(part, [log, _])| part.weight.ln() + log));
        let unrestricted = parts.iter().map(|(part, [_, log])| part.weight.ln() + log);
        let deviance = -2.0 * log_of_sum(unrestricted.collect());
        let weighed = parts.into_iter().zip(weights);
        let significant = weighed.filter(|(_, weight)| *weight > LEAST);
        let parts = significant.map(|((part, _), weight)| Part { weight, ..part });
        Some(CurveNoise {
            parts: parts.collect(),
            freedom,
            deviance: deviance + 2.0 * self.sizes.iter().map(|size| size.ln()).sum::<f64>(),
        })
    }

    /// The probability that smooth functions, a column each, reduce noise as much as the residuals; `None` where too few rows remain.
    ///
    /// ```text
    /// F = ((S₀ − S₁)/q)/(S₁/(n − k − q)),   p = Σ w(R) P(F_(q, n−k−q) > F),   w by the likelihood with the functions
    /// ```
    pub fn pattern(&self, functions: &DMatrix<f64>) -> Option<f64> {
        const FEWEST: usize = 4;
        let basis = Basis::new(self.design)?;
        let all = with_functions(basis.columns, functions);
        let estimates = self.design.ncols();
        let extra = all.ncols() - estimates;
        let remaining = all.nrows().checked_sub(all.ncols())?;
        if remaining < FEWEST || extra == 0 {
            return None;
        }
        let freedom = remaining as f64;
        let columns = self.standardised(&with_last(&all, self.residual));
        let tried = |candidate: &Candidate| {
            let noise = self.along(candidate);
            let triangle = Triangle::new(noise, &columns);
            let without = triangle.residual_square(estimates);
            let with = triangle.residual_square(estimates + extra);
            let ratio = (without - with) / extra as f64 / (with / freedom);
            let log = candidate.weight.ln() + triangle.log_likelihood(freedom);
            (f_tail([extra as f64, freedom], ratio), log)
        };
        let tried: Vec<(f64, f64)> = self.candidates().par_iter().map(tried).collect();
        let weights = shares(tried.iter().map(|(_, log)| *log));
        let pairs = tried.iter().zip(&weights);
        Some(pairs.map(|((tail, _), weight)| tail * weight).sum())
    }

    /// S⁻¹ times some columns, so that the noise of all rows has one size.
    fn standardised(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        columns.map_with_location(|row, _, value| value / self.sizes[row])
    }

    fn along(&self, candidate: &Candidate) -> NoiseAlong<'_> {
        NoiseAlong {
            curves: &self.orders[candidate.order],
            correlation: candidate.correlation,
        }
    }

    fn candidates(&self) -> Vec<Candidate> {
        let curves = self.orders.iter().flatten();
        let longest = curves.map(|curve| curve.rows.len()).max().unwrap_or(0) as f64;
        let geometric = std::iter::successors(Some(SHORTEST), |length| Some(STEP * length));
        let lengths: Vec<f64> = geometric.take_while(|l| *l <= LONGEST * longest).collect();
        let each = (lengths.len() * self.orders.len()) as f64;
        let correlation = |share: f64, length: f64| Correlation {
            decay: Decay::Exponential,
            share,
            length,
        };
        let white = Candidate {
            order: 0,
            correlation: correlation(0.0, 1.0),
            weight: WHITE,
        };
        let mut candidates = vec![white];
        for order in 0..self.orders.len() {
            for (share, weight) in CORRELATED {
                candidates.extend(lengths.iter().map(|length| Candidate {
                    order,
                    correlation: correlation(share, *length),
                    weight: weight / each,
                }));
            }
        }
        candidates
    }
}

impl CurveNoise {
    /// The same where something that was taken as known moves the estimates by `moved` for its standard error.
    #[must_use]
    pub fn with_moved(mut self, moved: &DVector<f64>) -> Self {
        for part in &mut self.parts {
            part.covariance += moved * moved.transpose();
        }
        self
    }

    /// Half the width of the 95 % interval of aᵀβ.
    pub fn half_width(&self, a: &DVector<f64>) -> f64 {
        const HALVINGS: usize = 40;
        const MISSED: f64 = 0.05;
        let error = |part: &Part| a.dot(&(&part.covariance * a)).max(0.0).sqrt();
        let errors: Vec<f64> = self.parts.iter().map(error).collect();
        if errors.iter().any(|error| !error.is_finite()) {
            return f64::NAN;
        }
        let [least, most] = super::extremes(errors.iter().copied());
        let reach = self.reach();
        let [mut low, mut high] = [least * reach, most * reach];
        for _ in 0..HALVINGS {
            if high - low <= 1e-12 * high {
                break;
            }
            let middle = 0.5 * (low + high);
            let missed = self.parts.iter().zip(&errors).map(|(part, error)| {
                part.weight * 2.0 * student_tail(self.freedom, middle / error)
            });
            if missed.sum::<f64>() > MISSED {
                low = middle
            } else {
                high = middle
            }
        }
        high
    }

    /// Half the width of a 95 % interval in standard errors, where one noise is known to be the true one.
    pub fn reach(&self) -> f64 {
        student_reach(self.freedom)
    }

    /// The covariance of the estimates.
    pub fn covariance(&self) -> DMatrix<f64> {
        let size = self.parts[0].covariance.nrows();
        let parts = self.parts.iter();
        parts.fold(DMatrix::zeros(size, size), |sum, part| {
            sum + &part.covariance * part.weight
        })
    }

    /// −2 ln of the likelihood of the residuals, except for a constant.
    pub fn deviance(&self) -> f64 {
        self.deviance
    }

    /// The number of independent values with the same information on the noise's variance as all of them.
    pub fn independent(&self) -> f64 {
        self.mean(|part| part.independent)
    }

    /// The correlation of values one gap apart.
    pub fn of_neighbours(&self) -> f64 {
        self.mean(|part| part.correlation.at(1.0))
    }

    fn mean(&self, value: impl Fn(&Part) -> f64) -> f64 {
        let parts = self.parts.iter();
        parts.map(|part| part.weight * value(part)).sum()
    }
}

/// Weights with the sum 1 whose logarithms are these, except for a constant.
fn shares(logarithms: impl Iterator<Item = f64>) -> Vec<f64> {
    let logarithms: Vec<f64> = logarithms.collect();
    let total = log_of_sum(logarithms.clone());
    let shares = logarithms.iter().map(|one| (one - total).exp());
    shares.collect()
}

/// ln Σ eˣ.
fn log_of_sum(logarithms: Vec<f64>) -> f64 {
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sizes = logarithms.iter().map(|one| (one - largest).exp());
    largest + sizes.sum::<f64>().ln()
}

fn with_last(columns: &DMatrix<f64>, last: &DVector<f64>) -> DMatrix<f64> {
    let mut all = columns.clone().insert_column(columns.ncols(), 0.0);
    all.set_column(columns.ncols(), last);
    all
}

/// Columns, extended by the parts of the functions that are linearly independent of them.
fn with_functions(mut columns: DMatrix<f64>, functions: &DMatrix<f64>) -> DMatrix<f64> {
    /// The least part of a function that must be independent of the columns before it.
    const LEAST: f64 = 1e-4;
    for function in functions.column_iter() {
        let mut rest: DVector<f64> = function.into_owned();
        let size = rest.norm();
        for _ in 0..2 {
            let known = columns.tr_mul(&rest);
            rest -= &columns * known;
        }
        let norm = rest.norm();
        if norm > LEAST * size {
            columns = with_last(&columns, &(rest / norm));
        }
    }
    columns
}

#[cfg(test)]
mod tests;
