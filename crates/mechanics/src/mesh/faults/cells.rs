//! Cells without area or turned inside out, cells given twice, and cells of a bad shape.

use std::collections::HashMap;

use super::finding::Finding;
use crate::error::Diagnostic;
use crate::mesh::cell_shape::CellShape;
use crate::mesh::cells::Mesh;
use crate::mesh::geometry::determinant;
use crate::statistics::extremes;

/// A Jacobian that counts as zero, relative to the square of a cell's size.
const ZERO_JACOBIAN: f64 = 1e-9;
/// The smallest angle between the sides of a good cell, in degrees; the largest one is 180° less it.
const SMALLEST_ANGLE: f64 = 5.0;
/// The longest side of a good cell over its shortest one.
const LONGEST: f64 = 50.0;

/// Cells without area and cells that are turned inside out somewhere.
pub fn without_sense(mesh: &Mesh) -> Vec<Diagnostic> {
    let mut samples: HashMap<CellShape, Vec<Vec<[f64; 2]>>> = HashMap::new();
    let (mut empty, mut inverted) = (Finding::default(), Finding::default());
    for cell in 0..mesh.cell_count() {
        let shape = mesh.shape(cell);
        let samples = samples.entry(shape).or_insert_with(|| {
            let points = shape.quadrature().into_iter().map(|(point, _)| point);
            let nodes = shape.natural_nodes().iter().copied();
            let points = points.chain(nodes);
            points.map(|point| shape.derivatives(point)).collect()
        });
        let jacobians = samples
            .iter()
            .map(|derivatives| determinant(&mesh.map(cell, derivatives)));
        let [low, high] = extremes(jacobians);
        let [from, to] = mesh.cell_box(cell);
        let nothing = ZERO_JACOBIAN * ((to[0] - from[0]).powi(2) + (to[1] - from[1]).powi(2));
        if low.abs().max(high.abs()) <= nothing {
            empty.add(mesh.centre(cell));
        } else if low <= nothing || low.is_nan() {
            inverted.add(mesh.centre(cell));
        }
    }
    let no_area = empty.error(
        ["cell has no area", "cells have no area"],
        "remove the cell, or correct its nodes; if nodes were merged, take a smaller tolerance",
    );
    let folded = inverted.error(
        [
            "cell is turned inside out, in part at least",
            "cells are turned inside out, in part at least",
        ],
        "its corners must be in order around it, with angles below 180°, and midside nodes of curved sides must lie in the middle half of the side",
    );
    no_area.into_iter().chain(folded).collect()
}

/// Cells with the same corners, each with the first one that has them.
pub fn given_twice(mesh: &Mesh) -> Vec<[usize; 2]> {
    let mut known: HashMap<[usize; 4], usize> = HashMap::with_capacity(mesh.cell_count());
    let mut twice = Vec::new();
    for cell in 0..mesh.cell_count() {
        let mut corners = [usize::MAX; 4];
        let nodes = mesh.corners(cell);
        corners[..nodes.len()].copy_from_slice(nodes);
        corners.sort_unstable();
        let first = *known.entry(corners).or_insert(cell);
        if first != cell {
            twice.push([first, cell]);
        }
    }
    twice
}

/// The fault of cells given twice.
pub fn duplicate_cells(mesh: &Mesh, twice: &[[usize; 2]]) -> Option<Diagnostic> {
    Finding::of(twice.iter().map(|[_, again]| mesh.centre(*again))).error(
        ["cell is given twice", "cells are given twice"],
        "write each cell once; in Gmsh a surface must belong to one physical group only, and must not be saved twice (Coherence)",
    )
}

/// A warning of cells with very small or large angles, or very long sides.
pub fn badly_shaped(mesh: &Mesh) -> Option<Diagnostic> {
    let (mut bad, mut worst) = (Finding::default(), 90.0_f64);
    for cell in 0..mesh.cell_count() {
        let (angle, longest) = shape_of(mesh, cell);
        if angle < SMALLEST_ANGLE || longest > LONGEST {
            bad.add(mesh.centre(cell));
            worst = worst.min(angle);
        }
    }
    let message = match bad.count {
        0 => return None,
        1 => "one cell has a bad shape".to_owned(),
        count => format!("{count} cells have a bad shape"),
    };
    let message = format!(
        "{message}: angles within {worst:.1}° of 0° or 180°, or sides of {LONGEST} : 1, near {}",
        bad.near()
    );
    let hint = "errors are large there; mesh it more evenly";
    Some(Diagnostic::warning("", message).hint(hint))
}

/// How near the angles between the straight lines from corner to corner come to 0° or 180°, and the longest line over the
/// shortest one.
fn shape_of(mesh: &Mesh, cell: usize) -> (f64, f64) {
    let corners = mesh.corners(cell);
    let count = corners.len();
    let side = |i: usize| {
        let [a, b] = [corners[i % count], corners[(i + 1) % count]].map(|node| mesh.nodes[node]);
        [b[0] - a[0], b[1] - a[1]]
    };
    let (mut least, mut short, mut long) = (90.0_f64, f64::INFINITY, 0.0_f64);
    for i in 0..count {
        let (a, b) = (side(i), side(i + 1));
        let turn = determinant(&[a, b]).abs();
        let angle = turn.atan2((a[0] * b[0] + a[1] * b[1]).abs());
        least = least.min(angle.to_degrees());
        let length = a[0].hypot(a[1]);
        (short, long) = (short.min(length), long.max(length));
    }
    (least, long / short)
}
