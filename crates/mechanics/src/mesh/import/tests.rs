//! Meshes of other programs.

use std::fs;
use std::path::PathBuf;

use super::raw::counter_clockwise;
use super::*;
use crate::mesh::cell_shape::CellShape;

fn with(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    (folder, path)
}

fn read(name: &str, text: &str) -> Result<Mesh, String> {
    let (_folder, path) = with(name, text);
    match import(&path, MeshReading::in_unit(10.0)) {
        Ok((mesh, _)) => Ok(mesh),
        Err(faults) => Err(faults.iter().map(ToString::to_string).collect()),
    }
}

/// A square of 1 × 1: a triangle below the diagonal, given clockwise, and one above; the lower side is a group.
const VERSION_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"lower side\"\n2 9 \"sheet\"\n$EndPhysicalNames\n\
$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n5 0 1 0\n$EndNodes\n\
$Elements\n3\n1 1 2 7 1 1 2\n2 2 2 9 1 1 3 2\n3 2 2 9 1 1 3 5\n$EndElements\n";

const VERSION_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"lower side\"\n$EndPhysicalNames\n\
$Entities\n1 1 1 0\n1 0 0 0 0\n4 0 0 0 1 0 0 1 7 2 1 -2\n1 0 0 0 1 1 0 0 1 4\n$EndEntities\n\
$Nodes\n1 4 1 5\n2 1 0 4\n1\n2\n3\n5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n\
$Elements\n2 2 1 2\n1 4 1 1\n1 1 2\n2 1 3 1\n2 1 2 3 5\n$EndElements\n";

#[test]
fn both_versions_of_gmsh_are_read_with_their_groups() {
    for (text, cells) in [
        (VERSION_2, 2),
        (VERSION_4, 1),
        // A curve that the group takes the other way round.
        (&VERSION_4.replace("1 7 2 1 -2", "1 -7 2 1 -2"), 1),
        (&VERSION_2.replace('\n', "\r\n"), 2),
    ] {
        let mesh = read("a.msh", text).unwrap();
        assert_eq!((mesh.nodes.len(), mesh.cell_count()), (4, cells));
        assert_eq!(mesh.nodes[2], [10.0, 10.0]);
        let groups = mesh.groups();
        assert_eq!(groups["lower side"].nodes, groups["bottom"].nodes);
        assert_eq!(groups["lower side"].edges, [[0, 1]]);
        assert_eq!(groups["boundary"].edges.len(), 4);
        for cell in 0..mesh.cell_count() {
            assert!(mesh.gradients(cell, mesh.shape(cell).centre()).1 > 0.0);
        }
    }
}

#[test]
fn points_and_lines_of_one_name_are_one_group() {
    let text = VERSION_2.replace("2\n1 7 ", "3\n0 3 \"lower side\"\n1 7 ");
    let text = text.replace("$Elements\n3\n", "$Elements\n4\n4 15 2 3 1 5\n");
    let mesh = read("a.msh", &text).unwrap();
    let group = &mesh.groups()["lower side"];
    assert_eq!(
        (&group.nodes[..], &group.edges[..]),
        (&[0, 1, 3][..], &[vec![0, 1]][..])
    );
}

#[test]
fn a_sheet_is_flat_up_to_rounding_wherever_its_nodes_lie() {
    // A node at the origin, and one that is off the plane by rounding.
    let nodes = "1 0 0 0\n2 1 0 0\n3 1 1 0\n5 0 1 0\n";
    let rounded = |z: &str| format!("1 0 -1 {z}\n2 1 -1 0\n3 1 0 0\n5 0 0 0\n");
    let with = |z: &str| read("a.msh", &VERSION_2.replace(nodes, &rounded(z)));
    assert!(with("1e-15").is_ok());
    assert!(with("1e-6").unwrap_err().contains("not flat"));
}

/// A triangle of six nodes.
const SIX: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [2.0, 0.0],
    [0.0, 2.0],
    [1.0, 0.0],
    [1.0, 1.0],
    [0.0, 1.0],
];

