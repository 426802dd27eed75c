//! What to write instead of a text that is no quantity.

use super::{Dimension, QuantityFault, UNITS, normalised, number_length, parse};
use crate::error::nearest;

/// Other names and spellings of units, in lower case, with bars between them.
const SPELLINGS: &[(&str, &str)] = &[
    ("mm", "millimetre|millimeter|millimetres|millimeters"),
    ("cm", "centimetre|centimeter|centimetres|centimeters"),
    ("m", "metre|meter|metres|meters"),
    (
        "µm",
        "micron|microns|micrometre|micrometer|micrometres|micrometers",
    ),
    ("in", "inch|inches|\"|″|zoll"),
    ("ft", "foot|feet"),
    ("mm^2", "mm2|sqmm|square mm"),
    ("cm^2", "cm2|sqcm|square cm"),
    ("m^2", "m2"),
    ("N", "newton|newtons"),
    ("gf", "grams-force|gram-force|pond"),
    ("µN", "un|micronewton|micronewtons"),
    ("kgf", "kilogram-force|kilopond|kp"),
    ("kgf/cm^2", "kp/cm^2|kg/cm^2"),
    ("dyn", "dyne|dynes"),
    ("dyn/cm^2", "dyne/cm^2"),
    ("K", "kelvin"),
    ("mol/L", "mol/l|mol/dm^3|mol/dm3|m"),
    ("mmol/L", "mmol/l|mm"),
    ("lbf", "lb|lbs|pound|pounds|pound-force"),
    ("Pa", "pascal|pascals"),
    ("N/mm^2", "n/mm2"),
    ("N/m^2", "n/m2"),
    ("mmHg", "torr|mm hg"),
    ("psi", "lbf/in^2|lbf/in2"),
    ("kg/m^3", "kg/m3"),
    ("g/cm^3", "g/cm3|g/cc|g/ml"),
    ("g", "gram|grams|gramme|grammes"),
    ("kg", "kilogram|kilograms|kilo"),
    ("tonne", "t|ton|tonnes"),
    ("s", "sec|secs|second|seconds"),
    ("ms", "msec|millisecond|milliseconds"),
    ("min", "minute|minutes|mins"),
    ("h", "hr|hrs|hour|hours"),
    ("Hz", "hertz|cycles/s|s^-1"),
    ("m/s^2", "m/s2|m/s/s"),
    ("mm/s^2", "mm/s2"),
    ("Pa·s", "pas|pa s|pa.s|pa-s"),
    ("mPa·s", "cp|cps|centipoise"),
    ("rad", "radian|radians"),
    ("deg", "degree|degrees|grad"),
    ("%", "percent|per cent|prozent|pct"),
    ("‰", "permille|per mille|promille"),
    ("µε", "ue|microstrain|microstrains|micro strain"),
];

/// Whether a text is one of some spellings.
fn is_one(text: &str, spellings: &str) -> bool {
    spellings.split('|').any(|known| known == text)
}

impl QuantityFault {
    /// What to write instead of `text`, where a quantity of a dimension is wanted.
    pub fn remedy(&self, text: &str, dimension: Dimension) -> String {
        match self {
            Self::DecimalComma => without_comma(text),
            Self::MissingUnit => {
                let known: Vec<_> = dimension.units().collect();
                let unit = known.first().copied().unwrap_or_default();
                format!(
                    "write it with its unit, as in \"{} {unit}\"; known units: {}",
                    text.trim(),
                    known.join(", ")
                )
            }
            Self::UnknownUnit(unit) => match meant(unit, dimension) {
                Some(known) => {
                    let number = &text.trim()[..number_length(text.trim())];
                    let space = if number.is_empty() { "" } else { " " };
                    format!("did you mean `{known}`? Write \"{number}{space}{known}\"")
                }
                None => format!(
                    "known units: {}",
                    dimension.units().collect::<Vec<_>>().join(", ")
                ),
            },
            Self::NotANumber | Self::OutOfRange(_) | Self::WrongDimension { .. } => {
                format!(
                    "write a {} such as {}",
                    dimension.name(),
                    dimension.example()
                )
            }
        }
    }
}

