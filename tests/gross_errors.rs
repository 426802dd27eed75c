//! Markers that are farther off than noise can be, where nothing is said of their weights.

use serde_json::Value;
use tempfile::TempDir;

mod common;

use common::{gelbench, root, words};

/// Standard deviation of the example's noise in mm; one marker in fifty is off by 3 to 8 mm.
const NOISE: f64 = 0.25;

/// What is printed, and the first frame of the example of the plate with weights as said.
fn corrected(weights: &[&str]) -> (String, Value) {
    let folder = TempDir::new().unwrap();
    let markers = root().join("examples/measured_plate.csv");
    let usual = ["correct", markers.to_str().unwrap(), "--material", "pva-10"];
    let known = ["--thickness", "2 mm", "--rigid", "left,right"];
    let edges = ["--free", "top,bottom", "--edge-gap", "0 mm"];
    let output = ["--output", "."];
    let arguments = [&usual[..], &known, &edges, &output, weights].concat();
    let done = gelbench(folder.path(), &arguments);
    let printed = words(&done.get_output().stdout);
    let text = std::fs::read_to_string(folder.path().join("report.json")).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    (printed, report["steps"][0]["corrected"].clone())
}

#[test]
fn gross_errors_have_no_say_unless_it_is_said_that_they_have() {
    let (printed, found) = corrected(&[]);
    assert_eq!(found["weights"], "tukey");
    assert!((found["noise_mm"].as_f64().unwrap() / NOISE - 1.0).abs() < 0.1);
    assert!(
        printed.contains("farther off than noise can be"),
        "{printed}"
    );
    let (_, said) = corrected(&["--robust", "tukey"]);
    assert_eq!(found["forces"], said["forces"]);
    let (printed, all) = corrected(&["--robust", "no"]);
    assert_eq!(all["weights"], "no");
    assert!(all["noise_mm"].as_f64().unwrap() > 2.0 * NOISE);
    assert!(
        !printed.contains("farther off than noise can be"),
        "{printed}"
    );
}
