//! The statements of a study for the report and for machines: sheet, supports, loads, material.

use serde_json::{Map, Value, json};

use super::deviations::DiscretisationError;
use super::problem::{Drive, MovingSheet, PointForce};
use crate::dynamics::TimeFunction;
use crate::mass_spring::{DashpotLaw, SpringLaw};
use crate::results::{Block, object};
use crate::studies::specimen::{Along, load_words, support_words};
use crate::units::number;

/// The sheet, its supports and loads, and the laws of springs and dashpots.
pub fn blocks(sheet: &MovingSheet) -> Vec<Block> {
    let rows = sentences(sheet).into_iter();
    vec![
        Block::Heading(2, "Sheet, supports and loads".into()),
        Block::table(
            &["what", "as in the study"],
            rows.map(|(what, words)| vec![what, words]),
        ),
    ]
}

/// The same for machines.
pub fn json(sheet: &MovingSheet, own_error: Option<&DiscretisationError>) -> Map<String, Value> {
    let sentences = sentences(sheet).into_iter();
    let says: Map<_, _> = sentences
        .map(|(what, words)| (what, json!(words)))
        .collect();
    object(json!({
        "size_mm": sheet.specimen.outline.size(),
        "thickness_mm": sheet.specimen.problem.thickness,
        "density_kg_per_m3": 1e12 * sheet.density,
        "says": says,
        "finite_element_own_error": own_error.map(|error| json!({
            "displacement_percent": error.displacement,
            "grip_force_percent": error.force,
        })),
    }))
}

fn sentences(sheet: &MovingSheet) -> Vec<(String, String)> {
    let specimen = &sheet.specimen;
    let problem = &specimen.problem;
    let mut all = vec![
        (
            "sheet".to_owned(),
            format!(
                "{}, {} mm thick at rest, of {}",
                specimen.outline.describe(),
                problem.thickness,
                specimen.card.describe_sheet()
            ),
        ),
        (
            "density".into(),
            format!("{} kg/m³", number(1e12 * sheet.density)),
        ),
        ("viscosity".into(), viscosity(sheet)),
    ];
    let supports = problem.supports.iter();
    all.extend(
        supports.map(|(group, support)| (format!("support {group}"), support_words(support))),
    );
    let loads = problem.loads.iter();
    all.extend(loads.map(|(group, load)| (format!("load {group}"), load_words(load))));
    all.extend([
        (
            format!("{} in time", specimen.along.name()),
            in_time(&sheet.drive, specimen.along, &specimen.group),
        ),
        ("gravity".into(), gravity(sheet)),
        ("point forces".into(), forces(sheet)),
        ("springs".into(), springs(sheet)),
        ("dashpots".into(), dashpots(sheet)),
    ]);
    all
}

fn viscosity(sheet: &MovingSheet) -> String {
    let material = &sheet.viscosity;
    if material.is_none() {
        return "none".into();
    }
    let shear = 1e6 * material.shear_viscosity;
    let terms = material.relaxation.iter().map(|term| {
        let (share, time) = (100.0 * term.share, term.time);
        format!("{share:.4} % of the instantaneous stress relaxes with τ = {time} s")
    });
    let mut all = vec![format!("η = {shear:.6} Pa·s in parallel with the law")];
    all.extend(terms);
    all.join("; ")
}

/// The load factor in time; motions of supports and loads above are those at 1.
fn in_time(drive: &Drive, along: Along, group: &str) -> String {
    let at = |factor: f64| along.describe(factor);
    let motion = match &drive.factor {
        TimeFunction::Constant(factor) => format!("held at {}", at(*factor)),
        TimeFunction::Ramp { begin, end } => {
            format!("from rest at {begin} s to {} at {end} s", at(1.0))
        }
        TimeFunction::Sine {
            mean,
            amplitude,
            frequency,
        } => format!(
            "oscillating about {} with an amplitude of {} at {frequency} Hz",
            at(*mean),
            at(*amplitude)
        ),
        TimeFunction::Table(points) => {
            let points = points.iter();
            let points = points.map(|[time, factor]| format!("{} at {time} s", at(*factor)));
            format!("linear between {}", points.collect::<Vec<_>>().join(", "))
        }
    };
    match drive.release {
        Some(time) => format!("{motion}; the supports of `{group}` let go at {time} s"),
        None => motion,
    }
}

fn gravity(sheet: &MovingSheet) -> String {
    match sheet.gravity {
        [0.0, 0.0] => "none".into(),
        [x, y] => format!(
            "({}, {}) m/s² in the plane of the sheet",
            1e-3 * x,
            1e-3 * y
        ),
    }
}

fn forces(sheet: &MovingSheet) -> String {
    let force = |point: &PointForce| {
        let ([x, y], [fx, fy]) = (point.at, point.force);
        let time = match &point.time {
            TimeFunction::Ramp { begin, end } => format!("growing from {begin} s to {end} s"),
            _ => "from time 0 on".into(),
        };
        format!("({fx}, {fy}) N at ({x}, {y}) mm, {time}")
    };
    if sheet.forces.is_empty() {
        "none".into()
    } else {
        sheet
            .forces
            .iter()
            .map(force)
            .collect::<Vec<_>>()
            .join("; ")
    }
}

fn springs(sheet: &MovingSheet) -> String {
    match &sheet.springs {
        SpringLaw::Material => "follow the material's curve".into(),
        SpringLaw::SecantModulus(function) => {
            format!("K(·) = a E/x₀ with a function E of λ − 1 of the study: {function}, in MPa")
        }
    }
}

fn dashpots(sheet: &MovingSheet) -> String {
    match &sheet.dashpots {
        DashpotLaw::Material(material) if material.is_none() => "none".into(),
        DashpotLaw::Material(_) => "follow the material's viscosity".into(),
        DashpotLaw::Viscosity {
            by_stretch,
            by_rate,
        } => format!(
            "D(·) = a η/x₀ with η of the study in MPa·s: {by_stretch} of λ − 1 times {by_rate} of the rate in 1/s"
        ),
    }
}
