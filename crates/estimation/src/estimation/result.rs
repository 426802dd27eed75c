//! The estimated field and its uncertainty.

use nalgebra::{DMatrix, Matrix2, Vector2};
use rayon::prelude::*;

use super::equations::solve;
use super::input::{Edge, Neighbours};
use super::judge::{Judgement, judge};
use super::outcome::{
    Answer, EdgeOutcome, FieldEstimate, MarkerEstimate, RULE, RULE_WITH_MODEL_ERROR, Smoothing,
    StressEstimate,
};
use super::regression::Robust;
use super::search::{MESH_ERROR_FACTOR, MeshError, NearestField};
use crate::error::{Error, SolveFault};
use crate::finite_element::recovery::Recovery;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::statistics::{chi_squared_limit, normal_reach, student_reach};

/// Share of sound markers that are taken for outliers by chance.
const FALSE_ALARMS: f64 = 1e-3;

impl NearestField<'_> {
    /// The field with all results that follow from it.
    pub fn into_estimate(mut self) -> Result<FieldEstimate, Error> {
        let known = self.known_mesh_error.take();
        let mesh_error = known.unwrap_or_else(|| self.compute_mesh_error());
        let mesh_error = mesh_error.as_ref();
        let judged = judge(&mut self, mesh_error)?;
        let markers = self.markers(mesh_error);
        let known_noise = self.observations().known_noise;
        let robust = self.equations.task.knowledge.robust;
        let uncertain = self.include_uncertainties(mesh_error, &judged)?;
        let variance_ratio = judged.noises.first().map_or(1.0, |noise| noise.variance);
        let weights = &self.observations().weights;
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        // Where the data are not explained, residuals are a misfit and not noise.
        let is_noise = judged.verdict.answer != Answer::NotExplained;
        Ok(FieldEstimate {
            displacement_error: self.displacement_error(mesh_error),
            cells: self.cells(mesh_error)?,
            holds_mesh_error: mesh_error.is_some(),
            imbalance: self.imbalance(),
            growth: self.growth(),
            verdict: judged.verdict.with_forces(&uncertain.force_checks),
            contradiction: judged.contradiction,
            markers,
            noise: (variance_ratio * self.variances.sound / mean).sqrt(),
            noise_range: self.deviations(variance_ratio).filter(|_| is_noise),
            robust,
            known_noise,
            effective_parameters: self.fit.effective,
            smoothing: self.smoothing(),
            rule: match self.equations.body {
                Some(_) => RULE_WITH_MODEL_ERROR.into(),
                None => RULE.into(),
            },
            interior_forces: self.equations.forces.clone(),
            edges: self.equations.edges.iter().map(Edge::outcome).collect(),
            steps: self.steps,
            reactions: self.reactions(),
            multipliers: self.multipliers,
            displacement: self.field,
            ..uncertain
        })
    }

    /// Adds all uncertainties of the field to the covariance, one after the other. Returns an estimate with the results that must be computed
    /// in between, because they do not include all uncertainties.
    fn include_uncertainties(
        &mut self,
        mesh_error: Option<&MeshError>,
        judged: &Judgement,
    ) -> Result<FieldEstimate, Error> {
        let rows = self.linear.design.nrows() as f64;
        let white = (rows - self.fit.effective).max(1.0);
        let considered = self.considered()?;
        let [by_law, by_all] = self.force_deviations(&considered)?;
        let scale = self.scale_response();
        let scale_change = self.scale_change(&scale)?;
        let before = self.force_checks(mesh_error, &scale_change, &by_all)?;
        let freedom = self.widen(judged).unwrap_or(white);
        let is_plain =
            self.equations.task.knowledge.robust == Robust::No && judged.noises.is_empty();
        let reach = if self.observations().known_noise && is_plain {
            normal_reach()
        } else {
            student_reach(freedom)
        };
        // Where the data are not explained, residuals taken for noise would hide a wrong force.
        let force_checks = match judged.verdict.answer {
            Answer::NotExplained => before,
            _ => self.force_checks(mesh_error, &scale_change, &by_all)?,
        };
        self.include_scale(&scale);
        let forces = self.forces(reach, mesh_error, &by_all)?;
        let parameters = self.law_parameters(reach, mesh_error);
        // The intervals of forces do not include common distances of edges, which only increase forces.
        self.consider(considered);
        Ok(FieldEstimate {
            degrees_of_freedom: freedom,
            reach,
            force_checks,
            forces,
            parameters,
            scale_change,
            is_given_the_law: self.equations.task.knowledge.is_given_the_law(),
            law_deviations: by_law,
            ..FieldEstimate::default()
        })
    }

    fn smoothing(&self) -> Vec<Smoothing> {
        let priors = self.equations.priors(&self.parameters).into_iter();
        let triples = priors.zip(&self.variances.smoothing).zip(&self.fit.freedom);
        triples
            .map(|((prior, weight), freedom)| Smoothing {
                edge: prior.edge,
                axis: prior.axis,
                weight: *weight,
                freedom: *freedom,
            })
            .collect()
    }

    fn displacement_error(&self, mesh_error: Option<&MeshError>) -> Vec<f64> {
        let unknowns = (0..self.field.len()).into_par_iter();
        let error = |unknown: usize| {
            let row: Vec<f64> = self
                .linear
                .sensitivities
                .iter()
                .map(|column| column[unknown])
                .collect();
            let mesh = mesh_error.map_or(0.0, |mesh_error| mesh_error.displacement[unknown]);
            self.error(&row).hypot(mesh)
        };
        unknowns.map(error).collect()
    }

    fn cells(&self, mesh_error: Option<&MeshError>) -> Result<Vec<StressEstimate>, Error> {
        let mesh = self.equations.task.specimen.mesh;
        let cells = (0..mesh.cell_count()).into_par_iter();
        let neighbours = self.neighbours();
        match mesh_error {
            Some(mesh_error) => cells
                .map(|cell| self.cell(cell, &neighbours, mesh_error.gradients[cell]))
                .collect(),
            None => {
                let recovered = Recovery::new(mesh).gradient(&self.field);
                let better = |cell| recovered.at(mesh, cell, mesh.shape(cell).centre());
                cells
                    .map(|cell| self.cell(cell, &neighbours, better(cell)))
                    .collect()
            }
        }
    }

    /// The laws on both sides of that of the field, each with the index of its parameter: of parameters that are found, or else considered.
    fn neighbours(&self) -> Vec<(usize, Neighbours)> {
        let equations = &self.equations;
        let fitted = equations.neighbours(&self.parameters);
        let uncertain = equations.task.knowledge.uncertain_law();
        let considered = uncertain.map_or(Vec::new(), |law| law.neighbours());
        let first = if fitted.is_empty() {
            self.parameters.len()
        } else {
            equations.motion.parameters()
        };
        (first..)
            .zip(fitted.into_iter().chain(considered))
            .collect()
    }

    fn cell(
        &self,
        cell: usize,
        neighbours: &[(usize, Neighbours)],
        better: [f64; 4],
    ) -> Result<StressEstimate, Error> {
        let specimen = &self.equations.task.specimen;
        let law = self.equations.law(cell);
        let mesh = specimen.mesh;
        let centre = mesh.shape(cell).centre();
        let (gradients, _) = mesh.gradients(cell, centre);
        let gradient = |field: &[f64]| {
            let mut h = PlaneTensor::zeros();
            for (node, g) in mesh.cell(cell).iter().zip(&gradients) {
                let [x, y] = [field[2 * node], field[2 * node + 1]];
                h += PlaneTensor::new(x * g[0], x * g[1], y * g[0], y * g[1]);
            }
            h
        };
        let kinematics = Kinematics::new(&gradient(&self.field)).map_err(|_| {
            solve(SolveFault::Inverted {
                element: mesh.describe_cell(cell),
            })
        })?;
        let response = law.response(&kinematics);
        let thinning = law.thickness_gradient(&kinematics);
        let thickness = specimen.thickness * law.thickness_stretch(&kinematics);
        let mut rows: [Vec<f64>; 5] = Default::default();
        for column in &self.linear.sensitivities {
            let change = gradient(column);
            let stress = response.tangent * change;
            (0..4).for_each(|component| rows[component].push(stress[component]));
            rows[4].push(specimen.thickness * thinning.dot(&change));
        }
        for (column, (laws, width)) in neighbours {
            let [low, high] = laws.each_ref().map(|law| law.stress(&kinematics).1);
            let slope = (high - low) / *width;
            (0..4).for_each(|component| rows[component][*column] += slope[component]);
        }
        let stress = response.first_piola_kirchhoff_stress;
        // Where the better gradient inverts the cell, the error is the stress itself.
        let (stress_off, thickness_off) =
            Kinematics::new(&PlaneTensor::from(better)).map_or((stress, thickness), |better| {
                let thinner = specimen.thickness * law.thickness_stretch(&better) - thickness;
                (law.stress(&better).1 - stress, thinner)
            });
        let stress_error =
            |component: usize| self.error(&rows[component]).hypot(stress_off[component]);
        Ok(StressEstimate {
            first_piola_kirchhoff_stress: stress.into(),
            stress_error: std::array::from_fn(stress_error),
            mesh_error: stress_off.norm(),
            thickness,
            thickness_error: self.error(&rows[4]).hypot(thickness_off),
        })
    }

    /// Whether gross errors make up the noise of markers that all have their weight, and the estimate is to end there.
    pub(super) fn ends_at_gross_errors(&self, markers: &[Option<MarkerEstimate>]) -> bool {
        let knowledge = self.equations.task.knowledge;
        knowledge.ends_at_gross_errors
            && knowledge.robust == Robust::No
            && MarkerEstimate::scatter_by_median(markers) < MarkerEstimate::GROSS_ERRORS
    }

    pub(super) fn markers(&self, mesh_error: Option<&MeshError>) -> Vec<Option<MarkerEstimate>> {
        let observations = self.observations();
        let limit = chi_squared_limit(2.0, FALSE_ALARMS);
        let mut all = vec![None; observations.markers];
        for (row, index) in observations.chosen.iter().enumerate() {
            let mesh_error = mesh_error.map_or([0.0; 2], |error| {
                [0, 1].map(|axis| MESH_ERROR_FACTOR * error.markers[2 * row + axis])
            });
            all[*index] = Some(self.marker(row, mesh_error, limit));
        }
        all
    }

    /// Cov(r) = v/w + (1 − 2ω) A M⁻¹ Aᵀ: a trusted marker (ω = 1) has drawn the field towards itself, one without trust (ω = 0) has not. An
    /// outlier has a larger residual than noise and twice the discretisation error e explain.
    fn marker(&self, index: usize, mesh_error: [f64; 2], limit: f64) -> MarkerEstimate {
        let residuals = &self.fit.residual;
        let residual = Vector2::new(residuals[2 * index], residuals[2 * index + 1]);
        let rows = self.linear.design.rows(2 * index, 2);
        let spread: DMatrix<f64> = rows * &self.fit.covariance * rows.transpose();
        let trust = self.variances.trust[index];
        let weights = &self.observations().weights;
        let square = |mesh_error: [f64; 2]| {
            let variances = Vector2::from_fn(|axis, _| {
                self.variances.sound / weights[2 * index + axis] + mesh_error[axis].powi(2)
            });
            let covariance = Matrix2::from_diagonal(&variances)
                + (1.0 - 2.0 * trust) * spread.fixed_view::<2, 2>(0, 0);
            let inverse = covariance.try_inverse();
            let solved = inverse.map_or(residual.component_div(&variances), |inverse| {
                inverse * residual
            });
            residual.dot(&solved).max(0.0)
        };
        let by_noise = square([0.0; 2]);
        MarkerEstimate {
            residual: residual.into(),
            standardised_residual: by_noise.sqrt(),
            trust,
            outlier: by_noise > limit && square(mesh_error) > limit,
        }
    }
}

impl Edge {
    pub(super) fn outcome(&self) -> EdgeOutcome {
        EdgeOutcome {
            edge: self.segment.name.clone(),
            length: self.segment.length(),
            condition: self.condition,
            probability: self.probability,
        }
    }
}
