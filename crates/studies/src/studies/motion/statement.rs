//! What a study says, in the report's words and for machines: plate, grips, loads, material.

use serde_json::{Map, Value, json};

use super::deviations::OwnError;
use super::problem::{MovingPlate, PointForce};
use crate::dynamics::TimeFunction;
use crate::mass_spring::{DashpotLaw, SpringLaw};
use crate::results::Block;
use crate::units::number;

/// The plate, what moves and loads it, what springs and dashpots follow.
pub fn blocks(plate: &MovingPlate) -> Vec<Block> {
    let row = |(what, says): (&'static str, String)| vec![what.to_owned(), says];
    vec![
        Block::Heading(2, "Plate, supports and loads".into()),
        Block::table(
            &["what", "as in the study"],
            sentences(plate).into_iter().map(row),
        ),
    ]
}

/// The same for machines.
pub fn json(plate: &MovingPlate, own_error: Option<&OwnError>) -> Map<String, Value> {
    let sentences = sentences(plate).into_iter();
    let says: Map<_, _> = sentences
        .map(|(what, says)| (what.to_owned(), json!(says)))
        .collect();
    let all = json!({
        "size_mm": plate.problem.size,
        "thickness_mm": plate.problem.thickness,
        "density_kg_per_m3": 1e12 * plate.density,
        "says": says,
        "finite_element_own_error": own_error.map(|own| json!({
            "displacement_percent": own.displacement,
            "grip_force_percent": own.force,
        })),
    });
    all.as_object().cloned().unwrap_or_default()
}

fn sentences(plate: &MovingPlate) -> Vec<(&'static str, String)> {
    let [length, width] = plate.problem.size;
    let thickness = plate.problem.thickness;
    vec![
        (
            "plate",
            format!(
                "{length} × {width} × {thickness} mm at rest, of {}",
                plate.card.describe_sheet()
            ),
        ),
        ("density", format!("{} kg/m³", number(1e12 * plate.density))),
        ("viscosity", viscosity(plate)),
        ("left side", "clamped: ux = uy = 0".into()),
        ("right side", right_side(plate)),
        ("gravity", gravity(plate)),
        ("point forces", forces(plate)),
        ("springs", springs(plate)),
        ("dashpots", dashpots(plate)),
    ]
}

fn viscosity(plate: &MovingPlate) -> String {
    let material = &plate.viscosity;
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

/// How the grip on the right moves, in % of the plate's length.
fn right_side(plate: &MovingPlate) -> String {
    let motion = match &plate.grip {
        TimeFunction::Constant(stretch) => format!("held at {:.4} % stretch", 100.0 * stretch),
        TimeFunction::Ramp { begin, end } => {
            format!("from rest at {begin} s to 100 % stretch at {end} s")
        }
        TimeFunction::Sine {
            mean,
            amplitude,
            frequency,
        } => format!(
            "oscillating about {:.4} % stretch with an amplitude of {:.4} % at {frequency} Hz",
            100.0 * mean,
            100.0 * amplitude
        ),
        TimeFunction::Table(points) => {
            let points = points.iter();
            let points =
                points.map(|[time, stretch]| format!("{:.4} % at {time} s", 100.0 * stretch));
            format!(
                "moved linearly between {}",
                points.collect::<Vec<_>>().join(", ")
            )
        }
    };
    match plate.release {
        Some(time) => format!("in a rigid grip, {motion}; released at {time} s"),
        None => format!("in a rigid grip, {motion}"),
    }
}

fn gravity(plate: &MovingPlate) -> String {
    match plate.gravity {
        [0.0, 0.0] => "none".into(),
        [x, y] => format!(
            "({}, {}) m/s² in the plane of the plate",
            1e-3 * x,
            1e-3 * y
        ),
    }
}

fn forces(plate: &MovingPlate) -> String {
    let force = |own: &PointForce| {
        let ([x, y], [fx, fy]) = (own.at, own.force);
        let time = match &own.time {
            TimeFunction::Ramp { begin, end } => format!("growing from {begin} s to {end} s"),
            _ => "from time 0 on".into(),
        };
        format!("({fx}, {fy}) N at ({x}, {y}) mm, {time}")
    };
    if plate.forces.is_empty() {
        "none".into()
    } else {
        plate
            .forces
            .iter()
            .map(force)
            .collect::<Vec<_>>()
            .join("; ")
    }
}

fn springs(plate: &MovingPlate) -> String {
    match &plate.springs {
        SpringLaw::Material => "follow the material's curve".into(),
        SpringLaw::SecantModulus(function) => {
            format!("K(·) = a E/x₀ with a function E of λ − 1 of the study: {function}, in MPa")
        }
    }
}

fn dashpots(plate: &MovingPlate) -> String {
    match &plate.dashpots {
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
