//! What the tests of the command share.
#![allow(dead_code, reason = "every test uses a part of it")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;
use tempfile::TempDir;

pub mod browser;
pub mod exports;
pub mod figures;
pub mod measured;
pub mod mesh_files;
pub mod process;
pub mod schema;
pub mod sheets;

pub fn gelbench(folder: &Path, arguments: &[&str]) -> Assert {
    let mut command = Command::cargo_bin("gelbench").unwrap();
    // Lines of messages are as long as they are.
    command.env("COLUMNS", "100000");
    command.current_dir(folder).args(arguments).assert()
}

pub fn words(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Text that was printed, in one line: messages are broken where a terminal's lines end.
pub fn one_line(printed: &[u8]) -> String {
    let text = words(printed);
    let of_text = text.split_whitespace().filter(|word| *word != "│");
    of_text.collect::<Vec<_>>().join(" ")
}

pub fn folder_with(study: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("small.toml"), study).unwrap();
    folder
}

pub fn number(value: &Value, path: &[&str]) -> f64 {
    path.iter()
        .fold(value, |value, key| &value[*key])
        .as_f64()
        .unwrap_or(f64::NAN)
}

/// The report for programs in an output folder.
pub fn machine_report(output: &Path) -> Value {
    let text = fs::read_to_string(output.join("report.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The report of `correct` in a folder.
pub fn report_of_correction(folder: &Path) -> Value {
    machine_report(&folder.join("output/correct"))
}

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A plate study with little to compute.
pub const SMALL: &str = r#"
[plate]
cells = [12, 4]
[load]
stretches = ["20 %"]
[finite_element]
cells = [24, 8]
[tolerances]
displacement = "5 %"
departure = "20 %"
force = "5 %"
correction = "10 %"
"#;
