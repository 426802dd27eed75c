//! Tables of numbers as laboratories write them: commas, semicolons or tabs, decimal points or commas, a
//! head of `# key: value` lines, names with units in brackets.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use crate::error::{Diagnostic, Error, Source};

/// What a file or the command line must say about a table.
pub const KEYS: [&str; 9] = [
    "test",
    "stress measure",
    "strain measure",
    "stress unit",
    "strain unit",
    "direction",
    "strain ratio",
    "area",
    "length",
];

/// A column's name and unit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// Its name in lower case, with underscores for spaces; empty where the file names no columns.
    pub name: String,
    /// The unit in brackets, if there is one.
    pub unit: Option<String>,
}

/// A table as it stands in a file.
#[derive(Debug)]
pub struct Table {
    /// The file, for messages.
    pub source: Arc<Source>,
    /// The `key: value` pairs of the head, keys in lower case, with their places.
    pub head: BTreeMap<String, (String, Range<usize>)>,
    /// The columns.
    pub columns: Vec<Column>,
    /// The place of the line that names the columns.
    pub columns_place: Range<usize>,
    /// The rows; each with its place. What is no number is none here, and told by [`Self::fault`].
    pub rows: Vec<(Vec<f64>, Range<usize>)>,
    /// The first field of each column that is no number: its row and what is wrong.
    faults: Vec<Option<(usize, String)>>,
    /// The same without fields that say that there is no number: empty ones and NaN.
    nonsense: Vec<Option<(usize, String)>>,
    /// Keys of the head that are said twice in different ways, with their places.
    pub contradictions: Vec<(String, Range<usize>)>,
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path).map_err(|cause| {
            Error::input(
                format!("cannot read {name}: {cause}"),
                "a file of test data has columns of strain and stress",
            )
        })?;
        let text = String::from_utf8(bytes).map_err(|fault| {
            let line = 1 + fault.as_bytes()[..fault.utf8_error().valid_up_to()]
                .iter()
                .filter(|byte| **byte == b'\n')
                .count();
            Error::input(
                format!("{name}: line {line} is not UTF-8 text"),
                "save the table as CSV in UTF-8",
            )
        })?;
        Self::parse(&name, &text)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// [`Error::Input`] with the place and the reason.
    pub fn parse(name: &str, text: &str) -> Result<Self, Error> {
        let text = text.trim_start_matches('\u{feff}');
        // Old line ends.
        let text = &match text.contains('\n') {
            true => text.to_owned(),
            false => text.replace('\r', "\n"),
        };
        let source = Arc::new(Source {
            name: name.to_owned(),
            text: text.to_owned(),
        });
        let refuse = |place: Range<usize>, message: &str, hint: &str| {
            let fault = Diagnostic::error("", message).hint(hint);
            Error::Input(vec![fault.at(&source, place)])
        };
        let Some(delimiter) = delimiter(text) else {
            return Err(refuse(
                0..0,
                "there are no columns in this file",
                "a table has at least two columns, separated by commas, semicolons or tabs",
            ));
        };
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let mut table = Self {
            source: Arc::clone(&source),
            head: BTreeMap::new(),
            columns: Vec::new(),
            columns_place: 0..0,
            rows: Vec::new(),
            faults: Vec::new(),
            nonsense: Vec::new(),
            contradictions: Vec::new(),
        };
        table.read_head(text);
        let mut decimals = Decimals::default();
        let mut record = csv::StringRecord::new();
        loop {
            match reader.read_record(&mut record) {
                Ok(true) => {}
                Ok(false) => break,
                Err(cause) => return Err(refuse(0..0, &cause.to_string(), "mend this line")),
            }
            if record.iter().all(str::is_empty) {
                continue;
            }
            let place = line_at(text, record.position().map_or(0, |at| at.byte() as usize));
            if table.rows.is_empty() && record.iter().all(is_name) {
                table.name_columns(&record, place);
                continue;
            }
            if table.columns.is_empty() {
                table.columns = vec![Column::default(); record.len()];
            }
            if record.len() != table.columns.len() {
                let message = format!(
                    "{} fields where there are {} columns",
                    record.len(),
                    table.columns.len()
                );
                let hint =
                    "numbers with decimal commas need semicolons or tabs between the columns";
                return Err(refuse(place, &message, hint));
            }
            table.faults.resize(record.len(), None);
            table.nonsense.resize(record.len(), None);
            let row = record.iter().enumerate().map(|(column, field)| {
                decimals.read(field).unwrap_or_else(|reason| {
                    let fault = (table.rows.len(), reason);
                    if !is_hole(field) {
                        table.nonsense[column].get_or_insert(fault.clone());
                    }
                    table.faults[column].get_or_insert(fault);
                    f64::NAN
                })
            });
            let row = row.collect();
            table.rows.push((row, place));
        }
        if decimals.ambiguous() {
            let hint = "write 1050 or 1.050 instead of 1,050, whichever is meant";
            let message = "commas may be decimal commas or group thousands in this file";
            return Err(refuse(0..0, message, hint));
        }
        if table.rows.is_empty() {
            let hint = "a table has a line of names with units and rows of numbers";
            return Err(refuse(0..0, "there are no rows of numbers", hint));
        }
        Ok(table)
    }

    /// What is wrong with the first field of a column that is no number, and where.
    pub fn fault(&self, column: usize) -> Option<(&str, Range<usize>)> {
        let (row, reason) = self.faults.get(column)?.as_ref()?;
        Some((reason, self.rows[*row].1.clone()))
    }

    /// What is wrong with the first field of a column that is neither a number nor a hole in the data (empty, NaN),
    /// and where.
    pub fn nonsense(&self, column: usize) -> Option<(&str, Range<usize>)> {
        let (row, reason) = self.nonsense.get(column)?.as_ref()?;
        Some((reason, self.rows[*row].1.clone()))
    }

    /// Reads the lines that begin with `#`: `key: value`, several of the known [`KEYS`] separated by semicolons.
    fn read_head(&mut self, text: &str) {
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let place = start..start + line.trim_end().len();
            start += line.len();
            let Some(comment) = line.strip_prefix('#') else {
                continue;
            };
            let first = comment.split(':').next().unwrap_or_default();
            let known = |key: &str| KEYS.contains(&&*plain_key(key));
            let parts = if known(first) {
                comment.split(';').collect()
            } else {
                vec![comment]
            };
            for (key, value) in parts.iter().filter_map(|part| part.split_once(':')) {
                let value = value.trim().to_owned();
                let key = plain_key(key);
                match self.head.get(&key) {
                    Some((said, _)) if known(&key) && *said != value => {
                        self.contradictions.push((key, place.clone()));
                    }
                    Some(_) => {}
                    None => {
                        self.head.insert(key, (value, place.clone()));
                    }
                }
            }
        }
    }

    /// The first line of names names the columns, a second one may hold their units.
    fn name_columns(&mut self, record: &csv::StringRecord, place: Range<usize>) {
        if self.columns.is_empty() {
            self.columns = record.iter().map(column).collect();
            self.columns_place = place;
        } else {
            for (column, field) in self.columns.iter_mut().zip(record) {
                let unit = field.trim_matches(['(', ')', '[', ']', ' ']);
                if column.unit.is_none() && !unit.is_empty() {
                    column.unit = Some(unit.to_owned());
                }
            }
        }
    }
}

