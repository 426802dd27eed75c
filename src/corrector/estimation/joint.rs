//! Parameters of a law from all frames of all specimens together.
//!
//! ```text
//! minimise over θ  Σₖ Qₖ(θ),    Qₖ(θ) = min over pₖ of  ‖H uₖ − dₖ‖²_W + ‖fₖ − Fₖ‖²/σ² + Σ λ ‖ρ‖²   subject to F(uₖ; θ) = 0
//!
//! Sₖ = M_θθ − M_θp M_pp⁻¹ M_pθ,   tₖ = m_θ − M_θp M_pp⁻¹ m_p          what frame k says of θ, its edges being free to follow
//! δθ = (Σ Sₖ)⁻¹ Σ tₖ,             Cov(θ) = S⁻¹ (Σ Jₖ) S⁻¹ (1 + ρ (K − 1))
//! ```
//!
//! M is the matrix of the regression of one frame about the field that is nearest to its markers alone; the forces act on the law by these
//! equations, with the noise of the field's own force beside that of the measured one. The eigenvectors of Σ Sₖ, every parameter over its value, are the
//! combinations of parameters that the data determine one by one; those with a relative standard error over [`VAGUE`] are not
//! determined, and stay as the card has them, but for a common factor of all stresses. Jₖ = Sₖ where the noise of the markers is white; else that of the noise found. ρ is the
//! correlation of what is left of a marker in one frame and the next: noise of the picture at rest is common to all frames.
//!
//! # References
//! L. Kish, Survey Sampling, Wiley 1965 (the factor 1 + ρ (K − 1)); D. J. Venzon, S. H. Moolgavkar, Appl. Stat. 37, 87 (1988),
//! doi:10.2307/2347496 (profile likelihood).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::knowledge::{Knowledge, MeasuredForce};
use super::regressed_law::RegressedLaw;
use crate::error::{Diagnostic, Error};
use crate::markers::Marker;
use crate::material::parameters::Parameter;
use crate::mesh::Mesh;
use crate::statistics::{Estimate, normal_reach, student_reach};
use descent::{Course, Descent};
use direction::directions;
use frame::{Ground, Judged, Say};

mod descent;
mod direction;
mod frame;
mod left_out;
mod profile;
#[cfg(test)]
mod tests;

pub use direction::{Direction, VAGUE};

/// One frame of one specimen. The law of what is known is not used.
#[derive(Clone, Debug)]
pub struct JointFrame<'a> {
    /// The specimen's mesh.
    pub mesh: &'a Mesh,
    /// Its thickness at rest in mm.
    pub thickness: f64,
    /// The markers.
    pub markers: &'a [Marker],
    /// What is known besides.
    pub knowledge: Knowledge,
}

/// What is to be found, and how.
#[derive(Clone, Copy, Debug)]
pub struct JointSettings {
    /// Into how many groups of frames, one after the other, the frames are split to leave out one after the other.
    pub groups: usize,
    /// Whether intervals follow the likelihood rather than standard errors.
    pub profiles: bool,
}

impl Default for JointSettings {
    /// Five groups, intervals by likelihood.
    fn default() -> Self {
        Self {
            groups: 5,
            profiles: true,
        }
    }
}

/// What all frames say of the parameters together.
#[derive(Clone, Debug)]
pub struct JointEstimate {
    /// The law; its search would begin at the values found.
    pub law: RegressedLaw,
    /// The parameters with their intervals, in the order of [`RegressedLaw::parameters`]; without uncertainty those that are not
    /// determined, given which are those of the others.
    pub parameters: Vec<Estimate>,
    /// Combinations of parameters, the best determined first.
    pub directions: Vec<Direction>,
    /// What was found of each frame.
    pub frames: Vec<FrameOutcome>,
    /// The correlation ρ of what is left in one frame and the next of its specimen.
    pub common: f64,
    /// Σ Qₖ at its minimum.
    pub misfit: f64,
    /// −2 ln L of markers and forces with as many values as are independent, but for a constant of the data.
    pub deviance: f64,
    /// Parameters that the data determined: of edges and law.
    pub effective_parameters: f64,
    /// Values that are independent: of markers and forces.
    pub independent: f64,
    /// Steps of the search.
    pub steps: usize,
}

/// What was found of one frame.
#[derive(Clone, Debug)]
pub struct FrameOutcome {
    /// Its share of what is known of the parameters: tr(S⁻¹ Sₖ) over the number of parameters.
    pub share: f64,
    /// Each measured force.
    pub forces: Vec<ForcePrediction>,
    /// Root mean square of what is left of each component of the sound markers in mm, with the law of the other frames.
    pub left: f64,
}

/// A measured force, and that of the field with the law of the other groups of frames.
#[derive(Clone, Debug, PartialEq)]
pub struct ForcePrediction {
    /// What was measured.
    pub measured: MeasuredForce,
    /// In N; `None` where no other group has a measured force.
    pub predicted: Option<f64>,
}

