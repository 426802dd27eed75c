//! Paths and refinements that end early.

use std::fs;

use super::{PULLED, specimen};
use crate::common::mesh_files::MeshFile;
use crate::common::{folder_with, gelbench, machine_report, words};

/// A specimen refines itself to the error that the study wants; where the cells do not suffice, that is told.
#[test]
fn local_refinement_ends_at_its_goal_or_at_its_limit() {
    let shape = "shape = \"notched-strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"2 mm\"\n\
        notch_length = \"6 mm\"\ncells = 8\n[finite_element]\nelement = \"T2\"\nadaptive = true\n";
    let folder = folder_with(&specimen(&format!("{shape}error = \"1 %\""), PULLED));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("4 of 4 checks passed"), "{printed}");
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("refined locally in"), "{report}");
    let finest = fs::read_to_string(folder.path().join("out/vtk/finite_element_002.vtu")).unwrap();
    assert!(finest.contains("estimated_error_percent_of_energy_norm"));

    let text = specimen(
        &format!("{shape}error = \"0.1 %\"\nmost_cells = 200"),
        PULLED,
    );
    fs::write(folder.path().join("small.toml"), text).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("most_cells = 200"), "{printed}");
}

/// Not even the first load factor is reached: the last equilibrium on the way is written all the same.
#[test]
fn a_path_that_ends_before_its_first_load_factor_leaves_its_last_state() {
    let shape = "shape = \"strip\"\nlength = \"60 mm\"\nwidth = \"6 mm\"\ncells = 4";
    let squeezed = PULLED.replace("x = \"6 mm\"", "x = \"-20 mm\"");
    let folder = folder_with(&specimen(shape, &squeezed));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(3);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("buckling, wrinkling or necking"),
        "{printed}"
    );
    assert!(
        !printed.contains("NaN") && !printed.contains("at most 0)"),
        "{printed}"
    );
    assert!(
        folder
            .path()
            .join("out/vtk/finite_element_end.vtu")
            .exists()
    );
    assert!(
        !folder
            .path()
            .join("out/vtk/finite_element_001.vtu")
            .exists()
    );
}

/// The states before the end of a path are written, and the end is told as a requirement that is not met.
#[test]
fn what_was_reached_before_a_path_ends_is_not_lost() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    // The second load factor presses the strip through itself.
    let pressed = PULLED
        .replace("factors = [0.5, 1.0]", "factors = [0.01, 3.0]")
        .replace("x = \"6 mm\"", "x = \"-20 mm\"");
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    assert!(folder.path().join("out/vtk/corrected_002.vtu").exists());
    fs::write(folder.path().join("small.toml"), specimen(shape, &pressed)).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(3);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("load factor 3 (reached 0.8"), "{printed}");
    assert!(
        printed.contains("buckling, wrinkling or necking"),
        "{printed}"
    );
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("| 0.01 |"), "{report}");
    assert!(folder.path().join("out/vtk/corrected_001.vtu").exists());
    assert!(!folder.path().join("out/vtk/corrected_002.vtu").exists());
    // The last equilibrium on the way to the second load factor is kept apart, and said to be.
    assert!(report.contains("| finite_element_end.vtu |"), "{report}");
    assert!(
        folder
            .path()
            .join("out/vtk/finite_element_end.vtu")
            .exists()
    );
}

/// The springs of a cantilever collapse before its full load; finite elements and corrected field go on.
#[test]
fn the_end_of_the_springs_is_told_and_the_other_models_complete() {
    let shape = "shape = \"strip\"\nlength = \"40 mm\"\nwidth = \"20 mm\"\ncells = 4";
    let rest = "[path]\nfactors = [0.2, 1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"traction\"\ny = \"80 kPa\"\n";
    let study = specimen(shape, rest).replace("pva-10-yeoh", "neo-hooke");
    let folder = folder_with(&study);
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(3);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("FAIL mass-spring at load factor 1 (reached 0."),
        "{printed}"
    );
    assert!(!printed.contains("corrector at load factor"), "{printed}");
    let out = folder.path().join("out");
    for file in [
        "mass_spring_001.vtu",
        "mass_spring_end.vtu",
        "corrected_002.vtu",
        "finite_element_002.vtu",
    ] {
        assert!(out.join("vtk").join(file).exists(), "{file}");
    }
    assert!(!out.join("vtk/mass_spring_002.vtu").exists());
    let report = fs::read_to_string(out.join("report.md")).unwrap();
    assert!(
        report.contains("The springs have no field at load factor 1."),
        "{report}"
    );
    let json = machine_report(&folder.path().join("out"));
    let steps = |model: &str| {
        let steps = json["steps"].as_array().unwrap().iter();
        steps.filter(|step| step[model].is_object()).count()
    };
    assert_eq!(
        ["mass_spring", "corrected", "finite_element"].map(steps),
        [1, 2, 2]
    );
}

/// In skewed cells some springs would need negative constants and get none: a node on a free side is held by a single spring, and swings.
#[test]
fn springs_that_are_unstable_at_rest_are_to_be_left_out() {
    let mesh = MeshFile {
        nodes: vec![
            [48.0, 0.0],
            [54.0, 0.0],
            [60.0, 0.0],
            [41.42, 2.62],
            [45.87, 2.83],
            [50.28, 3.07],
        ],
        cells: vec![vec![0, 1, 4, 3], vec![1, 2, 5, 4]],
        lines: vec![
            ("start".to_owned(), vec![0, 3]),
            ("end".to_owned(), vec![2, 5]),
        ],
    };
    let moved = PULLED
        .replace("left", "start")
        .replace("right", "end")
        .replace(
            "x = \"6 mm\"\ny = \"0 mm\"",
            "x = \"0.6 mm\"\ny = \"-0.4 mm\"",
        );
    let shape = "shape = \"mesh\"\nfile = \"skewed.msh\"\nfile_unit = \"mm\"";
    let study = specimen(shape, &moved).replace("pva-10-yeoh", "neo-hooke");
    let folder = folder_with(&study);
    fs::write(folder.path().join("skewed.msh"), mesh.msh()).unwrap();
    let run = ["run", "small.toml", "--output", "out"];
    let done = gelbench(folder.path(), &run).code(3);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("unstable at rest") && printed.contains("(54.0, 0.0) mm"),
        "{printed}"
    );
    let remedy = "models = [\"corrected\", \"finite-element\"]";
    assert!(printed.contains(remedy), "{printed}");
    let study = format!("{remedy}\n{study}");
    fs::write(folder.path().join("small.toml"), study).unwrap();
    gelbench(folder.path(), &run);
    let report = machine_report(&folder.path().join("out"));
    for step in report["steps"].as_array().unwrap() {
        assert!(step["mass_spring"].is_null());
        for model in ["corrected", "finite_element"] {
            assert!(step[model]["measured_N"].is_number(), "{model}: {step}");
        }
    }
}
