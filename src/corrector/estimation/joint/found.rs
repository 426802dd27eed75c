//! What a joint search begins with, and what it finds.

use nalgebra::DVector;

use super::direction::Direction;
use crate::corrector::estimation::given::{Knowledge, MeasuredForce, RegressedLaw};
use crate::markers::Marker;
use crate::material::parameters::Parameter;
use crate::mesh::Mesh;
use crate::statistics::{Estimate, chi_squared_limit};

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
    /// Whether the parameters' errors hold those of the meshes: not where a mesh is too large to be refined.
    pub holds_mesh_error: bool,
    /// What was found of each frame.
    pub frames: Vec<FrameOutcome>,
    /// The correlation ρ of what is left in one frame and the next of its specimen.
    pub common: f64,
    /// Σ Qₖ at its minimum.
    pub misfit: f64,
    /// How far the measured forces are from those of the fields.
    pub force_scatter: ForceScatter,
    /// −2 ln L of markers and forces with as many values as are independent, but for a constant of the data.
    pub deviance: f64,
    /// Parameters that the data determined: of edges and law.
    pub effective_parameters: f64,
    /// Values that are independent: of markers and forces.
    pub independent: f64,
    /// Steps of the search.
    pub steps: usize,
    /// Why the search ended before the least misfit, if it did: frames have no equilibrium with the parameters beyond.
    pub ended: Option<String>,
}

/// How far measured forces are from those of the fields with the law found, over what noise leaves of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceScatter {
    /// χ² = Σ (F − f)²/(σ² + s²).
    pub misfit: f64,
    /// Its degrees of freedom: forces less parameters that the data determine.
    pub freedom: f64,
}

impl ForceScatter {
    pub(super) fn new(misfit: f64, freedom: f64) -> Self {
        Self { misfit, freedom }
    }

    /// By how much variances are larger than the noises let expect, never smaller: χ² over its degrees of freedom (Birge's ratio squared).
    ///
    /// # References
    /// R. T. Birge, Phys. Rev. 40, 207 (1932), doi:10.1103/PhysRev.40.207
    pub fn widening(&self) -> f64 {
        match self.freedom >= 1.0 {
            true => (self.misfit / self.freedom).max(1.0),
            false => 1.0,
        }
    }

    /// Whether chance leaves so much in less than one case of a thousand.
    pub fn is_too_large(&self) -> bool {
        const CHANCE: f64 = 1e-3;
        self.freedom >= 1.0 && self.misfit > chi_squared_limit(self.freedom, CHANCE)
    }
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

/// A step in θ, or the score behind it.
pub type Step = DVector<f64>;
