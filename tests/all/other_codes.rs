//! Studies exported to other codes, and fields taken back from them, as a user meets them.
//!
//! Runs of another code are in `calculix.rs`.

use std::fs;

use crate::common::exports::{ADAPTIVE, GRIPPED, HOLE, PLATE, PULLED, deviation};
use crate::common::{SMALL, folder_with, gelbench, number, one_line, words};
use gelbench_mechanics::mesh::import_field;

/// The mesh that goes out is the one that the other models are compared with.
#[test]
fn graded_and_refined_meshes_go_out_as_they_are() {
    let export = [
        "export",
        "small.toml",
        "--to",
        "abaqus",
        "--output",
        "a.inp",
    ];
    let folder = folder_with(&format!("{PLATE}element = \"Q2\"\ngrading = 2.0\n"));
    gelbench(folder.path(), &export).code(0);
    let text = fs::read_to_string(folder.path().join("a.inp")).unwrap();
    // 12 cells on 30 mm: the first line lies at 15 (2/12)² mm.
    assert!(text.contains(", 4.16666666667e-1, 0\n"), "{text}");

    let folder = folder_with(&format!("{HOLE}{PULLED}{ADAPTIVE}"));
    gelbench(folder.path(), &export).code(0);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let text = fs::read_to_string(folder.path().join("a.inp")).unwrap();
    let elements = text
        .lines()
        .skip_while(|line| !line.starts_with("*ELEMENT"));
    let elements = elements.skip(1).take_while(|line| !line.starts_with('*'));
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    let cells = format!("on {} cells", elements.count());
    assert!(report.contains(&cells), "{cells}: {report}");
    let coarse = [&export[..], &["--mesh", "coarse"]].concat();
    let done = gelbench(folder.path(), &coarse).code(2);
    assert!(words(&done.get_output().stderr).contains("leave out --mesh"));
}

#[test]
fn every_code_gets_a_file_of_every_kind_of_study() {
    for study in [PLATE.to_owned(), format!("{HOLE}{PULLED}")] {
        let folder = folder_with(&study);
        for (code, expected) in [
            ("abaqus", "*HYPERELASTIC"),
            ("calculix", "*HYPERELASTIC"),
            ("febio", "<febio_spec version=\"4.0\">"),
        ] {
            let export = ["export", "small.toml", "--to", code, "--mesh", "coarse"];
            let done = gelbench(folder.path(), &export).code(0);
            let printed = words(&done.get_output().stdout);
            let path = folder
                .path()
                .join(printed.split_whitespace().next().unwrap());
            let text = fs::read_to_string(&path).unwrap();
            assert!(text.contains(expected), "{code}");
            gelbench(folder.path(), &export).code(0);
            assert_eq!(
                fs::read_to_string(&path).unwrap(),
                text,
                "{code}: the same bytes again"
            );
        }
    }
}

#[test]
fn what_cannot_be_exported_is_refused_before_anything_is_written() {
    let gripped = format!("{HOLE}{GRIPPED}");
    for (study, arguments, message) in [
        (&*gripped, vec!["--to", "febio"], "export to Abaqus"),
        (SMALL, vec!["--to", "calculix"], "fit such a card"),
        (
            PLATE,
            vec!["--to", "calculx"],
            "a similar value exists: 'calculix'",
        ),
        (
            PLATE,
            vec!["--to", "febio", "--bulk-ratio", "1"],
            "bulk ratio",
        ),
        (
            "kind = \"smoothing\"",
            vec!["--to", "febio"],
            "not a boundary value problem",
        ),
    ] {
        let folder = folder_with(study);
        let export = [vec!["export", "small.toml"], arguments].concat();
        let done = gelbench(folder.path(), &export).code(2);
        let actual = one_line(&done.get_output().stderr);
        assert!(actual.contains(message), "{message}: {actual}");
        assert!(!folder.path().join("output").exists());
    }
}

