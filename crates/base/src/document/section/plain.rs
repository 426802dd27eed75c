//! Values of TOML as plain data.

use toml::de::DeValue;

use crate::units::{self, Dimension, QuantityFault, bare_ratio};

pub(super) fn text(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        _ => None,
    }
}

/// A value's quantity in the internal unit, or what is wrong and what to do.
pub(super) fn quantity(value: &DeValue<'_>, dimension: Dimension) -> Result<f64, (String, String)> {
    let (name, example) = (dimension.name(), dimension.example());
    let article = if name.starts_with(['a', 'e']) {
        "an"
    } else {
        "a"
    };
    match value {
        DeValue::String(text) => units::parse(text, dimension).map_err(|fault| {
            let hint = fault.remedy(text, dimension);
            (format!("\"{text}\" {fault}"), hint)
        }),
        other => match plain_number(other) {
            Some(number) if dimension == Dimension::Ratio => {
                dimension.admitted(number).ok_or_else(|| {
                    let fault = QuantityFault::OutOfRange(dimension);
                    (fault.to_string(), fault.remedy("", dimension))
                })
            }
            Some(number) => {
                let text = number.to_string();
                let hint = QuantityFault::MissingUnit.remedy(&text, dimension);
                Err((format!("{article} {name} needs a unit"), hint))
            }
            None => Err((
                format!("must be {article} {name}"),
                format!("such as {example}"),
            )),
        },
    }
}

/// A bare number, in quotes or not.
pub(super) fn bare(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::String(text) => bare_ratio(text),
        other => plain_number(other),
    }
}

/// A bare number or a list of them, in quotes or not.
pub(super) fn bare_numbers(value: &DeValue<'_>) -> Option<Vec<f64>> {
    match value {
        DeValue::Array(items) => items.iter().map(|item| bare(item.get_ref())).collect(),
        one => bare(one).map(|number| vec![number]),
    }
}

/// How to write a number that stands in quotes.
pub(super) fn unquoted(text: &str) -> String {
    let point = text.trim().replacen(',', ".", 1);
    match point.parse::<f64>() {
        Ok(_) => format!("write {point}, without quotes"),
        Err(_) => "write it without quotes and without a unit, such as 1e-8".to_owned(),
    }
}

/// A number without the noise of its last binary digits.
pub(super) fn rounded(number: f64) -> f64 {
    format!("{number:.9e}").parse().unwrap_or(number)
}

pub(super) fn plain_number(value: &DeValue<'_>) -> Option<f64> {
    let text = match value {
        DeValue::Float(number) => number.as_str(),
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        _ => return None,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

pub(super) fn count_pair(value: &DeValue<'_>, low: usize, high: usize) -> Option<[usize; 2]> {
    let DeValue::Array(items) = value else {
        return None;
    };
    let parsed = items.iter().map(|item| whole_number(item.get_ref()));
    let numbers: Vec<usize> = parsed.collect::<Option<_>>()?;
    let inside = numbers.iter().all(|n| (low..=high).contains(n));
    inside.then(|| numbers.try_into().ok()).flatten()
}

pub(super) fn whole_number(value: &DeValue<'_>) -> Option<usize> {
    match value {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str().parse().ok(),
        _ => None,
    }
}
