//! Plates with viscosity.

use std::fs;

use super::{TIME, columns, distance_percent, motion};
use crate::common::{folder_with, gelbench, machine_report, root};

/// A wave of the loss tangent tan δ = 3 η 2πf/E₀ loses the share 1 − e^(−π tan δ) of its amplitude in a period.
#[test]
fn the_released_plate_decays_by_its_loss_tangent_and_is_corrected() {
    let folder =
        folder_with(&fs::read_to_string(root().join("examples/released_plate.toml")).unwrap());
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let out = folder.path().join("out");
    let table = |model: &str| fs::read_to_string(out.join(format!("motion_{model}.csv"))).unwrap();
    let elements = columns(&table("finite_element"), "end displacement x");
    let ends = elements.concat();
    let maxima: Vec<f64> = ends
        .windows(3)
        .filter(|three| three[1] > three[0] && three[1] >= three[2])
        .map(|three| three[1])
        .chain(ends.last().copied())
        .collect();
    let [first, second, third] = maxima[..] else {
        panic!("three maxima: {maxima:?}");
    };
    let loss_tangent = 3.0 * 20.0 * std::f64::consts::TAU * 19.283 / 136_540.0;
    for ratio in [second / first, third / second] {
        let exact = (-std::f64::consts::PI * loss_tangent).exp();
        assert!((ratio / exact - 1.0).abs() < 0.02, "{ratio}, {exact}");
    }
    let report = fs::read_to_string(out.join("report.md")).unwrap();
    for printed in [
        "springs deviates from the finite elements' by 15.",
        "motion deviates from the finite elements' by 0.07",
        "4 × 2 cells: 0.33",
    ] {
        assert!(report.contains(printed), "{printed}: {report}");
    }
    let sizes = fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().metadata().unwrap().len());
    let size: u64 = sizes.sum();
    assert!(
        size < 10_000_000 && !out.join("vtk").exists(),
        "{size} bytes"
    );
    assert_eq!(machine_report(&out)["passed"], true);
}

#[test]
fn a_viscous_plate_in_sine_motion_dissipates_under_gravity_and_a_force() {
    let rest = "[tolerances]\nforce = \"100 %\"\n[material]\ncard = \"pva-10\"\ndensity = \"1 g/cm^3\"\n\
        [material.viscosity]\nshear = \"100 Pa·s\"\nrelaxation = [{ share = 0.2, time = \"5 ms\" }]\n\
        [grip]\nmotion = \"sine\"\namplitude = \"2 %\"\nfrequency = \"50 Hz\"\n\
        [gravity]\nx = \"0 m/s^2\"\ny = \"-9.81 m/s^2\"\n\
        [[force]]\nat = [\"15 mm\", \"10 mm\"]\nx = \"0 N\"\ny = \"5 mN\"\nbegin = \"0 s\"\nend = \"10 ms\"\n\
        [mass_spring.stiffness]\nkind = \"polynomial\"\ncoefficients = [\"0.14 MPa\", \"0.1 MPa\"]\n";
    for integrator in ["velocity-verlet", "generalised-alpha"] {
        let time = format!("{TIME}integrator = \"{integrator}\"\n");
        let folder = folder_with(&motion(&format!("{rest}{time}")));
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
        let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
        let row = report
            .lines()
            .find(|line| line.starts_with("| finite elements |"))
            .unwrap();
        let viscous_work: f64 = row.split('|').nth(9).unwrap().trim().parse().unwrap();
        assert!(viscous_work > 0.0, "{row}");
    }
}

#[test]
fn a_viscous_plate_at_rest_is_set_in_motion_by_a_force() {
    let rest = "[material]\ncard = \"neo-hooke\"\ndensity = \"1 g/cm^3\"\n\
        [material.viscosity]\nshear = \"0.01 Pa·s\"\n\
        [start]\nstretch = \"0 %\"\n[grip]\nmotion = \"hold\"\n\
        [[force]]\nat = [\"15 mm\", \"10 mm\"]\nx = \"0 N\"\ny = \"5 mN\"\nbegin = \"2 ms\"\nend = \"10 ms\"\n\
        [tolerances]\ndeviation = \"25 %\"\n";
    let time = format!("{TIME}integrator = \"velocity-verlet\"\n");
    let folder = folder_with(&motion(&format!("{rest}{time}")));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
}

