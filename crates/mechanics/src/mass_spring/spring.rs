//! A spring, at rest and deformed.

use std::collections::BTreeMap;

use crate::material::law::TensionResponse;

/// One spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// The nodes at its ends.
    pub nodes: [usize; 2],
    /// Rest length x₀ in mm.
    pub rest_length: f64,
    /// Cross-section a in mm².
    pub area: f64,
    /// The number of its law among those of the lattice.
    pub law: u8,
}

/// Springs between nodes, with the sums of the cross-sections in mm² from the adjacent cells of one law: between cells of two laws there are
/// two springs side by side.
#[derive(Default)]
pub(super) struct CrossSections(BTreeMap<([usize; 2], u8), f64>);

impl CrossSections {
    /// Adds a cross-section of a law between two nodes.
    pub fn add(&mut self, [a, b]: [usize; 2], law: u8, area: f64) {
        *self.0.entry(([a.min(b), a.max(b)], law)).or_insert(0.0) += area;
    }

    /// The springs between nodes at these positions.
    pub fn springs(self, positions: &[[f64; 2]]) -> Vec<Spring> {
        let spring = |((nodes, law), area): (([usize; 2], u8), f64)| {
            let [from, to] = nodes.map(|node| positions[node]);
            Spring {
                nodes,
                rest_length: (to[0] - from[0]).hypot(to[1] - from[1]),
                area,
                law,
            }
        };
        self.0.into_iter().map(spring).collect()
    }
}

/// A spring in a deformed lattice, with the data for its forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringPose {
    /// λ = |x|/x₀.
    pub stretch: f64,
    /// x/|x|.
    pub unit: [f64; 2],
    /// The tension curve at λ.
    pub response: TensionResponse,
}

impl SpringPose {
    /// Adds a force in N along the spring, positive in tension, to those of its ends.
    pub fn add_force(&self, force: f64, ends: &mut [f64]) {
        let (near, far) = ends.split_at_mut(2);
        for (axis, direction) in self.unit.iter().enumerate() {
            near[axis] -= force * direction;
            far[axis] += force * direction;
        }
    }

    /// Adds stiffnesses along and across the spring in N/mm to those of its ends, row by row.
    pub fn add_stiffness(&self, [along, across]: [f64; 2], stiffness: &mut [f64]) {
        for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let identity = if i == k { 1.0 } else { 0.0 };
            let value = (along - across) * self.unit[i] * self.unit[k] + across * identity;
            stiffness[4 * i + k] += value;
            stiffness[4 * i + 2 + k] -= value;
            stiffness[4 * (2 + i) + k] -= value;
            stiffness[4 * (2 + i) + 2 + k] += value;
        }
    }
}
