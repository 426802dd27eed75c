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
                        "subset {} and step {} pixels according to {}",
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
            Self::Given(gap) if *gap > 0.0 => format!(", widened by {gap} mm"),
            Self::Subset { half, words, .. } => {
                format!(", widened by {half:.4} mm, half a subset ({words})")
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
                    "the specimen's edge is assumed to lie {half:.4} mm outside the outermost markers, half a subset: {words}"
                ),
                format!(
                    "state the edge with --edge-gap LENGTH, --outline or --mesh; subsets end inside the specimen, less than one step from its edge, so force \
                     intervals between free edges, and stress errors beside them, include an edge up to {step:.4} mm farther out; without free edges, forces \
                     are those through the outline"
                ),
            ),
            Self::Unknown(_) => (
                "the specimen's edge is not known: the outline is that of the markers, which usually end inside the edge".to_owned(),
                "state the edge with --edge-gap LENGTH (\"0 mm\" where markers lie on it), --outline or --mesh; forces grow with the width, so force \
                 intervals between free edges, and stress errors beside them, include an edge up to one marker spacing farther out; without free \
                 edges, forces are those through the outline"
                    .to_owned(),
            ),
        };
        Some(Diagnostic::warning("", message).hint(hint))
    }
}
