//! Matrices in files of MATLAB, version 5 (`save` without `-v7.3`): those of real numbers, also in structures.
//!
//! # References
//! The MathWorks, MAT-File Format, "Level 5 MAT-File Format".

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::super::binary::number;
use super::super::converted::{Unconvertible, afford};
use super::array::Array;
use super::numpy::by_rows;

/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Classes of matrices: structures, and the first and last of those of numbers.
const STRUCTURE: u8 = 2;
const NUMBERS: std::ops::RangeInclusive<u8> = 6..=15;
/// How deep structures are looked into.
const DEEPEST: usize = 4;

/// The arrays of real numbers, in the order of the file; those in structures as `structure.field`.
///
/// # Errors
/// [`Unconvertible`] where the file is damaged or too large.
pub fn arrays(bytes: &[u8]) -> Result<Vec<Array>, Unconvertible> {
    let big_endian = match bytes.get(126..128) {
        Some(b"MI") => true,
        Some(b"IM") => false,
        _ => return Err(damaged()),
    };
    let mut elements = Elements {
        rest: &bytes[128..],
        big_endian,
    };
    let mut all = Vec::new();
    while !elements.rest.is_empty() {
        let (mut kind, mut data) = elements.next()?;
        let unpacked;
        if kind == COMPRESSED {
            unpacked = unpack(data, big_endian)?;
            (kind, data) = elements.within(&unpacked).next()?;
        }
        if kind == MATRIX {
            matrix(elements.within(data), None, DEEPEST, &mut all)?;
        }
    }
    Ok(all)
}

fn damaged() -> Unconvertible {
    let hint = "save it again in MATLAB by save('a.mat', 'x', 'ux', '-v7'), or in Python by scipy.io.savemat";
    Unconvertible::new("is a damaged file of MATLAB", hint)
}

/// Unpacks an element of the size that its first bytes state.
fn unpack(data: &[u8], big_endian: bool) -> Result<Vec<u8>, Unconvertible> {
    let mut decoder = ZlibDecoder::new(data);
    let mut tag = [0; 8];
    decoder.read_exact(&mut tag).map_err(|_| damaged())?;
    let size = u64::from(word(&tag[4..], big_endian));
    afford(size as f64, 0.0)?;
    let mut all = tag.to_vec();
    decoder
        .take(size)
        .read_to_end(&mut all)
        .map_err(|_| damaged())?;
    Ok(all)
}

fn word(bytes: &[u8], big_endian: bool) -> u32 {
    let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
    if big_endian {
        u32::from_be_bytes(bytes)
    } else {
        u32::from_le_bytes(bytes)
    }
}

/// The elements of a file or of a matrix.
struct Elements<'a> {
    rest: &'a [u8],
    big_endian: bool,
}

impl<'a> Elements<'a> {
    /// The elements within another one.
    fn within<'b>(&self, rest: &'b [u8]) -> Elements<'b> {
        Elements { rest, ..*self }
    }

    /// The type and the data of the next element.
    fn next(&mut self) -> Result<(u32, &'a [u8]), Unconvertible> {
        self.split().ok_or_else(damaged)
    }

    /// Splits the next element off; small ones share four bytes with their tag.
    fn split(&mut self) -> Option<(u32, &'a [u8])> {
        let first = word(self.rest.get(..4)?, self.big_endian);
        if first >> 16 != 0 {
            let data = self.rest.get(4..4 + (first >> 16) as usize)?;
            self.rest = self.rest.get(8..)?;
            return Some((first & 0xffff, data));
        }
        let size = word(self.rest.get(4..8)?, self.big_endian) as usize;
        let data = self.rest.get(8..8_usize.checked_add(size)?)?;
        let padded = if first == COMPRESSED {
            size
        } else {
            size.next_multiple_of(8)
        };
        self.rest = self.rest.get(8 + padded..).unwrap_or_default();
        Some((first, data))
    }

    fn words(&mut self) -> Result<Vec<u32>, Unconvertible> {
        let words = self.next()?.1.chunks_exact(4);
        Ok(words.map(|bytes| word(bytes, self.big_endian)).collect())
    }

    /// The first of some words.
    fn first_word(&mut self) -> Result<u32, Unconvertible> {
        self.words()?.first().copied().ok_or_else(damaged)
    }

    /// Numbers of any type.
    fn numbers(&mut self) -> Result<Vec<f64>, Unconvertible> {
        let (kind, data) = self.next()?;
        let (size, kind) = match kind {
            1 => (1, 'i'),
            2 => (1, 'u'),
            3 => (2, 'i'),
            4 => (2, 'u'),
            5 => (4, 'i'),
            6 => (4, 'u'),
            7 => (4, 'f'),
            9 => (8, 'f'),
            12 => (8, 'i'),
            13 => (8, 'u'),
            _ => return Err(damaged()),
        };
        let values = data.chunks_exact(size);
        let numbers = values.map(|bytes| number(kind, bytes, self.big_endian));
        Ok(numbers.collect())
    }
}

/// A text up to its end or to the zero there.
fn text(data: &[u8]) -> String {
    let data = data.split(|byte| *byte == 0).next().unwrap_or_default();
    String::from_utf8_lossy(data).into_owned()
}

/// Adds the arrays of a matrix or a structure; what is neither is passed over.
fn matrix(
    mut elements: Elements,
    name: Option<String>,
    depth: usize,
    all: &mut Vec<Array>,
) -> Result<(), Unconvertible> {
    const COMPLEX: u32 = 0x800;
    if elements.rest.is_empty() {
        return Ok(());
    }
    let flags = elements.first_word()?;
    let class = flags as u8;
    if class != STRUCTURE && !NUMBERS.contains(&class) {
        return Ok(());
    }
    let shape = elements.words()?.into_iter().map(|size| size as usize);
    let shape: Vec<usize> = shape.collect();
    let (_, written) = elements.next()?;
    let name = name.unwrap_or_else(|| text(written));
    let mut sizes = shape.iter();
    let product = sizes.try_fold(1_usize, |all, size| all.checked_mul(*size));
    let count = product.ok_or_else(damaged)?;
    match class {
        STRUCTURE if depth > 0 && count == 1 => return structure(elements, &name, depth, all),
        STRUCTURE => return Ok(()),
        _ => afford(0.0, count as f64)?,
    }
    let numbers = elements.numbers()?;
    if numbers.len() != count {
        return Err(damaged());
    }
    if flags & COMPLEX == 0 {
        let numbers = by_rows(&numbers, &shape);
        all.push(Array {
            name,
            shape,
            numbers,
            ..Array::default()
        });
    }
    Ok(())
}

fn structure(
    mut elements: Elements,
    name: &str,
    depth: usize,
    all: &mut Vec<Array>,
) -> Result<(), Unconvertible> {
    let length = elements.first_word()? as usize;
    let (_, names) = elements.next()?;
    for field in names.chunks_exact(length.max(1)) {
        let (kind, data) = elements.next()?;
        if kind == MATRIX {
            let name = format!("{name}.{}", text(field));
            matrix(elements.within(data), Some(name), depth - 1, all)?;
        }
    }
    Ok(())
}
