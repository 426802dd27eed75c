//! The field nearest to measured displacements that satisfies the physics, with its uncertainty from the data.
//!
//! ```text
//! minimise ½ ‖H u − d‖²_W   subject to   F(u) = 0 at inner nodes and free edges
//! ```
//!
//! d are the displacements of markers anywhere on the sheet, H interpolates the field of the mesh there, W = 1/variance. As F(u) = 0
//! leaves only the displacements of the loaded edges free, u = u(p) where p are the coefficients of smooth functions along these
//! edges (cubic B-splines) and three numbers for every rigid grip. Their sensitivities follow from the tangent K,
//!
//! ```text
//! ∂u/∂p = Φ − K⁻¹ K_B Φ        Φ = ∂u_B/∂p
//! ```
//!
//! and each Gauss–Newton step is a small regression with the equations linearised about the field reached so far; the
//! first one is a polynomial through the markers, never the noisy data. The data decide how smooth an edge is, by restricted
//! maximum likelihood. Intervals follow from the covariance C of p, to first order in the noise:
//!
//! ```text
//! Cov(u) = S C Sᵀ,   Cov(P) = A:∇S C (A:∇S)ᵀ,   S = ∂u/∂p,   A = ∂P/∂F
//! ```
//!
//! The multipliers ζ of F(u) = 0 follow from one solution with the residuals, K ζ = Hᵀ W (d − H u): they show where the data
//! pull the field away from equilibrium.

use crate::error::Error;
use crate::markers::Marker;
use equations::Equations;
use input::{Task, observe};
use search::MOST_STEPS;

mod edges;
mod equations;
mod forces;
mod free_edges;
mod input;
mod joint;
mod judge;
mod noise;
mod outcome;
mod regression;
mod result;
mod search;
mod transfer;
mod uncertainty;

pub use input::{
    EdgeCondition, FORCE_CLASS, Knowledge, MeasuredForce, Physics, RegressedLaw, Specimen,
    UncertainLaw, Unnamed, name_parts,
};
pub use joint::{
    Direction, ForcePrediction, ForceScatter, FrameOutcome, JointEstimate, JointFrame,
    JointSettings, VAGUE, Watch, check_joint_frames, estimate_jointly, residual_products,
};
pub use outcome::{
    Alternative, Answer, Contradiction, EdgeForce, EdgeOutcome, FieldEstimate, ForceCheck,
    FoundParameter, MarkerEstimate, MovedPart, NoiseCorrelation, RULE, RULE_WITH_MODEL_ERROR,
    Reason, Smoothing, StressEstimate, Trial, Verdict, Worst,
};
pub use regression::Robust;
pub use transfer::transfer;
pub use uncertainty::{MOST_REFINED_CELLS, ScaleChange};

/// Estimates the field from the markers of one frame.
///
/// # Errors
/// [`Error::Input`] when the data, the mesh and the conditions do not match or do not determine the field,
/// [`Error::Solve`] when no equilibrium near the data was found.
pub fn estimate(
    specimen: &Specimen,
    markers: &[Marker],
    knowledge: &Knowledge,
) -> Result<FieldEstimate, Error> {
    let estimate = estimate_with(specimen, markers, knowledge);
    if knowledge.law.is_some() || knowledge.measured_forces().is_empty() {
        return estimate;
    }
    let compared = || {
        let checked = Knowledge {
            forces_are_checks: true,
            ..knowledge.clone()
        };
        estimate_with(specimen, markers, &checked)
    };
    match estimate {
        // Where no field has such forces, the field of the markers alone is compared with them.
        Err(Error::Solve { .. }) => compared(),
        // A wrong force leaves smooth residuals too, which must not pass for noise, and changes the field towards it.
        Ok(estimate)
            if [Answer::Undecided, Answer::NotExplained].contains(&estimate.verdict.answer) =>
        {
            match compared() {
                Ok(other) if other.force_checks.iter().any(ForceCheck::contradicts) => Ok(other),
                _ => Ok(estimate),
            }
        }
        estimate => estimate,
    }
}

/// The nearest field and the residuals of its markers, without verdict, intervals and stresses: the start of another computation. Edges without
/// a stated condition are loaded; with `may_free_edges`, or where equilibrium is not exact, the data decide which of them are free, which takes
/// many times longer. The displacement is empty where gross errors end the estimate.
///
/// # Errors
/// As [`estimate`], and where measured forces leave no solution.
pub fn nearest_field(
    specimen: &Specimen,
    markers: &[Marker],
    knowledge: &Knowledge,
    may_free_edges: bool,
) -> Result<FieldEstimate, Error> {
    let (edges, observations) = observe(specimen.mesh, markers, knowledge)?;
    let task = Task {
        specimen: specimen.clone(),
        observations: &observations,
        knowledge,
    };
    let nearest = if may_free_edges || knowledge.physics != Physics::Exact {
        free_edges::search(&task, edges)?
    } else {
        Equations::new(&task, &edges)?.run(MOST_STEPS)?
    };
    let markers = nearest.markers(None);
    let has_ended = nearest.ends_at_gross_errors(&markers);
    Ok(FieldEstimate {
        markers,
        displacement: if has_ended { Vec::new() } else { nearest.field },
        ..FieldEstimate::default()
    })
}

fn estimate_with(
    specimen: &Specimen,
    markers: &[Marker],
    knowledge: &Knowledge,
) -> Result<FieldEstimate, Error> {
    let (edges, mut observations) = observe(specimen.mesh, markers, knowledge)?;
    let (estimate, noise_ratio) = noise::with_observed_noise(&mut observations, |observations| {
        let task = Task {
            specimen: specimen.clone(),
            observations,
            knowledge,
        };
        let nearest = free_edges::search(&task, edges.clone())?;
        let markers = nearest.markers(None);
        if nearest.ends_at_gross_errors(&markers) {
            let ended = FieldEstimate {
                markers,
                ..FieldEstimate::default()
            };
            return Ok((ended, noise::OtherNoise::default()));
        }
        let other = nearest.other_noise(&markers);
        if other.is_none() {
            Ok((nearest.into_estimate()?, other))
        } else {
            Ok((FieldEstimate::default(), other))
        }
    })?;
    Ok(FieldEstimate {
        noise_ratio,
        ..estimate
    })
}

#[cfg(test)]
mod tests;
