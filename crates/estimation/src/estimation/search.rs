//! The search for the equilibrium nearest to the data.

use std::sync::OnceLock;

use nalgebra::{DMatrix, DVector};

use super::equations::{AT_THE_END, Equations, Linear, ON_THE_WAY, SearchState, solve};
use super::input::Observations;
use super::regression::{Fit, Regression, Undetermined, VarianceComponents};
use crate::error::{Error, SolveFault};
use crate::solve::vector::{add_scaled, largest, moved};

/// Steps allowed.
pub const MOST_STEPS: usize = 100;

/// Steps after which the variances are fixed: two of equal likelihood could alternate.
pub const VARIANCE_STEPS: usize = 6;

/// The length of a negligible step in standard errors, once variances are fixed: steps may then become shorter only slowly.
const NEAR: f64 = 0.03;

/// The shortest share of a step.
const SHORTEST: f64 = 1.0 / 64.0;

/// Part of the noise by which the last step may still move the field.
const MOVEMENT: f64 = 1e-3;

/// The field at the end of the search, with the data of the last step.
pub struct NearestField<'a> {
    pub equations: Equations<'a>,
    pub field: Vec<f64>,
    pub residual: Vec<f64>,
    pub linear: Linear,
    pub fit: Fit,
    pub variances: VarianceComponents,
    /// p.
    pub parameters: Vec<f64>,
    /// ζ of node after node.
    pub multipliers: Vec<f64>,
    pub steps: usize,
    /// The discretisation error, computed when it is first needed.
    pub known_mesh_error: OnceLock<Option<MeshError>>,
}

/// The discretisation error is at most about this multiple of the difference that cells half as large make.
pub const MESH_ERROR_FACTOR: f64 = 2.0;

/// The discretisation error of a field ([`super::uncertainty`] computes it on cells half as large).
#[derive(Clone, Debug)]
pub struct MeshError {
    /// e of node after node in mm.
    pub displacement: Vec<f64>,
    /// δp.
    pub parameters: DVector<f64>,
    /// H e, two numbers per marker.
    pub markers: Vec<f64>,
    /// G₁₁, G₁₂, G₂₁, G₂₂ of cell after cell.
    pub gradients: Vec<[f64; 4]>,
    /// The error of the force of each body in N, in the order of the bodies.
    pub forces: Vec<[f64; 2]>,
}

/// One linearised regression.
pub struct Scored {
    pub linear: Linear,
    pub fit: Fit,
    pub variances: VarianceComponents,
}

