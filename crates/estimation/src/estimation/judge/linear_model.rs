//! Linear models of the sound markers, and how much better one fits than another under noise that may correlate.

use nalgebra::{DMatrix, DVector};

use super::alternatives::Column;
use super::rows::Rows;
use crate::estimation::equations::Equations;
use crate::estimation::outcome::{Alternative, Trial};
use crate::estimation::regression::{Fit, VarianceComponents};
use crate::estimation::search::{NearestField, Scored};
use crate::estimation::uncertainty::Granted;
use crate::statistics::{
    CorrelatedNoise, CorrelatedRegression, WhiteRegression, Whitening, f_tail,
};

/// Evidence from which on noise counts as correlated: white noise has as much in one of four hundred cases.
const EVIDENCE: f64 = 12.0;

/// A linear model of the sound markers.
#[derive(Clone)]
pub struct Model {
    design: DMatrix<f64>,
    residual: DVector<f64>,
    held: DMatrix<f64>,
    slope: DVector<f64>,
}

/// The noises under which alternatives are compared with the equations: each model has the likelier of them.
///
/// ```text
/// −2 ln L = n ln(zᵀR⁻¹z/n) + 2 ln det R₁,   Λ = −2 ln L(equations) + 2 ln L(alternative)
/// F = (e^(Λ/n) − 1) (n − p)/(p − p₀)        p₀, p: parameters without and with the alternative; white noise: the usual F
/// ```
///
/// One noise is that of the residuals of the equations, which may contain a misfit; the other one is that of the residuals with all alternatives,
/// whose correlation length may be too short. The equations, too, have the likelier of both.
pub struct Reference {
    noises: Vec<Noise>,
    /// The likelihood of the equations; `None` where their parameters are not determined.
    equations: Option<Likelihood>,
}

struct Noise {
    whitening: Option<Whitening>,
    variance: f64,
}

/// A model under its likelier noise.
struct Likelihood {
    /// −2 ln L.
    deviance: f64,
    /// Parameters that were fitted.
    effective: f64,
}

impl Model {
    /// The model of a regression about the nearest field, with its conditions or others.
    fn new(
        rows: &Rows,
        equations: &Equations,
        design: DMatrix<f64>,
        fit: &Fit,
        variances: &VarianceComponents,
    ) -> Self {
        let residual = DMatrix::from_columns(std::slice::from_ref(&fit.residual));
        Self {
            // At the best fit the slope of the penalties is that of the data: −AᵀWr/v.
            slope: equations.target_of(fit.residual.as_slice(), &design, variances),
            design: rows.scaled(design),
            residual: rows.scaled(residual).column(0).into_owned(),
            held: fit.held.clone(),
        }
    }

    /// The model of a search.
    pub fn of_search(rows: &Rows, nearest_field: &NearestField) -> Self {
        let (fit, variances) = (&nearest_field.fit, &nearest_field.variances);
        let design = nearest_field.linear.design.clone();
        Self::new(rows, &nearest_field.equations, design, fit, variances)
    }

    /// The model of one regression with other conditions.
    pub fn of_score(rows: &Rows, nearest_field: &NearestField, scored: Scored) -> Self {
        let (fit, variances) = (&scored.fit, &scored.variances);
        let design = scored.linear.design;
        Self::new(rows, &nearest_field.equations, design, fit, variances)
    }

    /// The model with further columns without penalty.
    pub fn with<'a>(&self, rows: &Rows, more: impl IntoIterator<Item = &'a DMatrix<f64>>) -> Self {
        let more = more.into_iter().map(|design| (design, None));
        self.clone().extended(rows, more)
    }

    /// The model with changes that are known to be possible.
    pub fn granting(self, rows: &Rows, granted: &[Granted]) -> Self {
        let more = granted.iter();
        self.extended(rows, more.map(|change| (&change.design, change.deviation)))
    }

    /// The model with further columns, each of unit mean square, and the standard deviations of their parameters where known.
    fn extended<'a>(
        self,
        rows: &Rows,
        more: impl Iterator<Item = (&'a DMatrix<f64>, Option<f64>)>,
    ) -> Self {
        let mut columns: Vec<DVector<f64>> = Vec::new();
        let mut information: Vec<f64> = Vec::new();
        for (design, deviation) in more {
            let scaled = rows.scaled(design.clone());
            for column in scaled.column_iter() {
                let length = column.norm();
                if length > 0.0 && length.is_finite() {
                    let scale = (column.len() as f64).sqrt() / length;
                    columns.push(column * scale);
                    information
                        .push(deviation.map_or(0.0, |deviation| (scale / deviation).powi(2)));
                }
            }
        }
        let (before, all) = (self.design.ncols(), self.design.ncols() + columns.len());
        let mut design = self.design.resize_horizontally(all, 0.0);
        let mut held = self.held.resize(all, all, 0.0);
        for (index, (column, information)) in columns.iter().zip(information).enumerate() {
            design.set_column(before + index, column);
            held[(before + index, before + index)] = information;
        }
        Self {
            design,
            residual: self.residual,
            held,
            slope: self.slope.resize_vertically(all, 0.0),
        }
    }

    /// The correlations that the noise may have, where the data show one, the likeliest first.
    pub fn noises(&self, rows: &Rows) -> Vec<CorrelatedNoise> {
        let (chosen, sites) = rows.clusters();
        let entry = |row: usize| 2 * chosen[row / 2] + row % 2;
        let count = 2 * chosen.len();
        let columns = self.design.ncols();
        let regression = CorrelatedRegression {
            sites: &sites,
            design: &DMatrix::from_fn(count, columns, |row, j| self.design[(entry(row), j)]),
            residual: &DVector::from_fn(count, |row, _| self.residual[entry(row)]),
            held: &self.held,
            slope: &self.slope,
        };
        let longest = 0.5 * (rows.extent[0] * rows.extent[1]).sqrt();
        let plausible = regression.plausible(rows.spacing, longest);
        let shown = plausible.first().is_some_and(|one| one.evidence > EVIDENCE);
        plausible.into_iter().take_while(|_| shown).collect()
    }

    /// The residuals of the markers in mm, after an ordinary regression.
    pub fn residual_rms(&self, rows: &Rows, nearest_field: &NearestField) -> f64 {
        let white = WhiteRegression::new(&self.design, &self.residual, None);
        let fitted = white.residual_square(&self.held, &self.slope, 1.0);
        let count = 2.0 * rows.chosen.len() as f64;
        fitted.map_or(f64::NAN, |(square, _)| {
            (square / count).sqrt() * nearest_field.deviation()
        })
    }
}

