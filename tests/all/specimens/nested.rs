//! Fields that are corrected on nested meshes, and those that are made from the lattice's own springs.

use std::fs;

use serde_json::Value;

use super::{PULLED, specimen};
use crate::common::{folder_with, gelbench, machine_report, words};

/// What is measured and how far the field is from the finite elements, of the corrected field at each load factor.
fn corrected(shape: &str, rest: &str, method: &str) -> (Vec<[f64; 2]>, Value, String) {
    let corrector = format!("[corrector]\nmethod = \"{method}\"\n");
    let folder = folder_with(&specimen(shape, &format!("{rest}{corrector}")));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let read = |file: &str| fs::read_to_string(folder.path().join("out").join(file)).unwrap();
    let json = machine_report(&folder.path().join("out"));
    let steps = json["steps"].as_array().unwrap().iter();
    let figures = steps.map(|step| {
        let corrected = &step["corrected"];
        ["measured_percent", "displacement_percent"].map(|key| corrected[key].as_f64().unwrap())
    });
    (figures.collect(), json.clone(), read("report.md"))
}

#[test]
fn nested_meshes_lead_to_the_fields_of_the_direct_method_on_every_shape() {
    let turned = "[path]\nfactors = [0.3, 0.6, 1.0]\nmeasured_group = \"start\"\n\
        [[support]]\ngroup = \"start\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"end\"\nkind = \"rotation\"\ncentre = [\"0 mm\", \"0 mm\"]\nangle = \"15 deg\"\n\
        [[load]]\ngroup = \"outside\"\nkind = \"pressure\"\npressure = \"-0.5 kPa\"\n";
    let gripped = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"grip\"\nx_force = \"0.6 N\"\ny = \"1 mm\"\n";
    for (shape, rest) in [
        (
            "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 10\nlattice = \"triangles\"",
            gripped,
        ),
        (
            "shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 14",
            PULLED,
        ),
        (
            "shape = \"dog-bone\"\nlength = \"75 mm\"\nwidth = \"12.5 mm\"\nnarrow_length = \"25 mm\"\nnarrow_width = \"4 mm\"\nshoulder_length = \"8 mm\"\ncells = 8",
            PULLED,
        ),
        (
            "shape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\nangle = \"90 deg\"\ncells = 12",
            turned,
        ),
    ] {
        let (nested, json, report) = corrected(shape, rest, "nested");
        let (direct, other, plain) = corrected(shape, rest, "direct");
        for (nested, direct) in nested.iter().zip(&direct) {
            for (nested, direct) in nested.iter().zip(direct) {
                assert!(
                    (nested - direct).abs() < 1e-6,
                    "{shape}: {nested} % {direct} %"
                );
            }
        }
        let last = |json: &Value| {
            let steps = json["steps"].as_array().unwrap();
            steps[steps.len() - 1]["corrected"]["discretisation_mm"].as_f64()
        };
        assert!(last(&json).unwrap() > 0.0, "{shape}");
        assert_eq!(last(&other), None, "{shape}");
        assert!(
            report.contains("The corrected field comes from springs on a coarser mesh"),
            "{shape}"
        );
        assert!(!plain.contains("The corrected field comes from"), "{shape}");
    }
}

#[test]
fn nested_meshes_that_cannot_be_are_refused() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    for (corrector, message) in [
        ("method = \"nestd\"", "did you mean \"nested\"?"),
        (
            "method = \"nested\"\ntolerance = 1e-9",
            "corrector.tolerance",
        ),
    ] {
        let rest = format!("{PULLED}[corrector]\n{corrector}\n");
        let folder = folder_with(&specimen(shape, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let result = words(&done.get_output().stderr);
        assert!(result.contains(message), "{corrector}: {result}");
    }
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let mesh = "shape = \"mesh\"\nfile = \"out/vtk/corrected_001.vtu\"\nfile_unit = \"mm\"";
    let rest = format!("{PULLED}[corrector]\nmethod = \"nested\"\n");
    fs::write(folder.path().join("small.toml"), specimen(mesh, &rest)).unwrap();
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let result = words(&done.get_output().stderr);
    assert!(
        result.contains("the mesh of a file has no coarser meshes"),
        "{result}"
    );
}
