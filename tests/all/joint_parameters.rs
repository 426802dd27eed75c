//! Parameters from all frames of one or more specimens together, as a user meets them.

use std::fmt::Write;
use std::fs;

use gelbench::material::Card;
use tempfile::TempDir;

use crate::common::{gelbench, number, report_of_correction, root, words};

const TRUTH: [f64; 2] = [0.08, 0.03];

/// Markers on a sheet of 60 x 20 x 2 mm that is stretched evenly and keeps its volume, and the force on it in N.
fn frame(stretch: f64, seed: u64) -> (String, f64) {
    let across = stretch.powf(-0.5);
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    // Uniform numbers of ±1, which sum to nearly normal ones.
    let mut draw = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut rows = String::new();
    for i in 0..=20 {
        for j in 0..=8 {
            let [x, y] = [3.0 * f64::from(i), 2.5 * f64::from(j)];
            let mut noise = || 0.01 * (draw() + draw() + draw());
            let [u, v] = [(stretch - 1.0) * x + noise(), (across - 1.0) * y + noise()];
            writeln!(rows, "{x},{y},{u},{v}").unwrap();
        }
    }
    let stress = 2.0 * (stretch - stretch.powi(-2)) * (TRUTH[0] + TRUTH[1] / stretch);
    (rows, 40.0 * stress)
}

/// A folder with two specimens of three frames each and their machine's tables.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, stretches) in [("a", [1.15, 1.5, 1.9]), ("b", [1.3, 1.7, 2.2])] {
        let mut field = String::from("frame,x [mm],y [mm],ux [mm],uy [mm]\n");
        let mut forces = String::from("frame,load [N]\n");
        for (index, stretch) in stretches.iter().enumerate() {
            let (rows, force) = frame(*stretch, 7 + index as u64);
            for row in rows.lines() {
                writeln!(field, "{},{row}", index + 1).unwrap();
            }
            writeln!(forces, "{},{force}", index + 1).unwrap();
        }
        fs::write(folder.path().join(format!("{name}.csv")), field).unwrap();
        fs::write(folder.path().join(format!("{name}_forces.csv")), forces).unwrap();
        let specimen = format!(
            r#"edge_gap = "0 mm"
[specimen]
name = "strip {name}"
fields = ["{name}.csv"]
thickness = "2 mm"
forces = "{name}_forces.csv"
cell_size = "5 mm"
[[edges]]
names = ["left", "right"]
condition = "unknown"
[[edges]]
names = ["top", "bottom"]
condition = "free"
[[force]]
edge = "right"
axis = "x"
column = "load"
"#
        );
        fs::write(folder.path().join(format!("{name}.toml")), specimen).unwrap();
    }
    folder
}

const TWO: [&str; 7] = [
    "correct",
    "--specimen",
    "a.toml",
    "--specimen",
    "b.toml",
    "--material",
    "mooney-rivlin",
];

#[test]
fn two_specimens_give_two_parameters_a_card_and_a_ranking() {
    let folder = folder();
    let arguments = [&TWO[..], &["--laws", "neo-hooke"]].concat();
    let done = gelbench(folder.path(), &arguments).success();
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("strip a (3 frames), strip b (3 frames)"),
        "{printed}"
    );
    let actual = report_of_correction(folder.path());
    let parameters = actual["problem"]["parameters"].as_array().unwrap();
    for (parameter, truth) in parameters.iter().zip(TRUTH) {
        let interval: [f64; 2] = [0, 1].map(|end| parameter["interval"][end].as_f64().unwrap());
        assert!(interval[0] < truth && truth < interval[1], "{parameter}");
    }
    let laws = actual["problem"]["laws"].as_array().unwrap();
    assert_eq!(laws[0]["card"], "mooney-rivlin", "{laws:?}");
    assert!(number(&laws[1], &["aicc_above_least"]) > 10.0, "{laws:?}");
    let card = Card::load("output/correct/card.toml", folder.path()).unwrap();
    assert_eq!(
        card.parameter("c10").unwrap(),
        number(&parameters[0], &["value"])
    );
    for name in ["strip a", "strip b"] {
        let specimen = folder.path().join("output/correct/specimens").join(name);
        assert!(specimen.join("vtk/corrected_003.vtu").exists());
    }
    let forces = fs::read_to_string(folder.path().join("output/correct/forces.csv")).unwrap();
    for row in forces.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [measured, predicted] = [4, 6].map(|index: usize| cells[index].parse::<f64>().unwrap());
        assert!((predicted / measured - 1.0).abs() < 0.05, "{row}");
    }
}

