//! Identified functions as the spring law of a study.

use std::fmt::Write;

use super::{Argument, Form, Function, Identification, Recording};
use crate::document::quoted;

/// Points of a table.
const POINTS: usize = 25;

/// The tables `[springs.stiffness]` and `[springs.damping]` in TOML.
///
/// ```text
/// f = [K(·) x + D(·) ẋ] = a [E(·) (λ − 1) + η(·) λ̇],   E = K x₀/a in MPa,   η = D x₀/a in MPa·s
/// ```
///
/// Where the recording has the length x₀ and the cross-section a at rest, E and η are written, which make springs of all
/// lengths one material; otherwise K in N/mm and D in N·s/mm. The argument is the strain λ − 1 or its rate where x₀ is
/// known, else the extension in mm or its rate. A function is a `polynomial` of its argument, one coefficient for a
/// constant, or a `table`, between whose points cubics keep the shape.
pub fn law_text(found: &Identification, recording: &Recording, file: &str) -> String {
    let head = "# f = m ẍ + D(·) ẋ + K(·) x, identified by `gelbench identify` from";
    let mut text = format!("{head} {file}.\n");
    let material = recording
        .length
        .zip(recording.area)
        .map(|(length, area)| length / area);
    let units = match material {
        Some(_) => ["MPa", "MPa·s"],
        None => ["N/mm", "N·s/mm"],
    };
    let [stiffness, damping] = [&found.stiffness, &found.damping].map(|function| Written {
        function,
        factor: material.unwrap_or(1.0),
        length: recording.length,
    });
    let _ = write!(text, "\n[springs.stiffness]\nunit = {}\n", quoted(units[0]));
    text += &stiffness.text(Argument::Extension);
    let _ = write!(text, "\n[springs.damping]\nunit = {}\n", quoted(units[1]));
    text + &damping.text(found.settings.argument)
}

/// A function on its way to a file.
struct Written<'a> {
    function: &'a Function,
    factor: f64,
    length: Option<f64>,
}

impl Written<'_> {
    fn text(&self, argument: Argument) -> String {
        let of = match (argument, self.length) {
            (Argument::Extension, Some(_)) => "strain",
            (Argument::Extension, None) => "extension_mm",
            (Argument::Rate, Some(_)) => "strain_rate",
            (Argument::Rate, None) => "extension_rate_mm_per_s",
        };
        match self.function.basis.form {
            Form::Constant | Form::Polynomial(_) => self.polynomial(of),
            Form::Spline(_) => self.table(of),
        }
    }

    fn polynomial(&self, of: &str) -> String {
        let scale = self.length.unwrap_or(1.0);
        let powers = self.function.powers().into_iter().zip(0..);
        let (values, errors): (Vec<f64>, Vec<f64>) = powers
            .map(|(estimate, power)| {
                let factor = self.factor * scale.powi(power);
                (estimate.value * factor, estimate.standard_error * factor)
            })
            .unzip();
        let (values, errors) = (list(&values), list(&errors));
        format!(
            "kind = \"polynomial\"\nof = \"{of}\"\ncoefficients = {values}\nstandard_errors = {errors}\n"
        )
    }

    fn table(&self, of: &str) -> String {
        let scale = self.length.unwrap_or(1.0);
        let places = self.function.places(POINTS);
        let estimates: Vec<_> = places.iter().map(|x| self.function.at(*x)).collect();
        let column =
            |value: &dyn Fn(usize) -> f64| list(&(0..POINTS).map(value).collect::<Vec<_>>());
        let arguments = column(&|i| places[i] / scale);
        let values = column(&|i| self.factor * estimates[i].value);
        let errors = column(&|i| self.factor * estimates[i].standard_error);
        format!(
            "kind = \"table\"\nof = \"{of}\"\nat = {arguments}\nvalues = {values}\nstandard_errors = {errors}\n"
        )
    }
}

/// Numbers with six significant digits, without trailing zeros.
fn list(numbers: &[f64]) -> String {
    let plain = |value: &f64| -> String {
        let digits: f64 = format!("{value:.5e}").parse().unwrap_or(*value);
        // TOML tells whole numbers from others.
        format!("{digits:?}")
    };
    format!(
        "[{}]",
        numbers.iter().map(plain).collect::<Vec<_>>().join(", ")
    )
}
