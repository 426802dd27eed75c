//! Measured displacements that leave something open or contradict what is said: what is told, and which intervals hold.

use std::fs;

use gelbench_base::statistics::normal_numbers;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use tempfile::TempDir;

use crate::common::measured::{NOT_EXPLAINED, corrected, right_force, second_frame};
use crate::common::{gelbench, number, report_of_correction as report, root, words};

/// Corrects markers of the plate of whose grips nothing is known, with free long edges.
fn loosely_corrected(text: &str, more: &[&str]) -> (String, Value) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), text).unwrap();
    let loose = "[[edges]]\nnames = [\"left\", \"right\"]\ncondition = \"unknown\"\n\
                 [[edges]]\nnames = [\"top\", \"bottom\"]\ncondition = \"free\"\n";
    fs::write(folder.path().join("loose.toml"), loose).unwrap();
    let usual = [
        "correct",
        "plate.csv",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
    ];
    let arguments = [&usual[..], &["--robust", "tukey"], more].concat();
    let done = gelbench(folder.path(), &arguments).code(0);
    (words(&done.get_output().stdout), report(folder.path()))
}

/// The plate's force in frame 2 in N, by converged finite elements.
const FORCE: f64 = 12.875;

#[test]
fn markers_that_end_inside_the_edge_leave_the_force_open() {
    let inner = second_frame(|[x, y]| (1.0..149.0).contains(&x) && (1.0..49.0).contains(&y));
    // The outermost markers are no grips then: that they moved as rigid ones is contradicted.
    let (printed, result) = corrected(&inner, &[], NOT_EXPLAINED);
    assert!(
        printed.contains("the data contradict the stated condition on right, left")
            || printed.contains("the data contradict the stated condition on left, right"),
        "{printed}"
    );
    assert!(
        printed.contains("the specimen's edge is not known"),
        "{printed}"
    );
    // No interval says more than is known.
    let frame = &result["steps"][0]["corrected"];
    for force in frame["forces"].as_array().unwrap() {
        assert!(force["x_N"]["value"].is_number() && force["x_N"]["interval"].is_null());
    }
    assert!(printed.contains("interval: not explained"), "{printed}");
    // Grips that are not said to be rigid: the interval holds an edge that is nobody's knowledge.
    let loose = ["--study", "loose.toml"];
    let (_, result) = loosely_corrected(&inner, &loose);
    let [force, low, high] = right_force(&result, "x_N");
    assert!(
        force < 0.85 * FORCE && low < force && high > FORCE,
        "{force} {low} {high}"
    );
    // Said, the force is right and sure.
    let (_, result) = corrected(&inner, &["--edge-gap", "5 mm"], 0);
    let [force, low, high] = right_force(&result, "x_N");
    assert!((force / FORCE - 1.0).abs() < 0.01, "{force}");
    assert!(
        low < FORCE && high > FORCE && high - low < 0.03 * FORCE,
        "{low} {high}"
    );
}

#[test]
fn half_a_subset_lies_between_the_outermost_markers_and_the_edge() {
    let inner = second_frame(|[x, y]| (1.0..149.0).contains(&x) && (1.0..49.0).contains(&y));
    let turned = |line: &str| {
        let [x, y, ux, uy] = line.split(',').collect::<Vec<_>>()[..] else {
            return String::new();
        };
        if uy.is_empty() {
            format!("{x},-{y},,,0\n")
        } else {
            format!("{x},-{y},{ux},{},0\n", format!("-{uy}").replace("--", ""))
        }
    };
    let rows: String = inner.lines().skip(1).map(turned).collect();
    let dice = format!(
        "***\n*** Subset size: 10\n*** Step size: x 5 y 5 (-1 implies not regular grid)\n***\n\
         COORDINATE_X,COORDINATE_Y,DISPLACEMENT_X,DISPLACEMENT_Y,MATCH\n{rows}"
    );
    let (printed, result) = corrected(&dice, &["--unit", "1 mm", "--cell-size", "10 mm"], 0);
    let message = "assumed to lie 5.0000 mm outside the outermost markers, half a subset";
    assert!(printed.contains(message), "{printed}");
    let origin = result["problem"]["mesh"]["origin"].as_str().unwrap();
    assert!(
        origin.contains("widened by 5.0000 mm, half a subset (subset 10 and step 5 pixels according to the header of plate.csv)"),
        "{origin}"
    );
    let [force, low, high] = right_force(&result, "x_N");
    assert!((force / FORCE - 1.0).abs() < 0.01, "{force}");
    // Up to a step farther out is left open.
    assert!(low < FORCE && high > 1.1 * FORCE, "{low} {high}");
    let step = number(&result, &["problem", "edge_may_lie_farther_out_by_mm"]);
    assert!((step - 5.0).abs() < 1e-9, "{step}");
    // What the user says goes before.
    let (printed, result) = corrected(
        &dice,
        &[
            "--unit",
            "1 mm",
            "--cell-size",
            "10 mm",
            "--edge-gap",
            "5 mm",
        ],
        0,
    );
    assert!(!printed.contains("half a subset"), "{printed}");
    assert!(result["problem"]["edge_may_lie_farther_out_by_mm"].is_null());
}

