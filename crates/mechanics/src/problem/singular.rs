//! Points of a sheet at which stress has no bound: its value there depends on the mesh alone.

use std::collections::BTreeSet;

use super::boundary::BoundaryProblem;
use crate::error::Diagnostic;
use crate::mesh::{Mesh, REENTRANT};

impl BoundaryProblem {
    /// The points at rest in mm at which stress has no bound: where supports that hold a node along both axes end on the boundary, where they
    /// hold nodes of the sheet itself, and re-entrant corners of the boundary.
    ///
    /// # Errors
    /// A [`Diagnostic`] when a support names no group of the mesh, or when supports contradict each other.
    pub fn singular_points(&self, mesh: &Mesh) -> Result<Vec<[f64; 2]>, Diagnostic> {
        Ok(singular_points(mesh, &self.fixed_nodes(mesh)?))
    }

    /// The nodes that one support, or a grip with given forces, holds along both axes. Symmetry lines, inclined or crossing, do not bound the
    /// sheet.
    fn fixed_nodes(&self, mesh: &Mesh) -> Result<BTreeSet<usize>, Diagnostic> {
        let (held, mut ties) = (self.held_by(mesh)?, self.ties(mesh)?);
        // A node on an inclined line follows itself.
        ties.retain(|unknown, tie| unknown / 2 != tie.master / 2);
        let masters: BTreeSet<usize> = ties.values().map(|tie| tie.master).collect();
        let is_tied = |unknown: &usize| ties.contains_key(unknown) || masters.contains(unknown);
        let is_fixed = |node: &usize| {
            let [along, across] = [2 * node, 2 * node + 1];
            match (held.get(&along), held.get(&across)) {
                (Some(one), Some(other)) => one == other,
                (Some(_), None) => is_tied(&across),
                (None, Some(_)) => is_tied(&along),
                (None, None) => is_tied(&along) && is_tied(&across),
            }
        };
        Ok((0..mesh.nodes.len()).filter(is_fixed).collect())
    }
}

/// The points at rest in mm at which the stress of a sheet with these fixed nodes has no bound.
pub fn singular_points(mesh: &Mesh, fixed: &BTreeSet<usize>) -> Vec<[f64; 2]> {
    let boundary: BTreeSet<usize> = mesh.boundary().iter().flatten().copied().collect();
    let is_free = |side: &&Vec<usize>| side.iter().any(|node| !fixed.contains(node));
    let free_sides = mesh.boundary().iter().filter(is_free);
    let ends = free_sides.flatten().filter(|node| fixed.contains(node));
    let cells = (0..mesh.cell_count()).map(|cell| mesh.cell(cell));
    let inside = cells
        .filter(|cell| cell.iter().any(|node| !fixed.contains(node)))
        .flatten()
        .filter(|node| fixed.contains(node) && !boundary.contains(node));
    let corners = mesh.boundary_angles().into_iter();
    let corners = corners.filter_map(|(node, angle)| (angle > REENTRANT).then_some(node));
    let nodes: BTreeSet<usize> = ends.chain(inside).copied().chain(corners).collect();
    nodes.into_iter().map(|node| mesh.nodes[node]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::samples::{moved, problem, strip};
    use crate::mesh::{CellShape, Shape};
    use crate::problem::{Drive, Support};

    fn points(supports: &[(&str, Support)]) -> Vec<[f64; 2]> {
        let mesh = Shape::Strip { size: [20.0, 10.0] }.mesh(4, CellShape::Quad9);
        problem(supports, &[]).singular_points(&mesh).unwrap()
    }

    #[test]
    fn a_clamp_ends_at_two_corners_and_symmetry_lines_at_none() {
        let clamp = Support::Displacement([Some(0.0); 2]);
        let mut ends = points(&[("left", clamp)]);
        ends.sort_by(|a, b| a[1].total_cmp(&b[1]));
        assert_eq!(ends.len(), 2);
        assert_eq!([ends[0][0], ends[1][0]], [0.0; 2]);
        assert!((ends[1][1] - ends[0][1] - 10.0).abs() < 1e-12);
        let lines = [("left", Support::Roller), ("bottom", Support::Roller)];
        assert!(points(&lines).is_empty());
    }

    #[test]
    fn a_grip_ends_at_two_corners_however_it_is_driven() {
        let drives = [Drive::Displacement(1.0), Drive::Force(0.2)];
        for along in drives {
            for across in drives {
                let grip = ("right", Support::Grip([along, across]));
                let ends = points(&[("left", Support::Roller), grip]);
                assert_eq!(ends.len(), 2, "{along:?} {across:?}");
                assert!(ends.iter().all(|end| end[0] == 20.0));
            }
        }
    }

    #[test]
    fn turned_symmetry_lines_end_at_no_singular_point_and_hold_their_corner() {
        let mesh = moved(strip(CellShape::Quad9), 0.3, [0.0; 2]);
        let lines = [("left", Support::Roller), ("bottom", Support::Roller)];
        let problem = problem(&lines, &[]);
        assert_eq!(problem.singular_points(&mesh), Ok(Vec::new()));
        let corner = mesh.groups()["bottom-left"].nodes[0];
        let held: Vec<(usize, usize)> = problem.held_by(&mesh).unwrap().into_iter().collect();
        assert_eq!(held, [(2 * corner, 0), (2 * corner + 1, 1)]);
    }
}