#[test]
fn quadrilaterals_with_a_corner_twice_are_triangles() {
    // The upper triangle as a quadrilateral, whichever corner stands twice.
    for nodes in ["1 3 5 5", "1 3 3 5", "1 1 3 5", "1 3 5 1"] {
        let text = VERSION_2.replace("3 2 2 9 1 1 3 5", &format!("3 3 2 9 1 {nodes}"));
        let mesh = read("a.msh", &text).unwrap();
        assert_eq!(mesh.shape(1), CellShape::Triangle3, "{nodes}");
        assert!((mesh.cell_area(1) - 50.0).abs() < 1e-12, "{nodes}");
    }
    // Eight nodes: the middle of the side without a length is the corner.
    for side in 0..4 {
        let corners = [0, 1, 2];
        let middles = [3, 4, 5];
        let (mut around, mut between) = (Vec::new(), Vec::new());
        for at in 0..3 {
            around.push(corners[at]);
            // The doubled corner is the one at which the side without a length begins.
            if at == side % 3 {
                around.push(corners[at]);
                between.push(corners[at]);
            }
            between.push(middles[at]);
        }
        if side == 3 {
            // Over the end: the first corner stands at the end once more.
            around = vec![0, 1, 2, 0];
            between = vec![3, 4, 5, 0];
        }
        let nodes: Vec<u64> = around
            .iter()
            .chain(&between)
            .map(|node| *node as u64)
            .collect();
        let mut raw = Raw {
            cells: vec![(CellShape::Quad8, nodes)],
            positions: (0..6)
                .map(|node: usize| (node as u64, [SIX[node][0], SIX[node][1], 0.0]))
                .collect(),
            ..Raw::default()
        };
        raw.collapse_quadrilaterals();
        let mesh = raw.mesh(1.0).unwrap();
        assert_eq!(mesh.shape(0), CellShape::Triangle6, "{side}");
        assert!((mesh.cell_area(0) - 2.0).abs() < 1e-12, "{side}");
        assert!(mesh.faults(Exemptions::default()).is_empty(), "{side}");
    }
}

#[test]
fn what_cannot_be_read_is_refused_by_name() {
    for (text, reason) in [
        (VERSION_2.replace("2.2 0 8", "2.2 1 8"), "binary"),
        (VERSION_2.replace("2.2 0 8", "3.0 0 8"), "has the format 3"),
        (
            VERSION_2.replace("2 2 2 9 1 1 3 2", "2 4 2 9 1 1 3 2 5"),
            "is a 3-D mesh",
        ),
        (VERSION_2.replace("3 1 1 0\n", "3 1 1 0.5\n"), "is not flat"),
        (
            VERSION_2.replace("3 1 1 0\n", "3 1 x 0\n"),
            "has \"x\" in $Nodes",
        ),
        (
            VERSION_2.replace("1 1 3 5\n", "1 1 3 6\n"),
            "the node 6, which it does not contain",
        ),
        (
            VERSION_2.replace("3 1 1 0\n", "3 0.5 0 0\n"),
            "cell has no area, near (5, 0) mm",
        ),
        (
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".into(),
            "has no $Nodes",
        ),
        (
            VERSION_2
                .split("$EndNodes")
                .next()
                .unwrap()
                .replace("4\n1 0", "9\n1 0"),
            "ends within $Nodes",
        ),
    ] {
        let error = read("a.msh", &text).unwrap_err();
        assert!(error.contains(reason), "{error}");
    }
    assert!(read("a.stl", "").unwrap_err().contains("is not a .msh"));
    assert!(
        read("a.vtu", "nothing")
            .unwrap_err()
            .contains("cannot be read as VTK")
    );
}

#[test]
fn quadratic_cells_given_clockwise_are_turned_with_their_middles() {
    let turned = counter_clockwise(CellShape::Triangle6, vec![0, 2, 1, 5, 4, 3], &SIX);
    assert_eq!(turned, [0, 1, 2, 3, 4, 5]);
    assert_eq!(
        counter_clockwise(CellShape::Triangle6, turned.clone(), &SIX),
        turned
    );
}

/// Two steps of a view of vectors, in the format of both versions; the second lacks a node.
const VIEW: &str = "$NodeData\n1\n\"displacement [cm]\"\n1\n0.5\n3\n0\n3\n4\n1 0 0 0\n2 0.1 0 0\n3 0.1 -0.05 0\n5 0 -0.05 0\n$EndNodeData\n\
$NodeData\n1\n\"displacement [cm]\"\n1\n1.0\n3\n1\n3\n3\n1 0 0 0\n2 0.2 0 0\n3 0.2 NaN 0\n$EndNodeData\n\
$NodeData\n1\n\"temperature\"\n1\n0.5\n3\n0\n1\n1\n1 300\n$EndNodeData\n";

#[test]
fn views_of_gmsh_are_fields_with_their_times() {
    for mesh in [VERSION_2, VERSION_4] {
        let (_folder, path) = with("a.msh", &format!("{mesh}{VIEW}"));
        let series = import_series(&path, 1.0, None).unwrap();
        assert_eq!(series.steps.len(), 2);
        assert_eq!(series.steps[0].time, Some(0.5));
        let first = &series.steps[0].displacement;
        assert_eq!(first[..6], [0.0, 0.0, 1.0, 0.0, 1.0, -0.5]);
        let second = &series.steps[1];
        assert_eq!(second.displacement[2..4], [2.0, 0.0]);
        assert!(second.displacement[4..].iter().all(|u| u.is_nan()));
        let error = import_field(&path, 1.0, None, 1.0).unwrap_err().to_string();
        assert!(
            error.contains("of the node 3 that is not a number"),
            "{error}"
        );
        let chosen = import_field(&path, 1.0, None, 0.5).unwrap();
        assert_eq!(chosen.displacement, *first);
    }
    let (_folder, path) = with("a.msh", VERSION_2);
    let error = import_series(&path, 1.0, None).unwrap_err().to_string();
    assert!(error.contains("no vectors"), "{error}");
}

