//! The committed validation report is what the committed code prints.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

/// Rows of the tables that begin with one of `kinds`, less the section of times.
fn rows(report: &str, kinds: &[&str]) -> Vec<String> {
    let figures = report.split("## Times").next().unwrap();
    let of_kind = |line: &&str| {
        kinds
            .iter()
            .any(|kind| line.starts_with(&format!("| {kind} |")))
    };
    figures.lines().filter(of_kind).map(str::to_owned).collect()
}

/// Whether two rows say the same; figures far below what is asked for are rounding and may differ.
fn agree(found: &str, committed: &str) -> bool {
    let cells = |row: &str| {
        row.split('|')
            .map(|cell| cell.trim().to_owned())
            .collect::<Vec<_>>()
    };
    let (found, committed) = (cells(found), cells(committed));
    let same = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 1e-4 * b.abs() || a.abs().max(b.abs()) < 1e-6,
        _ => a == b,
    };
    found.len() == committed.len() && found.iter().zip(&committed).all(same)
}

#[test]
fn the_committed_report_shows_what_the_quick_cases_compute() {
    const QUICK: [&str; 4] = [
        "nonlinear-spring",
        "plate-ablation",
        "vibrating-spring",
        "correction-matrix",
    ];
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = TempDir::new().unwrap();
    let mut command = Command::cargo_bin("gelbench").unwrap();
    command
        .current_dir(root)
        .args(["validate", "--quick", "--output"])
        .arg(folder.path());
    command.assert().code(0);
    let read = |path: &Path| fs::read_to_string(path).unwrap();
    let committed = rows(&read(&root.join("validation/REPORT.md")), &QUICK);
    let found = rows(&read(&folder.path().join("REPORT.md")), &QUICK);
    assert_eq!(found.len(), committed.len());
    assert!(found.len() >= 30, "{}", found.len());
    for (found, committed) in found.iter().zip(&committed) {
        assert!(
            agree(found, committed),
            "\nfound     {found}\ncommitted {committed}"
        );
    }
    for picture in ["nonlinear_spring", "plate_ablation", "vibrating_spring"] {
        assert!(
            folder.path().join(format!("{picture}.png")).exists(),
            "{picture}"
        );
    }
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
