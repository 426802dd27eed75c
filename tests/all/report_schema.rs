//! Reports for machines have one schema, whatever the kind of the study.

use std::fs;

use gelbench::output::REPORT_SCHEMA;
use serde_json::Value;
use tempfile::TempDir;

use crate::common::schema::faults;
use crate::common::{SMALL, folder_with, gelbench, machine_report, root, words};

fn schema() -> Value {
    serde_json::from_str(REPORT_SCHEMA).unwrap()
}

/// The report in a folder, which follows the schema.
fn report(folder: &TempDir, kind: &str, along: Option<&str>, steps: usize) -> Value {
    let report = machine_report(&folder.path().join("out"));
    let result = faults(&schema(), &report, "report");
    assert!(result.is_empty(), "{result:#?}");
    assert_eq!(report["kind"], kind);
    assert_eq!(report["along"].as_str(), along);
    assert_eq!(report["steps"].as_array().unwrap().len(), steps);
    report
}

fn run(study: &str) -> TempDir {
    let folder = folder_with(study);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    folder
}

#[test]
fn a_plate_follows_the_schema() {
    let report = report(&run(SMALL), "plate", Some("stretch"), 1);
    assert_eq!(report["name"], "small");
    assert_eq!(report["requirements"].as_array().unwrap().len(), 4);
    assert_eq!(report["study"]["text"], SMALL);
    assert!(!report["study"]["defaults"].as_array().unwrap().is_empty());
}

#[test]
fn a_specimen_follows_the_schema() {
    let study = "kind = \"specimen\"\ntitle = \"small\"\n[material]\ncard = \"pva-10-yeoh\"\n\
        [specimen]\nthickness = \"2 mm\"\nshape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 4\n\
        [path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6 mm\"\ny = \"0 mm\"\n\
        [tolerances]\ndisplacement = \"20 %\"\nforce = \"20 %\"\ncorrection = \"10 %\"\n";
    let report = report(&run(study), "specimen", Some("load factor"), 2);
    let step = &report["steps"][1];
    assert!(step["corrected"]["displacement_percent"].is_number());
    assert!(step["finite_element"]["measured_N"].is_number());
    assert_eq!(report["material"]["law"], "yeoh");
}

#[test]
fn a_motion_follows_the_schema() {
    let study = "kind = \"motion\"\ntitle = \"small\"\n\
        [plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = [6, 2]\n\
        [finite_element]\nelement = \"Q1\"\ncells = [6, 2]\n\
        [[probe]]\nname = \"end\"\nat = [\"30 mm\", \"5 mm\"]\n\
        [start]\nstretch = \"10 %\"\n[grip]\nmotion = \"release\"\ntime = \"0 s\"\n\
        [material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n\
        [time]\nduration = \"4 ms\"\ninterval = \"2 ms\"\nstep = \"0.05 ms\"\n";
    let report = report(&run(study), "motion", Some("time"), 3);
    assert_eq!(report["steps"][2]["at"], 0.004);
    assert!(report["steps"][2]["finite_element"]["stored_energy_mJ"].is_number());
}

#[test]
fn markers_follow_the_schema() {
    let mut table = String::from("x [mm],y [mm],ux [mm],uy [mm]\n");
    for i in 0..12 {
        for j in 0..8 {
            let (x, y) = (5.0 * f64::from(i), 5.0 * f64::from(j));
            let noise = f64::from((7 * i + 3 * j) % 5 - 2) * 0.01;
            let (ux, uy) = (0.1 * x + noise, -0.045 * y - noise);
            table += &format!("{x},{y},{ux},{uy}\n");
        }
    }
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("field.csv"), table).unwrap();
    let arguments = [
        "correct",
        "field.csv",
        "--material",
        "pva-10",
        "--thickness",
        "2 mm",
    ];
    let arguments = [&arguments[..], &["--edge-gap", "0 mm", "--output", "out"]].concat();
    gelbench(folder.path(), &arguments);
    let report = report(&folder, "markers", Some("frame"), 1);
    assert_eq!(report["name"], "field");
    let corrected = &report["steps"][0]["corrected"];
    assert!(corrected["noise_mm"].is_number());
    let answer = corrected["verdict"]["answer"].as_str().unwrap();
    let [error, interval] =
        ["standard_error", "interval"].map(|key| corrected["forces"][0]["x_N"][key].is_null());
    assert_eq!([error, interval], [answer.starts_with("not"); 2]);
}

