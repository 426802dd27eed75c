//! An estimated field with its uncertainty from the data.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::verdict::{Answer, Reason, Verdict};
use crate::estimation::input::{EdgeCondition, MeasuredForce};
use crate::estimation::regression::Robust;
use crate::estimation::uncertainty::ScaleChange;
use crate::mesh::Mesh;
use crate::statistics::{Estimate, robust_deviation};

/// The field nearest to the markers.
///
/// Standard errors come from the noise of the markers, to first order, and from the discretisation error e: √(s² + e²).
/// For all quantities e follows from the same equations on cells half as large; for a large mesh only stress and
/// thickness include it, from the recovered gradient. Standard errors are valid where the verdict has intervals. `± reach · standard error` is
/// the 95 % interval.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct FieldEstimate {
    /// ux, uy of node after node in mm.
    pub displacement: Vec<f64>,
    /// Their standard errors in mm.
    pub displacement_error: Vec<f64>,
    /// Stress and thickness in the middle of each cell.
    pub cells: Vec<StressEstimate>,
    /// ∂Π/∂u in N of node after node: reactions at loaded edges, zero elsewhere.
    pub reactions: Vec<f64>,
    /// The total force on each edge that is not free; edges of one name are one body, and a node where two meet counts once.
    pub forces: Vec<EdgeForce>,
    /// ζ of the equilibrium of node after node in mm²/N: minus the derivative of ½ ‖H u − d‖²_W with respect to a
    /// force there, with weights relative to their mean; zero where the edges are not free.
    pub multipliers: Vec<f64>,
    /// The residual of each marker; `None` for markers that do not lie on the mesh.
    pub markers: Vec<Option<MarkerEstimate>>,
    /// Standard deviation of each component of a marker of mean weight in mm.
    pub noise: f64,
    /// The weights of markers with large residuals.
    pub robust: Robust,
    /// Whether the noise was given; otherwise it is estimated from the residuals of the markers.
    pub known_noise: bool,
    /// The ratio of the markers' scatter to their stated noise, where they contradict it by its size or by its
    /// variation over the sheet: the size of the noise is then estimated.
    pub noise_ratio: Option<f64>,
    /// The least and the largest standard deviation of the noise of markers along x and along y in mm, where it was found to
    /// vary over the sheet or between components, and the data are explained: markers are then weighted accordingly.
    pub noise_range: Option<[[f64; 2]; 2]>,
    /// The number of parameters that the data have determined: the trace of the matrix that maps the measured displacements to the fitted ones.
    pub effective_parameters: f64,
    /// Twice the number of markers less the effective parameters.
    pub degrees_of_freedom: f64,
    /// Half the width of a 95 % interval over the standard error.
    pub reach: f64,
    /// Forces on the interior in N on node after node that represent what the physics lacks; zero where it is exact.
    pub interior_forces: Vec<f64>,
    /// The rule by which data, smoothness and physics were balanced.
    pub rule: Cow<'static, str>,
    /// The smoothness of the edges of unknown motion, and the size of the forces on the interior, as chosen by the rule.
    pub smoothing: Vec<Smoothing>,
    /// The condition of each part of the boundary.
    pub edges: Vec<EdgeOutcome>,
    /// The parameters of the law that were found: key, unit, estimate.
    pub parameters: Vec<FoundParameter>,
    /// Steps of the search.
    pub steps: usize,
    /// The change due to an error of the picture's scale.
    pub scale_change: ScaleChange,
    /// Whether forces and stresses are as large as the given law makes them: no force is measured, and no parameter found.
    pub is_given_the_law: bool,
    /// The standard errors of the forces along x and y in N due to the uncertainty of the law that its card records, which their intervals
    /// include, in the order of the forces; empty where it records none.
    pub law_deviations: Vec<[f64; 2]>,
    /// Whether the standard errors of displacements, forces and parameters include the discretisation error, which is not
    /// known for meshes with too many cells.
    pub holds_mesh_error: bool,
    /// The relative growth of the force in 1/mm with the distance that all free edges lie farther out: ∮ Ψ ds/∫ Ψ dA
    /// over free edges and sheet, the derivative of its energy with respect to that distance.
    pub growth: f64,
    /// The sum of the forces of all edges and on the interior, relative to the largest of them.
    pub imbalance: f64,
    /// The measured forces compared with those of the field.
    pub force_checks: Vec<ForceCheck>,
    /// The statements on the edges that the data contradict.
    pub contradiction: Option<Contradiction>,
    /// Whether law, thickness and conditions explain the data.
    pub verdict: Verdict,
}

/// A measured force and that of the field.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct ForceCheck {
    /// The measured force.
    pub measured: MeasuredForce,
    /// The force of the field in N.
    pub estimated: f64,
    /// The difference in units of its own standard deviation, √(σ² − s² + e²), or √(σ² + s² + e²) where the field does not
    /// include the measured force: σ for the measured force, s for that of the field due to noise, e due to the mesh.
    pub standardised: f64,
}

impl ForceCheck {
    /// Whether the measured force differs from the field's by more than four standard deviations, which noise alone
    /// causes in six of a hundred thousand cases.
    pub fn contradicts(&self) -> bool {
        const CONTRADICTS: f64 = 4.0;
        self.standardised.abs() > CONTRADICTS
    }
}

