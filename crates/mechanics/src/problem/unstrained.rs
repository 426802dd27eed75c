//! Problems in which nothing strains the sheet: supports that move it as a rigid body, and no load.

use nalgebra::{Matrix3, Vector3};

use super::boundary::BoundaryProblem;
use super::boundary_conditions::Load;
use super::constraints::{Constraints, FACTORS, Tie};
use super::rigid_motion::RigidMotion;
use crate::error::Diagnostic;
use crate::mesh::Mesh;

/// Displacements further from those of a rigid body than this share of its size strain it.
const ROUNDING: f64 = 1e-9;

/// A displacement that a support prescribes, over the size of the mesh: the position relative to the middle, the axis, and the displacement.
type Prescribed = ([f64; 2], usize, f64);

impl BoundaryProblem {
    /// The fault or warning where nothing strains the sheet, so that all forces are zero and any comparison passes: an error where its supports
    /// move it, a warning where it stays at rest; `None` where something does.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support or a load does not suit a group of the mesh.
    pub fn unstrained(&self, mesh: &Mesh) -> Result<Option<Diagnostic>, Diagnostic> {
        let constraints = Constraints::of(mesh, &self.supports)?;
        let forces = self.dead_forces(mesh)?;
        let mut forces = forces.iter().enumerate();
        let presses = |(_, load): &(String, Load)| match load {
            Load::Pressure(pressure) => *pressure != 0.0,
            Load::Traction(_) | Load::Force(_) => false,
        };
        let is_loaded = forces
            .any(|(unknown, force)| *force != 0.0 && !constraints.held.contains_key(&unknown))
            || self.loads.iter().any(presses);
        if is_loaded
            || !FACTORS
                .iter()
                .all(|factor| is_rigid(mesh, &constraints, *factor))
        {
            return Ok(None);
        }
        let diagnostic = if self.supports.iter().all(|(_, support)| support.rests()) {
            Diagnostic::warning(
                "support",
                "no support moves and no load acts: the sheet stays at rest",
            )
        } else {
            Diagnostic::error(
                "support",
                "the supports move the sheet as a rigid body and no load acts: nothing strains it, and every force is zero",
            )
        };
        let hint = "hold one more group, such as the opposite side with kind = \"clamp\", move the supports apart, or give a group a [[load]]";
        Ok(Some(diagnostic.hint(hint)))
    }
}

/// Whether all prescribed displacements at a load factor are those of one rigid motion, which ties leave free.
fn is_rigid(mesh: &Mesh, constraints: &Constraints, factor: f64) -> bool {
    let (size, middle) = (mesh.diagonal(), mesh.middle());
    let position = |unknown: usize| {
        let at = mesh.nodes[unknown / 2];
        [0, 1].map(|axis| (at[axis] - middle[axis]) / size)
    };
    let held = constraints.held.iter();
    let prescribed = held.map(|(unknown, motion)| {
        let displacement = motion.at(factor) / size;
        (position(*unknown), unknown % 2, displacement)
    });
    let prescribed: Vec<_> = prescribed.collect();
    let mut turns = constraints.held.values().map(|motion| motion.angle());
    let turn = turns.find(|angle| *angle != 0.0).unwrap_or(0.0);
    let Some((rigid, rest)) = nearest_motion(&prescribed, factor * turn) else {
        return false;
    };
    // A rigid grip does not turn, and along an inclined line the sheet moves along the line alone.
    let moved = |unknown: usize| rigid.at(position(unknown))[unknown % 2];
    let follows = |(unknown, tie): (&usize, &Tie)| {
        (moved(*unknown) - tie.share * moved(tie.master)).abs() < ROUNDING
    };
    rest < ROUNDING && constraints.ties.iter().all(follows)
}

/// The rigid motion nearest to some displacements, by Gauss–Newton from an angle, and the largest distance from it;
/// `None` where the displacements determine no motion.
///
/// ```text
/// minimise Σ (a + (R(θ) x − x)ᵢ − uᵢ)²     over a and θ
/// ```
fn nearest_motion(prescribed: &[Prescribed], start: f64) -> Option<(RigidMotion, f64)> {
    const ITERATIONS: usize = 20;
    let mut motion = Vector3::new(0.0, 0.0, start);
    let mut largest = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let (sine, cosine) = motion[2].sin_cos();
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        largest = 0.0;
        for ([x, y], axis, displacement) in prescribed {
            let turned = [cosine * x - sine * y, sine * x + cosine * y];
            let residual = motion[*axis] + turned[*axis] - [x, y][*axis] - displacement;
            let mut slope = Vector3::new(0.0, 0.0, [-turned[1], turned[0]][*axis]);
            slope[*axis] = 1.0;
            normal += slope * slope.transpose();
            right -= residual * slope;
            largest = f64::max(largest, residual.abs());
        }
        motion += normal.cholesky()?.solve(&right);
    }
    let rigid = RigidMotion {
        displacement: [motion[0], motion[1]],
        angle: motion[2],
    };
    Some((rigid, largest))
}

