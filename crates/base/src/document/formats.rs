//! Tables in the formats of other programs, turned into the text of a table.
//!
//! | file | known by | what is a table |
//! |---|---|---|
//! | `.xlsx` | a ZIP archive with a workbook | a sheet |
//! | `.npy` | `\x93NUMPY` | two dimensions without names, or a structure with names |
//! | `.npz` | a ZIP archive of `.npy` | one such array, or arrays of one shape, each a column |
//! | `.mat` | `MATLAB 5.0 MAT-file` | a matrix, or vectors of one length, each a column |
//!
//! One of several sheets or arrays is named behind the file: `tests.xlsx#uniaxial`.

use std::path::{Path, PathBuf};

use super::archive::Archive;
use super::converted::{TableText, Unconvertible};
use super::{arrays, spreadsheet};

/// The endings of tables, in lower case.
const TABLES: [&str; 9] = [
    "csv", "txt", "dat", "tsv", "out", "xlsx", "npy", "npz", "mat",
];

/// The endings of files whose tables have names.
const WITH_PARTS: [&str; 4] = [".xlsx", ".xlsm", ".npz", ".mat"];

/// A file and the name of the table in it, where one is named: `tests.xlsx#uniaxial`.
pub(super) fn file_and_part(path: &Path) -> (PathBuf, Option<String>) {
    let complete = path.to_string_lossy();
    let ends = |(at, _): &(usize, &str)| {
        let file = complete[..*at].to_lowercase();
        WITH_PARTS.iter().any(|ending| file.ends_with(ending))
    };
    match complete.match_indices('#').find(ends) {
        Some((at, _)) => (
            PathBuf::from(&complete[..at]),
            Some(complete[at + 1..].to_owned()),
        ),
        None => (path.to_owned(), None),
    }
}

/// Whether a path is that of a table, by its ending.
pub fn is_table_path(path: &Path) -> bool {
    let ending = file_and_part(path)
        .0
        .extension()
        .map(|ending| ending.to_ascii_lowercase());
    ending.is_some_and(|ending| TABLES.iter().any(|known| ending == *known))
}

/// The tables of a file that is no text, in the order in which they are tried; `None` for any other file.
///
/// # Errors
/// [`Unconvertible`] where it has no table, not the one of this name, or is too large.
pub(super) fn tables(
    bytes: &[u8],
    part: Option<&str>,
) -> Result<Option<Vec<TableText>>, Unconvertible> {
    match bytes {
        [b'P', b'K', 3, 4, ..] => of_archive(bytes, part).map(Some),
        [0x93, b'N', b'U', b'M', b'P', b'Y', ..] => arrays::of_npy(bytes).map(Some),
        _ if bytes.starts_with(b"MATLAB 5.0 MAT-file") => arrays::of_mat(bytes, part).map(Some),
        _ if bytes.starts_with(b"MATLAB 7.3 MAT-file") || bytes.starts_with(b"\x89HDF") => {
            let hint = "save it in MATLAB by save('a.mat', 'x', 'ux', '-v7'), or as text by writematrix(x, 'a.csv')";
            Err(Unconvertible::new(
                "is a file of HDF5, which is not read",
                hint,
            ))
        }
        [0xd0, 0xcf, 0x11, 0xe0, ..] => {
            let hint = "save it as .xlsx or as .csv";
            Err(Unconvertible::new(
                "is a workbook of an old version of Excel",
                hint,
            ))
        }
        _ => Ok(None),
    }
}

fn of_archive(bytes: &[u8], part: Option<&str>) -> Result<Vec<TableText>, Unconvertible> {
    let mut archive = Archive::open(bytes)?;
    let names = archive.names();
    let are_arrays = !names.is_empty() && names.iter().all(|name| name.ends_with(".npy"));
    if names.iter().any(|name| name.ends_with("workbook.xml")) {
        spreadsheet::check(&mut archive)?;
        spreadsheet::tables(bytes, part)
    } else if are_arrays {
        arrays::of_npz(archive, part)
    } else {
        let hint = "give a table as text, .xlsx, .npy, .npz or .mat";
        Err(Unconvertible::new(
            "is an archive without a workbook or arrays of NumPy",
            hint,
        ))
    }
}

#[cfg(test)]
mod tests;
