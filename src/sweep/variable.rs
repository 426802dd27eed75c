//! What is varied, and by which values.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};

use gelbench_base::error::Diagnostic;
use gelbench_base::units::number_length;

/// More runs are refused.
pub const MOST_RUNS: usize = 1_000_000;

/// What a key is set to.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum Setting {
    /// A whole number.
    Integer(i64),
    /// A number with its unit, which may be empty.
    Number(f64, String),
    /// Any other text.
    Text(String),
}

/// The values of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Each of these.
    Listed(Vec<Setting>),
    /// Evenly between two ends, in a unit.
    Between([f64; 2], String),
    /// Normal, with mean and standard deviation in a unit.
    Normal([f64; 2], String),
}

/// A key with its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// The key, its parts with dots between them: `material.c10`, `load.stretches.0`.
    pub key: String,
    /// Its values.
    pub values: Values,
}

const HINT: &str = "write KEY=LOW..HIGH:COUNT for a grid, KEY=A,B,C for some values, KEY=LOW..HIGH or KEY=MEAN+-DEVIATION for a \
                    distribution, such as \"material.c10=0.04..0.06 MPa:20\"";

impl Setting {
    /// Of a text: a whole number, a number with or without a unit, or anything else.
    pub fn of(text: &str) -> Self {
        let text = text.trim();
        let unquoted = text.trim_matches('"');
        if unquoted.len() < text.len() {
            return Self::Text(unquoted.to_owned());
        }
        match (text.parse::<i64>(), number(text)) {
            (Ok(integer), _) => Self::Integer(integer),
            (_, Some((value, unit))) => Self::Number(value, unit.to_owned()),
            _ => Self::Text(text.to_owned()),
        }
    }

