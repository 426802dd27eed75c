//! Specimens of any shape, as a user meets them.

use std::fs;

use serde_json::Value;

mod common;

use common::{folder_with, gelbench, words};

/// A specimen study with little to compute; `shape` gives the measures, `rest` the supports and loads.
fn specimen(shape: &str, rest: &str) -> String {
    format!(
        "kind = \"specimen\"\ntitle = \"small\"\n[material]\ncard = \"pva-10-yeoh\"\n\
         [specimen]\nthickness = \"2 mm\"\n{shape}\n{rest}\n\
         [tolerances]\ndisplacement = \"5 %\"\nforce = \"5 %\"\ncorrection = \"10 %\"\n"
    )
}

const PULLED: &str = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
    [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"6 mm\"\ny = \"0 mm\"\n";

/// All three models are pulled by the same force between the same conditions; what is measured is the displacement.
#[test]
fn a_grip_with_a_force_moves_in_all_three_models() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    let rest = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"symmetry\"\n\
        [[support]]\ngroup = \"bottom\"\nkind = \"roller\"\n\
        [[support]]\ngroup = \"right\"\nkind = \"grip\"\nx_force = \"0.6 N\"\ny = \"0 mm\"\n";
    let folder = folder_with(&specimen(shape, rest));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(
        printed.contains("corrected grip displacement from"),
        "{printed}"
    );
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(
        report.contains("finite elements: grip displacement [mm]"),
        "{report}"
    );
    let lame = rest.replace("y = \"0 mm\"\n", "");
    fs::write(folder.path().join("small.toml"), specimen(shape, &lame)).unwrap();
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let found = words(&done.get_output().stderr);
    assert!(found.contains("needs either y or y_force"), "{found}");
}

