//! The estimated field and its uncertainty.

use nalgebra::{DMatrix, Matrix2, Vector2};
use rayon::prelude::*;

use super::contradiction::Contradiction;
use super::edge_motion::EdgeCondition;
use super::linearise::Neighbours;
use super::mesh_error::MeshError;
use super::observations::Observations;
use super::robust::Robust;
use super::search::{Found, Search};
use super::whiteness::Whiteness;
use super::{Edge, MeasuredForce};
use crate::error::{Error, SolveFault};
use crate::finite_element::recovery::{RecoveredGradient, Recovery};
use crate::material::sheet::{Gradient, Kinematics, cofactor};
use crate::statistics::{Estimate, chi_squared_limit, normal_reach, student_reach};

/// The field nearest to the markers.
///
/// Standard errors come from the noise of the markers, to first order, and from the mesh's own error: √(s² + e²). Of
/// displacements, forces and parameters e comes from the same equations on cells half as large, of stress and thickness from the
/// recovered gradient. They know nothing of a wrong material or a wrong thickness.
/// `± reach · standard error` is the 95 % interval.
#[derive(Clone, Debug)]
pub struct FieldEstimate {
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// Their standard errors in mm.
    pub displacement_error: Vec<f64>,
    /// Stress and thickness in the middle of each cell.
    pub cells: Vec<StressEstimate>,
    /// ∂Π/∂u in N of node after node: reactions at loaded edges, nothing elsewhere.
    pub reactions: Vec<f64>,
    /// The total force on each edge that is not free.
    pub forces: Vec<EdgeForce>,
    /// ζ of the equilibrium of node after node in mm²/N: less the derivative of ½ ‖H u − d‖²_W by a force there, the weights
    /// relative to their mean; nothing where the edges are not free.
    pub multipliers: Vec<f64>,
    /// What is left of each marker; nothing for markers that do not lie on the mesh.
    pub markers: Vec<Option<MarkerEstimate>>,
    /// Standard deviation of each component of a marker of mean weight in mm.
    pub noise: f64,
    /// Whether the noise was given; else it is estimated from what is left of the markers.
    pub known_noise: bool,
    /// `noise` over the given one: 1 but where markers that scatter far more are judged by their own level.
    pub noise_scale: f64,
    /// How many parameters the data have determined: the trace of the matrix that makes the fitted displacements of the
    /// measured ones.
    pub effective_parameters: f64,
    /// Twice the number of markers less the effective parameters.
    pub degrees_of_freedom: f64,
    /// Half the width of a 95 % interval over the standard error.
    pub reach: f64,
    /// Forces on the interior in N on node after node that stand for what the physics lacks; nothing where it is exact.
    pub interior_forces: Vec<f64>,
    /// The rule by which data, smoothness and physics were traded.
    pub rule: &'static str,
    /// How smooth the edges of unknown motion came out by the rule, and how large the forces on the interior.
    pub smoothing: Vec<Smoothing>,
    /// The condition of each part of the boundary.
    pub edges: Vec<EdgeOutcome>,
    /// The parameters of the law that were found: key, unit, estimate.
    pub parameters: Vec<(&'static str, &'static str, Estimate)>,
    /// Steps of the search.
    pub steps: usize,
    /// Whether the standard errors of displacements, forces and parameters hold the mesh's own error: of meshes with too many
    /// cells it is not known.
    pub holds_mesh_error: bool,
    /// By how much, relative to itself, the force grows with the distance in mm that all free edges lie farther out:
    /// ∮ Ψ ds/∫ Ψ dA over free edges and sheet, the derivative of its energy by that distance, in 1/mm.
    pub growth: f64,
    /// The measured forces beside those of the field.
    pub force_checks: Vec<ForceCheck>,
    /// What the data contradict of what is said of the edges.
    pub contradiction: Option<Contradiction>,
    /// How what is left of neighbouring markers correlates, where there is enough of it to tell.
    pub whiteness: Option<Whiteness>,
}

/// A measured force beside that of the field.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceCheck {
    /// What was measured.
    pub measured: MeasuredForce,
    /// The force of the field in N.
    pub found: f64,
    /// The difference in units of its own standard deviation, √(σ² − s² + e²): σ of the measured force, s of the field's by the
    /// noise, e by the mesh.
    pub standardised: f64,
}

/// The rule by which data and smoothness are traded.
pub const TRADE: &str = "equilibrium holds exactly; the roughness of each edge of unknown motion is weighted by restricted maximum likelihood";

/// The rule where the physics is weighted.
pub const TRADE_WEIGHTED: &str = "equilibrium holds up to smooth forces on the interior; these forces and the roughness of each edge of unknown motion are weighted by restricted maximum likelihood";

