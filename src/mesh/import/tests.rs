//! Meshes of other programs.

use std::fs;
use std::path::PathBuf;

use super::*;

fn with(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    (folder, path)
}

fn read(name: &str, text: &str) -> Result<Mesh, String> {
    let (_folder, path) = with(name, text);
    import(&path, 10.0)
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
fn what_cannot_be_read_is_refused_by_name() {
    for (text, reason) in [
        (VERSION_2.replace("2.2 0 8", "2.2 1 8"), "binary"),
        (VERSION_2.replace("2.2 0 8", "3.0 0 8"), "has the format 3"),
        (
            VERSION_2.replace("2 2 2 9 1 1 3 2", "2 4 2 9 1 1 3 2 5"),
            "Gmsh's type 4",
        ),
        (VERSION_2.replace("3 1 1 0\n", "3 1 1 0.5\n"), "is not flat"),
        (
            VERSION_2.replace("3 1 1 0\n", "3 1 x 0\n"),
            "has \"x\" in $Nodes",
        ),
        (
            VERSION_2.replace("1 1 3 5\n", "1 1 3 6\n"),
            "the node 6, which it does not hold",
        ),
        (
            VERSION_2.replace("3 1 1 0\n", "3 0.5 0 0\n"),
            "has a folded cell",
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
        let found = read("a.msh", &text).unwrap_err();
        assert!(found.contains(reason), "{found}");
    }
    assert!(read("a.stl", "").unwrap_err().contains("is no .msh"));
    assert!(
        read("a.vtu", "nothing")
            .unwrap_err()
            .contains("cannot be read as VTK")
    );
}

#[test]
fn quadratic_cells_given_clockwise_are_turned_with_their_middles() {
    let nodes = [
        [0.0, 0.0],
        [2.0, 0.0],
        [0.0, 2.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
    ];
    let turned = counter_clockwise(CellShape::Triangle6, vec![0, 2, 1, 5, 4, 3], &nodes);
    assert_eq!(turned, [0, 1, 2, 3, 4, 5]);
    assert_eq!(
        counter_clockwise(CellShape::Triangle6, turned.clone(), &nodes),
        turned
    );
}
