//! Many runs of a study, as a user meets them: whole tables, kills, parts.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::process::*;

const STUDY: &str = "\
title = \"small\"
[plate]
cells = [12, 4]
[material]
card = \"neo-hooke\"
[load]
stretches = [\"10 %\", \"20 %\"]
[finite_element]
cells = [12, 4]
";

/// 24 runs.
const VARIED: &str =
    "s.toml --vary material.c10=0.05..0.1MPa --vary plate.width=45mm,50mm --samples 12";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::TempDir::new().unwrap();
    fs::write(folder.path().join("s.toml"), STUDY).unwrap();
    folder
}

fn sweep(folder: &Path, more: &str) -> BTreeMap<String, Vec<u8>> {
    let done = run(folder, &format!("sweep {VARIED}{more}"));
    assert!(done.status.success(), "{}", output_text(&done));
    results(&folder.join("output/s_sweep"))
}

#[test]
fn a_sweep_that_was_killed_goes_on_and_parts_are_the_whole() {
    let position = folder();
    let folder = position.path();
    let complete = sweep(folder, "");
    let table = String::from_utf8(complete["sweep.csv"].clone()).unwrap();
    assert_eq!(table.lines().count(), 25);
    assert!(
        table.starts_with("run,material.c10 [MPa],plate.width [mm],corrected."),
        "{table}"
    );
    let output = folder.join("output/s_sweep");
    fs::remove_dir_all(&output).unwrap();

    let mut child = start(folder, &format!("sweep {VARIED}"));
    let kept =
        || first_partial(&output).and_then(|partial| fs::read_dir(partial.join(".parts")).ok());
    let count = || {
        kept().map_or(0, |entries| {
            entries
                .flatten()
                .filter(|one| !one.path().to_string_lossy().ends_with(".new"))
                .count()
        })
    };
    wait_for(|| count() >= 5);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(count() >= 5);
    assert!(
        sweep(folder, "") == complete,
        "what a killed sweep has left and what is added are the whole"
    );

    let missing = run(folder, &format!("sweep {VARIED} --join 3"));
    assert_ends(&missing, 2, "missing parts of 3: 1, 2, 3");
    for part in 1..=3 {
        let done = run(folder, &format!("sweep {VARIED} --shard {part}/3"));
        let printed = String::from_utf8_lossy(&done.stdout);
        assert!(printed.starts_with("8 runs"), "{printed}");
    }
    let other = VARIED.replace("12", "11");
    assert_ends(
        &run(folder, &format!("sweep {other} --join 3")),
        2,
        "not those of this sweep",
    );
    let joined = sweep(folder, " --join 3");
    assert_eq!(joined["sweep.csv"], complete["sweep.csv"]);
    assert_eq!(joined["sweep.json"], complete["sweep.json"]);
}

#[test]
fn a_sweep_of_other_cards_is_another_sweep() {
    let position = folder();
    let (folder, output) = (position.path(), &position.path().join("output/s_sweep"));
    let card = fs::read_to_string(crate::common::root().join("materials/neo-hooke.toml")).unwrap();
    fs::write(folder.join("a.toml"), &card).unwrap();
    let arguments = "sweep s.toml --vary material.card=a.toml --vary plate.width=40..60mm:24";
    let mut child = start(folder, arguments);
    let kept = |run: usize| {
        first_partial(output).is_some_and(|partial| partial.join(format!(".parts/{run}")).exists())
    };
    wait_for(|| (1..=24).any(kept));
    child.kill().unwrap();
    child.wait().unwrap();
    fs::write(
        folder.join("a.toml"),
        card.replace("0.05 MPa\"", "0.1 MPa\""),
    )
    .unwrap();
    let done = run(folder, arguments);
    assert!(done.status.success(), "{}", output_text(&done));
    let after = fs::read(output.join("sweep.csv")).unwrap();
    fs::remove_dir_all(output).unwrap();
    run(folder, arguments);
    assert!(after == fs::read(output.join("sweep.csv")).unwrap());
}

#[test]
fn runs_without_a_solution_stand_in_the_table() {
    let position = folder();
    let folder = position.path();
    let done = run(
        folder,
        "sweep s.toml --vary mass_spring.max_iterations=1,40",
    );
    assert_eq!(done.status.code(), Some(1));
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(
        printed.starts_with("2 runs; 1 of them without a solution somewhere"),
        "{printed}"
    );
    let table = fs::read(folder.join("output/s_sweep/sweep.csv")).unwrap();
    let keys = ["mass_spring.max_iterations".to_owned()];
    let rows = gelbench::sweep::read(Path::new("sweep.csv"), &keys, &table).unwrap();
    assert!(
        rows[0].fault.contains("no convergence in 1 iterations"),
        "{}",
        rows[0].fault
    );
    assert_eq!(rows[1].fault, "");
    let force = |row: usize| rows[row].figure("finite_element.force_N@0.2");
    assert_eq!(
        force(0),
        force(1),
        "the other models of a run stand in the table"
    );
    assert_eq!(rows[0].figure("mass_spring.force_N@0.2"), None);
}

