//! Whether law, thickness and conditions explain the data.

use serde::{Deserialize, Serialize};

use crate::estimation::input::EdgeCondition;
use crate::statistics::small_probability;
use crate::units::decimals;

/// The answer; a worse one is larger.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, Ord, PartialEq, PartialOrd, Serialize)]
pub enum Answer {
    /// The residuals are white noise.
    #[default]
    Explained,
    /// The residuals are noise that is correlated between neighbours; the intervals include that.
    Correlated,
    /// Nothing speaks against the equations, but the data would hardly show it: too few of their values are independent, gross
    /// errors make up their noise, or only the markers show free edges that they contradict.
    Undecided,
    /// The residuals are not noise: intervals are not valid.
    NotExplained,
}

impl Answer {
    /// The answer in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Explained => "explained",
            Self::Correlated => "explained with correlated noise",
            Self::Undecided => "the data cannot judge",
            Self::NotExplained => "not explained by this law, thickness and conditions",
        }
    }

    /// The answer in words, where the data are those of another `model`.
    pub fn given(self, model: &str) -> String {
        match self {
            Self::NotExplained => format!("not explained by {model}"),
            other => other.words().to_owned(),
        }
    }
}

/// The answer with its evidence.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Verdict {
    /// The answer.
    pub answer: Answer,
    /// The correlation of the noise, where there is one.
    pub correlation: Option<NoiseCorrelation>,
    /// Why the data are not explained, or cannot judge; empty where they are.
    pub reasons: Vec<Reason>,
    /// Alternatives that explain the data better, the best first, where the data are not explained.
    pub trials: Vec<Trial>,
    /// [`Trial::residual_rms`] of the equations as they are, with the same markers and weights, in mm; `None` where nothing was tried.
    pub residual_rms: Option<f64>,
    /// The position with the largest misfit, where the data are not explained.
    pub worst: Option<Worst>,
}

impl Verdict {
    /// Whether intervals are valid: where the residuals are noise, or may be as far as so few independent values show.
    pub fn has_intervals(&self) -> bool {
        let without =
            |reason: &Reason| matches!(reason, Reason::GrossErrors(_) | Reason::UnknownEdges(_));
        self.answer != Answer::NotExplained && !self.reasons.iter().any(without)
    }
}

/// The correlation of noise with distance.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct NoiseCorrelation {
    /// The distance in mm at which the correlation has fallen to 1/e.
    pub length: f64,
    /// The share of the noise's variance that is correlated.
    pub share: f64,
    /// The number of markers with white noise that would carry the same information.
    pub independent: f64,
    /// 2 ln of its likelihood over that of white noise.
    pub evidence: f64,
}

/// Why data are not explained, or cannot judge.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub enum Reason {
    /// An alternative reduces the misfit more than noise would: the probability of that under noise.
    Alternative(f64),
    /// The residuals correlate over a length, and too few markers with white noise would carry the same information.
    Few {
        /// The distance in mm.
        length: f64,
        /// The number of markers with white noise.
        independent: f64,
    },
    /// The data contradict free edges as the markers show them, which may lie up to this distance in mm farther out.
    UnknownEdges(f64),
    /// Gross errors make up the noise, which has this standard deviation in mm.
    GrossErrors(f64),
    /// A measured force differs from that of the field by this number of standard errors.
    Force(f64),
    /// The residuals have this correlation with those of the frame before or after.
    Alike(f64),
    /// The file seems to hold something else than displacements along x and y.
    Mistaken,
}

impl Reason {
    /// The reason in words.
    pub fn words(self) -> String {
        match self {
            Self::Alternative(probability) => format!(
                "an alternative model reduces the misfit by an amount that noise alone would reach with probability {}",
                small_probability(probability)
            ),
            Self::Few {
                length,
                independent,
            } => format!(
                "the residuals correlate over {length:.3} mm, so that the markers are worth {independent:.0} independent ones: too few to \
                 tell noise from a misfit, which is no evidence against the law"
            ),
            Self::UnknownEdges(_) => {
                "the data contradict the free edges where the markers end, and nothing else"
                    .to_owned()
            }
            Self::GrossErrors(noise) => format!(
                "many markers lie much closer to the field than a noise of {} mm suggests: gross errors make up this noise, and with it any \
                 law fits: leave out markers that were lost or matched wrongly, or try --robust tukey",
                decimals(noise, 4)
            ),
            Self::Force(errors) => {
                format!("a measured force is {errors:.1} standard errors off")
            }
            Self::Alike(correlation) => format!(
                "the residuals resemble those of the previous or next frame (correlation {correlation:.2}), unlike noise of \
                 single pictures"
            ),
            Self::Mistaken => "the file seems to hold a mistake".to_owned(),
        }
    }
}

