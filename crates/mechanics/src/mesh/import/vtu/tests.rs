//! Every way in which VTK writes an unstructured grid, and files that are damaged or ask for too much.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use proptest::prelude::*;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::*;

/// How a file is written.
#[derive(Clone, Copy, Debug)]
struct Encoding {
    format: &'static str,
    encoding: &'static str,
    compressed: bool,
    wide_header: bool,
    big_endian: bool,
}

const ASCII: Encoding = Encoding {
    format: "ascii",
    encoding: "",
    compressed: false,
    wide_header: false,
    big_endian: false,
};

/// A triangle and a quadrilateral side by side, with a displacement.
struct Written {
    options: Encoding,
    appended: Vec<u8>,
}

impl Written {
    fn size(&self, number: usize) -> Vec<u8> {
        let full = (number as u64).to_le_bytes();
        let mut bytes = full[..if self.options.wide_header { 8 } else { 4 }].to_vec();
        if self.options.big_endian {
            bytes.reverse();
        }
        bytes
    }

    /// An array; compressed ones are cut into blocks of 40 bytes.
    fn array(&mut self, name: &str, kind: &str, components: usize, values: &[f64]) -> String {
        let head = format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
        );
        if self.options.format == "ascii" {
            let values: Vec<String> = values.iter().map(f64::to_string).collect();
            return format!(
                "{head} format=\"ascii\">\n{}\n</DataArray>\n",
                values.join(" ")
            );
        }
        let mut data = Vec::new();
        for value in values {
            let mut bytes = match kind {
                "Float64" => value.to_le_bytes().to_vec(),
                "Float32" => (*value as f32).to_le_bytes().to_vec(),
                "Int64" => (*value as i64).to_le_bytes().to_vec(),
                _ => vec![*value as u8],
            };
            if self.options.big_endian {
                bytes.reverse();
            }
            data.extend(bytes);
        }
        let parts = if !self.options.compressed {
            vec![self.size(data.len()), data]
        } else {
            self.blocks(&data)
        };
        let stored: Vec<u8> = match (self.options.format, self.options.encoding) {
            ("appended", "raw") => parts.concat(),
            _ => parts
                .iter()
                .flat_map(|part| STANDARD.encode(part).into_bytes())
                .collect(),
        };
        if self.options.format == "appended" {
            let offset = self.appended.len();
            self.appended.extend(stored);
            return format!("{head} format=\"appended\" offset=\"{offset}\"/>\n");
        }
        let text = String::from_utf8(stored).unwrap();
        format!("{head} format=\"binary\">\n  {text}\n</DataArray>\n")
    }

    fn blocks(&self, data: &[u8]) -> Vec<Vec<u8>> {
        let blocks: Vec<Vec<u8>> = data
            .chunks(40)
            .map(|block| {
                let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
                encoder.write_all(block).unwrap();
                encoder.finish().unwrap()
            })
            .collect();
        let mut header = [blocks.len(), 40, data.len() % 40]
            .map(|n| self.size(n))
            .concat();
        header.extend(blocks.iter().flat_map(|block| self.size(block.len())));
        vec![header, blocks.concat()]
    }
}

fn file(options: Encoding) -> Vec<u8> {
    let mut written = Written {
        options,
        appended: Vec::new(),
    };
    let points = [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0, 2.0, 0.5, 0.0,
    ];
    let moved = [
        0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.5, -0.25, 0.0, 0.0, -0.25, 0.0, 1.0, -0.125, 0.0,
    ];
    let points = written.array("Points", "Float64", 3, &points);
    let moved = written.array("displacement", "Float32", 3, &moved);
    let nodes = written.array(
        "connectivity",
        "Int64",
        1,
        &[0.0, 1.0, 2.0, 3.0, 1.0, 4.0, 2.0],
    );
    let ends = written.array("offsets", "Int64", 1, &[4.0, 7.0]);
    let kinds = written.array("types", "UInt8", 1, &[9.0, 5.0]);
    let compressor = if options.compressed {
        " compressor=\"vtkZLibDataCompressor\""
    } else {
        ""
    };
    let order = if options.big_endian {
        "BigEndian"
    } else {
        "LittleEndian"
    };
    let header = if options.wide_header {
        "UInt64"
    } else {
        "UInt32"
    };
    let mut bytes = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{order}\" \
         header_type=\"{header}\"{compressor}>\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<PointData Vectors=\"displacement\">\n{moved}</PointData>\n\
         <CellData/>\n<Points>\n{points}</Points>\n<Cells>\n{nodes}{ends}{kinds}</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    )
    .into_bytes();
    if options.format == "appended" {
        bytes.extend(format!("<AppendedData encoding=\"{}\">\n _", options.encoding).into_bytes());
        bytes.extend(written.appended);
        bytes.extend(b"\n</AppendedData>\n");
    }
    bytes.extend(b"</VTKFile>\n");
    bytes
}