/// Without the rows of markers on the edges the sheet may be as wide as the next row would be, which moduli have in their intervals.
#[test]
fn moduli_hold_the_truth_where_the_edge_is_not_known() {
    let folder = folder();
    for name in ["a", "b"] {
        let [field, specimen] =
            ["csv", "toml"].map(|ending| folder.path().join(format!("{name}.{ending}")));
        let text = fs::read_to_string(&field).unwrap();
        let inner = text.lines().filter(|row| {
            let y = row.split(',').nth(2).unwrap();
            y != "0" && y != "20"
        });
        fs::write(&field, inner.collect::<Vec<_>>().join("\n")).unwrap();
        let text = fs::read_to_string(&specimen).unwrap();
        fs::write(&specimen, text.replace("edge_gap = \"0 mm\"\n", "")).unwrap();
    }
    gelbench(folder.path(), &TWO);
    let actual = report_of_correction(folder.path());
    let parameters = actual["problem"]["parameters"].as_array().unwrap();
    for (parameter, truth) in parameters.iter().zip(TRUTH) {
        let [low, high] = [0, 1].map(|end| parameter["interval"][end].as_f64().unwrap());
        assert!(low < truth && truth < high, "{parameter}");
    }
}

#[test]
fn a_wrong_thickness_of_one_specimen_is_told_and_leaves_no_interval() {
    let folder = folder();
    let path = folder.path().join("b.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("\"2 mm\"", "\"1 mm\"")).unwrap();
    let done = gelbench(folder.path(), &TWO).code(5);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("no interval: not all frames are explained"),
        "{printed}"
    );
    let actual = report_of_correction(folder.path());
    assert!(actual["problem"]["parameters"][0]["interval"].is_null());
}

#[test]
fn faults_of_specimens_name_the_remedy() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let good = fs::read_to_string(folder.path().join("a.toml")).unwrap();
    let without = good[good.find("[[edges]]").unwrap()..].to_owned();
    write("plain.toml", &without);
    write(
        "unforced.toml",
        &good[..good.find("[[force]]").unwrap()].replace("forces = ", "# "),
    );
    write("typo.toml", &good.replace("thickness", "thicknes"));
    let cases: [(&[&str], &str); 6] = [
        (&["--specimen", "plain.toml"], "has no [specimen]"),
        (&["--specimen", "unforced.toml"], "no force was measured"),
        (&["--specimen", "typo.toml"], "thicknes"),
        (
            &["--specimen", "a.toml", "--specimen", "a.toml"],
            "two specimens have the name",
        ),
        (
            &["--specimen", "a.toml", "--fit", "c30"],
            "no parameter `c30`",
        ),
        (
            &["a.csv", "--thickness", "2 mm", "--study", "a.toml"],
            "has a [specimen]",
        ),
    ];
    for (arguments, message) in cases {
        let all = [&["correct", "--material", "mooney-rivlin"], arguments].concat();
        let failed = gelbench(folder.path(), &all).code(2);
        let printed = words(&failed.get_output().stderr);
        assert!(printed.contains(message), "{message}: {printed}");
    }
    assert!(!folder.path().join("output").exists());
}

#[test]
fn the_example_gives_what_the_guide_says() {
    let folder = TempDir::new().unwrap();
    let examples = root().join("examples");
    let [field, forces] = ["measured_plate.csv", "measured_plate_forces.csv"]
        .map(|name| examples.join(name).display().to_string());
    let arguments = [
        "correct",
        &field,
        "--material",
        "pva-10-yeoh",
        "--thickness",
        "2 mm",
        "--rigid",
        "left,right",
        "--free",
        "top,bottom",
        "--forces",
        &forces,
        "--force-column",
        "right x force",
        "--edge-gap",
        "0 mm",
        "--together",
    ];
    let done = gelbench(folder.path(), &arguments).success();
    let actual = report_of_correction(folder.path());
    let combinations = actual["problem"]["combinations"].as_array().unwrap();
    assert_eq!(combinations.len(), 3);
    assert!(combinations[0]["is_determined"].as_bool().unwrap());
    // All stresses have a factor in common, so that a parameter which is not determined does not stay at its initial value.
    let printed = words(&done.get_output().stdout);
    assert!(!printed.contains("initial value"), "{printed}");
}