    /// The number, where it is one.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Integer(integer) => Some(*integer as f64),
            Self::Number(value, _) => Some(*value),
            Self::Text(_) => None,
        }
    }

    /// The unit of a number.
    pub fn unit(&self) -> &str {
        match self {
            Self::Number(_, unit) => unit,
            _ => "",
        }
    }

    /// The value without its unit.
    pub fn plain_text(&self) -> String {
        match self {
            Self::Integer(integer) => integer.to_string(),
            Self::Number(value, _) => value.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

impl Variable {
    /// Of a text such as `material.c10=0.04..0.06 MPa:20`.
    ///
    /// # Errors
    /// What is wrong with it, and the remedy.
    pub fn parse(text: &str) -> Result<Self, Diagnostic> {
        let wrong = |what: String| Diagnostic::error("", format!("`{text}`: {what}")).hint(HINT);
        let (key, values) = text
            .split_once('=')
            .ok_or_else(|| wrong("there is no `=`".to_owned()))?;
        Self::of(key, Values::parse(values.trim())).map_err(wrong)
    }

    /// Of a key and texts of its values, each such as `5 mm` or `pva-10`.
    ///
    /// # Errors
    /// What is wrong with them, and the remedy.
    pub fn listed(key: &str, values: &[String]) -> Result<Self, Diagnostic> {
        let values = Values::listed(values.iter().map(String::as_str));
        Self::of(key, values).map_err(|what| Diagnostic::error(key, what).hint(HINT))
    }

    fn of(key: &str, values: Result<Values, String>) -> Result<Self, String> {
        let key = key.trim();
        if key.is_empty() || key.split('.').any(str::is_empty) {
            return Err("the key is incomplete".to_owned());
        }
        Ok(Self {
            key: key.to_owned(),
            values: values?,
        })
    }
}

impl Values {
    fn parse(text: &str) -> Result<Self, String> {
        // `..` in a path is no range.
        let range = text
            .split_once("..")
            .filter(|(low, _)| !low.is_empty() && !low.contains(['/', '\\', '"']));
        if let Some((low, rest)) = range {
            let (high, count) = match rest.rsplit_once(':') {
                Some((high, count)) => (high, Some(count)),
                None => (rest, None),
            };
            let (ends, unit) = pair(low, high)?;
            if ends[0] >= ends[1] {
                return Err(format!("{} is not below {}", ends[0], ends[1]));
            }
            return match count {
                Some(count) => grid(ends, &unit, count),
                None => Ok(Self::Between(ends, unit)),
            };
        }
        if let Some((mean, deviation)) = text.split_once("+-").or_else(|| text.split_once('±')) {
            let (normal, unit) = pair(mean, deviation)?;
            return if normal[1] > 0.0 {
                Ok(Self::Normal(normal, unit))
            } else {
                Err("the standard deviation has to be positive".to_owned())
            };
        }
        if let Some(range) = misspelt_range(text) {
            return Err(format!(
                "a range is written `{range}`, or `{range}:3` for three values"
            ));
        }
        Self::listed(text.split(','))
    }

    fn listed<'a>(texts: impl Iterator<Item = &'a str>) -> Result<Self, String> {
        let mut listed: Vec<Setting> = texts.map(Setting::of).collect();
        let Some(last) = listed.last() else {
            return Err("there are no values".to_owned());
        };
        let unit = last.unit().to_owned();
        if listed
            .iter()
            .any(|one| *one == Setting::Text(String::new()))
        {
            return Err("a value is empty".to_owned());
        }
        // A unit behind the last number is that of all.
        for one in &mut listed {
            if let (Some(value), "") = (one.value(), one.unit())
                && !unit.is_empty()
            {
                *one = Setting::Number(value, unit.clone());
            }
        }
        if listed.iter().any(|one| one.unit() != unit) {
            return Err("the values have several units".to_owned());
        }
        let mut seen = HashSet::new();
        match listed.iter().find(|one| !seen.insert(one.plain_text())) {
            Some(again) => Err(format!("the value {} occurs twice", again.plain_text())),
            None => Ok(Self::Listed(listed)),
        }
    }
}

/// A key with a unit, which may be empty, as the head of a column.
pub fn headed(key: &str, unit: &str) -> String {
    match unit {
        "" => key.to_owned(),
        unit => format!("{key} [{unit}]"),
    }
}

/// The key and the unit of such a head.
pub fn key_and_unit(head: &str) -> (&str, &str) {
    let within = head.strip_suffix(']');
    within
        .and_then(|head| head.rsplit_once(" ["))
        .unwrap_or((head, ""))
}

/// Two numbers with one unit, which the first may omit.
fn pair(first: &str, second: &str) -> Result<([f64; 2], String), String> {
    let read = |text: &str| {
        let read_number = number(text.trim()).map(|(value, unit)| (value, unit.to_owned()));
        read_number.ok_or_else(|| format!("`{}` is not a number", text.trim()))
    };
    let ((a, before), (b, unit)) = (read(first)?, read(second)?);
    if before.is_empty() || before == unit {
        Ok(([a, b], unit))
    } else {
        Err(format!("`{before}` and `{unit}` are two units"))
    }
}

fn grid([low, high]: [f64; 2], unit: &str, count: &str) -> Result<Values, String> {
    let count: usize = count
        .trim()
        .parse()
        .ok()
        .filter(|count| (2..=100_000).contains(count))
        .ok_or_else(|| format!("`{count}` is not a number of values from 2 to 100,000"))?;
    let last = (count - 1) as f64;
    let value = |index: usize| {
        let share = index as f64 / last;
        let exact = low * (1.0 - share) + high * share;
        // Without the noise of the last binary digits: 0.39 for 0.38999999999999996.
        let value: f64 = format!("{exact:.14e}").parse().unwrap_or(exact);
        match unit {
            // Numbers of cells have to be whole ones.
            "" => Setting::of(&value.to_string()),
            unit => Setting::Number(value, unit.to_owned()),
        }
    };
    Ok(Values::Listed((0..count).map(value).collect()))
}

/// The correct spelling of the range in `1-3 mm`, `1 – 3 mm` or `1 to 3 mm`.
fn misspelt_range(text: &str) -> Option<String> {
    let (low, rest) = number(text)?;
    let high = ["-", "–", "—", "to "]
        .iter()
        .find_map(|dash| rest.strip_prefix(dash))?;
    let (high, unit) = number(high.trim())?;
    Some(format!("{low}..{high} {unit}").trim_end().to_owned())
}

/// A finite number and the text after it.
fn number(text: &str) -> Option<(f64, &str)> {
    let (digits, unit) = text.split_at(number_length(text));
    let value: f64 = digits.parse().ok()?;
    value.is_finite().then_some((value, unit.trim()))
}
