//! Studies that are computed to the end, small ones.

use std::fmt::Write;
use std::path::Path;

use gelbench::budget::Budget;
use gelbench::error::Error;
use gelbench::kinds::{kind_of, read_as};
use gelbench::material::registry::CARDS;
use gelbench::studies::{Progress, plate};

use super::Became;
use super::choices::Choices;

/// What a study of the campaign may ask for.
const SMALL: Budget = Budget {
    cells: 600.0,
    instants: 20.0,
    steps: 1000.0,
    unknowns: 2500.0,
    bytes: 3e8,
};

/// A text as it is where it is one of a study, else the study that the bytes choose.
fn computed(bytes: &[u8], of_choices: fn(&mut Choices) -> String) -> Became {
    match std::str::from_utf8(bytes) {
        Ok(text) if text.starts_with('#') || text.starts_with("kind") => compute(text),
        _ => compute(&of_choices(&mut Choices::new(bytes))),
    }
}

/// Reads and computes a study's text.
fn compute(text: &str) -> Became {
    let file = Path::new("study.toml");
    if std::env::var_os("GELBENCH_FUZZ_SHOW").is_some() {
        eprintln!("{text}");
    }
    let read = match kind_of("study.toml", text) {
        Ok(Some(case)) => read_as(case, file, text, SMALL),
        Ok(None) => plate::prepare(file, text, SMALL),
        Err(fault) => Err(fault),
    };
    let computed = read.and_then(|ready| ready.compute(Progress::silent()));
    match computed {
        Ok(results) => {
            let _ = results.passed();
            Became::Complete
        }
        Err(Error::Solve { .. }) => Became::Unsolved,
        Err(fault) => {
            if std::env::var_os("GELBENCH_FUZZ_SHOW").is_some() {
                eprintln!("{fault}");
            }
            Became::Refused
        }
    }
}

/// A plate.
pub fn run(bytes: &[u8]) -> Became {
    computed(bytes, plate_text)
}

/// A specimen of any shape.
pub fn specimen(bytes: &[u8]) -> Became {
    computed(bytes, specimen_text)
}

/// A plate in motion.
pub fn motion(bytes: &[u8]) -> Became {
    computed(bytes, motion_text)
}

/// A card that comes along.
pub fn card(choices: &mut Choices) -> &'static str {
    CARDS[choices.below(CARDS.len())].0
}

fn plate_text(choices: &mut Choices) -> String {
    let mut text = format!(
        "kind = \"plate\"\n[material]\ncard = \"{}\"\n",
        card(choices)
    );
    let (length, width) = (choices.between(20.0, 100.0), choices.between(10.0, 50.0));
    let across = 2 + 2 * choices.below(3);
    let along = ((across as f64 * length / width / 2.0).round() * 2.0).clamp(2.0, 40.0);
    let _ = writeln!(
        text,
        "[plate]\nlength = \"{length} mm\"\nwidth = \"{width} mm\"\nthickness = \"{} mm\"\ncells = [{along}, {across}]",
        choices.between(0.5, 3.0)
    );
    let sign = if choices.rarely() { -0.2 } else { 1.0 };
    let first = sign * choices.between(0.01, 0.8);
    let _ = writeln!(text, "[load]\nstretches = [{first}, {}]", 1.7 * first);
    let _ = writeln!(text, "[mass_spring]\narea_term = {}", choices.maybe());
    let _ = writeln!(
        text,
        "[corrector]\nscheme = \"{}\"\nmethod = \"{}\"",
        choices.one(&["biquadratic", "gauss"]),
        choices.one(&["climb", "direct"])
    );
    let cells = [4 + 4 * choices.below(3), 4 + 4 * choices.below(2)];
    let _ = writeln!(
        text,
        "[finite_element]\nelement = \"{}\"\ncells = {cells:?}\ngrading = {}",
        choices.one(&["Q2", "Q1"]),
        choices.between(1.0, 3.0)
    );
    text
}

