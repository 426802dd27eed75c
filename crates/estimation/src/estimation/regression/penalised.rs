//! Linear least squares with penalties on roughness, each weighted by the data.
//!
//! ```text
//! data        r = A δ + noise,   variance v/wᵢ                                     n rows
//! force_rows       g = G δ + noise,   variance 1                                        such as measured forces
//! priors      ρⱼ + Bⱼ δ,         variance 1/λⱼ                                     rank qⱼ each
//!
//! M = AᵀWA/v + GᵀG + Σ λⱼ BⱼᵀBⱼ,   M δ = AᵀWr/v + Gᵀg − Σ λⱼ Bⱼᵀρⱼ,   Cov(δ) = M⁻¹
//! λⱼ ← (qⱼ − λⱼ tr(M⁻¹BⱼᵀBⱼ)) / ‖ρⱼ + Bⱼδ‖²
//! v  ← Σ w r²/(n − tr(M⁻¹AᵀWA)/v)
//! ```
//!
//! The λⱼ maximise the restricted likelihood and are found by the fixed point of Fellner and Schall; where the data
//! carry no information on roughness λ grows without bound, and its term becomes as smooth as possible. M⁻¹ is the
//! covariance given the data, including the bias of the smoothing, so that its intervals cover (Nychka).
//!
//! # References
//! S. N. Wood, M. Fasiolo, Biometrics 73, 1071 (2017), doi:10.1111/biom.12666;
//! D. Nychka, J. Am. Stat. Assoc. 83, 1134 (1988), doi:10.1080/01621459.1988.10478711

use nalgebra::{DMatrix, DVector};

use super::robust::Robust;
use crate::statistics::{CorrelatedNoise, Sites, Whitening, inverse, normal_equations};

/// The curvature of the displacement of one edge along one axis: Σ r² = ∫ (d²u/dt²)² dt with t = 0…1 along the edge.
#[derive(Clone, Debug)]
pub struct Roughness {
    pub edge: String,
    pub axis: usize,
    /// The values r in mm.
    pub values: Vec<f64>,
    /// ∂r/∂p.
    pub slopes: DMatrix<f64>,
    /// Rank of the form.
    pub rank: usize,
}

/// The data of a fit.
pub struct Regression<'a> {
    /// A, two rows per marker.
    pub design: &'a DMatrix<f64>,
    /// r in mm.
    pub residual: DVector<f64>,
    /// Weights of the markers; 1/variance in 1/mm² where the noise is known.
    pub weights: &'a [f64],
    /// Whether the noise is known: v is 1.
    pub known_noise: bool,
    /// G and g.
    pub force_rows: (&'a DMatrix<f64>, &'a DVector<f64>),
    pub priors: Vec<Roughness>,
    /// How markers with large residuals are weighted.
    pub robust: Robust,
    /// Whether the variances are fixed.
    pub settled: bool,
}

/// The variances that are passed from one linearisation to the next.
#[derive(Clone, Debug)]
pub struct VarianceComponents {
    /// λ of each prior; empty before the first fit.
    pub smoothing: Vec<f64>,
    /// Factor in 0…1 of each marker's weight.
    pub trust: Vec<f64>,
    /// v.
    pub variance: f64,
    /// Variance of the noise of sound markers at weight 1: v where all are trusted.
    pub sound: f64,
}

impl VarianceComponents {
    /// The weight of one of a marker's two rows, including the trust in the marker.
    pub fn weight(&self, weights: &[f64], row: usize) -> f64 {
        weights[row] * self.trust[row / 2]
    }
}

pub struct Fit {
    /// δ.
    pub step: DVector<f64>,
    /// M⁻¹.
    pub covariance: DMatrix<f64>,
    /// r − A δ in mm.
    pub residual: DVector<f64>,
    /// √(δᵀ M δ): the length of the step in standard errors.
    pub length: f64,
    /// GᵀG + Σ λⱼ BⱼᵀBⱼ: M without the data.
    pub held: DMatrix<f64>,
    /// tr(M⁻¹AᵀWA)/v, the effective number of parameters.
    pub effective: f64,
    /// qⱼ − λⱼ tr(M⁻¹BⱼᵀBⱼ) of each prior: its remaining freedom.
    pub freedom: Vec<f64>,
}

