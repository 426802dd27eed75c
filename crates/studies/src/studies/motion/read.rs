//! The study file of a motion.

use std::path::Path;
use std::sync::Arc;

use super::functions::{
    GripMotion, STRETCHES, rates, reached_stretches, read_damping, read_grip, read_stiffness,
};
use super::problem::{MovingPlate, PointForce, Probe, Tolerances};
use super::timing::check_times;
use crate::budget::Need;
use crate::document::{Bound, Section};
use crate::dynamics::{Integrator, Step, TimeFunction, TimeSettings};
use crate::finite_element::Element;
use crate::mass_spring::{DashpotLaw, LatticeSettings, SpringLaw};
use crate::material::Card;
use crate::material::card::read_viscosity;
use crate::material::registry::SWELLING;
use crate::material::softened_law::WITHOUT;
use crate::material::viscosity::ViscousMaterial;
use crate::problem::ClampedPlate;
use crate::studies::card::read_card;
use crate::studies::pictures::Pictures;
use crate::studies::sections;
use crate::units::Dimension;
use crate::units::number;

/// The plate's material in motion.
struct Material {
    card: Option<Card>,
    density: f64,
    viscosity: ViscousMaterial,
}

/// The lattice, its springs and dashpots.
struct Lattice {
    settings: LatticeSettings,
    springs: Option<SpringLaw>,
    dashpots: Option<DashpotLaw>,
}

/// Reads a study; `None` where it has faults, which are recorded.
pub fn read(root: &Section, folder: &Path) -> Option<MovingPlate> {
    let section = root.section("material");
    let material = read_material(&section.requiring(&["card", "density"]), folder);
    let plate = root
        .section("plate")
        .requiring(&["length", "width", "thickness"]);
    let (problem, cells) = sections::read_plate(&plate, material.card.as_ref());
    plate.unknown_keys();
    let (start, grip) = read_stretches(root, material.card.as_ref());
    let gravity = read_gravity(&root.section("gravity"));
    let forces = tables(root, "force", |one| read_force(one, &problem));
    warn_of_rest(root, start, grip.as_ref(), gravity, &forces);
    let in_time = root.section("time").requiring(&["duration"]);
    let time = read_time(&in_time);
    let motion = time.as_ref().zip(grip.as_ref());
    check_times(root, &in_time, motion, &material.viscosity, &forces);
    let lattice = read_lattice(&root.section("mass_spring"), &material.viscosity);
    let section = root.section("corrector");
    let is_corrected = section.flag("enabled");
    section.unknown_keys();
    let element = read_element(&root.section("finite_element"));
    let probes = read_probes(root, &problem);
    let tolerances = read_tolerances(&root.section("tolerances"), grip.as_ref());
    let pictures = Pictures::read(&root.section("pictures"), "times", Dimension::Time, &[]);
    let (grip, card) = (grip?, material.card?);
    let plate = MovingPlate {
        problem: ClampedPlate {
            law: Arc::clone(&card.law),
            stretches: (start != 0.0).then_some(start).into_iter().collect(),
            ..problem
        },
        card,
        density: material.density,
        viscosity: material.viscosity,
        grip: grip.stretch,
        release: grip.release,
        gravity,
        forces,
        time: time?,
        cells,
        lattice: lattice.settings,
        springs: lattice.springs?,
        dashpots: lattice.dashpots?,
        is_corrected,
        element: element?,
        probes,
        tolerances,
        pictures,
    };
    let need = plate.need();
    let of_steps = Need {
        steps: need.steps,
        ..Need::default()
    };
    let others = Need { steps: 0.0, ..need };
    let affords = in_time.affords("step", of_steps, FEWER_STEPS)
        && in_time.affords("interval", others, SMALLER);
    affords.then_some(plate)
}

/// What makes a motion smaller.
const FEWER_STEPS: &str = "take a shorter duration, longer steps, or generalised-α; a short automatic step comes from small \
                           cells, little density or a stiff material";
const SMALLER: &str = "take a shorter duration, longer intervals or fewer cells";

/// All tables of a kind; none where the study has none.
fn tables<T>(root: &Section, key: &'static str, read: impl FnMut(&Section) -> T) -> Vec<T> {
    if root.has(key) {
        root.tables(key).iter().map(read).collect()
    } else {
        Vec::new()
    }
}

/// Densities in t/mm³ that soft materials have.
const LIKELY_DENSITY: std::ops::RangeInclusive<f64> = 1e-10..=1e-8;

fn read_material(section: &Section, folder: &Path) -> Material {
    let card = read_card(section, folder);
    let own_density = card.as_ref().and_then(|card| card.density);
    let density = match own_density {
        Some(density) if !section.has("density") => density,
        _ => section.quantity("density", Dimension::Density, Bound::Positive),
    };
    if !LIKELY_DENSITY.contains(&density) && density.is_finite() {
        let message = format!(
            "{} kg/m³ is outside the densities of tissue, gels and rubbers, 100 to 10000 kg/m³",
            number(1e12 * density)
        );
        section.warning(
            "density",
            &message,
            "check the unit: water has \"1000 kg/m^3\" or \"1 g/cm^3\"",
        );
    }
    let viscosity = match (section.has("viscosity"), &card) {
        (true, _) => read_viscosity(&section.section("viscosity")),
        (false, Some(card)) => card.viscosity.clone(),
        (false, None) => ViscousMaterial::default(),
    };
    if card.as_ref().is_some_and(|card| card.law_name == SWELLING) {
        section.warning(
            "card",
            "this gel is in equilibrium with its solvent at every instant, which takes a time of about h²/D (hours for a millimetre): in a motion it \
             is too soft, because fast deformation leaves no time for exchange",
            "take an incompressible card with the modulus of the swollen gel, as `gelbench materials show` reports it",
        );
    }
    if !viscosity.is_none()
        && card
            .as_ref()
            .is_some_and(|card| card.bulk_modulus().is_some())
    {
        let hint = "leave out the viscosity, or take an incompressible card";
        let message =
            "the viscous stress is that of an incompressible sheet, and this card is compressible";
        section.fault("card", message, hint);
    }
    if card
        .as_ref()
        .is_some_and(|card| card.law.softening().is_some())
    {
        let message = "this card softens, and a motion in time has no memory of the largest load";
        section.fault("card", message, WITHOUT);
    }
    section.unknown_keys();
    Material {
        card,
        density,
        viscosity,
    }
}