impl Reference {
    /// The noise of the equations, and what remains of it with all alternatives in them.
    pub fn new(
        rows: &Rows,
        noise: Option<&CorrelatedNoise>,
        base: &Model,
        all: Option<&Model>,
        columns: &[Column],
    ) -> Self {
        let most = all.unwrap_or(base);
        let flexible = || most.with(rows, columns.iter().map(|(_, design)| design));
        let remaining = noise.and_then(|_| flexible().noises(rows).into_iter().next());
        let mut noises = vec![Noise::new(rows, remaining.as_ref())];
        noises.extend(noise.map(|noise| Noise::new(rows, Some(noise))));
        let equations = likeliest(&noises, base);
        Self { noises, equations }
    }

    /// The factor of one further column that, together with the equations, fits best.
    pub fn factor(&self, rows: &Rows, base: &Model, design: &DMatrix<f64>) -> Option<f64> {
        let model = base.with(rows, [design]);
        let last = model.design.ncols().checked_sub(1)?;
        let remaining = self.noises.first()?;
        let best =
            remaining
                .regression(&model)
                .best(&model.held, &model.slope, remaining.variance)?;
        // The model scales its columns.
        let scaled = rows.scaled(design.clone());
        Some(best[last] * model.design.column(last).norm() / scaled.norm())
    }

    /// The reduction of the misfit of the equations by a model.
    pub fn test(&self, alternative: Alternative, model: &Model) -> Trial {
        let after = likeliest(&self.noises, model);
        let (Some(before), Some(after)) = (&self.equations, after) else {
            return Trial::nothing(alternative);
        };
        let count = model.residual.len() as f64;
        let more = (after.effective - before.effective).max(1.0);
        let freedom = (count - after.effective).max(1.0);
        let reduction = ((before.deviance - after.deviance) / count).exp_m1();
        let gain = reduction.max(0.0) * freedom;
        Trial {
            probability: f_tail([more, freedom], gain / more),
            gain: gain - 2.0 * more,
            ..Trial::nothing(alternative)
        }
    }
}

/// The likelihood of a model under the noise which makes it likeliest; `None` where its parameters are not determined.
fn likeliest(noises: &[Noise], model: &Model) -> Option<Likelihood> {
    let all = noises.iter().filter_map(|noise| noise.likelihood(model));
    all.min_by(|a, b| a.deviance.total_cmp(&b.deviance))
}

impl Noise {
    /// Correlated noise, or white.
    fn new(rows: &Rows, noise: Option<&CorrelatedNoise>) -> Self {
        Self {
            whitening: noise.map(|noise| Whitening::new(&rows.sites, &noise.correlation)),
            variance: noise.map_or(1.0, |noise| noise.variance),
        }
    }

    fn regression(&self, model: &Model) -> WhiteRegression {
        WhiteRegression::new(&model.design, &model.residual, self.whitening.as_ref())
    }

    fn likelihood(&self, model: &Model) -> Option<Likelihood> {
        let (square, effective) =
            self.regression(model)
                .residual_square(&model.held, &model.slope, self.variance)?;
        let count = model.residual.len() as f64;
        let log_determinant = self
            .whitening
            .as_ref()
            .map_or(0.0, Whitening::log_determinant);
        Some(Likelihood {
            deviance: count * (square / count).ln() + 2.0 * log_determinant,
            effective,
        })
    }
}

impl Trial {
    fn nothing(alternative: Alternative) -> Self {
        Self {
            alternative,
            residual_rms: f64::NAN,
            probability: 1.0,
            gain: 0.0,
        }
    }
}
