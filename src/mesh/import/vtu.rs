//! VTK's unstructured grids as XML (`.vtu`): text, base64 and raw data, inline or appended, plain or zlib-compressed.
//!
//! ```text
//! plain         [bytes] data
//! compressed    [blocks] [size of a block] [size of the last, 0: full] [compressed sizes …] blocks
//! ```
//!
//! The numbers in brackets are of the file's `header_type`. How many values an array has follows from the numbers of
//! points and cells, so that the size of everything is known, and bounded, before it is decoded.
//!
//! # References
//! VTK XML formats, <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>

use std::collections::BTreeMap;
use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::unstructured::{CUT_OFF, UnstructuredGrid};

/// Points and cells that are read at most.
const MOST: usize = 5_000_000;

/// Nodes of a cell at most: a biquadratic quadrilateral has nine, everything larger is refused by its kind.
const MOST_NODES: usize = 64;

/// Attributes of a tag.
type Attributes = BTreeMap<String, String>;

/// An array as it stands in the file.
struct Encoded {
    attributes: Attributes,
    text: String,
}

impl Encoded {
    fn attribute(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }

    fn components(&self) -> Result<usize, String> {
        match self.attribute("NumberOfComponents") {
            "" => Ok(1),
            text => text.parse().map_err(|_| {
                let name = self.attribute("Name");
                format!("has the array `{name}` with {text} components")
            }),
        }
    }
}

/// The arrays of a file by the part that they belong to, and how they are written.
#[derive(Default)]
struct Layout {
    file: Attributes,
    piece: Option<Attributes>,
    /// `Points`, `Cells`, `PointData` or `CellData`, and its arrays.
    arrays: Vec<(String, Encoded)>,
    appended_encoding: String,
}

/// Reads the bytes of a file.
///
/// # Errors
/// Says what is wrong or cannot be read.
pub fn read(bytes: &[u8]) -> Result<UnstructuredGrid, String> {
    let (head, appended) = split_appended(bytes);
    let head = std::str::from_utf8(head).map_err(|_| "is no XML: its head is no text")?;
    let layout = Layout::of(head)?;
    let file = XmlFile::new(&layout, appended)?;
    file.grid()
}

/// The XML before appended data, and these data behind their underscore.
fn split_appended(bytes: &[u8]) -> (&[u8], &[u8]) {
    const TAG: &[u8] = b"<AppendedData";
    let Some(start) = bytes.windows(TAG.len()).position(|window| window == TAG) else {
        return (bytes, &[]);
    };
    let after = |from: usize, wanted: u8| {
        let place = bytes[from..].iter().position(|byte| *byte == wanted);
        place.map(|place| from + place + 1)
    };
    match after(start, b'>').and_then(|end| Some((end, after(end, b'_')?))) {
        Some((end, data)) => (&bytes[..end], &bytes[data..]),
        None => (bytes, &[]),
    }
}

fn attributes(tag: &BytesStart) -> Result<Attributes, String> {
    let mut all = Attributes::new();
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.map_err(|cause| format!("is no XML: {cause}"))?;
        let value = attribute.normalized_value(XmlVersion::Explicit1_0);
        let value = value.map_err(|cause| format!("is no XML: {cause}"))?;
        all.insert(attribute.key.as_ref().to_owned(), value.into_owned());
    }
    Ok(all)
}

impl Layout {
    fn of(text: &str) -> Result<Self, String> {
        let mut reader = Reader::from_str(text);
        let mut layout = Self::default();
        let (mut part, mut open) = (String::new(), None::<Encoded>);
        // Keys with texts of their own may stand within an array.
        let mut within = 0_usize;
        loop {
            match reader.read_event() {
                Ok(Event::Start(tag)) => match tag.name().as_ref() {
                    "DataArray" => (open, within) = (Some(encoded(&tag)?), 0),
                    _ if open.is_some() => within += 1,
                    name => layout.enter(name, &tag, &mut part)?,
                },
                Ok(Event::Empty(tag)) => match tag.name().as_ref() {
                    "DataArray" => layout.arrays.push((part.clone(), encoded(&tag)?)),
                    name => layout.enter(name, &tag, &mut part)?,
                },
                Ok(Event::Text(text)) if within == 0 => {
                    if let Some(open) = &mut open {
                        open.text.push_str(&text);
                    }
                }
                Ok(Event::End(tag)) if tag.name().as_ref() == "DataArray" => {
                    let closed = open.take().map(|array| (part.clone(), array));
                    layout.arrays.extend(closed);
                }
                Ok(Event::End(_)) => within = within.saturating_sub(1),
                Ok(Event::Eof) => return Ok(layout),
                Ok(_) => {}
                Err(cause) => return Err(format!("is no XML: {cause}")),
            }
        }
    }

