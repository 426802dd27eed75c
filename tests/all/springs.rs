//! The springs of a study for other programs: table, VTK arrays and scene, as a user meets them.

use std::fs;

use tempfile::TempDir;

use crate::common::exports::{HOLE, PLATE, PULLED};
use crate::common::{folder_with, gelbench, one_line, words};

const MOTION: &str = "kind = \"motion\"\n[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = [6, 2]\n\
    [material]\ncard = \"neo-hooke\"\ndensity = \"1020 kg/m^3\"\n[finite_element]\nelement = \"Q2\"\ncells = [8, 4]\n\
    [start]\nstretch = \"10 %\"\n[grip]\nmotion = \"release\"\ntime = \"0 s\"\n\
    [time]\nduration = \"2 ms\"\ninterval = \"1 ms\"\nstep = \"0.05 ms\"\n";

fn run(folder: &TempDir) {
    // A requirement that is not met does not matter here.
    let arguments = ["run", "small.toml", "--output", "out"];
    let done = gelbench(folder.path(), &arguments);
    assert!(done.get_output().status.code().unwrap() <= 1);
}

#[test]
fn every_study_with_springs_has_a_table_of_them() {
    let strip = format!("{HOLE}{PULLED}");
    for (study, vtk) in [
        (PLATE, "springs_001.vtu"),
        (&*strip, "springs_001.vtu"),
        (MOTION, "springs_end.vtu"),
    ] {
        let folder = folder_with(study);
        run(&folder);
        let out = folder.path().join("out");
        let table = fs::read_to_string(out.join("springs.csv")).unwrap();
        let head = "spring,node_1,node_2,X_1_mm,Y_1_mm,X_2_mm,Y_2_mm,rest_length_mm,cross_section_mm2,stiffness_at_rest_N_per_mm,stretch,force_N\n";
        assert!(table.starts_with(head), "{table}");
        for line in table.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
            assert!(
                row[9] >= 0.0 && row[10] > 0.5 && (row[10] - 1.0) * row[11] >= 0.0,
                "{line}"
            );
        }
        let grid = fs::read(out.join("vtk").join(vtk)).unwrap();
        let grid = String::from_utf8_lossy(&grid);
        for name in [
            "force_N",
            "rest_length_mm",
            "cross_section_mm2",
            "stiffness_at_rest_N_per_mm",
        ] {
            assert!(grid.contains(&format!("Name=\"{name}\"")), "{vtk}: {name}");
        }
    }
}

#[test]
fn the_table_is_left_out_where_the_study_says_so() {
    let folder = folder_with(&format!("{PLATE}[output]\nsprings = false\n"));
    run(&folder);
    assert!(!folder.path().join("out/springs.csv").exists());
    assert!(folder.path().join("out/forces.csv").exists());
}

#[test]
fn springs_go_out_as_a_scene_of_sofa() {
    let strip = format!("{HOLE}{PULLED}");
    for study in [PLATE, &strip] {
        let folder = folder_with(study);
        let export = ["export", "small.toml", "--to", "sofa"];
        let done = gelbench(folder.path(), &export).code(0);
        assert!(one_line(&done.get_output().stderr).contains("the springs are linear"));
        assert!(words(&done.get_output().stdout).contains("small_sofa.scn for SOFA"));
        let scene = fs::read_to_string(folder.path().join("output/small/small_sofa.scn")).unwrap();
        for part in [
            "<SpringForceField ",
            "<FixedProjectiveConstraint ",
            "<LinearMovementProjectiveConstraint ",
        ] {
            assert!(scene.contains(part), "{part}: {scene}");
        }
    }
    let folder = folder_with(&format!("{PLATE}[mass_spring]\narea_term = true\n"));
    let refused = gelbench(folder.path(), &["export", "small.toml", "--to", "sofa"]).code(2);
    assert!(one_line(&refused.get_output().stderr).contains("leave out `area_term`"));
}
