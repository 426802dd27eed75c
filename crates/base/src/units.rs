//! Physical quantities as text with a unit, and their conversion to gelbench's internal units.
//!
//! Inside the program every length is in mm, force in N, stress in MPa, energy in mJ, time in s and
//! mass in tonne. These units are consistent: 1 N = 1 tonne·mm/s², 1 MPa = 1 N/mm², 1 mJ = 1 N·mm.

mod dimension;
mod figures;
mod linear;
mod remedy;
mod sheet_size;

use dimension::{CELSIUS, UNITS};
pub use dimension::{Dimension, SIZES, on_the_end};
pub use figures::{brief, decimals, extents, number};
pub use linear::{Linear, LinearFault, parse_linear_length};
pub use remedy::{RareUnit, bare_ratio, could_be_stretch_ratios, rare, symbol};
pub use sheet_size::implausible_sheet;

/// Why a text is not a quantity of the wanted dimension.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuantityFault {
    /// The text does not begin with a finite decimal number.
    #[error("does not begin with a finite number")]
    NotANumber,
    /// The number has a comma.
    #[error("has a number with a comma")]
    DecimalComma,
    /// A number without a unit.
    #[error("has no unit")]
    MissingUnit,
    /// A unit that is not in the table.
    #[error("has the unknown unit `{0}`")]
    UnknownUnit(String),
    /// A magnitude outside the possible range of this dimension.
    #[error("{}", out_of_range(*.0))]
    OutOfRange(Dimension),
    /// A unit of another dimension.
    #[error("has the unit `{unit}`, which measures {}", .actual.name())]
    WrongDimension {
        /// The unit as written.
        unit: String,
        /// What that unit measures.
        actual: Dimension,
    },
}

fn out_of_range(dimension: Dimension) -> String {
    let ([least, most], unit) = (dimension.range(), dimension.internal_unit());
    let (name, space) = (dimension.name(), if unit.is_empty() { "" } else { " " });
    format!(
        "is not a possible {name}: its absolute value must be zero or lie between {least:e} and {most:e}{space}{unit}"
    )
}

/// 0 °C in K.
const ICE_POINT: f64 = 273.15;

/// The minus sign that is not the hyphen of the keyboard.
const MINUS: char = '\u{2212}';

/// Reads text such as `"15 cm"` and returns its value in the internal unit of `dimension`.
///
/// # Errors
/// A [`QuantityFault`] when the number or the unit is missing, unknown or of another dimension, or when the quantity is out of the possible range.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, QuantityFault> {
    // A minus sign as word processors write it.
    let text = &text.trim().replace(MINUS, "-");
    let split = number_length(text);
    let number: f64 = text[..split]
        .parse()
        .map_err(|_| QuantityFault::NotANumber)?;
    if !number.is_finite() {
        return Err(QuantityFault::NotANumber);
    }
    let unit = text[split..].trim();
    if unit.starts_with(',') {
        return Err(QuantityFault::DecimalComma);
    }
    if unit.is_empty() {
        return match dimension {
            Dimension::Ratio => admitted(number, dimension),
            _ => Err(QuantityFault::MissingUnit),
        };
    }
    let normalised = normalised(unit);
    if CELSIUS.contains(&&*normalised) {
        return match dimension {
            Dimension::Temperature => admitted(number + ICE_POINT, dimension),
            _ => Err(QuantityFault::WrongDimension {
                unit: unit.to_owned(),
                actual: Dimension::Temperature,
            }),
        };
    }
    match UNITS.iter().find(|(symbol, ..)| *symbol == normalised) {
        Some((_, actual, factor)) if *actual == dimension => admitted(number * factor, dimension),
        Some((_, actual, _)) => Err(QuantityFault::WrongDimension {
            unit: unit.to_owned(),
            actual: *actual,
        }),
        None => Err(QuantityFault::UnknownUnit(unit.to_owned())),
    }
}

/// A unit in the table's notation: powers as `^3`, which may be written `³` or, behind a letter, `3`.
fn normalised(unit: &str) -> String {
    let mut text = String::new();
    for letter in unit.chars() {
        match letter {
            '²' => text += "^2",
            '³' => text += "^3",
            'μ' => text.push('µ'),
            '*' => text.push('·'),
            '2' | '3' if text.ends_with(char::is_alphabetic) => {
                text.push('^');
                text.push(letter);
            }
            other => text.push(other),
        }
    }
    text
}

fn admitted(value: f64, dimension: Dimension) -> Result<f64, QuantityFault> {
    let admitted = dimension.admitted(value);
    admitted.ok_or(QuantityFault::OutOfRange(dimension))
}

/// The factor from a unit by its name alone, such as `"kPa"`, to the internal unit of `dimension`; a ratio may be
/// written as `-`.
///
/// # Errors
/// A [`QuantityFault`] when the unit is missing, unknown or of another dimension, or when its zero differs from that of K (°C).
pub fn factor(unit: &str, dimension: Dimension) -> Result<f64, QuantityFault> {
    match (dimension, unit) {
        (_, offset) if CELSIUS.contains(&offset) => {
            Err(QuantityFault::UnknownUnit(offset.to_owned()))
        }
        (Dimension::Ratio, "-" | "–" | "1" | "mm/mm" | "m/m" | "in/in") => Ok(1.0),
        _ => parse(&format!("1 {unit}"), dimension),
    }
}

/// Whether two texts are the same, or one quantity of some dimension, such as `200 g` and `0.2 kg`.
pub fn are_equal(one: &str, other: &str) -> bool {
    let equal = |dimension: Dimension| {
        let values = [one, other].map(|text| parse(text, dimension));
        matches!(values, [Ok(a), Ok(b)] if (a - b).abs() <= 1e-12 * a.abs())
    };
    one == other || Dimension::ALL.into_iter().any(equal)
}

/// Whether a unit is known for any dimension.
pub fn is_known(unit: &str) -> bool {
    let parsed = parse(&format!("1 {unit}"), Dimension::Length);
    !matches!(parsed, Err(QuantityFault::UnknownUnit(_)))
}

/// The first unit of length whose size in mm meets a condition.
pub fn length_unit(is_it: impl Fn(f64) -> bool) -> Option<&'static str> {
    let unit = UNITS
        .iter()
        .find(|(_, dimension, size)| *dimension == Dimension::Length && is_it(*size));
    unit.map(|(symbol, ..)| *symbol)
}

/// Length in bytes of the decimal number at the beginning of `text`.
pub fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let exponent_sign = end > 0 && matches!(bytes[end - 1], b'e' | b'E');
        let exponent = matches!(bytes[end], b'e' | b'E')
            && bytes
                .get(end + 1)
                .is_some_and(|next| next.is_ascii_digit() || b"+-".contains(next));
        let sign = matches!(bytes[end], b'+' | b'-') && (end == 0 || exponent_sign);
        if !(bytes[end].is_ascii_digit() || bytes[end] == b'.' || sign || exponent) {
            break;
        }
        end += 1;
    }
    end
}

#[cfg(test)]
mod tests;