    fn enter(&mut self, name: &str, tag: &BytesStart, part: &mut String) -> Result<(), String> {
        match name {
            "VTKFile" => self.file = attributes(tag)?,
            "Piece" if self.piece.is_some() => {
                return Err("has several pieces; merge them into one".into());
            }
            "Piece" => self.piece = Some(attributes(tag)?),
            "AppendedData" => {
                let found = attributes(tag)?;
                self.appended_encoding = found.get("encoding").cloned().unwrap_or_default();
            }
            "Points" | "Cells" | "PointData" | "CellData" | "FieldData" => name.clone_into(part),
            _ => {}
        }
        Ok(())
    }
}

fn encoded(tag: &BytesStart) -> Result<Encoded, String> {
    Ok(Encoded {
        attributes: attributes(tag)?,
        text: String::new(),
    })
}

/// A file whose arrays can be decoded.
struct XmlFile<'a> {
    layout: &'a Layout,
    appended: &'a [u8],
    /// Where appended arrays begin, ascending.
    offsets: Vec<usize>,
    big_endian: bool,
    wide_header: bool,
    compressed: bool,
    points: usize,
    cells: usize,
}

impl<'a> XmlFile<'a> {
    fn new(layout: &'a Layout, appended: &'a [u8]) -> Result<Self, String> {
        let file = |name: &str| layout.file.get(name).map_or("", String::as_str);
        if layout.file.is_empty() {
            return Err("cannot be read as VTK: it has no VTKFile".into());
        }
        if file("type") != "UnstructuredGrid" {
            return Err("is no unstructured grid".into());
        }
        let compressed = match file("compressor") {
            "" => false,
            "vtkZLibDataCompressor" => true,
            other => {
                return Err(format!(
                    "is compressed by {other}; save it without compression or with zlib"
                ));
            }
        };
        let piece = layout.piece.as_ref().ok_or("has no piece")?;
        let count = |name: &str| {
            let number = piece.get(name).and_then(|text| text.trim().parse().ok());
            let number = number.ok_or_else(|| format!("has a piece without {name}"))?;
            match number {
                0..=MOST => Ok(number),
                _ => Err(format!("has {name} = {number}; at most {MOST} are read")),
            }
        };
        let arrays = layout.arrays.iter();
        let mut offsets: Vec<usize> = arrays
            .filter_map(|(_, array)| array.attribute("offset").parse().ok())
            .collect();
        offsets.sort_unstable();
        Ok(Self {
            appended,
            offsets,
            big_endian: file("byte_order") == "BigEndian",
            wide_header: file("header_type") == "UInt64",
            compressed,
            points: count("NumberOfPoints")?,
            cells: count("NumberOfCells")?,
            layout,
        })
    }

    fn grid(&self) -> Result<UnstructuredGrid, String> {
        let points = self.needed("Points", None)?;
        if points.components()? != 3 {
            return Err("has points without three coordinates".into());
        }
        let points = self.values(points, 3 * self.points)?;
        let offsets = self.values(self.needed("Cells", Some("offsets"))?, self.cells)?;
        let offsets: Vec<usize> = offsets.into_iter().map(|end| end as usize).collect();
        let nodes = offsets.last().copied().unwrap_or(0);
        if nodes > MOST_NODES * self.cells || offsets.windows(2).any(|pair| pair[1] < pair[0]) {
            return Err(CUT_OFF.into());
        }
        let connectivity = self.values(self.needed("Cells", Some("connectivity"))?, nodes)?;
        let types = self.values(self.needed("Cells", Some("types"))?, self.cells)?;
        let mut start = 0;
        let cells = types.into_iter().zip(offsets).map(|(kind, end)| {
            let nodes = connectivity[start..end].iter().map(|node| *node as u64);
            start = end;
            (kind as u8, nodes.collect())
        });
        Ok(UnstructuredGrid {
            cells: cells.collect(),
            points,
            point_arrays: self.arrays("PointData", self.points)?,
            cell_arrays: self.arrays("CellData", self.cells)?,
        })
    }