/// Numbers with decimal points or with decimal commas, but not both in one file.
#[derive(Default)]
struct Decimals {
    point: bool,
    comma: bool,
    /// A comma that cannot group thousands.
    surely_decimal: bool,
    /// A whole number of three digits or more without a comma.
    ungrouped: bool,
}

impl Decimals {
    fn read(&mut self, field: &str) -> Result<f64, String> {
        let value = number(field).ok_or_else(|| match field {
            "" => "a field is empty".to_owned(),
            _ => format!("\"{field}\" is not a number"),
        })?;
        if !value.is_finite() {
            return Err(format!("{field} is not a finite number"));
        }
        self.point |= field.contains('.');
        if let Some((whole, decimals)) = field.split_once(',') {
            let whole = whole.trim_start_matches(['+', '-']);
            self.comma = true;
            self.surely_decimal |= decimals.len() != 3 || whole.len() > 3 || whole.starts_with('0');
        } else {
            self.ungrouped |= value.abs() >= 100.0;
        }
        if self.point && self.comma {
            return Err(format!(
                "\"{field}\": decimal points and decimal commas are mixed in this file"
            ));
        }
        Ok(value)
    }
}

impl Decimals {
    /// Whether commas may just as well group thousands.
    fn ambiguous(&self) -> bool {
        self.comma && !self.surely_decimal && self.ungrouped
    }
}

/// A number with a decimal point or one decimal comma.
fn number(field: &str) -> Option<f64> {
    match field.matches(',').count() {
        0 => field.parse().ok(),
        1 if !field.contains('.') => field.replace(',', ".").parse().ok(),
        _ => None,
    }
}

/// Whether a field says that there is no number.
fn is_hole(field: &str) -> bool {
    field.is_empty()
        || field
            .trim_start_matches(['+', '-'])
            .eq_ignore_ascii_case("nan")
}

/// The separator of the first line that is no comment.
fn delimiter(text: &str) -> Option<u8> {
    let line = text
        .split(['\n', '\r'])
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))?;
    [b';', b'\t', b',']
        .into_iter()
        .find(|delimiter| line.as_bytes().contains(delimiter))
}

/// A key of the head in lower case with spaces.
fn plain_key(key: &str) -> String {
    key.trim().to_lowercase().replace('_', " ")
}

/// The line of a record: csv points to what stands before it, remarks and empty lines too.
fn line_at(text: &str, from: usize) -> Range<usize> {
    let mut start = from;
    for line in text[from..].split_inclusive('\n') {
        if !line.trim().is_empty() && !line.starts_with('#') {
            return start..start + line.trim_end().len();
        }
        start += line.len();
    }
    from..from
}

