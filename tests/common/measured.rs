//! Markers of the example's plate, and their corrections.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use super::{gelbench, number, report_of_correction as report, root, words};

/// Frame 2 of the example's markers, those that `keep` holds of.
pub fn second_frame(keep: impl Fn([f64; 2]) -> bool) -> String {
    let text = fs::read_to_string(root().join("examples/measured_plate.csv")).unwrap();
    let mut kept = String::from("x [mm],y [mm],ux [mm],uy [mm]\n");
    for line in text.lines().filter(|line| line.starts_with("2,")) {
        let position: Vec<f64> = line
            .split(',')
            .skip(1)
            .take(2)
            .map(|x| x.parse().unwrap())
            .collect();
        if keep([position[0], position[1]]) {
            kept += &format!("{}\n", &line[2..]);
        }
    }
    kept
}

/// Corrects markers of the plate with rigid grips and free long edges; what is printed and the report.
pub fn corrected(text: &str, more: &[&str], code: i32) -> (String, Value) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plate.csv"), text).unwrap();
    let thickness = if more.contains(&"--thickness") {
        vec![]
    } else {
        vec!["--thickness", "2 mm"]
    };
    let usual = ["correct", "plate.csv", "--material", "pva-10"];
    let robust = if more.contains(&"--robust") {
        vec![]
    } else {
        vec!["--robust", "tukey"]
    };
    let edges = ["--rigid", "left,right", "--free", "top,bottom"];
    let arguments = [&usual[..], &thickness[..], &robust[..], &edges[..], more].concat();
    let done = gelbench(folder.path(), &arguments).code(code);
    let printed = words(&done.get_output().stdout) + &words(&done.get_output().stderr);
    (printed, report(folder.path()))
}

/// The exit code where the data are not explained.
pub const NOT_EXPLAINED: i32 = 5;

/// The force on the right edge along `"x_N"` or `"y_N"` with its interval.
pub fn right_force(report: &Value, axis: &str) -> [f64; 3] {
    let forces = report["steps"][0]["corrected"]["forces"]
        .as_array()
        .unwrap();
    let force = forces
        .iter()
        .find(|force| force["edge"] == "right")
        .unwrap();
    let end = |index: usize| force[axis]["interval"][index].as_f64().unwrap();
    [number(force, &[axis, "value"]), end(0), end(1)]
}
