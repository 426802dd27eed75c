//! Arrays of NumPy and MATLAB as texts of tables.
//!
//! A matrix is a table without names, a structure has names, and several arrays of one shape are columns with their names.

use super::archive::Archive;
use super::converted::{TableText, Unconvertible};
use crate::error::suggestion;

mod array;
mod matlab;
mod numpy;

use self::array::{Array, push_row};

/// The table of a file of NumPy.
///
/// # Errors
/// [`Unconvertible`] where it is no table of numbers, or is damaged.
pub(super) fn of_npy(bytes: &[u8]) -> Result<Vec<TableText>, Unconvertible> {
    let array = numpy::array(String::new(), bytes)?;
    let Some(size) = array.size() else {
        let sizes = array.describe();
        let hint = "save a two-dimensional array, a structured array, or columns by name: np.savez('a.npz', x=x, y=y)";
        return Err(Unconvertible::new(
            format!("has an array of the size{sizes}, which is no table"),
            hint,
        ));
    };
    let text = array.table(size);
    Ok(vec![TableText { name: None, text }])
}

/// The table in an archive of NumPy.
///
/// # Errors
/// [`Unconvertible`] where it is not clear which array is the table, or the file is damaged.
pub(super) fn of_npz(
    mut archive: Archive,
    part: Option<&str>,
) -> Result<Vec<TableText>, Unconvertible> {
    let mut arrays = Vec::new();
    let mut refused = Vec::new();
    for file in archive.names() {
        let name = file.trim_end_matches(".npy").to_owned();
        if part.is_some_and(|part| part != name) {
            arrays.push(Array {
                name,
                ..Array::default()
            });
            continue;
        }
        match numpy::array(name, &archive.read(&file)?) {
            Ok(array) => arrays.push(array),
            Err(fault) => refused.push(fault),
        }
    }
    if arrays.is_empty() || part.is_some() && !refused.is_empty() {
        return Err(refused.swap_remove(0));
    }
    chosen(arrays, part)
}

/// The table of a file of MATLAB.
///
/// # Errors
/// [`Unconvertible`] where it is not clear which array is the table, or the file is damaged.
pub(super) fn of_mat(bytes: &[u8], part: Option<&str>) -> Result<Vec<TableText>, Unconvertible> {
    chosen(matlab::arrays(bytes)?, part)
}

/// The table that several arrays are, or the one that is named.
fn chosen(arrays: Vec<Array>, part: Option<&str>) -> Result<Vec<TableText>, Unconvertible> {
    if let Some(name) = part {
        let array = arrays
            .iter()
            .find(|array| array.name == name)
            .ok_or_else(|| {
                let known: Vec<&str> = arrays.iter().map(|array| &*array.name).collect();
                Unconvertible::new(
                    format!("has no array `{name}`"),
                    suggestion(name, &known, "its arrays:"),
                )
            })?;
        return of_one(array, true);
    }
    let several: Vec<&Array> = arrays
        .iter()
        .filter(|array| array.numbers.len() > 1)
        .collect();
    let tables: Vec<&Array> = several
        .iter()
        .copied()
        .filter(|array| array.size().is_some())
        .collect();
    let is_like_first = |array: &&Array| array.is_column() && array.shape == several[0].shape;
    match (&several[..], &tables[..]) {
        ([one], _) => of_one(one, false),
        ([_, _, ..], _) if several.iter().all(is_like_first) => Ok(vec![columns(&several)]),
        (_, [one]) => of_one(one, true),
        _ => Err(undecided(&arrays)),
    }
}

fn of_one(array: &Array, named: bool) -> Result<Vec<TableText>, Unconvertible> {
    let size = array.size().ok_or_else(|| {
        let message = format!("{} is no table", array.describe());
        Unconvertible::new(
            message,
            "a table is a matrix of two columns or more, or several vectors of one length",
        )
    })?;
    let name = named.then(|| array.name.clone());
    Ok(vec![TableText {
        name,
        text: array.table(size),
    }])
}

/// The table whose columns are arrays of one shape.
fn columns(arrays: &[&Array]) -> TableText {
    let names: Vec<&str> = arrays.iter().map(|array| &*array.name).collect();
    let mut text = names.join("\t");
    text.push('\n');
    for row in 0..arrays[0].numbers.len() {
        push_row(&mut text, arrays.iter().map(|array| array.numbers[row]));
    }
    TableText { name: None, text }
}

fn undecided(arrays: &[Array]) -> Unconvertible {
    if arrays.is_empty() {
        let hint =
            "save vectors of one length, or a matrix; tables of MATLAB by writetable(T, 'a.csv')";
        return Unconvertible::new("has no array of numbers", hint);
    }
    let sizes: Vec<String> = arrays.iter().map(Array::describe).collect();
    let message = format!("has arrays of several sizes: {}", sizes.join(", "));
    Unconvertible::new(
        message,
        "name a matrix behind the file, as in a.npz#matrix, or save the columns of one table alone",
    )
}
