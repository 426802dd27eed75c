//! Pads glued onto a sheet: one motion, one force.

use std::collections::BTreeSet;

use super::truth::{SIZE, estimate_on, grid, law, solved};
use crate::estimation::*;
use crate::mesh::{CellShape, Mesh};

/// How the pad moves in mm.
const MOTION: [f64; 2] = [4.0, 1.5];

/// A sheet with a pad of 10 × 10 mm in its middle, its left side clamped; the field and the force on the pad in N.
fn pulled(cells: [usize; 2]) -> (Mesh, Vec<f64>, [f64; 2]) {
    let mut mesh = Mesh::plate(SIZE, cells, CellShape::Quad9);
    let inside = |[x, y]: [f64; 2]| (25.0..=35.0).contains(&x) && (10.0..=20.0).contains(&y);
    let pad = (0..mesh.nodes.len()).filter(|node| inside(mesh.nodes[*node]));
    let pad: BTreeSet<usize> = pad.collect();
    mesh.name_nodes("pad", &pad);
    let (displacement, force) = solved(&mesh, law(), "pad", MOTION, &[0.5, 1.0]).remove(1);
    (mesh, displacement, force)
}

#[test]
fn a_rigid_pad_inside_of_the_sheet_has_one_motion_and_one_force() {
    let (mesh, field, force) = pulled([24, 12]);
    let markers: Vec<Marker> = grid()
        .into_iter()
        .enumerate()
        .map(|(number, position)| {
            let jitter = |axis: usize| 0.01 * (((7 * number + 3 * axis) % 11) as f64 - 5.0) / 5.0;
            let u = mesh.displacement_at(&field, position);
            Marker {
                number,
                position,
                displacement: [u[0] + jitter(0), u[1] + jitter(1)],
                standard_deviation: None,
            }
        })
        .collect();
    let knowledge = Knowledge {
        edges: vec![
            ("left".into(), EdgeCondition::Rigid),
            ("pad".into(), EdgeCondition::Rigid),
        ],
        unnamed: Unnamed::Free,
        ..Knowledge::default()
    };
    let result = estimate_on(&mesh, &markers, &knowledge);
    assert!((result.effective_parameters - 6.0).abs() < 1e-6);
    assert_eq!(result.forces.len(), 2);
    let pad = result
        .forces
        .iter()
        .find(|force| force.edge == "pad")
        .unwrap();
    for axis in [0, 1] {
        let miss = pad.force[axis].value - force[axis];
        assert!(
            miss.abs() < 0.01 * force[0].hypot(force[1]),
            "{pad:?} {force:?}"
        );
        let [low, high] = pad.force[axis].interval;
        // The truth is on the same mesh; the interval includes the discretisation error.
        assert!(high - low < 0.1 * force[0].hypot(force[1]), "{pad:?}");
        assert!(low < force[axis] && force[axis] < high, "{pad:?} {force:?}");
    }
    assert!(result.imbalance < 1e-9, "{}", result.imbalance);
    for node in &mesh.groups()["pad"].nodes {
        for (axis, motion) in MOTION.into_iter().enumerate() {
            assert!((result.displacement[2 * node + axis] - motion).abs() < 0.02);
        }
    }
    assert!(result.holds_mesh_error);
}
