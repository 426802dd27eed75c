//! Forces of markers.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{contains, example, output_text};
use crate::common::root;

/// The frame 2 of the measured plate.
fn one_frame(folder: &Path) {
    let text = example("measured_plate.csv");
    let rows = text.lines().filter(|line| !line.starts_with("1,"));
    fs::write(folder.join("one.csv"), rows.collect::<Vec<_>>().join("\n")).unwrap();
}

#[test]
fn a_force_with_the_wrong_sign_is_told_before_anything_is_computed() {
    let folder = TempDir::new().unwrap();
    one_frame(folder.path());
    let with = |force: &str| {
        let options = [
            "correct",
            "one.csv",
            "--material",
            "pva-10",
            "--thickness",
            "2 mm",
            "--rigid",
            "left,right",
            "--force",
        ];
        output_text(folder.path(), &[&options[..], &[force]].concat(), 2)
    };
    contains(
        &with("left x 12.9 N"),
        &[
            "force on `left` is 12.9 N along x",
            "towards -x",
            "write -12.9 N",
        ],
    );
    contains(&with("right x -12.9 N"), &["towards +x", "write 12.9 N"]);
}

#[test]
fn a_force_among_several_frames_is_asked_for_its_frame() {
    let options = [
        "correct",
        "examples/measured_plate.csv",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
        "--force",
        "right x 12.9 N",
    ];
    let message = output_text(root(), &options, 2);
    contains(
        &message,
        &[
            "there are 2 frames",
            "`frame = 2` under [[force]]",
            "or correct one frame alone",
        ],
    );
}