#[test]
fn specimens_of_every_shape_run_in_all_three_models() {
    let turned = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"start\"\n\
        [[support]]\ngroup = \"start\"\nkind = \"clamp\"\n\
        [[support]]\ngroup = \"end\"\nkind = \"rotation\"\ncentre = [\"0 mm\", \"0 mm\"]\nangle = \"15 deg\"\n\
        [[load]]\ngroup = \"outside\"\nkind = \"pressure\"\npressure = \"-0.5 kPa\"\n";
    let drawn = "[path]\nfactors = [0.5, 1.0]\nmeasured_group = \"left\"\n\
        [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
        [[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"20 kPa\"\n";
    for (shape, rest) in [
        (
            "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6\nlattice = \"triangles\"",
            PULLED,
        ),
        (
            "shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 8",
            drawn,
        ),
        (
            "shape = \"notched-strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"2 mm\"\nnotch_length = \"6 mm\"\ncells = 8",
            PULLED,
        ),
        (
            "shape = \"dog-bone\"\nlength = \"75 mm\"\nwidth = \"12.5 mm\"\nnarrow_length = \"25 mm\"\nnarrow_width = \"4 mm\"\nshoulder_length = \"8 mm\"\ncells = 6",
            PULLED,
        ),
        (
            "shape = \"ring-sector\"\ninner_radius = \"10 mm\"\nouter_radius = \"15 mm\"\nangle = \"90 deg\"\ncells = 8",
            turned,
        ),
    ] {
        let folder = folder_with(&specimen(shape, rest));
        let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
        let printed = words(&done.get_output().stdout);
        assert!(
            printed.contains("4 of 4 checks passed"),
            "{shape}: {printed}"
        );
        let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
        assert!(report.contains("corrected: displacement [%]"), "{shape}");
        for file in [
            "mass_spring_002.vtu",
            "corrected.pvd",
            "springs_001.vtu",
            "finite_element_002.vtu",
        ] {
            assert!(
                folder.path().join("out/vtk").join(file).exists(),
                "{shape} {file}"
            );
        }
    }
}

/// A mesh that goes out as VTK comes in again and gives the same figures.
#[test]
fn a_mesh_of_another_program_is_a_specimen() {
    let shape = "shape = \"strip-with-hole\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"4 mm\"\ncells = 8";
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let file = "shape = \"mesh\"\nfile = \"out/vtk/mass_spring_001.vtu\"\nfile_unit = \"1 mm\"";
    fs::write(folder.path().join("file.toml"), specimen(file, PULLED)).unwrap();
    gelbench(folder.path(), &["run", "file.toml", "--output", "again"]).code(0);
    let figure = |folder_name: &str| {
        let path = folder.path().join(folder_name).join("report.json");
        let report: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
        report["checks"][0]["computed"].as_f64().unwrap()
    };
    // The outline of the file is a polygon: its finite elements are not those of the circle.
    assert!(
        (figure("out") - figure("again")).abs() < 0.5,
        "{} {}",
        figure("out"),
        figure("again")
    );
}

#[test]
fn faults_of_a_specimen_are_told_with_their_place() {
    let strip = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    for (shape, rest, told) in [
        (
            strip,
            PULLED.replace("group = \"right\"", "group = \"rihgt\""),
            "the mesh has no group `rihgt`",
        ),
        (
            strip,
            PULLED.replace("\"clamp\"", "\"clmp\""),
            "did you mean \"clamp\"",
        ),
        (
            strip,
            PULLED.replace("measured_group = \"left\"", "measured_group = \"hole\""),
            "the specimen has no group `hole`",
        ),
        (
            "shape = \"strip-with-hole\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\nhole_diameter = \"10 mm\"\ncells = 6",
            PULLED.into(),
            "nine tenths",
        ),
        (
            "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 7",
            PULLED.into(),
            "cells must be even",
        ),
        (
            "shape = \"mesh\"\nfile = \"nothing.msh\"\nfile_unit = \"1 mm\"",
            PULLED.into(),
            "nothing.msh",
        ),
        (
            strip,
            format!("{PULLED}[finite_element]\nadaptive = true\n"),
            "adaptive refinement is that of triangles",
        ),
        (
            strip,
            format!(
                "{PULLED}[[load]]\ngroup = \"top\"\nkind = \"force\"\ny = \"1 N\"\n\
                [finite_element]\nelement = \"T1\"\nadaptive = true\n"
            ),
            "a force is shared by the nodes of its group",
        ),
        (
            strip,
            format!(
                "{PULLED}[[support]]\ngroup = \"top\"\nkind = \"displacement\"\ny = \"1 mm\"\n"
            ),
            "support 1 on the group `left` (a clamp) and support 3 on the group `top` (y = 1 mm) contradict each other",
        ),
    ] {
        let folder = folder_with(&specimen(shape, &rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
        let found = words(&done.get_output().stderr);
        let found = found.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(found.contains(told), "{told}: {found}");
    }
}

/// A specimen refines itself to the error that the study wants; where the cells do not suffice, that is told.
#[test]
fn local_refinement_ends_at_its_goal_or_at_its_limit() {
    let shape = "shape = \"notched-strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"2 mm\"\n\
        notch_length = \"6 mm\"\ncells = 8\n[finite_element]\nelement = \"T2\"\nadaptive = true\n";
    let folder = folder_with(&specimen(&format!("{shape}error = \"1 %\""), PULLED));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("5 of 5 checks passed"), "{printed}");
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("refined locally in"), "{report}");
    let finest = fs::read_to_string(folder.path().join("out/vtk/finite_element_002.vtu")).unwrap();
    assert!(finest.contains("estimated_error_percent_of_energy_norm"));

    let text = specimen(
        &format!("{shape}error = \"0.1 %\"\nmost_cells = 200"),
        PULLED,
    );
    fs::write(folder.path().join("small.toml"), text).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("most_cells = 200"), "{printed}");
}

/// Not even the first load factor is reached: the last equilibrium on the way is written all the same.
#[test]
fn a_path_that_ends_before_its_first_load_factor_leaves_its_last_state() {
    let shape = "shape = \"strip\"\nlength = \"60 mm\"\nwidth = \"6 mm\"\ncells = 4";
    let squeezed = PULLED.replace("x = \"6 mm\"", "x = \"-20 mm\"");
    let folder = folder_with(&specimen(shape, &squeezed));
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("buckling or wrinkling"), "{printed}");
    assert!(
        folder
            .path()
            .join("out/vtk/finite_element_end.vtu")
            .exists()
    );
    assert!(
        !folder
            .path()
            .join("out/vtk/finite_element_001.vtu")
            .exists()
    );
}

/// The states before the end of a path are written, and the end is told as a requirement that is not met.
#[test]
fn what_was_reached_before_a_path_ends_is_not_lost() {
    let shape = "shape = \"strip\"\nlength = \"20 mm\"\nwidth = \"10 mm\"\ncells = 6";
    // The second load factor presses the strip through itself.
    let pressed = PULLED
        .replace("factors = [0.5, 1.0]", "factors = [0.1, 30.0]")
        .replace("x = \"6 mm\"", "x = \"-2 mm\"");
    let folder = folder_with(&specimen(shape, PULLED));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    assert!(folder.path().join("out/vtk/corrected_002.vtu").exists());
    fs::write(folder.path().join("small.toml"), specimen(shape, &pressed)).unwrap();
    let done = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(1);
    let printed = words(&done.get_output().stdout);
    assert!(printed.contains("load factor 30 (reached 8."), "{printed}");
    assert!(printed.contains("buckling or wrinkling"), "{printed}");
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("| 0.1 |"), "{report}");
    assert!(folder.path().join("out/vtk/corrected_001.vtu").exists());
    assert!(!folder.path().join("out/vtk/corrected_002.vtu").exists());
    // The last equilibrium on the way to the second load factor is kept apart, and said to be.
    assert!(report.contains("| finite_element_end.vtu |"), "{report}");
    assert!(
        folder
            .path()
            .join("out/vtk/finite_element_end.vtu")
            .exists()
    );
}
