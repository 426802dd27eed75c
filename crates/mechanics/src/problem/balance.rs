//! The balance of all forces on a body, and of their moments.

use crate::mesh::Mesh;
use crate::mesh::geometry::{bounding_box, distance};
use crate::statistics::larger;

/// Forces and their moment about a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Sum of the forces in N.
    pub force: [f64; 2],
    /// Sum of their moments in N·mm, counter-clockwise.
    pub moment: f64,
    /// Sum of the magnitudes of all single forces in N.
    pub size: f64,
}

impl Resultant {
    /// The resultant of nodal forces in N, one for each unknown, at positions in mm about a centre.
    pub fn of_nodes(positions: &[[f64; 2]], forces: &[f64], centre: [f64; 2]) -> Self {
        let mut sum = Self::default();
        for (position, force) in positions.iter().zip(forces.chunks_exact(2)) {
            let arm = [position[0] - centre[0], position[1] - centre[1]];
            sum.force[0] += force[0];
            sum.force[1] += force[1];
            sum.moment += arm[0] * force[1] - arm[1] * force[0];
            sum.size += force[0].hypot(force[1]);
        }
        sum
    }

    /// The sum of two resultants about the same point.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            force: [0, 1].map(|axis| self.force[axis] + other.force[axis]),
            moment: self.moment + other.moment,
            size: self.size + other.size,
        }
    }
}

/// The resultant of all supports and loads; zero in equilibrium.
///
/// ```text
/// F = Σ R + Σ f,   M = Σ (x − c) × (R + f)
/// ```
///
/// R are the forces of the supports, including pulled grips, and f the loads, on the deformed positions x; c is the
/// centre of the body. Forces within a body have no resultant, whatever its field is; F therefore measures the
/// equilibrium of the free nodes, and M also the objectivity of the energy. A pressure enters by its resultant on the
/// deformed edges instead of its nodal forces, so that wrong nodal forces show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Sum of all forces in N.
    pub force: [f64; 2],
    /// Sum of their moments about the centre of the body in N·mm.
    pub moment: f64,
    /// The sum of the magnitudes of all forces of the supports in N, or of all loads where that is larger.
    pub largest_force: f64,
    /// `largest_force` times half the diagonal of the body, in N·mm.
    pub largest_moment: f64,
}

impl Balance {
    /// The largest unbalanced force or moment relative to the largest of all.
    pub fn relative(&self) -> f64 {
        let ratio = |rest: f64, largest: f64| if rest == 0.0 { 0.0 } else { rest / largest };
        let force = self.force[0].hypot(self.force[1]);
        let moment = self.moment.abs();
        larger(
            ratio(force, self.largest_force),
            ratio(moment, self.largest_moment),
        )
    }
}

/// A deformed body, and the point about which its moments are taken.
pub struct Body {
    /// The deformed nodes in mm.
    positions: Vec<[f64; 2]>,
    /// The centre of the box around them.
    centre: [f64; 2],
    /// The centre relative to the middle of the mesh at rest.
    pub from_middle: [f64; 2],
    half_diagonal: f64,
}

impl Body {
    /// A mesh with displacements.
    pub fn new(mesh: &Mesh, displacement: &[f64]) -> Self {
        let moved = mesh.nodes.iter().zip(displacement.chunks_exact(2));
        let positions: Vec<[f64; 2]> = moved.map(|(at, u)| [at[0] + u[0], at[1] + u[1]]).collect();
        let [low, high] = bounding_box(positions.iter().copied());
        let (centre, middle) = (
            [0, 1].map(|axis| 0.5 * (low[axis] + high[axis])),
            mesh.middle(),
        );
        Self {
            positions,
            centre,
            from_middle: [0, 1].map(|axis| centre[axis] - middle[axis]),
            half_diagonal: 0.5 * distance(low, high),
        }
    }

    /// The resultant of nodal forces in N, one for each unknown.
    pub fn resultant(&self, forces: &[f64]) -> Resultant {
        Resultant::of_nodes(&self.positions, forces, self.centre)
    }

    /// The balance of supports and loads about the centre, relative to forces of `negligible` in N at least.
    pub fn balance(&self, supports: Resultant, loads: Resultant, negligible: f64) -> Balance {
        let sum = supports.plus(loads);
        let largest_force = supports.size.max(loads.size).max(negligible);
        Balance {
            force: sum.force,
            moment: sum.moment,
            largest_force,
            largest_moment: largest_force * self.half_diagonal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellShape;

    #[test]
    fn a_couple_has_a_moment_and_no_force() {
        let positions = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]];
        let mesh = Mesh::new(positions, [(CellShape::Triangle3, vec![0, 1, 2])]);
        let body = Body::new(&mesh, &[0.0; 6]);
        let of =
            |forces: [f64; 6]| body.balance(body.resultant(&forces), Resultant::default(), 0.0);
        let balance = of([0.0, -2.0, 0.0, 2.0, 0.0, 0.0]);
        assert_eq!(balance.force, [0.0; 2]);
        assert_eq!(balance.moment, 8.0);
        assert_eq!(balance.largest_force, 4.0);
        assert_eq!(balance.largest_moment, 10.0);
        assert_eq!(balance.relative(), 0.8);
        assert_eq!(of([0.0; 6]).relative(), 0.0);
    }
}
