//! The field nearest to measured displacements that satisfies the physics, with what the data say about its uncertainty.
//!
//! ```text
//! minimise ½ ‖H u − d‖²_W   subject to   F(u) = 0 at inner nodes and free edges
//! ```
//!
//! d are displacements of markers at any places, H interpolates the field of the mesh there, W = 1/variance. As F(u) = 0
//! leaves only the displacements of the loaded edges free, u = u(p) where p are the coefficients of smooth functions along these
//! edges (cubic B-splines) and three numbers for every rigid grip. Their sensitivities follow from the tangent K,
//!
//! ```text
//! ∂u/∂p = Φ − K⁻¹ K_B Φ        Φ = ∂u_B/∂p
//! ```
//!
//! and each Gauss–Newton step is a small regression with the equations linearised about the field reached so far; the
//! first one is a polynomial through the markers, never the noisy data. How smooth an edge is, the data decide by restricted
//! maximum likelihood. Intervals follow from the covariance C of p, to first order in the noise:
//!
//! ```text
//! Cov(u) = S C Sᵀ,   Cov(P) = A:∇S C (A:∇S)ᵀ,   S = ∂u/∂p,   A = ∂P/∂F
//! ```
//!
//! The multipliers ζ of F(u) = 0 follow from one solution with the residuals, K ζ = Hᵀ W (d − H u): they tell where the data
//! pull the field away from equilibrium.

use std::sync::Arc;

use crate::error::{Diagnostic, Error};
use crate::markers::Marker;
use crate::material::HyperelasticLaw;
use crate::mesh::Mesh;

mod approach;
mod body_force;
mod contradiction;
mod edge_motion;
mod forces;
mod free_edges;
mod linearise;
mod mesh_error;
mod observations;
mod outline;
mod regressed_law;
mod regression;
mod result;
mod robust;
mod search;
mod start;
mod transfer;
mod whiteness;

pub use contradiction::Contradiction;
pub use edge_motion::EdgeCondition;
pub use regressed_law::RegressedLaw;
pub use result::{
    EdgeForce, EdgeOutcome, FieldEstimate, ForceCheck, MarkerEstimate, Smoothing, StressEstimate,
    TRADE, TRADE_WEIGHTED,
};
pub use robust::Robust;
pub use transfer::transfer;
pub use whiteness::Whiteness;

use observations::Observations;
use outline::{Segment, segments};

/// The sheet whose displacements were measured.
#[derive(Clone, Debug)]
pub struct Specimen<'a> {
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// Its material.
    pub law: Arc<dyn HyperelasticLaw>,
    /// Its thickness at rest in mm.
    pub thickness: f64,
}

/// What is known besides the displacements. All of it may be left out.
#[derive(Clone, Debug, Default)]
pub struct Knowledge {
    /// What is known of named parts of the boundary. Holes that are not named are free.
    pub edges: Vec<(String, EdgeCondition)>,
    /// What is assumed of the outer boundary where no part is named.
    pub unnamed: Unnamed,
    /// Forces that were measured.
    pub forces: Vec<MeasuredForce>,
    /// Standard deviation of each component of the displacement of markers without one of their own, in mm; nothing where it
    /// is to be estimated.
    pub noise: Option<f64>,
    /// How markers that are far off are weighted.
    pub robust: Robust,
    /// Whether equilibrium holds exactly.
    pub physics: Physics,
    /// Parameters of the law that are found with the field; the specimen's law is not used then.
    pub law: Option<RegressedLaw>,
}

/// What is assumed of the outer boundary, from corner to corner, where no part is named.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unnamed {
    /// All parts begin as loaded. One after the other, the longest first, is taken as free where the data do not contradict:
    /// where the misfit grows by no more than noise would let it in ninety-nine of a hundred cases (F test). One stays loaded.
    #[default]
    Tested,
    /// All parts are loaded: the mesh ends inside of the specimen.
    Loaded,
    /// All parts are free.
    Free,
}

impl Unnamed {
    /// The names that conditions use.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("tested", Self::Tested),
        ("loaded", Self::Loaded),
        ("free", Self::Free),
    ];
}

/// How far the equations hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Physics {
    /// F(u) = 0.
    #[default]
    Exact,
    /// F(u) = f with smooth forces f on the interior, which stand for what law, thickness and equations lack: the weight of
    /// ∫ f² beside the misfit follows by restricted maximum likelihood. Where the physics is right, f comes out as nothing.
    Weighted,
}

