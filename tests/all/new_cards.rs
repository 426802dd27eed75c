//! Cards of what is known of a material, and cards without provenance, as a user meets them.

use std::fs;

use tempfile::TempDir;

use crate::common::{SMALL, folder_with, gelbench, one_line, words};

fn new(folder: &TempDir, arguments: &[&str], code: i32) -> String {
    let arguments = [&["materials", "new"], arguments].concat();
    let done = gelbench(folder.path(), &arguments).code(code);
    let output = done.get_output();
    let text = match code {
        0 => &output.stdout,
        _ => &output.stderr,
    };
    one_line(text)
}

/// From one line to a computed study; the card is not replaced by another one.
#[test]
fn a_card_of_youngs_modulus_drives_a_study() {
    let folder = folder_with(&format!("{SMALL}[material]\ncard = \"gel.toml\"\n"));
    let line = [
        "--law",
        "neo-hooke",
        "--young",
        "20 kPa",
        "--poisson",
        "0.45",
        "--name",
        "gel",
        "--output",
        ".",
    ];
    let printed = new(&folder, &line, 0);
    for expected in [
        "W = Ψ + ½ κ (J − 1)², Ψ = C₁₀ (Ī₁ − 3)",
        "C₁₀ = 0.0034483 MPa, κ = 0.066667 MPa",
        "E = 0.02 MPa, ν = 0.45, μ = 0.0068966 MPa, K = 0.066667 MPa",
        "material.card = \"./gel.toml\"",
    ] {
        assert!(printed.contains(expected), "{expected}: {printed}");
    }
    let card = fs::read_to_string(folder.path().join("gel.toml")).unwrap();
    assert!(
        !card.contains("[source]") && card.contains("[volume]\npoisson_ratio = 0.45"),
        "{card}"
    );
    let checked = gelbench(folder.path(), &["check", "small.toml"]).code(0);
    let warned = words(&checked.get_output().stderr);
    assert!(
        !warned.contains("source") && !warned.contains("calibrated"),
        "{warned}"
    );
    gelbench(folder.path(), &["materials", "show", "gel.toml"]).code(0);
    new(&folder, &line, 0);
    let other = [&line[..3], &["30 kPa"], &line[4..]].concat();
    assert!(new(&folder, &other, 4).contains("choose another --name"));
    assert_eq!(
        fs::read_to_string(folder.path().join("gel.toml")).unwrap(),
        card
    );
}

#[test]
fn a_card_has_a_name_of_what_is_stated() {
    let folder = TempDir::new().unwrap();
    let line = [
        "--law",
        "gent",
        "--shear-modulus",
        "20 kPa",
        "--parameter",
        "jm=30",
    ];
    let printed = new(&folder, &line, 0);
    assert!(
        printed.contains("output/materials/gent-mu-0.02-MPa-jm-30.toml"),
        "{printed}"
    );
    assert!(printed.contains("the volume is constant"), "{printed}");
    let line = [
        "--law",
        "mooney-rivlin",
        "--convention",
        "febio",
        "--parameter",
        "c1=8 kPa",
        "--parameter",
        "c2=2 kPa",
        "--parameter",
        "k=5 MPa",
    ];
    let printed = new(&folder, &line, 0);
    assert!(
        printed.contains("½ κ ln² J") && printed.contains("κ = 5 MPa"),
        "{printed}"
    );
}

#[test]
fn what_is_wrong_is_told_with_a_remedy() {
    let folder = TempDir::new().unwrap();
    for (line, expected) in [
        (&["--young", "20"][..], "write it with its unit"),
        (
            &["--young", "20 kPa", "--poisson", "0.6"],
            "or is 0.5 for an incompressible material",
        ),
        (&["--young", "20 kPa", "--parameter", "c10"], "KEY=VALUE"),
        (
            &["--young", "20 kPa", "--parameter", "c1=1 kPa"],
            "did you mean `c10`",
        ),
        (&[], "add --parameter c10=…"),
        (&["--poisson", "0.3"], "add --parameter c10=…"),
        (
            &[
                "--convention",
                "abaqus",
                "--parameter",
                "C10=8 kPa",
                "--parameter",
                "D1=0.4",
            ],
            "0.1 1/MPa",
        ),
    ] {
        let line = [&["--law", "neo-hooke"], line].concat();
        let actual = new(&folder, &line, 2);
        assert!(actual.contains(expected), "{line:?}: {actual}");
    }
    assert!(fs::read_dir(folder.path()).unwrap().next().is_none());
}

/// Provenance is asked for when a card is shared, not before it is used.
#[test]
fn a_card_is_used_without_provenance_and_shared_with_it() {
    let folder = TempDir::new().unwrap();
    let card = "law = \"neo-hooke\"\n[parameters]\nc10 = \"3 kPa\"\n";
    fs::write(folder.path().join("gel.toml"), card).unwrap();
    let shown = gelbench(folder.path(), &["materials", "show", "gel.toml"]).code(0);
    let shown = words(&shown.get_output().stdout);
    assert!(
        shown.contains("calibrated range            not stated"),
        "{shown}"
    );
    let checked = gelbench(folder.path(), &["materials", "check", "gel.toml"]).code(0);
    let checked = words(&checked.get_output().stdout);
    assert_eq!(checked.lines().count(), 1, "{checked}");
    let share = ["materials", "check", "gel.toml", "--share"];
    let refused = gelbench(folder.path(), &share).code(2);
    let refused = words(&refused.get_output().stderr);
    for key in [
        "title",
        "data.test",
        "data.stretch_range",
        "source.citation",
        "source.specimen",
    ] {
        assert!(
            refused.contains(&format!("{key}: is not stated")),
            "{key}: {refused}"
        );
    }
    let mut shared = format!("title = \"a gel\"\n{card}");
    shared += "[data]\ntest = \"uniaxial\"\nstress_measure = \"nominal\"\nstrain_measure = \"nominal\"\noffset = \"subtract\"\n\
               stretch_range = [1.0, 1.5]\n[source]\ncitation = \"A. Author\"\nspecimen = \"strip\"\n";
    fs::write(folder.path().join("gel.toml"), shared).unwrap();
    gelbench(folder.path(), &share).code(0);
    gelbench(folder.path(), &["materials", "check", "pva-10", "--share"]).code(0);
}