/// The equations of a step at fixed variances.
pub struct NormalEquations {
    /// M.
    pub matrix: DMatrix<f64>,
    /// Mδ.
    pub target: DVector<f64>,
    /// r'Wr/v + Σ λ ρ'ρ before the step.
    pub misfit: f64,
    /// g'g before the step.
    pub force_misfit: f64,
}

/// A system without a unique solution: the data do not determine the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Undetermined;

const MOST_ITERATIONS: usize = 200;

/// The least pivot of a matrix scaled to a unit diagonal: √1e-13.
const LEAST_PIVOT: f64 = 3.162_277_660_168_379e-7;

/// Change of the effective number of parameters, and relative change of the variance, at which the fixed point is reached.
const CLOSE: f64 = 1e-4;

/// λ beyond which a prior counts as exact, relative to the weight of the data.
const STIFFEST: f64 = 1e7;

impl Regression<'_> {
    /// Fits, beginning at some variances.
    ///
    /// # Errors
    /// [`Undetermined`].
    pub fn fit(&self, variances: &mut VarianceComponents) -> Result<Fit, Undetermined> {
        let forms: Vec<Form> = self.priors.iter().map(Form::new).collect();
        let mut normal = self.normal(variances);
        let scales = self.scales(&normal.0, variances);
        if variances.smoothing.is_empty() {
            variances.smoothing.clone_from(&scales);
        }
        let mut last: Option<f64> = None;
        for iteration in 0.. {
            let fit = self.solve(&normal, &forms, variances)?;
            if self.settled {
                return Ok(fit);
            }
            let before = variances.variance;
            let trusted = self.update(&fit, variances, &scales);
            let settled = last.is_some_and(|last| (fit.effective - last).abs() < CLOSE)
                && (variances.variance / before - 1.0).abs() < CLOSE
                && trusted;
            if settled || iteration == MOST_ITERATIONS {
                return Ok(fit);
            }
            last = Some(fit.effective);
            if !trusted {
                normal = self.normal(variances);
            }
        }
        unreachable!("the iterations end")
    }

    /// AᵀWA and AᵀWr.
    fn normal(&self, variances: &VarianceComponents) -> (DMatrix<f64>, DVector<f64>) {
        normal_equations(self.design, &self.residual, |row| {
            variances.weight(self.weights, row)
        })
    }

    /// λ with which each prior has the weight of the data.
    fn scales(&self, normal: &DMatrix<f64>, variances: &VarianceComponents) -> Vec<f64> {
        let data = normal.trace() / variances.variance;
        let rough = |prior: &Roughness| prior.slopes.norm_squared().max(f64::MIN_POSITIVE);
        let priors = self.priors.iter();
        priors.map(|prior| data / rough(prior)).collect()
    }

    /// M and Mδ at fixed variances, and the misfit at δ = 0.
    pub fn equations(&self, variances: &VarianceComponents) -> NormalEquations {
        let forms: Vec<Form> = self.priors.iter().map(Form::new).collect();
        let (matrix, target, _) = self.system(&self.normal(variances), &forms, variances);
        let data = weighted_square(&self.residual, self.weights, &variances.trust);
        let priors = self.priors.iter().zip(&variances.smoothing);
        let rough = priors.map(|(prior, smoothing)| {
            let square: f64 = prior.values.iter().map(|value| value * value).sum();
            smoothing * square
        });
        NormalEquations {
            matrix,
            target,
            misfit: data / variances.variance + rough.sum::<f64>(),
            force_misfit: self.force_rows.1.norm_squared(),
        }
    }

    /// M, Mδ, and M without the data.
    fn system(
        &self,
        (normal, right): &(DMatrix<f64>, DVector<f64>),
        forms: &[Form],
        variances: &VarianceComponents,
    ) -> (DMatrix<f64>, DVector<f64>, DMatrix<f64>) {
        let (force_rows, values) = self.force_rows;
        let mut held = force_rows.tr_mul(force_rows);
        let mut target = right / variances.variance + force_rows.tr_mul(values);
        for (form, smoothing) in forms.iter().zip(&variances.smoothing) {
            held += &form.square * *smoothing;
            target -= &form.slope * *smoothing;
        }
        (normal / variances.variance + &held, target, held)
    }

    fn solve(
        &self,
        normal: &(DMatrix<f64>, DVector<f64>),
        forms: &[Form],
        variances: &VarianceComponents,
    ) -> Result<Fit, Undetermined> {
        let (matrix, target, held) = self.system(normal, forms, variances);
        let (normal, _) = normal;
        let covariance = inverse(&matrix, LEAST_PIVOT).ok_or(Undetermined)?;
        let step = &covariance * &target;
        let remaining = |(form, smoothing): (&Form, &f64)| {
            (form.rank - smoothing * form.square.dot(&covariance)).max(0.0)
        };
        let priors = forms.iter().zip(&variances.smoothing);
        Ok(Fit {
            residual: &self.residual - self.design * &step,
            effective: normal.dot(&covariance) / variances.variance,
            freedom: priors.map(remaining).collect(),
            length: step.dot(&target).max(0.0).sqrt(),
            covariance,
            held,
            step,
        })
    }

    /// New λ, v and trust; returns whether the trust is unchanged.
    fn update(&self, fit: &Fit, variances: &mut VarianceComponents, scales: &[f64]) -> bool {
        for (index, prior) in self.priors.iter().enumerate() {
            let values = DVector::from_column_slice(&prior.values);
            let rough = (values + &prior.slopes * &fit.step).norm_squared();
            let most = STIFFEST * scales[index];
            let next = fit.freedom[index] / rough.max(f64::MIN_POSITIVE);
            variances.smoothing[index] = next.clamp(scales[index] / STIFFEST, most);
        }
        let distances = self.distances(fit);
        let noise = self
            .robust
            .noise(&distances, fit.effective, self.known_noise);
        (variances.variance, variances.sound) = (noise.variance, noise.sound);
        let change = noise.trust.iter().zip(&variances.trust);
        let changed = change.fold(0.0, |most: f64, (new, old)| most.max((new - old).abs()));
        variances.trust = noise.trust;
        changed < 1e-3
    }

    /// √(wx rx² + wy ry²) of each marker.
    fn distances(&self, fit: &Fit) -> Vec<f64> {
        let squares = squares(&fit.residual, self.weights);
        squares.map(f64::sqrt).collect()
    }
}

