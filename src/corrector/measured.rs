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
//! and each Gauss–Newton step is a small [regression] with the equations linearised about the field reached so far; the
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
use crate::material::HyperelasticLaw;
use crate::measurement::Marker;
use crate::mesh::Mesh;

mod edge_motion;
mod outline;
mod regression;
mod result;
mod robust;
mod search;
mod spline;
mod start;
mod transfer;

pub use edge_motion::EdgeCondition;
pub use result::{EdgeForce, FieldEstimate, MarkerEstimate, Smoothing, StressEstimate, TRADE};
pub use robust::Robust;
pub use transfer::transfer;

use edge_motion::EdgeMotion;
use outline::{Segment, segments};
use search::{Observations, Search};

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
    /// Standard deviation of each component of the displacement of markers without one of their own, in mm; nothing where it
    /// is to be estimated.
    pub noise: Option<f64>,
    /// How markers that are far off are weighted.
    pub robust: Robust,
}

/// A marker farther outside of the mesh than this share of a cell's size is left out.
const OUTSIDE: f64 = 0.25;

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
    let observations = Observations::new(specimen.mesh, markers, knowledge.noise).map_err(input)?;
    let condition = |segment: &Segment| match segment.condition {
        Some(number) => knowledge.edges[number].1,
        None if segment.outer => EdgeCondition::Unknown,
        None => EdgeCondition::Free,
    };
    let conditions: Vec<_> = outline
        .iter()
        .map(|segment| (segment, condition(segment)))
        .collect();
    let spacing = observations.spacing(specimen.mesh);
    let motion = EdgeMotion::new(specimen.mesh, &conditions, spacing);
    let search = Search::new(specimen, &observations, motion, knowledge.robust)?;
    let found = search.run()?;
    found.into_estimate(&conditions)
}

#[cfg(test)]
mod tests;
