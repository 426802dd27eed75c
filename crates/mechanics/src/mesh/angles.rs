//! The angles of the sheet at its boundary.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::cells::Mesh;
use super::geometry::turn;

/// An angle of the sheet in rad from which on a corner is re-entrant; a smaller one is between the chords of a curve.
pub const REENTRANT: f64 = 210.0 * PI / 180.0;

impl Mesh {
    /// The largest angle of the sheet between two edges of its boundary, in rad, see [`Self::boundary_angles`].
    pub fn largest_angle(&self) -> f64 {
        let angles = self.boundary_angles().into_iter();
        angles.fold(0.0, |most, (_, angle)| most.max(angle))
    }

    /// The angles of the sheet at the nodes of its boundary, in rad: π where it is straight, 2π at the tip of a crack. Nodes at which
    /// several parts of the boundary meet do not count.
    pub fn boundary_angles(&self) -> Vec<(usize, f64)> {
        // The directions in which the boundary enters and leaves a node.
        let mut at: BTreeMap<usize, [Vec<[f64; 2]>; 2]> = BTreeMap::new();
        let between = |from: usize, to: usize| {
            [0, 1].map(|axis| self.nodes[to][axis] - self.nodes[from][axis])
        };
        for edge in self.boundary() {
            let [from, to] = [edge[0], edge[1]];
            let middle = edge.get(2).copied();
            at.entry(to).or_default()[0].push(between(middle.unwrap_or(from), to));
            at.entry(from).or_default()[1].push(between(from, middle.unwrap_or(to)));
        }
        let angle_at = |(node, both): (&usize, &[Vec<[f64; 2]>; 2])| match both {
            [before, after] if before.len() == 1 && after.len() == 1 => {
                Some((*node, angle(before[0], after[0])))
            }
            _ => None,
        };
        at.iter().filter_map(angle_at).collect()
    }
}

/// The angle on the left of a line that arrives along one vector and leaves along another.
fn angle(before: [f64; 2], after: [f64; 2]) -> f64 {
    /// A turn to the left by nearly π would leave no sheet.
    const LARGEST_TURN: f64 = 0.9999 * PI;
    match turn(before, after) {
        turn if turn > LARGEST_TURN => 2.0 * PI,
        turn => PI - turn,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellShape, Shape};

    #[test]
    fn a_strip_has_straight_edges_a_missing_quarter_a_corner_and_a_crack_a_tip() {
        for (name, shape) in CellShape::NAMES {
            let strip = Shape::Strip { size: [30.0, 10.0] }.mesh(4, shape);
            assert!((strip.largest_angle() - PI).abs() < 1e-12, "{name}");
        }
        assert!((angle([1.0, 0.0], [0.0, -1.0]) - 1.5 * PI).abs() < 1e-12);
        assert!((angle([1.0, 0.0], [-1.0, 0.0]) - 2.0 * PI).abs() < 1e-12);
        assert!((angle([1.0, 0.0], [0.0, 1.0]) - 0.5 * PI).abs() < 1e-12);
    }
}
