//! The figures of the examples are those of `validation/golden`, number by number.
//!
//! A figure that changes on purpose is renewed with `GELBENCH_GOLDEN=write cargo test --test all golden`, and named in CHANGELOG.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::common::figures::agree;
use crate::common::{gelbench, root, words};

/// What the command prints and reports of an example, without what depends on the run.
fn figures(arguments: &[&str]) -> String {
    let folder = TempDir::new().unwrap();
    let output = folder.path().to_str().unwrap();
    let done = gelbench(root(), &[arguments, &["--output", output]].concat());
    let report = folder.path().join("report.md");
    let report = fs::read_to_string(report).unwrap_or_default();
    let without_times = report.split("\n## Times").next().unwrap_or_default();
    let text = words(&done.get_output().stdout) + without_times;
    // Names of files that were written.
    let depends = |line: &&str| line.contains(output);
    let lines: Vec<&str> = text.lines().filter(|line| !depends(line)).collect();
    lines.join("\n") + "\n"
}

fn check(name: &str, arguments: &[&str]) {
    let path = root().join(format!("validation/golden/{name}.txt"));
    let result = figures(arguments);
    if std::env::var("GELBENCH_GOLDEN").is_ok_and(|wanted| wanted == "write") {
        fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).unwrap();
        return fs::write(path, result).unwrap();
    }
    let golden = fs::read_to_string(path).unwrap();
    let pairs: Vec<_> = result.lines().zip(golden.lines()).collect();
    for (line, (one, other)) in pairs.iter().enumerate() {
        assert!(
            agree(one, other),
            "{name}, line {}:\n{one}\n{other}",
            line + 1
        );
    }
    assert_eq!(result.lines().count(), golden.lines().count(), "{name}");
}

macro_rules! examples {
    ($($name:ident: $($argument:literal)+;)*) => {
        $(
            #[test]
            fn $name() {
                check(stringify!($name), &[$($argument),+]);
            }
        )*
    };
}

examples! {
    pva_plate: "run" "examples/pva_plate.toml";
    dog_bone: "run" "examples/dog_bone.toml";
    strip_with_hole: "run" "examples/strip_with_hole.toml";
    inclusion: "run" "examples/inclusion.toml";
    softening_strip: "run" "examples/softening_strip.toml";
    relaxing_plate: "run" "examples/relaxing_plate.toml";
    vibrating_strip: "run" "examples/vibrating_strip.toml";
    measured_plate: "correct" "examples/measured_plate.csv" "--material" "pva-10" "--thickness" "2 mm" "--edge-gap" "0 mm";
    spring_dashpot: "identify" "examples/spring_dashpot.csv";
}
