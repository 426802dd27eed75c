//! The columns of a table, and the lines above its rows that name them.

use super::decimals::is_number;
use super::lines::is_name;
use crate::units::{self, Dimension, QuantityFault};

/// A column's name and unit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// Its name in lower case, with underscores for spaces; empty where the file has no names of columns.
    pub name: String,
    /// The unit, in brackets or glued to the name, if there is one: the symbol of a known unit, any other text as it is written.
    pub unit: Option<String>,
    /// Its name as it is written, without the unit.
    pub written: String,
    /// What stands in brackets behind the name and is no unit, such as the number of the gauge, in the form of a name.
    remark: String,
    /// Name and unit as they are written.
    head: String,
}

impl Column {
    /// Name and unit of `nominal stress [MPa]`, `Load(Linear:Load) (kN)`, `Force_N`, `Position (z), mm` or `Kraft in N`: of several brackets
    /// the last one that is a unit, behind the name up to the first.
    pub(super) fn new(field: &str) -> Self {
        let field = unquoted(field);
        let bracketed = |split: Option<(&str, &str)>| {
            let (_, unit) = split?;
            Some(unit.trim_end_matches(CLOSING).to_owned())
        };
        let first = bracketed(field.split_once(BRACKETS));
        let last = bracketed(field.rsplit_once(BRACKETS)).filter(|unit| is_unit(unit));
        let behind = glued(field);
        let unit = match (&last, behind) {
            (Some(unit), _) => Some(spelled(unit)),
            (None, Some((_, unit))) => Some(spelled(unit)),
            (None, None) => first.as_deref().map(spelled),
        };
        let name = match (&last, behind) {
            (_, Some((name, _))) => name,
            (Some(_), None) => field.rsplit_once(BRACKETS).map_or(field, |(name, _)| name),
            (None, None) => field,
        };
        let (name, remark) = name.split_once(BRACKETS).unwrap_or((name, ""));
        Self {
            name: plain_name(name),
            unit,
            written: name.trim().to_owned(),
            remark: plain_name(remark.trim_end().trim_end_matches(CLOSING)),
            head: field.to_owned(),
        }
    }

    /// Gives it the unit of a line below the names: brackets behind its name that hold no unit belong to the name.
    pub(super) fn add_unit(&mut self, unit: &str) {
        if self
            .unit
            .as_deref()
            .is_some_and(|current| !is_unit(current))
            && is_unit(unit)
        {
            self.written.clone_from(&self.head);
            self.unit = None;
        }
        if self.unit.is_none() {
            self.head = format!("{} [{unit}]", self.head);
            self.unit = Some(spelled(unit));
        }
    }

    /// The factor from its unit to the internal one; a ratio needs no unit.
    ///
    /// # Errors
    /// [`QuantityFault`] where the unit is missing or none of the dimension.
    pub fn factor(&self, dimension: Dimension) -> Result<f64, QuantityFault> {
        match (self.unit.as_deref(), dimension) {
            (None, Dimension::Ratio) => Ok(1.0),
            (None, _) => Err(QuantityFault::MissingUnit),
            (Some(unit), _) => units::factor(unit, dimension),
        }
    }

    /// Name and unit as written.
    pub fn head(&self) -> String {
        self.head.clone()
    }

    /// Whether a name in upper or lower case is that of this column: a unit or a remark behind the name must be the column's, and may be left out.
    pub(super) fn answers_to(&self, wanted: &str) -> bool {
        let wanted = Self::new(wanted);
        let unit = wanted.unit.filter(|unit| is_unit(unit));
        self.name == wanted.name
            && (wanted.remark.is_empty() || wanted.remark == self.remark)
            && unit.is_none_or(|unit| self.unit.as_ref() == Some(&unit))
    }
}

/// What opens a unit, or a remark, behind a name.
const BRACKETS: [char; 4] = ['[', '(', '（', '［'];
/// What closes it.
const CLOSING: [char; 4] = [']', ')', '）', '］'];

/// The symbol of a unit, however it is spelled; any other text as it is.
fn spelled(unit: &str) -> String {
    units::symbol(unit).unwrap_or(unit.trim()).to_owned()
}

/// Name and unit of a head without brackets, where its end is the unit of a length, force, stress, time or ratio: `XForce_mN`, `Stress.MPa`,
/// `Time, s`, `Weg in mm`. Ends that may be words or indices (`in`, `min`, `_m`) are units behind a slash or ` in ` alone.
fn glued(field: &str) -> Option<(&str, &str)> {
    const WORDS: [&str; 5] = ["in", "m", "min", "h", "ft"];
    let trimmed = field.trim_end_matches('.');
    let ((name, unit), is_stated) = match (trimmed.rsplit_once(" in "), trimmed.rsplit_once('/')) {
        (Some(parts), _) | (None, Some(parts)) if is_symbol(parts.1) => (parts, true),
        _ => (trimmed.rsplit_once(['_', ' ', '.', ','])?, false),
    };
    let known = is_symbol(unit) && (is_stated || !WORDS.contains(&unit.trim()));
    let name = name.trim_end_matches(['.', ',', ' ', '_']);
    (known && !name.is_empty()).then_some((name, unit))
}

