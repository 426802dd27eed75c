//! One field in every dialect in which programs write tables is one and the same field.

use std::fs;
use std::path::Path;

use assert_cmd::assert::Assert;
use encoding_rs::{Encoding, GB18030, UTF_8, WINDOWS_1252};
use gelbench::markers::{ChosenColumns, MarkerFiles, MarkerSeries, ReadSettings, read};
use tempfile::TempDir;

mod exports;

use crate::common::{gelbench, report_of_correction, root, words};
use exports::*;

fn read_bytes(bytes: &[u8], settings: &ReadSettings) -> MarkerFiles {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.csv");
    fs::write(&path, bytes).unwrap();
    read(&[path], settings).unwrap_or_else(|error| panic!("{error}\n{}", words(bytes)))
}

fn settings(unit: Option<f64>) -> ReadSettings {
    ReadSettings {
        unit,
        ..ReadSettings::default()
    }
}

/// The field as plain columns.
fn expected() -> MarkerSeries {
    let text = dialects()[0].text(&exports()[0], "");
    read_bytes(text.as_bytes(), &settings(None)).series
}

#[test]
fn every_program_in_every_dialect_gives_the_same_field() {
    let expected = expected();
    assert_eq!(expected.frames[0].markers.len(), 12);
    for export in exports() {
        for dialect in dialects() {
            let text = dialect.text(&export, "made by hand");
            let actual = read_bytes(text.as_bytes(), &settings(export.unit));
            assert_eq!(actual.understood.layout, export.layout, "{text}");
            assert_eq!(
                actual.series, expected,
                "{}, {dialect:?}\n{text}",
                export.layout
            );
        }
    }
}

fn utf_16(text: &str, bytes_of: fn(u16) -> [u8; 2]) -> Vec<u8> {
    text.encode_utf16().flat_map(bytes_of).collect()
}

#[test]
fn every_program_in_every_encoding_gives_the_same_field() {
    let expected = expected();
    let in_one = |encoding: &'static Encoding, text: &str| {
        let (bytes, _, lost) = encoding.encode(text);
        assert!(!lost);
        bytes.into_owned()
    };
    for export in exports() {
        for dialect in [dialects()[0], dialects()[70]] {
            let [plain, european, chinese] =
                ["plain", "Prüfkörper, Größe in µm", "试样的位移和坐标"]
                    .map(|remark| dialect.text(&export, remark));
            let marked = format!("\u{feff}{chinese}");
            for (bytes, name) in [
                (in_one(UTF_8, &chinese), "UTF-8"),
                (in_one(UTF_8, &marked), "UTF-8"),
                (in_one(WINDOWS_1252, &european), "Latin-1 (Windows-1252)"),
                (in_one(GB18030, &chinese), "gb18030"),
                (utf_16(&marked, u16::to_le_bytes), "UTF-16LE"),
                (utf_16(&marked, u16::to_be_bytes), "UTF-16BE"),
                (utf_16(&plain, u16::to_le_bytes), "UTF-16LE"),
                (utf_16(&plain, u16::to_be_bytes), "UTF-16BE"),
            ] {
                let actual = read_bytes(&bytes, &settings(export.unit));
                assert_eq!(actual.understood.encoding, Some(name));
                assert_eq!(actual.series, expected, "{}, {name}", export.layout);
            }
        }
    }
}

#[test]
fn named_columns_give_what_the_program_is_known_for() {
    let expected = expected();
    let exports = exports();
    let unnamed = |name: &str| ReadSettings {
        columns: ChosenColumns::parse(name.split(',')).unwrap(),
        downwards: Some(true),
        ..settings(Some(0.5))
    };
    for (layout, names) in [
        ("pyALDIC", "id=node_id,x=x_px,y=y_px,ux=disp_u,uy=disp_v"),
        (
            "DICe",
            "x=COORDINATE_X,y=coordinate_y,ux=Displacement_X,uy=DISPLACEMENT_Y",
        ),
        ("VIC-2D", "x=x,y=y,ux=u,uy=v"),
    ] {
        let export = exports
            .iter()
            .find(|export| export.layout == layout)
            .unwrap();
        for dialect in [dialects()[0], dialects()[70]] {
            let text = dialect.text(export, "");
            let actual = read_bytes(text.as_bytes(), &unnamed(names));
            assert_eq!(actual.understood.layout, "columns");
            let positions = |series: &MarkerSeries| -> Vec<_> {
                let markers = series.frames[0].markers.iter();
                markers
                    .map(|marker| (marker.position, marker.displacement))
                    .collect()
            };
            assert_eq!(positions(&actual.series), positions(&expected), "{layout}");
        }
    }
    // Capitals tell columns apart; the file's y axis points up here.
    let vic = exports
        .iter()
        .find(|export| export.layout == "VIC-3D")
        .unwrap();
    let upwards = ReadSettings {
        columns: ChosenColumns::parse(["x=X", "y=Y", "ux=U [mm]", "uy=v", "id=Index"]).unwrap(),
        ..settings(None)
    };
    let text = dialects()[0].text(vic, "");
    assert_eq!(read_bytes(text.as_bytes(), &upwards).series, expected);
}

