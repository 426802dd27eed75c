//! The four sides of the box around a mesh, which are groups of every mesh.

use crate::error::Diagnostic;
use crate::mesh::cells::Mesh;

/// How far from a side its nodes may lie, as a share of the box's longer side: single precision leaves some 1e-7.
const NEAR: f64 = 1e-6;

/// How far from a side an edge lies that may be meant to belong to it.
const DOUBTFUL: f64 = 1e-4;

/// The sides: name, axis across, and which end of the box.
const SIDES: [(&str, usize, usize); 4] = [
    ("left", 0, 0),
    ("right", 0, 1),
    ("bottom", 1, 0),
    ("top", 1, 1),
];

/// Names the boundary and its parts on the four sides of the mesh's box.
pub fn name_sides(mesh: &mut Mesh) {
    let bounds = mesh.bounding_box();
    let near = NEAR * longer_side(bounds);
    for (name, axis, end) in SIDES {
        let value = bounds[end][axis];
        mesh.name_boundary(name, |position| (position[axis] - value).abs() <= near);
    }
    mesh.name_boundary("boundary", |_| true);
}

fn longer_side([low, high]: [[f64; 2]; 2]) -> f64 {
    (high[0] - low[0]).max(high[1] - low[1])
}

/// Warnings of sides with a part of the edges that lie close to them, but for those that the file names itself.
pub fn doubtful_sides(mesh: &Mesh, is_named: impl Fn(&str) -> bool) -> Vec<Diagnostic> {
    let bounds = mesh.bounding_box();
    let doubtful = |(name, axis, end): (&str, usize, usize)| {
        let named = mesh.groups()[name].edges.len();
        let (value, size) = (bounds[end][axis], longer_side(bounds));
        let away = |edge: &Vec<usize>| {
            let distances = edge
                .iter()
                .map(|node| (mesh.nodes[*node][axis] - value).abs());
            distances.fold(0.0, f64::max)
        };
        let close = mesh.boundary().iter().map(away);
        let close: Vec<f64> = close.filter(|away| *away <= DOUBTFUL * size).collect();
        if named == 0 || close.len() == named || is_named(name) {
            return None;
        }
        let most = close.iter().copied().fold(0.0, f64::max);
        let message = format!(
            "the side `{name}` has {named} of the {} edges that lie within {most:.1e} mm of the mesh's box",
            close.len()
        );
        let hint = "name the edges in the file as a group of their own, or save the nodes with more digits";
        Some(Diagnostic::warning("", message).hint(hint))
    };
    SIDES.into_iter().filter_map(doubtful).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellShape, Shape};

    fn strip(lift: f64) -> Mesh {
        let mut mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(4, CellShape::Quad4);
        for (index, node) in mesh.nodes.iter_mut().enumerate() {
            node[0] += lift * ((index % 7) as f64);
        }
        name_sides(&mut mesh);
        mesh
    }

    #[test]
    fn sides_bear_single_precision_and_tell_of_edges_close_by() {
        let exact = strip(0.0);
        assert!(doubtful_sides(&exact, |_| false).is_empty());
        let rounded = strip(4e-7);
        for (name, ..) in SIDES {
            let edges = |mesh: &Mesh| mesh.groups()[name].edges.len();
            assert_eq!(edges(&rounded), edges(&exact), "{name}");
        }
        assert!(doubtful_sides(&rounded, |_| false).is_empty());
        let rough = strip(1.2e-5);
        let warnings = doubtful_sides(&rough, |_| false);
        assert!(
            warnings
                .iter()
                .any(|one| one.message.contains("edges that lie within")),
            "{warnings:?}"
        );
        assert!(doubtful_sides(&rough, |_| true).is_empty());
    }
}
