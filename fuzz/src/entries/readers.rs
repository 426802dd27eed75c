//! Readers of files and texts.

use std::path::Path;

use gelbench::budget::Budget;
use gelbench::document::{Statements, Table};
use gelbench::identification::Recording;
use gelbench::kinds::{kind_of, read_as};
use gelbench::markers::{ReadSettings, read};
use gelbench::material::Card;
use gelbench::mesh::{CellShape, MeshReading, Outline, import};
use gelbench::studies::plate;
use gelbench_mechanics::markers::read_lines;
use gelbench_mechanics::mesh::import_series;

use super::{Became, with_file};

/// Bytes as text; what is no text is refused by every reader alike.
fn text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

/// A study of any kind is read and checked.
pub fn study(bytes: &[u8]) -> Became {
    let Some(text) = text(bytes) else {
        return Became::Refused;
    };
    let file = Path::new("study.toml");
    let read = match kind_of("study.toml", text) {
        Ok(Some(case)) => read_as(case, file, text, Budget::USUAL).is_ok(),
        Ok(None) => plate::load(file, text, Budget::USUAL).is_ok(),
        Err(_) => false,
    };
    read.into()
}

/// A card is read, and its law evaluated.
pub fn card(bytes: &[u8]) -> Became {
    let card = text(bytes).map(|text| Card::parse("card", "card.toml", text));
    let Some(Ok(card)) = card else {
        return Became::Refused;
    };
    let _ = card.law.shear_modulus();
    let _ = gelbench::material::stability::stable_range(
        &*card.law,
        gelbench::material::curve::Mode::Uniaxial,
    );
    Became::Complete
}

/// A table is read.
pub fn tables(bytes: &[u8]) -> Became {
    text(bytes)
        .is_some_and(|text| Table::parse("table.csv", text).is_ok())
        .into()
}

/// A table in the format of another program is read; `.xlsx` permits the names of sheets.
pub fn formats(bytes: &[u8]) -> Became {
    with_file("table.xlsx", bytes, |file| {
        Table::read(file, "").is_ok().into()
    })
}

/// A workbook is read: sheet, texts and formats are the parts of the input between zeros.
pub fn spreadsheet(bytes: &[u8]) -> Became {
    let mut parts = bytes.splitn(3, |byte| *byte == 0);
    let mut part = || parts.next().unwrap_or_default();
    let [sheet, texts, styles] = [part(), part(), part()];
    let package = br#"<Relationships><Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>"#;
    let workbook = br#"<workbook xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets><sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>"#;
    let references = br#"<Relationships><Relationship Id="r1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet1.xml"/></Relationships>"#;
    let archive = stored(&[
        ("_rels/.rels", package),
        ("xl/workbook.xml", workbook),
        ("xl/_rels/workbook.xml.rels", references),
        ("xl/worksheets/sheet1.xml", sheet),
        ("xl/sharedStrings.xml", texts),
        ("xl/styles.xml", styles),
    ]);
    formats(&archive)
}

/// A camera image: PNG, TIFF, BMP or JPEG.
pub fn image(bytes: &[u8]) -> Became {
    gelbench_images::images::of_bytes(bytes).is_ok().into()
}

/// An archive of files that are not compressed.
fn stored(files: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, bytes) in files {
        let size = (bytes.len() as u32).to_le_bytes();
        let lengths = [(name.len() as u16).to_le_bytes(), [0; 2]].concat();
        let offset = (archive.len() as u32).to_le_bytes();
        let common = [
            &[20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0][..],
            &checksum(bytes).to_le_bytes(),
            &size,
            &size,
            &lengths,
        ]
        .concat();
        archive.extend([b"PK\x03\x04", &common[..], name.as_bytes(), bytes].concat());
        directory.extend(
            [
                b"PK\x01\x02\x14\0",
                &common[..],
                &[0; 10],
                &offset,
                name.as_bytes(),
            ]
            .concat(),
        );
    }
    let count = (files.len() as u16).to_le_bytes();
    let [size, start] =
        [directory.len(), archive.len()].map(|length| (length as u32).to_le_bytes());
    let end = [
        &b"PK\x05\x06\0\0\0\0"[..],
        &count,
        &count,
        &size,
        &start,
        &[0; 2],
    ]
    .concat();
    [archive, directory, end].concat()
}

/// Markers are read, and an outline is laid around them.
pub fn markers(bytes: &[u8]) -> Became {
    let settings = ReadSettings {
        unit: Some(1.0),
        ..ReadSettings::default()
    };
    with_file("markers.csv", bytes, |file| {
        let Ok(result) = read(&[file.to_owned()], &settings) else {
            return Became::Refused;
        };
        let _ = Outline::of_points(&result.series.positions());
        Became::Complete
    })
}

/// Closed lines are read and meshed.
pub fn outline(bytes: &[u8]) -> Became {
    with_file("outline.csv", bytes, |file| {
        let Ok(lines) = read_lines(file, Some(1.0)) else {
            return Became::Refused;
        };
        let Ok(outline) = Outline::of_lines(lines) else {
            return Became::Refused;
        };
        let size = (outline.area() / 50.0).sqrt();
        for shape in [CellShape::Triangle3, CellShape::Quad9] {
            let _ = outline.mesh(size, shape);
        }
        Became::Complete
    })
}

/// A mesh and the fields on it are read.
fn mesh_file(name: &str, bytes: &[u8]) -> Became {
    with_file(name, bytes, |file| {
        let mesh = import(file, MeshReading::in_unit(1.0)).is_ok();
        let field = import_series(file, 1.0, None).is_ok();
        (mesh || field).into()
    })
}

/// Gmsh's files.
pub fn gmsh(bytes: &[u8]) -> Became {
    mesh_file("mesh.msh", bytes)
}

/// Abaqus' input files.
pub fn abaqus(bytes: &[u8]) -> Became {
    mesh_file("mesh.inp", bytes)
}

/// VTK's legacy files.
pub fn vtk(bytes: &[u8]) -> Became {
    mesh_file("mesh.vtk", bytes)
}

/// VTK's XML files.
pub fn vtu(bytes: &[u8]) -> Became {
    mesh_file("mesh.vtu", bytes)
}

/// CalculiX' result files.
pub fn frd(bytes: &[u8]) -> Became {
    mesh_file("mesh.frd", bytes)
}

/// ParaView's collections beside a file that they may name, `a.vtu`.
pub fn pvd(bytes: &[u8]) -> Became {
    const ONE: &[u8] = include_bytes!("../../corpus/vtu/triangle.vtu");
    with_file("all.pvd", bytes, |file| {
        std::fs::write(file.with_file_name("a.vtu"), ONE).expect("a file beside the collection");
        import_series(file, 1.0, None).is_ok().into()
    })
}

/// A recording of a spring is read.
pub fn recording(bytes: &[u8]) -> Became {
    let table = text(bytes).map(|text| Table::parse("spring.csv", text));
    let Some(Ok(table)) = table else {
        return Became::Refused;
    };
    Recording::of_table(&table, &Statements::new())
        .is_ok()
        .into()
}

/// CRC-32 as in zlib.
fn checksum(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _: u32| (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
    let byte = |crc: u32, byte: &u8| (0..8).fold(crc ^ u32::from(*byte), step);
    !bytes.iter().fold(!0, byte)
}