#[test]
fn collections_name_their_files_and_times() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("all.pvd");
    let of = |text: &str| {
        fs::write(&path, text).unwrap();
        import_series(&path, 1.0, None)
    };
    let step = |time: f64, file: &str| {
        format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>")
    };
    let list = |steps: &str| {
        format!(
            "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>{steps}</Collection></VTKFile>"
        )
    };
    let view = VIEW.split("$NodeData").nth(1).unwrap();
    fs::write(
        folder.path().join("a&b.msh"),
        format!("{VERSION_2}$NodeData{view}"),
    )
    .unwrap();
    let series = of(&list(
        &(step(1.0, "a&amp;b.msh") + &step(2.5, "a&amp;b.msh")),
    ))
    .unwrap();
    let times: Vec<_> = series.steps.iter().map(|step| step.time).collect();
    assert_eq!(times, [Some(1.0), Some(2.5)]);
    for (text, reason) in [
        (list(""), "names no files"),
        (
            list(&step(1.0, "none.vtu")),
            "names none.vtu, which cannot be read",
        ),
        (
            list("<DataSet file=\"x\"/>"),
            "a DataSet without `timestep`",
        ),
        (list(&step(1.0, "all.pvd")), "as one of its files"),
    ] {
        let error = of(&text).unwrap_err();
        assert!(error.to_string().contains(reason), "{error}");
    }
}

#[test]
fn groups_of_cells_and_of_lines_on_the_sheet_are_kept_as_nodes() {
    let nodes: String = (0..16)
        .map(|node| format!("{} {} {} 0\n", node + 1, node % 4, node / 4))
        .collect();
    let cell = |i: usize, j: usize| {
        let first = 4 * j + i + 1;
        [first, first + 1, first + 5, first + 4]
    };
    let words =
        |nodes: &[usize]| -> String { nodes.iter().map(|node| format!(" {node}")).collect() };
    let (mut elements, mut count) = (String::new(), 0);
    let mut add = |kind: &str, nodes: &[usize]| {
        count += 1;
        elements += &format!("{count} {kind}{}\n", words(nodes));
    };
    for (i, j) in (0..9).map(|cell| (cell % 3, cell / 3)) {
        let physical = if (i, j) == (1, 1) { 8 } else { 9 };
        add(&format!("3 2 {physical} 1"), &cell(i, j));
    }
    let middle = cell(1, 1);
    (0..4).for_each(|side| add("1 2 7 1", &[middle[side], middle[(side + 1) % 4]]));
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 7 \"ring\"\n2 8 \"pad\"\n2 9 \"sheet\"\n$EndPhysicalNames\n\
         $Nodes\n16\n{nodes}$EndNodes\n$Elements\n{count}\n{elements}$EndElements\n"
    );
    let (_folder, path) = with("a.msh", &text);
    let (mesh, warnings) = import(&path, MeshReading::in_unit(1.0)).unwrap();
    for name in ["ring", "pad"] {
        let group = &mesh.groups()[name];
        assert_eq!(group.nodes, [5, 6, 9, 10], "{name}");
        assert!(group.edges.is_empty());
    }
    assert_eq!(mesh.groups()["ring"].lines.len(), 4);
    assert_eq!(mesh.groups()["pad"].cells.len(), 1);
    assert_eq!(mesh.groups()["sheet"].nodes.len(), 16);
    assert!(
        warnings[0].to_string().contains("supports act on them"),
        "{warnings:?}"
    );
    let finer = mesh.refined();
    assert_eq!(finer.groups()["pad"].nodes.len(), 9);
    assert_eq!(finer.groups()["pad"].cells.len(), 4);
    assert_eq!(finer.groups()["ring"].nodes.len(), 8);
    // A surface of the name of a side of the box, or of a curve: the file's own names count, all of them.
    let text = text.replace("\"pad\"", "\"left\"");
    let sides = read("a.msh", &text).unwrap();
    assert_eq!(sides.groups()["left"].nodes, [5, 6, 9, 10]);
    let text = text.replace("\"left\"", "\"ring\"");
    let both = read("a.msh", &text).unwrap();
    let ring = &both.groups()["ring"];
    assert_eq!([ring.lines.len(), ring.cells.len()], [4, 1]);
    let merged = read("a.msh", &text.replace("3 2 8 1", "3 2 9 1")).unwrap();
    assert_eq!(merged.groups()["sheet"].cells.len(), merged.cell_count());
}
