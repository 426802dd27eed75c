//! Parameters of a law from all frames of all specimens together.
//!
//! ```text
//! minimise over θ  Σₖ Qₖ(θ),    Qₖ(θ) = min over pₖ of  ‖H uₖ − dₖ‖²_W + ‖fₖ − Fₖ‖²/σ² + Σ λ ‖ρ‖²   subject to F(uₖ; θ) = 0
//!
//! Sₖ = M_θθ − M_θp M_pp⁻¹ M_pθ,   tₖ = m_θ − M_θp M_pp⁻¹ m_p          the information of frame k on θ, its edges being free to follow
//! δθ = (Σ Sₖ)⁻¹ Σ tₖ,             Cov(θ) = S⁻¹ (Σ Jₖ + ρ (K − 1) Jₖ') S⁻¹
//! ```
//!
//! M is the matrix of the regression of one frame about the field that is nearest to its markers alone; the forces act on the law through these
//! equations, with the noise of the field's own force added to that of the measured one. The eigenvectors of Σ Sₖ, with every parameter relative to
//! its value, are the combinations of parameters that the data determine one by one; those with a relative standard error over [`VAGUE`] are not
//! determined, and keep the card's values but for a common factor of all stresses. Jₖ = Sₖ where the noise of the markers is white; otherwise it is
//! that of the noise found; Jₖ' is the markers' part of it. ρ is the correlation of a marker's residuals in one frame and the next: noise of the
//! picture at rest is common to all frames.
//!
//! The discretisation error is the effect that the equilibria on cells half as large, at the same motions of the edges, have on the right-hand
//! sides: e = S⁻¹ Σ (−AᵀWHd/v − Gᵀd_F/σ), reduced as tₖ is ([`MeshError`](super::search::MeshError) has d, G and d_F of one frame). ± 1.96
//! e is added to the intervals as if it were noise; it is alike in all frames, so that more frames do not reduce it.
//!
//! The effects of a standard deviation of the load cell's gain, and of one of the pictures' scale, on the right-hand
//! sides are added likewise, of the same sign in all frames of all specimens. Where measured forces scatter more than
//! both noises explain, Cov(θ) is multiplied by their χ² over its degrees of freedom.
//!
//! # References
//! L. Kish, Survey Sampling, Wiley 1965 (the factor 1 + ρ (K − 1)); D. J. Venzon, S. H. Moolgavkar, Appl. Stat. 37, 87 (1988),
//! doi:10.2307/2347496 (profile likelihood).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::input::{MeasuredForce, RegressedLaw};
use crate::error::Error;
use crate::statistics::{normal_reach, student_reach};
use descent::{Course, Descent};
use direction::directions;
use estimate::Step;
use frame::{Frame, FrameInformation};

mod descent;
mod direction;
mod estimate;
mod frame;
mod profile;
mod reduced;
#[cfg(test)]
mod tests;

pub use direction::{Direction, VAGUE};
pub use estimate::{
    ForcePrediction, ForceScatter, FrameOutcome, JointEstimate, JointFrame, JointSettings, Watch,
};
pub use frame::residual_products;

/// Estimates the parameters of a law from all frames together.
///
/// # Errors
/// [`Error::Input`] when the data, meshes and conditions do not match, no force was measured in any frame, or the
/// data determine no parameter at all; [`Error::Solve`] when no equilibrium near the data is found.
pub fn estimate_jointly(
    frames: &[JointFrame],
    law: &RegressedLaw,
    settings: &JointSettings,
    watch: Watch,
) -> Result<JointEstimate, Error> {
    check_joint_frames(frames)?;
    watch("edges of the frames");
    let searched = frames.par_iter().map(|source| Frame::new(source, law));
    let frames = searched.collect::<Result<Vec<Frame>, Error>>()?;
    let mut descent = Descent::new(frames.iter().collect(), law);
    let (course, scales) = descent.run(watch)?;
    outcome(&descent, course, scales, settings, watch)
}

/// Checks that a force was measured in some frame.
///
/// # Errors
/// [`Error::Input`] where none was.
pub fn check_joint_frames(frames: &[JointFrame]) -> Result<(), Error> {
    if frames
        .iter()
        .any(|frame| !frame.knowledge.forces.is_empty())
    {
        return Ok(());
    }
    Err(Error::input(
        "parameters of the law are to be estimated, but no force was measured in any frame",
        "give the force on an edge with its standard deviation: displacements alone do not determine a stiffness",
    ))
}

