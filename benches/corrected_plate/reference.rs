//! The converged field: a climb on a grid graded towards the corners, where the field is singular.

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::climb::{Climb, ClimbSettings};
use gelbench::error::Error;
use gelbench::problem::ClampedPlate;
use gelbench_corrector::corrector::climb::{Field, Grid};

/// The published converged force at 100 % in N, with five digits after the point: Richardson's extrapolation of
/// finite elements by dolfinx and scikit-fem.
pub const PUBLISHED_FORCE: f64 = 52.16485;

/// Elements along X of the reference and of the one that it is compared with; half as many along Y.
const ELEMENTS: [usize; 2] = [480, 240];

/// A field that all others are measured against.
pub struct Reference {
    grid: Grid,
    field: Field,
    stretch: f64,
    /// Force on the moving grip in N.
    pub force: f64,
    /// Departure of half as many elements from this one in percent: more than this one's own error.
    pub error_percent: f64,
}

impl Reference {
    pub fn new(problem: &ClampedPlate, stretch: f64) -> Result<Self, Error> {
        let [fine, coarse] = ELEMENTS.map(|elements| Self::on(problem, stretch, elements));
        let (mut fine, coarse) = (fine?, coarse?);
        fine.error_percent = fine.departure_percent(&coarse.grid, &coarse.field);
        Ok(fine)
    }

    fn on(problem: &ClampedPlate, stretch: f64, elements: usize) -> Result<Self, Error> {
        let boundaries = Grid::graded(problem.size, [elements, elements / 2], 2.0).coordinates;
        let tight = ClimbSettings {
            tolerance: 0.01,
            max_iterations: 100,
        };
        let mut climb = Climb::new(problem, boundaries, DifferenceScheme::Biquadratic, tight);
        let climbed = climb.correct(stretch)?;
        Ok(Self {
            grid: climb.grid().clone(),
            force: climbed.force,
            field: climbed.field,
            stretch,
            error_percent: f64::NAN,
        })
    }

    /// 100 √(Σ A |u − v|² / Σ A |v − a|²) over the nodes of a grid with their areas A; v is this field, a the affine
    /// stretch.
    pub fn departure_percent(&self, grid: &Grid, field: &Field) -> f64 {
        let expected = self.field.onto(&self.grid, grid);
        relative_percent(grid, field, &expected, self.stretch)
    }

    /// Deviation of the force in percent, without sign.
    pub fn force_percent(&self, force: f64) -> f64 {
        100.0 * (force / self.force - 1.0).abs()
    }
}

/// The distance of two fields relative to the departure of the second one from the affine stretch in percent.
pub fn relative_percent(grid: &Grid, field: &Field, expected: &Field, stretch: f64) -> f64 {
    let [along, across] = grid.coordinates.each_ref().map(|nodes| lengths(nodes));
    let (mut distance, mut departure) = (0.0, 0.0);
    for (line, (x, length)) in grid.coordinates[0].iter().zip(&along).enumerate() {
        for (node, width) in across.iter().enumerate() {
            let position = line * across.len() + node;
            for (axis, affine) in [stretch * x, 0.0].into_iter().enumerate() {
                let [u, v] = [field, expected].map(|field| field.components[axis][position]);
                distance += length * width * (u - v).powi(2);
                departure += length * width * (v - affine).powi(2);
            }
        }
    }
    100.0 * (distance / departure).sqrt()
}

/// The length that belongs to each node.
fn lengths(nodes: &[f64]) -> Vec<f64> {
    let last = nodes.len() - 1;
    let half = |node: usize| 0.5 * (nodes[(node + 1).min(last)] - nodes[node.saturating_sub(1)]);
    (0..=last).map(half).collect()
}
