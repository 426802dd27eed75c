//! Measured fields of thick bodies between walls: `correct --sheet plane-strain`, against finite elements.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use gelbench::material::{HyperelasticLaw, NeoHooke, PlaneState, Volume, VolumeEnergy};
use gelbench::mesh::{CellShape, Mesh};
use gelbench::problem::{BoundaryProblem, Support};
use gelbench::solve::NewtonSettings;
use gelbench_base::statistics::normal_numbers;
use gelbench_mechanics::material::volume::bulk_modulus;
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{gelbench, number, one_line, report_of_correction, root};

const SIZE: [f64; 2] = [60.0, 30.0];
const THICKNESS: f64 = 20.0;
/// Standard deviation of the noise in mm.
const NOISE: f64 = 0.05;

fn law(poisson_ratio: f64) -> Arc<dyn HyperelasticLaw> {
    let law: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    let bulk_modulus = bulk_modulus(law.shear_modulus(), poisson_ratio);
    let volume = Volume {
        bulk_modulus,
        energy: VolumeEnergy::Quadratic,
        plane: PlaneState::Strain,
    };
    law.with_volume(volume).unwrap()
}

/// Writes the markers of a block of neo-Hookean gel between walls, clamped and pulled by 30 %, and its card; the force in N.
fn measure(folder: &Path, poisson_ratio: f64) -> f64 {
    let mesh = Mesh::plate(SIZE, [24, 12], CellShape::Quad9);
    let problem = BoundaryProblem {
        thickness: THICKNESS,
        regions: Vec::new(),
        law: law(poisson_ratio),
        supports: vec![
            ("left".into(), Support::Displacement([Some(0.0); 2])),
            (
                "right".into(),
                Support::Displacement([Some(18.0), Some(0.0)]),
            ),
        ],
        loads: Vec::new(),
    };
    let energy = problem.finite_elements(&mesh);
    let settings = NewtonSettings {
        tolerance: 1e-9,
        max_iterations: 50,
    };
    let discretised = problem.on(&mesh, &energy).unwrap();
    let states = discretised
        .solve(&[0.25, 0.5, 0.75, 1.0], settings, &|_| {})
        .unwrap();
    let last = states.last().unwrap();
    let mut normal = normal_numbers(5);
    let mut text = String::from("x [mm],y [mm],ux [mm],uy [mm]\n");
    for (i, j) in (0..=16).flat_map(|i| (0..=8).map(move |j| (i, j))) {
        let [x, y] = [3.75 * f64::from(i), 3.75 * f64::from(j)];
        let u = mesh.displacement_at(&last.displacement, [x, y]);
        let mut noise = || NOISE * normal();
        let _ = writeln!(text, "{x},{y},{},{}", u[0] + noise(), u[1] + noise());
    }
    fs::write(folder.join("block.csv"), text).unwrap();
    let card = fs::read_to_string(root().join("materials/neo-hooke.toml")).unwrap();
    let card = card.replace(
        "[data]",
        &format!("[volume]\npoisson_ratio = {poisson_ratio}\nenergy = \"quadratic\"\n\n[data]"),
    );
    fs::write(folder.join("gel.toml"), card).unwrap();
    discretised.reaction(last, "right")[0]
}

/// Corrects the markers; the report of the frame.
fn corrected(folder: &Path, more: &[&str], codes: &[i32]) -> Value {
    let usual = [
        "correct",
        "block.csv",
        "--material",
        "gel.toml",
        "--thickness",
        "20 mm",
        "--edge-gap",
        "0 mm",
        "--rigid",
        "left,right",
        "--free",
        "top,bottom",
    ];
    let done = gelbench(folder, &[&usual[..], more].concat());
    let code = done.get_output().status.code().unwrap();
    let printed = one_line(&done.get_output().stdout) + &one_line(&done.get_output().stderr);
    assert!(codes.contains(&code), "{code}: {printed}");
    report_of_correction(folder)
}

/// Value and interval of the force on the right along x.
fn force(report: &Value) -> (f64, [f64; 2]) {
    let forces = report["steps"][0]["corrected"]["forces"]
        .as_array()
        .unwrap();
    let right = forces
        .iter()
        .find(|force| force["edge"] == "right")
        .unwrap();
    let interval = &right["x_N"]["interval"];
    let ends = [&interval[0], &interval[1]].map(|end| end.as_f64().unwrap_or(f64::NAN));
    (number(right, &["x_N", "value"]), ends)
}

#[test]
fn fields_of_bodies_between_walls_are_explained_in_plane_strain() {
    for poisson_ratio in [0.3, 0.49] {
        let folder = TempDir::new().unwrap();
        let truth = measure(folder.path(), poisson_ratio);
        let report = corrected(folder.path(), &["--sheet", "plane-strain"], &[0]);
        assert_eq!(report["material"]["sheet"], "plane-strain");
        let (value, [low, high]) = force(&report);
        assert!(
            low < truth && truth < high,
            "ν = {poisson_ratio}: {truth} in {low} … {value} … {high}"
        );
        assert!((value / truth - 1.0).abs() < 0.01, "{value} {truth}");
    }
}

/// The in-plane field of neo-Hookean gel hardly depends on the walls where ν is ½, and much on them where it is 0.3: the verdict or the
/// force tells.
#[test]
fn the_same_fields_are_refuted_in_plane_stress_or_give_another_force() {
    for poisson_ratio in [0.3, 0.49] {
        let folder = TempDir::new().unwrap();
        let truth = measure(folder.path(), poisson_ratio);
        let report = corrected(folder.path(), &[], &[0, 1, 5]);
        assert_eq!(report["material"]["sheet"], "plane-stress");
        let verdict = &report["steps"][0]["corrected"]["verdict"];
        let (value, ends) = force(&report);
        println!("ν = {poisson_ratio}: {verdict} {value} {ends:?} {truth}");
        assert!((value / truth - 1.0).abs() > 0.05, "{value} {truth}");
    }
}

#[test]
fn the_file_of_conditions_states_the_plane_too_and_cards_must_have_it() {
    let folder = TempDir::new().unwrap();
    measure(folder.path(), 0.3);
    fs::write(
        folder.path().join("known.toml"),
        "sheet = \"plane-strain\"\n",
    )
    .unwrap();
    let report = corrected(folder.path(), &["--study", "known.toml"], &[0]);
    assert_eq!(report["material"]["sheet"], "plane-strain");
    let text = fs::read_to_string(folder.path().join("output/correct/report.md")).unwrap();
    assert!(text.contains("in plane strain, 20 mm thick"), "{text}");
    let arguments = [
        "correct",
        "block.csv",
        "--material",
        "neo-hooke",
        "--thickness",
        "20 mm",
        "--sheet",
        "plane-strain",
    ];
    let done = gelbench(folder.path(), &arguments).code(2);
    let message = one_line(&done.get_output().stderr);
    assert!(
        message.contains("is incompressible") && message.contains("poisson_ratio"),
        "{message}"
    );
}
