//! Dead loads on cells of different sizes.

use super::*;
use crate::mesh::{CellShape, Grid};

/// A force on an edge is the traction with the same sum, whatever the cells along it are.
#[test]
fn a_force_is_spread_evenly_over_the_length_of_edges() {
    let (force, thickness) = ([0.3, -0.1], 2.0);
    for shape in [CellShape::Quad4, CellShape::Quad9] {
        for grading in [1.0, 2.5] {
            let mesh = Mesh::of_grid(Grid::new([20.0, 10.0], [5, 3], grading), shape);
            let load = |load| dead_forces(&mesh, &("right".to_owned(), load), thickness).unwrap();
            let traction = force.map(|force| force / (thickness * 10.0));
            let (computed, expected) = (load(Load::Force(force)), load(Load::Traction(traction)));
            for (computed, expected) in computed.iter().zip(&expected) {
                assert!((computed - expected).abs() < 1e-14, "{shape:?} {grading}");
            }
        }
    }
}

#[test]
fn a_force_on_nodes_without_edges_is_shared_by_them() {
    let mut mesh = Mesh::of_grid(Grid::new([20.0, 10.0], [5, 3], 2.0), CellShape::Quad4);
    mesh.name_nodes("pins", &[5, 10].into());
    let forces = dead_forces(&mesh, &("pins".to_owned(), Load::Force([1.0, 0.0])), 2.0).unwrap();
    assert_eq!([forces[10], forces[20]], [0.5, 0.5]);
}
