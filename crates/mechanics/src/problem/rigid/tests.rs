use super::super::boundary_conditions::{Drive, Support};
use super::super::tests::samples::{CLAMP, problem};
use crate::error::Diagnostic;
use crate::mesh::{CellShape, Mesh, Shape};

fn checked(mesh: &Mesh, supports: &[(&str, Support)]) -> Vec<Diagnostic> {
    problem(supports, &[]).check(mesh).err().unwrap_or_default()
}

fn strip() -> Mesh {
    let mut mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(2, CellShape::Quad4);
    for (name, at) in [("corner", [0.0, -5.0]), ("end", [30.0, -5.0])] {
        let node = mesh.nodes.iter().position(|node| *node == at).unwrap();
        mesh.name_nodes(name, &[node].into());
    }
    mesh
}

const X: Support = Support::Displacement([Some(0.0), None]);
const Y: Support = Support::Displacement([None, Some(0.0)]);

#[test]
fn free_motions_of_one_part_are_named() {
    let mesh = strip();
    for (supports, message) in [
        (vec![], "move along x and y and rotate: nothing holds it"),
        (vec![("left", X)], "move along y without"),
        (vec![("bottom", Y)], "move along x without"),
        (vec![("corner", CLAMP)], "rotate about (0.0, -5.0) mm"),
        (vec![("corner", X)], "move along y and rotate"),
        (
            vec![("corner", X), ("end", Y)],
            "rotate about (30.0, -5.0) mm",
        ),
        (
            vec![(
                "right",
                Support::Grip([Drive::Force(1.0), Drive::Displacement(0.0)]),
            )],
            "move along x without",
        ),
        (
            vec![(
                "right",
                Support::Grip([Drive::Force(1.0), Drive::Force(0.0)]),
            )],
            "move along x and y without",
        ),
    ] {
        let diagnostics = checked(&mesh, &supports);
        assert_eq!(diagnostics.len(), 1, "{supports:?}: {diagnostics:?}");
        assert!(
            diagnostics[0].message.starts_with("the specimen can "),
            "{}",
            diagnostics[0].message
        );
        assert!(
            diagnostics[0].message.contains(message),
            "{supports:?}: {}",
            diagnostics[0].message
        );
        let hint = diagnostics[0].hint.as_deref().unwrap_or_default();
        assert!(hint.contains("`left`"), "{hint}");
    }
}

#[test]
fn supports_that_suffice_are_accepted() {
    let grip = |x, y| Support::Grip([x, y]);
    for supports in [
        vec![("left", CLAMP)],
        vec![("corner", CLAMP), ("end", Y)],
        vec![("left", X), ("bottom", Y)],
        vec![
            ("left", CLAMP),
            ("right", grip(Drive::Force(1.0), Drive::Force(0.0))),
        ],
        vec![
            ("left", X),
            ("right", grip(Drive::Force(1.0), Drive::Displacement(0.0))),
        ],
    ] {
        assert_eq!(checked(&strip(), &supports), [], "{supports:?}");
    }
}

/// A single point has no line on which it slides.
#[test]
fn a_roller_on_a_point_is_refused() {
    let diagnostics = checked(&strip(), &[("left", CLAMP), ("end", Support::Roller)]);
    assert!(
        diagnostics.len() == 1 && diagnostics[0].message.contains("single point"),
        "{diagnostics:?}"
    );
}

/// Two squares beside each other, at one corner, or apart.
fn squares(by: [f64; 2]) -> Mesh {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut nodes = square.to_vec();
    let mut other = Vec::new();
    for corner in square {
        let position = [corner[0] + by[0], corner[1] + by[1]];
        let known = nodes.iter().position(|node| *node == position);
        other.push(known.unwrap_or(nodes.len()));
        if known.is_none() {
            nodes.push(position);
        }
    }
    let cells = [
        (CellShape::Quad4, vec![0, 1, 2, 3]),
        (CellShape::Quad4, other),
    ];
    let mut mesh = Mesh::new(nodes, cells);
    mesh.name_nodes("left", &[0, 3].into());
    mesh
}

#[test]
fn every_part_must_be_held_and_a_hinge_holds_two_motions_of_three() {
    let clamp = [("left", CLAMP)];
    assert_eq!(checked(&squares([1.0, 0.0]), &clamp), []);
    let hinged = checked(&squares([1.0, 1.0]), &clamp);
    assert_eq!(hinged.len(), 1);
    let message = &hinged[0].message;
    assert!(
        message.contains("the part with cell 1 near (1.5, 1.5) mm can rotate about (1.0, 1.0) mm"),
        "{message}"
    );
    let apart = checked(&squares([3.0, 0.0]), &clamp);
    assert_eq!(apart.len(), 1);
    assert!(apart[0].message.contains("nothing holds it"), "{apart:?}");
    assert!(
        apart[0]
            .hint
            .as_deref()
            .is_some_and(|hint| hint.contains("attach it"))
    );
}
