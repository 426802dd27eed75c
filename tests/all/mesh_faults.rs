//! What is said of faulty meshes, and what is done with sound ones however they are written.

use std::fs;
use std::sync::Arc;

use gelbench::budget::Budget;
use gelbench::kinds::{kind_of, read_as};
use gelbench::material::NeoHooke;
use gelbench::mesh::{CellShape, Mesh, MeshReading, Shape, import};
use gelbench::problem::{BoundaryProblem, Support};
use gelbench::solve::NewtonSettings;
use gelbench::studies::Progress;

use crate::common::mesh_files::{KINDS, MeshFile};
use crate::common::{folder_with, gelbench, one_line, words};

/// A study of a strip from a file, with more keys of its specimen.
fn study(more: &str) -> String {
    format!(
        "kind = \"specimen\"\ntitle = \"strip\"\n[material]\ncard = \"neo-hooke\"\n\
         [specimen]\nshape = \"mesh\"\nfile = \"strip.msh\"\nfile_unit = \"mm\"\nthickness = \"1 mm\"\n{more}\n\
         [path]\nfactors = [1.0]\nmeasured_group = \"left\"\n\
         [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
         [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"0.4 mm\"\ny = \"0 mm\"\n\
         [tolerances]\ndisplacement = \"9 %\"\nforce = \"9 %\"\ncorrection = \"1 %\"\n"
    )
}

/// What `gelbench` says of a mesh, in one line.
fn output_text(file: &MeshFile, more: &str, arguments: &[&str], code: i32) -> String {
    let folder = folder_with(&study(more));
    fs::write(folder.path().join("strip.msh"), file.msh()).unwrap();
    let done = gelbench(folder.path(), arguments).code(code);
    one_line(&done.get_output().stderr)
}

const CHECK: [&str; 2] = ["check", "small.toml"];

/// Four squares by two, whose right half has nodes of its own at X = 2.
fn with_seam() -> MeshFile {
    let mut file = MeshFile::squares([4, 2]);
    file.nodes.extend([[2.0, 0.0], [2.0, 1.0], [2.0, 2.0]]);
    for node in file.cells[4..].iter_mut().flatten() {
        if (6..9).contains(node) {
            *node += 9;
        }
    }
    file
}

/// Meshes with one fault each: what is told, where, and what to do about it.
fn faulty() -> Vec<(&'static str, MeshFile, [&'static str; 2])> {
    let strip = || MeshFile::squares([4, 2]);
    let with = |change: &dyn Fn(&mut MeshFile)| {
        let mut file = strip();
        change(&mut file);
        file
    };
    vec![
        (
            "hanging node",
            with(&|file| {
                file.nodes.extend([[3.0, 0.5], [4.0, 0.5]]);
                file.cells[6] = vec![9, 12, 16, 15];
                file.cells.push(vec![15, 16, 13, 10]);
            }),
            [
                "one node hangs on a cell's side without being its node, near (3, 0.5) mm",
                "divide the larger cell",
            ],
        ),
        (
            "cells given twice",
            with(&|file| {
                let again: Vec<_> = file.cells[2..4].to_vec();
                file.cells.extend(again);
            }),
            [
                "2 cells are given twice, near (1.5, 0.5), (1.5, 1.5) mm",
                "write each cell once",
            ],
        ),
        (
            "seam",
            with_seam(),
            [
                "2 sides lie on another cell's without sharing its nodes",
                "merge_nodes",
            ],
        ),
        (
            "unattached part",
            with(&|file| {
                file.nodes.extend([[1.0, 3.0], [2.0, 3.0], [2.0, 4.0]]);
                file.cells.push(vec![15, 16, 17]);
            }),
            ["2 parts are not attached to each other", "allow \"parts\""],
        ),
        (
            "hinge",
            with(&|file| {
                file.nodes.extend([[5.0, 2.0], [5.0, 3.0]]);
                file.cells.push(vec![14, 15, 16]);
            }),
            [
                "one node alone joins cells on both sides of it: a hinge, near (4, 2) mm",
                "allow \"hinges\"",
            ],
        ),
        (
            "cell without area",
            with(&|file| file.cells.push(vec![0, 1, 2])),
            ["one cell has no area, near (0, 1) mm", "remove the cell"],
        ),
        (
            "inverted cell",
            with(&|file| file.cells[5] = vec![7, 10, 8, 11]),
            [
                "one cell is turned inside out",
                "must be in order around it",
            ],
        ),
        (
            "three cells at a side",
            with(&|file| file.cells.push(vec![6, 9, 10])),
            ["overlap: two on the same side", "remove one of the cells"],
        ),
        (
            "overlapping cells",
            with(&|file| {
                file.nodes.extend([[3.7, 0.7], [5.0, 0.3]]);
                file.cells.push(vec![12, 16, 15]);
            }),
            [
                "one place is covered by two cells, which overlap, near (3.7, 0.7) mm",
                "remove cells that lie on other cells",
            ],
        ),
    ]
}