fn encodings() -> Vec<Encoding> {
    let mut encodings = vec![ASCII];
    for (format, encoding) in [("binary", ""), ("appended", "raw"), ("appended", "base64")] {
        for switches in 0..8 {
            encodings.push(Encoding {
                format,
                encoding,
                compressed: switches & 1 != 0,
                wide_header: switches & 2 != 0,
                big_endian: switches & 4 != 0,
            });
        }
    }
    encodings
}

#[test]
fn a_grid_is_the_same_however_it_is_written() {
    for options in encodings() {
        let grid = read(&file(options)).unwrap_or_else(|reason| panic!("{options:?}: {reason}"));
        assert_eq!(
            grid.cells,
            [(9, vec![0, 1, 2, 3]), (5, vec![1, 4, 2])],
            "{options:?}"
        );
        assert_eq!(grid.points[12..], [2.0, 0.5, 0.0], "{options:?}");
        let [(name, values)] = &grid.point_arrays[..] else {
            panic!("{options:?}");
        };
        assert_eq!(
            (&**name, values.len(), values[13]),
            ("displacement", 15, -0.125),
            "{options:?}"
        );
    }
}

#[test]
fn a_file_that_asks_for_more_than_it_holds_is_refused_before_anything_is_made() {
    let plain = String::from_utf8(file(ASCII)).unwrap();
    for (from, to, reason) in [
        (
            "NumberOfPoints=\"5\"",
            "NumberOfPoints=\"3500000000\"",
            "at most",
        ),
        (
            "NumberOfPoints=\"5\"",
            "NumberOfPoints=\"50\"",
            "does not have 150 values",
        ),
        (
            "NumberOfPoints=\"5\"",
            "NumberOfPoints=\"-5\"",
            "without NumberOfPoints",
        ),
        ("4 7", "4 7000000", "cut off"),
        ("4 7", "7 4", "cut off"),
        (
            "UnstructuredGrid\"",
            "PolyData\"",
            "is not an unstructured grid",
        ),
        (
            "<Piece",
            "<Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"/><Piece",
            "several pieces",
        ),
        ("\"Float64\"", "\"String\"", "is of the type `String`"),
    ] {
        let error = read(plain.replacen(from, to, 1).as_bytes()).err();
        let error = error.unwrap_or_else(|| panic!("{from} -> {to} was read"));
        assert!(
            error.to_string().contains(reason),
            "{from} -> {to}: {error}"
        );
    }
    let squeezed = Encoding {
        compressed: true,
        ..encodings()[1]
    };
    let text = String::from_utf8(file(squeezed)).unwrap();
    let bomb = text.replace("NumberOfPoints=\"5\"", "NumberOfPoints=\"4000000\"");
    let error = read(bomb.as_bytes()).err().unwrap();
    assert!(
        error.to_string().contains("bytes that belong to it"),
        "{error}"
    );
}

/// Files that made the library behind the earlier reader panic or ask for 84 GB.
#[test]
fn short_and_empty_files_are_refused() {
    for text in [
        "",
        "<",
        "<VTKFile type=\"UnstructuredGrid\"/>",
        "<VTKFile type=\"UnstructuredGrid\"><Piece/></VTKFile>",
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"><Points>\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\"></DataArray></Points></Piece>",
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"><Points>\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"99\"/></Points></Piece>\
         <AppendedData encoding=\"raw\">_",
    ] {
        assert!(read(text.as_bytes()).is_err(), "{text}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Damage is an error or another grid, and never a panic.
    #[test]
    fn damaged_files_never_panic(
        index in 0..25_usize,
        positions in proptest::collection::vec((0.0..1.0_f64, any::<u8>()), 1..6),
        cut in 0.0..1.2_f64,
    ) {
        let mut bytes = file(encodings()[index]);
        let length = bytes.len();
        for (position, byte) in positions {
            bytes[(position * length as f64) as usize] = byte;
        }
        bytes.truncate((cut * length as f64) as usize);
        let _ = read(&bytes);
    }
}
