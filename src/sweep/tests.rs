use std::collections::HashMap;
use std::path::Path;

use super::*;
use gelbench_base::budget::Budget;
use gelbench_report::results::Drawing;

mod points;

const STUDY: &str = "\
title = \"small\"
[plate]
cells = [6, 2]
[material]
card = \"neo-hooke\"
[load]
stretches = [\"10 %\", \"20 %\"]
[finite_element]
cells = [8, 4]
[output]
report = false
";

fn sweep(vary: &[&str], samples: Option<usize>) -> Sweep {
    Sweep {
        study: BaseStudy {
            path: Path::new("small.toml").to_owned(),
            text: STUDY.to_owned(),
            files: Vec::new(),
            budget: Budget::USUAL,
        },
        variables: vary
            .iter()
            .map(|text| Variable::parse(text).unwrap())
            .collect(),
        points: None,
        fitted: None,
        sampling: Sampling {
            samples,
            method: Method::Sobol,
            seed: 1,
        },
    }
}

fn rows(sweep: &Sweep) -> Vec<Row> {
    let runs = sweep.runs().unwrap();
    sweep
        .compute(&runs, HashMap::new(), &|_| Ok(()), &|| ())
        .unwrap()
}

#[test]
fn forces_are_proportional_to_stiffness_and_thickness_in_every_combination() {
    let sweep = sweep(
        &["material.c10=0.05..0.1 MPa:2", "plate.thickness=1 mm,3 mm"],
        None,
    );
    let rows = rows(&sweep);
    let forces: Vec<f64> = rows
        .iter()
        .map(|row| row.figure("finite_element.force_N@0.2").unwrap())
        .collect();
    assert_eq!(rows.len(), 4);
    for (force, factor) in forces.iter().zip([1.0, 3.0, 2.0, 6.0]) {
        assert!((force / forces[0] - factor).abs() < 1e-6, "{forces:?}");
    }
    assert_eq!(statistics(&rows)[0].runs, 4);
}

#[test]
fn what_is_kept_is_not_computed_again_and_a_table_is_read_as_it_was_written() {
    let sweep = sweep(
        &["plate.width=40..60 mm:3", "mass_spring.area_term=0,1"],
        None,
    );
    let fault = sweep.compute(&sweep.runs().unwrap(), HashMap::new(), &|_| Ok(()), &|| ());
    let message = fault.unwrap_err().to_string();
    assert!(
        message.contains("run 1") && message.contains("area_term"),
        "{message}"
    );

    let sweep = super::tests::sweep(&["plate.width=40..60 mm:3"], None);
    let runs = sweep.runs().unwrap();
    let first = rows(&sweep);
    let done: HashMap<usize, Row> = first[..2]
        .iter()
        .map(|row| (row.number, row.clone()))
        .collect();
    let computed = std::sync::Mutex::new(Vec::new());
    let again = sweep.compute(
        &runs,
        done,
        &|row| {
            computed.lock().unwrap().push(row.number);
            Ok(())
        },
        &|| (),
    );
    assert_eq!(again.unwrap(), first);
    assert_eq!(*computed.lock().unwrap(), [3]);
    let table = write(&sweep.keys(), &first);
    assert_eq!(
        read(Path::new("sweep.csv"), &sweep.keys(), &table).unwrap(),
        first
    );
}

#[test]
fn pictures_and_statistics_say_what_a_reader_expects() {
    let sweep = sweep(&["plate.thickness=1..3 mm:10"], None);
    let (rows, keys) = (rows(&sweep), sweep.keys());
    let figures = figures(&keys, &rows, sweep.study.steps_run_along());
    let names: Vec<&str> = figures.iter().map(|figure| &*figure.name).collect();
    assert_eq!(names, ["band.png", "force_over_plate_thickness.png"]);
    let axes = |index: usize| match &figures[index].drawing {
        Drawing::Charts(charts) => [&charts[0].0.x, &charts[0].0.y].map(|axis| axis.label.clone()),
        other => panic!("{other:?}"),
    };
    assert_eq!(axes(0)[0], "stretch [%]");
    assert_eq!(
        axes(1),
        ["plate.thickness [mm]", "force at 20 % stretch [N]"]
    );
    let caption = &figures[1].caption;
    assert!(
        caption.contains("at 20 % stretch over plate.thickness"),
        "{caption}"
    );
    // Across a symmetric plate a force is rounding: in the table of all runs, but not in their statistics.
    let report = format!("{:?}", blocks("small", &keys, &rows, &figures));
    let small = |row: &Row, name: &String| row.figure(name).is_some_and(|value| value.abs() < 1e-9);
    let all = rows[0].figures.iter().map(|(name, _)| name);
    let forces = all.filter(|name| name.contains("force_N") && name.ends_with("@0.2"));
    for name in forces {
        let is_rounding = rows.iter().all(|row| small(row, name));
        assert_eq!(
            report.contains(&format!("\"{name}\"")),
            !is_rounding,
            "{name}"
        );
    }
}

#[test]
fn every_run_is_in_one_part_and_parts_of_others_are_refused() {
    let sweep = sweep(&["plate.width=40..60 mm:7"], None);
    let runs = sweep.runs().unwrap();
    let shards: Vec<Shard> = (1..=3).filter_map(|part| Shard::new(part, 3)).collect();
    for run in &runs {
        let holders = shards.iter().filter(|shard| shard.holds(run)).count();
        assert_eq!(holders, 1, "run {}", run.number);
    }
    assert!(Shard::new(0, 3).is_none() && Shard::new(4, 3).is_none());
    let row = |run: &Run| Row::failed(run, "none".to_owned(), Vec::new());
    let mut rows: Vec<Row> = runs.iter().rev().map(row).collect();
    let joined = join(&runs, rows.clone()).unwrap();
    assert!(joined.iter().map(|row| row.number).eq(1..=7));
    rows[3].settings[0] = Setting::Number(1.0, "mm".to_owned());
    assert!(join(&runs, rows.clone()).is_err());
    rows.remove(3);
    assert!(join(&runs, rows).is_err());
}

#[test]
fn a_sweep_over_other_keys_or_values_goes_beside_the_one_that_is_there() {
    let position = tempfile::TempDir::new().unwrap();
    let output = position.path().join("out");
    let open = |sweep: &Sweep, then: &dyn Fn(SweepFolder)| {
        then(SweepFolder::open(sweep, Share::Whole, &output, &[], None).unwrap());
    };
    let (width, thickness) = (
        sweep(&["plate.width=40..60 mm:2"], None),
        sweep(&["plate.thickness=1..2 mm:2"], None),
    );
    open(&width, &|mut folder| {
        assert!(folder.replaces().is_none());
        let rows = folder.rows(&|_| (), &|| ()).unwrap();
        folder.finish(&rows).unwrap();
    });
    open(&width, &|folder| assert!(folder.replaces().is_none()));
    open(&thickness, &|folder| {
        let message = folder.replaces().unwrap().message;
        assert!(
            message.contains("another sweep: it is replaced"),
            "{message}"
        );
    });
    let adjacent = free_folder(&thickness, output.clone()).unwrap();
    assert!(adjacent.ends_with("out_2"), "{adjacent:?}");
    assert_eq!(free_folder(&width, output.clone()).unwrap(), output);
    for other in [
        "width=40..62 mm:2",
        "length=40..60 mm:2",
        "width=40..60 cm:2",
    ] {
        let other = sweep(&[format!("plate.{other}").as_str()], None);
        assert_eq!(free_folder(&other, output.clone()).unwrap(), adjacent);
    }
}

#[test]
fn values_are_each_one_and_without_the_noise_of_their_last_digits() {
    let message = Variable::parse("plate.width=40,50,40 mm")
        .unwrap_err()
        .to_string();
    assert!(message.contains("the value 40 occurs twice"), "{message}");
    let Values::Listed(values) = Variable::parse("x=0.3..0.6:11").unwrap().values else {
        panic!("no grid");
    };
    let words: Vec<String> = values.iter().map(Setting::plain_text).collect();
    assert_eq!(words[3], "0.39");
    let cells = Values::Listed([20, 40, 60].map(Setting::Integer).into());
    let grid = Variable::parse("plate.cells.0=20..60:3").unwrap();
    assert_eq!(grid.values, cells);
}

#[test]
fn a_computation_that_is_broken_off_leaves_the_runs_that_have_ended() {
    use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
    let position = tempfile::TempDir::new().unwrap();
    let output = position.path().join("out");
    let sweep = sweep(&["plate.width=40..60 mm:6"], None);
    let pushed = std::sync::Mutex::new(Vec::new());
    let open = || SweepFolder::open(&sweep, Share::Whole, &output, &[], None).unwrap();
    let broken = catch_unwind(AssertUnwindSafe(|| {
        let ended = |number: usize| pushed.lock().unwrap().push(number);
        let attend = || {
            let count = pushed.lock().unwrap().len();
            if count > 1 {
                resume_unwind(Box::new("stop"));
            }
        };
        open().rows(&ended, &attend).map(drop)
    }));
    assert!(broken.is_err());
    let ended = pushed.into_inner().unwrap();
    assert!((2..6).contains(&ended.len()), "{ended:?}");
    let mut folder = open();
    let parts = folder.as_ref().unfinished().partial.join(".parts");
    for number in &ended {
        assert!(parts.join(number.to_string()).is_file(), "run {number}");
    }
    let resumed = folder.rows(&|_| (), &|| ()).unwrap();
    assert_eq!(resumed, super::tests::rows(&sweep));
}

/// Beyond the range of the card, as `run` would say; once of all runs.
#[test]
fn what_deserves_attention_in_single_runs_is_told_of_all_together() {
    let mut sweep = sweep(&["plate.thickness=1 mm,2 mm"], None);
    let warnings = cautions(&rows(&sweep));
    assert!(
        !warnings.iter().any(|one| one.contains("range")),
        "{warnings:?}"
    );
    let pressed = STUDY.replace("10 %", "-5 %").replace("20 %", "-10 %");
    sweep.study.text = pressed.replace("neo-hooke", "pva-10-yeoh");
    let rows = rows(&sweep);
    let warnings = cautions(&rows);
    let outside: Vec<&String> = warnings
        .iter()
        .filter(|one| one.contains("range"))
        .collect();
    assert!(
        matches!(outside[..], [one] if one.starts_with("Run 1 and another: ")),
        "{warnings:?}"
    );
    let keys = sweep.keys();
    let read = read(Path::new("a.csv"), &keys, &write(&keys, &rows)).unwrap();
    assert_eq!(read, rows);
    assert_eq!(json(&keys, &rows)["warnings"][0], warnings[0]);
    // Each kind of warning once, without a word before it.
    assert!(
        warnings.iter().all(|one| !one.contains("Warning")),
        "{warnings:?}"
    );
}

#[test]
fn quantiles_that_leave_out_runs_without_a_solution_are_called_biased() {
    let sweep = sweep(&["plate.thickness=1..2 mm:3"], None);
    let mut rows = rows(&sweep);
    let before = cautions(&rows);
    let run = &sweep.runs().unwrap()[1];
    rows[1] = Row::failed(run, "no solution".into(), Vec::new());
    let warnings = cautions(&rows);
    assert_eq!(warnings.len(), before.len() + 1, "{warnings:?}");
    assert!(
        warnings[0].starts_with("1 of 3 runs") && warnings[0].contains("biased"),
        "{warnings:?}"
    );
}
