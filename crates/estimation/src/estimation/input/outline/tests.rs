use super::*;
use crate::mesh::{CellShape, Outline, Shape};

#[test]
fn a_plate_has_four_edges_from_corner_to_corner() {
    for (cells, shape) in [([60, 20], CellShape::Quad4), ([7, 3], CellShape::Quad9)] {
        let mesh = Mesh::plate([150.0, 50.0], cells, shape);
        let all = segments(&mesh, &["left"]).unwrap();
        let mut lengths: Vec<f64> = all.iter().map(Segment::length).collect();
        lengths.sort_by(f64::total_cmp);
        let expected = [50.0, 50.0, 150.0, 150.0];
        assert!(
            lengths
                .iter()
                .zip(expected)
                .all(|(l, e)| (l - e).abs() < 1e-9)
        );
        let named: Vec<_> = all.iter().filter(|part| part.condition.is_some()).collect();
        assert_eq!((named.len(), named[0].name.as_str()), (1, "left"));
        let degree = mesh.shape(0).degree();
        assert_eq!(named[0].nodes.len(), degree * cells[1] + 1);
        assert!(all.iter().any(|part| part.name == "bottom"));
    }
}

#[test]
fn sides_without_a_group_have_names_of_their_own() {
    let shape = Shape::NotchedStrip {
        size: [100.0, 40.0],
        depth: 12.0,
        half_length: 12.0,
    };
    let all = segments(&shape.mesh(12, CellShape::Quad4), &[]).unwrap();
    let names: BTreeSet<&str> = all.iter().map(|part| part.name.as_str()).collect();
    assert!(all.len() > 4 && names.len() == all.len(), "{names:?}");
}

#[test]
fn a_hole_is_one_closed_segment_without_corners() {
    let shape = Shape::StripWithHole {
        size: [100.0, 40.0],
        radius: 8.0,
    };
    let mesh = shape.mesh(8, CellShape::Quad4);
    let all = segments(&mesh, &[]).unwrap();
    assert_eq!(all.iter().filter(|part| part.outer).count(), 4);
    let hole: Vec<_> = all.iter().filter(|part| !part.outer).collect();
    assert_eq!(hole.len(), 1, "{hole:?}");
    assert_eq!(hole[0].ends()[0], hole[0].ends()[1]);
    assert_eq!(hole[0].name, "hole");
}

#[test]
fn groups_that_cannot_be_edges_are_refused() {
    let mut mesh = Mesh::plate([3.0, 2.0], [3, 2], CellShape::Quad4);
    mesh.name_nodes("inner", &[4, 5].into());
    let message = |groups: &[&str]| segments(&mesh, groups).unwrap_err().to_string();
    assert!(message(&["lef"]).contains("no group `lef`"));
    for condition in [EdgeCondition::Free, EdgeCondition::Unknown] {
        let message = parts(&mesh, &[("inner".into(), condition)]).unwrap_err();
        assert!(message.to_string().contains("contains no edge"));
    }
}

#[test]
fn nodes_of_a_held_group_that_are_no_edge_are_a_pad() {
    let mut mesh = Mesh::plate([3.0, 2.0], [3, 2], CellShape::Quad4);
    let names = |mesh: &Mesh| -> Vec<(String, bool, usize)> {
        let found = parts(mesh, &[("pad".into(), EdgeCondition::Rigid)]).unwrap();
        let own = found.into_iter().filter(|part| part.condition.is_some());
        own.map(|part| (part.name, part.inside, part.nodes.len()))
            .collect()
    };
    let inner: BTreeSet<usize> = (0..mesh.nodes.len())
        .filter(|node| mesh.nodes[*node][1] == 1.0 && (0.5..2.5).contains(&mesh.nodes[*node][0]))
        .collect();
    mesh.name_nodes("pad", &inner);
    assert_eq!(names(&mesh), [("pad".to_owned(), true, 2)]);
    let edge: BTreeSet<usize> = (0..mesh.nodes.len())
        .filter(|node| mesh.nodes[*node][0] < 1.5)
        .collect();
    mesh.name_nodes("pad", &edge);
    let found = names(&mesh);
    assert!(found.contains(&("pad".to_owned(), true, 1)), "{found:?}");
    assert_eq!(found.len(), 4);
}

/// A U whose lower side is one piece and whose upper one is two.
#[test]
fn parts_of_a_side_are_named_as_results_name_them() {
    let corners = [
        [0.0, 0.0],
        [30.0, 0.0],
        [30.0, 20.0],
        [20.0, 20.0],
        [20.0, 8.0],
        [10.0, 8.0],
        [10.0, 20.0],
        [0.0, 20.0],
    ];
    let outline = Outline::of_lines(vec![corners.to_vec()]).unwrap();
    for shape in [CellShape::Triangle3, CellShape::Triangle6] {
        let mut mesh = outline.mesh(2.5, shape);
        let names = |mesh: &Mesh, groups: &[&str]| -> BTreeSet<String> {
            segments(mesh, groups)
                .unwrap()
                .into_iter()
                .map(|part| part.name)
                .collect()
        };
        let before = names(&mesh, &[]);
        assert!(
            before.contains("top 1") && before.contains("top 2"),
            "{before:?}"
        );
        name_parts(&mut mesh, ["top 2", "left", "nowhere"].into_iter());
        assert!(!mesh.groups().contains_key("nowhere"));
        let part = &mesh.groups()["top 2"];
        let length: f64 = part
            .edges
            .iter()
            .map(|edge| (mesh.nodes[edge[0]][0] - mesh.nodes[edge[1]][0]).abs())
            .sum();
        assert!((length - 10.0).abs() < 1e-9, "{length}");
        assert_eq!(names(&mesh, &["top 2"]), before);
    }
}
