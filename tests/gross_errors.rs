//! Markers that are farther off than noise can be, where nothing is said of their weights.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

mod common;

use common::{gelbench, report_of_correction, root, words};

/// Standard deviation of the example's noise in mm; one marker in fifty is off by 3 to 8 mm.
const NOISE: f64 = 0.25;

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
    let said = words(&done.get_output().stdout) + &written;
    let report = report_of_correction(folder.path());
    (said, report["steps"][0]["corrected"].clone())
}

#[test]
fn gross_errors_have_no_say_unless_it_is_said_that_they_have() {
    const TOLD: &str = "farther off than noise can be";
    let edges = [
        "--rigid",
        "left,right",
        "--free",
        "top,bottom",
        "--edge-gap",
        "0 mm",
    ];
    let weighted = |weights: &[&str]| corrected(&markers(), &[&edges, weights].concat());
    let (text, found) = weighted(&[]);
    assert_eq!(found["weights"], "tukey");
    assert!((found["noise_mm"].as_f64().unwrap() / NOISE - 1.0).abs() < 0.1);
    // Two frames, in the terminal and in the report.
    assert_eq!(text.matches(TOLD).count(), 4, "{text}");
    let (_, said) = weighted(&["--robust", "tukey"]);
    assert_eq!(found["forces"], said["forces"]);
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
        let place: Vec<&str> = line.split(',').collect();
        !line.starts_with(|first: char| first.is_ascii_digit())
            || (!["0", "150"].contains(&place[1]) && !["0", "50"].contains(&place[2]))
    };
    let inside: Vec<&str> = text.lines().filter(is_inside).collect();
    let (_, found) = corrected(&inside.join("\n"), &[]);
    assert_eq!(found["weights"], "tukey");
    assert!((found["noise_mm"].as_f64().unwrap() / NOISE - 1.0).abs() < 0.1);
}
