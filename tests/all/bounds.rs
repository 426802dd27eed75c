//! What asks for too much, measures what nothing measures, or is no file: refused before anything is built, with the estimate,
//! the key and the remedy.

use std::fs;
use std::time::{Duration, Instant};

use gelbench::budget::Budget;
use gelbench::markers::ReadSettings;
use gelbench::mesh::CellShape;
use gelbench::studies::markers::{Conditions, MarkerStudy, MeshSource, Request};
use tempfile::TempDir;

use crate::common::{gelbench, one_line, root};

/// A study of the examples with some keys changed.
fn study(name: &str, changes: &[(&str, &str)]) -> String {
    let text = fs::read_to_string(root().join("examples").join(name)).unwrap();
    let changed = |text: String, (key, value): &(&str, &str)| {
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let begin = format!("{key} =");
        let line = lines.iter_mut().find(|line| line.starts_with(&begin));
        *line.unwrap_or_else(|| panic!("{name} has no {key}")) = format!("{key} = {value}");
        lines.join("\n")
    };
    changes.iter().fold(text, changed)
}

/// What a command says about a file beside it; it must be done soon.
fn output_text(file: &str, text: &str, arguments: &[&str], code: i32) -> String {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join(file), text).unwrap();
    let start = Instant::now();
    let done = gelbench(folder.path(), arguments).code(code);
    assert!(start.elapsed() < Duration::from_secs(30), "{arguments:?}");
    let output = done.get_output();
    one_line(&output.stderr) + " " + &one_line(&output.stdout)
}

#[test]
fn too_large_studies_are_refused_with_key_estimate_and_remedy() {
    let stretches: Vec<String> = (1..30_000).map(|i| format!("{}e-5", i)).collect();
    let many = format!("[load]\nstretches = [{}]\n", stretches.join(","));
    let cases = [
        (
            study("strip_with_hole.toml", &[("length", "\"100 m\"")]),
            ["specimen.cells", " cells, and 1,000,000 are allowed"],
        ),
        (
            study("dog_bone.toml", &[("cells", "400")]),
            ["specimen.cells", " cells, and 1,000,000"],
        ),
        (
            "[plate]\ncells = [6000, 2000]\n".to_owned(),
            ["plate.cells", "12,000,000 cells"],
        ),
        (
            "[finite_element]\ncells = [4000, 1200]\n".to_owned(),
            ["finite_element.cells", "4,800,000 cells"],
        ),
        (
            many,
            ["load.stretches", "29,999 instants, and 20,000 are allowed"],
        ),
        (
            study(
                "released_plate.toml",
                &[("interval", "\"1e-4 s\""), ("duration", "\"5 s\"")],
            ),
            ["time.interval", "50,000 instants"],
        ),
        (
            study("released_plate.toml", &[("step", "\"1e-9 s\"")]),
            ["time.step", "143,000,000 time steps"],
        ),
        (
            study(
                "released_plate.toml",
                &[
                    ("density", "\"2e-6 kg/m³\""),
                    ("duration", "\"10 s\""),
                    ("interval", "\"1 s\""),
                ],
            ),
            ["time.step", "time steps"],
        ),
        (
            study(
                "released_plate.toml",
                &[
                    ("duration", "\"1000 s\""),
                    ("interval", "\"1 s\""),
                    ("step", "\"1 s\""),
                ],
            ),
            ["corrector.enabled", "bytes of memory"],
        ),
    ];
    for (text, parts) in cases {
        let printed = output_text("s.toml", &text, &["check", "s.toml"], 2);
        for part in parts.iter().chain(&["--allow-large"]) {
            assert!(printed.contains(part), "{part}: {printed}");
        }
    }
}

#[test]
fn a_motion_that_turns_out_to_take_too_many_steps_ends_at_once() {
    let stiff = "\n[mass_spring.stiffness]\nkind = \"polynomial\"\ncoefficients = [\"1e9 MPa\"]\n";
    let text = study("released_plate.toml", &[]) + stiff;
    let printed = output_text("s.toml", &text, &["run", "s.toml"], 3);
    for part in ["steps of at most", "1.0e7 are allowed", "softer springs"] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
}

