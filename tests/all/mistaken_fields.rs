//! Mistakes in files of measured displacements: which are named, where, and how often.

use std::fs;

use tempfile::TempDir;

use crate::common::measured::{NOT_EXPLAINED, corrected, second_frame};
use crate::common::{gelbench, one_line, words};

/// Rows of markers with each displacement changed.
fn changed(text: &str, change: impl Fn([f64; 4]) -> [f64; 2]) -> String {
    let mut table = "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned();
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
        let [x, y, ux, uy] = row[..] else { continue };
        let [ux, uy] = change([x, y, ux, uy]);
        table += &format!("{x},{y},{ux},{uy}\n");
    }
    table
}

/// A mistake in how a field is written: its name in words, and the displacements that it makes of x, y, ux, uy.
type Mistake = (&'static str, fn([f64; 4]) -> [f64; 2]);

const MISTAKES: [Mistake; 3] = [
    (
        "final positions instead of displacements",
        |[x, y, ux, uy]| [x + ux, y + uy],
    ),
    ("displacements with x and y exchanged", |[_, _, ux, uy]| {
        [uy, ux]
    }),
    ("mirrored along y", |[_, _, ux, uy]| [ux, -uy]),
];

fn reversed([_, _, ux, uy]: [f64; 4]) -> [f64; 2] {
    [-ux, -uy]
}

/// The first line that a correction prints, with a doubt.
fn first_doubt(printed: &str) -> &str {
    let first = printed.lines().next().unwrap_or_default();
    assert!(first.starts_with("Doubtful: "), "{printed}");
    first
}

#[test]
fn mistakes_in_a_file_are_named_first_and_once() {
    let text = second_frame(|_| true);
    for (name, change) in MISTAKES {
        let (printed, actual) = corrected(&changed(&text, change), &[], NOT_EXPLAINED);
        assert!(first_doubt(&printed).contains(name), "{name}: {printed}");
        assert_eq!(
            printed.matches("the field seems to be").count(),
            1,
            "{printed}"
        );
        let doubts = actual["doubts"].as_array().unwrap();
        assert!(doubts[0].as_str().unwrap().contains(name), "{doubts:?}");
    }
    let (printed, _) = corrected(&text, &[], 0);
    assert!(!printed.contains("the field seems to be"), "{printed}");
}

/// The error on a field without solution, with free long edges and more options.
fn error_without_solution(table: &str, more: &[&str]) -> String {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), table).unwrap();
    let usual = "correct plate.csv --free top,bottom --thickness";
    let arguments: Vec<&str> = usual.split(' ').chain(["2 mm"]).collect();
    let done = gelbench(folder.path(), &[&arguments, more].concat()).code(2);
    one_line(&done.get_output().stderr)
}

/// A plate that is pushed by half of its length between rigid grips buckles, a free one that widens as it is pulled is none, and neither is one
/// that becomes smaller everywhere though its edges are free: there is no field to judge.
#[test]
fn mistakes_are_named_where_no_equilibrium_is_near() {
    let text = changed(&second_frame(|_| true), reversed);
    let plate = "--material pva-10 --robust tukey --rigid left,right";
    let plate: Vec<&str> = plate.split(' ').collect();
    let strip = |[a, b]: [f64; 2]| {
        let positions = (0..21 * 9).map(|k| [5.0 * f64::from(k / 9), 5.0 * f64::from(k % 9)]);
        let rows = positions.map(|[x, y]| format!("{x},{y},{},{}\n", a * x, b * y));
        "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned() + &rows.collect::<String>()
    };
    let mirrored = strip([-0.3, 1.3_f64.sqrt().recip() - 1.0]);
    let pressed = strip([-0.3, -0.3]);
    let gel = &["--material", "neo-hooke", "--cell-size", "5 mm"][..];
    for (table, more, expected) in [
        (
            &text,
            &plate[..],
            ", but seems to be displacements with reversed sign",
        ),
        (&mirrored, gel, ", but seems to be mirrored along x"),
        (
            &pressed,
            gel,
            " with the stated conditions, but is explained if top and bottom moved in an unknown way",
        ),
    ] {
        let message = error_without_solution(table, more);
        let expected = format!("the field has no solution{expected}");
        assert!(message.contains(&expected), "{message}");
    }
}

/// Where nothing is said of the edges, any field is explained by edges of unknown motion.
#[test]
fn a_reversed_sign_is_named_where_edges_are_not_stated_too() {
    let folder = TempDir::new().unwrap();
    fs::write(
        folder.path().join("plate.csv"),
        changed(&second_frame(|_| true), reversed),
    )
    .unwrap();
    let arguments = [
        "correct",
        "plate.csv",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
    ];
    let done = gelbench(folder.path(), &arguments);
    let printed = words(&done.get_output().stdout);
    assert!(
        first_doubt(&printed).contains("with reversed sign"),
        "{printed}"
    );
}

/// A square that is pulled along both axes, more along x, with waves too long to tell from noise: not mirrored, though it widens.
#[test]
fn a_biaxial_test_is_not_told_to_be_mirrored() {
    let text = second_frame(|[x, _]| x < 51.0);
    let stretched = |[x, y, ..]: [f64; 4]| {
        let wave = 0.4 * (x / 9.0).sin() * (y / 7.0).cos();
        [0.3 * x + wave, 0.11 * y + wave]
    };
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("square.csv"), changed(&text, stretched)).unwrap();
    let arguments = [
        "correct",
        "square.csv",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
    ];
    let done = gelbench(folder.path(), &arguments).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("the data cannot judge"), "{printed}");
    assert!(!printed.contains("mirrored"), "{printed}");
    assert!(!printed.contains("the field seems to be"), "{printed}");
}

#[test]
fn doubts_are_printed_once_for_all_frames_and_as_wide_as_the_terminal() {
    let folder = TempDir::new().unwrap();
    let frame = changed(&second_frame(|_| true), |[_, _, ux, uy]| [ux, uy]);
    let rows = || frame.lines().skip(1);
    let frames = (1..=3).flat_map(|number| rows().map(move |row| format!("{number},{row}\n")));
    let table: String = frames.collect();
    fs::write(
        folder.path().join("plate.csv"),
        format!("frame,x [mm],y [mm],ux [mm],uy [mm]\n{table}"),
    )
    .unwrap();
    let mut command = assert_cmd::Command::cargo_bin("gelbench").unwrap();
    let arguments = "correct plate.csv --material pva-10 --noise 0.0005mm --edge-gap 0mm --rigid left,right --free top,bottom";
    let arguments = arguments.split(' ').chain(["--thickness", "2 mm"]);
    let command = command.current_dir(folder.path()).args(arguments);
    let done = command.env("COLUMNS", "60").assert().code(1);
    let output = done.get_output();
    let (printed, errors) = (words(&output.stdout), words(&output.stderr));
    let all = one_line(&output.stdout) + &one_line(&output.stderr);
    let stated = "doubtful: frames 1 to 3: the markers scatter";
    assert_eq!(all.matches(stated).count(), 1, "{all}");
    assert_eq!(all.matches("their stated noise").count(), 1, "{all}");
    let longest = printed.lines().chain(errors.lines());
    let longest = longest.map(|line| line.chars().count()).max();
    assert!(longest <= Some(60), "{printed}{errors}");
}
