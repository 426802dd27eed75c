//! Mistakes in how a field was written, each tried by undoing it: the field that was meant is far nearer to an equilibrium.
//!
//! ```text
//! AIC = 2 n ln r + 2 p        r of n values, p parameters: by less than this the markers would not choose
//! ```
//!
//! Only fields whose misfit is more than their noise, or in which no edge is free where the data may choose, are tried, in the one frame
//! that moves most: a mistake is that of a file.

use nalgebra::Matrix2;
use rayon::prelude::*;

use super::MarkerStudy;
use super::quantities::{residual_rms, used};
use crate::error::Diagnostic;
use crate::estimation::{EdgeCondition, FieldEstimate};
use crate::markers::{Frame, Marker};
use crate::units::decimals;

/// What a field was written as, instead of displacements along x and y from rest to the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mistake {
    /// Positions in the frame.
    FinalPositions,
    /// Displacements from the frame to rest.
    Reversed,
    /// Displacements along y and x.
    Exchanged,
    /// Displacements against one of the axes.
    Mirrored(usize),
}

/// How much smaller Akaike's criterion is where a mistake is named: one of e¹⁵ fields is named by chance.
const SURE: f64 = 30.0;

/// How much nearer to the markers a field must be that is not explained either.
const NEARER: f64 = 3.0;

/// The share of the residuals' variance that correlates, from which on a misfit may be that of a mistake.
const MUCH: f64 = 0.5;

/// Principal stretches of specimens, on the mean.
const STRETCHES: std::ops::Range<f64> = 0.2..5.0;

impl Mistake {
    const ALL: [Self; 5] = [
        Self::FinalPositions,
        Self::Reversed,
        Self::Exchanged,
        Self::Mirrored(0),
        Self::Mirrored(1),
    ];

    /// The displacement that was meant.
    fn undone(self, marker: Marker) -> Marker {
        let ([x, y], [ux, uy]) = (marker.place, marker.displacement);
        let displacement = match self {
            Self::FinalPositions => [ux - x, uy - y],
            Self::Reversed => [-ux, -uy],
            Self::Exchanged => [uy, ux],
            Self::Mirrored(0) => [-ux, uy],
            Self::Mirrored(_) => [ux, -uy],
        };
        Marker {
            displacement,
            ..marker
        }
    }

    /// Whether a specimen may be strained as the undone field is on the mean: nothing that is pulled only shears, and what is
    /// pulled narrows.
    fn may_be(self, written: &Matrix2<f64>, undone: &Matrix2<f64>) -> bool {
        let deformation = Matrix2::identity() + undone;
        let stretches = deformation.singular_values();
        let is_sound = deformation.determinant() > 0.0
            && stretches.iter().all(|stretch| STRETCHES.contains(stretch));
        let straight = |h: &Matrix2<f64>| h.m11.abs().max(h.m22.abs());
        is_sound
            && match self {
                Self::FinalPositions | Self::Reversed => true,
                Self::Exchanged => straight(undone) > straight(written),
                Self::Mirrored(_) => undone.m11 * undone.m22 < 0.0,
            }
    }

    /// What the field seems to be, and what to do.
    fn words(self) -> (String, &'static str) {
        match self {
            Self::FinalPositions => (
                "final positions instead of displacements".to_owned(),
                "subtract the positions at rest: ux = x in the frame − x at rest",
            ),
            Self::Reversed => (
                "displacements with reversed sign".to_owned(),
                "reverse the sign of both columns: displacements lead from rest to the frame",
            ),
            Self::Exchanged => (
                "displacements with x and y exchanged".to_owned(),
                "exchange the two columns",
            ),
            Self::Mirrored(axis) => (
                format!("mirrored along {}", ["x", "y"][axis]),
                "reverse the sign of that column: positions and displacements share their axes",
            ),
        }
    }
}