impl<'a> Equations<'a> {
    /// Finds the equilibrium nearest to the data.
    ///
    /// # Errors
    /// [`Error::Input`] when the data do not determine it, [`Error::Solve`] when `most` steps do not reach it.
    pub fn run(mut self, most: usize) -> Result<NearestField<'a>, Error> {
        let (state, trust) = self.start()?;
        let variances = VarianceComponents {
            smoothing: Vec::new(),
            trust,
            variance: self.first_variance(&state.field),
            sound: 1.0,
        };
        self.run_from(state, variances, VARIANCE_STEPS, most)
    }

    /// The same from a given state; the data change the variances in the first `adjusting` steps.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_from(
        mut self,
        mut state: SearchState,
        mut variances: VarianceComponents,
        adjusting: usize,
        most: usize,
    ) -> Result<NearestField<'a>, Error> {
        let (mut last, mut share) = (f64::INFINITY, 1.0);
        let (mut moved, mut wanted) = (f64::NAN, f64::NAN);
        for steps in 1..=most {
            let linear = self.linearise(&state)?;
            let fit = self.regress(&state, steps > adjusting, &linear, &mut variances)?;
            let change = combined(
                &linear.newton_step,
                &linear.sensitivities,
                fit.step.as_slice(),
            );
            let close = self.close(&variances, &state.field);
            let scale = largest(&state.field);
            (moved, wanted) = (largest(&change) / scale, close / scale);
            if steps > adjusting {
                share = next_share(share, fit.length / last);
            }
            last = fit.length;
            let near = fit.length <= NEAR && largest(&linear.newton_step) <= close;
            let done = largest(&change) <= close || (steps > adjusting && near);
            let cut = self.advance(&mut state, &change, fit.step.as_slice(), share)?;
            if done && !cut {
                let multipliers = self.multipliers(&fit, &variances)?;
                let residual = self.settle(&mut state, AT_THE_END)?;
                return Ok(NearestField {
                    field: state.field,
                    parameters: state.parameters,
                    multipliers,
                    residual,
                    linear,
                    fit,
                    variances,
                    steps,
                    known_mesh_error: OnceLock::new(),
                    equations: self,
                });
            }
        }
        Err(solve(SolveFault::Stalled {
            iterations: most,
            residual: moved,
            tolerance: wanted,
        }))
    }

    /// The same from the field of another search, with its trust in the markers.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_near(
        mut self,
        nearest_field: &NearestField,
        most: usize,
    ) -> Result<NearestField<'a>, Error> {
        let (mut state, variances) = self.nearby(nearest_field);
        self.settle(&mut state, ON_THE_WAY)?;
        self.run_from(state, variances, VARIANCE_STEPS, most)
    }

    /// The field of another search with the parameters nearest to it, and its variances but for those of the edges.
    fn nearby(&self, nearest_field: &NearestField) -> (SearchState, VarianceComponents) {
        let mut parameters = self.nearest_parameters(&nearest_field.field);
        let others = &nearest_field.parameters[nearest_field.equations.motion.parameters()..];
        parameters.extend_from_slice(others);
        parameters.resize(self.parameter_count(), 0.0);
        let state = SearchState {
            parameters,
            field: nearest_field.field.clone(),
        };
        let variances = VarianceComponents {
            smoothing: Vec::new(),
            ..nearest_field.variances.clone()
        };
        (state, variances)
    }

    /// One linearised regression from the field of another search, with its trust in the markers. Edges that these equations release begin with
    /// the displacements of that field, which is then in equilibrium; with other conditions it must be settled first.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn score(mut self, nearest_field: &NearestField, settle: bool) -> Result<Scored, Error> {
        let (mut state, mut variances) = self.nearby(nearest_field);
        if settle {
            self.settle(&mut state, ON_THE_WAY)?;
        }
        let linear = self.linearise(&state)?;
        let fit = self.regress(&state, false, &linear, &mut variances)?;
        Ok(Scored {
            linear,
            fit,
            variances,
        })
    }

    /// The largest negligible move, in mm.
    fn close(&self, variances: &VarianceComponents, field: &[f64]) -> f64 {
        let observations = self.task.observations;
        let variance = if observations.known_noise {
            1.0
        } else {
            variances.variance
        };
        let most = largest(&observations.weights);
        (MOVEMENT * (variance / most).sqrt()).max(1e-9 * largest(field))
    }

    fn regress(
        &self,
        state: &SearchState,
        settled: bool,
        linear: &Linear,
        variances: &mut VarianceComponents,
    ) -> Result<Fit, Error> {
        let regression = self.regression(state, settled, linear);
        regression.fit(variances).map_err(|Undetermined| {
            Error::input(
                "the data do not determine the motion of the edges, or the parameters of the law",
                "state more about the edges (free, rigid, known), measure more markers near them, or estimate fewer parameters",
            )
        })
    }

    /// The regression about a state.
    pub(super) fn regression<'b>(
        &'b self,
        state: &SearchState,
        settled: bool,
        linear: &'b Linear,
    ) -> Regression<'b> {
        let ahead = moved(&state.field, 1.0, &linear.newton_step);
        let observations = self.task.observations;
        Regression {
            design: &linear.design,
            residual: observations.residual(&ahead),
            weights: &observations.weights,
            known_noise: observations.known_noise,
            force_rows: (&linear.force_rows.0, &linear.force_rows.1),
            priors: self.priors(&state.parameters),
            robust: self.task.knowledge.robust,
            settled,
        }
    }

    /// K⁻¹ Hᵀ W (d − H u) by the last tangent, with weights relative to their mean.
    fn multipliers(
        &mut self,
        fit: &Fit,
        variances: &VarianceComponents,
    ) -> Result<Vec<f64>, Error> {
        let observations = self.task.observations;
        let weights = &observations.weights;
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let residual = fit.residual.iter().enumerate();
        let weighted = residual.map(|(row, r)| -variances.weight(weights, row) / mean * r);
        let pull: Vec<f64> = weighted.collect();
        let force = observations.interpolation.multiply_transposed(&pull);
        let mut changes = self.newton.tangent.changes(&[force]).map_err(solve)?;
        Ok(changes.remove(0))
    }

    /// The variance at the start.
    fn first_variance(&self, field: &[f64]) -> f64 {
        let observations = self.task.observations;
        if observations.known_noise {
            return 1.0;
        }
        let residual = observations.residual(field);
        (residual.norm_squared() / residual.len() as f64).max(1e-12 * largest(field).powi(2))
    }

    /// Takes the share `most` of the step, or a smaller one that leaves all cells admissible and changes no parameter of the law by more than half;
    /// equilibrium is restored where it is lost. Returns whether the share was smaller.
    fn advance(
        &mut self,
        state: &mut SearchState,
        change: &[f64],
        step: &[f64],
        most: f64,
    ) -> Result<bool, Error> {
        const WITHIN: f64 = 0.5;
        let values = self.law_values(&state.parameters).iter();
        let share = values
            .zip(self.law_values(step))
            .map(|(value, step)| (step / value).abs());
        let longest = 1.0 / share.fold(1.0, |most: f64, share| most.max(share / WITHIN));
        let mut length = longest.min(most);
        loop {
            let mut next = state.clone();
            add_scaled(&mut next.parameters, length, step);
            add_scaled(&mut next.field, length, change);
            match self.balance(&mut next) {
                Ok(()) => {
                    *state = next;
                    return Ok(length < most);
                }
                Err(fault) if length <= SHORTEST => return Err(fault),
                Err(_) => length *= 0.5,
            }
        }
    }
}