impl Physics {
    /// The names that conditions use.
    pub const NAMES: [(&'static str, Self); 2] =
        [("exact", Self::Exact), ("weighted", Self::Weighted)];
}

/// A force that was measured on an edge that is not free.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredForce {
    /// The group of the edge.
    pub edge: String,
    /// 0 along x, 1 along y.
    pub axis: usize,
    /// The force of the grip on the sheet in N.
    pub force: f64,
    /// Its standard deviation in N.
    pub standard_deviation: f64,
}

/// Estimates the field from the markers of one frame.
///
/// # Errors
/// [`Error::Input`] when the data, the mesh and the conditions do not go together or do not determine the field,
/// [`Error::Solve`] when no equilibrium near the data was found.
pub fn estimate(
    specimen: &Specimen,
    markers: &[Marker],
    knowledge: &Knowledge,
) -> Result<FieldEstimate, Error> {
    let input = |fault: Diagnostic| Error::Input(vec![fault]);
    let names: Vec<&str> = knowledge
        .edges
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    let outline = segments(specimen.mesh, &names).map_err(input)?;
    check(knowledge).map_err(input)?;
    let observations = Observations::new(specimen.mesh, markers, knowledge.noise).map_err(input)?;
    let edges = outline
        .iter()
        .map(|segment| Edge::new(segment, knowledge))
        .collect();
    let task = Task {
        specimen,
        observations: &observations,
        knowledge,
    };
    let (found, edges) = free_edges::search(&task, edges)?;
    let own = found.mesh_error(&edges);
    let contradiction = contradiction::contradiction(&task, &found, &edges, own.as_ref());
    found.into_estimate(&edges, own.as_ref(), contradiction)
}

/// A part of the boundary with its condition.
#[derive(Clone, Debug)]
pub(crate) struct Edge<'a> {
    segment: &'a Segment,
    condition: EdgeCondition,
    /// Whether the data choose between loaded and free.
    tested: bool,
    /// Where they have chosen: how probable the misfit of the free edge was.
    probability: Option<f64>,
}

impl<'a> Edge<'a> {
    fn new(segment: &'a Segment, knowledge: &Knowledge) -> Self {
        let open = segment.outer && segment.condition.is_none();
        let condition = match segment.condition {
            Some(number) => knowledge.edges[number].1,
            None if open && knowledge.unnamed != Unnamed::Free => EdgeCondition::Unknown,
            None => EdgeCondition::Free,
        };
        Self {
            segment,
            condition,
            tested: open && knowledge.unnamed == Unnamed::Tested,
            probability: None,
        }
    }
}

/// What the search is for.
#[derive(Clone, Copy)]
pub(crate) struct Task<'a> {
    specimen: &'a Specimen<'a>,
    observations: &'a Observations,
    knowledge: &'a Knowledge,
}

/// Looks at the measured forces and the noise.
fn check(knowledge: &Knowledge) -> Result<(), Diagnostic> {
    for MeasuredForce {
        edge,
        force,
        standard_deviation,
        ..
    } in &knowledge.forces
    {
        let condition = knowledge.edges.iter().find(|(name, _)| name == edge);
        if condition.is_none_or(|(_, condition)| *condition == EdgeCondition::Free) {
            let fault =
                format!("the force on `{edge}` was measured, but the edge is not named as held");
            return Err(Diagnostic::error("", fault).hint("say that it is known, rigid or unknown"));
        }
        let sound = force.is_finite() && standard_deviation.is_finite();
        if !sound || *standard_deviation <= 0.0 {
            let fault = format!("the force on `{edge}` is {force} ± {standard_deviation} N");
            return Err(
                Diagnostic::error("", fault).hint("give finite numbers and a positive deviation")
            );
        }
    }
    if knowledge.law.is_some() && knowledge.forces.is_empty() {
        let fault = "a parameter of the law is to be found without a measured force";
        return Err(Diagnostic::error("", fault).hint(
            "displacements alone say nothing of a stiffness: give the force on an edge with its deviation",
        ));
    }
    if knowledge
        .noise
        .is_some_and(|noise| !(noise > 0.0 && noise.is_finite()))
    {
        return Err(Diagnostic::error("", "the noise is not positive")
            .hint("leave it out to have it estimated"));
    }
    Ok(())
}

#[cfg(test)]
mod coverage;
#[cfg(test)]
mod tests;