fn specimen_text(choices: &mut Choices) -> String {
    let element = choices.one(&["Q2", "Q1", "T2", "T1", "Q2 serendipity"]);
    let adaptive = element.starts_with('T') && choices.rarely();
    let mut text = format!(
        "kind = \"specimen\"\n[material]\ncard = \"{}\"\n[finite_element]\nelement = \"{element}\"\nadaptive = {adaptive}\n\
         most_cells = 60\n[specimen]\nthickness = \"{} mm\"\ncells = {}\nlattice = \"{}\"\n",
        card(choices),
        choices.between(0.5, 3.0),
        [2, 2, 2, 4][choices.below(4)],
        choices.one(&["quadrilaterals", "triangles"]),
    );
    let groups = shape(choices, &mut text);
    let _ = writeln!(
        text,
        "[[support]]\ngroup = \"{}\"\nkind = \"clamp\"",
        groups[0]
    );
    pulled(choices, groups, &mut text);
    let (first, second) = (choices.between(0.1, 0.5), choices.between(0.6, 1.0));
    let _ = writeln!(
        text,
        "[path]\nfactors = [{first}, {second}]\nmeasured_group = \"{}\"",
        groups[1]
    );
    text
}

/// Writes a shape; its groups: one that is held, one that is pulled, another one.
fn shape(choices: &mut Choices, text: &mut String) -> [&'static str; 3] {
    let name = choices.one(&[
        "strip",
        "strip-with-hole",
        "notched-strip",
        "dog-bone",
        "ring-sector",
    ]);
    let _ = writeln!(text, "shape = \"{name}\"");
    let mut length = |key: &str, low: f64, high: f64| {
        let value = choices.between(low, high);
        let _ = writeln!(text, "{key} = \"{value} mm\"");
    };
    if name == "ring-sector" {
        length("inner_radius", 5.0, 10.0);
        length("outer_radius", 11.0, 20.0);
        let _ = writeln!(text, "angle = \"{} deg\"", choices.between(20.0, 200.0));
        return ["start", "end", "inside"];
    }
    length("length", 40.0, 60.0);
    length("width", 15.0, 30.0);
    match name {
        "strip-with-hole" => length("hole_diameter", 2.0, 12.0),
        "notched-strip" => {
            length("notch_depth", 1.0, 5.0);
            length("notch_length", 12.0, 20.0);
        }
        "dog-bone" => {
            length("narrow_length", 5.0, 15.0);
            length("narrow_width", 5.0, 12.0);
            length("shoulder_length", 11.0, 12.0);
        }
        _ => {}
    }
    ["left", "right", "top"]
}

/// Writes what pulls: a displacement, a grip, a force, a traction, a pressure or a turn.
fn pulled(choices: &mut Choices, [_, end, side]: [&str; 3], text: &mut String) {
    let (x, y) = (choices.between(-2.0, 20.0), choices.between(-1.0, 1.0));
    let small = choices.between(0.0, 0.02);
    let _ = match choices.below(7) {
        0 => writeln!(
            text,
            "[[support]]\ngroup = \"{end}\"\nkind = \"displacement\"\nx = \"{x} mm\"\ny = \"{y} mm\""
        ),
        1 => writeln!(
            text,
            "[[support]]\ngroup = \"{end}\"\nkind = \"displacement\"\nx = \"{y} * Y + {small} * X\"\ny = \"0 mm\""
        ),
        2 => writeln!(
            text,
            "[[support]]\ngroup = \"{end}\"\nkind = \"grip\"\nx_force = \"{small} N\"\ny = \"{y} mm\""
        ),
        3 => writeln!(
            text,
            "[[load]]\ngroup = \"{end}\"\nkind = \"traction\"\nx = \"{small} MPa\"\ny = \"0 MPa\""
        ),
        4 => writeln!(
            text,
            "[[load]]\ngroup = \"{side}\"\nkind = \"pressure\"\npressure = \"{small} MPa\""
        ),
        5 => writeln!(
            text,
            "[[load]]\ngroup = \"{end}\"\nkind = \"force\"\nx = \"{small} N\"\ny = \"{} N\"",
            0.1 * y
        ),
        _ => writeln!(
            text,
            "[[support]]\ngroup = \"{end}\"\nkind = \"rotation\"\ncentre = [\"50 mm\", \"0 mm\"]\nangle = \"{x} deg\""
        ),
    };
}

