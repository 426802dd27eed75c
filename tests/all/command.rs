//! The command as a user meets it: words, files and exit codes.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::common::{SMALL, folder_with, gelbench, machine_report, number, words};

/// The main job: the figures that the README promises, at every stretch.
#[test]
fn the_pva_plate_study_reaches_its_accuracy() {
    let folder = TempDir::new().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = folder.path().to_str().unwrap();
    let done = gelbench(
        root,
        &["run", "examples/pva_plate.toml", "--output", output],
    )
    .code(0);
    let printed = words(&done.get_output().stdout);
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let is_of_folder = |line: &&str| line.contains("files in") || line.starts_with("open ");
    for line in printed.lines().filter(|line| !is_of_folder(line)) {
        assert!(readme.contains(line), "the README does not show: {line}");
    }

    let report = machine_report(folder.path());
    let steps = report["steps"].as_array().unwrap();
    let stretches: Vec<f64> = steps.iter().map(|step| number(step, &["at"])).collect();
    assert_eq!(stretches, [0.15, 0.3, 0.5, 0.75, 1.0]);
    // Converged forces and widths of dolfinx, scikit-fem and FElupe.
    let published = [
        [2.49239, 46.55659],
        [5.98013, 43.75464],
        [12.87459, 40.71896],
        [27.17571, 37.69968],
        [52.16485, 35.27206],
    ];
    for (step, [force, width]) in steps.iter().zip(published) {
        assert!(number(step, &["corrected", "displacement_percent"]) <= 0.1);
        assert!(number(step, &["corrected", "departure_percent"]) <= 1.0);
        assert!(number(step, &["corrected", "measured_percent"]).abs() <= 0.2);
        assert!(number(step, &["corrected", "displacement_correction_percent"]) >= 95.0);
        assert!(number(step, &["mass_spring", "departure_percent"]) > 20.0);
        let measured = number(step, &["finite_element", "measured_discretisation_percent"]);
        assert!(measured < 0.01, "{measured}");
        let actual = number(step, &["finite_element", "force_N"]);
        assert!((actual / force - 1.0).abs() < 1e-5, "{actual} {force}");
        let actual = number(step, &["finite_element", "width_mm"]);
        assert!((actual / width - 1.0).abs() < 1e-6, "{actual} {width}");
        for key in ["max_difference_mm", "force_N", "width_mm"] {
            assert!(
                number(step, &["mass_spring", key]) > 0.0
                    && number(step, &["corrected", key]) > 0.0
            );
        }
    }
    assert!(number(&report, &["times_s", "springs and corrector"]) > 0.0);
}

#[test]
fn the_same_study_gives_the_same_bytes() {
    let folder = folder_with(SMALL);
    for output in ["first", "second"] {
        gelbench(folder.path(), &["run", "small.toml", "--output", output]).code(0);
    }
    let mut compared = 0;
    for part in ["", "vtk"] {
        for entry in fs::read_dir(folder.path().join("first").join(part)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            let known = !name.starts_with('.') || name == ".gelbench-manifest.json";
            assert!(known, "{name} was left behind");
            // Reports end with a section of times.
            if path.is_dir() || name.starts_with("report") {
                continue;
            }
            let other = folder.path().join("second").join(part).join(&name);
            assert_eq!(fs::read(&path).unwrap(), fs::read(other).unwrap(), "{name}");
            compared += 1;
        }
    }
    assert_eq!(
        compared,
        10 + 8 + 1 + 1 + 1 + 1,
        "pictures, VTK files, a view of them, forces, springs and the manifest"
    );
    let without_times = |output: &str| {
        let report = fs::read_to_string(folder.path().join(output).join("report.md")).unwrap();
        report.split("## Times").next().unwrap().to_owned()
    };
    assert_eq!(without_times("first"), without_times("second"));
}

#[test]
fn pictures_and_vtk_files_are_what_they_claim() {
    let folder = folder_with(SMALL);
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    let output = folder.path().join("output/small");
    for name in [
        "material",
        "displacement",
        "error",
        "von_mises",
        "largest_principal_stress",
        "errors",
        "forces",
        "residuals",
        "mesh",
        "estimated_error",
    ] {
        let bytes = fs::read(output.join(format!("small_{name}.png"))).unwrap();
        assert!(
            bytes.starts_with(b"\x89PNG") && bytes.len() > 5_000,
            "{name}"
        );
    }
    let page = fs::read_to_string(output.join("report.html")).unwrap();
    assert_eq!(page.matches("data:image/png;base64,").count(), 10);
    for model in ["mass_spring", "springs", "corrected", "finite_element"] {
        let collection = fs::read_to_string(output.join(format!("vtk/{model}.pvd"))).unwrap();
        assert!(collection.contains(&format!(
            "timestep=\"0.2\" part=\"0\" file=\"{model}_001.vtu\""
        )));
        let grid = fs::read_to_string(output.join(format!("vtk/{model}_001.vtu"))).unwrap();
        assert!(grid.contains("UnstructuredGrid") && grid.contains("displacement_mm"));
    }
}

#[test]
fn nothing_of_an_earlier_run_is_left_among_the_files() {
    let all = "[pictures]\nfactors = \"all\"\n";
    let folder = folder_with(&(SMALL.replace("[\"20 %\"]", "[0.1, 0.2]") + all));
    let output = folder.path().join("output/small");
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    assert!(
        output.join("small_displacement_002.png").exists()
            && output.join("vtk/corrected_002.vtu").exists()
    );
    fs::write(output.join("notes_002.png"), "mine").unwrap();
    fs::write(folder.path().join("small.toml"), format!("{SMALL}{all}")).unwrap();
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    assert!(
        !output.join("small_displacement_002.png").exists()
            && !output.join("vtk/corrected_002.vtu").exists()
    );
    assert!(
        output.join("small_displacement_001.png").exists() && output.join("notes_002.png").exists()
    );
}

