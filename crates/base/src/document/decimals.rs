//! Numbers with decimal points or with decimal commas, but not both in one file, and times of clocks.

/// The format of a file's numbers, as far as known.
#[derive(Default)]
pub(super) struct Decimals {
    point: bool,
    comma: bool,
    /// A comma that cannot group thousands.
    surely_decimal: bool,
    /// A whole number of three digits or more without a comma.
    ungrouped: bool,
}

impl Decimals {
    /// The number in a field.
    ///
    /// # Errors
    /// [`NotANumber`] with the reason.
    pub fn read(&mut self, field: &str) -> Result<f64, NotANumber> {
        let value = number(field).or_else(|| clock_time(field));
        let value = value.ok_or_else(|| match field {
            "" => NotANumber::Empty,
            _ => NotANumber::Text(field.to_owned()),
        })?;
        if !value.is_finite() {
            return Err(NotANumber::Infinite(field.to_owned()));
        }
        self.point |= field.contains('.');
        if let Some((complete, decimals)) = field.split_once(',') {
            let complete = complete.trim_start_matches(['+', '-']);
            self.comma = true;
            self.surely_decimal |=
                decimals.len() != 3 || complete.len() > 3 || complete.starts_with('0');
        } else {
            self.ungrouped |= value.abs() >= 100.0 && !is_clock_time(field);
        }
        if self.point && self.comma {
            Err(NotANumber::Mixed(field.to_owned()))
        } else {
            Ok(value)
        }
    }

    /// Whether commas may also be separators of thousands.
    pub fn are_ambiguous(&self) -> bool {
        self.comma && !self.surely_decimal && self.ungrouped
    }
}

/// Why a field is not a number.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum NotANumber {
    #[error("a field is empty")]
    Empty,
    #[error("\"{0}\" is not a number")]
    Text(String),
    #[error("{0} is not a finite number")]
    Infinite(String),
    #[error("\"{0}\": decimal points and decimal commas are mixed in this file")]
    Mixed(String),
}

/// A number with a decimal point or one decimal comma.
fn number(field: &str) -> Option<f64> {
    match field.matches(',').count() {
        0 => field.parse().ok(),
        1 if !field.contains('.') => field.replace(',', ".").parse().ok(),
        _ => None,
    }
}

/// A time as clocks show it, `01:02:03.5` or `01:02:03,5`, in s.
fn clock_time(field: &str) -> Option<f64> {
    let mut parts = field.split(':');
    let whole = |part: &str| part.parse::<u16>().ok().map(f64::from);
    let (hours, minutes) = (whole(parts.next()?)?, whole(parts.next()?)?);
    let seconds = parts.next().and_then(number)?;
    let is_time = minutes < 60.0 && (0.0..60.0).contains(&seconds) && parts.next().is_none();
    is_time.then_some(3600.0 * hours + 60.0 * minutes + seconds)
}

/// Whether a field that was read is the time of a clock.
pub(super) fn is_clock_time(field: &str) -> bool {
    field.contains(':')
}

/// Whether a field is a number.
pub(super) fn is_number(field: &str) -> bool {
    number(field).is_some()
}

/// Whether a field marks a missing number.
pub(super) fn is_hole(field: &str) -> bool {
    // The words of spreadsheets, R and pandas.
    const WORDS: [&str; 8] = ["nan", "na", "n/a", "#n/a", "#nv", "#div/0!", "null", "none"];
    let unsigned = field.trim_start_matches(['+', '-']);
    unsigned.is_empty() || WORDS.iter().any(|word| unsigned.eq_ignore_ascii_case(word))
}