/// The column of a table below a head.
fn column<'a>(table: &'a str, head: &str) -> Vec<&'a str> {
    let heads: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let position = heads.iter().position(|name| *name == head);
    let position = position.unwrap_or_else(|| panic!("{head}: {heads:?}"));
    let rows = table.lines().skip(1);
    rows.map(|row| row.split(',').nth(position).unwrap())
        .collect()
}

#[test]
fn parameters_of_softening_and_relaxation_are_varied_by_the_names_that_fits_have_for_them() {
    let position = folder();
    let card = "\
law = \"neo-hooke\"
title = \"soft\"
[parameters]
c10 = \"0.05 MPa\"
[softening]
r = 2.0
m = \"0.005 MPa\"
beta = 0.1
[viscosity]
relaxation = [{ share = 0.2, time = \"1 s\" }, { share = 0.1, time = \"10 s\" }]
[data]
test = \"none\"
stress_measure = \"nominal\"
strain_measure = \"nominal\"
offset = \"subtract\"
stretch_range = [0.5, 3.0]
[source]
citation = \"made\"
specimen = \"none\"
";
    fs::write(position.path().join("card.toml"), card).unwrap();
    let study = STUDY.replace("\"neo-hooke\"", "\"card.toml\"").replace(
        "\"20 %\"]",
        "\"20 %\", \"10 %\"]\n[corrector]\nmethod = \"direct\"",
    );
    fs::write(position.path().join("s.toml"), study).unwrap();
    let varied =
        "s.toml --vary material.softening.r=1.5,3 --vary material.relaxation.2.share=0.1,0.2";
    let done = run(position.path(), &format!("sweep {varied}"));
    assert!(done.status.success(), "{}", output_text(&done));
    let files = results(&position.path().join("output/s_sweep"));
    let table = String::from_utf8(files["sweep.csv"].clone()).unwrap();
    let virgin = column(&table, "corrected.force_N@0.1");
    assert!(
        virgin.len() == 4 && virgin.iter().all(|force| force == &virgin[0]),
        "{virgin:?}"
    );
    let forces = column(&table, "corrected.force_N@0.1#2");
    // Plates take no part of the relaxation, and softened ones pull back less.
    assert!(
        forces[0] == forces[1] && forces[0] != forces[2],
        "{forces:?}"
    );
    let done = run(
        position.path(),
        "sweep s.toml --vary material.relaxation.3.share=0.1,0.2",
    );
    assert!(!done.status.success());
}

#[test]
fn few_draws_beyond_what_a_study_may_hold_are_told_and_steps_may_be_varied() {
    let position = folder();
    let varied =
        "s.toml --vary material.c10=0.05+-0.045MPa --vary load.stretches.1=15..25% --samples 16";
    let done = run(position.path(), &format!("sweep {varied}"));
    // Some have no solution.
    assert_ends(&done, 1, "outside the admissible range of a study");
    let file = |name: &str| fs::read(position.path().join("output/s_sweep").join(name)).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&file("sweep.json")).unwrap();
    let failed = report["failed"].as_u64().unwrap();
    assert!((1..=3).contains(&failed), "{failed}");
    let text = String::from_utf8(file("report.md")).unwrap();
    let row = text
        .lines()
        .find(|line| line.contains("corrected.force_N@the last step"));
    let row = row.unwrap_or_else(|| panic!("{text}"));
    assert!(row.contains(&format!("| {} |", 16 - failed)), "{row}");
    assert!(
        text.contains("outside the admissible range of a study"),
        "{text}"
    );
    // More than a few are a mistake.
    let done = run(
        position.path(),
        "sweep s.toml --vary material.c10=0.01+-0.1MPa --samples 16",
    );
    assert_ends(&done, 2, "parameters.c10");
}

#[test]
fn what_cannot_be_varied_is_told_before_anything_is_computed() {
    let position = folder();
    for (arguments, expected) in [
        ("s.toml", "nothing is varied"),
        (
            "s.toml --vary plate.lenght=1mm,2mm",
            "did you mean `length`",
        ),
        ("s.toml --vary material.c10=0.05+-0.01MPa", "--samples"),
        (
            "s.toml --vary plate.width=45mm,50mm --shard 4/3",
            "PART/PARTS",
        ),
        (
            "s.toml --vary plate.width=45mm,50mm --fit s.toml",
            "is not JSON",
        ),
        (
            "s.toml --vary plate.width=45..50mm --samples 0",
            "above zero",
        ),
        ("s.toml --points s.toml", "is not a comma-separated table"),
        ("none.toml --vary plate.width=45mm,50mm", "none.toml"),
    ] {
        let done = run(position.path(), &format!("sweep {arguments}"));
        assert_ends(&done, 2, expected);
    }
}
