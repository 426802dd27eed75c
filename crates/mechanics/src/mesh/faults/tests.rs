//! Meshes with one fault each, and sound ones.

use super::*;
use crate::mesh::cell_shape::CellShape;
use crate::mesh::shapes::Shape;

/// A strip of 4 × 2 squares of 1 mm, by its nodes and cells.
fn strip() -> (Vec<[f64; 2]>, Vec<Vec<usize>>) {
    let nodes = (0..=4).flat_map(|i| (0..=2).map(move |j| [f64::from(i), f64::from(j)]));
    let cells = (0..4).flat_map(|i| (0..2).map(move |j| 3 * i + j));
    let cells = cells.map(|a| vec![a, a + 3, a + 4, a + 1]);
    (nodes.collect(), cells.collect())
}

fn mesh(nodes: Vec<[f64; 2]>, cells: Vec<Vec<usize>>) -> Mesh {
    let shape = |nodes: &Vec<usize>| match nodes.len() {
        3 => CellShape::Triangle3,
        6 => CellShape::Triangle6,
        8 => CellShape::Quad8,
        _ => CellShape::Quad4,
    };
    Mesh::new(nodes, cells.into_iter().map(|nodes| (shape(&nodes), nodes)))
}

fn messages_of(mesh: &Mesh, allowed: Exemptions) -> Vec<String> {
    let faults = mesh.faults(allowed).into_iter();
    faults.map(|fault| fault.message).collect()
}

fn assert_messages(mesh: &Mesh, expected: &[&str]) {
    let messages = messages_of(mesh, Exemptions::default());
    assert_eq!(messages.len(), expected.len(), "{messages:?}");
    for (message, expected) in messages.iter().zip(expected) {
        assert!(message.contains(expected), "{message}");
    }
}

const ALL: Exemptions = Exemptions {
    seams: true,
    parts: true,
    hinges: true,
    polygons: true,
};

#[test]
fn sound_meshes_have_no_faults() {
    let (nodes, cells) = strip();
    assert_messages(&mesh(nodes, cells), &[]);
    for shape in [
        Shape::StripWithHole {
            size: [30.0, 10.0],
            radius: 2.5,
        },
        Shape::RingSector {
            radii: [10.0, 20.0],
            angle: 6.0,
        },
        Shape::NotchedStrip {
            size: [30.0, 10.0],
            depth: 2.0,
            half_length: 3.0,
        },
    ] {
        for (_, kind) in CellShape::NAMES {
            assert_messages(&shape.mesh(6, kind), &[]);
        }
    }
    assert_messages(&Mesh::plate([9.0, 3.0], [90, 30], CellShape::Quad9), &[]);
}

#[test]
fn cells_without_area_or_inside_out_are_found() {
    let (mut nodes, cells) = strip();
    nodes[14] = [3.0, 0.5];
    let folded = mesh(nodes.clone(), cells.clone());
    assert_messages(
        &folded,
        &["one cell is turned inside out, in part at least, near (3.25"],
    );
    let (nodes, mut cells) = strip();
    cells.push(vec![0, 1, 2]);
    let messages = messages_of(&mesh(nodes.clone(), cells.clone()), Exemptions::default());
    assert!(
        messages[0].starts_with("one cell has no area, near (0, 1) mm"),
        "{messages:?}"
    );
    // Corners that do not follow each other.
    cells.pop();
    cells[7] = vec![10, 13, 11, 14];
    let messages = messages_of(&mesh(nodes, cells), Exemptions::default());
    assert!(messages[0].contains("turned inside out"), "{messages:?}");
}

#[test]
fn a_side_that_is_curved_too_far_turns_its_cell_inside_out() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
    let middles = |bend: f64| [[1.0, bend], [1.0, 1.0], [0.0, 1.0]];
    for (bend, faults) in [(0.4, 0), (-0.9, 0), (0.6, 1)] {
        let nodes = corners.into_iter().chain(middles(bend)).collect();
        let messages = messages_of(&mesh(nodes, vec![(0..6).collect()]), ALL);
        assert_eq!(messages.len(), faults, "{bend}: {messages:?}");
    }
}

