//! VTK's unstructured grids as XML (`.vtu`): text, base64 and raw data, inline or appended, plain or zlib-compressed.
//!
//! ```text
//! plain         [bytes] data
//! compressed    [blocks] [size of a block] [size of the last, 0: full] [compressed sizes …] blocks
//! ```
//!
//! The numbers in brackets have the file's `header_type`. How many values an array has follows from the numbers of
//! points and cells, so that the size of everything is known, and bounded, before it is decoded.
//!
//! # References
//! VTK XML formats, <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>

use std::collections::BTreeMap;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::unstructured::{CUT_OFF, UnstructuredGrid};

mod decode;

use super::raw::ImportFault;
use decode::{Header, Numbers, decode_base64, inflate, width};

/// Points and cells that are read at most.
const MOST: usize = 5_000_000;

/// Nodes of a cell at most: a biquadratic quadrilateral has nine, everything larger is refused by its kind.
const MOST_NODES: usize = 64;

/// Attributes of a tag.
pub type Attributes = BTreeMap<String, String>;

/// An array as it stands in the file.
struct DataArray {
    attributes: Attributes,
    text: String,
}

impl DataArray {
    fn attribute(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }

    fn components(&self) -> Result<usize, ImportFault> {
        match self.attribute("NumberOfComponents") {
            "" => Ok(1),
            text => text.parse().map_err(|_| {
                let name = self.attribute("Name");
                format!("has the array `{name}` with {text} components").into()
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
    arrays: Vec<(String, DataArray)>,
    appended_encoding: String,
}

/// Reads the bytes of a file.
pub fn read(bytes: &[u8]) -> Result<UnstructuredGrid, ImportFault> {
    let (head, appended) = split_appended(bytes);
    let head = std::str::from_utf8(head).map_err(|_| "is not XML: its header is not text")?;
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
        let position = bytes[from..].iter().position(|byte| *byte == wanted);
        position.map(|position| from + position + 1)
    };
    match after(start, b'>').and_then(|end| Some((end, after(end, b'_')?))) {
        Some((end, data)) => (&bytes[..end], &bytes[data..]),
        None => (bytes, &[]),
    }
}

pub fn attributes(tag: &BytesStart) -> Result<Attributes, ImportFault> {
    let mut all = Attributes::new();
    for attribute in tag.attributes().with_checks(false) {
        let attribute = attribute.map_err(|cause| format!("is not XML: {cause}"))?;
        let value = attribute.normalized_value(XmlVersion::Explicit1_0);
        let value = value.map_err(|cause| format!("is not XML: {cause}"))?;
        all.insert(attribute.key.as_ref().to_owned(), value.into_owned());
    }
    Ok(all)
}

impl Layout {
    fn of(text: &str) -> Result<Self, ImportFault> {
        let mut reader = Reader::from_str(text);
        let mut layout = Self::default();
        let (mut part, mut open) = (String::new(), None::<DataArray>);
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
                Err(cause) => return Err(format!("is not XML: {cause}").into()),
            }
        }
    }

    fn enter(
        &mut self,
        name: &str,
        tag: &BytesStart,
        part: &mut String,
    ) -> Result<(), ImportFault> {
        match name {
            "VTKFile" => self.file = attributes(tag)?,
            "Piece" if self.piece.is_some() => {
                return Err("has several pieces; merge them into one".into());
            }
            "Piece" => self.piece = Some(attributes(tag)?),
            "AppendedData" => {
                let fields = attributes(tag)?;
                self.appended_encoding = fields.get("encoding").cloned().unwrap_or_default();
            }
            "Points" | "Cells" | "PointData" | "CellData" | "FieldData" => name.clone_into(part),
            _ => {}
        }
        Ok(())
    }
}

fn encoded(tag: &BytesStart) -> Result<DataArray, ImportFault> {
    Ok(DataArray {
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
    binary: Numbers,
    compressed: bool,
    points: usize,
    cells: usize,
}

impl<'a> XmlFile<'a> {
    fn new(layout: &'a Layout, appended: &'a [u8]) -> Result<Self, ImportFault> {
        let file = |name: &str| layout.file.get(name).map_or("", String::as_str);
        if layout.file.is_empty() {
            return Err("cannot be read as VTK: it has no VTKFile".into());
        }
        if file("type") != "UnstructuredGrid" {
            return Err("is not an unstructured grid".into());
        }
        let compressed = match file("compressor") {
            "" => false,
            "vtkZLibDataCompressor" => true,
            other => {
                return Err(format!(
                    "is compressed by {other}; save it without compression or with zlib"
                )
                .into());
            }
        };
        let piece = layout.piece.as_ref().ok_or("has no piece")?;
        let count = |name: &str| -> Result<usize, ImportFault> {
            let number = piece.get(name).and_then(|text| text.trim().parse().ok());
            let number = number.ok_or_else(|| format!("has a piece without {name}"))?;
            match number {
                0..=MOST => Ok(number),
                _ => Err(format!("has {name} = {number}; at most {MOST} are read").into()),
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
            binary: Numbers {
                big_endian: file("byte_order") == "BigEndian",
                wide_header: file("header_type") == "UInt64",
            },
            compressed,
            points: count("NumberOfPoints")?,
            cells: count("NumberOfCells")?,
            layout,
        })
    }

    fn grid(&self) -> Result<UnstructuredGrid, ImportFault> {
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
    fn needed(&self, part: &str, name: Option<&str>) -> Result<&'a DataArray, ImportFault> {
        let mut arrays = self.layout.arrays.iter().filter(|(of, _)| of == part);
        let matching =
            arrays.find(|(_, array)| name.is_none_or(|name| array.attribute("Name") == name));
        let (_, array) = matching.ok_or_else(|| {
            let name = name.map_or(String::new(), |name| format!("`{name}` "));
            format!("has no array {name}of {part}")
        })?;
        Ok(array)
    }

    /// The arrays of a part that hold numbers, with the names of their own.
    fn arrays(&self, part: &str, tuples: usize) -> Result<Vec<(String, Vec<f64>)>, ImportFault> {
        let of_part = self.layout.arrays.iter().filter(|(of, _)| of == part);
        let numbers = of_part.filter(|(_, array)| width(array.attribute("type")).is_some());
        let decode = |(_, array): &(String, DataArray)| {
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
    fn values(&self, array: &DataArray, count: usize) -> Result<Vec<f64>, ImportFault> {
        let name = array.attribute("Name");
        let named = |reason: String| format!("has the array `{name}`, which {reason}");
        let kind = array.attribute("type");
        let width = width(kind).ok_or_else(|| named(format!("is of the type `{kind}`")))?;
        if array.attribute("format") == "ascii" {
            let numbers = array.text.split_ascii_whitespace();
            let values: Result<Vec<f64>, _> = numbers.take(count + 1).map(str::parse).collect();
            let values =
                values.map_err(|_| named("contains something that is not a number".into()))?;
            return if values.len() == count {
                Ok(values)
            } else {
                Err(named(format!("does not have {count} values")).into())
            };
        }
        let bytes = self.bytes(array, count * width);
        let bytes = bytes.map_err(|fault| named(fault.to_string()))?;
        let numbers = bytes.chunks_exact(width);
        Ok(numbers
            .map(|bytes| self.binary.number(kind, bytes))
            .collect())
    }

    /// The bytes of an array, of which there must be so many.
    fn bytes(&self, array: &DataArray, wanted: usize) -> Result<Vec<u8>, ImportFault> {
        let stored = match array.attribute("format") {
            "binary" => decode_base64(array.text.as_bytes())?,
            "appended" => self.appended(array)?,
            other => return Err(format!("is in the format `{other}`").into()),
        };
        let mut header = Header {
            numbers: self.binary,
            bytes: &stored,
        };
        if !self.compressed {
            let size = header.next()?;
            return match header.bytes.get(..wanted) {
                Some(data) if size == wanted => Ok(data.to_vec()),
                _ => Err(format!("has {size} bytes where {wanted} belong").into()),
            };
        }
        inflate(header, wanted)
    }

    /// The bytes of an appended array, with what stands behind them.
    fn appended(&self, array: &DataArray) -> Result<Vec<u8>, ImportFault> {
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
}

#[cfg(test)]
mod tests;
