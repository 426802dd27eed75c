//! The study file of a motion: of a plate, or of a specimen of any shape.

use std::path::Path;

use super::functions::{STRETCHES, rates, reached, read_damping, read_drive, read_stiffness};
use super::problem::{Drive, MovingSheet, PointForce, Tolerances};
use super::timing::{check_times, drive_section};
use crate::budget::Need;
use crate::document::{Bound, Section};
use crate::dynamics::{Integrator, Step, TimeFunction, TimeSettings};
use crate::mass_spring::{DashpotLaw, LatticeSettings, SpringLaw};
use crate::material::Card;
use crate::material::card::read_viscosity;
use crate::material::registry::SWELLING;
use crate::material::softened_law::NO_SOFTENING_ADVICE;
use crate::material::viscosity::ViscousMaterial;
use crate::studies::card::read_card;
use crate::studies::pictures::Pictures;
use crate::studies::points::{Region, read_point, read_probes, tables};
use crate::studies::sections;
use crate::studies::specimen::{self, Along, Specimen};
use crate::units::{Dimension, number};

mod plate;

use plate::read_plate;

/// Reads a study; `None` where it has faults, which are recorded.
pub fn read(root: &Section, folder: &Path) -> Option<MovingSheet> {
    let section = root.section("material");
    let (card, density, viscosity) =
        read_material(&section.requiring(&["card", "density"]), folder);
    let along = if root.is_of("specimen") {
        Along::LoadFactor
    } else {
        Along::Stretch
    };
    let (lattice, springs, dashpots) =
        read_lattice(&root.section("mass_spring"), &viscosity, along);
    let card = card.as_ref();
    let start = read_start(root, card, along);
    let course =
        root.section(drive_section(along))
            .requiring(&["motion", "time", "measured_group"]);
    let drive = read_drive(&course, start, along);
    let specimen = match along {
        Along::Stretch => {
            check_reached(&course, start, card.zip(drive.as_ref()));
            read_plate(root, card, lattice)
        }
        Along::LoadFactor => specimen::read_moving(root, folder, card, &course),
    };
    course.unknown_keys();
    let region = specimen.as_ref().map(|specimen| {
        let outline = &specimen.outline;
        (outline.lattice(), outline.bounding_box())
    });
    let gravity = read_gravity(&root.section("gravity"));
    let forces = tables(root, "force", |section| {
        read_force(section, region.as_ref())
    });
    let in_time = root.section("time").requiring(&["duration"]);
    let time = read_time(&in_time);
    let motion = time.as_ref().zip(drive.as_ref());
    check_times(root, &in_time, (motion, along), &viscosity, &forces);
    let corrector = root.section("corrector");
    let is_corrected = corrector.flag("enabled");
    corrector.unknown_keys();
    let probes = read_probes(root, region.as_ref());
    let tolerances = read_tolerances(&root.section("tolerances"), drive.as_ref());
    let pictures = Pictures::read(&root.section("pictures"), "times", Dimension::Time, &[]);
    let sheet = MovingSheet {
        specimen: Specimen {
            name: "motion".into(),
            along,
            factors: (start != 0.0).then_some(start).into_iter().collect(),
            pictures,
            ..specimen?
        },
        density,
        viscosity,
        drive: drive?,
        gravity,
        forces,
        time: time?,
        springs: springs?,
        dashpots: dashpots?,
        is_corrected,
        probes,
        tolerances,
    };
    warn_of_rest(root, start, &sheet);
    check_release(root, &sheet);
    affords(&in_time, &corrector, &sheet).then_some(sheet)
}

/// Whether a motion is not too large; that it is, is recorded.
fn affords(in_time: &Section, corrector: &Section, sheet: &MovingSheet) -> bool {
    let need = sheet.need();
    let of_steps = Need {
        steps: need.steps,
        ..Need::default()
    };
    let others = Need { steps: 0.0, ..need };
    in_time.affords("step", of_steps, FEWER_STEPS)
        && in_time.affords("interval", others, SMALLER)
        && corrector.affords("enabled", sheet.need_of_correction(), UNCORRECTED)
}

