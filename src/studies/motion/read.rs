//! The study file of a motion.

use std::path::Path;
use std::sync::Arc;

use crate::document::{Bound, Section};
use crate::dynamics::{Integrator, Step, TimeFunction, TimeSettings};
use crate::finite_element::Element;
use crate::mass_spring::{DashpotLaw, LatticeSettings, SpringLaw};
use crate::material::Card;
use crate::material::card::read_viscosity;
use crate::material::scalar_function::ScalarFunction;
use crate::material::viscosity::ViscousMaterial;
use crate::problem::ClampedPlate;
use crate::studies::plate::study;
use crate::units::Dimension;

/// A point of the plate that is watched.
pub struct Probe {
    /// Its name.
    pub name: String,
    /// Where it is at rest, in mm.
    pub at: [f64; 2],
}

/// A dead force on a point.
pub struct PointForce {
    /// Where it pulls, in mm.
    pub at: [f64; 2],
    /// In N.
    pub force: [f64; 2],
    /// How much of it acts.
    pub time: TimeFunction,
}

/// What has to be reached, in %.
#[derive(Clone, Copy)]
pub struct Tolerances {
    /// Largest error of the energy balance.
    pub energy_percent: f64,
    /// Largest deviation of the springs from the finite elements.
    pub deviation_percent: f64,
}

/// A plate that moves.
pub struct MovingPlate {
    /// The plate; its stretches are that of the start, or none at rest.
    pub problem: ClampedPlate,
    /// The card of its material.
    pub card: Card,
    /// In tonne/mm³.
    pub density: f64,
    /// The viscous part of the material.
    pub viscosity: ViscousMaterial,
    /// The right grip's stretch in time.
    pub grip: TimeFunction,
    /// When it lets go, in s.
    pub release: Option<f64>,
    /// In mm/s².
    pub gravity: [f64; 2],
    /// Point forces.
    pub forces: Vec<PointForce>,
    /// Duration, instants, steps.
    pub time: TimeSettings,
    /// Cells of the lattice.
    pub cells: [usize; 2],
    /// What it consists of.
    pub lattice: LatticeSettings,
    /// K(·).
    pub springs: SpringLaw,
    /// D(·).
    pub dashpots: DashpotLaw,
    /// The finite element, and how many.
    pub element: (Element, [usize; 2]),
    /// Points that are watched.
    pub probes: Vec<Probe>,
    /// What has to be reached.
    pub tolerances: Tolerances,
}

/// Stretches that a grip may reach.
const STRETCHES: Bound = Bound::Within(-0.5, 10.0);

/// Most instants: every one is kept in memory.
const MOST_INSTANTS: f64 = 20_000.0;

/// Reads a study; nothing where it has faults, which are recorded.
pub fn read(root: &Section, folder: &Path) -> Option<MovingPlate> {
    let material = root.section("material").requiring(&["card", "density"]);
    let card = study::read_card(&material, folder);
    let own_density = card.as_ref().and_then(|card| card.density);
    let density = match own_density {
        Some(density) if !material.has("density") => density,
        _ => material.quantity("density", Dimension::Density, Bound::Positive),
    };
    let viscosity = match material.has("viscosity") {
        true => read_viscosity(&material.section("viscosity")),
        false => card
            .as_ref()
            .map(|card| card.viscosity.clone())
            .unwrap_or_default(),
    };
    material.unknown_keys();
    let plate = root
        .section("plate")
        .requiring(&["length", "width", "thickness"]);
    let (problem, cells) = study::read_plate(&plate, card.as_ref());
    plate.unknown_keys();

    let section = root.section("start").requiring(&["stretch"]);
    let start = section.quantity("stretch", Dimension::Ratio, STRETCHES);
    if let Some(card) = card.as_ref().filter(|_| start > 0.0) {
        study::check_range(&section, "stretch", start, card);
    }
    section.unknown_keys();
    let section = root.section("grip").requiring(&["motion", "time"]);
    let grip = read_grip(&section, start);
    let largest = grip.as_ref().map_or(0.0, |(motion, _)| largest(motion));
    if let Some(card) = card.as_ref().filter(|_| largest > start) {
        study::check_range(&section, "motion", largest, card);
    }
    section.unknown_keys();
    let section = root.section("gravity");
    let gravity =
        ["x", "y"].map(|axis| section.quantity(axis, Dimension::Acceleration, Bound::Any));
    section.unknown_keys();
    let forces = match root.has("force") {
        true => root
            .tables("force")
            .iter()
            .map(|one| read_force(one, &problem))
            .collect(),
        false => Vec::new(),
    };
    let time = read_time(&root.section("time").requiring(&["duration"]));

    let section = root.section("mass_spring");
    let lattice = LatticeSettings {
        area_term: section.flag("area_term"),
    };
    let springs = match section.has("stiffness") {
        true => read_stiffness(&section.section("stiffness")),
        false => Some(SpringLaw::Material),
    };
    let dashpots = match section.has("damping") {
        true => read_damping(&section.section("damping")),
        false => Some(DashpotLaw::Material(viscosity.clone())),
    };
    section.unknown_keys();
    let section = root.section("finite_element");
    let element = section.choice("element", &Element::NAMES);
    let element_cells = section.count_pair("cells", 1, 500);
    section.unknown_keys();
    let probes = match root.has("probe") {
        true => root.tables("probe"),
        false => Vec::new(),
    };
    let probes = probes.iter();
    let probes = probes.map(|probe| read_probe(probe, &problem)).collect();
    let section = root.section("tolerances");
    let percent = |key| 100.0 * section.quantity(key, Dimension::Ratio, Bound::Positive);
    let tolerances = Tolerances {
        energy_percent: percent("energy"),
        deviation_percent: percent("deviation"),
    };
    section.unknown_keys();
    let (grip, release) = grip?;
    let stretches = if start == 0.0 {
        Vec::new()
    } else {
        vec![start]
    };
    let card = card?;
    Some(MovingPlate {
        problem: ClampedPlate {
            law: Arc::clone(&card.law),
            stretches,
            ..problem
        },
        card,
        density,
        viscosity,
        grip,
        release,
        gravity,
        forces,
        time: time?,
        cells,
        lattice,
        springs: springs?,
        dashpots: dashpots?,
        element: (element?, element_cells?),
        probes,
        tolerances,
    })
}

