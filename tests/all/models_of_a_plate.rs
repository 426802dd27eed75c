//! Which models a study ends with, and how they are judged.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{SMALL, folder_with, gelbench, machine_report, number, words};

/// The report for programs of a study that ended with a code.
fn report_of(folder: &TempDir) -> Value {
    machine_report(&folder.path().join("output/small"))
}

fn judgements(report: &Value) -> Vec<&str> {
    let requirements = report["requirements"].as_array().unwrap().iter();
    requirements
        .map(|requirement| requirement["result"].as_str().unwrap())
        .collect()
}

/// Q2 elements on equal cells are the biquadratic scheme on a lattice of twice as many: deviation 0, whatever the error is.
#[test]
fn a_plate_compared_with_itself_is_not_judged() {
    let study = SMALL.replace("cells = [24, 8]", "cells = [12, 4]\ngrading = 1.0");
    let study = study.replacen("cells = [12, 4]", "cells = [24, 8]", 1);
    let study = format!("{study}[corrector]\ngrading = 1.0\n");
    let folder = folder_with(&study);
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert_eq!(printed.matches("cannot be judged").count(), 4, "{printed}");
    assert!(!printed.contains("pass ") && !printed.contains("FAIL "));
    assert!(words(&done.get_output().stderr).contains("own equations on the same nodes"));
    let report = report_of(&folder);
    assert_eq!(judgements(&report), ["cannot be judged"; 4]);
    assert_eq!(report["passed"], false);
    let text = fs::read_to_string(folder.path().join("output/small/report.md")).unwrap();
    assert!(text.contains("cannot be judged") && text.contains("not been judged in all"));
}

/// A reference coarser than the lattice is blamed, and not the corrected field.
#[test]
fn a_reference_coarser_than_the_lattice_judges_nothing() {
    let coarse = SMALL.replace("cells = [24, 8]", "cells = [8, 4]\ngrading = 1.0");
    let coarse = coarse.replacen("cells = [12, 4]", "cells = [48, 16]", 1);
    let coarse = coarse.replace("\"5 %\"", "\"0.001 %\"");
    let folder = folder_with(&coarse);
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(
        !printed.contains("FAIL") && !printed.contains("pass "),
        "{printed}"
    );
    assert!(
        printed.contains("the reference is too coarse") && printed.contains("finite_element.cells"),
        "{printed}"
    );
}

#[test]
fn where_the_springs_end_the_other_models_are_complete() {
    for method in ["climb", "direct"] {
        let study = format!(
            "{SMALL}\n[mass_spring]\nmax_iterations = 1\n[corrector]\nmethod = \"{method}\"\n"
        );
        let folder = folder_with(&study);
        let done = gelbench(folder.path(), &["run", "small.toml"]).code(3);
        let message = words(&done.get_output().stdout);
        assert!(
            message.contains("FAIL mass-spring at 20 % stretch")
                && message.contains("(take smaller"),
            "{message}"
        );
        let report = report_of(&folder);
        assert_eq!(judgements(&report), ["pass", "pass", "pass", "FAIL"]);
        assert_eq!(report["passed"], false);
        assert!(report["ends"][0].as_str().unwrap().contains("mass-spring"));
        let step = &report["steps"][0];
        assert!(step["mass_spring"].is_null());
        assert!(number(step, &["corrected", "displacement_percent"]) < 1.0);
        assert!(number(step, &["finite_element", "force_N"]) > 1.0);
        let output = folder.path().join("output/small");
        for (file, there) in [
            ("vtk/mass_spring_001.vtu", false),
            ("vtk/mass_spring.pvd", false),
            ("vtk/corrected_001.vtu", true),
            ("vtk/finite_element_001.vtu", true),
            ("small_displacement.png", true),
            ("small_error.png", true),
        ] {
            assert_eq!(output.join(file).exists(), there, "{file}");
        }
        let text = fs::read_to_string(output.join("report.md")).unwrap();
        assert!(
            text.contains("mass-spring at 20 % stretch") && text.contains("takes the place of ū")
        );
    }
}

#[test]
fn where_the_finite_elements_end_springs_and_corrected_field_are_complete() {
    let folder = folder_with(&SMALL.replace("[24, 8]", "[24, 8]\nmax_iterations = 1"));
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(3);
    assert!(words(&done.get_output().stdout).contains("finite elements (24 × 8 cells"));
    let report = report_of(&folder);
    assert_eq!(judgements(&report), ["FAIL"; 3]);
    let step = &report["steps"][0];
    assert!(step["finite_element"].is_null() && step["corrected"]["measured_percent"].is_null());
    assert!(number(step, &["corrected", "force_N"]) > 1.0);
    assert!(number(step, &["mass_spring", "force_N"]) > 1.0);
    let output = folder.path().join("output/small");
    assert!(
        output.join("small_displacement.png").exists() && !output.join("small_error.png").exists()
    );
}

#[test]
fn where_no_model_has_a_solution_the_first_end_is_told() {
    let folder = folder_with(&format!(
        "{}\n[mass_spring]\nmax_iterations = 1\n[corrector]\nmethod = \"direct\"\nmax_steps = 1\n",
        SMALL.replace("[24, 8]", "[24, 8]\nmax_iterations = 1")
    ));
    let done = gelbench(folder.path(), &["run", "small.toml"]).code(3);
    let printed = words(&done.get_output().stderr);
    assert!(
        printed.contains("finite elements (") && printed.contains("try:"),
        "{printed}"
    );
    assert!(!folder.path().join("output/small").exists());
}

#[test]
fn a_compressed_plate_is_computed_and_warned_of() {
    let folder = folder_with(&SMALL.replace("[\"20 %\"]", "[\"-5 %\", \"-10 %\"]"));
    let done = gelbench(folder.path(), &["run", "small.toml"]);
    let printed = words(&done.get_output().stderr);
    assert!(
        printed.contains("may wrinkle or buckle") && printed.contains("are critical"),
        "{printed}"
    );
    let report = report_of(&folder);
    for step in report["steps"].as_array().unwrap() {
        for model in ["mass_spring", "corrected", "finite_element"] {
            assert!(number(step, &[model, "force_N"]) < 0.0, "{model}");
        }
    }
    assert!(
        report["warnings"]
            .as_array()
            .unwrap()
            .iter()
            .any(|warning| { warning.as_str().unwrap().contains("may wrinkle") })
    );
    assert_eq!(done.get_output().status.code(), Some(0), "{printed}");
}

#[test]
fn the_grips_forces_are_in_balance_and_the_report_says_so() {
    let folder = folder_with(SMALL);
    gelbench(folder.path(), &["run", "small.toml"]).code(0);
    let report = report_of(&folder);
    for model in ["mass_spring", "corrected", "finite_element"] {
        let grips = number(&report, &["balance", "models", model, "unbalanced"]);
        assert!(grips < 1e-9, "{model}: {grips}");
        let residual = number(&report, &["balance", "models", model, "free_nodes"]);
        assert!(
            residual < if model == "corrected" { 1e-3 } else { 1e-9 },
            "{model}: {residual}"
        );
    }
    let text = fs::read_to_string(folder.path().join("output/small/report.md")).unwrap();
    assert!(text.contains("Balance of forces and moments") && text.contains("thick at rest"));
}
