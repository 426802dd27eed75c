//! What goes wrong in files and on the command line is told with its remedy.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::common::{SMALL, gelbench, one_line, root};

mod forces;
mod specimens;

/// What a command that fails prints, without line breaks.
fn output_text(folder: &Path, arguments: &[&str], code: i32) -> String {
    let done = gelbench(folder, arguments).code(code);
    one_line(&done.get_output().stderr)
}

fn contains(message: &str, expected: &[&str]) {
    for expected in expected {
        assert!(message.contains(expected), "{expected}: {message}");
    }
}

/// What `check` tells of a study.
fn checked(study: &str, expected: &[&str]) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("a.toml"), study).unwrap();
    contains(
        &output_text(folder.path(), &["check", "a.toml"], 2),
        expected,
    );
}

fn example(name: &str) -> String {
    fs::read_to_string(root().join("examples").join(name)).unwrap()
}

#[test]
fn files_that_are_no_studies_are_told_with_the_command_that_takes_them() {
    for (file, expected) in [
        (
            "examples/measured_plate.csv",
            "`gelbench correct examples/measured_plate.csv",
        ),
        (
            "examples/spring_dashpot.csv",
            "`gelbench identify examples/spring_dashpot.csv`",
        ),
        (
            "materials/data/pva_10_uniaxial.csv",
            "`gelbench materials fit materials/data/pva_10_uniaxial.csv",
        ),
        (
            "materials/pva-10.toml",
            "`gelbench materials show materials/pva-10.toml`",
        ),
        (
            "examples/measured_plate.toml",
            "--study examples/measured_plate.toml",
        ),
    ] {
        for command in ["run", "check"] {
            let message = output_text(root(), &[command, file], 2);
            contains(&message, &[file, "not a study", expected]);
            assert_eq!(message.matches('×').count(), 1, "one message: {message}");
        }
    }
    for kind in ["specimen", "motion"] {
        let name = if kind == "motion" {
            "released_plate.toml"
        } else {
            "dog_bone.toml"
        };
        let study = example(name).replace(&format!("kind = \"{kind}\""), "");
        checked(&study, &[&format!("add `kind = \"{kind}\"`")]);
    }
}

#[test]
fn ratios_that_may_be_percentages_are_asked_for_in_every_kind_of_study() {
    let plate = |stretches: &str| SMALL.replace("[\"20 %\"]", stretches);
    checked(
        &plate("[15, 30]"),
        &[
            "15 means 1500 %",
            "write \"15 %\", or \"1500 %\" if that is meant",
            "30 means 3000 %",
        ],
    );
    checked(
        &plate("[\"15\", \"50 %\"]"),
        &["15 means 1500 %", "write \"15 %\""],
    );
    checked(&plate("[0.15, \"50 %\"]"), &["0.15 means 15 %"]);
    checked(
        &SMALL.replace("\"5 %\"", "5.5"),
        &["tolerances.displacement: 5.5 means 550 %"],
    );
    let motion = example("released_plate.toml").replace("stretch = \"10 %\"", "stretch = 10");
    checked(&motion, &["start.stretch: 10 means 1000 %"]);
    let card = fs::read_to_string(root().join("materials/pva-10.toml")).unwrap();
    let table = card
        .replace("marlow-exponential", "marlow-table")
        .replace("amplitude = \"0.0611 MPa\"", "strain = [0, 50, 100]")
        .replace(
            "exponent = 2.2347",
            "stress = [\"0 MPa\", \"0.1 MPa\", \"0.3 MPa\"]",
        )
        .replace("offset = \"-0.05923 MPa\"", "");
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("a.toml"), table).unwrap();
    contains(
        &output_text(folder.path(), &["materials", "show", "a.toml"], 2),
        &["100 means 10000 %", "\"100 %\""],
    );
    // Load factors are what they say.
    let folder = TempDir::new().unwrap();
    let specimen = example("dog_bone.toml").replace("[0.25, 0.5, 0.75, 1.0]", "[1, 10]");
    fs::write(folder.path().join("a.toml"), specimen).unwrap();
    gelbench(folder.path(), &["check", "a.toml"]).code(0);
}

