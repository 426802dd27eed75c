//! Paths that end nowhere but where a body does.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{folder_with, gelbench, machine_report, number, words};

const STRIP: &str = "kind = \"specimen\"\n[finite_element]\nelement = \"Q2\"\n\
    [specimen]\nshape = \"strip\"\nlength = \"40 mm\"\nthickness = \"1 mm\"\ncells = 8\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n";

/// The report of `small.toml` in a folder.
fn report_of(folder: &Path) -> Value {
    machine_report(&folder.join("output/small"))
}

/// The symmetric part of its tangent, which says nothing of its stability, is not positive definite beyond a fifth of the load.
#[test]
fn a_pressure_on_an_edge_with_free_ends_is_followed_to_its_end() {
    let rest = "width = \"20 mm\"\n[material]\ncard = \"neo-hooke\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"pressure\"\npressure = \"-100 kPa\"\n\
        [path]\nfactors = [0.1, 0.4, 1.0]\nmeasured_group = \"left\"\n";
    let folder = folder_with(&STRIP.replace("cells = 8\n", &format!("cells = 8\n{rest}")));
    gelbench(folder.path(), &["run", "small.toml"]);
    let report = report_of(folder.path());
    // By an independent code on the same mesh of 512 cells.
    for (step, pulled) in [(0, 1.33281), (2, 14.8904)] {
        let groups = &report["steps"][step]["finite_element"]["groups"];
        let result = groups["right"]["displacement_mm"][0].as_f64().unwrap();
        assert!((result / pulled - 1.0).abs() < 2e-4, "{step}: {result}");
    }
}

/// A coarser mesh's field on a finer one changes the cells' areas: a bad guess, and no branch.
#[test]
fn a_sheet_that_hardly_changes_its_area_is_not_called_one_of_several() {
    let rest = "width = \"40 mm\"\n[material]\ncard = \"nh.toml\"\nsheet = \"plane-strain\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"8 mm\"\ny = \"0 mm\"\n\
        [path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n";
    let folder = folder_with(&STRIP.replace("cells = 8\n", &format!("cells = 8\n{rest}")));
    let card = "title = \"nearly incompressible\"\nlaw = \"neo-hooke\"\n[parameters]\nc10 = \"0.05 MPa\"\n[volume]\npoisson_ratio = 0.4999\n\
        [data]\ntest = \"none\"\nstress_measure = \"nominal\"\nstrain_measure = \"nominal\"\noffset = \"subtract\"\nstretch_range = [0.3, 4]\n\
        [source]\ncitation = \"none\"\nspecimen = \"none\"\n";
    fs::write(folder.path().join("nh.toml"), card).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml"]);
    let message = words(&done.get_output().stderr);
    assert!(!message.contains("several equilibria"), "{message}");
    let report = report_of(folder.path());
    let force = number(&report["steps"][1]["finite_element"], &["measured_N"]);
    // By an independent code.
    assert!((force / 3.192993069 - 1.0).abs() < 1e-6, "{force}");
}