impl FieldEstimate {
    /// Whether law, thickness and conditions explain the data.
    pub fn is_explained(&self) -> bool {
        matches!(self.verdict.answer, Answer::Explained | Answer::Correlated)
    }

    /// Whether its intervals are valid.
    pub fn has_intervals(&self) -> bool {
        self.verdict.has_intervals()
    }

    /// How far free edges may lie outside of those of the mesh, in mm, where the data cannot judge for that reason.
    pub fn unknown_edges(&self) -> Option<f64> {
        let mut reasons = self.verdict.reasons.iter();
        reasons.find_map(|reason| match reason {
            Reason::UnknownEdges(gap) => Some(*gap),
            _ => None,
        })
    }

    /// The share of the area on which the discretisation error is the larger part of the error of stress, and more than a
    /// hundredth of the root mean square of the stress.
    pub fn coarse_share(&self, mesh: &Mesh) -> f64 {
        const MATTERS: f64 = 0.01;
        let square = |stress: &[f64; 4]| stress.iter().map(|value| value * value).sum::<f64>();
        let areas: Vec<f64> = (0..self.cells.len())
            .map(|cell| mesh.cell_area(cell))
            .collect();
        let total: f64 = areas.iter().sum();
        let parts = self.cells.iter().zip(&areas);
        let mean = parts
            .clone()
            .map(|(cell, area)| square(&cell.first_piola_kirchhoff_stress) * area / total)
            .sum::<f64>();
        let coarse = parts.filter(|(cell, _)| {
            let square_error = cell.mesh_error.powi(2);
            square_error > 0.5 * square(&cell.stress_error) && square_error > MATTERS.powi(2) * mean
        });
        coarse.map(|(_, area)| area / total).sum()
    }
}

/// The rule by which data and smoothness are balanced.
pub const RULE: &str = "equilibrium holds exactly; the roughness of each edge of unknown motion is weighted by restricted maximum likelihood";

/// The rule where the physics is weighted.
pub const RULE_WITH_MODEL_ERROR: &str = "equilibrium holds up to smooth forces on the interior; these forces and the roughness of each edge of unknown motion are weighted by restricted maximum likelihood";

/// The state in the middle of a cell.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct StressEstimate {
    /// First Piola–Kirchhoff stress P₁₁, P₁₂, P₂₁, P₂₂ in MPa, the transpose of the nominal stress.
    pub first_piola_kirchhoff_stress: [f64; 4],
    /// Their standard errors in MPa: √(s² + e²) with s from the noise and e = |P(G) − P(∇u)|, where G is the gradient
    /// of the field on cells half as large, or, for a mesh too large for that, the recovered gradient of its field u.
    pub stress_error: [f64; 4],
    /// √(e : e), the part of them due to the mesh itself, in MPa.
    pub mesh_error: f64,
    /// Thickness of the deformed sheet in mm.
    pub thickness: f64,
    /// Its standard error in mm.
    pub thickness_error: f64,
}

/// A parameter of the law that was found: key, unit, estimate.
pub type FoundParameter = (Cow<'static, str>, Cow<'static, str>, Estimate);

/// The force that an edge exerts on the sheet.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct EdgeForce {
    /// The edge.
    pub edge: String,
    /// Along x and y in N.
    pub force: [Estimate; 2],
}

/// The condition of a part of the boundary.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct EdgeOutcome {
    /// The edge.
    pub edge: String,
    /// Its length in mm.
    pub length: f64,
    /// Its condition.
    pub condition: EdgeCondition,
    /// Where the data have chosen between free and loaded: the probability of the misfit if the edge is free.
    pub probability: Option<f64>,
}

/// The residual of a marker.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct MarkerEstimate {
    /// Measured less estimated displacement in mm.
    pub residual: [f64; 2],
    /// Length of the residual in units of its own standard deviation: √(rᵀ Cov(r)⁻¹ r).
    pub standardised_residual: f64,
    /// Factor of its weight, from 0 to 1.
    pub trust: f64,
    /// Whether normal noise and the discretisation error would leave so large a residual at less than one marker in a thousand.
    pub outlier: bool,
}

impl MarkerEstimate {
    /// The scatter by the median over that by squares below which gross errors make up the noise: 1 of normal noise, 0.8 of Laplace's.
    pub const GROSS_ERRORS: f64 = 0.5;

    /// The scatter of the standardised residuals by their median, over that of noise.
    pub fn scatter_by_median(markers: &[Option<Self>]) -> f64 {
        let markers = markers.iter().flatten();
        robust_deviation(markers.map(|marker| marker.standardised_residual))
    }
}

/// The smoothness of an edge along an axis.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Smoothing {
    /// The edge.
    pub edge: String,
    /// x or y: 0 or 1.
    pub axis: usize,
    /// λ in 1/mm²: the inverse of the variance of the curvature over the edge; for forces on the interior, that of b over the area in mm²/N².
    pub weight: f64,
    /// Parameters beyond a straight line that the data determine.
    pub freedom: f64,
}

/// The statements that the data contradict.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Contradiction {
    /// The probability of so large a reduction of the misfit if all statements on the edges are true.
    pub probability: f64,
    /// The edges that contradict on their own, each with this probability; empty where they do so only together.
    pub edges: Vec<(String, f64)>,
}
