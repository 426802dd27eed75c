//! Tables of numbers as laboratories write them: commas, semicolons or tabs, decimal points or commas, a
//! head of `# key: value` lines, names with units in brackets.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use crate::error::{Diagnostic, Error, Source};

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
    /// The rows; each with its place.
    pub rows: Vec<(Vec<f64>, Range<usize>)>,
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Input`] with file, line and reason.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let name = path.display().to_string();
        let refuse = |message: String, hint: &str| {
            Error::Input(vec![Diagnostic::error("", message).hint(hint)])
        };
        let bytes = std::fs::read(path).map_err(|cause| {
            refuse(
                format!("cannot read {name}: {cause}"),
                "a file of test data has columns of strain and stress",
            )
        })?;
        let text = String::from_utf8(bytes).map_err(|fault| {
            let line = 1 + fault.as_bytes()[..fault.utf8_error().valid_up_to()]
                .iter()
                .filter(|byte| **byte == b'\n')
                .count();
            refuse(
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
            head: head(text),
            columns: Vec::new(),
            columns_place: 0..0,
            rows: Vec::new(),
        };
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
            let start = record.position().map_or(0, |at| at.byte() as usize);
            let length = text[start..].find(['\n', '\r']);
            let place = start..length.map_or(text.len(), |length| start + length);
            if table.rows.is_empty() && record.iter().all(|field| number(field).is_none()) {
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
            let row: Result<Vec<f64>, String> =
                record.iter().map(|field| decimals.read(field)).collect();
            match row {
                Ok(row) => table.rows.push((row, place)),
                Err(reason) => {
                    let hint =
                        "every row holds finite numbers alone; units stand in the line of names";
                    return Err(refuse(place, &reason, hint));
                }
            }
        }
        if table.rows.is_empty() {
            let hint = "a table has a line of names with units and rows of numbers";
            return Err(refuse(0..0, "there are no rows of numbers", hint));
        }
        Ok(table)
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
        self.comma |= field.contains(',');
        if self.point && self.comma {
            return Err(format!(
                "\"{field}\": decimal points and decimal commas are mixed in this file"
            ));
        }
        Ok(value)
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

/// The separator of the first line that is no comment.
fn delimiter(text: &str) -> Option<u8> {
    let line = text
        .split(['\n', '\r'])
        .find(|line| !line.trim().is_empty() && !line.starts_with('#'))?;
    [b';', b'\t', b',']
        .into_iter()
        .find(|delimiter| line.as_bytes().contains(delimiter))
}

/// `key: value` pairs of the lines that begin with `#`, several of them separated by semicolons.
fn head(text: &str) -> BTreeMap<String, (String, Range<usize>)> {
    let mut head = BTreeMap::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let place = start..start + line.trim_end().len();
        start += line.len();
        let Some(comment) = line.strip_prefix('#') else {
            continue;
        };
        for part in comment.split("; ") {
            if let Some((key, value)) = part.split_once(": ") {
                let key = key.trim().to_lowercase().replace('_', " ");
                let value = value.trim().trim_end_matches(';').to_owned();
                head.entry(key).or_insert((value, place.clone()));
            }
        }
    }
    head
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
            ("a,b\n1,0\n2,NaN\n", "a.csv:3: NaN is not a finite number"),
            ("a,b\n1,0\n2,inf\n", "a.csv:3: inf is not a finite number"),
            ("a,b\n1,0\n2,x\n", "a.csv:3: \"x\" is not a number"),
            (
                "a,b\n1,0\n2,0.1 MPa\n",
                "a.csv:3: \"0.1 MPa\" is not a number",
            ),
            ("a,b\n1,0\n2,\n", "a.csv:3: a field is empty"),
            (
                "a,b\n1,5,0,2\n",
                "a.csv:2: 4 fields where there are 2 columns",
            ),
            ("a;b\n1,5;0,2\n1.5;0.3\n", "are mixed in this file"),
            ("a;b\n1.000,5;0,2\n", "is not a number"),
        ] {
            let found = refusal(text);
            assert!(found.contains(reason), "{text:?}: {found}");
        }
    }
}
