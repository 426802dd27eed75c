use std::path::{Path, PathBuf};

use super::*;
use crate::document::converted::afford;
use crate::document::{Head, Statements, Table};

/// A file that NumPy, SciPy or openpyxl has written.
fn corpus(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/formats");
    folder.join(name)
}

fn read(name: &str) -> Table {
    Table::read(&corpus(name), Table::HINT).unwrap()
}

fn rows(table: &Table) -> Vec<Vec<f64>> {
    table.rows.iter().map(|(row, _)| row.clone()).collect()
}

fn heads(table: &Table) -> Vec<String> {
    table
        .columns
        .iter()
        .map(crate::document::Column::head)
        .collect()
}

fn refusal(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    Table::read(&path, Table::HINT).unwrap_err().to_string()
}

const MATRIX: [[f64; 2]; 3] = [[1.0, 0.0], [1.5, -0.25], [2.0, 0.125]];

#[test]
fn arrays_of_numpy_and_matlab_are_tables() {
    for name in [
        "matrix.npy",
        "fortran.npy",
        "several.npz",
        "matrix.mat",
        "matrix.mat#data",
    ] {
        let table = read(name);
        assert_eq!(rows(&table), MATRIX, "{name}");
        assert_eq!(heads(&table), ["", ""], "{name}");
    }
    for (name, names) in [
        ("columns.npz", ["x [mm]", "ux [mm]"]),
        ("vectors.mat", ["x", "ux"]),
    ] {
        let table = read(name);
        assert_eq!(
            (rows(&table), heads(&table)),
            (
                MATRIX.map(Vec::from).to_vec(),
                names.map(str::to_owned).to_vec()
            )
        );
    }
    let table = read("columns.npz");
    let printed = Statements::new();
    let missing = Head::new(&table, &[], &printed)
        .unwrap()
        .missing("stress unit", "MPa");
    // No line can be written at the top of an archive.
    assert_eq!(missing.hint.as_deref(), Some("give --stress-unit MPa"));
    let table = read("structure.npy");
    assert_eq!(heads(&table), ["x", "ux", "frame"]);
    assert_eq!(rows(&table), [[0.0, 1.5, -2.0], [10.0, 2.5, 3.0]]);
    let table = read("structure.mat");
    assert_eq!(heads(&table), ["result.x", "result.frame"]);
    assert_eq!(rows(&table), [[1.0, 1.0], [1.5, 2.0], [2.0, 3.0]]);
}

#[test]
fn the_only_sheet_with_rows_enough_is_read_and_named() {
    let table = read("three_sheets.xlsx");
    assert!(
        table
            .source
            .name
            .ends_with("three_sheets.xlsx#Uniaxial <1>")
    );
    assert_eq!(table.part.as_deref(), Some("Uniaxial <1>"));
    assert_eq!(heads(&table), ["stretch [-]", "stress [kPa]", "remark"]);
    assert!(table.check_numbers([0], "").is_ok());
    // A formula that no program has computed has no value.
    let fault = table.check_numbers([1], "").unwrap_err().to_string();
    assert!(
        fault.contains("<1>:6: column `stress`: a field is empty"),
        "{fault}"
    );
    let named = read("three_sheets.xlsx#Planar");
    assert_eq!(heads(&named), ["time [s]", "force [N]"]);
    let fault = named.check_numbers([0], "").unwrap_err().to_string();
    assert!(
        fault.contains(":2:") && fault.contains("a time of day"),
        "{fault}"
    );
}

#[test]
fn what_is_no_table_is_refused_with_a_remedy() {
    let archive = std::fs::read(corpus("three_sheets.xlsx")).unwrap();
    for (name, bytes, reason) in [
        ("a.mat", &b"MATLAB 7.3 MAT-file, written \x89HDF"[..], "-v7"),
        (
            "a.xls",
            b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
            "save it as .xlsx",
        ),
        ("a.xlsx", &archive[..archive.len() / 2], "damaged archive"),
        (
            "a.npy",
            b"\x93NUMPY\x01\x00\x10\x00{'descr': '<c16'",
            "astype(float)",
        ),
    ] {
        let refused = refusal(name, bytes);
        assert!(refused.contains(reason), "{refused}");
    }
    for (name, reason) in [
        ("three_sheets.xlsx#planar", "did you mean `Planar`?"),
        ("several.npz#pixel", "pixel (4) is no table"),
        ("several.npz#u", "has no array `u`"),
    ] {
        let refused = Table::read(&corpus(name), "").unwrap_err().to_string();
        assert!(refused.contains(reason), "{refused}");
    }
}

#[test]
fn a_head_that_promises_too_much_is_refused_before_anything_is_decoded() {
    let head = |shape: &str, of: &str| {
        let head = format!("{{'descr': '{of}', 'fortran_order': False, 'shape': ({shape}), }}\n");
        [
            b"\x93NUMPY\x01\x00",
            &(head.len() as u16).to_le_bytes()[..],
            head.as_bytes(),
            &[0; 64],
        ]
        .concat()
    };
    assert!(refusal("a.npy", &head("1000000000, 1000000000", "<f8")).contains("cut off"));
    assert!(refusal("a.npy", &head("9999999999999999999, 9", "<f8")).contains("cut off"));
    assert!(refusal("a.npy", &head("2, 2", "<c16")).contains("astype(float)"));
    assert!(refusal("a.npy", &head("4", "<f8")).contains("no table"));
    assert!(
        afford(1e10, 0.0)
            .unwrap_err()
            .message
            .contains("bytes of memory")
    );
}

#[test]
fn sheets_and_arrays_are_named_behind_the_file() {
    for (path, file, part) in [
        ("a/tests.xlsx", "a/tests.xlsx", None),
        (
            "a#1/tests.XLSX#Sheet #2",
            "a#1/tests.XLSX",
            Some("Sheet #2"),
        ),
        ("a#1.csv", "a#1.csv", None),
    ] {
        let result = file_and_part(Path::new(path));
        assert_eq!(result, (PathBuf::from(file), part.map(str::to_owned)));
    }
    assert!(is_table_path(Path::new("a.xlsx#Sheet.1")) && is_table_path(Path::new("a.OUT")));
    assert!(!is_table_path(Path::new("a.vtu")));
}