#[test]
fn what_the_data_contradict_stands_beside_the_figures_and_in_the_exit_code() {
    let gap = ["--edge-gap", "0 mm"];
    let complete = second_frame(|_| true);
    let (printed, result) = corrected(&complete, &gap, 0);
    assert!(!printed.contains("doubtful"), "{printed}");
    assert!(
        printed.contains("verdict, frame 1: explained\n"),
        "{printed}"
    );
    assert!(number(&result, &["balance", "worst"]) < 1e-9);
    let [_, low, high] = right_force(&result, "x_N");
    assert!(low < FORCE && high > FORCE, "{low} {high}");
    let cut = second_frame(|[x, _]| x < 101.0);
    for (text, more, message, code) in [
        (
            &complete,
            vec!["--force", "right x 6.4 N ± 0.1 N"],
            "contradicts the field's",
            NOT_EXPLAINED,
        ),
        (
            &complete,
            vec!["--thickness", "1 mm", "--force", "right x 12.9 N ± 0.1 N"],
            "contradicts the field's",
            NOT_EXPLAINED,
        ),
        (
            &complete,
            vec!["--noise", "0.0005 mm"],
            "times as much as their stated noise, more than chance allows: the stated noise is rescaled",
            1,
        ),
        (
            &cut,
            vec![],
            "the data contradict the stated condition on",
            NOT_EXPLAINED,
        ),
    ] {
        let (printed, result) = corrected(text, &[&gap[..], &more].concat(), code);
        assert!(
            printed.contains("doubtful") && printed.contains(message),
            "{more:?}: {printed}"
        );
        let doubts = result["doubts"].as_array().unwrap();
        let adjacent = |doubt: &Value| doubt.as_str().unwrap().contains(message);
        assert!(doubts.iter().any(adjacent), "{doubts:?}");
        if code == 1 {
            // The scaled noise has intervals that hold.
            let [_, low, high] = right_force(&result, "x_N");
            assert!(low < FORCE && high > FORCE, "{low} {high}");
        } else {
            assert!(printed.contains("not explained by this law, thickness and conditions"));
        }
    }
}

/// The markers of the second frame with means of white noise over squares of so many markers.
fn with_smooth_noise(across: usize) -> String {
    let mut normal = normal_numbers(21);
    let white: Vec<f64> = (0..2 * 40 * 20).map(|_| normal()).collect();
    let mut table = "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned();
    for line in second_frame(|_| true).lines().skip(1) {
        let line: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
        let [x, y, ux, uy] = line[..] else { continue };
        let [i, j] = [x, y].map(|x| (x / 5.0).round() as usize);
        let noise = [0, 1].map(|axis| {
            let around =
                (0..across * across).map(|k| (20 * (i + k / across) + j + k % across, axis));
            0.5 * around.map(|(at, axis)| white[2 * at + axis]).sum::<f64>() / across as f64
        });
        table += &format!("{x},{y},{},{}\n", ux + noise[0], uy + noise[1]);
    }
    table
}

#[test]
fn noise_that_correlates_is_told_and_held_by_the_intervals() {
    let (printed, result) = corrected(&with_smooth_noise(2), &["--edge-gap", "0 mm"], 0);
    assert!(
        printed.contains("explained with correlated noise"),
        "{printed}"
    );
    let length = number(
        &result["steps"][0]["corrected"],
        &["verdict", "correlation_length_mm"],
    );
    assert!((2.5..15.0).contains(&length), "{length}");
    let [_, low, high] = right_force(&result, "x_N");
    assert!(
        low < FORCE && high > FORCE && high - low > 0.01 * FORCE,
        "{low} {high}"
    );
}

#[test]
fn noise_of_which_few_independent_values_are_left_cannot_be_judged() {
    let (printed, result) = corrected(&with_smooth_noise(4), &["--edge-gap", "0 mm"], 1);
    assert!(
        printed.contains("the data cannot judge") && printed.contains("too few to tell noise"),
        "{printed}"
    );
    assert!(!printed.contains("not explained"), "{printed}");
    let [_, low, high] = right_force(&result, "x_N");
    assert!(low < FORCE && high > FORCE, "{low} {high}");
}

