//! One estimate compared with the truth.

use super::truth::{Markers, Truth};
use crate::estimation::FieldEstimate;
use crate::markers::Marker;
use crate::mesh::Mesh;
use crate::validation::case::Squares;

/// Markers of one kind, and how many of them were taken for gross errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Flagged {
    /// Taken for gross errors.
    pub flagged: usize,
    /// All of the kind.
    pub count: usize,
}

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
    /// Markers with a gross error.
    pub wrong: Flagged,
    /// Markers without one.
    pub sound: Flagged,
}

/// Corners are singular: nothing is compared within a fifth of the width.
const AWAY: f64 = 0.2;

impl Trial {
    /// Compares an estimate on `mesh` with the truth.
    pub fn new(truth: &Truth, mesh: &Mesh, data: &Markers, field: &FieldEstimate) -> Self {
        let mut trial = Self {
            noise: field.noise,
            differences: differences(truth, data),
            displacement_cover: displacement_cover(truth, mesh, field),
            ..Self::default()
        };
        trial.compare_markers(truth, mesh, data, field);
        trial.compare_stress(truth, mesh, field);
        trial
    }

    /// The fall of the displacement's deviation in %.
    pub fn reduction(&self) -> f64 {
        100.0 * (1.0 - self.after / self.before)
    }

    fn compare_markers(
        &mut self,
        truth: &Truth,
        mesh: &Mesh,
        data: &Markers,
        field: &FieldEstimate,
    ) {
        let (mut before, mut after) = (0.0, 0.0);
        let markers = data.markers.iter().zip(&data.wrong).zip(&field.markers);
        for ((marker, wrong), estimate) in markers {
            let exact = truth.displacement(marker.position);
            let there = mesh.displacement_at(&field.displacement, marker.position);
            for axis in [0, 1] {
                before += (marker.displacement[axis] - exact[axis]).powi(2);
                after += (there[axis] - exact[axis]).powi(2);
            }
            let kind = if *wrong {
                &mut self.wrong
            } else {
                &mut self.sound
            };
            kind.flagged += usize::from(estimate.is_some_and(|estimate| estimate.outlier));
            kind.count += 1;
        }
        let count = 2.0 * data.markers.len() as f64;
        (self.before, self.after) = ((before / count).sqrt(), (after / count).sqrt());
    }

    fn compare_stress(&mut self, truth: &Truth, mesh: &Mesh, field: &FieldEstimate) {
        let (mut squares, mut covered, mut count) = (Squares::default(), 0.0, 0.0);
        for (cell, estimate) in field.cells.iter().enumerate() {
            let centre = mesh.position(cell, mesh.shape(cell).centre());
            let Some(exact) = truth.stress(centre).filter(|_| is_away(truth, centre)) else {
                continue;
            };
            let (_, size) = mesh.gradients(cell, mesh.shape(cell).centre());
            let stress = &estimate.first_piola_kirchhoff_stress;
            squares.add(size, stress, &exact);
            for ((exact, stress), error) in exact.iter().zip(stress).zip(&estimate.stress_error) {
                let is_inside = (exact - stress).abs() <= field.reach * error;
                covered += f64::from(u8::from(is_inside));
                count += 1.0;
            }
        }
        self.stress = 100.0 * squares.relative();
        self.stress_cover = 100.0 * covered / count;
    }
}

fn displacement_cover(truth: &Truth, mesh: &Mesh, field: &FieldEstimate) -> f64 {
    let exact = mesh.nodes.iter().flat_map(|node| truth.displacement(*node));
    let field_values = field.displacement.iter().zip(&field.displacement_error);
    let covered = exact
        .zip(field_values)
        .filter(|(exact, (u, error))| (exact - *u).abs() <= field.reach * **error);
    100.0 * covered.count() as f64 / field.displacement.len() as f64
}

/// Whether a place is farther than a fifth of the width from all corners.
pub fn is_away(truth: &Truth, position: [f64; 2]) -> bool {
    let [low, high] = truth.mesh.bounding_box();
    let far = AWAY * (high[1] - low[1]);
    let x = [low[0], high[0]].into_iter();
    let mut corners = x.flat_map(|x| [[x, low[1]], [x, high[1]]]);
    corners.all(|[x, y]| (position[0] - x).hypot(position[1] - y) > far)
}

/// Deviation in % of the stress from mean differences of four neighbouring markers, in the middle between them; where these
/// turn a square inside out the stress is all wrong and counts as nothing.
fn differences(truth: &Truth, data: &Markers) -> f64 {
    let mut squares = Squares::default();
    for first in &data.markers {
        let Some(square) = Square::at(first, &data.markers) else {
            continue;
        };
        let centre = square.centre();
        if truth.mesh.outside(centre) > 1e-6 || !is_away(truth, centre) {
            continue;
        }
        let Some(exact) = truth.stress(centre) else {
            continue;
        };
        let raw = truth.stress_of(square.gradient()).unwrap_or([0.0; 4]);
        squares.add(1.0, &raw, &exact);
    }
    100.0 * squares.relative()
}

/// Four neighbouring markers: lower left and right, upper left and right.
struct Square<'a> {
    corners: [&'a Marker; 4],
}

impl<'a> Square<'a> {
    /// The one whose lower left corner a marker is.
    fn at(first: &'a Marker, markers: &'a [Marker]) -> Option<Self> {
        let next = |axis: usize, position: [f64; 2]| {
            let other = 1 - axis;
            let row = markers
                .iter()
                .filter(|marker| (marker.position[other] - position[other]).abs() < 1e-6);
            let farther = row.filter(|marker| marker.position[axis] > position[axis] + 1e-6);
            farther.min_by(|a, b| a.position[axis].total_cmp(&b.position[axis]))
        };
        let (right, above) = (next(0, first.position)?, next(1, first.position)?);
        let last = next(1, right.position)?;
        let is_square = (last.position[1] - above.position[1]).abs() < 1e-6;
        is_square.then_some(Self {
            corners: [first, right, above, last],
        })
    }

    fn size(&self) -> [f64; 2] {
        let [first, right, above, _] = self.corners.map(|marker| marker.position);
        [right[0] - first[0], above[1] - first[1]]
    }

    fn centre(&self) -> [f64; 2] {
        let (position, size) = (self.corners[0].position, self.size());
        [0, 1].map(|axis| position[axis] + 0.5 * size[axis])
    }

    /// Displacement gradient, components 11, 12, 21, 22.
    fn gradient(&self) -> [f64; 4] {
        let size = self.size();
        std::array::from_fn(|index| {
            let [a, b, c, d] = self.corners.map(|marker| marker.displacement[index / 2]);
            match index % 2 {
                0 => (b - a + d - c) / (2.0 * size[0]),
                _ => (c - a + d - b) / (2.0 * size[1]),
            }
        })
    }
}