/// Whether the end of a head is a unit of what tests measure: one letter alone must be its symbol, or that of seconds.
fn is_symbol(unit: &str) -> bool {
    const MEASURED: [Dimension; 5] = [
        Dimension::Length,
        Dimension::Force,
        Dimension::Stress,
        Dimension::Time,
        Dimension::Ratio,
    ];
    let unit = unit.trim();
    let Some(symbol) = units::symbol(unit) else {
        return false;
    };
    let is_exact = symbol == unit || unit == "S" || unit.chars().count() > 1;
    is_exact && MEASURED.iter().any(|of| units::factor(symbol, *of).is_ok())
}

/// A name in the form of columns: in lower case, with underscores for spaces.
pub fn plain_name(name: &str) -> String {
    name.trim().to_lowercase().replace([' ', '-'], "_")
}

/// Whether a unit is the pixel.
pub fn is_pixel(unit: &str) -> bool {
    ["px", "pixel", "pixels"].contains(&&*unit.to_lowercase())
}

/// A field without the quotation marks that follow a space.
pub(super) fn unquoted(field: &str) -> &str {
    field.trim().trim_matches('"').trim()
}

/// The lines above the rows, by their places among the lines that are not empty.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Above {
    /// The line that names the columns.
    pub names: Option<usize>,
    /// The line with their units.
    pub units: Option<usize>,
    /// The first row.
    pub first_row: usize,
}

impl Above {
    /// Finds the lines above the rows among the first lines of a file, split into fields.
    ///
    /// There are as many names as fields in most lines. The lines of this width right above the first row of numbers are names and, below
    /// them, units; titles over groups of columns, with empty or repeated fields, and all lines before them are a preamble.
    pub fn of(lines: &[Vec<String>]) -> Self {
        let width = most_frequent(lines.iter().map(Vec::len));
        let is_head = |line: &Vec<String>| line.iter().all(|field| is_name(unquoted(field)));
        let of_width = |line: &Vec<String>| Some(line.len()) == width;
        let leading = lines.iter().take_while(|line| is_head(line)).count();
        let row_of_numbers = lines.iter().position(|line| of_width(line) && is_row(line));
        let first_row = row_of_numbers.unwrap_or(leading);
        let above = lines[..first_row].iter().rev();
        let heads = above.take_while(|line| of_width(line) && (is_head(line) || is_units(line)));
        let count = heads.count();
        if count == 0 {
            // Names of another width, such as those above rows that end with a separator.
            return Self {
                names: (leading > 0).then_some(0),
                units: (leading > 1).then_some(1),
                first_row: leading,
            };
        }
        let first = first_row - count;
        let heads = &lines[first..first_row];
        let last_is_units = heads.len() > 1 && heads.last().is_some_and(|line| is_units(line));
        let named = heads.len() - usize::from(last_is_units);
        let titles = heads[..named]
            .iter()
            .take_while(|line| is_title(line))
            .count();
        let names = first + titles.min(named.saturating_sub(1));
        let has_units = last_is_units || names + 1 < first_row;
        Self {
            names: (named > 0).then_some(names),
            units: (named > 0 && has_units).then_some(names + 1),
            first_row,
        }
    }
}

/// Whether a line is a row of numbers, which may have texts too: two of its fields are numbers, or one is and all others are empty; and
/// it is no line of units.
fn is_row(line: &[String]) -> bool {
    let fields = || line.iter().map(|field| unquoted(field));
    let numbers = fields().filter(|field| is_number(field)).count();
    let others_are_empty = fields().filter(|field| field.is_empty()).count() + 1 == line.len();
    (numbers >= 2 || numbers == 1 && others_are_empty) && !is_units(line)
}

/// The most frequent value, the first of those that are equally frequent.
fn most_frequent(values: impl Iterator<Item = usize>) -> Option<usize> {
    let mut counted: Vec<(usize, usize)> = Vec::new();
    for value in values {
        match counted.iter_mut().find(|(known, _)| *known == value) {
            Some((_, count)) => *count += 1,
            None => counted.push((value, 1)),
        }
    }
    let most = counted.iter().map(|(_, count)| *count).max()?;
    let first = counted.into_iter().find(|(_, count)| *count == most);
    first.map(|(value, _)| value)
}

/// Whether a line is a title over groups of columns: fields are empty or repeated, and they are not units.
fn is_title(line: &[String]) -> bool {
    let fields: Vec<&str> = line.iter().map(|field| unquoted(field)).collect();
    let repeats = |(index, field): (usize, &&str)| fields[..index].contains(field);
    let repeated = fields.iter().enumerate().any(repeats);
    repeated && !fields.iter().all(|field| is_unit(field))
}