/// wx rx² + wy ry² of each marker.
pub fn squares(residual: &DVector<f64>, weights: &[f64]) -> impl Iterator<Item = f64> {
    let markers = residual.as_slice().chunks_exact(2);
    let pairs = markers.zip(weights.chunks_exact(2));
    pairs.map(|(r, w)| w[0] * r[0] * r[0] + w[1] * r[1] * r[1])
}

/// Σ ω (wx rx² + wy ry²) of markers.
pub fn weighted_square(residual: &DVector<f64>, weights: &[f64], trust: &[f64]) -> f64 {
    let squares = squares(residual, weights).zip(trust);
    squares.map(|(square, trust)| trust * square).sum()
}

/// ‖ρ + Bδ‖² of a prior.
pub struct Form {
    /// BᵀB.
    pub square: DMatrix<f64>,
    /// Bᵀρ.
    pub slope: DVector<f64>,
    rank: f64,
}

impl Form {
    pub fn new(prior: &Roughness) -> Self {
        let transposed = prior.slopes.transpose();
        Self {
            square: &transposed * &prior.slopes,
            slope: transposed * DVector::from_column_slice(&prior.values),
            rank: prior.rank as f64,
        }
    }
}

/// The derivatives of the markers, two rows each, with their weights.
pub struct MarkerRows<'a> {
    pub design: &'a DMatrix<f64>,
    pub weights: &'a [f64],
    pub variances: &'a VarianceComponents,
}

impl MarkerRows<'_> {
    /// ÃᵀÃ, Ã = √(W/v) A.
    pub fn information(&self) -> DMatrix<f64> {
        let none = DVector::zeros(self.design.nrows());
        normal_equations(self.design, &none, |row| self.weight(row)).0
    }

    fn weight(&self, row: usize) -> f64 {
        self.variances.weight(self.weights, row) / self.variances.variance
    }

    /// τ² ÃᵀRÃ.
    pub fn spread(&self, noise: &CorrelatedNoise, sites: &Sites) -> DMatrix<f64> {
        let whitening = Whitening::new(sites, &noise.correlation);
        let scaled = self.scaled();
        let columns = scaled.column_iter();
        let entries =
            columns.flat_map(|column| whitening.apply_inverse_transposed(column.as_slice()));
        let root = DMatrix::from_iterator(scaled.nrows(), scaled.ncols(), entries);
        root.tr_mul(&root) * noise.variance
    }

    /// Ã.
    fn scaled(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.design.nrows(), self.design.ncols(), |row, column| {
            self.weight(row).sqrt() * self.design[(row, column)]
        })
    }
}