impl JointEstimate {
    /// The corrected Akaike information criterion, with as many values as are independent; infinite where there are too few.
    ///
    /// # References
    /// C. M. Hurvich, C.-L. Tsai, Biometrika 76, 297 (1989), doi:10.1093/biomet/76.2.297
    pub fn information_criterion(&self) -> f64 {
        let (k, n) = (self.effective_parameters, self.independent);
        match n - k - 1.0 > 0.0 {
            true => self.deviance + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0),
            false => f64::INFINITY,
        }
    }

    /// Root mean square of the errors of predicted forces over that of the measured ones; `None` where none was predicted.
    pub fn prediction_error(&self) -> Option<f64> {
        let all = self.frames.iter().flat_map(|frame| &frame.forces);
        let pairs = all.filter_map(|force| Some((force.measured.force, force.predicted?)));
        let [off, whole] = pairs.fold([0.0; 2], |[off, whole], (measured, predicted)| {
            [
                off + (predicted - measured).powi(2),
                whole + measured * measured,
            ]
        });
        (whole > 0.0).then(|| (off / whole).sqrt())
    }

    /// The parameters of the law with their values.
    pub fn with_keys(&self) -> impl Iterator<Item = (&Parameter, &Estimate)> {
        self.law.parameters().iter().zip(&self.parameters)
    }
}

/// What is done next, for somebody who waits.
pub type Told<'a> = &'a (dyn Fn(&str) + Sync);

/// Finds the parameters of a law from all frames together.
///
/// # Errors
/// [`Error::Input`] when the data, meshes and conditions do not go together, no force was measured in any frame, or the data determine no
/// parameter at all; [`Error::Solve`] when no equilibrium near the data is found.
pub fn estimate_jointly(
    frames: &[JointFrame],
    law: &RegressedLaw,
    settings: &JointSettings,
    told: Told,
) -> Result<JointEstimate, Error> {
    check_joint_frames(frames)?;
    told("edges of the frames");
    let grounds: Result<Vec<Ground>, Error> = frames.par_iter().map(Ground::new).collect();
    let grounds = grounds?;
    let judged: Result<Vec<Judged>, Error> = grounds
        .par_iter()
        .map(|ground| ground.judged(law))
        .collect();
    let judged = judged?;
    let mut descent = Descent::new(judged.iter().collect(), law);
    let course = descent.find(told)?;
    outcome(&descent, course, settings, told)
}

/// Whether a force was measured in any frame.
///
/// # Errors
/// [`Error::Input`] where none was.
pub fn check_joint_frames(frames: &[JointFrame]) -> Result<(), Error> {
    let measured = frames
        .iter()
        .any(|frame| !frame.knowledge.forces.is_empty());
    if measured {
        return Ok(());
    }
    let fault = Diagnostic::error(
        "",
        "parameters of the law are to be found, and no force was measured in any frame",
    );
    Err(Error::Input(vec![fault.hint(
        "displacements alone say nothing of a stiffness: give the force on an edge with its deviation",
    )]))
}

/// Degrees of freedom of the noise that are taken at least.
const LEAST_FREEDOM: f64 = 3.0;

/// All that follows where the search ends.
fn outcome(
    descent: &Descent,
    course: Course,
    settings: &JointSettings,
    told: Told,
) -> Result<JointEstimate, Error> {
    let says: Result<Vec<Say>, Error> = descent
        .frames
        .par_iter()
        .zip(&course.states)
        .map(|(frame, state)| frame.say(&descent.law, &course.values, state))
        .collect();
    let says = says?;
    let scales = &descent.settled_scales(&course);
    let whole = course.information();
    let directions = directions(&whole, scales);
    if !directions.iter().any(Direction::is_determined) {
        return Err(Error::input(
            "the data determine no parameter of the law",
            "measure a force with a deviation, say more of the edges, or take frames with larger strains",
        ));
    }
    let inverse = direction::inverse(&directions, scales, VAGUE);
    let common = frame::common_noise(&descent.frames, &says);
    let spread = says
        .iter()
        .fold(DMatrix::zeros(scales.len(), scales.len()), |sum, say| {
            sum + &say.spread
        });
    let alike = 1.0 + common * (says_that_count(&says, &inverse) - 1.0).max(0.0);
    let covariance = &inverse * spread * &inverse * alike;
    told("intervals");
    let sum = |value: fn(&Say) -> f64| says.iter().map(value).sum::<f64>();
    let determined = directions.iter().filter(|one| one.is_determined()).count() as f64;
    let effective = sum(|say| say.effective) + determined;
    let freedom = (sum(|say| say.independent) - effective).max(LEAST_FREEDOM);
    let reach = match descent.frames.iter().all(|frame| frame.knows_noise()) {
        true => normal_reach(),
        false => student_reach(freedom),
    };
    let ends = profile::Ends {
        descent,
        course: &course,
        inverse: &inverse,
        covariance: &covariance,
        reach,
        directions: &directions,
    };
    let parameters = ends.intervals(settings.profiles);
    let frames = left_out::outcomes(descent, &course, (&says, &inverse), settings, told)?;
    let forces: usize = frames.iter().map(|frame| frame.forces.len()).sum();
    Ok(JointEstimate {
        law: descent.law.beginning_at(&course.values),
        parameters,
        directions,
        frames,
        common,
        misfit: course.misfit(),
        deviance: sum(|say| say.deviance),
        effective_parameters: effective,
        independent: sum(|say| say.independent) + forces as f64,
        steps: course.steps,
    })
}

/// As how many equal frames they count for the parameters: (Σ s)²/Σ s² of their shares s.
fn says_that_count(says: &[Say], inverse: &DMatrix<f64>) -> f64 {
    let shares = says.iter().map(|say| say.information.dot(inverse).max(0.0));
    let [sum, square] = shares.fold([0.0; 2], |[sum, square], share| {
        [sum + share, square + share * share]
    });
    sum * sum / square.max(f64::MIN_POSITIVE)
}

/// A step in θ, or the score behind it.
type Step = DVector<f64>;
