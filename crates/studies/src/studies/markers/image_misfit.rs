//! The misfit of camera images about fields in equilibrium.
//!
//! ```text
//! images ─follow─▶ patches about the tracked field ─estimate─▶ field u ─▶ patches about u ─estimate─▶ … until they stay
//! ```
//!
//! These are Gauss–Newton steps of the images' misfit over fields in equilibrium: each is linear about the field before.

use rayon::prelude::*;

use super::MarkerStudy;
use crate::images::{Patches, Warp, series};
use crate::markers::{Frame, Marker};
use crate::statistics::median;
use crate::studies::images::TrackedImages;
use crate::units::decimals;

/// The largest number of fields about which a frame is measured.
const MOST: usize = 4;

/// Root mean square of the change of the patches' displacements, in pixels and in their standard deviations, below which iterations end.
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
    /// The study with the patches of all frames measured about the fields in equilibrium that are nearest to them; each frame is reported before
    /// it begins.
    ///
    /// Where the noise is so large that the search for a single patch fails, tracking may fail as well. Then each frame is also started from the
    /// field of the frame before, the first one from rest, and the field is taken about which the patches are more similar.
    pub(super) fn about_equilibrium(
        mut self,
        images: &TrackedImages,
        is_mask: bool,
        watch: &dyn Fn(&str),
    ) -> Self {
        let report = |frame: &Frame| watch(&format!("patches of frame {}", frame.number));
        if self.unknown_gap.is_none() {
            let (accuracy, words) = accuracy(images.pixel, is_mask);
            self.edge_accuracy = accuracy;
            self.mesh_origin += &words;
        }
        let misfit = ImageMisfit {
            images,
            patches: images.tracker.patches(),
            are_precise: images.tracker.patches().are_precise(),
            study: &self,
        };
        let measured: Vec<Option<Measured>> = if misfit.are_precise {
            let together = self.series.frames.chunks(4 * rayon::current_num_threads());
            let measured = |frames: &[Frame]| -> Vec<Option<Measured>> {
                frames.iter().for_each(report);
                let frames = frames.par_iter();
                frames.map(|frame| misfit.about_tracked(frame)).collect()
            };
            together.flat_map(measured).collect()
        } else {
            misfit.in_turn(&report)
        };
        for (frame, measured) in self.series.frames.iter_mut().zip(measured) {
            if let Some(measured) = measured {
                frame.markers = measured.markers;
            }
        }
        self.mistaken_images = images.contradiction(&self.series);
        self
    }
}

/// The accuracy of an edge that is traced in an image, in pixels: that of a mask by its pixels, that of lines by the eye of who draws them.
const OF_MASK: f64 = 0.5;
const OF_LINES: f64 = 0.25;

/// The accuracy of the edge of a mask or of lines in mm, and this in words.
fn accuracy(pixel: f64, is_mask: bool) -> (f64, String) {
    let (share, words) = if is_mask {
        (OF_MASK, "half")
    } else {
        (OF_LINES, "a quarter of")
    };
    let accuracy = share * pixel;
    let words = format!(
        ", taken to be right to {} mm, {words} a pixel",
        decimals(accuracy, 4)
    );
    (accuracy, words)
}

/// The images of a study, and the patches of the first one.
struct ImageMisfit<'a> {
    images: &'a TrackedImages,
    patches: Patches<'a>,
    /// Whether the noise is so small that most patches can be searched for one by one.
    are_precise: bool,
    study: &'a MarkerStudy,
}

impl ImageMisfit<'_> {
    /// Frame after frame, each also started from the field of the one before.
    fn in_turn(&self, report: &dyn Fn(&Frame)) -> Vec<Option<Measured>> {
        let mut before = vec![0.0; 2 * self.study.mesh.nodes.len()];
        let frames = self.study.series.frames.iter().map(|frame| {
            report(frame);
            let from_before = self.settled(frame, before.clone());
            let both = from_before.into_iter().chain(self.about_tracked(frame));
            let best = both.max_by(|a, b| a.similarity.total_cmp(&b.similarity))?;
            before.clone_from(&best.displacement);
            Some(best)
        });
        frames.collect()
    }

    fn about_tracked(&self, frame: &Frame) -> Option<Measured> {
        let start = self.nearest_displacement(frame)?;
        self.settled(frame, start)
    }

    /// The nodal displacements of the field nearest to a frame. Patches that are searched for one by one need no more of it than its gradient, for
    /// which it does not matter whether edges are free.
    fn nearest_displacement(&self, frame: &Frame) -> Option<Vec<f64>> {
        let may_free_edges = !self.are_precise;
        self.study.nearest_displacement(frame, may_free_edges).ok()
    }

    /// The patches about a field, about the field that is nearest to these, and so on until they stay.
    fn settled(&self, frame: &Frame, mut displacement: Vec<f64>) -> Option<Measured> {
        let image = self.images.file(frame.number)?.read().ok()?;
        let (spline, pixel) = (self.patches.spline(&image), self.images.pixel);
        let (mut frame, mut similarity) = (frame.clone(), 0.0);
        for _ in 0..MOST {
            let warp = |point: usize| self.warp(&displacement, point);
            let measured = self.patches.measure(&spline, &warp);
            similarity = median(measured.iter().flatten().map(|patch| patch.similarity));
            let all = series(&[(frame.number, measured)], image.size()[1], pixel);
            let markers = all.frames.into_iter().next()?.markers;
            let is_last = is_unchanged(&frame.markers, &markers, pixel);
            frame.markers = markers;
            if is_last {
                break;
            }
            displacement = self.nearest_displacement(&frame)?;
        }
        Some(Measured {
            markers: frame.markers,
            displacement,
            similarity,
        })
    }

    /// A field of nodal displacements about a point of the grid, in pixels and y down.
    fn warp(&self, displacement: &[f64], point: usize) -> Option<Warp> {
        let TrackedImages { tracker, pixel, .. } = self.images;
        let up = tracker.reference().image.size()[1] as f64 - 1.0;
        let [x, y] = tracker.positions()[point].map(|pixel| pixel as f64);
        let half = 0.5 * self.patches.width() as f64;
        let at =
            |along: f64, down: f64| [(x + half * along) * pixel, (up - y - half * down) * pixel];
        let mesh = &self.study.mesh;
        (mesh.outside(at(0.0, 0.0)) <= OUTSIDE).then(|| {
            Warp::sampled(half, |along, down| {
                let [u, v] = mesh.displacement_at(displacement, at(along, down));
                [u / pixel, -v / pixel]
            })
        })
    }
}

/// Whether the displacements of a frame's patches have not changed since they were last measured.
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