    /// The array of a name in a part, or its only one.
    fn needed(&self, part: &str, name: Option<&str>) -> Result<&'a Encoded, String> {
        let mut own = self.layout.arrays.iter().filter(|(of, _)| of == part);
        let found = own.find(|(_, array)| name.is_none_or(|name| array.attribute("Name") == name));
        let (_, array) = found.ok_or_else(|| {
            let name = name.map_or(String::new(), |name| format!("`{name}` "));
            format!("has no array {name}of {part}")
        })?;
        Ok(array)
    }

    /// The arrays of a part that hold numbers, with the names of their own.
    fn arrays(&self, part: &str, tuples: usize) -> Result<Vec<(String, Vec<f64>)>, String> {
        let own = self.layout.arrays.iter().filter(|(of, _)| of == part);
        let numbers = own.filter(|(_, array)| width(array.attribute("type")).is_some());
        let decode = |(_, array): &(String, Encoded)| {
            let components = array.components()?;
            // A tensor of a symmetric kind has six, a whole one nine.
            if components > 9 {
                return Ok(None);
            }
            let values = self.values(array, components * tuples)?;
            Ok(Some((array.attribute("Name").to_owned(), values)))
        };
        numbers
            .filter_map(|array| decode(array).transpose())
            .collect()
    }

    /// So many numbers of an array.
    fn values(&self, array: &Encoded, count: usize) -> Result<Vec<f64>, String> {
        let name = array.attribute("Name");
        let named = |reason: String| format!("has the array `{name}`, which {reason}");
        let kind = array.attribute("type");
        let width = width(kind).ok_or_else(|| named(format!("is of the type `{kind}`")))?;
        if array.attribute("format") == "ascii" {
            let numbers = array.text.split_ascii_whitespace();
            let values: Result<Vec<f64>, _> = numbers.take(count + 1).map(str::parse).collect();
            let values = values.map_err(|_| named("holds something that is no number".into()))?;
            return match values.len() == count {
                true => Ok(values),
                false => Err(named(format!("does not have {count} values"))),
            };
        }
        let bytes = self.bytes(array, count * width).map_err(named)?;
        let numbers = bytes.chunks_exact(width);
        Ok(numbers.map(|bytes| self.number(kind, bytes)).collect())
    }

    /// The bytes of an array, of which there must be so many.
    fn bytes(&self, array: &Encoded, wanted: usize) -> Result<Vec<u8>, String> {
        let stored = match array.attribute("format") {
            "binary" => decode_base64(array.text.as_bytes())?,
            "appended" => self.appended(array)?,
            other => return Err(format!("is in the format `{other}`")),
        };
        let mut header = Header {
            file: self,
            bytes: &stored,
        };
        if !self.compressed {
            let size = header.next()?;
            return match header.bytes.get(..wanted) {
                Some(data) if size == wanted => Ok(data.to_vec()),
                _ => Err(format!("has {size} bytes where {wanted} belong")),
            };
        }
        inflate(header, wanted)
    }

    /// The bytes of an appended array, with what stands behind them.
    fn appended(&self, array: &Encoded) -> Result<Vec<u8>, String> {
        let start = array.attribute("offset").parse().ok();
        let start = start.filter(|start: &usize| *start < self.appended.len());
        let start = start.ok_or("begins behind the end of the file")?;
        let next = self.offsets.iter().find(|offset| **offset > start);
        let end = next.map_or(self.appended.len(), |next| *next);
        let stored = &self.appended[start..end.min(self.appended.len())];
        match &*self.layout.appended_encoding {
            "raw" => Ok(stored.to_vec()),
            _ => decode_base64(stored),
        }
    }

    fn number(&self, kind: &str, bytes: &[u8]) -> f64 {
        let mut own = [0; 8];
        own[..bytes.len()].copy_from_slice(bytes);
        if self.big_endian {
            own[..bytes.len()].reverse();
        }
        let whole = u64::from_le_bytes(own);
        let shift = 64 - 8 * bytes.len() as u32;
        match kind {
            "Float32" => f64::from(f32::from_bits(whole as u32)),
            "Float64" => f64::from_bits(whole),
            _ if kind.starts_with('U') => whole as f64,
            _ => ((whole << shift) as i64 >> shift) as f64,
        }
    }
}

