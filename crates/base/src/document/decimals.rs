//! Numbers with decimal points or with decimal commas, but not both in one file, and times of clocks.

/// The format of a file's numbers, as far as known.
#[derive(Default)]
pub(super) struct Decimals {
    point: bool,
    comma: bool,
    /// A point or comma that cannot group thousands, or a whole number of thousands without one.
    surely_decimal: bool,
    columns: Vec<Grouping>,
}

/// What the numbers of a column look like.
#[derive(Clone, Default)]
struct Grouping {
    /// A point or comma before three digits.
    grouped: bool,
    /// A whole number of three digits.
    hundreds: bool,
}

impl Decimals {
    /// The number in a field of a column.
    ///
    /// # Errors
    /// [`NotANumber`] with the reason.
    pub fn read(&mut self, column: usize, field: &str) -> Result<f64, NotANumber> {
        let value = number(field).or_else(|| clock_time(field));
        let value = value.ok_or_else(|| match field {
            "" => NotANumber::Empty,
            _ if groups_thousands(field) => NotANumber::Grouped(field.to_owned()),
            _ => NotANumber::Text(field.to_owned()),
        })?;
        if !value.is_finite() {
            return Err(NotANumber::Infinite(field.to_owned()));
        }
        self.point |= field.contains('.');
        self.comma |= field.contains(',');
        if !is_clock_time(field) {
            self.note_groups(column, field, value);
        }
        if self.point && self.comma {
            Err(NotANumber::Mixed(field.to_owned()))
        } else {
            Ok(value)
        }
    }

    fn note_groups(&mut self, column: usize, field: &str, value: f64) {
        if self.columns.len() <= column {
            self.columns.resize(column + 1, Grouping::default());
        }
        let groups = &mut self.columns[column];
        if let Some((complete, decimals)) = field.split_once(['.', ',']) {
            let complete = complete.trim_start_matches(['+', '-']);
            let decimal = decimals.len() != 3 || complete.len() > 3 || complete.starts_with('0');
            self.surely_decimal |= decimal || complete.is_empty();
            groups.grouped = true;
        } else {
            self.surely_decimal |= value.abs() >= 1000.0;
            groups.hundreds |= value.abs() >= 100.0;
        }
    }

    /// Whether points or commas may also be separators of thousands.
    pub fn are_ambiguous(&self) -> bool {
        let mut columns = self.columns.iter();
        !self.surely_decimal && columns.any(|column| column.grouped && column.hundreds)
    }
}

/// Whether a field is a number whose thousands are grouped: `1,008.4`, `1.008,4` or `1,008,400`.
fn groups_thousands(field: &str) -> bool {
    let field = field.trim_start_matches(['+', '-']);
    let parts: Vec<&str> = field.split(['.', ',']).collect();
    let [first, groups @ .., last] = &parts[..] else {
        return false;
    };
    let is_whole = !(field.contains('.') && field.contains(','));
    let are_digits = field
        .chars()
        .all(|letter| letter.is_ascii_digit() || ".,".contains(letter));
    are_digits
        && (1..=3).contains(&first.len())
        && !groups.is_empty()
        && groups.iter().all(|group| group.len() == 3)
        && (!is_whole || last.len() == 3)
}

/// Why a field is not a number.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum NotANumber {
    #[error("a field is empty")]
    Empty,
    #[error("\"{0}\" is not a number")]
    Text(String),
    #[error("\"{0}\" is not a number: save the table without separators of thousands")]
    Grouped(String),
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
    let integer = |part: &str| part.parse::<u16>().ok().map(f64::from);
    let (hours, minutes) = (integer(parts.next()?)?, integer(parts.next()?)?);
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