/// Whether a field may stand in a line of units.
fn is_unit(field: &str) -> bool {
    let plain = field.trim_matches(['(', ')', '[', ']', ' ']);
    let bracketed = plain.len() < field.len();
    let is_known = || units::symbol(plain).is_some() || units::is_known(plain);
    bracketed || ["", "-", "1", "mm/mm"].contains(&plain) || is_pixel(plain) || is_known()
}

/// Whether a line contains units, some of which are 1, so that it may look like a row.
fn is_units(line: &[String]) -> bool {
    let fields: Vec<&str> = line.iter().map(|field| unquoted(field)).collect();
    let named = fields
        .iter()
        .any(|field| is_name(field) && !field.is_empty());
    named && fields.iter().all(|field| is_unit(field))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn above(text: &str) -> Above {
        let split = |line: &str| line.split(';').map(str::to_owned).collect();
        Above::of(&text.lines().map(split).collect::<Vec<_>>())
    }

    fn expected(names: usize, units: Option<usize>, first_row: usize) -> Above {
        Above {
            names: Some(names),
            units,
            first_row,
        }
    }

    #[test]
    fn names_units_titles_and_preambles_are_told_apart() {
        for (text, actual) in [
            ("x;y;u\n1;2;3\n4;5;6", expected(0, None, 1)),
            ("x;y;u\nmm;mm;mm\n1;2;3\n4;5;6", expected(0, Some(1), 2)),
            ("x;y;e\nmm;mm;1\n1;2;3\n4;5;6", expected(0, Some(1), 2)),
            ("Project 7\nx;y;u\n1;2;3\n4;5;6", expected(1, None, 2)),
            (
                "Date;4.5.2024\nStage\nx;y;u\n[mm];[mm];\n1;2;3\n4;5;6",
                expected(2, Some(3), 4),
            ),
            ("L0;L0;L0\nx;y;u\n1;2;3\n4;5;6", expected(1, None, 2)),
            (
                "Sample A;;\n1 _ 1;;\nTime;Force;Stroke\nsec;N;mm\n1;2;3\n4;5;6",
                expected(2, Some(3), 4),
            ),
            (
                "ISO;37a\nProbe;1\nWeg;Kraft\nmm;N\n1;2\n3;4",
                expected(2, Some(3), 4),
            ),
            (
                "L0;;\nx;y;u\nmm;mm;px\n1;2;3\n4;5;6",
                expected(1, Some(2), 3),
            ),
        ] {
            assert_eq!(above(text), actual, "{text}");
        }
        // A line of names among rows is a fault of the row that it is.
        assert_eq!(above("1;2\n3;4\nx;y").names, None);
    }

    #[test]
    fn names_are_plain_and_as_written() {
        let column = Column::new(" \"disp.Horizontal Displacement U [mm]\"");
        assert_eq!(column.name, "disp.horizontal_displacement_u");
        assert_eq!(column.written, "disp.Horizontal Displacement U");
        assert_eq!(column.unit.as_deref(), Some("mm"));
        assert_eq!(Column::new("位移（mm）").unit.as_deref(), Some("mm"));
    }

    #[test]
    fn units_may_be_glued_to_names() {
        for (head, name, unit) in [
            ("stress_MPa", "stress", Some("MPa")),
            ("Force/N", "force", Some("N")),
            ("XForce_mN", "xforce", Some("mN")),
            ("Time_S", "time", Some("s")),
            ("Displacement_um", "displacement", Some("um")),
            ("Stress..MPa.", "stress", Some("MPa")),
            ("Time, s", "time", Some("s")),
            ("Kraft in N", "kraft", Some("N")),
            ("Force kN", "force", Some("kN")),
            ("Stress (KPa)", "stress", Some("kPa")),
            ("Load(Linear:Load) (kN)", "load", Some("kN")),
            ("Position (z), mm", "position", Some("mm")),
            ("Strain (Strain 1) [%]", "strain", Some("%")),
            ("strain_%", "strain", Some("%")),
            ("Strain (\u{3bc}ε)", "strain", Some("µε")),
            ("Strain [microstrain]", "strain", Some("µε")),
            ("Length/m", "length", Some("m")),
            ("strain_min", "strain_min", None),
            ("pressure_in", "pressure_in", None),
            ("P1", "p1", None),
            ("u_m", "u_m", None),
            ("stress_n", "stress_n", None),
            ("Load cell", "load_cell", None),
            ("m", "m", None),
        ] {
            let column = Column::new(head);
            assert_eq!(
                (&*column.name, column.unit.as_deref()),
                (name, unit),
                "{head}"
            );
            assert_eq!(column.head(), head);
        }
    }
}
