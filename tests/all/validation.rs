//! The committed validation report is what the committed code prints.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

use crate::common::figures::agree;

/// What a report says, less the number of checks and the claim about times, which depend on the machine.
fn lines(report: &str) -> Vec<&str> {
    let figures = report.lines();
    let depends = |line: &str| line.ends_with("checks passed.") || line.contains("CPU time");
    figures
        .filter(|line| !line.is_empty() && !depends(line))
        .collect()
}

/// Runs `gelbench validate`, which ends with one of some codes, and looks for everything that it says in the committed report.
fn compare(arguments: &[&str], codes: &'static [i32]) -> usize {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = TempDir::new().unwrap();
    let mut command = Command::cargo_bin("gelbench").unwrap();
    command
        .current_dir(root)
        .arg("validate")
        .args(arguments)
        .arg("--output")
        .arg(folder.path());
    command.assert().code(codes);
    let read = |path: &Path| fs::read_to_string(path).unwrap();
    assert!(read(&folder.path().join("TIMES.md")).contains("time [s]"));
    let committed = read(&root.join("validation/REPORT.md"));
    let committed = lines(&committed);
    let result = read(&folder.path().join("REPORT.md"));
    let result = lines(&result);
    for line in &result {
        assert!(!line.contains("NaN"), "not a number in the report: {line}");
        let printed = committed.iter().any(|committed| agree(line, committed));
        assert!(printed, "the committed report does not say: {line}");
    }
    for entry in fs::read_dir(folder.path()).unwrap() {
        let name = entry.unwrap().file_name();
        let name_text = name.to_string_lossy();
        let of_run = name_text.ends_with("html")
            || name_text == "TIMES.md"
            || name_text == ".gelbench-manifest.json";
        assert!(
            of_run || root.join("validation").join(&name).exists(),
            "{name:?} is not committed"
        );
    }
    result.len()
}

#[test]
fn the_committed_report_shows_what_the_quick_cases_compute() {
    assert!(compare(&["--quick"], &[0]) > 60);
}

/// All cases, slow ones too, once a week; some of their requirements are not met, which the committed report says.
#[test]
#[ignore = "takes a minute"]
fn the_committed_report_shows_what_all_cases_compute() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let committed = fs::read_to_string(root.join("validation/REPORT.md")).unwrap();
    assert_eq!(compare(&[], &[0, 1]), lines(&committed).len());
}

#[test]
fn a_case_study_runs_by_itself() {
    let folder = TempDir::new().unwrap();
    let study = folder.path().join("mine.toml");
    fs::write(
        &study,
        "kind = \"nonlinear-spring\"\n[spring]\nstiffness = 2\n",
    )
    .unwrap();
    let mut command = Command::cargo_bin("gelbench").unwrap();
    command
        .current_dir(folder.path())
        .args(["run", "mine.toml"])
        .assert()
        .code(0);
    let report = fs::read_to_string(folder.path().join("output/mine/report.json")).unwrap();
    assert!(report.contains("\"passed\": true"));
    assert!(
        folder
            .path()
            .join("output/mine/nonlinear_spring.png")
            .exists()
    );

    fs::write(
        &study,
        "kind = \"nonlinear-spring\"\n[spring]\nstifness = 2\n",
    )
    .unwrap();
    let mut command = Command::cargo_bin("gelbench").unwrap();
    let done = command
        .current_dir(folder.path())
        .args(["check", "mine.toml"])
        .assert()
        .code(2);
    assert!(
        String::from_utf8_lossy(&done.get_output().stderr).contains("did you mean `stiffness`")
    );
    let mut command = Command::cargo_bin("gelbench").unwrap();
    command
        .current_dir(folder.path())
        .args(["validate", "no-such-case"])
        .assert()
        .code(2);
}
