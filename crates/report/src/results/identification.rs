//! The picture and the numbers of an identified spring.

use serde_json::{Value, json};

use super::{Drawing, Line, LineChart, PALETTE, Stroke};
use crate::identification::{Argument, Function, Identification, Recording};
use crate::statistics::farthest;

const INK: [u8; 3] = [60, 60, 60];
const GREY: [u8; 3] = [190, 190, 190];

/// Points of a drawn curve.
const POINTS: usize = 201;

/// K(·) and D(·) with their bands and the secants at all instants, and the residuals of force and motion.
pub fn identification_picture(identification: &Identification, recording: &Recording) -> Drawing {
    let motion = &identification.motion;
    let (over, label) = match identification.settings.argument {
        Argument::Extension => (&motion.extension, "extension x [mm]"),
        Argument::Rate => (&motion.rate, "rate of extension [mm/s]"),
    };
    let elastic =
        |i: usize| identification.stiffness.at(motion.extension[i]).value * motion.extension[i];
    let viscous = |i: usize| identification.damping.at(over[i]).value * motion.rate[i];
    let force = |i: usize| recording.force[i] - recording.mass * motion.acceleration[i];
    let stiffness = secants(&motion.extension, &motion.extension, &|i| {
        force(i) - viscous(i)
    });
    let damping = secants(&motion.rate, over, &|i| force(i) - elastic(i));
    let stiffness = curves(&identification.stiffness, stiffness, PALETTE[0]);
    let damping = curves(&identification.damping, damping, PALETTE[1]);
    Drawing::Charts(vec![
        (
            LineChart::new("Spring K(·)", "extension x [mm]", "K [N/mm]", stiffness),
            340,
        ),
        (
            LineChart::new("Dashpot D(·)", label, "D [N·s/mm]", damping),
            340,
        ),
        (residuals(identification, recording), 260),
    ])
}

/// The share of the force in N divided by its argument, at every instant where the argument is large; near zero a secant is only noise.
fn secants(divisor: &[f64], argument: &[f64], force: &dyn Fn(usize) -> f64) -> Vec<[f64; 2]> {
    const LEAST: f64 = 0.25;
    let most = farthest(divisor.iter().copied()).abs();
    let instants = (0..divisor.len()).filter(|i| divisor[*i].abs() > LEAST * most);
    instants
        .map(|i| [argument[i], force(i) / divisor[i]])
        .collect()
}

fn curves(function: &Function, points: Vec<[f64; 2]>, colour: [u8; 3]) -> Vec<Line> {
    let positions = function.positions(POINTS);
    let edge = |side: usize| positions.iter().map(move |x| [*x, function.band(*x)[side]]);
    let end = |side: usize| {
        let positions = positions.iter();
        positions.map(move |x| [*x, function.at(*x).interval[side]])
    };
    let curve = positions.iter().map(|x| [*x, function.at(*x).value]);
    let darker = colour.map(|part| part / 2);
    let mut lines = vec![Line::new(
        "from force and motion",
        points,
        GREY,
        Stroke::Points,
    )];
    if function.reach[0].is_finite() {
        let band = edge(0).chain(edge(1).rev());
        lines.extend([
            Line::new("95 % band", band, colour, Stroke::Filled),
            Line::new("95 % pointwise", end(0), colour, Stroke::Dashed),
            Line::new("", end(1), colour, Stroke::Dashed),
        ]);
    }
    lines.push(Line::new("identified", curve, darker, Stroke::Solid));
    lines
}

fn residuals(identification: &Identification, recording: &Recording) -> LineChart {
    let Recording {
        times,
        force,
        extension,
        ..
    } = recording;
    let residual = |label: &str, [measured, fitted]: [&[f64]; 2], noise: f64, colour| {
        let pairs = measured.iter().zip(fitted).zip(times);
        let points = pairs.map(|((measured, fitted), t)| [*t, (measured - fitted) / noise]);
        Line::new(label, points, colour, Stroke::Points)
    };
    let [noise, force_noise] = identification.noise;
    let lines = vec![
        residual(
            "extension",
            [extension, &identification.motion.extension],
            noise,
            PALETTE[5],
        ),
        residual(
            "force",
            [force, &identification.motion.force],
            force_noise,
            INK,
        ),
    ];
    let title = "Residuals: measured less fitted, over the noise";
    LineChart::new(title, "time [s]", "residual [–]", lines)
}

/// All numbers of an identification. Numbers that do not exist are `null`.
pub fn identification_json(
    identification: &Identification,
    recording: &Recording,
    file: &str,
) -> Value {
    let function = |(symbol, unit, function): (&str, &str, &Function)| {
        let curve = function.positions(41).into_iter().map(|x| {
            let estimate = function.at(x);
            json!({
                "at": x,
                "value": estimate.value,
                "standard_error": estimate.standard_error,
                "interval_95_percent": estimate.interval,
                "band_95_percent": function.band(x),
            })
        });
        json!({
            "function": symbol,
            "unit": unit,
            "effective_coefficients": function.degrees,
            "coefficients_of_powers": function.powers().iter().map(|one| json!({
                "value": one.value,
                "standard_error": one.standard_error,
                "interval_95_percent": one.interval,
            })).collect::<Vec<_>>(),
            "curve": curve.collect::<Vec<_>>(),
        })
    };
    json!({
        "gelbench": env!("CARGO_PKG_VERSION"),
        "data": file,
        "instants": recording.times.len(),
        "mass_tonne": recording.mass,
        "length_mm": recording.length,
        "noise_of_extension_mm": identification.noise[0],
        "noise_of_force_N": identification.noise[1],
        "misfit": identification.misfit,
        "degrees_of_freedom": identification.freedom,
        "functions": identification.functions().into_iter().map(function).collect::<Vec<_>>(),
        "residuals": recording.times.iter().enumerate().map(|(i, t)| json!({
            "time_s": t,
            "extension_mm": recording.extension[i] - identification.motion.extension[i],
            "force_N": recording.force[i] - identification.motion.force[i],
        })).collect::<Vec<_>>(),
        "verdict": {
            "answer": identification.verdict.words(),
            "reasons": identification.verdict.reasons,
            "doubts": identification.verdict.doubts,
        },
        "warnings": identification.warnings,
    })
}
