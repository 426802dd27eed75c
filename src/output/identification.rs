//! Picture and figures of an identified spring.

use serde_json::{Value, json};

use super::picture::PALETTE;
use super::picture::lines::{Axis, Line, LineChart, Stroke, stacked};
use crate::identification::{Argument, Function, Identification, Recording};

const INK: [u8; 3] = [60, 60, 60];
const GREY: [u8; 3] = [190, 190, 190];

/// Points of a drawn curve.
const POINTS: usize = 201;

/// K(·) and D(·) with their bands over what every instant asks for, and what is left of force and motion.
pub fn identification_picture(found: &Identification, recording: &Recording) -> Vec<u8> {
    let motion = &found.motion;
    let secants = |own: &[f64], other: &dyn Fn(usize) -> f64, argument: &[f64]| -> Vec<[f64; 2]> {
        // Near zero a secant is noise alone.
        const LEAST: f64 = 0.25;
        let most = own
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
        let instants = (0..own.len()).filter(|i| own[*i].abs() > LEAST * most);
        let inertia = |i: usize| recording.mass * motion.acceleration[i];
        instants
            .map(|i| {
                [
                    argument[i],
                    (recording.force[i] - inertia(i) - other(i)) / own[i],
                ]
            })
            .collect()
    };
    let (over, label) = match found.settings.argument {
        Argument::Extension => (&motion.extension, "extension x [mm]"),
        Argument::Rate => (&motion.rate, "rate of extension [mm/s]"),
    };
    let elastic = |i: usize| found.stiffness.at(motion.extension[i]).value * motion.extension[i];
    let viscous = |i: usize| found.damping.at(over[i]).value * motion.rate[i];
    let stiffness = secants(&motion.extension, &viscous, &motion.extension);
    let damping = secants(&motion.rate, &elastic, over);
    let chart = |title: &str, x: &str, y: &str, function: &Function, points, colour| LineChart {
        title: title.to_owned(),
        x: Axis::linear(x),
        y: Axis::linear(y),
        lines: curves(function, points, colour),
        band: None,
    };
    stacked(&[
        (
            chart(
                "Spring K(·)",
                "extension x [mm]",
                "K [N/mm]",
                &found.stiffness,
                stiffness,
                PALETTE[0],
            ),
            340,
        ),
        (
            chart(
                "Dashpot D(·)",
                label,
                "D [N·s/mm]",
                &found.damping,
                damping,
                PALETTE[1],
            ),
            340,
        ),
        (residuals(found, recording), 260),
    ])
}

fn line(label: &str, points: Vec<[f64; 2]>, colour: [u8; 3], stroke: Stroke) -> Line {
    Line {
        label: label.to_owned(),
        points,
        colour,
        stroke,
    }
}

fn curves(function: &Function, points: Vec<[f64; 2]>, colour: [u8; 3]) -> Vec<Line> {
    let places = function.places(POINTS);
    let edge = |side: usize| places.iter().map(move |x| [*x, function.band(*x)[side]]);
    let outline = edge(0).chain(edge(1).rev()).collect();
    let curve = places.iter().map(|x| [*x, function.at(*x).value]).collect();
    let end = |side: usize| -> Vec<[f64; 2]> {
        places
            .iter()
            .map(|x| [*x, function.at(*x).interval[side]])
            .collect()
    };
    let darker = colour.map(|part| part / 2);
    vec![
        line("from force and motion", points, GREY, Stroke::Points),
        line("95 % band", outline, colour, Stroke::Filled),
        line("95 % at one place", end(0), colour, Stroke::Dashed),
        line("", end(1), colour, Stroke::Dashed),
        line("identified", curve, darker, Stroke::Solid),
    ]
}

fn residuals(found: &Identification, recording: &Recording) -> LineChart {
    let left = |measured: &[f64], fitted: &[f64], noise: f64| -> Vec<[f64; 2]> {
        let pairs = measured.iter().zip(fitted).zip(&recording.times);
        pairs
            .map(|((measured, fitted), t)| [*t, (measured - fitted) / noise])
            .collect()
    };
    let force = left(&recording.force, &found.motion.force, found.noise[1]);
    let extension = left(
        &recording.extension,
        &found.motion.extension,
        found.noise[0],
    );
    LineChart {
        title: "Residuals: measured less fitted, over the noise".into(),
        x: Axis::linear("time [s]"),
        y: Axis::linear("residual [–]"),
        lines: vec![
            line("extension", extension, PALETTE[5], Stroke::Points),
            line("force", force, INK, Stroke::Points),
        ],
        band: None,
    }
}

/// All figures of an identification. Numbers that do not exist are `null`.
pub fn identification_json(found: &Identification, recording: &Recording, file: &str) -> Value {
    let function = |(symbol, unit, function): (&str, &str, &Function)| {
        let curve = function.places(41).into_iter().map(|x| {
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
        "noise_of_extension_mm": found.noise[0],
        "noise_of_force_N": found.noise[1],
        "misfit": found.misfit,
        "degrees_of_freedom": found.freedom,
        "functions": found.functions().into_iter().map(function).collect::<Vec<_>>(),
        "residuals": recording.times.iter().enumerate().map(|(i, t)| json!({
            "time_s": t,
            "extension_mm": recording.extension[i] - found.motion.extension[i],
            "force_N": recording.force[i] - found.motion.force[i],
        })).collect::<Vec<_>>(),
        "warnings": found.warnings,
    })
}