fn motion_text(choices: &mut Choices) -> String {
    let start = if choices.maybe() {
        choices.between(0.0, 0.3)
    } else {
        0.0
    };
    let mut text = format!(
        "kind = \"motion\"\n[material]\ncard = \"{}\"\ndensity = \"{} kg/m³\"\n",
        card(choices),
        choices.between(500.0, 3000.0)
    );
    if choices.maybe() {
        let _ = writeln!(
            text,
            "[material.viscosity]\nshear = \"{} Pa·s\"",
            choices.between(0.0, 50.0)
        );
        if choices.rarely() {
            let _ = writeln!(
                text,
                "relaxation = [{{ share = 0.3, time = \"{} s\" }}]",
                choices.between(0.01, 2.0)
            );
        }
    }
    let across = 2 + choices.below(2);
    let _ = writeln!(
        text,
        "[plate]\nlength = \"{} mm\"\nwidth = \"{} mm\"\nthickness = \"2 mm\"\ncells = [{}, {across}]\n[start]\nstretch = {start}",
        choices.between(100.0, 150.0),
        choices.between(50.0, 70.0),
        2 * across,
    );
    grip(choices, start, &mut text);
    if choices.maybe() {
        let _ = writeln!(
            text,
            "[gravity]\nx = \"{} m/s²\"\ny = \"-9.81 m/s²\"",
            choices.between(0.0, 10.0)
        );
    }
    if choices.maybe() {
        let _ = writeln!(
            text,
            "[[force]]\nat = [\"100 mm\", \"{} mm\"]\nx = \"{} N\"\ny = \"0 N\"\nbegin = \"0 s\"\nend = \"{} s\"",
            choices.between(0.0, 50.0),
            choices.between(-0.1, 0.2),
            choices.between(0.001, 0.05)
        );
    }
    let duration = choices.between(0.002, 0.02);
    let _ = writeln!(
        text,
        "[time]\nduration = \"{duration} s\"\ninterval = \"{} s\"\nintegrator = \"{}\"\nspectral_radius = {}",
        duration / (1 + choices.below(8)) as f64,
        choices.one(&["velocity-verlet", "generalised-alpha"]),
        choices.between(0.0, 1.0)
    );
    springs(choices, &mut text);
    let cells = [1 + choices.below(3), 1 + choices.below(2)];
    let _ = writeln!(
        text,
        "[finite_element]\nelement = \"{}\"\ncells = {cells:?}",
        choices.one(&["Q2", "Q1"])
    );
    text
}

/// Writes the motion of the right grip.
fn grip(choices: &mut Choices, start: f64, text: &mut String) {
    let time = choices.between(0.0, 0.02);
    let stretch = choices.between(0.0, 0.5);
    let _ = match choices.below(5) {
        0 => writeln!(text, "[grip]\nmotion = \"release\"\ntime = \"{time} s\""),
        1 => writeln!(text, "[grip]\nmotion = \"hold\""),
        2 => writeln!(
            text,
            "[grip]\nmotion = \"ramp\"\nto = {stretch}\nbegin = \"0 s\"\nend = \"{time} s\""
        ),
        3 => writeln!(
            text,
            "[grip]\nmotion = \"sine\"\namplitude = {stretch}\nfrequency = \"{} Hz\"",
            1e3 * time
        ),
        _ => writeln!(
            text,
            "[grip]\nmotion = \"table\"\ntimes = [\"0 s\", \"{time} s\"]\nstretches = [{start}, {stretch}]"
        ),
    };
}

/// Writes springs and dashpots of their own, if any.
fn springs(choices: &mut Choices, text: &mut String) {
    if choices.maybe() {
        let _ = writeln!(
            text,
            "[mass_spring.stiffness]\nkind = \"polynomial\"\ncoefficients = [\"{} MPa\", \"{} MPa\"]",
            choices.between(0.01, 0.2),
            choices.between(-0.1, 0.2)
        );
    }
    if choices.maybe() {
        let _ = writeln!(
            text,
            "[mass_spring.damping]\nkind = \"table\"\nof = \"{}\"\nat = [0.0, 1.0, 5.0]\nvalues = [\"{} Pa·s\", \"40 Pa·s\", \"20 Pa·s\"]",
            choices.one(&["stretch rate", "stretch"]),
            choices.between(0.0, 80.0)
        );
    }
}