/// A unit that differs in its capitals alone from a usual one, which is mostly meant.
#[derive(Clone, Copy, Debug)]
pub struct RareUnit {
    /// What it measures.
    pub dimension: Dimension,
    /// The factor to the internal unit.
    pub factor: f64,
    /// What it means.
    pub meaning: &'static str,
    /// The usual unit.
    pub usual: &'static str,
}

/// The unit of this name, where it is none that this field uses but one of other capitals is.
pub fn rare(unit: &str) -> Option<RareUnit> {
    let (dimension, factor, meaning, usual) = match &*normalised(unit) {
        "mPa" => (Dimension::Stress, 1e-9, "a thousandth of a Pa", "MPa"),
        "mN/m^2" => (Dimension::Stress, 1e-9, "a thousandth of a Pa", "MN/m^2"),
        "MN" => (Dimension::Force, 1e6, "a million N", "mN"),
        _ => return None,
    };
    Some(RareUnit {
        dimension,
        factor,
        meaning,
        usual,
    })
}

/// The symbol of a unit in a table's head, however it is spelled: `KPa`, `Mpa`, `sec`, `Newton`, `kN/m²`. `None` where it is not known, or where
/// it is [`rare`].
pub fn symbol(unit: &str) -> Option<&'static str> {
    let text = normalised(unit.trim());
    let exact = UNITS.iter().find(|(known, ..)| *known == text);
    if let Some((known, ..)) = exact {
        return Some(known);
    }
    if rare(&text).is_some() {
        return None;
    }
    let lower = text.to_lowercase();
    let in_other_case = UNITS
        .iter()
        .find(|(known, ..)| known.to_lowercase() == lower);
    let spelled = || {
        SPELLINGS
            .iter()
            .find(|(_, spellings)| is_one(&lower, spellings))
    };
    in_other_case
        .map(|(known, ..)| *known)
        .or_else(|| spelled().map(|(known, _)| *known))
}

/// The unit that another spelling stands for, else the one that was probably meant.
fn meant(unit: &str, dimension: Dimension) -> Option<&'static str> {
    let lower = unit.to_lowercase();
    let of_dimension = |symbol: &str| {
        UNITS
            .iter()
            .any(|(known, of, _)| *known == symbol && *of == dimension)
    };
    let spelled = SPELLINGS
        .iter()
        .find(|(symbol, spellings)| of_dimension(symbol) && is_one(&lower, spellings));
    // Signs of ratios are near to any other short unit.
    let is_word = |known: &&str| known.len() > 2 && dimension != Dimension::Ratio;
    let in_other_case = || {
        dimension
            .units()
            .find(|known| known.to_lowercase() == lower)
    };
    spelled
        .map(|(symbol, _)| *symbol)
        .or_else(in_other_case)
        .or_else(|| nearest(unit, dimension.units().filter(is_word)))
        .or_else(|| {
            let words = SPELLINGS.iter().filter(|(symbol, _)| of_dimension(symbol));
            let words = words.flat_map(|(symbol, spellings)| {
                spellings.split('|').map(move |word| (word, *symbol))
            });
            let words: Vec<_> = words.filter(|(word, _)| word.len() > 3).collect();
            let near = nearest(&lower, words.iter().map(|(word, _)| *word))?;
            words
                .iter()
                .find(|(word, _)| *word == near)
                .map(|(_, symbol)| *symbol)
        })
}

/// The readings of a text whose number has a comma: a decimal point, and thousands where three digits follow.
fn without_comma(text: &str) -> String {
    let point = text.trim().replacen(',', ".", 1);
    let digits = text.split_once(',').map_or("", |(_, rest)| rest);
    let group = digits.chars().take_while(char::is_ascii_digit).count();
    let none = text.trim().replace(',', "");
    match group == 3 && !digits[group..].starts_with('.') {
        true => format!("write \"{point}\" or \"{none}\", whichever is meant"),
        false if text.matches(',').count() == 1 && !digits.contains('.') => {
            format!("write \"{point}\", with a decimal point")
        }
        false => format!("write \"{none}\", without commas"),
    }
}

/// The number of a text that is a ratio without a percent sign.
pub fn bare_ratio(text: &str) -> Option<f64> {
    let text = text.trim();
    (number_length(text) == text.len())
        .then(|| parse(text, Dimension::Ratio).ok())
        .flatten()
}