#[test]
fn more_markers_than_memory_holds_are_refused_with_estimate_and_remedy() {
    let correct = |bytes: f64| {
        let request = Request {
            files: vec![root().join("examples/measured_plate.csv")],
            reading: ReadSettings::default(),
            images: Default::default(),
            material: "pva-10".into(),
            thickness: 2.0,
            mesh: MeshSource::Data,
            cell_size: Some(20.0),
            shape: CellShape::Triangle3,
            holes: false,
            conditions: Conditions::default(),
            forces: None,
            budget: Budget {
                bytes,
                ..Budget::USUAL
            },
        };
        MarkerStudy::prepare(request, &|_| ())
            .err()
            .map(|fault| fault.to_string())
    };
    let printed = correct(1e6).unwrap();
    for part in [
        "a field of ",
        " markers needs about 2,",
        "use every other marker",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    assert_eq!(correct(8e6), None);
}

#[test]
fn large_studies_pass_where_one_says_so_and_impossible_ones_never() {
    let text = "[plate]\ncells = [6000, 2000]\n";
    let printed = output_text("s.toml", text, &["check", "s.toml", "--allow-large"], 0);
    assert!(printed.contains("no faults"), "{printed}");
    for command in [
        &["run", "s.toml"][..],
        &["export", "s.toml", "--to", "abaqus"],
        &["compare", "s.toml", "s.toml"],
    ] {
        let printed = output_text("s.toml", text, command, 2);
        assert!(
            printed.contains("or use --allow-large"),
            "{command:?}: {printed}"
        );
    }
    let text = study(
        "released_plate.toml",
        &[
            ("step", "\"1e-12 s\""),
            ("duration", "\"1e6 s\""),
            ("interval", "\"1e3 s\""),
        ],
    );
    let printed = output_text("s.toml", &text, &["check", "s.toml", "--allow-large"], 2);
    assert!(
        printed.contains("time steps") && !printed.contains("--allow-large"),
        "{printed}"
    );
}

#[test]
fn sizes_lie_between_a_nanometre_and_a_kilometre() {
    for length in [
        "4294967296 mm",
        "1e150 mm",
        "1e-60 mm",
        "1e-300 mm",
        "0.1 nm",
    ] {
        let text = study("dog_bone.toml", &[("length", &format!("\"{length}\""))]);
        let printed = output_text("s.toml", &text, &["check", "s.toml"], 2);
        assert!(
            printed.contains("specimen.length") && printed.contains(length),
            "{length}: {printed}"
        );
    }
    let text = study("dog_bone.toml", &[("thickness", "\"1e-60 mm\"")]);
    let printed = output_text("s.toml", &text, &["check", "s.toml"], 2);
    assert!(printed.contains("specimen.thickness"), "{printed}");
    let text = study("strip_with_hole.toml", &[("hole_diameter", "\"2 nm\"")]);
    let printed = output_text("s.toml", &text, &["check", "s.toml"], 2);
    assert!(
        printed.contains("differ by a factor of more than 100,000"),
        "{printed}"
    );
}

/// A grid of markers on a strip, its lengths times a factor.
fn grid(factor: &str) -> String {
    let mut text = "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned();
    for (i, j) in (0..8).flat_map(|i| (0..5).map(move |j| (i, j))) {
        text += &format!(
            "{}{factor},{}{factor},{}{factor},{}{factor}\n",
            10 * i,
            10 * j,
            i,
            -0.3 * f64::from(j)
        );
    }
    text
}

#[test]
fn markers_and_outlines_measure_what_specimens_do() {
    let usual = ["--material", "pva-10", "--thickness", "2 mm"];
    for factor in ["e-50", "e70", "e20", "e-20"] {
        let printed = output_text(
            "m.csv",
            &grid(factor),
            &[&["correct", "m.csv"], &usual[..]].concat(),
            2,
        );
        assert!(
            printed.contains("must measure 1 nm to 1 km"),
            "{factor}: {printed}"
        );
    }
    for corners in ["0,0\n1e12,0\n1e12,1e-3\n", "0,0\n1e-50,0\n0,1e-50\n"] {
        let field = root().join("examples/measured_plate.csv");
        let outline = format!("x [mm],y [mm]\n{corners}");
        let more = ["correct", field.to_str().unwrap(), "--outline", "o.csv"];
        let printed = output_text("o.csv", &outline, &[&more[..], &usual].concat(), 2);
        assert!(
            printed.contains("must measure 1 nm to 1 km"),
            "{corners}: {printed}"
        );
    }
    let many = [&["correct", "m.csv", "--cell-size", "50 um"], &usual[..]].concat();
    let printed = output_text("m.csv", &grid(""), &many, 2);
    assert!(
        printed.contains("cells, and 1,000,000 are allowed")
            && printed.contains("choose a larger --cell-size, or use --allow-large"),
        "{printed}"
    );
}

#[test]
fn a_field_on_one_cell_is_corrected() {
    let cell = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0\n10 0 0\n10 10 0\n0 10 0\n\
                CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\nPOINT_DATA 4\nVECTORS u float\n0 0 0\n1 0 0\n1 0 0\n0 0 0\n";
    let printed = output_text(
        "one.vtk",
        cell,
        &[
            "correct",
            "one.vtk",
            "--material",
            "pva-10",
            "--thickness",
            "1 mm",
        ],
        0,
    );
    assert!(printed.contains("files in"), "{printed}");
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_by_every_reader() {
    let folder = TempDir::new().unwrap();
    for ending in ["toml", "csv", "msh", "vtu", "vtk", "pvd", "frd"] {
        let link = folder.path().join(format!("zero.{ending}"));
        std::os::unix::fs::symlink("/dev/zero", link).unwrap();
    }
    let markers = root().join("examples/measured_plate.csv");
    let markers = markers.to_str().unwrap();
    let bone = root().join("examples/dog_bone.toml");
    let bone = bone.to_str().unwrap();
    let sheet = ["--material", "pva-10", "--thickness", "2 mm"];
    let mut commands: Vec<Vec<&str>> = vec![
        vec!["check", "zero.toml"],
        vec!["run", "zero.toml"],
        vec!["identify", "zero.csv"],
        vec!["materials", "fit", "zero.csv", "--law", "yeoh"],
        vec!["materials", "show", "zero.toml"],
        vec!["compare", bone, "zero.csv"],
        vec!["compare", bone, "zero.vtu"],
        vec![
            "correct",
            markers,
            "--material",
            "zero.toml",
            "--thickness",
            "2 mm",
        ],
        [&["correct", markers, "--study", "zero.toml"], &sheet[..]].concat(),
        [&["correct", markers, "--outline", "zero.csv"], &sheet[..]].concat(),
        [&["correct", markers, "--mesh", "zero.msh"], &sheet[..]].concat(),
    ];
    let fields = [
        "zero.csv", "zero.msh", "zero.vtu", "zero.vtk", "zero.pvd", "zero.frd",
    ];
    commands.extend(fields.map(|field| [&["correct", field], &sheet[..]].concat()));
    for command in commands {
        let done = gelbench(folder.path(), &command).code(2);
        let printed = one_line(&done.get_output().stderr);
        assert!(
            printed.contains("it is not a regular file; save its output"),
            "{command:?}: {printed}"
        );
    }
}