/// Bytes of a number of a type.
fn width(kind: &str) -> Option<usize> {
    match kind {
        "Int8" | "UInt8" => Some(1),
        "Int16" | "UInt16" => Some(2),
        "Int32" | "UInt32" | "Float32" => Some(4),
        "Int64" | "UInt64" | "Float64" => Some(8),
        _ => None,
    }
}

/// The numbers at the beginning of an array's bytes.
struct Header<'a> {
    file: &'a XmlFile<'a>,
    bytes: &'a [u8],
}

impl Header<'_> {
    fn next(&mut self) -> Result<usize, String> {
        let (kind, width) = match self.file.wide_header {
            true => ("UInt64", 8),
            false => ("UInt32", 4),
        };
        let (own, rest) = self.bytes.split_at_checked(width).ok_or("is cut off")?;
        self.bytes = rest;
        Ok(self.file.number(kind, own) as usize)
    }
}

/// The data of compressed blocks, of which there must be so many bytes.
fn inflate(mut header: Header, wanted: usize) -> Result<Vec<u8>, String> {
    let (blocks, size, last) = (header.next()?, header.next()?, header.next()?);
    let full = if last == 0 {
        blocks
    } else {
        blocks.saturating_sub(1)
    };
    let total = full.checked_mul(size).and_then(|sum| sum.checked_add(last));
    // A block holds at least a byte, but for an array without values.
    if total != Some(wanted) || blocks > wanted.max(1) {
        return Err(format!(
            "does not have the {wanted} bytes that belong to it"
        ));
    }
    let sizes: Result<Vec<usize>, String> = (0..blocks).map(|_| header.next()).collect();
    let (mut data, mut rest) = (Vec::new(), header.bytes);
    for size in sizes? {
        let (block, behind) = rest.split_at_checked(size).ok_or("is cut off")?;
        rest = behind;
        let left = (wanted - data.len()) as u64;
        let read = ZlibDecoder::new(block)
            .take(left + 1)
            .read_to_end(&mut data);
        read.map_err(|cause| format!("cannot be decompressed: {cause}"))?;
        if data.len() > wanted {
            break;
        }
    }
    match data.len() == wanted {
        true => Ok(data),
        false => Err(format!(
            "does not have the {wanted} bytes that belong to it"
        )),
    }
}

/// Bytes from base64, in which white space may stand and several parts with their own padding may follow one another.
fn decode_base64(text: &[u8]) -> Result<Vec<u8>, String> {
    // What follows appended data is XML again.
    let end = text.iter().position(|byte| *byte == b'<');
    let own = text[..end.unwrap_or(text.len())].iter().copied();
    let plain: Vec<u8> = own.filter(|byte| !byte.is_ascii_whitespace()).collect();
    let (mut bytes, mut start) = (Vec::new(), 0);
    while start < plain.len() {
        let padding = plain[start..].iter().position(|byte| *byte == b'=');
        let end = padding.map_or(plain.len(), |place| (start + place + 1).next_multiple_of(4));
        // Parts begin at multiples of four, for each is padded to them.
        let part = plain.get(start..end).ok_or("is no base64")?;
        let decoded = STANDARD
            .decode(part)
            .map_err(|cause| format!("is no base64: {cause}"))?;
        bytes.extend(decoded);
        start = end;
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests;