#[cfg(test)]
mod tests {
    use super::super::boundary_conditions::{Drive, Support};
    use super::super::tests::samples::{CLAMP, moved, problem, strip, turned};
    use super::*;
    use crate::mesh::CellShape;
    use crate::units::Linear;

    fn is_unstrained(supports: &[(&str, Support)], loads: &[(&str, Load)]) -> bool {
        let (mesh, problem) = (strip(CellShape::Quad4), problem(supports, loads));
        assert_eq!(problem.check(&mesh), Ok(()));
        problem.unstrained(&mesh).unwrap().is_some()
    }

    const MOVED: Support = Support::Displacement([Some(5.0), Some(1.0)]);
    const ALONG: Support = Support::Displacement([Some(5.0), None]);
    const TURNED: Support = Support::Rotation {
        centre: [3.0, -2.0],
        angle: 2.5,
    };

    #[test]
    fn whatever_moves_a_sheet_as_a_rigid_body_strains_nothing() {
        let no_load = Load::Traction([0.0; 2]);
        let free_grip = Support::Grip([Drive::Force(0.0); 2]);
        let linear = |slope: [f64; 2]| {
            Some(Linear {
                at_origin: 0.0,
                slope,
            })
        };
        // An edge whose nodes are moved along x in proportion to y turns with the sheet where they are free along y.
        let tilted = Support::LinearDisplacement([linear([0.0, 0.1]), None]);
        let fixed = Support::LinearDisplacement([None, linear([0.0, 0.0])]);
        for supports in [
            vec![("left", CLAMP)],
            vec![("right", MOVED)],
            vec![("left", TURNED)],
            vec![("left", TURNED), ("right", TURNED)],
            vec![("left", MOVED), ("right", MOVED)],
            vec![("left", ALONG), ("bottom", Support::Roller)],
            vec![("left", MOVED), ("right", free_grip)],
        ] {
            assert!(
                is_unstrained(&supports, &[("top", no_load)]),
                "{supports:?}"
            );
        }
        // A load on what is held changes nothing.
        let load = Load::Force([1.0, 0.0]);
        assert!(is_unstrained(&[("right", MOVED)], &[("right", load)]));
        let mut mesh = strip(CellShape::Quad4);
        let corner = mesh
            .nodes
            .iter()
            .position(|node| *node == [0.0, 0.0])
            .unwrap();
        mesh.name_nodes("middle", &[corner].into());
        let turning = problem(&[("left", tilted), ("middle", fixed)], &[]);
        assert!(turning.unstrained(&mesh).unwrap().is_some());
    }

    #[test]
    fn what_strains_a_sheet_is_not_taken_for_a_rigid_motion() {
        let grip = Support::Grip([Drive::Force(1.0), Drive::Displacement(0.0)]);
        let free_grip = Support::Grip([Drive::Force(0.0); 2]);
        for supports in [
            vec![("left", CLAMP), ("right", MOVED)],
            vec![("left", CLAMP), ("right", TURNED)],
            vec![("left", CLAMP), ("right", grip)],
            vec![("left", TURNED), ("right", free_grip)],
        ] {
            assert!(!is_unstrained(&supports, &[]), "{supports:?}");
        }
        for load in [Load::Pressure(0.01), Load::Traction([0.0, 0.01])] {
            assert!(!is_unstrained(&[("left", CLAMP)], &[("top", load)]));
        }
    }

    /// The right side of a turned strip slides along its own line: moved along it the strip is rigid, moved across it is strained.
    #[test]
    fn an_inclined_line_strains_a_sheet_that_is_moved_across_it() {
        let mesh = moved(strip(CellShape::Quad4), 0.3, [0.0; 2]);
        let is_unstrained = |by: [f64; 2]| {
            let left = ("left", Support::Displacement(by.map(Some)));
            let problem = problem(&[left, ("right", Support::Roller)], &[]);
            problem.unstrained(&mesh).unwrap().is_some()
        };
        assert!(is_unstrained(turned([0.0, 5.0], 0.3)));
        assert!(!is_unstrained([5.0, 1.0]));
    }
}