/// Hints for motions that are too large.
const FEWER_STEPS: &str = "take a shorter duration, longer steps, or generalised-α; a short automatic step comes from small \
                           cells, little density or a stiff material";
const SMALLER: &str = "take a shorter duration, longer intervals or fewer cells";
const UNCORRECTED: &str = "the correction takes 200 steps in a period of the first longitudinal vibration: take a shorter duration or fewer cells, or \
                           enabled = false";

/// Plausible densities of soft materials in t/mm³.
const LIKELY_DENSITY: std::ops::RangeInclusive<f64> = 1e-10..=1e-8;

/// The card, the density in t/mm³ and the viscous part of the sheet's material.
fn read_material(section: &Section, folder: &Path) -> (Option<Card>, f64, ViscousMaterial) {
    let card = read_card(section, folder);
    let card_density = card.as_ref().and_then(|card| card.density);
    let density = match card_density {
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
    if let Some(card) = &card {
        check_card(section, card, &viscosity);
    }
    section.unknown_keys();
    (card, density, viscosity)
}

/// Whether a card is one for motions; faults and warnings are recorded.
fn check_card(section: &Section, card: &Card, viscosity: &ViscousMaterial) {
    if card.law_name == SWELLING {
        section.warning(
            "card",
            "this gel is in equilibrium with its solvent at every instant, which takes a time of about h²/D (hours for a millimetre): in a motion it \
             is too soft, because fast deformation leaves no time for exchange",
            "take an incompressible card with the modulus of the swollen gel, as `gelbench materials show` reports it",
        );
    }
    if !viscosity.is_none() && card.bulk_modulus().is_some() {
        let hint = "leave out the viscosity, or take an incompressible card";
        let message =
            "the viscous stress is that of an incompressible sheet, and this card is compressible";
        section.fault("card", message, hint);
    }
    if card.law.softening().is_some() {
        let message = "this card softens, and a motion in time has no memory of the largest load";
        section.fault("card", message, NO_SOFTENING_ADVICE);
    }
}

/// The load factor, or stretch, at the start.
fn read_start(root: &Section, card: Option<&Card>, along: Along) -> f64 {
    let section = root.section("start").requiring(&["stretch", "factor"]);
    let start = match along {
        Along::Stretch => section.stretch("stretch", STRETCHES),
        Along::LoadFactor => section.quantity("factor", Dimension::Ratio, Bound::Any),
    };
    if let Some(card) = card.filter(|_| along == Along::Stretch && start != 0.0) {
        sections::check_range(&section, "stretch", &[start], card);
    }
    section.unknown_keys();
    start
}

/// Warns of stretches of a plate outside the range of its card, or beyond the stability of its law.
fn check_reached(course: &Section, start: f64, driven: Option<(&Card, &Drive)>) {
    let Some((card, drive)) = driven else {
        return;
    };
    let [least, most] = reached(&drive.factor);
    let ends: Vec<f64> = [least.min(start), most.max(start)].into();
    let ends: Vec<f64> = ends.into_iter().filter(|end| *end != start).collect();
    sections::check_range(course, "motion", &ends, card);
}

/// Records a release of what no support holds.
fn check_release(root: &Section, sheet: &MovingSheet) {
    if sheet.drive.release.is_none() || sheet.is_measured_held() {
        return;
    }
    let message = format!(
        "releases nothing: no support holds the measured group `{}`",
        sheet.specimen.group
    );
    let hint = "name the group of a support as measured_group; a load ends by motion = \"table\" with factors down to 0";
    root.section(drive_section(sheet.specimen.along))
        .fault("motion", &message, hint);
}

/// Warns of a sheet that rests between its supports.
fn warn_of_rest(root: &Section, start: f64, sheet: &MovingSheet) {
    let problem = &sheet.specimen.problem;
    let is_driven =
        problem.supports.iter().any(|(_, support)| !support.rests()) || !problem.loads.is_empty();
    let stays = start == 0.0 && reached(&sheet.drive.factor) == [0.0; 2];
    if sheet.is_loaded() || is_driven && !stays {
        return;
    }
    let (message, hint) = match sheet.specimen.along {
        Along::Stretch => (
            "no grip moves and no force or gravity acts: the plate stays at rest",
            "give the [start] a stretch, the [grip] a motion, or the plate a [[force]] or [gravity]",
        ),
        Along::LoadFactor => (
            "no support moves and no load, force or gravity acts: the sheet stays at rest",
            "give the [start] a factor, the [path] a motion, or the sheet a [[load]], a [[force]] or [gravity]",
        ),
    };
    root.warning(drive_section(sheet.specimen.along), message, hint);
}

/// A point force: constant, or growing from `begin` to `end`.
fn read_force(section: &Section, region: Option<&Region>) -> PointForce {
    let force = ["x", "y"].map(|axis| section.quantity(axis, Dimension::Force, Bound::Any));
    let time = if section.has("begin") || section.has("end") {
        let begin = section.optional_quantity("begin", Dimension::Time, Bound::NonNegative);
        let begin = begin.unwrap_or(0.0);
        let end = section.quantity("end", Dimension::Time, Bound::NonNegative);
        if end <= begin {
            section.fault("end", "must be after the begin", "give a later time");
        }
        TimeFunction::Ramp { begin, end }
    } else {
        TimeFunction::Constant(1.0)
    };
    let at = read_point(section, "at", region);
    section.unknown_keys();
    PointForce { at, force, time }
}

fn read_gravity(section: &Section) -> [f64; 2] {
    let gravity =
        ["x", "y"].map(|axis| section.quantity(axis, Dimension::Acceleration, Bound::Any));
    section.unknown_keys();
    gravity
}

/// The option of a plate's lattice, its springs and its dashpots.
fn read_lattice(
    section: &Section,
    viscosity: &ViscousMaterial,
    along: Along,
) -> (LatticeSettings, Option<SpringLaw>, Option<DashpotLaw>) {
    let settings = LatticeSettings {
        // Only cells of a plate have area terms.
        area_term: along == Along::Stretch && section.flag("area_term"),
    };
    let springs = if section.has("stiffness") {
        read_stiffness(&section.section("stiffness"))
    } else {
        Some(SpringLaw::Material)
    };
    let dashpots = if section.has("damping") {
        read_damping(&section.section("damping"))
    } else {
        Some(DashpotLaw::Material(viscosity.clone()))
    };
    section.unknown_keys();
    (settings, springs, dashpots)
}

/// What a driven motion has to reach where the study does not state it, in %: a support that is driven imposes most of the displacement and of the
/// force, so that the limit for a free vibration would accept any field.
const DRIVEN_PERCENT: f64 = 5.0;

/// The same for a free motion: a fifth of the 80 % by which the springs of a plate without viscosity deviate over ten periods.
const FREE_PERCENT: f64 = 16.0;

/// The tolerances of a study; where supports are driven, the force is judged too.
fn read_tolerances(section: &Section, drive: Option<&Drive>) -> Tolerances {
    let is_driven =
        drive.is_some_and(|drive| drive.release.is_none() && rates(&drive.factor).is_some());
    let percent = |key| 100.0 * section.quantity(key, Dimension::Ratio, Bound::Positive);
    let or_usual = |key| match (section.has(key), is_driven) {
        (true, _) => percent(key),
        (false, true) => DRIVEN_PERCENT,
        (false, false) => FREE_PERCENT,
    };
    let tolerances = Tolerances {
        energy_percent: percent("energy"),
        deviation_percent: or_usual("deviation"),
        force_percent: (is_driven || section.has("force")).then(|| or_usual("force")),
    };
    section.unknown_keys();
    tolerances
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