/// The share of the next step, from that of the last one and the ratio of the lengths of both, which is 1 − share where the regression is
/// linear. Steps that become shorter less quickly oscillate about the nearest field.
fn next_share(share: f64, ratio: f64) -> f64 {
    if ratio > 1.0 - 0.5 * share {
        (0.5 * share).max(SHORTEST)
    } else if ratio < 1.0 - 0.75 * share {
        (2.0 * share).min(1.0)
    } else {
        share
    }
}

/// newton_step + Σ stepⱼ columnⱼ.
fn combined(newton_step: &[f64], columns: &[Vec<f64>], step: &[f64]) -> Vec<f64> {
    let mut sum = newton_step.to_vec();
    for (column, factor) in columns.iter().zip(step) {
        add_scaled(&mut sum, *factor, column);
    }
    sum
}

impl NearestField<'_> {
    /// The state from which another search may begin.
    pub fn state(&self) -> SearchState {
        SearchState {
            parameters: self.parameters.clone(),
            field: self.field.clone(),
        }
    }

    pub fn observations(&self) -> &Observations {
        self.equations.task.observations
    }

    /// The displacements of the markers due to small residual forces, a column for each of several.
    pub fn marker_changes(&mut self, forces: &[Vec<f64>]) -> Result<DMatrix<f64>, Error> {
        let tangent = &mut self.equations.newton.tangent;
        let changes = tangent.changes(forces).map_err(solve)?;
        let interpolation = &self.observations().interpolation;
        let values = changes
            .iter()
            .flat_map(|change| interpolation.multiply(change));
        Ok(DMatrix::from_iterator(
            interpolation.len(),
            changes.len(),
            values,
        ))
    }

    /// √(s C sᵀ) of a row s of sensitivities.
    pub fn error(&self, row: &[f64]) -> f64 {
        let covariance = &self.fit.covariance;
        let product = |j: usize| -> f64 {
            let column = covariance.column(j);
            row[j] * column.iter().zip(row).map(|(c, s)| c * s).sum::<f64>()
        };
        (0..row.len()).map(product).sum::<f64>().max(0.0).sqrt()
    }

    /// Reactions at held edges.
    pub fn reactions(&self) -> Vec<f64> {
        let mut reactions = self.residual.clone();
        for unknown in self.equations.newton.free() {
            reactions[*unknown] = 0.0;
        }
        reactions
    }
}