#[test]
fn numbers_and_units_are_told_alike_in_studies_cards_tables_and_options() {
    let faults = [
        ("15,0 cm", "write \"15.0 cm\", with a decimal point"),
        ("3 inch", "did you mean `in`? Write \"3 in\""),
        ("15", "as in \"15 mm\""),
        ("15 N", "write a length such as \"2 mm\""),
    ];
    for (text, remedy) in faults {
        let quoted = format!("\"{text}\"");
        checked(
            &SMALL.replace("[plate]", &format!("[plate]\nlength = {quoted}")),
            &["plate.length", remedy],
        );
        let strip = example("strip_with_hole.toml");
        checked(
            &strip.replace("thickness = \"2 mm\"", &format!("thickness = {quoted}")),
            &["specimen.thickness", remedy],
        );
        checked(
            &strip.replace("x = \"45 mm\"", &format!("x = {quoted}")),
            &[
                "support[2].x",
                remedy
                    .split(" such as")
                    .next()
                    .unwrap()
                    .trim_start_matches("write a length"),
            ],
        );
        let motion = example("released_plate.toml");
        checked(
            &motion.replace("length = \"15 cm\"", &format!("length = {quoted}")),
            &["plate.length", remedy],
        );
        let options = [
            "correct",
            "examples/measured_plate.csv",
            "--material",
            "pva-10",
            "--thickness",
            text,
        ];
        contains(&output_text(root(), &options, 2), &["--thickness", remedy]);
    }
    let card = fs::read_to_string(root().join("materials/pva-10.toml")).unwrap();
    let folder = TempDir::new().unwrap();
    fs::write(
        folder.path().join("a.toml"),
        card.replace("0.0611 MPa", "0,0611 mpa"),
    )
    .unwrap();
    let message = output_text(folder.path(), &["materials", "show", "a.toml"], 2);
    contains(&message, &["parameters.amplitude", "write \"0.0611 mpa\""]);
    let table = "# test: uniaxial\nstretch [-],nominal_stress [kPaa]\n1,0\n2,1\n";
    fs::write(folder.path().join("a.csv"), table).unwrap();
    let message = output_text(
        folder.path(),
        &["materials", "fit", "a.csv", "--law", "yeoh"],
        2,
    );
    contains(&message, &["did you mean `kPa`?"]);
}

#[test]
fn values_without_quotes_are_told_with_quotes() {
    checked(
        "[plate]\nlength = 15 cm\n",
        &["a.toml:2", "in quotes: length = \"15 cm\""],
    );
    checked(
        "[load]\nstretches = [15 %, 30 %]\n",
        &["in quotes: \"15 %\"", "\"30 %\""],
    );
}

#[test]
fn a_file_in_utf_16_is_told_how_to_save_it() {
    let folder = TempDir::new().unwrap();
    let wide: Vec<u8> = SMALL.encode_utf16().flat_map(u16::to_le_bytes).collect();
    for bytes in [[b"\xff\xfe", &*wide].concat(), wide] {
        fs::write(folder.path().join("a.toml"), bytes).unwrap();
        let message = output_text(folder.path(), &["run", "a.toml"], 2);
        contains(&message, &["written in UTF-16", "save it as UTF-8"]);
    }
}

#[test]
fn units_of_meshes_are_told_by_their_names() {
    let strip = example("strip_with_hole.toml")
        .replace("\"strip-with-hole\"", "\"mesh\"\nfile = \"a.msh\"");
    checked(
        &strip,
        &["file_unit: is missing", "add `file_unit = \"mm\"`"],
    );
    let with = |unit: &str| strip.replace("\"a.msh\"", &format!("\"a.msh\"\nfile_unit = {unit}"));
    checked(&with("\"inch\""), &["did you mean `in`?"]);
    checked(&with("\"furlong\""), &["known units: mm, cm, m"]);
    checked(&with("1"), &["must be a unit of length", "such as \"mm\""]);
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("a.toml"), with("\"mm\"")).unwrap();
    let message = output_text(folder.path(), &["check", "a.toml"], 2);
    assert!(!message.contains("specimen.file_unit:"), "{message}");
}

