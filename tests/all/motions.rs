//! Studies of motions, as a user meets them.

use std::fs;

mod shapes;
mod viscous;

use crate::common::{folder_with, gelbench, machine_report, words};

/// A motion study with little to compute; the rest says what is not released from 10 % stretch.
fn motion(rest: &str) -> String {
    let usual = [
        ("[start]", "[start]\nstretch = \"10 %\"\n"),
        ("[grip]", "[grip]\nmotion = \"release\"\ntime = \"0 s\"\n"),
        (
            "[material]",
            "[material]\ncard = \"pva-10\"\ndensity = \"1020 kg/m^3\"\n",
        ),
    ];
    let usual = usual.iter().filter(|(head, _)| !rest.contains(head));
    let usual: String = usual.map(|(_, text)| *text).collect();
    format!(
        "kind = \"motion\"\ntitle = \"small\"\n\
         [plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\nthickness = \"1 mm\"\ncells = [6, 2]\n\
         [finite_element]\nelement = \"Q2\"\ncells = [8, 4]\n\
         [[probe]]\nname = \"end\"\nat = [\"30 mm\", \"5 mm\"]\n{usual}{rest}\n"
    )
}

const TIME: &str = "[time]\nduration = \"20 ms\"\ninterval = \"2 ms\"\nstep = \"0.05 ms\"\n";

#[test]
fn a_released_plate_is_written_with_tables_and_series() {
    let folder = folder_with(&motion(TIME));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let table = fs::read_to_string(folder.path().join("out/motion_mass_spring.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 12);
    assert!(lines[0].starts_with("time [s],kinetic energy [mJ]"));
    assert!(lines[0].ends_with(",end displacement y [mm],end velocity y [mm/s]"));
    let numbers =
        |line: &str| -> Vec<f64> { line.split(',').map(|word| word.parse().unwrap()).collect() };
    let (first, second) = (numbers(lines[1]), numbers(lines[2]));
    // Released at 10 %: the end flies back.
    assert!(
        (first[7] - 3.0).abs() < 1e-12 && second[7] < 3.0,
        "{first:?} {second:?}"
    );
    let series = fs::read_to_string(folder.path().join("out/vtk/finite_element.pvd")).unwrap();
    assert!(series.contains("timestep=\"0.02\""), "{series}");
    assert!(folder.path().join("out/small_energy.png").exists());
}

/// Of a slender plate many vibrations of bending are slower than the first longitudinal one, √(E₀/ρ)/(2 L) = 144 Hz here.
#[test]
fn the_longitudinal_frequency_of_a_slender_plate_is_none_of_bending() {
    let rest = "[start]\nstretch = \"0 %\"\n[grip]\nmotion = \"hold\"\n[material]\ncard = \"neo-hooke\"\ndensity = \"1 g/cm^3\"\n\
        [time]\nduration = \"1 ms\"\ninterval = \"0.5 ms\"\nstep = \"0.02 ms\"\n";
    let slender = motion(rest)
        .replace(
            "length = \"30 mm\"\nwidth = \"10 mm\"",
            "length = \"60 mm\"\nwidth = \"2 mm\"",
        )
        .replace("cells = [6, 2]", "cells = [60, 2]")
        .replace("cells = [8, 4]", "cells = [30, 2]")
        .replace("[\"30 mm\", \"5 mm\"]", "[\"60 mm\", \"0 mm\"]");
    let folder = folder_with(&slender);
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]);
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    for model in ["mass-spring", "finite elements"] {
        let row = report
            .lines()
            .find(|line| line.starts_with(&format!("| {model} | ")));
        let actual: f64 = row
            .unwrap()
            .split('|')
            .nth(6)
            .unwrap()
            .trim()
            .parse()
            .unwrap();
        assert!((actual / 144.3 - 1.0).abs() < 0.02, "{model}: {actual}");
    }
}

#[test]
fn every_fault_of_a_motion_is_told_with_its_remedy() {
    let rest = "[material]\ncard = \"pva-10\"\ndensity = \"1 mm\"\n\
        [grip]\nmotion = \"table\"\ntimes = [\"0 s\", \"0 s\"]\nstretches = [\"10 %\", \"20 %\"]\n\
        [time]\nduration = \"1 s\"\ninterval = \"2 s\"\nintegrator = \"verlet\"\n\
        [[force]]\nat = [\"40 mm\", \"0 mm\"]\nx = \"1 N\"\ny = \"0 N\"\n\
        [mass_spring.damping]\nkind = \"table\"\nat = [0.0]\nvalues = [\"1 Pa·s\"]\n";
    let folder = folder_with(&motion(rest));
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let message = words(&done.get_output().stderr);
    for fault in [
        "measures length",
        "must ascend",
        "longer than the duration",
        "\"velocity-verlet\"",
        "must be a point of the sheet",
        "two points",
    ] {
        assert!(message.contains(fault), "{fault}: {message}");
    }
    assert!(!folder.path().join("output").exists());
}

