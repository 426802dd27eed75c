//! The misfit of camera images about fields in equilibrium.
//!
//! ```text
//! images ─follow─▶ patches about the tracked field ─estimate─▶ field u ─▶ patches about u ─estimate─▶ … until they stay
//! ```
//!
//! These are Gauss–Newton steps of the images' misfit over fields in equilibrium: each is linear about the field before.

use rayon::prelude::*;

use super::MarkerStudy;
use crate::images::{Warp, series};
use crate::markers::{Frame, Marker};
use crate::statistics::median;
use crate::studies::images::TrackedImages;

/// The most fields about which a frame is measured.
const MOST: usize = 4;

/// Root mean square of the change of the patches' displacements in pixels, and in their standard deviations, that counts as none.
const UNCHANGED: f64 = 0.01;
const UNCHANGED_DEVIATIONS: f64 = 0.1;

/// How far outside of the mesh a patch may lie, in cells.
const OUTSIDE: f64 = 0.5;

/// A frame's patches about a field in equilibrium, and this field.
struct Measured {
    markers: Vec<Marker>,
    displacement: Vec<f64>,
    /// The median of the patches' similarity.
    similarity: f64,
}

impl MarkerStudy {
    /// With the patches of all frames measured about the fields in equilibrium that are nearest to them, where there are images.
    ///
    /// Where noise is so large that a patch alone does not lead to its displacement, neither may tracking: then each frame also starts from the
    /// field of the frame before, the first one from rest, and the field counts about which the patches are the more similar.
    pub(super) fn about_equilibrium(mut self, images: Option<TrackedImages>) -> Self {
        let Some(images) = images else {
            return self;
        };
        let frames = self.series.frames.par_iter();
        let measured: Vec<Option<Measured>> = if images.tracker.patches().are_precise() {
            frames
                .map(|frame| images.about_tracked(&self, frame))
                .collect()
        } else {
            images.in_turn(&self)
        };
        for (frame, measured) in self.series.frames.iter_mut().zip(measured) {
            if let Some(measured) = measured {
                frame.markers = measured.markers;
            }
        }
        self
    }
}

impl TrackedImages {
    fn in_turn(&self, study: &MarkerStudy) -> Vec<Option<Measured>> {
        let mut before = vec![0.0; 2 * study.mesh.nodes.len()];
        let frames = study.series.frames.iter().map(|frame| {
            let starts = [
                self.settled(study, frame, before.clone()),
                self.about_tracked(study, frame),
            ];
            let starts = starts.into_iter().flatten();
            let best = starts.max_by(|a, b| a.similarity.total_cmp(&b.similarity))?;
            before.clone_from(&best.displacement);
            Some(best)
        });
        frames.collect()
    }

    fn about_tracked(&self, study: &MarkerStudy, frame: &Frame) -> Option<Measured> {
        let start = study.estimate_frame(frame).ok()?;
        self.settled(study, frame, start.displacement)
    }

    /// The patches about a field, about the field that is nearest to these, and so on until they stay.
    fn settled(
        &self,
        study: &MarkerStudy,
        frame: &Frame,
        mut displacement: Vec<f64>,
    ) -> Option<Measured> {
        let mut files = self.files.1.iter();
        let (_, file) = files.find(|(number, _)| *number == frame.number)?;
        let image = file.read().ok()?;
        let patches = self.tracker.patches();
        let (mut frame, mut similarity) = (frame.clone(), 0.0);
        for _ in 0..MOST {
            let warp = |point: usize| self.warp(study, &displacement, point, patches.width());
            let measured = patches.measure(&image, &warp);
            similarity = median(measured.iter().flatten().map(|patch| patch.similarity));
            let all = series(&[(frame.number, measured)], image.size()[1], self.pixel);
            let markers = all.frames.into_iter().next()?.markers;
            let is_last = is_unchanged(&frame.markers, &markers, self.pixel);
            frame.markers = markers;
            if is_last {
                break;
            }
            displacement = study.estimate_frame(&frame).ok()?.displacement;
        }
        Some(Measured {
            markers: frame.markers,
            displacement,
            similarity,
        })
    }

    /// A field of nodal displacements about a point of the grid, in pixels and y down.
    fn warp(
        &self,
        study: &MarkerStudy,
        displacement: &[f64],
        point: usize,
        width: usize,
    ) -> Option<Warp> {
        let up = self.tracker.reference().image.size()[1] as f64 - 1.0;
        let [x, y] = self.tracker.places()[point].map(|pixel| pixel as f64);
        let half = 0.5 * width as f64;
        let place = |along: f64, down: f64| {
            [
                (x + half * along) * self.pixel,
                (up - y - half * down) * self.pixel,
            ]
        };
        (study.mesh.outside(place(0.0, 0.0)) <= OUTSIDE).then(|| {
            Warp::sampled(half, |along, down| {
                let [u, v] = study.mesh.displacement_at(displacement, place(along, down));
                [u / self.pixel, -v / self.pixel]
            })
        })
    }
}

/// Whether the displacements of a frame's patches are those that were measured before, up to what counts as none.
fn is_unchanged(before: &[Marker], now: &[Marker], pixel: f64) -> bool {
    let pairs = before.iter().zip(now);
    let (mut squares, mut relative) = (0.0, 0.0);
    for (before, now) in pairs {
        let change = [0, 1].map(|axis| now.displacement[axis] - before.displacement[axis]);
        let square = change[0].powi(2) + change[1].powi(2);
        squares += square / (pixel * pixel);
        relative += square / now.standard_deviation.map_or(f64::INFINITY, |sd| sd * sd);
    }
    let count = 2.0 * now.len() as f64;
    let are_alike = |(before, now): (&Marker, &Marker)| before.number == now.number;
    before.len() == now.len()
        && before.iter().zip(now).all(are_alike)
        && (squares < count * UNCHANGED * UNCHANGED
            || relative < count * UNCHANGED_DEVIATIONS * UNCHANGED_DEVIATIONS)
}