/// The results at the end of the search.
fn outcome(
    descent: &Descent,
    course: Course,
    scales: Vec<f64>,
    settings: &JointSettings,
    watch: Watch,
) -> Result<JointEstimate, Error> {
    let law = descent.law.beginning_at(&course.values);
    let states = descent.frames.par_iter().zip(&course.states);
    let of_frames = states.map(|(frame, state)| frame.information(&law, state));
    let parts = of_frames.collect::<Result<Vec<FrameInformation>, Error>>()?;
    let directions = directions(&course.information(), &scales);
    if course.ended.is_none() && !directions.iter().any(Direction::is_determined) {
        return Err(Error::input(
            "the data determine no parameter of the law",
            "give a measured force with its standard deviation, state more about the edges, or use frames with larger strains",
        ));
    }
    let inverse = direction::inverse(&directions, &scales, VAGUE);
    let common = frame::common_noise(&descent.frames, &parts);
    let sum = |value: fn(&FrameInformation) -> f64| parts.iter().map(value).sum::<f64>();
    let determined = directions.iter().filter(|one| one.is_determined()).count() as f64;
    let measured = descent.measured();
    let force_scatter = ForceScatter {
        misfit: sum(|part| part.force_misfit),
        freedom: measured - determined,
    };
    let covariance = covariance(&parts, &inverse, common, force_scatter.widening());
    watch("intervals");
    let mesh = mesh_error(&parts, &inverse);
    let effective = sum(|part| part.effective) + determined;
    let ends = profile::Ends {
        descent,
        course: &course,
        inverse: &inverse,
        covariance: &covariance,
        common_error: &common_error(&parts, &inverse, mesh.as_ref()),
        reach: reach(descent, sum(|part| part.independent) - effective),
        directions: &directions,
    };
    let frames = frame_outcomes(descent, &course, &parts, &inverse, settings.groups, watch)?;
    let shares = frames.iter().zip(&parts);
    let growth: f64 = shares.map(|(frame, part)| frame.share * part.growth).sum();
    let mut parameters = ends.intervals(settings.profiles);
    for (estimate, parameter) in parameters.iter_mut().zip(law.parameters()) {
        if parameter.unit() == "MPa" {
            *estimate = estimate.lower_by(growth);
        }
    }
    Ok(JointEstimate {
        parameters,
        law,
        holds_mesh_error: mesh.is_some(),
        frames,
        common,
        force_scatter,
        effective_parameters: effective,
        steps: course.steps,
        ended: course.ended,
        directions,
    })
}

/// S⁻¹ (Σ Jₖ + ρ (K − 1) Jₖ') S⁻¹, multiplied by the scatter of forces where it exceeds both noises.
fn covariance(
    parts: &[FrameInformation],
    inverse: &DMatrix<f64>,
    common: f64,
    widening: f64,
) -> DMatrix<f64> {
    let repeated = common * (equal_frames(parts, inverse) - 1.0).max(0.0);
    let sum = parts.iter().fold(inverse * 0.0, |sum, part| {
        sum + &part.spread + &part.spread_of_markers * repeated
    });
    inverse * (sum * widening) * inverse
}

/// The error of each parameter due to errors that all frames have in common: those of forces, of pictures, and of meshes, as if independent.
fn common_error(parts: &[FrameInformation], inverse: &DMatrix<f64>, mesh: Option<&Step>) -> Step {
    let common = [0, 1].map(|kind| {
        let targets = parts.iter().map(|part| &part.common[kind]);
        inverse * targets.sum::<Step>()
    });
    let all = common.iter().chain(mesh);
    all.fold(DVector::zeros(inverse.nrows()), |sum, step| {
        sum.zip_map(step, f64::hypot)
    })
}

/// S⁻¹ Σ tₖ from the effects of the discretisation errors on the right-hand sides, which are the same where frames have the same mesh.
fn mesh_error(parts: &[FrameInformation], inverse: &DMatrix<f64>) -> Option<Step> {
    let targets = parts.iter().map(|part| part.mesh.as_ref());
    Some(inverse * targets.sum::<Option<Step>>()?)
}

/// Half the width of a 95 % interval in standard errors, with the degrees of freedom of an estimated noise.
fn reach(descent: &Descent, freedom: f64) -> f64 {
    const LEAST_FREEDOM: f64 = 3.0;
    if descent.frames.iter().all(|frame| frame.knows_noise()) {
        normal_reach()
    } else {
        student_reach(freedom.max(LEAST_FREEDOM))
    }
}

/// K, the number of frames of equal information that would carry the same: (Σ s)²/Σ s² of the frames' shares s.
fn equal_frames(parts: &[FrameInformation], inverse: &DMatrix<f64>) -> f64 {
    let shares = parts
        .iter()
        .map(|part| part.information.dot(inverse).max(0.0));
    let [sum, square] = shares.fold([0.0; 2], |[sum, square], share| {
        [sum + share, square + share * share]
    });
    sum * sum / square.max(f64::MIN_POSITIVE)
}

/// The results of every frame: its share, and its forces predicted with the law of the other groups of frames, if these have forces.
fn frame_outcomes(
    descent: &Descent,
    course: &Course,
    parts: &[FrameInformation],
    inverse: &DMatrix<f64>,
    groups: usize,
    watch: Watch,
) -> Result<Vec<FrameOutcome>, Error> {
    let count = course.states.len();
    let groups = groups.clamp(1, count);
    let mut outcomes = Vec::with_capacity(count);
    for group in 0..groups {
        let members = group * count / groups..(group + 1) * count / groups;
        watch(&format!("frames left out, group {} of {groups}", group + 1));
        let others = if groups == 1 {
            None
        } else {
            descent.without_frames(course, &members, watch)?
        };
        let law = descent
            .law
            .beginning_at(others.as_ref().unwrap_or(&course.values));
        let outcome = |index: usize| {
            let frame = descent.frames[index];
            let prediction = frame.cross_predict(&law, Some(&course.states[index]))?;
            let part = &parts[index];
            Ok(FrameOutcome {
                share: part.information.dot(inverse) / course.values.len() as f64,
                forces: force_predictions(frame, prediction.forces, others.is_some()),
                residual_rms: prediction.residual_rms,
                deviance: part.deviance,
                independent: part.independent,
            })
        };
        let prediction = members.into_par_iter().map(outcome);
        outcomes.extend(prediction.collect::<Result<Vec<FrameOutcome>, Error>>()?);
    }
    Ok(outcomes)
}

fn force_predictions(
    frame: &Frame,
    predicted: Vec<f64>,
    is_predicted: bool,
) -> Vec<ForcePrediction> {
    let forces = frame.measured().iter().zip(predicted);
    let force = |(measured, predicted): (&MeasuredForce, f64)| ForcePrediction {
        measured: measured.clone(),
        predicted: is_predicted.then_some(predicted),
    };
    forces.map(force).collect()
}