/// What moves is never taken from the study that comes along.
#[test]
fn a_motion_that_does_not_say_its_physics_is_refused() {
    let folder =
        folder_with("kind = \"motion\"\ntitle = \"nothing\"\n[grip]\nmotion = \"release\"\n");
    let done = gelbench(folder.path(), &["check", "small.toml"]).code(2);
    let message = words(&done.get_output().stderr);
    for key in [
        "material.card: is missing",
        "material.density: is missing",
        "plate.length: is missing",
        "plate.width: is missing",
        "plate.thickness: is missing",
        "start.stretch: is missing",
        "grip.time: is missing",
        "time.duration: is missing",
    ] {
        assert!(message.contains(key), "{key}: {message}");
    }
    assert!(message.contains("card = \"pva-10\""), "{message}");
}

#[test]
fn the_report_of_a_motion_says_plate_material_and_grips() {
    let folder = folder_with(&motion(TIME));
    gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let (report, json) = (read("report.md"), read("report.json"));
    for printed in [
        "a plate of 30 × 10 mm, 1 mm thick at rest",
        "held at 10 % stretch; the supports of `right` let go at 0 s",
        "1020.0 kg/m³",
        "marlow-exponential",
        "0.0611 MPa",
    ] {
        assert!(report.contains(printed), "{printed}: {report}");
    }
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let material = &json["material"];
    assert_eq!(material["parameters"]["amplitude"]["value"], 0.0611);
    assert_eq!(json["problem"]["thickness_mm"], 1.0);
}

/// Where nothing moves, forces at free nodes are rounding, and the corrector measures what is left by those at the grips.
#[test]
fn a_plate_that_is_held_and_one_that_comes_to_rest_are_corrected() {
    let held = "[start]\nstretch = \"5 %\"\n[grip]\nmotion = \"hold\"\n";
    let ramp = "[start]\nstretch = \"0 %\"\n[grip]\nmotion = \"ramp\"\nbegin = \"0 s\"\nend = \"0.1 s\"\nto = \"10 %\"\n";
    let material = "[material]\ncard = \"neo-hooke\"\ndensity = \"1 g/cm^3\"\n";
    let viscous = format!("{material}[material.viscosity]\nshear = \"50 Pa·s\"\n");
    let long = "[time]\nduration = \"0.4 s\"\ninterval = \"20 ms\"\nintegrator = \"generalised-alpha\"\nstep = \"10 ms\"\n";
    for study in [
        format!("{material}{held}{TIME}"),
        format!("{viscous}{ramp}{long}"),
    ] {
        let folder = folder_with(&motion(&study));
        gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
        let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
        assert!(report.contains("Newton steps"), "{report}");
    }
}

/// A force of 10 N tears the middle node through its cells: what came before is kept, and the end is told.
#[test]
fn a_motion_that_ends_before_its_time_keeps_its_instants() {
    let rest = "[start]\nstretch = \"0 %\"\n[grip]\nmotion = \"hold\"\n\
        [[force]]\nat = [\"15 mm\", \"5 mm\"]\nx = \"10 N\"\ny = \"3 N\"\nbegin = \"2 ms\"\nend = \"20 ms\"\n\
        [time]\nduration = \"20 ms\"\ninterval = \"0.5 ms\"\n";
    let folder = folder_with(&motion(rest));
    let run = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(3);
    let message = words(&run.get_output().stdout);
    assert!(
        message.contains("FAIL mass-spring (6 × 2 cells) at time 0.007 s"),
        "{message}"
    );
    assert!(
        message.contains("end the path or motion before it"),
        "{message}"
    );
    assert!(
        message.contains("corrected: displacement up to 0.0070000 s"),
        "{message}"
    );
    let instants = |model: &str| {
        let table = folder.path().join(format!("out/motion_{model}.csv"));
        fs::read_to_string(table).unwrap().lines().count() - 1
    };
    assert_eq!(instants("mass_spring"), 15);
    assert!(instants("finite_element") > 1);
    let report = fs::read_to_string(folder.path().join("out/report.md")).unwrap();
    assert!(report.contains("at time 0.007 s"), "{report}");
}

/// Steps that swing with the grip would see it at rest.
#[test]
fn steps_that_do_not_follow_a_swing_are_refused_and_what_does_nothing_is_told() {
    let swing = "[grip]\nmotion = \"sine\"\namplitude = \"2 %\"\nfrequency = \"100 Hz\"\n";
    let time = "[time]\nduration = \"0.1 s\"\ninterval = \"10 ms\"\nintegrator = \"generalised-alpha\"\nstep = \"10 ms\"\n";
    let start = "[start]\nstretch = \"0 %\"\n";
    let message = |rest: &str| {
        let folder = folder_with(&motion(rest));
        let done = gelbench(folder.path(), &["check", "small.toml"]);
        words(&done.get_output().stderr)
    };
    let refused = message(&format!("{start}{swing}{time}"));
    assert!(
        refused.contains("time.step") && refused.contains("times the grip's period"),
        "{refused}"
    );
    let fine = message(&format!(
        "{start}{swing}{}",
        time.replace("10 ms", "0.4 ms")
    ));
    assert!(!fine.contains("the grip's period"), "{fine}");
    let late = "[grip]\nmotion = \"ramp\"\nbegin = \"5 s\"\nend = \"6 s\"\nto = \"10 %\"\n";
    let idle = message(&format!("{start}{late}{TIME}"));
    assert!(
        idle.contains("does not begin within the computed time"),
        "{idle}"
    );
}

