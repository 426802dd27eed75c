//! Checks of the times of a motion.

use super::functions::rates;
use super::problem::{Drive, PointForce};
use crate::document::Section;
use crate::dynamics::{Step, TimeFunction, TimeSettings};
use crate::material::viscosity::{Covered, ViscousMaterial};
use crate::studies::specimen::Along;

/// The section of the load factor in time.
pub fn drive_section(along: Along) -> &'static str {
    match along {
        Along::Stretch => "grip",
        Along::LoadFactor => "path",
    }
}

/// Warns where stresses, which are evaluated at the instants, miss relaxation between them.
fn check_interval(section: &Section, time: &TimeSettings, viscosity: &ViscousMaterial) {
    /// The longest interval over the shortest relaxation time: stresses are then a few percent off where a motion changes between two instants.
    const SHORT: f64 = 0.25;
    let shortest = viscosity.relaxation.iter().map(|term| term.time);
    let shortest = shortest.fold(f64::INFINITY, f64::min);
    if time.interval > SHORT * shortest * (1.0 + 1e-9) {
        let message = format!(
            "stresses in files and pictures assume a uniform motion between two instants, and the shortest relaxation time is {shortest} s"
        );
        let hint = format!(
            "forces account for every time step; for stresses take an interval of {} s or less",
            SHORT * shortest
        );
        section.warning("interval", &message, &hint);
    }
}

/// Whether steps and instants resolve a load factor that oscillates; steps that do not would compute another motion.
fn check_swing(section: &Section, time: &TimeSettings, drive: &Drive) {
    /// Steps in a period below which the motion is another one, and below which it is inaccurate.
    const FEWEST: f64 = 8.0;
    const FEW: f64 = 20.0;
    let Some(period) = drive.factor.period() else {
        return;
    };
    let advice = |key: &str, length: f64| {
        let message = format!(
            "is {:.3} times the grip's period of {period} s",
            length / period
        );
        let article = if key.starts_with('i') { "an" } else { "a" };
        let hint = format!("take {article} {key} of {} s or less", period / FEW);
        (message, hint)
    };
    if let Step::AtMost(step) = time.step {
        let step = step.min(time.interval);
        let (message, hint) = advice("step", step);
        if step > period / FEWEST {
            section.fault("step", &message, &hint);
            return;
        }
        if step > period / FEW * (1.0 + 1e-9) {
            section.warning("step", &message, &hint);
        }
    }
    if time.interval > period / FEWEST * (1.0 + 1e-9) {
        let (message, hint) = advice("interval", time.interval);
        section.warning(
            "interval",
            &format!("{message}: figures and pictures resolve it poorly"),
            &hint,
        );
    }
}

/// Warns where a support or a force does nothing in the time that is computed.
fn check_idle(
    root: &Section,
    time: &TimeSettings,
    (drive, along): (&Drive, Along),
    forces: &[PointForce],
) {
    let late = |begin: f64| begin >= time.duration;
    let hint = "take a longer `time.duration`, or an earlier time";
    let kinks = drive.factor.kinks().into_iter().take(1);
    let begins = kinks.chain(drive.release).reduce(f64::min);
    if begins.is_some_and(late) {
        let message = "does not begin within the computed time: nothing moves";
        root.section(drive_section(along))
            .warning("motion", message, hint);
    }
    let forces = forces.iter().filter(|force| match force.time {
        TimeFunction::Ramp { begin, .. } => late(begin),
        _ => false,
    });
    for PointForce { at: [x, y], .. } in forces {
        let message = format!("the force at ({x}, {y}) mm does not begin within the computed time");
        root.section("time").warning("duration", &message, hint);
    }
}

/// Checks whether steps, instants and duration suit the motion.
pub fn check_times(
    root: &Section,
    in_time: &Section,
    (motion, along): (Option<(&TimeSettings, &Drive)>, Along),
    viscosity: &ViscousMaterial,
    forces: &[PointForce],
) {
    let Some((time, drive)) = motion else {
        return;
    };
    check_interval(in_time, time, viscosity);
    check_covered(root, in_time, time, (drive, along), &viscosity.covered);
    check_swing(in_time, time, drive);
    check_idle(root, time, (drive, along), forces);
}

/// Warns where a motion lasts longer, or is faster or slower, than the tests from which the relaxation was found.
fn check_covered(
    root: &Section,
    in_time: &Section,
    time: &TimeSettings,
    (drive, along): (&Drive, Along),
    covered: &Covered,
) {
    if let Some([_, longest]) = covered.times
        && time.duration > longest * (1.0 + 1e-9)
    {
        let message =
            format!("the relaxation was measured over {longest} s, and the motion lasts longer");
        let hint = "relaxation that is slower than the tests is not in the card: find it from a longer test";
        in_time.warning("duration", &message, hint);
    }
    // The rate of a load factor is no rate of stretch.
    let stretch_rates = rates(&drive.factor).filter(|_| along == Along::Stretch);
    let (Some([low, high]), Some([slowest, fastest])) = (covered.rates, stretch_rates) else {
        return;
    };
    let outside = match (fastest > high * (1.0 + 1e-9), slowest < low * (1.0 - 1e-9)) {
        (true, _) => fastest,
        (false, true) => slowest,
        (false, false) => return,
    };
    let message = format!(
        "the stretch rate of the grip is {outside:.4} 1/s, and the relaxation was measured at {low:.4} to {high:.4} 1/s"
    );
    let hint = "the material may be stiffer at rates that were not tested than the card states: find it from tests at this rate";
    root.section(drive_section(along))
        .warning("motion", &message, hint);
}
