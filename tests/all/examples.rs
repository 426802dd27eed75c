//! The programs in `examples/` print what their first comments say.

use std::error::Error;
use std::fs;
use std::path::Path;

#[expect(dead_code, reason = "the test asks for the text that `main` prints")]
#[path = "../../examples/corrected_plate.rs"]
mod corrected_plate;
#[expect(dead_code, reason = "the test asks for the text that `main` prints")]
#[path = "../../examples/marker_field.rs"]
mod marker_field;
#[expect(dead_code, reason = "the test asks for the text that `main` prints")]
#[path = "../../examples/own_law.rs"]
mod own_law;

/// The block of text in the head of an example.
fn promised(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.rs"));
    let source = fs::read_to_string(path).unwrap();
    let head = source.lines().map_while(|line| line.strip_prefix("//!"));
    let block = head.skip_while(|line| *line != " ```text").skip(1);
    let lines = block.take_while(|line| *line != " ```");
    lines
        .map(|line| format!("{}\n", line[1..].trim_end()))
        .collect()
}

fn check(name: &str, report: fn() -> Result<String, Box<dyn Error>>) {
    let printed = report().unwrap();
    assert_eq!(promised(name), printed, "examples/{name}.rs");
}

#[test]
fn a_corrected_plate() {
    check("corrected_plate", corrected_plate::report);
}

#[test]
fn a_law_of_your_own() {
    check("own_law", own_law::report);
}

#[test]
fn a_field_from_markers() {
    check("marker_field", marker_field::report);
}