#[test]
fn check_names_every_fault_with_place_and_remedy() {
    for (name, file, expected) in faulty() {
        let actual = output_text(&file, "", &CHECK, 2);
        for expected in expected {
            assert!(actual.contains(expected), "{name}: {actual}");
        }
    }
    output_text(&MeshFile::squares([4, 2]), "", &CHECK, 0);
}

#[test]
fn no_command_computes_on_a_faulty_mesh() {
    for arguments in [
        &["run", "small.toml", "--output", "out"][..],
        &[
            "export",
            "small.toml",
            "--to",
            "calculix",
            "--output",
            "strip.inp",
        ],
        &["compare", "small.toml", "strip.msh"],
        &[
            "correct",
            "strip.csv",
            "--material",
            "neo-hooke",
            "--thickness",
            "1 mm",
            "--mesh",
            "strip.msh",
        ],
    ] {
        let folder = folder_with(&study(""));
        fs::write(folder.path().join("strip.msh"), with_seam().msh()).unwrap();
        let markers =
            (0..=8).flat_map(|i| (0..=4).map(move |j| [0.5 * f64::from(i), 0.5 * f64::from(j)]));
        let markers = markers.map(|[x, y]| format!("{x},{y},{},{}\n", 0.1 * x, -0.05 * y));
        let markers = format!(
            "x [mm],y [mm],ux [mm],uy [mm]\n{}",
            markers.collect::<String>()
        );
        fs::write(folder.path().join("strip.csv"), markers).unwrap();
        let done = gelbench(folder.path(), arguments).code(2);
        let actual = words(&done.get_output().stderr);
        assert!(
            actual.contains("2 sides lie on another cell's"),
            "{arguments:?}: {actual}"
        );
    }
}

#[test]
fn seams_are_merged_or_allowed_where_one_wants_it() {
    output_text(&with_seam(), "merge_nodes = \"1e-6 mm\"", &CHECK, 0);
    let seams = output_text(&with_seam(), "allowed = [\"seams\"]", &CHECK, 2);
    assert!(seams.contains("2 parts are not attached"), "{seams}");
    let unknown = output_text(&with_seam(), "allowed = [\"seam\"]", &CHECK, 2);
    assert!(unknown.contains("\"seam\" is not known here"), "{unknown}");
    // A tolerance beyond the cells' size makes them nothing.
    let coarse = output_text(&with_seam(), "merge_nodes = \"3 mm\"", &CHECK, 2);
    assert!(
        coarse.contains("no area") || coarse.contains("inside out"),
        "{coarse}"
    );
}

#[test]
fn an_empty_file_name_is_an_error_and_a_polygon_a_warning() {
    let folder = folder_with(&study("").replace("strip.msh", ""));
    let done = gelbench(folder.path(), &CHECK).code(2);
    assert!(words(&done.get_output().stderr).contains("must name a mesh"));
    let hole = Shape::StripWithHole {
        size: [6.0, 3.0],
        radius: 0.6,
    };
    let file = MeshFile::of(&hole.mesh(4, CellShape::Quad4));
    let actual = output_text(&file, "", &CHECK, 0);
    assert!(
        actual.contains("the boundary `hole` is a polygon"),
        "{actual}"
    );
    let meant = output_text(&file, "allowed = [\"polygons\"]", &CHECK, 0);
    assert_eq!(meant, "");
    let actual = output_text(
        &MeshFile::of(&hole.mesh(4, CellShape::Quad8)),
        "",
        &CHECK,
        0,
    );
    assert!(!actual.contains("polygon"), "{actual}");
}

/// The force in N on the group `right`, which moves by a vector against the group `left`.
fn force(mesh: &Mesh, direction: [f64; 2]) -> [f64; 2] {
    let support = |group: &str, [x, y]: [f64; 2]| {
        (group.to_owned(), Support::Displacement([Some(x), Some(y)]))
    };
    let problem = BoundaryProblem {
        thickness: 1.0,
        law: Arc::new(NeoHooke { c10: 0.05 }),
        regions: Vec::new(),
        supports: vec![support("held", [0.0; 2]), support("moved", direction)],
        loads: Vec::new(),
    };
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).unwrap();
    let newton = NewtonSettings {
        tolerance: 1e-12,
        max_iterations: 40,
    };
    let states = model.solve(&[1.0], newton, &|_| ());
    model.reaction(&states.ok().unwrap()[0], "moved")
}

fn read(name: &str, text: &str, unit: f64) -> Mesh {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    import(&path, MeshReading::in_unit(unit)).unwrap().0
}