#[test]
fn a_field_read_downwards_is_the_mirrored_one() {
    let text = |turned: bool| {
        let sign = if turned { -1.0 } else { 1.0 };
        let row = |[x, y, ux, uy]: Point| format!("{x},{},{ux},{}\n", sign * y, sign * uy);
        "x [mm],y [mm],ux [mm],uy [mm]\n".to_owned()
            + &points().into_iter().map(row).collect::<String>()
    };
    let downwards = ReadSettings {
        downwards: Some(true),
        ..settings(None)
    };
    let actual = read_bytes(text(true).as_bytes(), &downwards);
    assert_eq!(actual.series, expected());
    assert!(actual.understood.turned_up && actual.understood.sketch().is_some());
    let upwards = read_bytes(text(false).as_bytes(), &settings(None));
    assert_eq!(actual.series, upwards.series);
    assert!(!upwards.understood.turned_up);
    // What a layout says is overruled.
    let dice = exports().remove(1);
    let up = ReadSettings {
        downwards: Some(false),
        ..settings(Some(0.5))
    };
    let actual = read_bytes(dialects()[0].text(&dice, "").as_bytes(), &up);
    let [first, wanted] =
        [&actual.series, &upwards.series].map(|series| series.frames[0].markers[0]);
    assert_eq!(
        (first.position[1], first.displacement[1]),
        (-wanted.position[1], -wanted.displacement[1])
    );
}

/// What is known of the edges.
const EDGES: [&str; 8] = [
    "--rigid",
    "left,right",
    "--free",
    "top,bottom",
    "--edge-gap",
    "0 mm",
    "--cell-size",
    "3 mm",
];

/// Corrects the table `a.csv` of a folder.
fn correct(folder: &Path, more: &[&str]) -> Assert {
    let card = root().join("materials/pva-10.toml").display().to_string();
    let usual = ["correct", "a.csv", "--material", &card];
    let thickness = ["--thickness", "2 mm"];
    gelbench(folder, &[&usual[..], &thickness, more].concat())
}

/// The corrected field of a table: its nodes, the report, and what is printed.
fn corrected(bytes: &[u8], more: &[&str]) -> (String, String, String) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("a.csv"), bytes).unwrap();
    let done = correct(folder.path(), &[&EDGES, more].concat());
    let done = done.get_output().clone();
    let file = |name: &str| {
        let path = folder.path().join("output/correct").join(name);
        fs::read_to_string(path).unwrap_or_else(|_| panic!("{}", words(&done.stderr)))
    };
    let report = report_of_correction(folder.path());
    assert!(report["problem"]["reading"]["encoding"].is_string());
    (
        file("nodes_001.csv"),
        file("report.md"),
        words(&done.stdout),
    )
}

