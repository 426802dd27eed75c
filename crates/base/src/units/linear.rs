//! Quantities that are linear in the reference coordinates, as text: `"2 mm + 0.1 * X - 5 % * Y"`.

use super::{Dimension, QuantityFault, parse};

/// f(X, Y) = f₀ + g₁ X + g₂ Y with the place at rest X, Y in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// f₀, the value at the origin, in the internal unit.
    pub at_origin: f64,
    /// g₁ and g₂, in the internal unit per mm.
    pub slope: [f64; 2],
}

impl Linear {
    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Self {
            at_origin: value,
            slope: [0.0; 2],
        }
    }

    /// The value at a place in mm.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.at_origin + self.slope[0] * x + self.slope[1] * y
    }
}

/// Why a text is not a linear function of the place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearFault {
    /// A sign without a term after it, or no text at all.
    #[error("lacks a term")]
    MissingTerm,
    /// A factor that is neither X nor Y.
    #[error("has the factor `{0}`, which is neither X nor Y (the position at rest)")]
    NotAPlace(String),
    /// A number that cannot be read, with its text and the dimension that it should have.
    #[error("has the term `{0}`, which {2}")]
    Quantity(String, Dimension, QuantityFault),
}

impl LinearFault {
    /// What to write instead.
    pub fn remedy(&self) -> String {
        const FORM: &str = "write a quantity, a number times X or Y, or a sum of these, such as \"2 mm + 0.1 * X - 0.05 * Y\"";
        match self {
            Self::Quantity(
                _,
                _,
                QuantityFault::NotANumber | QuantityFault::WrongDimension { .. },
            )
            | Self::MissingTerm
            | Self::NotAPlace(_) => FORM.to_owned(),
            Self::Quantity(text, dimension, fault) => fault.remedy(text, *dimension),
        }
    }
}

/// Reads a length that is linear in the place: a sum of lengths with their units and of ratios times `X` or `Y`, such
/// as `"0.1 * X"` or `"2 mm + 10 % * X - Y"`; the result is in mm.
///
/// # Errors
/// A [`LinearFault`] that names the term.
pub fn parse_linear_length(text: &str) -> Result<Linear, LinearFault> {
    let mut sum = Linear::constant(0.0);
    for (sign, term) in terms(text) {
        let term = term.trim();
        if term.is_empty() {
            return Err(LinearFault::MissingTerm);
        }
        let number = |text: &str, dimension| {
            let value = parse(text, dimension);
            value.map_err(|fault| LinearFault::Quantity(text.trim().to_owned(), dimension, fault))
        };
        let axis = |text: &str| ["X", "Y"].iter().position(|name| *name == text.trim());
        match (axis(term), term.split_once('*')) {
            (Some(axis), _) => sum.slope[axis] += sign,
            (None, None) if is_name(term) => return Err(LinearFault::NotAPlace(term.to_owned())),
            (None, None) => sum.at_origin += sign * number(term, Dimension::Length)?,
            (None, Some((left, right))) => {
                let (axis, factor) = match (axis(left), axis(right)) {
                    (Some(axis), _) => (axis, right),
                    (None, Some(axis)) => (axis, left),
                    (None, None) => return Err(LinearFault::NotAPlace(right.trim().to_owned())),
                };
                sum.slope[axis] += sign * number(factor, Dimension::Ratio)?;
            }
        }
    }
    Ok(sum)
}

fn is_name(text: &str) -> bool {
    text.chars().all(char::is_alphabetic)
}

/// The terms of a sum with their signs; a sign after an exponent's `e` belongs to its number, and so does one right before a number that
/// follows another sign or `*`.
fn terms(text: &str) -> Vec<(f64, &str)> {
    let bytes = text.as_bytes();
    let in_exponent = |at: usize| {
        at >= 2 && matches!(bytes[at - 1], b'e' | b'E') && {
            let before = bytes[at - 2];
            before.is_ascii_digit() || before == b'.'
        }
    };
    let of_number = |at: usize| {
        let follows = text[..at].trim_end().ends_with(['+', '-', '*']);
        follows && text[at + 1..].starts_with(|next: char| next.is_ascii_digit() || next == '.')
    };
    let (mut all, mut sign, mut start) = (Vec::new(), 1.0, 0);
    for (at, byte) in bytes.iter().enumerate() {
        if !matches!(byte, b'+' | b'-') || in_exponent(at) || of_number(at) {
            continue;
        }
        // A sign before the first term.
        if !text[..at].trim().is_empty() {
            all.push((sign, &text[start..at]));
        }
        sign = if *byte == b'-' { -1.0 } else { 1.0 };
        start = at + 1;
    }
    all.push((sign, &text[start..]));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_lengths_and_places_are_read() {
        for (text, at_origin, slope) in [
            ("2 mm", 2.0, [0.0, 0.0]),
            ("-1.5e-1 cm", -1.5, [0.0, 0.0]),
            ("0.1 * X", 0.0, [0.1, 0.0]),
            ("X", 0.0, [1.0, 0.0]),
            ("- Y", 0.0, [0.0, -1.0]),
            ("Y * 1e-3", 0.0, [0.0, 1e-3]),
            ("2 mm + 0.1*X - 5 % * Y", 2.0, [0.1, -0.05]),
            ("1 mm - 0.2 * X + 0.3 * X", 1.0, [-0.2 + 0.3, 0.0]),
            ("4 mm + -0.1 * Y", 4.0, [0.0, -0.1]),
            ("-4 mm - -.1*X + Y * -2e-1", -4.0, [0.1, -0.2]),
        ] {
            assert_eq!(
                parse_linear_length(text),
                Ok(Linear { at_origin, slope }),
                "{text}"
            );
        }
        let linear = parse_linear_length("2 mm + 0.1 * X - 0.05 * Y").unwrap();
        assert!((linear.at([10.0, 20.0]) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn faults_name_the_term() {
        for (text, message) in [
            ("", "lacks a term"),
            ("2 mm +", "lacks a term"),
            ("2 mm + - 1 mm", "lacks a term"),
            ("0.1 * Z", "the factor `Z`"),
            ("x", "the factor `x`"),
            ("0.1 * X * Y", "the factor"),
            ("2", "the term `2`, which has no unit"),
            (
                "2 N + X",
                "the term `2 N`, which has the unit `N`, which measures force",
            ),
            ("2 mm * X", "the term `2 mm`"),
        ] {
            let fault = parse_linear_length(text).expect_err(text).to_string();
            assert!(fault.contains(message), "{text}: {fault}");
        }
    }
}