impl MarkerStudy {
    /// The mistake that a file seems to hold, if there is one.
    pub(super) fn likely_mistake(&self, estimates: &[FieldEstimate]) -> Option<Diagnostic> {
        let frames = self.frames_with(estimates);
        let doubtful = frames.filter(|(_, estimate)| may_be_mistaken(estimate));
        let (frame, estimate) =
            doubtful.max_by(|(a, _), (b, _)| a.motion().total_cmp(&b.motion()))?;
        let (mistake, meant) = self.likeliest(frame, Some(estimate))?;
        let (seems, hint) = mistake.words();
        let message = format!(
            "frame {}: the field seems to be {seems}: with this undone it leaves a residual of {} mm with {:.1} parameters, instead of {} mm with {:.1}",
            frame.number,
            decimals(residual_rms(&meant), 4),
            meant.effective_parameters,
            decimals(residual_rms(estimate), 4),
            estimate.effective_parameters,
        );
        Some(Diagnostic::warning("", message).hint(hint))
    }

    /// The mistake that a frame without an estimate seems to hold.
    pub(super) fn mistake_without_solution(&self, frame: &Frame) -> Option<Diagnostic> {
        let (mistake, _) = self.likeliest(frame, None)?;
        let (seems, hint) = mistake.words();
        let message = format!("the field has no solution, but seems to be {seems}");
        Some(Diagnostic::error("", message).hint(hint))
    }

    /// The mistake that explains the most, and the estimate of the field that was meant.
    fn likeliest(
        &self,
        frame: &Frame,
        written: Option<&FieldEstimate>,
    ) -> Option<(Mistake, FieldEstimate)> {
        if self.coarse.is_some() {
            return None;
        }
        let gradient = frame.mean_gradient()?;
        let tried = Mistake::ALL.into_par_iter().filter_map(|mistake| {
            let markers = frame.markers.iter().map(|marker| mistake.undone(*marker));
            let meant = Frame {
                markers: markers.collect(),
                ..frame.clone()
            };
            let may_be = mistake.may_be(&gradient, &meant.mean_gradient()?);
            let estimate = may_be.then(|| self.estimate_frame(&meant).ok()).flatten()?;
            is_nearer(&estimate, written).then_some((mistake, estimate))
        });
        let tried: Vec<_> = tried.collect();
        let least = |(_, a): &(_, _), (_, b): &(_, _)| criterion(a).total_cmp(&criterion(b));
        tried.into_iter().min_by(least)
    }
}

/// Whether the misfit of a field is more than its noise, or none of its edges is free where the data may choose.
fn may_be_mistaken(estimate: &FieldEstimate) -> bool {
    let correlation = estimate.verdict.correlation;
    let is_far = correlation.is_some_and(|correlation| correlation.share > MUCH);
    !has_free_edge(estimate) || (!estimate.is_explained() && is_far)
}

/// Whether a field is explained, with a free edge where the data may choose.
fn is_natural(estimate: &FieldEstimate) -> bool {
    estimate.is_explained() && has_free_edge(estimate)
}

/// Whether one of the edges is free where the data may choose; true where they may not.
fn has_free_edge(estimate: &FieldEstimate) -> bool {
    let mut chosen = estimate
        .edges
        .iter()
        .filter(|edge| edge.probability.is_some())
        .map(|edge| edge.condition == EdgeCondition::Free)
        .peekable();
    chosen.peek().is_none() || chosen.any(|is_free| is_free)
}

/// Whether the field that may have been meant is far more probable than the one that was written.
fn is_nearer(meant: &FieldEstimate, written: Option<&FieldEstimate>) -> bool {
    let Some(written) = written else {
        return is_natural(meant);
    };
    let nearer = NEARER * residual_rms(meant) < residual_rms(written);
    criterion(written) - criterion(meant) > SURE && (nearer || is_natural(meant))
}

/// Akaike's criterion.
fn criterion(estimate: &FieldEstimate) -> f64 {
    let values = 2.0 * used(estimate) as f64;
    2.0 * values * residual_rms(estimate).ln() + 2.0 * estimate.effective_parameters
}
