//! Identified functions as the spring law of a study.

use std::fmt::Write;

use super::{Argument, Form, Function, Identification, Recording};
use crate::document::quoted;

/// Points of a table.
const POINTS: usize = 25;

/// The tables `[spring]`, `[spring.stiffness]` and `[spring.damping]` in TOML: K(·) and D(·) of f = K x + D ẋ, as
/// `linear` (a constant), `polynomial` in powers of the argument, or `table` between which cubics keep the shape. The
/// argument is the stretch (powers: less 1) or its rate where the length at rest is known, else the extension in mm.
pub fn law_text(found: &Identification, recording: &Recording, file: &str) -> String {
    let mut text = format!(
        "# K(·) and D(·) of f = m ẍ + D(·) ẋ + K(·) x, identified by `gelbench identify` from {file}.\n\n[spring]\n"
    );
    if let Some(length) = recording.length {
        let _ = writeln!(text, "length = {}", quoted(&format!("{length} mm")));
    }
    if recording.mass > 0.0 {
        let _ = writeln!(
            text,
            "mass = {}",
            quoted(&format!("{} g", plain(1e6 * recording.mass)))
        );
    }
    let arguments = [Argument::Extension, found.settings.argument];
    let names = ["stiffness", "damping"];
    for (((_, unit, function), argument), name) in
        found.functions().into_iter().zip(arguments).zip(names)
    {
        let _ = write!(text, "\n[spring.{name}]\nunit = {}\n", quoted(unit));
        text += &function_text(function, argument, recording.length);
    }
    text
}

fn function_text(function: &Function, argument: Argument, length: Option<f64>) -> String {
    let scale = length.unwrap_or(1.0);
    let (key, rest) = match (argument, length) {
        (Argument::Extension, Some(_)) => ("stretch", 1.0),
        (Argument::Extension, None) => ("extension", 0.0),
        (Argument::Rate, Some(_)) => ("stretch_rate", 0.0),
        (Argument::Rate, None) => ("extension_rate", 0.0),
    };
    let list = |numbers: Vec<f64>| {
        let texts: Vec<_> = numbers.into_iter().map(plain).collect();
        format!("[{}]", texts.join(", "))
    };
    match function.basis.form {
        Form::Constant => {
            let estimate = function.powers()[0];
            format!(
                "kind = \"linear\"\nvalue = {} # standard error {:.2e}\n",
                plain(estimate.value),
                estimate.standard_error
            )
        }
        Form::Polynomial(_) => {
            let powers = function.powers().into_iter().zip(0..);
            let values: Vec<f64> = powers
                .map(|(estimate, power)| estimate.value * scale.powi(power))
                .collect();
            let of = if rest > 0.0 {
                format!("{key} - 1")
            } else {
                key.to_owned()
            };
            format!(
                "kind = \"polynomial\"\nof = {}\ncoefficients = {}\n",
                quoted(&of),
                list(values)
            )
        }
        Form::Spline(_) => {
            let places = function.places(POINTS);
            let estimates: Vec<_> = places.iter().map(|x| function.at(*x)).collect();
            format!(
                "kind = \"table\"\n{key} = {}\nvalue = {}\nstandard_error = {}\n",
                list(places.iter().map(|x| rest + x / scale).collect()),
                list(estimates.iter().map(|one| one.value).collect()),
                list(estimates.iter().map(|one| one.standard_error).collect())
            )
        }
    }
}

/// A number with six significant digits, without trailing zeros.
fn plain(value: f64) -> String {
    let digits: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    digits.to_string()
}
