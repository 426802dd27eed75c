//! Studies in which something is exactly zero: a force, all stresses, all displacements.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use super::{STRIP, machine_report, specimen};
use crate::common::{folder_with, gelbench, one_line, words};

/// The report of a study that passes in all.
fn passed(folder: &Path) -> String {
    let done = gelbench(folder, &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("3 of 3 checks passed"), "{printed}");
    fs::read_to_string(folder.join("out/report.md")).unwrap()
}

#[test]
fn a_sheet_that_nothing_moves_is_told_and_passes() {
    let rest = "[path]\nfactors = [1.0]\nmeasured_group = \"right\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"0 MPa\"\n";
    let folder = folder_with(&specimen(STRIP, rest));
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(0);
    let message = words(&done.get_output().stderr);
    assert!(message.contains("the sheet stays at rest"), "{message}");
    let report = passed(folder.path());
    assert!(report.contains("the sheet stays at rest"), "{report}");
    for wrong in ["NaN", "no effect"] {
        assert!(!report.contains(wrong), "{wrong}: {report}");
    }
}

#[test]
fn a_study_whose_supports_move_the_sheet_as_a_rigid_body_is_refused() {
    let moved = |group: &str| {
        format!(
            "[[support]]\ngroup = \"{group}\"\nkind = \"displacement\"\nx = \"3 mm\"\ny = \"1 mm\"\n"
        )
    };
    for supports in [moved("right"), moved("left") + &moved("right")] {
        let path = "[path]\nfactors = [1.0]\nmeasured_group = \"right\"\n";
        let folder = folder_with(&specimen(STRIP, &format!("{path}{supports}")));
        for command in ["check", "run"] {
            let done = gelbench(folder.path(), &[command, "small.toml"]).code(2);
            let printed = one_line(&done.get_output().stderr);
            for words in ["as a rigid body", "nothing strains it", "clamp"] {
                assert!(printed.contains(words), "{printed}");
            }
        }
    }
}

#[test]
fn a_load_on_a_clamp_is_told_to_have_no_effect() {
    let at = |group: &str| {
        let rest = format!(
            "[path]\nfactors = [1.0]\nmeasured_group = \"left\"\n\
             [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
             [[load]]\ngroup = \"{group}\"\nkind = \"traction\"\nx = \"5 kPa\"\n\
             [[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"5 kPa\"\n"
        );
        let folder = folder_with(&specimen(STRIP, &rest));
        let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        words(&done.get_output().stderr)
    };
    assert!(at("left").contains("the load on left has no effect on the field"));
    assert!(!at("top").contains("no effect"));
}

/// A closed ring of bilinear cells in Gmsh's format, `around` of them around and `across` across.
fn ring([around, across]: [usize; 2]) -> String {
    let node = |i: usize, j: usize| i * around + j % around + 1;
    let mut nodes = String::new();
    for i in 0..=across {
        let radius = 10.0 + 10.0 * i as f64 / across as f64;
        for j in 0..around {
            // Unequal cells: the forces of the nodes have a small rest.
            let turn = j as f64 + 0.1 * (2.0 * j as f64).sin();
            let (sine, cosine) = (std::f64::consts::TAU * turn / around as f64).sin_cos();
            let (x, y) = (radius * cosine, radius * sine);
            writeln!(nodes, "{} {x:.15e} {y:.15e} 0", node(i, j)).unwrap();
        }
    }
    let mut elements = String::new();
    let mut count = 0;
    for j in 0..around {
        for (group, i) in [(1, 0), (2, across)] {
            count += 1;
            let [from, to] = [node(i, j), node(i, j + 1)];
            writeln!(elements, "{count} 1 2 {group} {group} {from} {to}").unwrap();
        }
        for i in 0..across {
            count += 1;
            let [a, b] = [node(i, j), node(i + 1, j)];
            let [c, d] = [node(i + 1, j + 1), node(i, j + 1)];
            writeln!(elements, "{count} 3 2 100 100 {a} {b} {c} {d}").unwrap();
        }
    }
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
         $PhysicalNames\n3\n1 1 \"inner\"\n1 2 \"outer\"\n2 100 \"sheet\"\n$EndPhysicalNames\n\
         $Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{count}\n{elements}$EndElements\n",
        around * (across + 1)
    )
}

