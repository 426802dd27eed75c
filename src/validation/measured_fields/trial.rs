//! One estimate beside the truth.

use super::truth::{Markers, Truth};
use crate::corrector::estimation::FieldEstimate;
use crate::mesh::Mesh;

/// What one seed comes to. Deviations are root mean squares.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trial {
    /// Deviation of the markers' displacements in mm.
    pub before: f64,
    /// Deviation of the field at the markers in mm.
    pub after: f64,
    /// Deviation of the stress away from the corners, in % of the stress.
    pub stress: f64,
    /// The same from differences of neighbouring markers.
    pub differences: f64,
    /// Share of the displacements of nodes within their intervals, in %.
    pub displacement_cover: f64,
    /// Share of the stresses away from the corners within their intervals, in %.
    pub stress_cover: f64,
    /// Estimated noise in mm.
    pub noise: f64,
    /// Gross errors that were found, and all of them.
    pub hits: [usize; 2],
    /// Sound markers that were taken for gross errors, and all of them.
    pub alarms: [usize; 2],
}

/// Corners are singular: nothing is compared within a fifth of the width.
const AWAY: f64 = 0.2;

impl Trial {
    /// Compares an estimate on `mesh` with the truth.
    pub fn new(truth: &Truth, mesh: &Mesh, data: &Markers, found: &FieldEstimate) -> Self {
        let mut trial = Self {
            noise: found.noise,
            ..Self::default()
        };
        trial.compare_markers(truth, mesh, data, found);
        trial.compare_nodes(truth, mesh, found);
        trial.compare_stress(truth, mesh, found);
        trial.differences = differences(truth, data);
        trial
    }

    /// The fall of the displacement's deviation in %.
    pub fn fall(&self) -> f64 {
        100.0 * (1.0 - self.after / self.before)
    }

    fn compare_markers(
        &mut self,
        truth: &Truth,
        mesh: &Mesh,
        data: &Markers,
        found: &FieldEstimate,
    ) {
        let (mut before, mut after) = (0.0, 0.0);
        for ((marker, wrong), estimate) in data.markers.iter().zip(&data.wrong).zip(&found.markers)
        {
            let exact = truth.displacement(marker.place);
            let there = mesh.displacement_at(&found.displacement, marker.place);
            for axis in [0, 1] {
                before += (marker.displacement[axis] - exact[axis]).powi(2);
                after += (there[axis] - exact[axis]).powi(2);
            }
            let flagged = usize::from(estimate.is_some_and(|estimate| estimate.outlier));
            let count = if *wrong {
                &mut self.hits
            } else {
                &mut self.alarms
            };
            *count = [count[0] + flagged, count[1] + 1];
        }
        let count = 2.0 * data.markers.len() as f64;
        (self.before, self.after) = ((before / count).sqrt(), (after / count).sqrt());
    }

    fn compare_nodes(&mut self, truth: &Truth, mesh: &Mesh, found: &FieldEstimate) {
        let exact = mesh.nodes.iter().flat_map(|node| truth.displacement(*node));
        let pairs = exact
            .zip(&found.displacement)
            .zip(&found.displacement_error);
        let covered =
            pairs.filter(|((exact, u), error)| (exact - *u).abs() <= found.reach * **error);
        self.displacement_cover = 100.0 * covered.count() as f64 / found.displacement.len() as f64;
    }

    fn compare_stress(&mut self, truth: &Truth, mesh: &Mesh, found: &FieldEstimate) {
        let (mut sums, mut covered, mut count) = ([0.0; 2], 0.0, 0.0);
        for (cell, estimate) in found.cells.iter().enumerate() {
            let centre = mesh.place(cell, mesh.shape(cell).centre());
            let Some(exact) = truth.stress(centre).filter(|_| is_away(truth, centre)) else {
                continue;
            };
            let (_, size) = mesh.gradients(cell, mesh.shape(cell).centre());
            let stress = estimate.first_piola_kirchhoff_stress.iter();
            let estimates = stress.zip(&estimate.stress_error);
            for (exact, (stress, error)) in exact.iter().zip(estimates) {
                let wrong = exact - stress;
                sums[0] += size * wrong.powi(2);
                sums[1] += size * exact.powi(2);
                let inside = wrong.abs() <= found.reach * error;
                covered += f64::from(u8::from(inside));
                count += 1.0;
            }
        }
        self.stress = 100.0 * (sums[0] / sums[1]).sqrt();
        self.stress_cover = 100.0 * covered / count;
    }
}

fn is_away(truth: &Truth, place: [f64; 2]) -> bool {
    let [low, high] = truth.mesh.bounding_box();
    let far = AWAY * (high[1] - low[1]);
    let corners = [low[0], high[0]]
        .into_iter()
        .flat_map(|x| [[x, low[1]], [x, high[1]]]);
    corners
        .into_iter()
        .all(|[x, y]| (place[0] - x).hypot(place[1] - y) > far)
}

/// Deviation in % of the stress from mean differences of four neighbouring markers, in the middle between them; where these
/// turn a square inside out the stress is all wrong and counts as nothing.
fn differences(truth: &Truth, data: &Markers) -> f64 {
    let markers = &data.markers;
    let next = |axis: usize, place: [f64; 2]| {
        let other = 1 - axis;
        let row = markers
            .iter()
            .filter(|marker| (marker.place[other] - place[other]).abs() < 1e-6);
        let beyond = row.filter(|marker| marker.place[axis] > place[axis] + 1e-6);
        beyond.min_by(|a, b| a.place[axis].total_cmp(&b.place[axis]))
    };
    let mut sums = [0.0; 2];
    for a in markers {
        let corners = next(0, a.place).zip(next(1, a.place));
        let Some((b, c)) = corners else { continue };
        let fourth = [b.place[0], c.place[1]];
        let Some(d) = next(1, b.place).filter(|d| (d.place[1] - fourth[1]).abs() < 1e-6) else {
            continue;
        };
        let size = [b.place[0] - a.place[0], c.place[1] - a.place[1]];
        let centre = [0, 1].map(|axis| a.place[axis] + 0.5 * size[axis]);
        if truth.mesh.outside(centre) > 1e-6 || !is_away(truth, centre) {
            continue;
        }
        let gradient = std::array::from_fn(|index| {
            let [a, b, c, d] = [a, b, c, d].map(|marker| marker.displacement[index / 2]);
            match index % 2 {
                0 => (b - a + d - c) / (2.0 * size[0]),
                _ => (c - a + d - b) / (2.0 * size[1]),
            }
        });
        let Some(exact) = truth.stress(centre) else {
            continue;
        };
        let raw = truth.stress_of(gradient).unwrap_or([0.0; 4]);
        for (exact, raw) in exact.iter().zip(raw) {
            sums[0] += (exact - raw).powi(2);
            sums[1] += exact.powi(2);
        }
    }
    100.0 * (sums[0] / sums[1]).sqrt()
}