#[derive(Clone, Copy)]
enum Grip {
    Hold,
    Release,
    Ramp,
    Sine,
    Table,
}

/// The right grip's stretch in time, and when it lets go.
fn read_grip(section: &Section, start: f64) -> Option<(TimeFunction, Option<f64>)> {
    let kinds = [
        ("hold", Grip::Hold),
        ("release", Grip::Release),
        ("ramp", Grip::Ramp),
        ("sine", Grip::Sine),
        ("table", Grip::Table),
    ];
    let stretch = |key| section.quantity(key, Dimension::Ratio, STRETCHES);
    let instant = |key| section.quantity(key, Dimension::Time, Bound::NonNegative);
    let held = TimeFunction::Constant(start);
    Some(match section.choice("motion", &kinds)? {
        Grip::Hold => (held, None),
        Grip::Release => (held, Some(instant("time"))),
        Grip::Ramp => {
            let (begin, end, to) = (instant("begin"), instant("end"), stretch("to"));
            let points = ascending(section, "end", vec![begin, end], vec![start, to])?;
            (TimeFunction::Table(points), None)
        }
        Grip::Sine => {
            let sine = TimeFunction::Sine {
                mean: start,
                amplitude: stretch("amplitude"),
                frequency: section.quantity("frequency", Dimension::Frequency, Bound::Positive),
            };
            (sine, None)
        }
        Grip::Table => {
            let times = section.quantities("times", Dimension::Time, Bound::NonNegative);
            let stretches = section.quantities("stretches", Dimension::Ratio, STRETCHES);
            if stretches.first().is_some_and(|first| *first != start) {
                let hint = "the grips have held the plate at `start.stretch` before time 0";
                section.fault(
                    "stretches",
                    "must begin with the stretch at the start",
                    hint,
                );
            }
            let points = ascending(section, "times", times, stretches)?;
            (TimeFunction::Table(points), None)
        }
    })
}

/// The largest stretch of a grip's motion.
fn largest(motion: &TimeFunction) -> f64 {
    match motion {
        TimeFunction::Constant(stretch) => *stretch,
        TimeFunction::Ramp { .. } => 1.0,
        TimeFunction::Sine {
            mean, amplitude, ..
        } => mean + amplitude.abs(),
        TimeFunction::Table(points) => points
            .iter()
            .fold(f64::NEG_INFINITY, |most, point| most.max(point[1])),
    }
}

/// Points of a table whose times ascend.
fn ascending(
    section: &Section,
    key: &'static str,
    times: Vec<f64>,
    values: Vec<f64>,
) -> Option<Vec<[f64; 2]>> {
    if times.len() != values.len() || times.is_empty() {
        section.fault(
            key,
            "must be as many as the values",
            "give one time for each value",
        );
        return None;
    }
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        section.fault(
            key,
            "must ascend",
            "sort the times and leave out repetitions",
        );
        return None;
    }
    Some(
        times
            .into_iter()
            .zip(values)
            .map(|(t, value)| [t, value])
            .collect(),
    )
}

