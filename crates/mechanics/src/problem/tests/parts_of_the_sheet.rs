//! Supports of areas and of lines on the sheet hold them as wholes, on finer meshes too.

use std::collections::BTreeSet;

use super::samples::{CLAMP, problem, solved, strip};
use crate::mesh::{CellShape, Mesh};
use crate::problem::boundary_conditions::Support;
use crate::units::parse_linear_length;

/// Names the nodes of a mesh at the positions where `inside` holds.
fn name(mesh: &mut Mesh, group: &str, inside: impl Fn([f64; 2]) -> bool) {
    let nodes = (0..mesh.nodes.len()).filter(|node| inside(mesh.nodes[*node]));
    let nodes: BTreeSet<usize> = nodes.collect();
    mesh.name_nodes(group, &nodes);
}

/// The cells of a mesh between two positions along x, with the groups `left` and `right`.
fn part(mesh: &Mesh, [from, to]: [f64; 2]) -> Mesh {
    let cells = (0..mesh.cell_count()).filter(|cell| {
        let [x, _] = mesh.centre(*cell);
        from < x && x < to
    });
    let cells: Vec<usize> = cells.collect();
    let kept: BTreeSet<usize> = cells
        .iter()
        .flat_map(|cell| mesh.cell(*cell))
        .copied()
        .collect();
    let kept: Vec<usize> = kept.into_iter().collect();
    let number = |node: &usize| kept.binary_search(node).unwrap();
    let cells = cells.iter().map(|cell| {
        let nodes = mesh.cell(*cell).iter().map(number);
        (mesh.shape(*cell), nodes.collect())
    });
    let mut part = Mesh::new(kept.iter().map(|node| mesh.nodes[*node]).collect(), cells);
    part.name_boundary("left", |[x, _]| (x - from).abs() < 1e-9);
    part.name_boundary("right", |[x, _]| (x - to).abs() < 1e-9);
    part
}

/// What meshes are made into on their way through a study.
const FINER: [fn(&Mesh) -> Mesh; 4] = [
    Mesh::clone,
    Mesh::refined,
    |mesh| mesh.linear().refined().quadratic(),
    |mesh| {
        let triangles = mesh.triangulated();
        triangles.refined_where(&vec![true; triangles.cell_count()])
    },
];

/// A strip with rigid tabs at its ends is the strip between them with clamped ends.
#[test]
fn rigid_tabs_leave_the_strip_between_them() {
    let pull = Support::Displacement([Some(3.0), Some(0.0)]);
    for (_, shape) in CellShape::NAMES {
        let mut full = strip(shape);
        name(&mut full, "grip", |[x, _]| x < 7.6);
        name(&mut full, "jaw", |[x, _]| x > 22.4);
        let gauge = part(&full, [7.5, 22.5]);
        for finer in FINER {
            let tabs = problem(&[("grip", CLAMP), ("jaw", pull)], &[]);
            let ends = problem(&[("left", CLAMP), ("right", pull)], &[]);
            let solution = solved(&tabs, &finer(&full), &["grip", "jaw"]);
            let expected = solved(&ends, &finer(&gauge), &["left", "right"]);
            for (force, other) in solution.reactions.iter().zip(&expected.reactions) {
                let apart = (force[0] - other[0]).abs() + (force[1] - other[1]).abs();
                assert!(apart < 1e-10, "{shape:?}: {force:?} {other:?}");
            }
        }
    }
}

/// A line across the strip that is held leaves the half of it before the line, and what hangs beyond follows without a force; one
/// along the strip ends on the clamped side, whose corner is shared.
#[test]
fn lines_on_the_sheet_are_held_whole_and_forces_of_groups_add_up() {
    let along = parse_linear_length("0.05 * X").unwrap();
    let stretched = Support::LinearDisplacement([Some(along), None]);
    let pull = Support::Displacement([Some(1.5), Some(0.0)]);
    for (_, shape) in CellShape::NAMES {
        let mut full = strip(shape);
        name(&mut full, "across", |[x, _]| (x - 15.0).abs() < 1e-9);
        name(&mut full, "along", |[_, y]| (y - 5.0).abs() < 1e-9);
        let half = part(&full, [0.0, 15.0]);
        for finer in FINER {
            let (full, half) = (finer(&full), finer(&half));
            let across = problem(&[("left", CLAMP), ("across", pull)], &[]);
            let ends = problem(&[("left", CLAMP), ("right", pull)], &[]);
            let reactions = solved(&across, &full, &["left", "across"]).reactions;
            let expected = solved(&ends, &half, &["right"]).reactions[0];
            assert!((reactions[1][0] - expected[0]).abs() < 1e-10, "{shape:?}");
            assert!(
                (reactions[0][0] + reactions[1][0]).abs() < 1e-10,
                "{shape:?}"
            );
            let middle = problem(&[("left", CLAMP), ("along", stretched)], &[]);
            let reactions = solved(&middle, &full, &["left", "along"]).reactions;
            assert!(reactions[1][0] > 0.01, "{reactions:?}");
            assert!(
                (reactions[0][0] + reactions[1][0]).abs() < 1e-10,
                "{shape:?} {reactions:?}"
            );
        }
    }
}
