//! Rules about sheets that hold in every kind of study: plates, specimens, meshes of files, motions.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::common::{folder_with, gelbench, machine_report, one_line};

fn plate(measures: [&str; 3], stretches: &str) -> String {
    let [length, width, thickness] = measures;
    format!(
        "kind = \"plate\"\n[material]\ncard = \"pva-10\"\n\
         [plate]\nlength = \"{length}\"\nwidth = \"{width}\"\nthickness = \"{thickness}\"\ncells = [12, 4]\n\
         [load]\nstretches = {stretches}\n[finite_element]\ncells = [24, 8]\n"
    )
}

/// A strip whose right end moves by a displacement, or its mesh.
fn specimen(shape: &str, thickness: &str, moved: &str) -> String {
    format!(
        "kind = \"specimen\"\n[material]\ncard = \"pva-10\"\n[specimen]\n{shape}\nthickness = \"{thickness}\"\n\
         [path]\nfactors = [0.5, 1.0]\nmeasured_group = \"right\"\n\
         [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
         [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"{moved}\"\ny = \"0 mm\"\n"
    )
}

fn strip(length: &str, width: &str) -> String {
    format!("shape = \"strip\"\nlength = \"{length}\"\nwidth = \"{width}\"\ncells = 4")
}

/// A plate whose grip goes to a stretch within a second.
fn motion([length, width, thickness]: [&str; 3], to: &str) -> String {
    format!(
        "kind = \"motion\"\n[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n\
         [plate]\nlength = \"{length}\"\nwidth = \"{width}\"\nthickness = \"{thickness}\"\ncells = [12, 4]\n\
         [start]\nstretch = \"0 %\"\n[grip]\nmotion = \"ramp\"\nbegin = \"0 s\"\nend = \"1 s\"\nto = \"{to}\"\n\
         [finite_element]\nelement = \"Q2\"\ncells = [18, 6]\n[corrector]\nenabled = false\n\
         [time]\nduration = \"1 s\"\ninterval = \"0.25 s\"\nstep = \"50 ms\"\nintegrator = \"generalised-alpha\"\n\
         spectral_radius = 0.5\n"
    )
}

/// A mesh of 60 × 20 in Gmsh's format, without a unit.
fn mesh() -> String {
    let node = |i: usize, j: usize| 3 * i + j + 1;
    let (mut nodes, mut elements, mut count) = (String::new(), String::new(), 0);
    for i in 0..=6 {
        for j in 0..=2 {
            writeln!(nodes, "{} {} {} 0", node(i, j), 10 * i, 10 * j).unwrap();
        }
    }
    let mut add = |kind: &str, corners: &[usize]| {
        count += 1;
        let corners: Vec<String> = corners.iter().map(ToString::to_string).collect();
        writeln!(elements, "{count} {kind} {}", corners.join(" ")).unwrap();
    };
    for j in 0..2 {
        add("1 2 1 1", &[node(0, j), node(0, j + 1)]);
        add("1 2 2 2", &[node(6, j), node(6, j + 1)]);
        for i in 0..6 {
            let lower = [node(i, j), node(i + 1, j)];
            add(
                "3 2 3 3",
                &[lower[0], lower[1], node(i + 1, j + 1), node(i, j + 1)],
            );
        }
    }
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"left\"\n1 2 \"right\"\n2 3 \"sheet\"\n$EndPhysicalNames\n\
         $Nodes\n21\n{nodes}$EndNodes\n$Elements\n{count}\n{elements}$EndElements\n"
    )
}

/// What `check` says of a study, with an exit code.
fn checked(study: &str, code: i32) -> String {
    let folder = folder_with(study);
    fs::write(folder.path().join("strip.msh"), mesh()).unwrap();
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(code);
    one_line(&done.get_output().stderr)
}

/// The warnings of a study's results.
fn warnings(study: &str) -> String {
    let folder = folder_with(study);
    drop(gelbench(
        folder.path(),
        &["run", "small.toml", "--output", "out"],
    ));
    warnings_of(&folder.path().join("out"))
}

fn warnings_of(folder: &Path) -> String {
    machine_report(folder)["warnings"].to_string()
}

