//! Markers that are farther off than noise can explain, where nothing is said of their weights.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{gelbench, report_of_correction, root, words};

/// Standard deviation of the example's noise in mm; one marker in fifty is off by 3 to 8 mm.
const NOISE: f64 = 0.25;

/// What is known of the plate's edges.
const EDGES: [&str; 6] = [
    "--rigid",
    "left,right",
    "--free",
    "top,bottom",
    "--edge-gap",
    "0 mm",
];

/// The example's markers.
fn markers() -> String {
    fs::read_to_string(root().join("examples/measured_plate.csv")).unwrap()
}

/// What is printed and reported of markers of the plate, and their first frame.
fn corrected(markers: &str, options: &[&str]) -> (String, Value) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), markers).unwrap();
    let usual = ["correct", "plate.csv", "--material", "pva-10"];
    let more = ["--thickness", "2 mm"];
    let done = gelbench(folder.path(), &[&usual[..], &more, options].concat());
    let written = fs::read_to_string(folder.path().join("output/correct/report.md")).unwrap();
    let printed = words(&done.get_output().stdout) + &written;
    let report = report_of_correction(folder.path());
    (printed, report["steps"][0]["corrected"].clone())
}

#[test]
fn gross_errors_have_no_say_unless_it_is_said_that_they_have() {
    const TOLD: &str = "farther off than noise can explain";
    let weighted = |weights: &[&str]| corrected(&markers(), &[&EDGES, weights].concat());
    let (text, result) = weighted(&[]);
    assert_eq!(result["weights"], "tukey");
    assert!((result["noise_mm"].as_f64().unwrap() / NOISE - 1.0).abs() < 0.1);
    // Of both frames at once, in the terminal and in the report.
    assert_eq!(text.matches(TOLD).count(), 2, "{text}");
    let (_, printed) = weighted(&["--robust", "tukey"]);
    assert_eq!(result["forces"], printed["forces"]);
    let (text, all) = weighted(&["--robust", "no"]);
    assert_eq!(all["weights"], "no");
    assert!(all["noise_mm"].as_f64().unwrap() > 2.0 * NOISE);
    assert!(!text.contains(TOLD), "{text}");
}

#[test]
fn gross_errors_that_keep_an_estimate_from_being_found_have_no_say() {
    // Without the rows along the edges, and with nothing said of any edge.
    let text = markers();
    let is_inside = |line: &&str| {
        let position: Vec<&str> = line.split(',').collect();
        !line.starts_with(|first: char| first.is_ascii_digit())
            || (!["0", "150"].contains(&position[1]) && !["0", "50"].contains(&position[2]))
    };
    let inside: Vec<&str> = text.lines().filter(is_inside).collect();
    let (_, result) = corrected(&inside.join("\n"), &[]);
    assert_eq!(result["weights"], "tukey");
    assert!((result["noise_mm"].as_f64().unwrap() / NOISE - 1.0).abs() < 0.1);
}

/// The first frame with every third marker anywhere, and what more there is of it.
fn with_a_third_anywhere() -> String {
    let mut text = String::new();
    for (number, line) in markers().lines().enumerate() {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        if line.starts_with("1,") && number % 3 == 0 && !fields[3].is_empty() {
            let turn = 2.4 * number as f64;
            let far = 4.0 + (number % 7) as f64;
            for (field, by) in fields[3..].iter_mut().zip([turn.cos(), turn.sin()]) {
                let moved = field.parse::<f64>().unwrap() + far * by;
                *field = format!("{moved:.4}");
            }
        }
        if !line.starts_with("2,") {
            text += &(fields.join(",") + "\n");
        }
    }
    text
}

#[test]
fn many_gross_errors_that_lie_scattered_have_no_say_and_are_a_doubt() {
    let (text, result) = corrected(&with_a_third_anywhere(), &EDGES);
    assert_eq!(result["weights"], "tukey", "{text}");
    let noise = result["noise_mm"].as_f64().unwrap();
    // The median of all, of which two thirds have noise alone, lies at the three quarters of these: 1.41 times as far.
    assert!((1.0..1.7).contains(&(noise / NOISE)), "{noise}");
    assert!(
        text.contains("markers are outliers, more than noise explains"),
        "{text}"
    );
    // Without weights their size is taken for noise, by which nothing can be judged.
    let (text, result) = corrected(
        &with_a_third_anywhere(),
        &[&EDGES[..], &["--robust", "no"]].concat(),
    );
    assert!(result["noise_mm"].as_f64().unwrap() > 5.0 * NOISE);
    let verdict = &result["verdict"];
    assert_eq!(verdict["answer"], "the data cannot judge", "{text}");
    assert!(text.contains("interval: the noise is that of gross errors"));
    assert!(text.contains("of the specimen's smaller extent"), "{text}");
}

#[test]
fn a_frame_that_cannot_be_corrected_leaves_the_others_theirs() {
    let good: Vec<String> = markers().lines().map(str::to_owned).collect();
    let first: Vec<&String> = good.iter().filter(|line| line.starts_with("1,")).collect();
    let head: Vec<&String> = good
        .iter()
        .take_while(|line| !line.starts_with("1,"))
        .collect();
    let again = |number: usize, change: &dyn Fn([f64; 4]) -> [f64; 4]| -> Vec<String> {
        let lines = first.iter().filter_map(|line| {
            let numbers: Vec<f64> = line
                .split(',')
                .skip(1)
                .map(|x| x.parse().unwrap_or(f64::NAN))
                .collect();
            let [x, y, u, v] = change([numbers[0], numbers[1], numbers[2], numbers[3]]);
            (u.is_finite() && v.is_finite()).then(|| format!("{number},{x},{y},{u},{v}"))
        });
        lines.collect()
    };
    let rest = again(3, &|[x, y, ..]| [x, y, 0.0, 0.0]);
    let few: Vec<String> = again(4, &|all| all).into_iter().take(2).collect();
    let folded = again(5, &|[x, y, ..]| [x, y, -1.5 * x, 0.3 * y]);
    let all = head
        .into_iter()
        .chain(first.iter().copied())
        .chain(&rest)
        .chain(&few)
        .chain(&folded);
    let all: Vec<&str> = all.map(String::as_str).collect();
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), all.join("\n")).unwrap();
    let study = "[[force]]\nedge = \"right\"\nframe = 3\naxis = \"x\"\nforce = \"0 N\"\n";
    fs::write(folder.path().join("known.toml"), study).unwrap();
    let usual = ["correct", "plate.csv", "--material", "pva-10"];
    let more = ["--thickness", "2 mm", "--study", "known.toml"];
    let arguments = [&usual[..], &more, &EDGES].concat();
    let done = gelbench(folder.path(), &arguments).code(1);
    let message = words(&done.get_output().stderr);
    assert!(message.contains("no marker moves in frame 3"), "{message}");
    let message = words(&done.get_output().stdout);
    assert!(
        message.contains("frame 4: 2 of 2 markers lie on the mesh, and at least three are needed"),
        "{message}"
    );
    assert!(
        message.matches("the frame is left out").count() == 2,
        "{message}"
    );
    let report = report_of_correction(folder.path());
    let frames: Vec<&Value> = report["steps"]
        .as_array()
        .unwrap()
        .iter()
        .map(|step| &step["at"])
        .collect();
    assert_eq!(frames, [1.0]);
}