/// The stretch at the start, and the motion of the right grip from there.
fn read_stretches(root: &Section, card: Option<&Card>) -> (f64, Option<GripMotion>) {
    let section = root.section("start").requiring(&["stretch"]);
    let start = section.stretch("stretch", STRETCHES);
    if let Some(card) = card.filter(|_| start != 0.0) {
        sections::check_range(&section, "stretch", &[start], card);
    }
    section.unknown_keys();
    let section = root.section("grip").requiring(&["motion", "time"]);
    let grip = read_grip(&section, start);
    let reached = grip.as_ref().map(|grip| reached_stretches(&grip.stretch));
    if let Some((card, [least, most])) = card.zip(reached) {
        let beyond: Vec<f64> = [least.min(start), most.max(start)].into();
        let beyond: Vec<f64> = beyond.into_iter().filter(|end| *end != start).collect();
        sections::check_range(&section, "motion", &beyond, card);
    }
    section.unknown_keys();
    (start, grip)
}

/// Warns of a plate that rests between its grips.
fn warn_of_rest(
    root: &Section,
    start: f64,
    grip: Option<&GripMotion>,
    gravity: [f64; 2],
    forces: &[PointForce],
) {
    let rests = |grip: &GripMotion| reached_stretches(&grip.stretch) == [0.0; 2];
    let is_loaded = gravity != [0.0; 2] || forces.iter().any(|own| own.force != [0.0; 2]);
    if start == 0.0 && !is_loaded && grip.is_some_and(rests) {
        let message = "no grip moves and no force or gravity acts: the plate stays at rest";
        let hint = "give the [start] a stretch, the [grip] a motion, or the plate a [[force]] or [gravity]";
        root.warning("grip", message, hint);
    }
}

fn read_gravity(section: &Section) -> [f64; 2] {
    let gravity =
        ["x", "y"].map(|axis| section.quantity(axis, Dimension::Acceleration, Bound::Any));
    section.unknown_keys();
    gravity
}

fn read_lattice(section: &Section, viscosity: &ViscousMaterial) -> Lattice {
    let lattice = Lattice {
        settings: LatticeSettings {
            area_term: section.flag("area_term"),
        },
        springs: if section.has("stiffness") {
            read_stiffness(&section.section("stiffness"))
        } else {
            Some(SpringLaw::Material)
        },
        dashpots: if section.has("damping") {
            read_damping(&section.section("damping"))
        } else {
            Some(DashpotLaw::Material(viscosity.clone()))
        },
    };
    section.unknown_keys();
    lattice
}

/// What a driven motion has to reach where the study does not state it, in %: a grip that is driven imposes most of the displacement and of the
/// force, so that what would be good for a free vibration says nothing.
const DRIVEN_PERCENT: f64 = 5.0;

/// The tolerances of a study; where the grip is driven, the force is judged too.
fn read_tolerances(section: &Section, grip: Option<&GripMotion>) -> Tolerances {
    let is_driven =
        grip.is_some_and(|grip| grip.release.is_none() && rates(&grip.stretch).is_some());
    let percent = |key| 100.0 * section.quantity(key, Dimension::Ratio, Bound::Positive);
    let of_driven = |key| {
        if is_driven && !section.has(key) {
            DRIVEN_PERCENT
        } else {
            percent(key)
        }
    };
    let tolerances = Tolerances {
        energy_percent: percent("energy"),
        deviation_percent: of_driven("deviation"),
        force_percent: (is_driven || section.has("force")).then(|| of_driven("force")),
    };
    section.unknown_keys();
    tolerances
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

/// The finite element, and how many.
fn read_element(section: &Section) -> Option<(Element, [usize; 2])> {
    let element = section.choice("element", &Element::NAMES);
    let cells = section.count_pair("cells", 1, sections::MOST_CELLS);
    section.unknown_keys();
    element.zip(cells)
}

/// All probes; tables have columns of their names.
fn read_probes(root: &Section, problem: &ClampedPlate) -> Vec<Probe> {
    let mut names = Vec::new();
    tables(root, "probe", |section| {
        let probe = read_probe(section, problem);
        if names.contains(&probe.name) {
            let hint = "table columns carry this name: give each probe a name of its own";
            section.fault("name", "is the name of another probe", hint);
        }
        names.push(probe.name.clone());
        probe
    })
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
        let begin = if section.has("begin") {
            instant("begin")
        } else {
            0.0
        };
        let end = instant("end");
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
    if interval > duration {
        section.fault(
            "interval",
            "is longer than the duration",
            "take a shorter one",
        );
    }
    let step = section.quantity_or("automatic", "step", Dimension::Time, Bound::Positive);
    let step = step.map_or(Step::Automatic, Step::AtMost);
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
        most_steps: section.budget().steps,
    })
}