/// What gelbench writes as VTK comes in again; all formats tell the same.
#[test]
fn a_field_of_ones_own_deviates_by_nothing() {
    let folder = folder_with(PLATE);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let field = "out/vtk/finite_element_001.vtu";
    let compare = [
        "compare",
        "small.toml",
        field,
        "--stretch",
        "0.2",
        "--output",
        "compared",
    ];
    let done = gelbench(folder.path(), &compare).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(deviation(&printed) < 1e-6, "{printed}");
    let report = fs::read_to_string(folder.path().join("compared/report.md")).unwrap();
    assert!(
        report.contains("| finite elements | 12 × 4 cells, graded by 2 | 0.0000 |"),
        "{report}"
    );
    for file in ["finite_elements.vtu", "mass_spring.vtu", "corrected.vtu"] {
        assert!(
            folder.path().join("compared/vtk").join(file).exists(),
            "{file}"
        );
    }
    // A file with two displacements must be told which; the compared files hold the difference too.
    let two = [
        "compare",
        "small.toml",
        "compared/vtk/finite_elements.vtu",
        "--factor",
        "0.2",
    ];
    let array = [&two[..], &["--array", "imported_displacement_mm"]].concat();
    let done = gelbench(folder.path(), &array).code(0);
    assert!(deviation(&words(&done.get_output().stdout)) < 1e-6);
    let wrong = [&two[..], &["--array", "velocity"]].concat();
    let done = gelbench(folder.path(), &wrong).code(2);
    assert!(words(&done.get_output().stderr).contains("imported_displacement_mm"));
    // Without finite elements the other models are compared.
    let others = format!("models = [\"mass-spring\", \"corrected\"]\n{PLATE}");
    fs::write(folder.path().join("small.toml"), others).unwrap();
    let done = gelbench(folder.path(), &compare[..5]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("own error is not known"), "{printed}");
}

/// What a run says of the corrected field and what a comparison with its finite elements says is the same, but for the places; a shift
/// of the whole field is all of the finite elements' difference then, and exchanged components are all of every model's.
#[test]
fn a_comparison_says_what_a_run_says_and_which_part_is_a_motion_of_the_whole_body() {
    let folder = folder_with(SMALL);
    let position = folder.path();
    let json = |arguments: &[&str], code: i32| -> serde_json::Value {
        let done = gelbench(position, arguments).code(code);
        serde_json::from_slice(&done.get_output().stdout).unwrap()
    };
    let run = json(&["run", "small.toml", "--output", "out", "--json"], 0);
    let field = "out/vtk/finite_element_001.vtu";
    let compared = json(&["compare", "small.toml", field, "--json"], 0);
    let of = |actual: &serde_json::Value, model: usize| {
        number(&actual["models"][model], &["displacement_percent"])
    };
    assert!(of(&compared, 0) < 1e-6);
    assert!(number(&compared, &["finite_elements_own_error_percent"]) > 0.0);
    let corrected = number(&run["steps"][0], &["corrected", "displacement_percent"]);
    let ratio = of(&compared, 2) / corrected;
    assert!((0.9..1.2).contains(&ratio), "{ratio}");

    let moved = import_field(&position.join(field), 1.0, None, 1.0).unwrap();
    let write = |name: &str, changed: fn(&[f64]) -> [f64; 2]| {
        let nodes = moved.mesh.nodes.iter().zip(moved.displacement.chunks(2));
        let rows = nodes.map(|([x, y], u)| {
            let [ux, uy] = changed(u);
            format!("{x},{y},{ux},{uy}\n")
        });
        let head = "X [mm],Y [mm],ux [mm],uy [mm]\n".to_owned();
        fs::write(position.join(name), head + &rows.collect::<String>()).unwrap();
    };
    write("moved.csv", |u| [u[0] + 1.5, u[1] - 0.7]);
    let compared = json(&["compare", "small.toml", "moved.csv", "--json"], 1);
    let message = compared["doubts"][0].as_str().unwrap();
    assert!(
        message.contains(
            "by (-1.5000, 0.7000) mm and -0.0000 degrees: without it the difference is 0.0000"
        ) || message.contains(
            "by (-1.5000, 0.7000) mm and 0.0000 degrees: without it the difference is 0.0000"
        ),
        "{message}"
    );

    write("exchanged.csv", |u| [u[1], u[0]]);
    let compared = json(&["compare", "small.toml", "exchanged.csv", "--json"], 1);
    let message = compared["doubts"][0].as_str().unwrap();
    assert!(message.contains("with x and y exchanged"), "{message}");
}