#[test]
fn a_validation_case_follows_the_schema() {
    let study = fs::read_to_string(root().join("examples/nonlinear_spring.toml")).unwrap();
    report(&run(&study), "nonlinear-spring", None, 0);
}

/// Every command that makes a report, and where its JSON is among the files that it writes, if it is.
#[test]
fn with_json_standard_output_is_the_report_and_words_go_to_standard_error() {
    let folder = folder_with(SMALL);
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write(
        "other.csv",
        "X [mm],Y [mm],ux [mm],uy [mm]\n15,5,1.5,0\n20,5,2,0\n",
    );
    write("m.csv", &crate::common::process::markers(1));
    let data = root().join("materials/data/pva_10_uniaxial.csv");
    fs::copy(data, folder.path().join("data.csv")).unwrap();
    fs::copy(
        root().join("examples/spring_dashpot.csv"),
        folder.path().join("s.csv"),
    )
    .unwrap();
    let correct = format!("{} --json", crate::common::process::CORRECT);
    let correct: Vec<&str> = correct.split(' ').collect();
    let samples: [(&[&str], &str, &str); 6] = [
        (
            &["run", "small.toml", "--output", "r", "--json"],
            "r/report.json",
            "files in r",
        ),
        (&correct, "c/report.json", "files in c"),
        (
            &[
                "compare",
                "small.toml",
                "other.csv",
                "--output",
                "o",
                "--json",
            ],
            "o/comparison.json",
            "deviation from",
        ),
        (
            &["validate", "nonlinear-spring", "--output", "v", "--json"],
            "",
            "report: v",
        ),
        (
            &[
                "identify",
                "s.csv",
                "--output",
                "i",
                "--stiffness",
                "constant",
                "--damping",
                "constant",
                "--json",
            ],
            "i/s.json",
            "written: i",
        ),
        (
            &[
                "materials",
                "fit",
                "data.csv",
                "--law",
                "yeoh",
                "--name",
                "a",
                "--output",
                "f",
                "--json",
            ],
            "f/a.json",
            "written: f",
        ),
    ];
    for (arguments, file, message) in samples {
        let done = gelbench(folder.path(), arguments);
        let output = done.get_output();
        let printed: Value = serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|fault| panic!("{arguments:?}: {fault}: {}", words(&output.stdout)));
        if !file.is_empty() {
            let written = fs::read_to_string(folder.path().join(file)).unwrap();
            assert_eq!(
                printed,
                serde_json::from_str::<Value>(&written).unwrap(),
                "{file}"
            );
        }
        assert!(
            words(&output.stderr).contains(message),
            "{}",
            words(&output.stderr)
        );
    }
}

#[test]
fn verbose_names_steps_and_files_and_quiet_names_neither() {
    let folder = folder_with(SMALL);
    let message = |option: &str| {
        let done = gelbench(
            folder.path(),
            &["run", "small.toml", "--output", "o", option],
        );
        words(&done.code(0).get_output().stderr)
    };
    let verbose = message("--verbose");
    for line in [
        "done: mass-spring, ",
        "done: corrector, ",
        "written: o/report.json",
        "written: o/vtk/corrected.pvd",
    ] {
        assert!(verbose.contains(line), "{line}: {verbose}");
    }
    let quiet = message("--quiet");
    assert!(!quiet.contains("gelbench: "), "{quiet}");
}

#[test]
fn the_schema_sees_what_does_not_follow_it() {
    let report = report(&run(SMALL), "plate", Some("stretch"), 1);
    let broken = |change: fn(&mut Value)| {
        let mut report = report.clone();
        change(&mut report);
        faults(&schema(), &report, "report").len()
    };
    assert_eq!(broken(|report| report["passed"] = "yes".into()), 1);
    assert_eq!(broken(|report| report["more"] = 1.into()), 1);
    assert_eq!(broken(|report| report["steps"][0]["at"] = Value::Null), 1);
    let without = |report: &mut Value| {
        report["requirements"][0]
            .as_object_mut()
            .unwrap()
            .remove("unit");
    };
    assert_eq!(broken(without), 1);
}
