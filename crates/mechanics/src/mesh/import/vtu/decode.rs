//! Numbers from base64, from zlib, and from their bytes.

use std::io::Read;

use super::super::raw::ImportFault;
use crate::document::binary;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;

/// How a file writes its numbers.
#[derive(Clone, Copy)]
pub struct Numbers {
    pub big_endian: bool,
    pub wide_header: bool,
}

impl Numbers {
    /// A number of a type from its bytes.
    pub fn number(self, kind: &str, bytes: &[u8]) -> f64 {
        let first = kind.chars().next().unwrap_or_default();
        binary::number(first.to_ascii_lowercase(), bytes, self.big_endian)
    }
}

/// Bytes of a number of a type.
pub fn width(kind: &str) -> Option<usize> {
    match kind {
        "Int8" | "UInt8" => Some(1),
        "Int16" | "UInt16" => Some(2),
        "Int32" | "UInt32" | "Float32" => Some(4),
        "Int64" | "UInt64" | "Float64" => Some(8),
        _ => None,
    }
}

/// The numbers at the beginning of an array's bytes.
pub struct Header<'a> {
    pub numbers: Numbers,
    pub bytes: &'a [u8],
}

impl Header<'_> {
    pub fn next(&mut self) -> Result<usize, ImportFault> {
        let (kind, width) = if self.numbers.wide_header {
            ("UInt64", 8)
        } else {
            ("UInt32", 4)
        };
        let (word, rest) = self.bytes.split_at_checked(width).ok_or("is cut off")?;
        self.bytes = rest;
        Ok(self.numbers.number(kind, word) as usize)
    }
}

/// The data of compressed blocks, of which there must be so many bytes.
pub fn inflate(mut header: Header, wanted: usize) -> Result<Vec<u8>, ImportFault> {
    let (blocks, size, last) = (header.next()?, header.next()?, header.next()?);
    let full = if last == 0 {
        blocks
    } else {
        blocks.saturating_sub(1)
    };
    let total = full.checked_mul(size).and_then(|sum| sum.checked_add(last));
    // A block holds at least a byte, but for an array without values.
    if total != Some(wanted) || blocks > wanted.max(1) {
        return Err(format!("does not have the {wanted} bytes that belong to it").into());
    }
    let sizes: Result<Vec<usize>, ImportFault> = (0..blocks).map(|_| header.next()).collect();
    let (mut data, mut rest) = (Vec::new(), header.bytes);
    for size in sizes? {
        let (block, behind) = rest.split_at_checked(size).ok_or("is cut off")?;
        rest = behind;
        let remaining = (wanted - data.len()) as u64;
        let read = ZlibDecoder::new(block)
            .take(remaining + 1)
            .read_to_end(&mut data);
        read.map_err(|cause| format!("cannot be decompressed: {cause}"))?;
        if data.len() > wanted {
            break;
        }
    }
    if data.len() == wanted {
        Ok(data)
    } else {
        Err(format!("does not have the {wanted} bytes that belong to it").into())
    }
}

/// Bytes from base64, in which white space may stand and several parts with their own padding may follow one another.
pub fn decode_base64(text: &[u8]) -> Result<Vec<u8>, ImportFault> {
    // What follows appended data is XML again.
    let end = text.iter().position(|byte| *byte == b'<');
    let encoded = text[..end.unwrap_or(text.len())].iter().copied();
    let plain: Vec<u8> = encoded.filter(|byte| !byte.is_ascii_whitespace()).collect();
    let (mut bytes, mut start) = (Vec::new(), 0);
    while start < plain.len() {
        let padding = plain[start..].iter().position(|byte| *byte == b'=');
        let end = padding.map_or(plain.len(), |position| {
            (start + position + 1).next_multiple_of(4)
        });
        // Parts begin at multiples of four, for each is padded to them.
        let part = plain.get(start..end).ok_or("is not base64")?;
        let decoded = STANDARD
            .decode(part)
            .map_err(|cause| format!("is not base64: {cause}"))?;
        bytes.extend(decoded);
        start = end;
    }
    Ok(bytes)
}