/// The columns of a table whose heads hold a word.
fn columns(table: &str, word: &str) -> Vec<Vec<f64>> {
    let mut lines = table.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows = lines.map(|line| -> Vec<f64> {
        let values = heads.iter().zip(line.split(','));
        let wanted = values.filter(|(head, _)| head.contains(word));
        wanted.map(|(_, value)| value.parse().unwrap()).collect()
    });
    rows.collect()
}

/// √(Σ (a − b)²/Σ b²) in %.
fn distance_percent(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let pairs = || a.iter().flatten().zip(b.iter().flatten());
    let wrong: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
    100.0 * (wrong / pairs().map(|(_, b)| b * b).sum::<f64>()).sqrt()
}

#[test]
fn the_finite_elements_own_error_is_what_finer_ones_differ_by() {
    let probes: String = (1..9)
        .map(|i| {
            let (x, y) = (10.0 * f64::from(i % 4), 5.0 * f64::from(i / 4));
            format!("[[probe]]\nname = \"p{i}\"\nat = [\"{x} mm\", \"{y} mm\"]\n")
        })
        .collect();
    let driven = "[start]\nstretch = \"0 %\"\n[grip]\nmotion = \"ramp\"\nto = \"30 %\"\nbegin = \"0 s\"\nend = \"10 ms\"\n";
    let swinging = "[time]\nduration = \"20 ms\"\ninterval = \"1 ms\"\n";
    let implicit = format!("{swinging}integrator = \"generalised-alpha\"\nstep = \"1 ms\"\n");
    for (rest, element) in [
        (format!("{driven}{swinging}"), "Q1"),
        (format!("{driven}{implicit}"), "Q1"),
        (format!("{driven}{swinging}"), "Q2"),
        (swinging.to_owned(), "Q1"),
    ] {
        let run = |cells: &str, rest: &str| {
            let text = motion(&format!(
                "{probes}{rest}[tolerances]\ndeviation = \"90 %\"\nforce = \"90 %\"\nenergy = \"20 %\"\n"
            ));
            let cells = format!("element = \"{element}\"\ncells = {cells}");
            let text = text.replace("element = \"Q2\"\ncells = [8, 4]", &cells);
            let folder = folder_with(&text);
            gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(0);
            let file =
                |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
            let report = machine_report(&folder.path().join("out"));
            let stated_percent =
                report["problem"]["finite_element_own_error"]["displacement_percent"].as_f64();
            let table = columns(&file("motion_finite_element.csv"), "displacement");
            (stated_percent.unwrap(), table)
        };
        let (stated, table) = run("[12, 4]", &rest);
        let shorter = rest.replace("step = \"1 ms\"", "step = \"0.1 ms\"");
        let truth = distance_percent(&table, &run("[48, 16]", &shorter).1);
        assert!(
            stated > 0.5 * truth && stated < 4.0 * truth,
            "{element}, {rest}: {stated} %, {truth} %"
        );
    }
}

#[test]
fn a_driven_plate_has_the_corrected_force_of_its_grip_and_may_go_without() {
    let driven = "[start]\nstretch = \"0 %\"\n[grip]\nmotion = \"ramp\"\nto = \"30 %\"\nbegin = \"0 s\"\nend = \"100 ms\"\n\
                  [time]\nduration = \"120 ms\"\ninterval = \"1 ms\"\n[tolerances]\ndeviation = \"16 %\"\n";
    let files = |rest: &str, code: i32| {
        let folder = folder_with(&motion(&format!("{driven}{rest}")));
        let message = gelbench(folder.path(), &["run", "small.toml", "--output", "out"]).code(code);
        let file = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).ok();
        (
            file("motion_corrected.csv"),
            file("motion_finite_element.csv").unwrap(),
            file("report.md").unwrap(),
            words(&message.get_output().stdout),
        )
    };
    let (corrected, elements, report, _) = files("force = \"20 %\"\n", 0);
    let [corrected, elements] =
        [corrected.unwrap(), elements].map(|table| columns(&table, "grip force x"));
    let actual = distance_percent(&corrected, &elements);
    assert!(actual < 10.0, "{actual} %");
    assert!(
        report.contains("corrected: force of the right grip"),
        "{report}"
    );
    let (corrected, _, report, _) = files("[corrector]\nenabled = false\n", 0);
    assert!(corrected.is_none());
    assert!(report.contains("The study disables the correction of the motion"));
    let (_, _, _, message) = files("force = \"0.001 %\"\n", 1);
    assert!(message.contains("force of the right grip"), "{message}");
}