/// Half of the numbers go up, half of them down, so that none stays.
fn shuffled(file: &MeshFile) -> MeshFile {
    let count = file.nodes.len();
    let new = |node: usize| {
        if node.is_multiple_of(2) {
            node / 2
        } else {
            count - 1 - node / 2
        }
    };
    let mut nodes = vec![[0.0; 2]; count];
    for (node, position) in file.nodes.iter().enumerate() {
        nodes[new(node)] = *position;
    }
    let renamed = |entry: &Vec<usize>| entry.iter().map(|node| new(*node)).collect::<Vec<_>>();
    MeshFile {
        nodes,
        cells: file.cells.iter().rev().map(renamed).collect(),
        lines: file
            .lines
            .iter()
            .map(|(name, entry)| (name.clone(), renamed(entry)))
            .collect(),
    }
}

#[test]
fn the_same_mesh_in_other_numbers_places_and_units_has_the_same_force() {
    let hole = Shape::StripWithHole {
        size: [6.0, 3.0],
        radius: 0.8,
    };
    for kind in KINDS {
        let mut file = MeshFile::of(&hole.mesh(2, kind));
        for (name, _) in &mut file.lines {
            // Names that a turned mesh's own sides do not have.
            *name = name.replace("left", "held").replace("right", "moved");
        }
        let direction = [0.6, 0.2];
        let expected = force(&read("a.msh", &file.msh(), 1.0), direction);
        let size = expected[0].hypot(expected[1]);
        let same = |what: &str, actual: [f64; 2], expected: [f64; 2]| {
            let error = (actual[0] - expected[0]).hypot(actual[1] - expected[1]) / size;
            assert!(error < 1e-9, "{kind:?}, {what}: {error}");
        };
        let moved = |map: &dyn Fn([f64; 2]) -> [f64; 2]| MeshFile {
            nodes: file.nodes.iter().map(|position| map(*position)).collect(),
            ..file.clone()
        };
        same(
            "numbers",
            force(&read("a.msh", &shuffled(&file).msh(), 1.0), direction),
            expected,
        );
        let far = moved(&|[x, y]| [x + 100.0, y - 30.0]);
        same(
            "translated",
            force(&read("a.msh", &far.msh(), 1.0), direction),
            expected,
        );
        let (sine, cosine) = 0.7_f64.sin_cos();
        let turn = |[x, y]: [f64; 2]| [cosine * x - sine * y, sine * x + cosine * y];
        same(
            "turned",
            force(&read("a.msh", &moved(&turn).msh(), 1.0), turn(direction)),
            turn(expected),
        );
        // The cells of the mirrored mesh go around clockwise.
        let mirror = |[x, y]: [f64; 2]| [-x, y];
        let mirrored = force(
            &read("a.msh", &moved(&mirror).msh(), 1.0),
            mirror(direction),
        );
        same("mirrored", mirrored, mirror(expected));
        let metres = moved(&|position| position.map(|x| 1e-3 * x));
        same(
            "in metres",
            force(&read("a.msh", &metres.msh(), 1e3), direction),
            expected,
        );
        let mut other = read("a.vtu", &file.vtu(), 1.0);
        other.name_boundary("held", |[x, _]| x.abs() < 1e-9);
        other.name_boundary("moved", |[x, _]| (x - 6.0).abs() < 1e-9);
        same("as .vtu", force(&other, direction), expected);
    }
}

/// What is computed of a mesh of eight squares where so many cells are allowed, and what is warned of.
fn within(cells: f64) -> (String, Vec<String>) {
    let folder = folder_with("");
    fs::write(
        folder.path().join("strip.msh"),
        MeshFile::squares([4, 2]).msh(),
    )
    .unwrap();
    let text = study("");
    let case = kind_of("small.toml", &text).unwrap().unwrap();
    let budget = Budget {
        cells,
        ..Budget::USUAL
    };
    let ready = read_as(case, &folder.path().join("small.toml"), &text, budget);
    let results = ready.unwrap().compute(Progress::silent()).unwrap();
    (format!("{:?}", results.report()), results.read_warnings)
}

#[test]
fn a_mesh_that_cannot_be_halved_twice_is_halved_less_and_that_is_told() {
    let (report, warnings) = within(128.0);
    assert!(report.contains("on 128 cells, the finest of three meshes"));
    assert_eq!(warnings, [""; 0]);
    let (report, warnings) = within(127.0);
    assert!(report.contains("on 32 cells, the finer of two meshes"));
    assert!(
        warnings[0].contains("needs about 128 cells, and 127 are allowed: the finite elements are computed on two meshes"),
        "{warnings:?}"
    );
    let (report, warnings) = within(8.0);
    assert!(report.contains("on 8 cells") && !report.contains("meshes;"));
    assert!(
        warnings[0].contains("computed on this mesh alone"),
        "{warnings:?}"
    );
}
