//! Where a specimen's edge lies outside of its outermost markers.

use super::request::Request;
use crate::error::Diagnostic;
use crate::markers::Understood;
use crate::mesh::{Outline, OutlineFault};

/// What is known of the edge.
pub(super) enum EdgePlace {
    /// So far outside, as the user says, in mm.
    Given(f64),
    /// At least half a subset outside, as subsets lie inside of the specimen, and less than a step farther.
    Subset {
        half: f64,
        step: f64,
        /// Both in pixels, and where they are said.
        words: String,
    },
    /// Up to a spacing of the markers outside.
    Unknown(f64),
}

impl EdgePlace {
    /// What the user says, else what files say of subsets; `spacing` is that of the markers in mm.
    pub fn of(request: &Request, understood: &Understood, spacing: f64) -> Self {
        match (request.conditions.edge_gap, &understood.subset) {
            (Some(gap), _) => Self::Given(gap),
            (None, Some(subset)) => {
                let pixel = understood.pixel.unwrap_or(spacing / subset.step);
                Self::Subset {
                    half: 0.5 * subset.size * pixel,
                    step: subset.step * pixel,
                    words: format!(
                        "subset {} and step {} pixels by {}",
                        subset.size, subset.step, subset.told_by
                    ),
                }
            }
            (None, None) => Self::Unknown(spacing),
        }
    }

    /// The outline of the markers brought to the edge, and what is known of it then: where half a subset does not fit, nothing.
    ///
    /// # Errors
    /// An [`OutlineFault`] of a gap that the user gives.
    pub fn outline(self, markers: Outline, spacing: f64) -> Result<(Outline, Self), OutlineFault> {
        match self {
            Self::Given(gap) => Ok((markers.widened(gap)?, self)),
            Self::Subset { half, .. } => Ok(match markers.widened(half) {
                Ok(wider) => (wider, self),
                Err(_) => (markers, Self::Unknown(spacing)),
            }),
            Self::Unknown(_) => Ok((markers, self)),
        }
    }

    /// How far outside of the outline the edge may lie all the same, in mm.
    pub fn unknown(&self) -> Option<f64> {
        match self {
            Self::Given(_) => None,
            Self::Subset { step, .. } => Some(*step),
            Self::Unknown(spacing) => Some(*spacing),
        }
    }

    /// How a mesh's origin says it.
    pub fn origin(&self) -> String {
        match self {
            Self::Given(gap) if *gap > 0.0 => format!(", {gap} mm farther out"),
            Self::Subset { half, words, .. } => {
                format!(", {half:.4} mm farther out: half a subset ({words})")
            }
            _ => String::new(),
        }
    }

    /// What the user should know of it.
    pub fn warning(&self) -> Option<Diagnostic> {
        let (message, hint) = match self {
            Self::Given(_) => return None,
            Self::Subset { half, step, words } => (
                format!(
                    "the specimen's edge is taken to lie {half:.4} mm outside of the outermost markers, half a subset: {words}"
                ),
                format!(
                    "subsets lie inside of the specimen, and less than a step was left: between free edges, intervals of forces hold an edge up to \
                     {step:.4} mm farther out, else they are forces through the outline, and errors of stress beside free edges hold it too; say where the edge is with \
                     --edge-gap LENGTH, --outline or --mesh"
                ),
            ),
            Self::Unknown(_) => (
                "the specimen's edge is not known: the outline is that of the markers, which usually end inside of it".to_owned(),
                "forces grow with the width: between free edges their intervals hold an edge up to a spacing farther out, else they are \
                 forces through the outline, and errors of stress beside free edges hold it too; say where the edge is with --edge-gap LENGTH \
                 (\"0 mm\" where markers lie on it), --outline or --mesh"
                    .to_owned(),
            ),
        };
        Some(Diagnostic::warning("", message).hint(hint))
    }
}