/// A file in cm under heads in mm is a field on a corner of the specimen, which is as little off as the strain is uniform.
#[test]
fn a_field_in_another_unit_than_its_heads_say_is_doubted() {
    let folder = folder_with(SMALL);
    let position = folder.path();
    gelbench(position, &["run", "small.toml", "--output", "out"]);
    let field = position.join("out/vtk/finite_element_001.vtu");
    let field = import_field(&field, 1.0, None, 1.0).unwrap();
    let nodes = field.mesh.nodes.iter().zip(field.displacement.chunks(2));
    let rows = nodes.map(|([x, y], u)| {
        let [x, y, ux, uy] = [*x, *y, u[0], u[1]].map(|millimetres| 0.1 * millimetres);
        format!("{x},{y},{ux},{uy}\n")
    });
    let table = format!(
        "X [mm],Y [mm],ux [mm],uy [mm]\n{}",
        rows.collect::<String>()
    );
    fs::write(position.join("cm.csv"), table).unwrap();
    let compare = ["compare", "small.toml", "cm.csv"];
    let done = gelbench(position, &compare).code(1);
    let message = words(&done.get_output().stderr);
    assert!(
        message.contains("in cm they would span all of it") && message.contains("--unit cm"),
        "{message}"
    );
    let stated = [&compare[..], &["--unit", "cm"]].concat();
    let done = gelbench(position, &stated).code(0);
    assert!(deviation(&words(&done.get_output().stdout)) < 1e-3);
}

#[test]
fn fields_on_meshes_that_are_fine_where_they_must_come_in_again() {
    for study in [
        format!("{PLATE}element = \"Q2\"\ngrading = 3.0\n"),
        format!("{HOLE}{PULLED}{ADAPTIVE}"),
    ] {
        let folder = folder_with(&study);
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        let field = folder.path().join("out").join("vtk/finite_element_002.vtu");
        let compare = ["compare", "small.toml", &field.display().to_string()];
        let done = gelbench(folder.path(), &compare).code(0);
        let printed = words(&done.get_output().stdout);
        assert!(deviation(&printed) < 1e-6, "{printed}");
    }
}

/// The material points that dolfinx computed for `validation/plate`.
#[test]
fn points_of_another_code_are_a_reference() {
    let study = "[plate]\nlength = \"150 mm\"\nwidth = \"50 mm\"\nthickness = \"2 mm\"\ncells = [24, 8]\n[material]\n\
        card = \"neo-hooke\"\n[load]\nstretches = [\"15 %\", \"50 %\"]\n[finite_element]\ncells = [60, 20]\nelement = \"Q2\"\ngrading = 1.0\n";
    let folder = folder_with(study);
    let points = crate::common::root().join("validation/plate/displacement_nh_60x20_Q2.csv");
    let points = points.display().to_string();
    let compare = [
        "compare",
        "small.toml",
        &points,
        "--stretch",
        "50 %",
        "--output",
        "compared",
    ];
    let done = gelbench(folder.path(), &compare).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("341 points") && deviation(&printed) < 1e-4,
        "{printed}"
    );
    assert!(folder.path().join("compared/vtk/corrected.vtu").exists());
    let metres = ["compare", "small.toml", &points, "--stretch", "40 %"];
    let done = gelbench(folder.path(), &metres).code(2);
    assert!(words(&done.get_output().stderr).contains("no rows for the load factor 0.4"));
}