#[test]
fn a_missing_key_of_a_list_is_added_as_toml_writes_it() {
    let strip = example("strip_with_hole.toml").replacen("\ngroup", "\n# group", 1);
    checked(&strip, &["under [[support]] number 1"]);
}

#[test]
fn names_of_files_that_are_no_kinds_lead_to_the_right_one() {
    for (kind, hint) in [
        ("moving-specimen", "write kind = \"motion\""),
        ("markers", "`gelbench correct FIELD --study FILE`"),
        ("card", "`card` under [material]"),
    ] {
        checked(
            &format!("kind = \"{kind}\"\n"),
            &["is no kind of study", hint],
        );
    }
}

#[test]
fn advice_on_cells_is_taken_by_the_next_check() {
    let wide = SMALL.replace("[plate]", "[plate]\nwidth = \"37 mm\"");
    for (cells, advice) in [
        ("[13, 5]", "[14, 4]"),
        ("[11, 4]", "[12, 4]"),
        ("[60, 3]", "[56, 14]"),
    ] {
        let study = wide.replacen("[12, 4]", cells, 1);
        checked(&study, &["plate.cells", &format!("take {advice}")]);
        let folder = TempDir::new().unwrap();
        fs::write(
            folder.path().join("a.toml"),
            wide.replacen("[12, 4]", advice, 1),
        )
        .unwrap();
        gelbench(folder.path(), &["check", "a.toml"]).code(0);
    }
}

#[test]
fn a_card_with_two_laws_is_told_to_have_one() {
    let folder = TempDir::new().unwrap();
    let card = fs::read_to_string(root().join("materials/pva-10-yeoh.toml")).unwrap();
    let two = card.replacen("law = ", "law = \"gent\"\nlaw = ", 1);
    let mixed = card.replacen("[data]", "jm = 30.0\n[data]", 1);
    for (card, expected) in [
        (two, "a card has one law: remove one"),
        (
            mixed,
            "yeoh has no jm: leave it out, or take another law (gent)",
        ),
    ] {
        fs::write(folder.path().join("a.toml"), card).unwrap();
        contains(
            &output_text(folder.path(), &["materials", "show", "a.toml"], 2),
            &[expected],
        );
    }
}

#[test]
fn a_file_in_place_of_a_folder_is_told_and_a_folder_in_place_of_a_file() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    fs::write(path.join("small.toml"), SMALL).unwrap();
    for output in ["small.toml", "small.toml/deep"] {
        let message = output_text(path, &["run", "small.toml", "--output", output], 4);
        contains(
            &message,
            &["small.toml is a file", "name another with --output"],
        );
    }
    fs::create_dir(path.join("there")).unwrap();
    let data = root().join("materials/data/pva_10_uniaxial.csv");
    let data = data.to_str().unwrap();
    let message = output_text(
        path,
        &[
            "materials",
            "fit",
            data,
            "--law",
            "yeoh",
            "--output",
            "small.toml",
        ],
        4,
    );
    contains(&message, &["small.toml is a file"]);
    for command in [["plot", "pva-10"], ["convert", data]] {
        let message = output_text(
            path,
            &["materials", command[0], command[1], "--output", "there"],
            4,
        );
        contains(&message, &["there: it is a folder"]);
    }
}

#[test]
fn a_comparison_with_another_step_is_told_to_name_the_step() {
    let message = output_text(
        root(),
        &[
            "compare",
            "examples/pva_plate.toml",
            "examples/measured_plate.csv",
            "--factor",
            "50",
        ],
        2,
    );
    contains(
        &message,
        &["a stretch of 5000 %", "write --factor \"50 %\""],
    );
}