#[test]
fn cells_given_twice_and_cells_on_each_other_are_found() {
    let (nodes, mut cells) = strip();
    cells.push(vec![4, 1, 0, 3]);
    assert_messages(
        &mesh(nodes.clone(), cells.clone()),
        &["one cell is given twice, near (0.5, 0.5) mm"],
    );
    cells.pop();
    cells.push(vec![9, 12, 10]);
    assert_messages(&mesh(nodes, cells), &["overlap: two on the same side"]);
    // A part laid over another one, with nodes of its own.
    let (mut nodes, mut cells) = strip();
    nodes.extend([[1.2, 0.3], [1.9, 0.3], [1.9, 0.9]]);
    cells.push(vec![15, 16, 17]);
    let messages = messages_of(&mesh(nodes.clone(), cells.clone()), Exemptions::default());
    assert!(
        messages[0].contains("2 parts are not attached"),
        "{messages:?}"
    );
    let messages = messages_of(&mesh(nodes, cells), ALL);
    assert!(messages[0].contains("covered by two cells"), "{messages:?}");
}

#[test]
fn hanging_nodes_are_found_on_straight_and_curved_sides() {
    let (mut nodes, mut cells) = strip();
    // The last two cells of the lower row are divided along the middle.
    nodes.extend([[3.0, 0.5], [4.0, 0.5]]);
    cells[6] = vec![9, 12, 16, 15];
    cells.push(vec![15, 16, 13, 10]);
    assert_messages(
        &mesh(nodes, cells),
        &["one node hangs on a cell's side without being its node, near (3, 0.5) mm"],
    );
    // Beside a quadratic side: its middle is the corner of two linear cells.
    let nodes = vec![
        [0.0, 0.0],
        [2.0, 0.0],
        [0.0, 2.0],
        [1.0, 0.0],
        [1.1, 1.1],
        [0.0, 1.0],
        [2.0, 2.0],
    ];
    let messages = messages_of(
        &mesh(nodes, vec![(0..6).collect(), vec![1, 6, 4], vec![4, 6, 2]]),
        Exemptions::default(),
    );
    assert!(messages[0].contains("one node hangs"), "{messages:?}");
}

#[test]
fn seams_of_doubled_nodes_are_found_unless_they_are_allowed() {
    let (mut nodes, mut cells) = strip();
    // The right half gets nodes of its own at X = 2, but for the one in the middle.
    nodes.extend([[2.0, 0.0], [2.0, 2.0]]);
    let twin = |node: &usize| match node {
        6 => 15,
        8 => 16,
        other => *other,
    };
    for cell in &mut cells[4..] {
        *cell = cell.iter().map(twin).collect();
    }
    let split = mesh(nodes, cells);
    assert_messages(&split, &["2 sides lie on another cell's"]);
    let seams = Exemptions {
        seams: true,
        hinges: true,
        ..Exemptions::default()
    };
    assert_eq!(messages_of(&split, seams), Vec::<String>::new());
}

#[test]
fn banks_of_a_slit_need_not_have_nodes_at_the_same_places() {
    // Two squares above each other, the upper one divided, with nodes of their own but for the left one.
    let nodes = vec![
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [0.0, 1.0],
        [1.0, 1.0],
        [2.0, 1.0],
        [2.0, 2.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    let cells = |end: usize| vec![vec![0, 1, 2, 3], vec![3, 4, 7, 8], vec![4, end, 6, 7]];
    let messages = messages_of(&mesh(nodes.clone(), cells(2)), ALL);
    assert!(messages[0].contains("one node hangs"), "{messages:?}");
    let mut apart = nodes;
    apart.push([0.0, 1.0]);
    let cells = vec![vec![0, 1, 2, 3], vec![9, 4, 7, 8], vec![4, 5, 6, 7]];
    assert_eq!(messages_of(&mesh(apart, cells), ALL), Vec::<String>::new());
}

#[test]
fn unattached_parts_and_hinges_are_found() {
    let (mut nodes, mut cells) = strip();
    nodes.extend([[6.0, 0.0], [7.0, 0.0], [7.0, 1.0]]);
    cells.push(vec![15, 16, 17]);
    assert_messages(
        &mesh(nodes, cells),
        &["2 parts are not attached to each other: 8 cells near (0.5, 0.5) mm, 1 cells near"],
    );
    let (mut nodes, mut cells) = strip();
    nodes.extend([[5.0, 2.0], [5.0, 3.0]]);
    cells.push(vec![14, 15, 16]);
    assert_messages(
        &mesh(nodes, cells),
        &["one node alone joins cells on both sides of it: a hinge, near (4, 2) mm"],
    );
}

#[test]
fn bad_shapes_are_warnings() {
    let nodes = vec![[0.0, 0.0], [1.0, 0.0], [0.5, 0.02]];
    let faults = mesh(nodes, vec![vec![0, 1, 2]]).faults(Exemptions::default());
    assert_eq!(faults.len(), 1);
    assert_eq!(faults[0].severity, crate::error::Severity::Warning);
    assert!(
        faults[0].message.contains("bad shape"),
        "{}",
        faults[0].message
    );
}
