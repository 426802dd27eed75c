//! The reference of keys, the schemas and the studies of `new` are what the readers ask for.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::schema::faults;
use crate::common::{gelbench, root, words};

const KINDS: [&str; 6] = [
    "plate",
    "specimen",
    "motion",
    "moving-specimen",
    "markers",
    "card",
];

fn printed(arguments: &[&str]) -> String {
    words(&gelbench(root(), arguments).code(0).get_output().stdout)
}

fn schema(kind: &str) -> Value {
    serde_json::from_str(&printed(&["schema", kind])).unwrap()
}

/// What of a file does not follow the schema of its kind.
fn wrong(schema: &Value, text: &str) -> Vec<String> {
    let file: toml::Table = text.parse().unwrap();
    faults(schema, &serde_json::to_value(file).unwrap(), "")
}

#[test]
fn the_page_of_the_guide_is_what_the_readers_ask_for() {
    let page = fs::read_to_string(root().join("src/guide/keys.md")).unwrap();
    let now = printed(&["keys"]);
    for (one, other) in page.lines().zip(now.lines()) {
        assert_eq!(
            one, other,
            "write the page anew: gelbench keys > src/guide/keys.md"
        );
    }
    assert_eq!(page.lines().count(), now.lines().count());
}

#[test]
fn keys_of_choices_are_found_with_unit_range_and_default() {
    let mut texts = BTreeMap::new();
    for (kind, row) in [
        (
            "plate",
            "| `cells` | two whole numbers from 2 to 100000 | `[60, 20]` |",
        ),
        (
            "specimen",
            "| `notch_depth` | length, greater than zero, from 1 nm to 1 km | must be stated, such as `\"2 mm\"` | with `shape` `\"notched-strip\"` |",
        ),
        (
            "specimen",
            "| `file_unit` | unit of length | must be stated, such as `\"mm\"` | with `shape` `\"mesh\"` |",
        ),
        (
            "specimen",
            "| `pressure` | stress | must be stated, such as `\"1 MPa\"` | with `kind` `\"pressure\"` |",
        ),
        (
            "specimen",
            "| `angle` | angle | must be stated, such as `\"30 deg\"` | with `kind` `\"rotation\"` |",
        ),
        (
            "specimen",
            "| `hole_diameter` | length, greater than zero, from 1 nm to 1 km | must be stated, such as `\"12 mm\"` | with `shape` `\"strip-with-hole\"` |",
        ),
        (
            "motion",
            "| `step` | `\"automatic\"`, or time > 0 | `\"automatic\"` |",
        ),
        (
            "specimen",
            "| `x_force` | force | none; such as `\"1.5 N\"` | with `kind` `\"grip\"` |",
        ),
        (
            "motion",
            "| `frequency` | frequency > 0 | must be stated, such as `\"2 Hz\"` | with `motion` `\"sine\"`",
        ),
        (
            "motion",
            "| `coefficients` | list, each a viscosity | must be stated, such as `[\"50 Pa·s\"]` | with `kind` `\"polynomial\"` |",
        ),
        ("card", "| `c10` | stress"),
        (
            "markers",
            "| `standard_deviation` | force > 0 | none; such as `\"1.5 N\"` |",
        ),
    ] {
        let text = texts
            .entry(kind)
            .or_insert_with(|| printed(&["keys", kind]));
        assert!(text.contains(row), "{row}\n{text}");
    }
}

#[test]
fn files_that_come_along_follow_the_schema_of_their_kind() {
    let files = [
        ("plate", "examples/pva_plate.toml"),
        ("specimen", "examples/strip_with_hole.toml"),
        ("specimen", "examples/dog_bone.toml"),
        ("specimen", "examples/inclusion.toml"),
        ("motion", "examples/released_plate.toml"),
        ("motion", "examples/relaxing_plate.toml"),
        ("moving-specimen", "examples/vibrating_strip.toml"),
        ("markers", "examples/measured_plate.toml"),
        ("markers", "crates/studies/src/studies/markers/default.toml"),
        ("card", "materials/pva-10.toml"),
        ("card", "materials/treloar-ogden-3.toml"),
    ];
    let schemas: BTreeMap<&str, Value> = KINDS.map(|kind| (kind, schema(kind))).into();
    for (kind, file) in files {
        let text = fs::read_to_string(root().join(file)).unwrap();
        let faults = wrong(&schemas[kind], &text);
        assert!(faults.is_empty(), "{file}: {faults:?}");
    }
    let strip = fs::read_to_string(root().join(files[1].1)).unwrap();
    let schema = &schemas["specimen"];
    for (from, to, position) in [
        ("thickness =", "thicknes =", ".specimen.thicknes"),
        ("\"clamp\"", "\"clap\"", ".support[0].kind"),
        ("cells = 24", "cells = 24000", ".specimen.cells"),
        (
            "adaptive = false",
            "adaptive = 0",
            ".finite_element.adaptive",
        ),
    ] {
        let result = wrong(schema, &strip.replacen(from, to, 1));
        assert!(
            result.iter().any(|fault| fault.starts_with(position)),
            "{to}: {result:?}"
        );
    }
}

