//! The input and the result of a joint estimation.

use nalgebra::DVector;

use super::direction::Direction;
use crate::estimation::input::{Knowledge, MeasuredForce, RegressedLaw, Specimen};
use crate::markers::Marker;
use crate::material::parameters::Parameter;
use crate::statistics::{Estimate, chi_squared_limit, corrected_akaike_criterion};

/// One frame of one specimen. The law in `knowledge` is not used, nor is that of the cells that belong to no region: theirs is searched for.
#[derive(Clone, Debug)]
pub struct JointFrame<'a> {
    /// The specimen.
    pub specimen: Specimen<'a>,
    /// The markers.
    pub markers: &'a [Marker],
    /// What is known besides the displacements.
    pub knowledge: Knowledge,
}

/// The settings of a joint search.
#[derive(Clone, Copy, Debug)]
pub struct JointSettings {
    /// The number of groups of consecutive frames, each of which is left out in turn.
    pub groups: usize,
    /// Whether intervals follow from the likelihood instead of standard errors.
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

/// The parameters according to all frames together.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JointEstimate {
    /// The law; a new search would begin at the values found.
    pub law: RegressedLaw,
    /// The parameters with their intervals, in the order of [`RegressedLaw::parameters`]; those that are not
    /// determined have no uncertainty, and the intervals of the others are conditional on them.
    pub parameters: Vec<Estimate>,
    /// Combinations of parameters, the best determined first.
    pub directions: Vec<Direction>,
    /// Whether the parameters' errors include those of the meshes, which they do not where a mesh is too large to be refined.
    pub holds_mesh_error: bool,
    /// The results of each frame.
    pub frames: Vec<FrameOutcome>,
    /// The correlation ρ of the residuals in one frame and the next of its specimen.
    pub common: f64,
    /// The scatter of the measured forces about those of the fields.
    pub force_scatter: ForceScatter,
    /// Number of parameters of edges and law that the data determined.
    pub effective_parameters: f64,
    /// Steps of the search.
    pub steps: usize,
    /// Why the search ended before the least misfit, if it did: frames have no equilibrium at the next values.
    pub ended: Option<String>,
}

/// The scatter of measured forces about those of the fields with the law found, relative to both noises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceScatter {
    /// χ² = Σ (F − f)²/(σ² + s²).
    pub misfit: f64,
    /// Its degrees of freedom: the number of forces less the parameters that the data determine.
    pub freedom: f64,
}

impl ForceScatter {
    /// The factor by which variances exceed those expected from the noises, at least 1: χ² over its degrees of freedom (Birge's ratio squared).
    ///
    /// # References
    /// R. T. Birge, Phys. Rev. 40, 207 (1932), doi:10.1103/PhysRev.40.207
    pub fn widening(&self) -> f64 {
        if self.freedom >= 1.0 {
            (self.misfit / self.freedom).max(1.0)
        } else {
            1.0
        }
    }

    /// Whether chance causes so large a χ² in less than one case of a thousand.
    pub fn is_too_large(&self) -> bool {
        const CHANCE: f64 = 1e-3;
        self.freedom >= 1.0 && self.misfit > chi_squared_limit(self.freedom, CHANCE)
    }
}

/// The results of one frame.
#[derive(Clone, Debug)]
pub struct FrameOutcome {
    /// Its share of the information on the parameters: tr(S⁻¹ Sₖ) over the number of parameters.
    pub share: f64,
    /// Each measured force.
    pub forces: Vec<ForcePrediction>,
    /// Root mean square of each component of the sound markers' residuals in mm, with the law of the other frames.
    pub residual_rms: f64,
    /// −2 ln L of one of its markers' independent values, up to a constant of the data.
    pub deviance: f64,
    /// Number of independent values of its markers.
    pub independent: f64,
}

/// A measured force, and that of the field with the law of the other groups of frames.
#[derive(Clone, Debug, PartialEq)]
pub struct ForcePrediction {
    /// The measured force.
    pub measured: MeasuredForce,
    /// The predicted force in N; `None` where no other group has a measured force.
    pub predicted: Option<f64>,
}

impl JointEstimate {
    /// The corrected Akaike information criterion, beside that of other laws with the same frames; infinite where there are too few
    /// independent values.
    ///
    /// Each law's residuals may show another number of independent values. Likelihoods of different numbers of values cannot be compared, so
    /// that all laws have the least number of each frame.
    pub fn information_criterion(&self, laws: &[&Self]) -> f64 {
        let mut independent = 0.0;
        let mut deviance = self.force_scatter.misfit;
        for (k, frame) in self.frames.iter().enumerate() {
            let others = laws.iter().filter_map(|law| law.frames.get(k));
            let least = others
                .map(|other| other.independent)
                .fold(frame.independent, f64::min);
            independent += least + frame.forces.len() as f64;
            deviance += least * frame.deviance;
        }
        corrected_akaike_criterion(deviance, self.effective_parameters, independent)
    }

    /// Root mean square of the errors of predicted forces relative to that of the measured ones; `None` where none was predicted.
    pub fn prediction_error(&self) -> Option<f64> {
        let all = self.frames.iter().flat_map(|frame| &frame.forces);
        let pairs = all.filter_map(|force| Some((force.measured.force, force.predicted?)));
        let [error, size] = pairs.fold([0.0; 2], |[error, size], (measured, predicted)| {
            [
                error + (predicted - measured).powi(2),
                size + measured * measured,
            ]
        });
        (size > 0.0).then(|| (error / size).sqrt())
    }

    /// The parameters of the law with their values.
    pub fn with_keys(&self) -> impl Iterator<Item = (&Parameter, &Estimate)> {
        self.law.parameters().iter().zip(&self.parameters)
    }
}

/// Reports progress: called with a description of the next action.
pub type Watch<'a> = &'a (dyn Fn(&str) + Sync);

/// A step in θ, or the score behind it.
pub type Step = DVector<f64>;