#[test]
fn a_net_force_of_closed_edges_that_is_none_is_not_compared() {
    let shape =
        "shape = \"mesh\"\nfile = \"ring.msh\"\nfile_unit = \"mm\"\nallowed = [\"polygons\"]";
    let radial = "kind = \"radial\"\ncentre = [\"0 mm\", \"0 mm\"]\ndisplacement = \"1 mm\"";
    let turned = "kind = \"rotation\"\ncentre = [\"0 mm\", \"0 mm\"]\nangle = \"5 deg\"";
    for motion in [radial, turned] {
        let rest = format!(
            "[path]\nfactors = [1.0]\nmeasured_group = \"inner\"\n\
             [[support]]\ngroup = \"outer\"\nkind = \"clamp\"\n[[support]]\ngroup = \"inner\"\n{motion}\n"
        );
        let folder = folder_with(&specimen(shape, &rest));
        fs::write(folder.path().join("ring.msh"), ring([40, 5])).unwrap();
        // Whether the corrected field is good enough on these cells is another question.
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        let report = machine_report(&folder.path().join("out"));
        let force = &report["requirements"][1];
        assert_eq!(force["passed"], true, "{motion}: {force}");
        let remark = force["remark"].as_str().unwrap();
        assert!(remark.contains("nothing to compare"), "{motion}: {remark}");
    }
}

#[test]
fn a_report_says_the_material_and_the_plane_state_of_its_study() {
    let card = "title = \"foam\"\nlaw = \"neo-hooke-simo-pister\"\n[parameters]\nmu = \"0.1 MPa\"\npoisson_ratio = 0.3\n\
        [data]\ntest = \"none\"\nstress_measure = \"nominal\"\nstrain_measure = \"nominal\"\noffset = \"subtract\"\n\
        stretch_range = [0.3, 4.0]\n[source]\ncitation = \"made up\"\nspecimen = \"none\"\n";
    let rest = "[path]\nfactors = [1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"1 mm\"\ny = \"0 mm\"\n";
    let study = specimen(STRIP, rest)
        .replace("title = \"small\"\n", "")
        .replace("\"pva-10-yeoh\"", "\"foam.toml\"\nsheet = \"plane-strain\"");
    let folder = folder_with(&study);
    fs::write(folder.path().join("foam.toml"), card).unwrap();
    let report = passed(folder.path());
    for output in [
        "# Specimen of foam\n",
        "of a compressible material (bulk modulus κ = 0.2167 MPa) in plane strain",
    ] {
        assert!(report.contains(output), "{output}: {report}");
    }
    assert!(!report.contains("incompressible"), "{report}");
}

/// A hole that is turned between clamped sides has a moment and no force.
#[test]
fn a_moment_that_no_requirement_judges_is_told() {
    let sides = ["left", "right", "bottom", "top"];
    let clamps = sides.map(|side| format!("[[support]]\ngroup = \"{side}\"\nkind = \"clamp\"\n"));
    let rest = format!(
        "[path]\nfactors = [1.0]\nmeasured_group = \"hole\"\n{}\
         [[support]]\ngroup = \"hole\"\nkind = \"rotation\"\ncentre = [\"20 mm\", \"0 mm\"]\nangle = \"10 deg\"\n",
        clamps.concat()
    );
    let shape = "shape = \"strip-with-hole\"\nlength = \"40 mm\"\nwidth = \"20 mm\"\nhole_diameter = \"8 mm\"\ncells = 8";
    let folder = folder_with(&specimen(shape, &rest));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let message = words(&done.get_output().stderr);
    assert!(
        message.contains("but their moment at load factor 1"),
        "{message}"
    );
}