/// Whether a field is a name or a unit: it does not begin as a number does.
fn is_name(field: &str) -> bool {
    let digits = field.trim_start_matches(['+', '-', '.', ',']);
    number(field).is_none() && !digits.starts_with(|first: char| first.is_ascii_digit())
}

/// Name and unit of `nominal stress [MPa]` or `Stress (kPa)`.
fn column(field: &str) -> Column {
    let (name, unit) = match field.find(['[', '(']) {
        Some(at) => (
            &field[..at],
            Some(field[at + 1..].trim_end_matches([']', ')'])),
        ),
        None => (field, None),
    };
    let name = name.trim().to_lowercase().replace([' ', '-'], "_");
    Column {
        name,
        unit: unit.map(|unit| unit.trim().to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<Vec<f64>> {
        let table = Table::parse("a.csv", text).unwrap();
        table.rows.into_iter().map(|(row, _)| row).collect()
    }

    fn refusal(text: &str) -> String {
        Table::parse("a.csv", text).unwrap_err().to_string()
    }

    #[test]
    fn the_usual_ways_of_writing_a_table_are_read_alike() {
        let expected = vec![vec![1.0, 0.0], vec![1.5, -0.25]];
        for text in [
            "stretch [-],stress [MPa]\n1,0\n1.5,-0.25\n",
            "\u{feff}stretch [-],stress [MPa]\r\n1.0,0.0\r\n1.5,-2.5e-1\r\n",
            "stretch [-];stress [MPa]\n1,0;0,0\n1,5;-0,25\n",
            "stretch [-]\tstress [MPa]\n1\t0\n\n1,5\t-0,25",
            "\"Stretch\",\"Stress\"\n\"(-)\",\"(MPa)\"\n\"1\",\"0\"\n\"1.5\",\"-0.25\"\n",
            "# test: uniaxial\n1, 0\n# a remark\n1.5, -0.25\n",
        ] {
            assert_eq!(rows(text), expected, "{text:?}");
        }
    }

    #[test]
    fn names_units_and_head_are_found() {
        let text =
            "# test: uniaxial; direction: 2\n# A remark.\nNominal Stress (kPa),stretch\n1,2\n";
        let table = Table::parse("a.csv", text).unwrap();
        assert_eq!(table.columns[0].name, "nominal_stress");
        assert_eq!(table.columns[0].unit.as_deref(), Some("kPa"));
        assert_eq!(table.columns[1].unit, None);
        assert_eq!(table.head["test"].0, "uniaxial");
        assert_eq!(table.head["direction"].0, "2");
    }

    #[test]
    fn bad_tables_are_refused_with_line_and_reason() {
        for (text, reason) in [
            ("", "no columns"),
            ("# only a head\n", "no columns"),
            ("a,b\n", "no rows"),
            (
                "a,b\n1,5,0,2\n",
                "a.csv:2: 4 fields where there are 2 columns",
            ),
            ("a\tb\n1,050\t2\n950\t3\n", "group thousands"),
        ] {
            let found = refusal(text);
            assert!(found.contains(reason), "{text:?}: {found}");
        }
    }

    #[test]
    fn fields_that_are_no_numbers_are_told_by_their_column() {
        for (text, line, reason) in [
            (
                "a,b\n1,0\n# pause\n\n2,NaN\n",
                5,
                "NaN is not a finite number",
            ),
            ("a,b\n1,0\n2,inf\n", 3, "inf is not a finite number"),
            ("a,b\n1,0\n2,x\n", 3, "\"x\" is not a number"),
            ("a,b\n1,0\n2,0.1 MPa\n", 3, "\"0.1 MPa\" is not a number"),
            ("a,b\n1,0\n2,\n", 3, "a field is empty"),
            ("a;b\n1,5;0,2\n1,6;0.3\n", 3, "are mixed in this file"),
            ("a;b\n1,0;1.000,5\n", 2, "is not a number"),
        ] {
            let table = Table::parse("a.csv", text).unwrap();
            let (found, place) = table.fault(1).unwrap();
            assert!(found.contains(reason), "{text:?}: {found}");
            assert_eq!(table.source.line(place.start), line, "{text:?}");
            assert_eq!(table.fault(0), None, "{text:?}");
        }
    }

    #[test]
    fn remarks_old_line_ends_and_citations_are_read() {
        let text =
            "#test:uniaxial\r# source: Smith A 2001; Jones B: Aorta tests\ra [-],b [MPa]\r1,2\r";
        let table = Table::parse("a.csv", text).unwrap();
        assert_eq!(table.head["test"].0, "uniaxial");
        assert_eq!(table.head["source"].0, "Smith A 2001; Jones B: Aorta tests");
        assert_eq!(table.rows.len(), 1);
        let twice = Table::parse("a.csv", "# test: planar\n# test: uniaxial\na,b\n1,2\n").unwrap();
        assert_eq!(twice.contradictions[0].0, "test");
    }
}