/// Whether ratios without a percent sign could as well be λ as λ − 1: none lies below rest, λ = 1, and none far beyond it.
pub fn could_be_stretch_ratios(bare: &[f64]) -> bool {
    const FROM_REST: std::ops::RangeInclusive<f64> = 1.0..=3.0;
    bare.iter().all(|ratio| FROM_REST.contains(ratio)) && bare.iter().any(|ratio| *ratio > 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_heads_are_known_however_they_are_spelled() {
        for (unit, expected) in [
            ("KPa", Some("kPa")),
            ("Mpa", Some("MPa")),
            ("mPa", None),
            ("MN", None),
            ("MN/m2", Some("MN/m^2")),
            ("mN/m²", None),
            ("kgf/cm^2", Some("kgf/cm^2")),
            ("Sec", Some("s")),
            ("S", Some("s")),
            ("newton", Some("N")),
            ("MM", Some("mm")),
            ("MPa·s", Some("MPa·s")),
            ("furlong", None),
            ("\u{3bc}ε", Some("µε")),
            ("ue", Some("µε")),
            ("Microstrain", Some("µε")),
            ("px", None),
        ] {
            assert_eq!(symbol(unit), expected, "{unit}");
        }
    }

    #[test]
    fn ratios_from_rest_on_could_be_either() {
        for (bare, expected) in [
            (&[1.05, 1.1][..], true),
            (&[1.0, 2.5], true),
            (&[1.0], false),
            (&[0.5, 1.5], false),
            (&[4.0], false),
            (&[], false),
        ] {
            assert_eq!(could_be_stretch_ratios(bare), expected, "{bare:?}");
        }
    }

    fn remedy(text: &str, dimension: Dimension) -> String {
        parse(text, dimension)
            .expect_err(text)
            .remedy(text, dimension)
    }

    #[test]
    fn every_wrong_text_is_told_what_to_write() {
        for (text, dimension, expected) in [
            (
                "15,0 cm",
                Dimension::Length,
                "write \"15.0 cm\", with a decimal point",
            ),
            ("-1,5 mm", Dimension::Length, "write \"-1.5 mm\""),
            (
                "1,050 mm",
                Dimension::Length,
                "write \"1.050 mm\" or \"1050 mm\"",
            ),
            (
                "1,050.5 mm",
                Dimension::Length,
                "write \"1050.5 mm\", without commas",
            ),
            ("0,5", Dimension::Ratio, "write \"0.5\""),
            ("12,5 %", Dimension::Ratio, "write \"12.5 %\""),
            (
                "3 inch",
                Dimension::Length,
                "did you mean `in`? Write \"3 in\"",
            ),
            ("3 Inches", Dimension::Length, "did you mean `in`?"),
            ("3 milimeter", Dimension::Length, "did you mean `mm`?"),
            ("3 CM", Dimension::Length, "did you mean `cm`?"),
            ("3 kpa", Dimension::Stress, "did you mean `kPa`?"),
            ("3 newton", Dimension::Force, "did you mean `N`?"),
            ("3 n/mm2", Dimension::Stress, "did you mean `N/mm^2`?"),
            ("1020 KG/m3", Dimension::Density, "did you mean `kg/m^3`?"),
            ("50 percent", Dimension::Ratio, "Write \"50 %\""),
            ("3 degrees", Dimension::Angle, "did you mean `deg`?"),
            (
                "15",
                Dimension::Length,
                "as in \"15 mm\"; known units: mm, cm",
            ),
            ("15 N", Dimension::Length, "write a length such as \"2 mm\""),
            ("wide", Dimension::Length, "write a length such as \"2 mm\""),
            ("3 furlong", Dimension::Length, "known units: mm, cm, m"),
            ("3 px", Dimension::Ratio, "known units: %, ‰, µε"),
        ] {
            let message = remedy(text, dimension);
            assert!(message.contains(expected), "{text}: {message}");
        }
    }

    #[test]
    fn every_spelling_leads_to_a_unit_of_the_table() {
        for (symbol, spellings) in SPELLINGS {
            let unit = UNITS.iter().find(|(known, ..)| known == symbol);
            let (_, dimension, _) = unit.unwrap_or_else(|| panic!("{symbol}"));
            for spelling in spellings.split('|') {
                assert_eq!(meant(spelling, *dimension), Some(*symbol), "{spelling}");
            }
        }
    }
}
