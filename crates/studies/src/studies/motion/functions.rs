//! Functions that a study of motion states: the load factor in time, the stiffness and the damping of springs.

use super::problem::Drive;
use crate::document::{Bound, Section};
use crate::dynamics::TimeFunction;
use crate::mass_spring::{DashpotLaw, SpringLaw};
use crate::material::scalar_function::ScalarFunction;
use crate::statistics::extremes;
use crate::studies::specimen::Along;
use crate::units::Dimension;

/// Stretches that a grip may reach.
pub const STRETCHES: Bound = Bound::Within(LEAST, 10.0);

/// The least of them.
const LEAST: f64 = -0.5;

/// The load factor in time from that at the start: of a plate the stretch of its right grip, under keys of its own.
pub fn read_drive(section: &Section, start: f64, along: Along) -> Option<Drive> {
    let kinds = ["hold", "release", "ramp", "sine", "table"].map(|kind| (kind, kind));
    let instant = |key| section.quantity(key, Dimension::Time, Bound::NonNegative);
    let mut release = None;
    let factor = match section.choice("motion", &kinds)? {
        "hold" => TimeFunction::Constant(start),
        "release" => {
            release = Some(instant("time"));
            TimeFunction::Constant(start)
        }
        "ramp" => {
            let (begin, end) = (instant("begin"), instant("end"));
            let to = match along {
                Along::Stretch => section.stretch("to", STRETCHES),
                Along::LoadFactor => section.quantity("to", Dimension::Ratio, Bound::Any),
            };
            if end <= begin {
                section.fault("end", "must be after the begin", "give a later time");
                return None;
            }
            TimeFunction::Table(vec![[begin, start], [end, to]])
        }
        "sine" => TimeFunction::Sine {
            mean: start,
            amplitude: read_amplitude(section, start, along),
            frequency: section.quantity("frequency", Dimension::Frequency, Bound::Positive),
        },
        _ => TimeFunction::Table(read_table(section, start, along)?),
    };
    Some(Drive { factor, release })
}

/// The amplitude of an oscillation about the start.
fn read_amplitude(section: &Section, start: f64, along: Along) -> f64 {
    if along == Along::LoadFactor {
        return section.quantity("amplitude", Dimension::Ratio, Bound::Any);
    }
    let amplitude = section.quantity("amplitude", Dimension::Ratio, STRETCHES);
    if start - amplitude.abs() < LEAST {
        let message = "compresses the plate to less than half of its length";
        let hint = "take a smaller one, or a larger `start.stretch`";
        section.fault("amplitude", message, hint);
    }
    amplitude
}

/// The instants and load factors of a table.
fn read_table(section: &Section, start: f64, along: Along) -> Option<Vec<[f64; 2]>> {
    let times = section.quantities("times", Dimension::Time, Bound::NonNegative);
    let (key, factors) = match along {
        Along::Stretch => ("stretches", section.stretches("stretches", STRETCHES)),
        Along::LoadFactor => {
            let factors = section.multiples("factors", Bound::Any, f64::INFINITY);
            ("factors", factors)
        }
    };
    // "35 %" and 0.35 differ by rounding.
    let begins_elsewhere = |first: &f64| (first - start).abs() > 1e-12 * start.abs();
    if factors.first().is_some_and(begins_elsewhere) {
        let message = format!("must begin with the {} at the start", along.name());
        let hint = match along {
            Along::Stretch => "the grips have held the plate at `start.stretch` before time 0",
            Along::LoadFactor => "the sheet has been held at `start.factor` before time 0",
        };
        section.fault(key, &message, hint);
    }
    ascending(section, "times", times, factors)
}

/// The least and the largest load factor, or stretch, of a motion.
pub fn reached(motion: &TimeFunction) -> [f64; 2] {
    match motion {
        TimeFunction::Constant(factor) => [*factor; 2],
        TimeFunction::Ramp { .. } => [0.0, 1.0],
        TimeFunction::Sine {
            mean, amplitude, ..
        } => [mean - amplitude.abs(), mean + amplitude.abs()],
        TimeFunction::Table(points) => extremes(points.iter().map(|point| point[1])),
    }
}

/// The slowest and the fastest rate of a load factor, or stretch, in 1/s, rests left out; nothing where it rests.
pub fn rates(motion: &TimeFunction) -> Option<[f64; 2]> {
    let speeds: Vec<f64> = match motion {
        TimeFunction::Constant(_) => Vec::new(),
        TimeFunction::Ramp { begin, end } => vec![1.0 / (end - begin)],
        TimeFunction::Sine {
            amplitude,
            frequency,
            ..
        } => vec![std::f64::consts::TAU * frequency * amplitude.abs()],
        TimeFunction::Table(points) => {
            let pairs = points.windows(2);
            let rates = pairs.map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]));
            rates.map(f64::abs).collect()
        }
    };
    let [slowest, fastest] = extremes(speeds.into_iter().filter(|rate| *rate > 0.0));
    (slowest <= fastest).then_some([slowest, fastest])
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
    let points = times.into_iter().zip(values);
    Some(points.map(|(t, value)| [t, value]).collect())
}

/// A function of one variable.
fn read_function(section: &Section, dimension: Dimension) -> Option<ScalarFunction> {
    let kinds = ["constant", "polynomial", "table"].map(|kind| (kind, kind));
    Some(match section.choice("kind", &kinds)? {
        "constant" => {
            let value = section.quantity("value", dimension, Bound::NonNegative);
            ScalarFunction::constant(value)
        }
        "polynomial" => {
            let coefficients = section.quantities("coefficients", dimension, Bound::Any);
            ScalarFunction::Polynomial(coefficients)
        }
        _ => {
            let at = section.multiples("at", Bound::Any, f64::INFINITY);
            let values = section.quantities("values", dimension, Bound::NonNegative);
            let points = ascending(section, "at", at, values)?;
            let table = ScalarFunction::table(points).map_err(|reason| {
                let hint = "give two or more ascending points";
                section.fault("at", &reason.to_string(), hint);
            });
            table.ok()?
        }
    })
}

/// E(·) of springs.
pub fn read_stiffness(section: &Section) -> Option<SpringLaw> {
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

/// η(·) of dashpots.
pub fn read_damping(section: &Section) -> Option<DashpotLaw> {
    let function = read_function(section, Dimension::Viscosity);
    let choices = [("stretch", false), ("stretch rate", true)];
    let by_rate = section.stated("of", |_, key| section.choice(key, &choices));
    section.unknown_keys();
    let one = ScalarFunction::constant(1.0);
    let (by_stretch, by_rate) = if by_rate.unwrap_or(Some(true))? {
        (one, function?)
    } else {
        (function?, one)
    };
    Some(DashpotLaw::Viscosity {
        by_stretch,
        by_rate,
    })
}