#[test]
fn millimetres_taken_for_metres_are_told_in_every_kind_of_study() {
    let of_mesh = |unit: &str| {
        let shape = format!("shape = \"mesh\"\nfile = \"strip.msh\"\nfile_unit = \"{unit}\"");
        specimen(&shape, "2 mm", &format!("6 {unit}"))
    };
    let strips = |unit: &str| {
        let [length, width] = ["60", "20"].map(|size| format!("{size} {unit}"));
        [
            plate([&length, &width, "2 mm"], "[\"10 %\"]"),
            specimen(&strip(&length, &width), "2 mm", &format!("6 {unit}")),
            of_mesh(unit),
            motion([&length, &width, "2 mm"], "10 %"),
        ]
    };
    for study in strips("m") {
        let result = checked(&study, 0);
        assert!(result.contains("times its thickness"), "{study}{result}");
    }
    for study in strips("mm") {
        let result = checked(&study, 0);
        assert!(!result.contains("thickness"), "{study}{result}");
    }
}

#[test]
fn a_motion_without_any_load_is_told_to_stay_at_rest() {
    let study = motion(["60 mm", "20 mm", "2 mm"], "0 %");
    assert!(checked(&study, 0).contains("the plate stays at rest"));
    let loaded = format!("{study}[gravity]\nx = \"0 m/s^2\"\ny = \"-9.81 m/s^2\"\n");
    assert!(!checked(&loaded, 0).contains("at rest"));
}

/// The card ends at λ = 2, which the middle of a clamped strip exceeds by 1.5 % where the grips reach it.
#[test]
fn the_range_of_a_card_is_judged_alike_in_plates_specimens_and_motions() {
    let measures = ["60 mm", "20 mm", "2 mm"];
    let kinds = |percent: &str, millimetres: &str| {
        [
            plate(measures, &format!("[\"50 %\", \"{percent}\"]")),
            specimen(&strip("60 mm", "20 mm"), "2 mm", millimetres),
            motion(measures, percent),
        ]
    };
    for study in kinds("100 %", "60 mm") {
        let result = warnings(&study);
        assert!(!result.contains("outside the range"), "{study}{result}");
    }
    for study in kinds("110 %", "66 mm") {
        let result = warnings(&study);
        assert!(
            result.contains("outside the range of the card `pva-10`"),
            "{study}{result}"
        );
    }
}

#[test]
fn thin_sheets_are_told_to_wrinkle_and_thick_ones_are_not_in_every_kind_of_study() {
    let kinds = |thickness: &'static str| {
        let measures = ["60 mm", "20 mm", thickness];
        [
            plate(measures, "[\"15 %\", \"30 %\"]"),
            specimen(&strip("60 mm", "20 mm"), thickness, "18 mm"),
            motion(measures, "30 %"),
        ]
    };
    for study in kinds("2 mm") {
        let result = warnings(&study);
        assert!(!result.contains("wrinkle"), "{study}{result}");
    }
    for study in kinds("0.005 mm") {
        let result = warnings(&study);
        assert!(result.contains("may wrinkle or buckle"), "{study}{result}");
    }
}

/// Springs alone are some percent off, which is no pass where the grip imposes the motion.
#[test]
fn a_driven_motion_has_limits_of_five_percent_unless_it_states_others() {
    let limits = |rest: &str| {
        let study = motion(["60 mm", "20 mm", "2 mm"], "10 %") + rest;
        let folder = folder_with(&study);
        drop(gelbench(
            folder.path(),
            &["run", "small.toml", "--output", "out"],
        ));
        let report = machine_report(&folder.path().join("out"));
        let all = report["requirements"].as_array().unwrap().clone();
        let of = |name: &str| {
            let requirement = all
                .iter()
                .find(|requirement| requirement["quantity"].as_str().unwrap().contains(name));
            requirement.map(|requirement| requirement["wanted"]["at_most"].as_f64().unwrap())
        };
        ["displacement", "force of the right grip"].map(of)
    };
    assert_eq!(limits(""), [Some(5.0); 2]);
    let stated = "[tolerances]\ndeviation = \"10 %\"\n";
    assert_eq!(limits(stated), [Some(10.0), Some(5.0)]);
}
