//! The finite elements compared with CalculiX, which solves what gelbench exports.
//!
//! Needs `ccx` on the path (Debian: `calculix-ccx`). Without it every test is listed as ignored, with the reason: what was
//! not run has not passed.

use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use libtest_mimic::{Arguments, Completion, Failed, Trial};

mod common;

use common::exports::{ADAPTIVE, GRIPPED, HOLE, PLATE, PULLED, deviation};
use common::{folder_with, gelbench, words};

/// What the tests do where CalculiX is installed.
const TESTS: [(&str, fn()); 4] = [
    (
        "calculix_finds_the_same_plate",
        calculix_finds_the_same_plate,
    ),
    (
        "calculix_comes_nearer_with_finer_linear_elements",
        calculix_comes_nearer_with_finer_linear_elements,
    ),
    (
        "calculix_finds_the_same_strip_with_a_hole_under_every_load",
        calculix_finds_the_same_strip_with_a_hole_under_every_load,
    ),
    (
        "calculix_finds_the_same_on_meshes_that_are_fine_where_they_must",
        calculix_finds_the_same_on_meshes_that_are_fine_where_they_must,
    ),
];

fn main() -> ExitCode {
    let trial = |(name, test): (&str, fn())| {
        Trial::ignorable_test(name, move || -> Result<Completion, Failed> {
            if !is_installed() {
                let reason = "ccx is not installed (Debian: calculix-ccx)";
                return Ok(Completion::ignored_with(reason));
            }
            test();
            Ok(Completion::Completed)
        })
    };
    let trials = TESTS.into_iter().map(trial).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

/// `ccx` in a folder; its output is not wanted.
fn ccx(folder: &Path) -> Command {
    let mut command = Command::new("ccx");
    command.current_dir(folder).env("OMP_NUM_THREADS", "1");
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn is_installed() -> bool {
    ccx(Path::new(".")).arg("-v").status().is_ok()
}

/// Exports `small.toml`, solves it with CalculiX, and returns the deviation of the finite elements from its field at
/// every load factor.
fn solved(study: &str, factors: &[&str]) -> Vec<f64> {
    let folder = folder_with(study);
    let export = [
        "export",
        "small.toml",
        "--to",
        "calculix",
        "--output",
        "small.inp",
    ];
    gelbench(folder.path(), &export).code(0);
    let status = ccx(folder.path()).arg("small").status().unwrap();
    assert!(status.success(), "ccx ended with {status}");
    let compare = |factor: &&str| {
        let done = gelbench(
            folder.path(),
            &["compare", "small.toml", "small.frd", "--factor", factor],
        );
        deviation(&words(&done.code(0).get_output().stdout))
    };
    factors.iter().map(compare).collect()
}

fn calculix_finds_the_same_plate() {
    let result = solved(&format!("{PLATE}element = \"Q2\"\n"), &["20 %", "50 %"]);
    assert!(result.iter().all(|percent| *percent < 0.5), "{result:?}");
}

/// CalculiX' linear solids are not the bilinear elements of a sheet: both come nearer to each other on finer meshes.
fn calculix_comes_nearer_with_finer_linear_elements() {
    let study = format!("{PLATE}element = \"Q1\"\n");
    let finer = study.replace(
        "[finite_element]\ncells = [12, 4]",
        "[finite_element]\ncells = [24, 8]",
    );
    let coarse = solved(&study, &["50 %"]);
    let fine = solved(&finer, &["50 %"]);
    assert!(fine[0] < 0.8 * coarse[0], "{coarse:?} {fine:?}");
}

fn calculix_finds_the_same_strip_with_a_hole_under_every_load() {
    let turned = "[[support]]\ngroup = \"right\"\nkind = \"rotation\"\ncentre = [\"0 mm\", \"40 mm\"]\nangle = \"15 deg\"\n";
    let blown =
        format!("{PULLED}[[load]]\ngroup = \"hole\"\nkind = \"pressure\"\npressure = \"20 kPa\"\n");
    let drawn =
        "[[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"0.2 MPa\"\ny = \"10 kPa\"\n";
    let steps: &[&str] = &["0.5", "1"];
    for (load, element, factors) in [
        (PULLED, "Q2 serendipity", steps),
        (turned, "T2", steps),
        // CalculiX finds no second step under a pressure on these cells; it finds the same load in one.
        (&blown, "Q2", &["1"]),
        (drawn, "Q2", steps),
        (GRIPPED, "Q2 serendipity", steps),
    ] {
        let hole = match factors {
            ["1"] => HOLE.replace("[0.5, 1.0]", "[1.0]"),
            _ => HOLE.to_owned(),
        };
        let study = format!("{hole}{load}[finite_element]\nelement = \"{element}\"\n");
        let result = solved(&study, factors);
        assert!(
            result.iter().all(|percent| *percent < 0.5),
            "{load}: {result:?}"
        );
    }
}

fn calculix_finds_the_same_on_meshes_that_are_fine_where_they_must() {
    for study in [
        format!("{PLATE}element = \"Q2\"\ngrading = 2.0\n"),
        format!("{HOLE}{PULLED}{ADAPTIVE}"),
    ] {
        let result = solved(&study, &["0.5"]);
        assert!(result[0] < 0.5, "{study}: {result:?}");
    }
}