/// The state in the middle of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressEstimate {
    /// First Piola–Kirchhoff stress P₁₁, P₁₂, P₂₁, P₂₂ in MPa, the transpose of the nominal stress.
    pub first_piola_kirchhoff_stress: [f64; 4],
    /// Their standard errors in MPa: √(s² + e²) with s of the noise and e = |P(G*) − P(∇u)|, where G* is the recovered
    /// gradient of the mesh's field u.
    pub stress_error: [f64; 4],
    /// Thickness of the deformed sheet in mm.
    pub thickness: f64,
    /// Its standard error in mm.
    pub thickness_error: f64,
}

/// The force that an edge exerts on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeForce {
    /// The edge.
    pub edge: String,
    /// Along x and y in N.
    pub force: [Estimate; 2],
}

/// The condition of a part of the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeOutcome {
    /// The edge.
    pub edge: String,
    /// Its length in mm.
    pub length: f64,
    /// Its condition.
    pub condition: EdgeCondition,
    /// Where the data have chosen between free and loaded: how probable the misfit is if the edge is free.
    pub probability: Option<f64>,
}

/// What is left of a marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerEstimate {
    /// Measured less estimated displacement in mm.
    pub residual: [f64; 2],
    /// Length of the residual in units of its own standard deviation: √(rᵀ Cov(r)⁻¹ r).
    pub standardised_residual: f64,
    /// Factor of its weight in 0…1.
    pub trust: f64,
    /// Whether normal noise would leave so much of less than one marker in a thousand.
    pub outlier: bool,
}

/// How smooth an edge came out along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothing {
    /// The edge.
    pub edge: String,
    /// x or y: 0 or 1.
    pub axis: usize,
    /// λ in 1/mm²: the inverse of the variance of the curvature over the edge; of forces on the interior, that of b over the
    /// area in mm²/N².
    pub weight: f64,
    /// Parameters beyond a straight line that the data determine.
    pub freedom: f64,
}

/// Share of sound markers that are taken for outliers.
const FALSE_ALARMS: f64 = 1e-3;