#[test]
fn a_requirement_that_is_not_met_ends_with_code_1() {
    let folder = folder_with(&SMALL.replace("\"5 %\"", "\"0.001 %\""));
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(1);
    assert!(words(&done.get_output().stdout).contains("FAIL corrected displacement"));
    assert!(folder.path().join("output/small/report.html").exists());
}

#[test]
fn faults_of_a_study_are_told_at_once_with_code_2() {
    let study = SMALL.replace(
        "cells = [12, 4]\n[load]",
        "cels = [12, 4]\nthickness = 2\n[load]",
    );
    let folder = folder_with(&study.replace("[plate]", "[material]\ncard = \"pva10\"\n[plate]"));
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let message = words(&done.get_output().stderr);
    for expected in [
        "did you mean `pva-10`",
        "plate.cels",
        "did you mean `cells`",
        "needs a unit",
        "small.toml:5",
    ] {
        assert!(message.contains(expected), "{expected}: {message}");
    }
    gelbench(folder.path(), &["run", "small.toml"]).code(2);
    assert!(!folder.path().join("output").exists(), "nothing is written");
    gelbench(folder.path(), &["run", "missing.toml"]).code(2);
    gelbench(folder.path(), &["walk"]).code(2);
}

#[test]
fn a_folder_that_takes_no_files_ends_with_code_4() {
    let folder = folder_with(SMALL);
    let done = gelbench(
        folder.path(),
        &["run", "small.toml", "--output", "small.toml/out"],
    )
    .code(4);
    assert!(words(&done.get_output().stderr).contains("cannot write small.toml/out"));
}

#[test]
fn a_new_study_is_complete_and_is_not_overwritten() {
    let folder = TempDir::new().unwrap();
    gelbench(folder.path(), &["new", "mine"]).code(0);
    let done = gelbench(folder.path(), &["check", "mine.toml"]).code(0);
    assert!(words(&done.get_output().stdout).contains("no faults"));
    let done = gelbench(folder.path(), &["new", "mine.toml"]).code(4);
    assert!(words(&done.get_output().stderr).contains("exists already"));
}

#[test]
fn cards_are_listed_and_shown() {
    let folder = TempDir::new().unwrap();
    let done = gelbench(folder.path(), &["materials", "list"]).code(0);
    assert!(words(&done.get_output().stdout).contains("pva-10-cauchy"));
    let done = gelbench(folder.path(), &["materials", "show", "pva-10"]).code(0);
    let shown = words(&done.get_output().stdout);
    assert!(
        shown.contains("\namplitude                   0.0611 MPa")
            && shown.contains("10.1002/jbm.b.30543"),
        "{shown}"
    );
    gelbench(folder.path(), &["materials", "show", "pva"]).code(2);
    gelbench(folder.path(), &["materials", "plot", "pva-10"]).code(0);
    assert!(
        folder
            .path()
            .join("output/materials/pva-10_curves.png")
            .exists()
    );
    let plot = ["materials", "plot", "pva-10", "--output", "curves.pdf"];
    gelbench(folder.path(), &plot).code(0);
    let picture = fs::read(folder.path().join("curves.pdf")).unwrap();
    assert!(picture.starts_with(b"%PDF"));
    let done = gelbench(
        folder.path(),
        &["materials", "compare", "pva-10", "neo-hooke"],
    )
    .code(0);
    assert!(words(&done.get_output().stdout).contains("E₀ = 0.136540 MPa"));
    assert!(
        folder
            .path()
            .join("output/materials/comparison.png")
            .exists()
    );
    let done = gelbench(folder.path(), &["materials", "compare", "pva", "neo"]).code(2);
    let message = words(&done.get_output().stderr);
    assert!(
        message.contains("`pva`") && message.contains("`neo`"),
        "both are named: {message}"
    );
}

#[test]
fn a_reader_that_has_gone_away_is_no_error() {
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("gelbench"));
    command
        .args(["materials", "list"])
        .stdout(std::process::Stdio::piped());
    let mut child = command.spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

/// One with a fault keeps the others from nothing; the exit code is the largest.
#[test]
fn several_studies_are_checked_and_run_one_after_the_other() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let spring = "kind = \"nonlinear-spring\"\n[spring]\nstiffness = 2\n";
    write("a.toml", spring);
    write("b.toml", &spring.replace("stiffness", "stifness"));
    write("c.toml", spring);
    let files = ["a.toml", "b.toml", "c.toml"];
    let checked = gelbench(folder.path(), &[&["check"], &files[..]].concat()).code(2);
    let printed = words(&checked.get_output().stdout);
    assert!(
        printed.contains("a.toml: no faults") && printed.contains("c.toml: no faults"),
        "{printed}"
    );
    let run = [&["run"], &files[..], &["--output", "all"]].concat();
    gelbench(folder.path(), &run).code(2);
    for name in ["a", "c"] {
        assert!(
            folder
                .path()
                .join(format!("all/{name}/report.html"))
                .exists()
        );
    }
    let twice = gelbench(folder.path(), &["run", "a.toml", "./a.toml"]).code(2);
    let message = words(&twice.get_output().stderr);
    assert!(
        message.contains("two studies have the name `a`"),
        "{message}"
    );
}