/// A point of the plate in mm.
fn read_point(section: &Section, problem: &ClampedPlate) -> [f64; 2] {
    let at = section.quantities("at", Dimension::Length, Bound::NonNegative);
    let inside = |at: &[f64; 2]| at.iter().zip(problem.size).all(|(x, size)| *x <= size);
    match <[f64; 2]>::try_from(at) {
        Ok(at) if inside(&at) || at.iter().chain(&problem.size).any(|x| x.is_nan()) => at,
        _ => {
            let [length, width] = problem.size;
            let hint = format!("two lengths up to [\"{length} mm\", \"{width} mm\"]");
            section.fault("at", "must be a point of the plate", &hint);
            [0.0; 2]
        }
    }
}

fn read_probe(section: &Section, problem: &ClampedPlate) -> Probe {
    let probe = Probe {
        name: section.heading("name"),
        at: read_point(section, problem),
    };
    section.unknown_keys();
    probe
}

fn read_force(section: &Section, problem: &ClampedPlate) -> PointForce {
    let force = ["x", "y"].map(|axis| section.quantity(axis, Dimension::Force, Bound::Any));
    let instant = |key| section.quantity(key, Dimension::Time, Bound::NonNegative);
    let time = if section.has("begin") || section.has("end") {
        let (begin, end) = (instant("begin"), instant("end"));
        if end <= begin {
            section.fault("end", "must be after the begin", "give a later time");
        }
        TimeFunction::Ramp { begin, end }
    } else {
        TimeFunction::Constant(1.0)
    };
    let force = PointForce {
        at: read_point(section, problem),
        force,
        time,
    };
    section.unknown_keys();
    force
}

fn read_time(section: &Section) -> Option<TimeSettings> {
    let instant = |key| section.quantity(key, Dimension::Time, Bound::Positive);
    let (duration, interval) = (instant("duration"), instant("interval"));
    if duration / interval > MOST_INSTANTS {
        let hint = format!("take at most {MOST_INSTANTS} instants");
        section.fault("interval", "is too short for the duration", &hint);
    }
    if interval > duration {
        section.fault(
            "interval",
            "is longer than the duration",
            "take a shorter one",
        );
    }
    const STEP: &str = "step";
    let step = match section.text(STEP).as_str() {
        "automatic" => Step::Automatic,
        _ => Step::AtMost(instant(STEP)),
    };
    let alpha = Integrator::GeneralisedAlpha {
        spectral_radius: section.number("spectral_radius", Bound::Within(0.0, 1.0)),
        tolerance: section.number("tolerance", Bound::Within(1e-12, 1e-1)),
    };
    let integrators = [
        ("generalised-alpha", alpha),
        ("velocity-verlet", Integrator::VelocityVerlet),
    ];
    let integrator = section.choice("integrator", &integrators);
    section.unknown_keys();
    Some(TimeSettings {
        duration,
        interval,
        step,
        integrator: integrator?,
    })
}

#[derive(Clone, Copy)]
enum Kind {
    Constant,
    Polynomial,
    Table,
}

fn read_function(section: &Section, dimension: Dimension) -> Option<ScalarFunction> {
    let kinds = [
        ("constant", Kind::Constant),
        ("polynomial", Kind::Polynomial),
        ("table", Kind::Table),
    ];
    let function = match section.choice("kind", &kinds)? {
        Kind::Constant => {
            let value = section.quantity("value", dimension, Bound::NonNegative);
            ScalarFunction::constant(value)
        }
        Kind::Polynomial => {
            let coefficients = section.quantities("coefficients", dimension, Bound::Any);
            ScalarFunction::Polynomial(coefficients)
        }
        Kind::Table => {
            let at = section.quantities("at", Dimension::Ratio, Bound::Any);
            let values = section.quantities("values", dimension, Bound::NonNegative);
            let points = ascending(section, "at", at, values)?;
            match ScalarFunction::table(points) {
                Ok(table) => table,
                Err(reason) => {
                    section.fault("at", &reason, "give two or more ascending points");
                    return None;
                }
            }
        }
    };
    Some(function)
}

fn read_stiffness(section: &Section) -> Option<SpringLaw> {
    let modulus = read_function(section, Dimension::Stress);
    section.unknown_keys();
    let modulus = modulus?;
    if modulus.at(0.0)[0] <= 0.0 {
        section.fault(
            "kind",
            "the springs have no stiffness at rest",
            "E(0) must be positive",
        );
        return None;
    }
    Some(SpringLaw::SecantModulus(modulus))
}

fn read_damping(section: &Section) -> Option<DashpotLaw> {
    let function = read_function(section, Dimension::Viscosity);
    let by_rate = match section.has("of") {
        true => section.choice("of", &[("stretch", false), ("stretch rate", true)]),
        false => Some(true),
    };
    section.unknown_keys();
    let one = ScalarFunction::constant(1.0);
    let (by_stretch, by_rate) = match by_rate? {
        true => (one, function?),
        false => (function?, one),
    };
    Some(DashpotLaw::Viscosity {
        by_stretch,
        by_rate,
    })
}
