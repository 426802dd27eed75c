//! How far a model is from the finite elements with the grip at the same place, in percent.

use gelbench::mesh::Mesh;
use gelbench_mechanics::mesh::weighted_distance;
use gelbench_report::compare::area_weighted_percent;

use super::engine::{Solved, between_grips};
use super::scene::{Grip, Scene};

/// Deviation of one model from the finite elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Displacement in relative L2, in %.
    pub displacement: f64,
    /// Departure from the field that is linear between the grips, in relative L2, in %.
    pub departure: f64,
    /// Force on the grip, signed where it acts along X alone, in %.
    pub force: f64,
}

impl Deviation {
    /// Of a model on the lattice; nothing where the sheet is at rest, or the elements' field on the lattice is not known.
    pub fn of(scene: &Scene, lattice: &Mesh, model: &Solved, elements: &Solved) -> Option<Self> {
        let (computed, expected) = (&model.displacement[..], elements.on_lattice.as_deref()?);
        if scene.grip == Grip::default() || computed.len() != expected.len() {
            return None;
        }
        let areas = lattice.corner_areas();
        let grips = [Grip::default(), scene.grip];
        let linear = between_grips(lattice, [scene.size[0], scene.axis()], grips);
        let departure = weighted_distance(expected, &linear, &areas);
        Some(Self {
            displacement: area_weighted_percent(lattice, computed, expected),
            departure: 100.0 * weighted_distance(computed, expected, &areas) / departure,
            force: force_percent(model.force, elements.force),
        })
    }
}

/// 100 (F/F₀ − 1) where both forces act along X, 100 |F − F₀|/|F₀| else.
fn force_percent([x, y]: [f64; 2], [x0, y0]: [f64; 2]) -> f64 {
    if y0.abs() < 1e-9 * x0.abs() {
        100.0 * (x / x0 - 1.0)
    } else {
        100.0 * (x - x0).hypot(y - y0) / x0.hypot(y0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_across_are_measured_as_vectors() {
        assert!((force_percent([11.0, 0.0], [10.0, 0.0]) - 10.0).abs() < 1e-12);
        assert!((force_percent([3.0, 4.5], [3.0, 4.0]) - 10.0).abs() < 1e-12);
    }
}