#[test]
fn half_of_the_markers_lost_gives_no_interval_that_lies() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let kept: Vec<bool> = (0..341).map(|_| random.random::<f64>() < 0.5).collect();
    let index = |[x, y]: [f64; 2]| 11 * (x / 5.0).round() as usize + (y / 5.0).round() as usize;
    let half = second_frame(|position| kept[index(position)]);
    // The interval holds an edge that is nobody's knowledge.
    let (printed, result) = corrected(&half, &[], 1);
    assert!(
        printed.contains("the outline of the markers is uncertain"),
        "{printed}"
    );
    let [force, low, high] = right_force(&result, "x_N");
    assert!((force / FORCE - 1.0).abs() < 0.05, "{force}");
    assert!(low < FORCE && high > FORCE, "{low} {high}");
    // Where lost markers still have rows, their places are the outline.
    let mut rows = second_frame(|_| true);
    rows = rows
        .lines()
        .enumerate()
        .map(|(line, row)| match row.split(',').collect::<Vec<_>>()[..] {
            [x, y, ..] if line > 0 && !kept[line - 1] => format!("{x},{y},,\n"),
            _ => format!("{row}\n"),
        })
        .collect();
    let (_, result) = corrected(&rows, &["--edge-gap", "0 mm"], 0);
    let [_, low, high] = right_force(&result, "x_N");
    assert!(
        low < FORCE && high > FORCE && high - low < 0.03 * FORCE,
        "{low} {high}"
    );
}

#[test]
fn a_gap_is_a_hole_whether_its_points_have_rows_or_not() {
    let in_gap = |[x, y]: [f64; 2]| (x - 75.0).abs() < 12.5 && (y - 25.0).abs() < 12.5;
    let without_rows = second_frame(|position| !in_gap(position));
    let emptied = |row: &str| match row.split(',').collect::<Vec<_>>()[..] {
        [x, y, ..] if in_gap([x, y].map(|at| at.parse().unwrap_or(f64::NAN))) => {
            format!("{x},{y},NaN,NaN\n")
        }
        _ => format!("{row}\n"),
    };
    let with_rows: String = second_frame(|_| true).lines().map(emptied).collect();
    let (printed, left_out) = corrected(&without_rows, &[], NOT_EXPLAINED);
    assert!(printed.contains("treated as holes: 1"), "{printed}");
    let (printed, empty) = corrected(&with_rows, &[], NOT_EXPLAINED);
    // A marker beside the 25 was lost.
    assert!(
        printed.contains("treated as holes: 1, with 26 points in them"),
        "{printed}"
    );
    let forces = |report: &Value| report["steps"][0]["corrected"]["forces"].clone();
    assert_eq!(forces(&left_out), forces(&empty));
    // The plate has none.
    let closed = ["--holes", "closed", "--edge-gap", "0 mm"];
    let (_, closed) = corrected(&with_rows, &closed, 0);
    let [_, low, high] = right_force(&closed, "x_N");
    assert!(low < FORCE && FORCE < high, "{low} … {high}");
}

#[test]
fn cells_become_smaller_until_their_own_error_is_a_small_part_of_the_intervals() {
    let text = second_frame(|_| true);
    let coarse = ["--cell-size", "25 mm", "--edge-gap", "0 mm"];
    let share = |report: &Value| {
        let frame = &report["steps"][0]["corrected"];
        number(frame, &["mesh_error_dominates_area_percent"])
    };
    let width = |report: &Value| {
        let [_, low, high] = right_force(report, "x_N");
        assert!(low < FORCE && FORCE < high, "{low} … {high}");
        high - low
    };
    let (_, before) = corrected(&text, &coarse, 0);
    assert!(share(&before) > 20.0, "{}", share(&before));
    let (_, after) = corrected(&text, &[&coarse[..], &["--refine"]].concat(), 0);
    assert!(share(&after) <= 5.0, "{}", share(&after));
    assert!(width(&after) < width(&before));
}

#[test]
fn cells_that_are_given_are_not_made_smaller() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), second_frame(|_| true)).unwrap();
    let usual = [
        "correct",
        "plate.csv",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
        "--refine",
    ];
    let output = |more: &[&str]| {
        let done = gelbench(folder.path(), &[&usual[..], more].concat()).code(2);
        words(&done.get_output().stderr)
    };
    let together = output(&["--together"]);
    assert!(
        together.contains("--refine") && together.contains("--together"),
        "{together}"
    );
    let mesh = root().join("validation/measured/skin_forearm/skin_mesh.msh");
    let given = output(&["--mesh", mesh.to_str().unwrap()]);
    assert!(given.contains("leave out --refine"), "{given}");
}
