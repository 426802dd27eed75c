//! Numbers with decimal points or with decimal commas, but not both in one file.

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
        let value = number(field).ok_or_else(|| match field {
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
            self.ungrouped |= value.abs() >= 100.0;
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