/// An alternative with which the equations would fit the data better.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum Alternative {
    /// One edge moves in an unknown smooth way.
    Edge(String),
    /// One edge has another condition than the stated one.
    Condition {
        /// Its name.
        edge: String,
        /// The condition.
        condition: EdgeCondition,
    },
    /// All edges with a stated condition move in an unknown smooth way.
    Edges,
    /// A part of the specimen's edge lies elsewhere.
    MovedEdge {
        /// The part.
        part: MovedPart,
        /// The distance outside of the mesh's edge, in mm.
        outwards: f64,
    },
    /// A smooth force on the sheet, such as friction or weight.
    BodyForce,
    /// Thickness or stiffness that varies smoothly over the sheet.
    Stiffness,
    /// Another isotropic law.
    Law,
    /// A stiffness that depends on the direction.
    Direction,
    /// A volume that changes.
    Volume,
    /// A picture of another scale.
    Scale,
    /// Stiffness times thickness, by a factor.
    Factor(f64),
}

/// A part of the specimen's edge that may lie elsewhere than that of the mesh.
#[derive(Clone, Debug, Deserialize, Eq, PartialEq, Serialize)]
pub enum MovedPart {
    /// A free edge by its name.
    FreeEdge(String),
    /// All free edges together.
    FreeEdges,
    /// All edges together, free ones and grips, as where the distance of the markers from the specimen's edge is wrong.
    Outline,
}

impl MovedPart {
    fn words(&self) -> String {
        match self {
            Self::FreeEdge(name) => format!("the free edge `{name}`"),
            Self::FreeEdges => "all free edges".to_owned(),
            Self::Outline => "the whole outline, grips and free edges,".to_owned(),
        }
    }
}

impl Alternative {
    /// The alternative in words.
    pub fn words(&self) -> String {
        match self {
            Self::Edge(name) => format!("an unknown motion of `{name}`"),
            Self::Condition { edge, condition } => {
                format!("`{edge}` {}", condition_words(*condition))
            }
            Self::Edges => "an unknown motion of all edges with a stated condition".into(),
            Self::MovedEdge { part, outwards } => {
                let direction = if *outwards > 0.0 { "out" } else { "in" };
                let distance = roughly(outwards.abs());
                format!("{} about {distance} mm farther {direction}", part.words())
            }
            Self::BodyForce => "a smooth force on the sheet (friction, weight, a fixture)".into(),
            Self::Stiffness => "a thickness or stiffness that varies over the sheet".into(),
            Self::Law => "another isotropic law".into(),
            Self::Direction => "a stiffness that depends on the direction".into(),
            Self::Volume => "a change of volume".into(),
            Self::Scale => {
                "a picture of another scale (a specimen nearer to or farther from its camera)"
                    .into()
            }
            Self::Factor(factor) => {
                format!("stiffness times thickness multiplied by {factor:.3}")
            }
        }
    }
}

/// The condition that would be stated instead.
fn condition_words(condition: EdgeCondition) -> &'static str {
    match condition {
        EdgeCondition::Free => "free (--free)",
        EdgeCondition::Rigid => "as a rigid grip (--rigid)",
        EdgeCondition::Unknown => "moved in an unknown way",
        EdgeCondition::Known([Some(_), None]) => {
            "on rollers that hold ux (condition = \"known\", ux = \"0 mm\")"
        }
        EdgeCondition::Known([None, Some(_)]) => {
            "on rollers that hold uy (condition = \"known\", uy = \"0 mm\")"
        }
        EdgeCondition::Known(_) => "fixed",
    }
}

/// A positive number with one digit.
fn roughly(value: f64) -> String {
    let digits = (-value.max(1e-9).log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}

/// The effect of an alternative, tried in one linearised step.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Trial {
    /// The alternative.
    pub alternative: Alternative,
    /// Root mean square of each component of the sound markers' residuals with the alternative, with their weights, in mm: without outliers
    /// it is smaller than that of all markers.
    pub residual_rms: f64,
    /// The probability that noise alone causes so large a reduction of the misfit.
    pub probability: f64,
    /// The reduction of the misfit in units of the noise's variance, less twice the number of its parameters.
    pub gain: f64,
}

/// Where the field is farthest from the data.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Worst {
    /// The position in mm.
    pub position: [f64; 2],
    /// The mean of measured less corrected displacement of the markers around it in mm.
    pub misfit: [f64; 2],
}
