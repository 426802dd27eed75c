//! What the reader of Abaqus' files takes, and what it refuses.

use super::*;

const TWO: &str = "*HEADING\nA strip\n** made by hand\n*Part, name=strip\n*Node, nset=ALL\n1, 0., 0.\n 2, 1D1, 0.\n3, 20., 0., 0.\n\
    4, 0., 10.\n5, 10., 10.\n6, 20., 10.\n*Element, type=CPS4R, elset=left half\n1, 1, 2, 5, 4\n*ELEMENT, TYPE=CPE3H\n2, 2, 3,\n6\n\
    3, 2, 6, 5\n*Nset, nset=bottom, generate\n1, 3, 1\n*Nset, nset=lower\nbottom\n*Elset, elset=\"right\"\n2, 3\n*End Part\n\
    *Boundary\nlower, 1, 2\n";

#[test]
fn nodes_elements_and_sets_are_read() {
    let raw = read(TWO).unwrap();
    assert_eq!(raw.positions.len(), 6);
    assert_eq!(raw.positions[&2], [10.0, 0.0, 0.0]);
    assert_eq!(raw.cells[0], (CellShape::Quad4, vec![1, 2, 5, 4]));
    assert_eq!(raw.cells[1], (CellShape::Triangle3, vec![2, 3, 6]));
    assert_eq!(raw.areas["left half"], [0]);
    assert_eq!(raw.areas["right"], [1, 2]);
    assert_eq!(raw.sets["bottom"], [1, 2, 3]);
    assert_eq!(raw.sets["lower"], [1, 2, 3]);
    assert_eq!(raw.sets["ALL"].len(), 6);
    let mesh = raw.mesh(1.0).unwrap();
    assert_eq!(
        (mesh.cell_count(), mesh.groups()["bottom"].edges.len()),
        (3, 2)
    );
}

#[test]
fn what_is_no_sheet_is_refused_with_its_line() {
    for (text, reason) in [
        ("*ELEMENT, TYPE=C3D8\n", "line 1: elements of the type C3D8"),
        ("*ELEMENT\n", "line 1: *ELEMENT without TYPE=NAME"),
        ("*NODE\n1, 0\n", "line 2: 2 fields"),
        ("*NODE\n1, 0, a\n", "line 2: \"a\" where a number should be"),
        ("*NODE\n1, 0, 0\n1, 0, 0\n", "line 3: the node 1 once more"),
        (
            "*ELEMENT, TYPE=CPS3\n1, 1, 2\n",
            "line 2: the element 1 has 2 nodes instead of 3",
        ),
        (
            "*NSET, NSET=a, GENERATE\n1, 99999999999, 1\n",
            "line 2: a range",
        ),
        ("*NSET, NSET=a\nb\n", "neither a number nor a set"),
        ("*INCLUDE, INPUT=mesh.inp\n", "*INCLUDE names another file"),
    ] {
        let error = read(text).err().unwrap().to_string();
        assert!(error.contains(reason), "{error}");
    }
}

/// A square of a part, and what the file says of its instances.
fn square(assembly: &str) -> String {
    format!(
        "*PART, NAME=Sheet\n*NODE\n1, 1., 0.\n2, 3., 0.\n3, 3., 2.\n4, 1., 2.\n*ELEMENT, TYPE=CPS4\n1, 1, 2, 3, 4\n*END PART\n\
         *PART, NAME=tool\n*NODE\n9, 0., 0.\n*END PART\n*ASSEMBLY, NAME=all\n{assembly}*END ASSEMBLY\n"
    )
}

fn instance(lines: &str) -> String {
    square(&format!(
        "*INSTANCE, NAME=tool-1, PART=tool\n7., 7., 0.\n*END INSTANCE\n*INSTANCE, NAME=Sheet-1, PART=sheet\n{lines}*END INSTANCE\n*NODE\n8, 1., 1.\n"
    ))
}

#[test]
fn an_instance_is_moved_and_then_turned() {
    for (lines, first, third) in [
        ("", [1.0, 0.0, 0.0], [3.0, 2.0, 0.0]),
        ("100., 50., 0.\n", [101.0, 50.0, 0.0], [103.0, 52.0, 0.0]),
        ("0., 5., 2\n", [1.0, 5.0, 2.0], [3.0, 7.0, 2.0]),
        (
            "0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n",
            [0.0, 1.0, 0.0],
            [-2.0, 3.0, 0.0],
        ),
        // The axis goes through (10, 0) and down.
        (
            "10., , \n10., 0., 1., 10., 0., 0., 90.\n",
            [10.0, -1.0, 0.0],
            [12.0, -3.0, 0.0],
        ),
    ] {
        let raw = read(&instance(lines)).unwrap();
        assert_eq!(
            [raw.positions[&1], raw.positions[&3]],
            [first, third],
            "{lines}"
        );
        // Points of the assembly are where they are; the mesh of the tool is none.
        assert_eq!(raw.positions[&8], [1.0, 1.0, 0.0]);
    }
    let turned = instance("0., 0., 0.\n0., 0., 0., 0., 0., 1., 30.\n");
    let [x, y, _] = read(&turned).unwrap().positions[&1];
    assert!((x - 0.75_f64.sqrt()).abs() < 1e-15 && (y - 0.5).abs() < 1e-15);
}

#[test]
fn what_places_no_sheet_is_refused_with_its_line() {
    let two = "*INSTANCE, NAME=a, PART=Sheet\n*END INSTANCE\n*INSTANCE, NAME=b, PART=Sheet\n40., 0., 0.\n*END INSTANCE\n";
    for (text, reason) in [
        (
            square(two),
            "line 17: the instance `b` is a mesh beside that of the instance `a`",
        ),
        (
            instance("0., 0., 0.\n0., 0., 0., 1., 0., 0., 90.\n"),
            "line 20: the instance `Sheet-1` is turned about an axis that is not along z",
        ),
        (
            instance("1., 2., 3., 4.\n"),
            "line 19: 4 numbers place the instance",
        ),
        (
            "*NODE, SYSTEM=C\n1, 1., 90.\n".to_owned(),
            "line 1: *NODE with SYSTEM=C",
        ),
        (
            "*SYSTEM\n100., 50., 0.\n*NODE\n1, 0., 0.\n".to_owned(),
            "line 2: *SYSTEM",
        ),
        ("*NMAP, NSET=a\n".to_owned(), "line 1: *NMAP"),
    ] {
        let error = read(&text).err().unwrap().to_string();
        assert!(error.contains(reason), "{error}");
    }
    // A system of its own that ends before the nodes, and x, y and z by name.
    let plain = "*SYSTEM\n*NODE, SYSTEM=R\n1, 1., 90.\n";
    assert_eq!(read(plain).unwrap().positions[&1], [1.0, 90.0, 0.0]);
}