#[test]
fn the_correction_is_the_same_to_the_bit_and_the_report_says_what_was_read() {
    let (exports, dialects) = (exports(), dialects());
    let plain = dialects[0].text(&exports[0], "");
    let (nodes, report, printed) = corrected(plain.as_bytes(), &[]);
    assert!(printed.contains("\ncolumns; "), "{printed}");
    assert!(report.contains("with y assumed to point up"), "{report}");
    let german = dialects
        .iter()
        .find(|one| one.separator == ";" && one.decimal == ',' && one.second_line);
    let vic = german.unwrap().text(&exports[4], "Größe");
    let (bytes, ..) = WINDOWS_1252.encode(&vic);
    let (of_vic, report, printed) = corrected(&bytes, &[]);
    assert_eq!(of_vic, nodes);
    assert!(printed.contains("\nVIC-3D; "), "{printed}");
    assert!(report.contains("Text in Latin-1"), "{report}");
    let aldic = german.unwrap().text(&exports[2], "");
    let (of_aldic, report, printed) = corrected(
        &utf_16(&format!("\u{feff}{aldic}"), u16::to_be_bytes),
        &["--unit", "0.5 mm"],
    );
    assert_eq!(of_aldic, nodes);
    assert!(printed.contains("\npyALDIC, y turned up; "), "{printed}");
    for message in [
        "read as pyALDIC",
        "Text in UTF-16BE",
        "y points down, as in an image",
        "| ux | disp_u | 0.5 | --unit |",
    ] {
        assert!(report.contains(message), "{message}: {report}");
    }
}

#[test]
fn forces_of_a_testing_machine_are_those_that_the_user_could_write() {
    let folder = TempDir::new().unwrap();
    let field = dialects()[0].text(&exports()[0], "");
    fs::write(folder.path().join("a.csv"), field).unwrap();
    fs::write(
        folder.path().join("machine.csv"),
        "Project 7\nframe;Weg;Kraft\n-;mm;kN\n1;0,5;0,0004\n2;0,7;0,0009\n",
    )
    .unwrap();
    let study = "[[force]]\nedge = \"right\"\naxis = \"x\"\ncolumn = \"Kraft\"\nstandard_deviation = \"0.1 N\"\n";
    fs::write(folder.path().join("study.toml"), study).unwrap();
    let measured = |more: &[&str]| {
        correct(folder.path(), &[&EDGES, more].concat());
        report_of_correction(folder.path())["steps"][0]["corrected"]["measured_forces"].clone()
    };
    let written = measured(&["--force", "right x 0.4 N ± 0.1 N"]);
    assert_eq!(written[0]["measured_N"], 0.4);
    let of_machine = [
        "--forces",
        "machine.csv",
        "--force-column",
        "right x Kraft ± 0.1 N",
    ];
    assert_eq!(measured(&of_machine), written);
    assert_eq!(
        measured(&["--forces", "machine.csv", "--study", "study.toml"]),
        written
    );
    let message = |arguments: &[&str]| {
        let refused = correct(folder.path(), arguments).code(2);
        words(&refused.get_output().stderr)
    };
    assert!(
        message(&["--forces", "machine.csv"])
            .contains("no column of this table is chosen as a force")
    );
    assert!(message(&["--study", "study.toml"]).contains("--forces FILE"));
}

#[test]
fn wrong_names_are_told_with_those_that_there_are() {
    let folder = TempDir::new().unwrap();
    let text = "x_px,y_px,disp_u,disp_v,disp_v\n1,2,3,4,5\n";
    fs::write(folder.path().join("a.csv"), text).unwrap();
    for (columns, message) in [
        (
            "x=x_px,y=y_px,ux=disp_x,uy=disp_v",
            "there is no column `disp_x` did you mean `disp_u`? the file has x_px, y_px, disp_u",
        ),
        (
            "x=x_px,y=y_px,ux=disp_u,uy=disp_v",
            "the file has 2 columns `disp_v`",
        ),
        ("x=x_px,x=y_px", "two columns are named for `x`"),
        ("x=x_px,y=x_px", "the column `x_px` is named twice"),
        (
            "x=x_px,displacement=disp_u",
            "`displacement` is not a known quantity known quantities: x, y, ux, uy",
        ),
        ("uz=disp_u", "did you mean `ux`?"),
        ("x_px", "`x_px` names no column"),
        ("x=", "`x=` names no column"),
    ] {
        let arguments = ["--unit", "1 mm", "--columns", columns];
        let refused = correct(folder.path(), &arguments).code(2);
        let actual = words(&refused.get_output().stderr);
        let plain: String = actual
            .chars()
            .map(|letter| {
                if "│×╰─▶·╭╯┬├".contains(letter) {
                    ' '
                } else {
                    letter
                }
            })
            .collect();
        let plain = plain
            .replace("help:", "")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        for part in message.split(" did you").collect::<Vec<_>>() {
            assert!(plain.contains(part.trim()), "{columns}: {plain}");
        }
    }
}
