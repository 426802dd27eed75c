//! Motions of specimens of any shape.

use std::fs;
use std::path::Path;

use crate::common::{folder_with, gelbench, machine_report, words};

/// A table that a motion has written, column by column under the heads.
fn table(folder: &Path, name: &str) -> Vec<(String, Vec<f64>)> {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    let mut lines = text.lines();
    let heads = lines.next().unwrap().split(',').map(str::to_owned);
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|word| word.parse().unwrap()).collect())
        .collect();
    let column = |index: usize| rows.iter().map(|row| row[index]).collect();
    heads
        .enumerate()
        .map(|(index, head)| (head, column(index)))
        .collect()
}

fn column(table: &[(String, Vec<f64>)], head: &str) -> Vec<f64> {
    let actual = table.iter().find(|(name, _)| name == head);
    actual.unwrap_or_else(|| panic!("{head}")).1.clone()
}

const MATERIAL: &str = "[material]\ncard = \"neo-hooke\"\ndensity = \"1 g/cm^3\"\n";
const HELD: &str = "[[support]]\ngroup = \"left\"\nkind = \"clamp\"\n\
    [[support]]\ngroup = \"right\"\nkind = \"displacement\"\nx = \"30 mm\"\ny = \"0 mm\"\n";

/// The same strip in the words of a plate and in those of a specimen: springs, corrected motion and finite elements are the same.
#[test]
fn a_strip_moves_as_the_plate_does() {
    let common = format!(
        "kind = \"motion\"\n{MATERIAL}[material.viscosity]\nshear = \"20 Pa·s\"\n\
         [time]\nduration = \"10 ms\"\ninterval = \"1 ms\"\nstep = \"0.05 ms\"\nintegrator = \"generalised-alpha\"\n"
    );
    let plate = format!(
        "{common}[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = [12, 4]\n\
         [finite_element]\nelement = \"Q2\"\ncells = [12, 4]\n\
         [start]\nstretch = \"10 %\"\n[grip]\nmotion = \"sine\"\namplitude = \"2 %\"\nfrequency = \"50 Hz\"\n"
    );
    let strip = format!(
        "{common}[specimen]\nshape = \"strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = 4\n\
         {HELD}[start]\nfactor = 0.1\n[path]\nmotion = \"sine\"\namplitude = 0.02\nfrequency = \"50 Hz\"\nmeasured_group = \"right\"\n"
    );
    let [of_plate, of_strip] = [plate, strip].map(|study| {
        let folder = folder_with(&study);
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
        folder
    });
    for (model, exact) in [
        ("mass_spring", 1e-9),
        ("corrected", 1e-9),
        ("finite_element", 1e-9),
    ] {
        let name = format!("out/motion_{model}.csv");
        let tables = [&of_plate, &of_strip].map(|folder| table(folder.path(), &name));
        for (head, values) in &tables[0] {
            let others = column(&tables[1], head);
            assert_eq!(values.len(), others.len());
            let size = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            // Forces across the axis of symmetry are rounding.
            for (one, other) in values.iter().zip(&others).filter(|_| !head.contains('y')) {
                assert!(
                    (one - other).abs() <= exact * size,
                    "{model}, {head}: {one} {other}"
                );
            }
        }
    }
}

/// A slender strip held at λ = 1.5 and plucked across vibrates as a stiff string. In its current state, l long and w wide:
///
/// ```text
/// f = √(σ/ρ)/(2 l) (1 + 2 ε + (4 + π²/2) ε²),   ε² = E_t w²/(12 σ l²),   σ = 2 C₁₀ (λ² − 1/λ),   E_t = 2 C₁₀ (2 λ² + 1/λ)
/// ```
///
/// H. Fletcher, J. Acoust. Soc. Am. 36, 203 (1964), doi:10.1121/1.1918933
#[test]
fn a_slender_strip_in_tension_vibrates_as_a_stiff_string() {
    let study = format!(
        "kind = \"motion\"\n{MATERIAL}\
         [specimen]\nshape = \"strip\"\nlength = \"60 mm\"\nwidth = \"1 mm\"\nthickness = \"1 mm\"\ncells = 2\n\
         {HELD}[start]\nfactor = 1.0\n[path]\nmotion = \"hold\"\nmeasured_group = \"right\"\n\
         [[force]]\nat = [\"30 mm\", \"0 mm\"]\nx = \"0 N\"\ny = \"0.001 N\"\n\
         [[probe]]\nname = \"middle\"\nat = [\"30 mm\", \"0 mm\"]\n\
         [corrector]\nenabled = false\n\
         [time]\nduration = \"40 ms\"\ninterval = \"0.1 ms\"\nstep = \"0.1 ms\"\nintegrator = \"generalised-alpha\"\n"
    );
    let folder = folder_with(&study);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let report = machine_report(&folder.path().join("out"));
    let c10 = report["material"]["parameters"]["c10"]["value"]
        .as_f64()
        .unwrap();
    let of_elements = table(folder.path(), "out/motion_finite_element.csv");
    let times = column(&of_elements, "time [s]");
    let across = column(&of_elements, "middle displacement y [mm]");
    let mean = across.iter().sum::<f64>() / across.len() as f64;
    let downwards = across.windows(2).zip(times.windows(2));
    let crossings: Vec<f64> = downwards
        .filter(|(y, _)| y[0] > mean && y[1] <= mean)
        .map(|(y, t)| t[0] + (t[1] - t[0]) * (y[0] - mean) / (y[0] - y[1]))
        .collect();
    let periods = (crossings.len() - 1) as f64;
    let actual = periods / (crossings[crossings.len() - 1] - crossings[0]);
    let (lambda, density, length): (f64, f64, f64) = (1.5, 1e-9, 90.0);
    let width = lambda.powf(-0.5);
    let stress = 2.0 * c10 * (lambda * lambda - 1.0 / lambda);
    let tangent = 2.0 * c10 * (2.0 * lambda * lambda + 1.0 / lambda);
    let e = (tangent * width * width / (12.0 * stress * length * length)).sqrt();
    let stiff = 1.0 + 2.0 * e + (4.0 + 0.5 * std::f64::consts::PI.powi(2)) * e * e;
    let expected = (stress / density).sqrt() / (2.0 * length) * stiff;
    assert!(
        (actual / expected - 1.0).abs() < 5e-3,
        "{actual} {expected}"
    );
    // The springs deviate as far as they do in the middle; of the displacement with the 30 mm by which it is held, a hundredth as far.
    let of_springs = table(folder.path(), "out/motion_mass_spring.csv");
    let of_springs = column(&of_springs, "middle displacement y [mm]");
    let pairs = of_springs.iter().zip(&across);
    let (wrong, size) = pairs.fold((0.0_f64, 0.0_f64), |(wrong, size), (springs, elements)| {
        (
            wrong + (springs - elements).powi(2),
            size + elements * elements,
        )
    });
    let in_the_middle = 100.0 * (wrong / size).sqrt();
    let checks = report["requirements"].as_array().unwrap();
    let name = "mass-spring: displacement since the start over all instants";
    let check = checks.iter().find(|check| check["quantity"] == name);
    let reported = check.unwrap()["computed"].as_f64().unwrap();
    assert!(
        reported > 0.5 * in_the_middle && reported < 2.0 * in_the_middle,
        "{reported} % {in_the_middle} %"
    );
}

