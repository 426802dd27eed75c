//! Specimens that loads pull, and no support.

use std::fs;

use crate::common::{folder_with, gelbench, machine_report, number, words};

const STRIP: &str = "kind = \"specimen\"\n[material]\ncard = \"neo-hooke\"\n\
    [specimen]\nshape = \"strip\"\nlength = \"40 mm\"\nwidth = \"10 mm\"\nthickness = \"2 mm\"\ncells = 6\n\
    [[support]]\ngroup = \"left\"\nkind = \"roller\"\n[[support]]\ngroup = \"bottom\"\nkind = \"symmetry\"\n\
    [[extensometer]]\nname = \"clip\"\nfrom = [\"10 mm\", \"0 mm\"]\nto = [\"30 mm\", \"0 mm\"]\n\
    [path]\nfactors = [0.5, 1]\nmeasured_group = \"right\"\n";

/// A homogeneous strip under a nominal stress of 0.1 MPa: 2 c10 (λ − λ⁻²) = 0.1, W = c10 (λ² + 2/λ − 3).
#[test]
fn the_energy_is_the_strains_and_the_force_the_loads() {
    let stretch = 1.465_571_231_876_768;
    let energy = 800.0 * 0.05 * (stretch * stretch + 2.0 / stretch - 3.0);
    for (kind, of) in [
        ("traction", "x = \"100 kPa\""),
        ("force", "x = \"2 N\"\ny = \"0 N\""),
    ] {
        let load = format!("[[load]]\ngroup = \"right\"\nkind = \"{kind}\"\n{of}\n");
        let folder = folder_with(&STRIP.replace("[[ext", &(load + "[[ext")));
        gelbench(folder.path(), &["run", "small.toml"]).code(0);
        let output = folder.path().join("output/small");
        let report = machine_report(&output);
        let computed = number(&report["steps"][1]["finite_element"], &["energy_mJ"]);
        assert!(
            (computed / energy - 1.0).abs() < 1e-8,
            "{computed} {energy}"
        );
        let table = fs::read_to_string(output.join("extensometers.csv")).unwrap();
        let last: Vec<&str> = table.lines().last().unwrap().split(',').collect();
        let [.., read, force] = last[..] else {
            panic!("{table}")
        };
        assert!((read.parse::<f64>().unwrap() / stretch - 1.0).abs() < 1e-8);
        assert!(
            (force.parse::<f64>().unwrap() - 2.0).abs() < 1e-9,
            "{table}"
        );
    }
}

/// Plane strain, and a region of all cells, as a mesh file states them.
#[test]
fn what_a_mesh_file_states_of_all_cells_counts() {
    let study = STRIP.replace(
        "shape = \"strip\"\nlength = \"40 mm\"\nwidth = \"10 mm\"",
        "shape = \"mesh\"\nfile = \"a.inp\"\nfile_unit = \"mm\"",
    );
    let study = study
        .replace("cells = 6\n", "")
        .replace("card = \"neo-hooke\"", "card = \"neo-hooke\"\non = \"gel\"");
    let study = study.replace("[material]", "[[material]]")
        + "[[load]]\ngroup = \"gel\"\nkind = \"force\"\nx = \"1 N\"\ny = \"0 N\"\n";
    let folder = folder_with(&study);
    let mesh = "*NODE\n1, 0, 0\n2, 20, 0\n3, 40, 0\n4, 0, 10\n5, 20, 10\n6, 40, 10\n\
        *ELEMENT, TYPE=CPE4, ELSET=gel\n1, 1, 2, 5, 4\n2, 2, 3, 6, 5\n";
    fs::write(folder.path().join("a.inp"), mesh).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml"]);
    let printed = words(&done.get_output().stderr);
    assert!(printed.contains("those of plane strain (CPE)"), "{printed}");
    let report = machine_report(&folder.path().join("output/small"));
    let held = &report["steps"][1]["finite_element"]["groups"]["left"];
    let force = held["force_N"][0].as_f64().unwrap();
    assert!((force + 1.0).abs() < 1e-9, "{force}");
}