/// Viscous forces take energy whatever high frequencies the integrator damps: 3 η ∫ (λ'/λ)² V dt, and some at the clamps.
#[test]
fn viscous_work_of_a_slow_ramp_is_that_of_the_closed_form() {
    let rest = "[start]\nstretch = \"0 %\"\n[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n[material.viscosity]\nshear = \"1000 Pa·s\"\n\
        [grip]\nmotion = \"ramp\"\nbegin = \"0 s\"\nend = \"1 s\"\nto = \"20 %\"\n\
        [time]\nduration = \"1 s\"\ninterval = \"0.1 s\"\nstep = \"10 ms\"\nintegrator = \"generalised-alpha\"\nspectral_radius = 0.5\n";
    let coarse = motion(rest).replace("\"Q2\"\ncells = [8, 4]", "\"Q1\"\ncells = [6, 2]");
    let folder = folder_with(&coarse);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let exact = 3.0 * 1e-3 * 0.2 * (1.0 - 1.0 / 1.2) * 300.0;
    for model in ["mass_spring", "finite_element"] {
        let text =
            fs::read_to_string(folder.path().join(format!("out/motion_{model}.csv"))).unwrap();
        let work = columns(&text, "viscous work").concat();
        assert!(
            work.windows(2).all(|pair| pair[1] >= pair[0]),
            "{model}: {work:?}"
        );
        let ratio = work[work.len() - 1] / exact;
        assert!(ratio > 0.95 && ratio < 1.25, "{model}: {ratio}");
    }
}

/// Viscous forces of a sudden grip last far shorter than steps: their work is told too large, and the motion goes on.
#[test]
fn a_very_viscous_plate_whose_grip_begins_suddenly_does_not_explode() {
    let rest = "[start]\nstretch = \"0 %\"\n[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n[material.viscosity]\nshear = \"1000 Pa·s\"\n\
        [grip]\nmotion = \"ramp\"\nbegin = \"0 s\"\nend = \"1 s\"\nto = \"20 %\"\n\
        [tolerances]\nforce = \"100 %\"\n\
        [corrector]\nenabled = false\n[time]\nduration = \"1 s\"\ninterval = \"0.1 s\"\nintegrator = \"generalised-alpha\"\n";
    let force = |settings: &str| {
        let folder = folder_with(&motion(&format!("{rest}{settings}")));
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
        let table = fs::read_to_string(folder.path().join("out/motion_finite_element.csv"));
        columns(&table.unwrap(), "grip force x").pop().unwrap()[0]
    };
    let long = force("step = \"10 ms\"\nspectral_radius = 0.5\n");
    let short = force("step = \"2 ms\"\nspectral_radius = 0.5\n");
    assert!((long / short - 1.0).abs() < 1e-6, "{long} N, {short} N");
}

/// The velocity of the grip jumps at the corners of a ramp, and viscous forces with it, wherever corners lie: at instants, within a
/// rounding error of a step, or between steps. All models tell the force before a jump.
#[test]
fn viscous_plates_have_one_force_at_the_corners_of_a_ramp() {
    for (begin, end) in [
        ("20 ms", "60 ms"),
        ("25 ms", "65 ms"),
        ("21.3 ms", "61.7 ms"),
    ] {
        let rest = format!(
            "[start]\nstretch = \"0 %\"\n[material]\ncard = \"neo-hooke\"\ndensity = \"1 g/cm^3\"\n\
             [material.viscosity]\nshear = \"200 Pa·s\"\n\
             [grip]\nmotion = \"ramp\"\nbegin = \"{begin}\"\nend = \"{end}\"\nto = \"5 %\"\n\
             [time]\nduration = \"80 ms\"\ninterval = \"10 ms\"\nintegrator = \"generalised-alpha\"\nspectral_radius = 0.5\n"
        );
        let folder = folder_with(&motion(&rest));
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        let forces = |model: &str| {
            let path = folder.path().join(format!("out/motion_{model}.csv"));
            columns(&fs::read_to_string(path).unwrap(), "grip force x")
        };
        let (corrected, elements) = (forces("corrected"), forces("finite_element"));
        assert_eq!(corrected.len(), 9, "{begin}");
        let actual = distance_percent(&corrected, &elements);
        assert!(
            actual < 5.0,
            "{begin}: {actual} %, {corrected:?}, {elements:?}"
        );
    }
}