/// The keys that stand in a file, those in remarks too, such as `support[].kind`.
fn stated(text: &str) -> BTreeSet<String> {
    let mut table = String::new();
    let mut keys = BTreeSet::new();
    for line in text.lines() {
        let line = line.strip_prefix("# ").unwrap_or(line);
        let line = line.split(" #").next().unwrap_or_default().trim();
        let within = |begin, end| line.strip_prefix(begin)?.strip_suffix(end);
        if let Some(name) = within("[[", "]]") {
            table = format!("{name}[].");
        } else if let Some(name) = within("[", "]") {
            table = format!("{name}.");
        } else if let Some((key, _)) = line.split_once('=') {
            keys.insert(format!("{table}{}", key.trim()));
        }
    }
    keys
}

/// What belongs to one choice, such as the measures of another shape, is explained beside the choice.
#[test]
fn new_studies_have_every_key_and_the_reference_explains_each() {
    let folder = TempDir::new().unwrap();
    for kind in KINDS.into_iter().filter(|kind| *kind != "card") {
        gelbench(folder.path(), &["new", kind, "--kind", kind]).code(0);
        let text = fs::read_to_string(folder.path().join(format!("{kind}.toml"))).unwrap();
        let (stated, reference) = (stated(&text), printed(&["keys", kind]));
        let mut table = String::new();
        for line in reference.lines() {
            if let Some(heading) = line.strip_prefix("## ") {
                let name = heading.trim_matches('`');
                let list = name
                    .strip_prefix("[[")
                    .and_then(|name| name.strip_suffix("]]"));
                table = match list {
                    Some(list) => format!("{list}[]."),
                    None if name == "At the top" => String::new(),
                    None => format!("{}.", name.trim_matches(['[', ']'])),
                };
            }
            let Some((key, rest)) = line.strip_prefix("| `").and_then(|row| row.split_once('`'))
            else {
                continue;
            };
            if table.is_empty() && rest.contains("| units |") || rest.contains("| with `") {
                continue;
            }
            assert!(
                stated.contains(&format!("{table}{key}")),
                "{kind}: {table}{key}"
            );
            let is_explained = !rest.trim_end().ends_with("|  |");
            assert!(
                is_explained || !["plate", "specimen"].contains(&kind),
                "{kind}: {table}{key}"
            );
        }
    }
}

#[test]
fn every_kind_of_new_file_is_accepted_as_it_is() {
    let folder = TempDir::new().unwrap();
    for kind in KINDS {
        gelbench(folder.path(), &["new", kind, "--kind", kind]).code(0);
        let file = format!("{kind}.toml");
        if kind == "card" {
            let shown = gelbench(folder.path(), &["materials", "show", &file]).code(0);
            let shown = words(&shown.get_output().stdout);
            assert!(
                shown.contains("not stated")
                    && !shown.contains("Treloar")
                    && !shown.contains("doi")
            );
        } else if kind != "markers" {
            gelbench(folder.path(), &["check", &file]).code(0);
        } else {
            // That it is read shows in the fault being another file's.
            let options = [
                "correct",
                "none.csv",
                "--material",
                "pva-10",
                "--thickness",
                "2 mm",
                "--study",
                &file,
            ];
            let message = words(
                &gelbench(folder.path(), &options)
                    .code(2)
                    .get_output()
                    .stderr,
            );
            assert!(
                message.contains("cannot read none.csv") && !message.contains("markers.toml"),
                "{message}"
            );
        }
    }
}

#[test]
fn shells_and_manuals_know_every_command() {
    let folder = TempDir::new().unwrap();
    gelbench(folder.path(), &["man", "--output", "man"]).code(0);
    for page in ["gelbench.1", "gelbench-run.1", "gelbench-materials-fit.1"] {
        let text = fs::read_to_string(folder.path().join("man").join(page)).unwrap();
        assert!(text.contains(".TH"), "{page}: {text}");
    }
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = printed(&["completions", shell]);
        assert!(
            script.contains("correct") && script.contains("thickness"),
            "{shell}"
        );
    }
}

#[test]
fn the_workbench_is_started_where_it_is_installed_and_else_it_is_said_how() {
    let folder = TempDir::new().unwrap();
    let program = folder.path().join("gelbench");
    let built = assert_cmd::cargo::cargo_bin("gelbench");
    fs::hard_link(&built, &program)
        .or_else(|_| fs::copy(&built, &program).map(|_| ()))
        .unwrap();
    let start = || {
        let mut command = assert_cmd::Command::new(&program);
        command.args(["workbench", "a.toml", "b.csv"]);
        command.env("PATH", folder.path()).assert()
    };
    let message = words(&start().code(2).get_output().stderr);
    assert!(
        message.contains("cargo install --path workbench"),
        "{message}"
    );
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let window = folder.path().join("gelbench-workbench");
        fs::write(&window, "#!/bin/sh\necho \"opens $*\"\nexit 7\n").unwrap();
        fs::set_permissions(&window, fs::Permissions::from_mode(0o755)).unwrap();
        let printed = words(&start().code(7).get_output().stdout);
        assert_eq!(printed, "opens a.toml b.csv\n");
    }
}
