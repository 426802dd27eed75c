//! Sheets of a workbook (Office Open XML, `.xlsx`) as texts of tables: the values that its cells showed when it was saved.
//!
//! Each row of a sheet is a line, so that messages name the rows that the user sees. Errors of formulas are missing
//! numbers; dates and times of day are no numbers.
//!
//! # References
//! ECMA-376, part 1, § 18.3 (worksheets), § 18.4 (shared strings), § 18.8 (styles).

use super::archive::Archive;
use super::converted::{TableText, Unconvertible};
use crate::error::suggestion;

mod cells;
mod workbook;
mod xml;

use workbook::{NamedSheet, Workbook};

/// The sheets in their order, or the one with a name.
///
/// # Errors
/// [`Unconvertible`] where there is no sheet of this name, or a part is damaged or too large.
pub(super) fn tables(
    mut archive: Archive,
    part: Option<&str>,
) -> Result<Vec<TableText>, Unconvertible> {
    let workbook = Workbook::read(&mut archive)?;
    let wanted: Vec<&NamedSheet> = match part {
        None => workbook.sheets.iter().collect(),
        Some(name) => vec![named(&workbook, name)?],
    };
    let texts = wanted.into_iter().map(|sheet| {
        let xml = xml::text(archive.read(&sheet.path)?)?;
        Ok(TableText {
            name: Some(sheet.name.clone()),
            text: cells::text(&xml, &workbook)?,
        })
    });
    texts.collect()
}

fn named<'a>(workbook: &'a Workbook, name: &str) -> Result<&'a NamedSheet, Unconvertible> {
    let mut sheets = workbook.sheets.iter();
    sheets.find(|sheet| sheet.name == name).ok_or_else(|| {
        let known: Vec<&str> = workbook.sheets.iter().map(|sheet| &*sheet.name).collect();
        Unconvertible::new(
            format!("has no sheet `{name}`"),
            suggestion(name, &known, "its sheets:"),
        )
    })
}