/// A traction that increases slowly leads to the displacement of the study at rest.
#[test]
fn a_slow_load_leads_to_the_equilibrium() {
    let sheet = "[specimen]\nshape = \"notched-strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nnotch_depth = \"2 mm\"\n\
         notch_length = \"6 mm\"\nthickness = \"1 mm\"\ncells = 4\n\
         [[support]]\ngroup = \"left\"\nkind = \"clamp\"\n[[load]]\ngroup = \"right\"\nkind = \"traction\"\nx = \"10 kPa\"\n";
    let moving = format!(
        "kind = \"motion\"\n{MATERIAL}[material.viscosity]\nshear = \"200 Pa·s\"\n{sheet}\
         [start]\nfactor = 0.0\n[path]\nmotion = \"ramp\"\nbegin = \"0 s\"\nend = \"0.2 s\"\nto = 1.0\nmeasured_group = \"right\"\n\
         [time]\nduration = \"0.4 s\"\ninterval = \"20 ms\"\nstep = \"5 ms\"\nintegrator = \"generalised-alpha\"\nspectral_radius = 0.5\n\
         [corrector]\nenabled = false\n[[probe]]\nname = \"end\"\nat = [\"30 mm\", \"0 mm\"]\n"
    );
    let folder = folder_with(&moving);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let of_elements = table(folder.path(), "out/motion_finite_element.csv");
    assert!(of_elements.iter().all(|(head, _)| !head.contains("force")));
    let end = column(&of_elements, "end displacement x [mm]");
    let still = format!(
        "kind = \"specimen\"\n[material]\ncard = \"neo-hooke\"\n{sheet}[path]\nfactors = [1.0]\nmeasured_group = \"right\"\n"
    );
    let folder = folder_with(&still);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let report = machine_report(&folder.path().join("out"));
    let states = report["steps"].as_array().unwrap();
    let groups = &states[0]["finite_element"]["groups"]["right"];
    let expected = groups["displacement_mm"][0].as_f64().unwrap();
    let last = end[end.len() - 1];
    assert!((last / expected - 1.0).abs() < 5e-3, "{last} {expected}");
}

#[test]
fn what_a_motion_does_not_have_is_refused_at_its_place() {
    let study = format!(
        "kind = \"motion\"\n{MATERIAL}\
         [specimen]\nshape = \"strip\"\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = 4\n\
         [[support]]\ngroup = \"left\"\nkind = \"rotation\"\ncentre = [\"0 mm\", \"0 mm\"]\nangle = \"5°\"\n\
         [[support]]\ngroup = \"right\"\nkind = \"grip\"\nx_force = \"1 N\"\ny = \"0 mm\"\n\
         [[load]]\ngroup = \"top\"\nkind = \"pressure\"\npressure = \"1 kPa\"\n\
         [start]\nfactor = 0.0\n[path]\nmotion = \"ramp\"\nbegin = \"0 s\"\nend = \"1 s\"\nto = 1.0\nmeasured_group = \"rigth\"\n\
         [time]\nduration = \"1 s\"\ninterval = \"0.1 s\"\n\
         [[probe]]\nname = \"far\"\nat = [\"90 mm\", \"0 mm\"]\n"
    );
    let folder = folder_with(&study);
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let message = words(&done.get_output().stderr);
    for part in [
        "support[1].kind: a rotation in time is not computed",
        "support[2].kind: a rigid grip that is pulled by a force has no equation of motion",
        "load[1].kind: a pressure that follows the edges is not computed in time",
        "path.measured_group: the specimen has no group `rigth`",
    ] {
        assert!(message.contains(part), "{part}: {message}");
    }
}