impl Found<'_> {
    /// The field with all that follows from it.
    pub fn into_estimate(
        self,
        edges: &[Edge],
        own: Option<&MeshError>,
        contradiction: Option<Contradiction>,
    ) -> Result<FieldEstimate, Error> {
        let rows = self.linear.design.nrows() as f64;
        let known_noise = self.observations().known_noise;
        let robust = self.search.task.knowledge.robust != Robust::No;
        let freedom = (rows - self.fit.effective).max(1.0);
        let reach = match known_noise && !robust {
            true => normal_reach(),
            false => student_reach(freedom),
        };
        let weights = &self.observations().weights;
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let motion = self.search.priors(&self.parameters);
        let smoothing = motion
            .iter()
            .zip(&self.trade.smoothing)
            .zip(&self.fit.freedom);
        let smoothing = smoothing.map(|((rough, weight), freedom)| Smoothing {
            edge: rough.edge.clone(),
            axis: rough.axis,
            weight: *weight,
            freedom: *freedom,
        });
        let markers = self.markers();
        let outcome = |edge: &Edge| EdgeOutcome {
            edge: edge.segment.name.clone(),
            length: edge.segment.length(),
            condition: edge.condition,
            probability: edge.probability,
        };
        Ok(FieldEstimate {
            displacement_error: self.displacement_error(own),
            cells: self.cells()?,
            forces: self.forces(edges, reach, own)?,
            parameters: self.law_parameters(reach, own),
            holds_mesh_error: own.is_some(),
            growth: self.growth(edges),
            force_checks: self.force_checks(edges, own)?,
            contradiction,
            whiteness: self.whiteness(&markers, own),
            markers,
            noise: (self.trade.sound / mean).sqrt(),
            known_noise,
            noise_scale: if known_noise {
                self.trade.sound.sqrt()
            } else {
                1.0
            },
            effective_parameters: self.fit.effective,
            degrees_of_freedom: freedom,
            reach,
            smoothing: smoothing.collect(),
            rule: match self.search.body {
                Some(_) => TRADE_WEIGHTED,
                None => TRADE,
            },
            interior_forces: self.search.forces.clone(),
            edges: edges.iter().map(outcome).collect(),
            steps: self.steps,
            reactions: self.reactions(),
            multipliers: self.multipliers,
            displacement: self.field,
        })
    }

    fn observations(&self) -> &Observations {
        self.search.task.observations
    }

    /// √(s C sᵀ) of a row s of sensitivities.
    pub(super) fn error(&self, row: &[f64]) -> f64 {
        let covariance = &self.fit.covariance;
        let product = |j: usize| -> f64 {
            let column = covariance.column(j);
            row[j] * column.iter().zip(row).map(|(c, s)| c * s).sum::<f64>()
        };
        (0..row.len()).map(product).sum::<f64>().max(0.0).sqrt()
    }

    fn displacement_error(&self, own: Option<&MeshError>) -> Vec<f64> {
        let unknowns = (0..self.field.len()).into_par_iter();
        let error = |unknown: usize| {
            let row: Vec<f64> = self
                .linear
                .sensitivities
                .iter()
                .map(|column| column[unknown])
                .collect();
            let mesh = own.map_or(0.0, |own| own.displacement[unknown]);
            self.error(&row).hypot(mesh)
        };
        unknowns.map(error).collect()
    }

    fn cells(&self) -> Result<Vec<StressEstimate>, Error> {
        let cells = (0..self.search.task.specimen.mesh.cell_count()).into_par_iter();
        let neighbours = self.search.neighbours(&self.parameters);
        let recovered = Recovery::new(self.search.task.specimen.mesh).gradient(&self.field);
        cells
            .map(|cell| self.cell(cell, &neighbours, &recovered))
            .collect()
    }

    fn cell(
        &self,
        cell: usize,
        neighbours: &[Neighbours],
        recovered: &RecoveredGradient,
    ) -> Result<StressEstimate, Error> {
        let Search { task, law, .. } = &self.search;
        let specimen = task.specimen;
        let mesh = specimen.mesh;
        let centre = mesh.shape(cell).centre();
        let (gradients, _) = mesh.gradients(cell, centre);
        let gradient = |field: &[f64]| {
            let mut h = Gradient::zeros();
            for (node, g) in mesh.cell(cell).iter().zip(&gradients) {
                let [x, y] = [field[2 * node], field[2 * node + 1]];
                h += Gradient::new(x * g[0], x * g[1], y * g[0], y * g[1]);
            }
            h
        };
        let kinematics = Kinematics::new(&gradient(&self.field)).map_err(|_| {
            super::search::solve(SolveFault::Inverted {
                element: mesh.describe_cell(cell),
            })
        })?;
        let response = law.response(&kinematics);
        let cofactor = cofactor(&kinematics.deformation_gradient);
        let thickness = specimen.thickness / kinematics.area_ratio();
        let mut rows: [Vec<f64>; 5] = Default::default();
        for column in &self.linear.sensitivities {
            let change = gradient(column);
            let stress = response.tangent * change;
            (0..4).for_each(|component| rows[component].push(stress[component]));
            rows[4].push(thickness / kinematics.area_ratio() * cofactor.dot(&change));
        }
        for (index, (laws, width)) in neighbours.iter().enumerate() {
            let [low, high] = laws.each_ref().map(|law| law.stress(&kinematics).1);
            let slope = (high - low) / *width;
            let place = self.search.motion.parameters() + index;
            (0..4).for_each(|component| rows[component][place] += slope[component]);
        }
        let stress = response.first_piola_kirchhoff_stress;
        let better = Gradient::from(recovered.at(mesh, cell, centre));
        // Where the recovered gradient turns the cell inside out, all of the stress is in doubt.
        let (stress_off, thickness_off) =
            Kinematics::new(&better).map_or((stress, thickness), |better| {
                let thinner = specimen.thickness / better.area_ratio() - thickness;
                (law.stress(&better).1 - stress, thinner)
            });
        let stress_error =
            |component: usize| self.error(&rows[component]).hypot(stress_off[component]);
        Ok(StressEstimate {
            first_piola_kirchhoff_stress: stress.into(),
            stress_error: std::array::from_fn(stress_error),
            thickness,
            thickness_error: self.error(&rows[4]).hypot(thickness_off),
        })
    }

    /// Reactions where edges are held.
    pub(super) fn reactions(&self) -> Vec<f64> {
        let mut reactions = self.residual.clone();
        for unknown in self.search.newton.free() {
            reactions[*unknown] = 0.0;
        }
        reactions
    }

    fn markers(&self) -> Vec<Option<MarkerEstimate>> {
        let observations = self.observations();
        let limit = chi_squared_limit(2.0, FALSE_ALARMS);
        let mut all = vec![None; observations.markers];
        for (row, index) in observations.chosen.iter().enumerate() {
            all[*index] = Some(self.marker(row, limit));
        }
        all
    }

    /// Cov(r) = v/w + (1 − 2ω) A M⁻¹ Aᵀ: a marker that had a say has drawn the field to it, one that had none has not.
    fn marker(&self, index: usize, limit: f64) -> MarkerEstimate {
        let left = &self.fit.residual;
        let residual = Vector2::new(left[2 * index], left[2 * index + 1]);
        let rows = self.linear.design.rows(2 * index, 2);
        let spread: DMatrix<f64> = rows * &self.fit.covariance * rows.transpose();
        let trust = self.trade.trust[index];
        let own = self.trade.sound / self.observations().weights[index];
        let covariance = Matrix2::from_fn(|i, j| {
            let diagonal = if i == j { own } else { 0.0 };
            diagonal + (1.0 - 2.0 * trust) * spread[(i, j)]
        });
        let solved = covariance
            .try_inverse()
            .map_or(residual / own, |inverse| inverse * residual);
        let square = residual.dot(&solved).max(0.0);
        MarkerEstimate {
            residual: residual.into(),
            standardised_residual: square.sqrt(),
            trust,
            outlier: square > limit,
        }
    }
}
