//! Identified functions as the spring law of a study.

use std::fmt::Write;

use super::band::Function;
use super::basis::Form;
use super::joint::Argument;
use super::recording::Recording;
use super::types::Identification;
use crate::document::quoted;

/// Points of a table.
const POINTS: usize = 25;

/// The tables `[mass_spring.stiffness]` and `[mass_spring.damping]` of a study of the kind `motion`.
///
/// ```text
/// f = [K(·) x + D(·) ẋ] = a [E(·) (λ − 1) + η(·) λ̇],   E = K x₀/a in MPa,   η = D x₀/a in MPa·s
/// ```
///
/// Where the recording states the length x₀ and the cross-section a at rest, E and η are written over the strain λ −
/// 1 or its rate: with them, springs of all lengths represent one material. Otherwise K in N/mm and D in N·s/mm are
/// written over the extension in mm or its rate, which no study accepts. A function is `constant`, a `polynomial`, or
/// a `table`, between whose points cubics keep the shape.
pub fn law_text(result: &Identification, recording: &Recording, file: &str) -> String {
    let head = "# f = m ẍ + D(·) ẋ + K(·) x, identified by `gelbench identify` from";
    let mut text = format!("{head} {file}.\n");
    let specimen = recording.length.zip(recording.area);
    if specimen.is_none() {
        text += "# Studies take E = K x₀/a in MPa and η = D x₀/a in MPa·s: state length and area at rest.\n";
    }
    let (factor, scale, units) = match specimen {
        Some((length, area)) => (length / area, length, ["MPa", "MPa·s"]),
        None => (1.0, 1.0, ["N/mm", "N·s/mm"]),
    };
    let written = |function, unit| FunctionText {
        function,
        factor,
        scale,
        unit,
    };
    let of = if specimen.is_some() {
        "λ − 1"
    } else {
        "extension in mm"
    };
    let _ = write!(text, "\n[mass_spring.stiffness] # over {of}\n");
    text += &written(&result.stiffness, units[0]).text();
    let (key, of) = match (result.settings.argument, specimen) {
        (Argument::Extension, _) => ("stretch", of),
        (Argument::Rate, Some(_)) => ("stretch rate", "its rate in 1/s"),
        (Argument::Rate, None) => ("stretch rate", "its rate in mm/s"),
    };
    let _ = write!(
        text,
        "\n[mass_spring.damping] # over {of}\nof = {}\n",
        quoted(key)
    );
    text + &written(&result.damping, units[1]).text()
}

/// A function to be written to a file.
struct FunctionText<'a> {
    function: &'a Function,
    /// Factor of its values.
    factor: f64,
    /// Factor of its argument.
    scale: f64,
    unit: &'static str,
}

impl FunctionText<'_> {
    fn text(&self) -> String {
        match self.function.basis.form {
            Form::Constant | Form::Polynomial(_) => self.polynomial(),
            Form::Spline(_) => self.table(),
        }
    }

    fn polynomial(&self) -> String {
        let powers = self.function.powers().into_iter().zip(0..);
        let (values, errors): (Vec<f64>, Vec<f64>) = powers
            .map(|(estimate, power)| {
                let factor = self.factor * self.scale.powi(power);
                (estimate.value * factor, estimate.standard_error * factor)
            })
            .unzip();
        let errors = self.errors(&errors);
        match values[..] {
            [value] => format!(
                "kind = \"constant\"\nvalue = {} # standard error {errors}\n",
                self.quantity(value)
            ),
            _ => format!(
                "kind = \"polynomial\"\ncoefficients = {}\n# standard errors: {errors}\n",
                self.quantities(&values)
            ),
        }
    }

    /// Values below zero are written as zero: studies refuse springs that push and dashpots that add energy.
    fn table(&self) -> String {
        let positions = self.function.positions(POINTS);
        let estimates: Vec<_> = positions.iter().map(|x| self.function.at(*x)).collect();
        let arguments: Vec<String> = positions.iter().map(|x| plain(x / self.scale)).collect();
        let values: Vec<f64> = estimates
            .iter()
            .map(|one| self.factor * one.value.max(0.0))
            .collect();
        let errors: Vec<f64> = estimates
            .iter()
            .map(|one| self.factor * one.standard_error)
            .collect();
        let zero = if estimates.iter().any(|one| one.value < 0.0) {
            "# Values below zero are written as zero.\n"
        } else {
            ""
        };
        format!(
            "kind = \"table\"\nat = [{}]\nvalues = {}\n{zero}# standard errors: {}\n",
            arguments.join(", "),
            self.quantities(&values),
            self.errors(&errors)
        )
    }

    /// Standard errors, which a recording that is not explained has not.
    fn errors(&self, values: &[f64]) -> String {
        if values.iter().all(|value| value.is_finite()) {
            self.quantities(values)
        } else {
            "none, because the recording is not explained".to_owned()
        }
    }

    fn quantity(&self, value: f64) -> String {
        quoted(&format!("{} {}", plain(value), self.unit))
    }

    fn quantities(&self, values: &[f64]) -> String {
        let texts: Vec<String> = values.iter().map(|value| self.quantity(*value)).collect();
        format!("[{}]", texts.join(", "))
    }
}

/// A number with six significant digits, without trailing zeros.
fn plain(value: f64) -> String {
    let digits: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    // TOML distinguishes whole numbers from others.
    format!("{digits:?}")
}
