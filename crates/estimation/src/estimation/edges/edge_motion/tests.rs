//! Edges under all conditions.

use super::*;
use crate::estimation::input::segments;
use crate::mesh::CellShape;

fn motion(conditions: [EdgeCondition; 4]) -> (Mesh, EdgeMotion) {
    let mesh = Mesh::plate([6.0, 4.0], [6, 4], CellShape::Quad9);
    let names = ["left", "bottom", "right", "top"];
    let parts = segments(&mesh, &names).unwrap();
    let pairs: Vec<_> = parts
        .iter()
        .map(|part| (part, conditions[part.condition.unwrap()]))
        .collect();
    let corners = parts.iter().flat_map(Segment::ends).collect();
    let motion = EdgeMotion::new(&mesh, &pairs, &corners, 0.5);
    (mesh, motion)
}

const ALL: [EdgeCondition; 4] = [
    EdgeCondition::Rigid,
    EdgeCondition::Unknown,
    EdgeCondition::Known([Some(0.3), Some(-0.2)]),
    EdgeCondition::Unknown,
];

#[test]
fn slopes_are_those_of_the_displacements() {
    let (mesh, motion) = motion(ALL);
    let count = 2 * mesh.nodes.len();
    let p: Vec<f64> = (0..motion.parameters())
        .map(|i| 0.3 * (1.7 * i as f64).sin())
        .collect();
    let motions = motion.at(&p).motions(p.len(), count);
    let rough = motion.roughness(&p);
    for index in 0..p.len() {
        let at = |step: f64| {
            let mut moved = p.clone();
            moved[index] += step;
            let mut field = vec![0.0; count];
            motion.at(&moved).write(&mut field);
            (field, motion.roughness(&moved))
        };
        let ((up, rough_up), (down, rough_down)) = (at(1e-5), at(-1e-5));
        for unknown in 0..count {
            let slope = (up[unknown] - down[unknown]) / 2e-5;
            assert!((slope - motions[index][unknown]).abs() < 1e-9);
        }
        for ((rough, up), down) in rough.iter().zip(rough_up).zip(rough_down) {
            for row in 0..rough.values.len() {
                let slope = (up.values[row] - down.values[row]) / 2e-5;
                assert!((slope - rough.slopes[(row, index)]).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn neighbouring_edges_move_their_corner_together() {
    let (mesh, motion) = motion([EdgeCondition::Unknown; 4]);
    // Four edges of 8 spans, or 5, with ends in common.
    let p = vec![0.7; motion.parameters()];
    let mut field = vec![0.0; 2 * mesh.nodes.len()];
    motion.at(&p).write(&mut field);
    for edge in mesh.boundary() {
        assert!(
            edge.iter()
                .all(|node| (field[2 * node] - 0.7).abs() < 1e-12)
        );
    }
    let (_, mixed) = self::motion(ALL);
    assert_eq!(motion.parameters() % 2, 0);
    assert!(mixed.parameters() < motion.parameters());
}

#[test]
fn a_rigid_edge_keeps_its_length() {
    let (mesh, motion) = motion([
        EdgeCondition::Rigid,
        EdgeCondition::Free,
        EdgeCondition::Free,
        EdgeCondition::Free,
    ]);
    let mut field = vec![0.0; 2 * mesh.nodes.len()];
    motion.at(&[1.0, 2.0, 1.3]).write(&mut field);
    let nodes = &mesh.groups()["left"].nodes;
    let position = |node: usize| [0, 1].map(|axis| mesh.nodes[node][axis] + field[2 * node + axis]);
    let (a, b) = (position(nodes[0]), position(nodes[nodes.len() - 1]));
    assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 4.0).abs() < 1e-12);
}

/// A closed edge with steps, as one that follows a grid of markers.
#[test]
fn an_uneven_edge_may_deform_uniformly() {
    let line: Vec<[f64; 2]> = (0..72)
        .map(|k| {
            let angle = f64::from(k) / 72.0 * std::f64::consts::TAU;
            [angle.cos(), angle.sin()].map(|x| (10.0 * x).round())
        })
        .collect();
    let outline = crate::mesh::Outline::of_lines(vec![line]).unwrap();
    let mesh = outline.mesh(2.0, CellShape::Triangle6);
    let parts = segments(&mesh, &[] as &[&str]).unwrap();
    let pairs = parts.iter().map(|part| (part, EdgeCondition::Unknown));
    let pairs: Vec<_> = pairs.collect();
    let motion = EdgeMotion::new(&mesh, &pairs, &BTreeSet::new(), 1.0);
    let uniform = mesh.nodes.iter();
    let uniform = uniform.flat_map(|[x, y]| [0.3 * x + 0.1 * y, 0.05 * x - 0.12 * y]);
    let uniform: Vec<f64> = uniform.collect();
    let count = motion.parameters();
    let (rows, values) = motion.at(&vec![0.0; count]).toward(&uniform, count);
    let nearest = rows.clone().svd(true, true).solve(&values, 1e-12).unwrap();
    assert!((rows * nearest - values).amax() < 1e-9);
}
