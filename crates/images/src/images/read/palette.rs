//! TIFF images whose pixels are numbers of colours, which no decoder at hand reads.

use std::io::{Cursor, Read, Seek};

use tiff::decoder::Decoder;
use tiff::tags::{PhotometricInterpretation, Tag};
use tiff::{TiffError, TiffUnsupportedError};

use crate::images::grey::luminance;

/// The white of a palette's 16 bit over that of a pixel's 8 bit.
const TO_EIGHT_BIT: f32 = 257.0;

/// The number of colours of 8 bit.
const COLOURS: usize = 256;

/// The version of BigTIFF files, whose directories are different.
const BIG: u8 = 43;

/// Bytes of an entry of a directory of a TIFF file: tag, type, count and value.
const ENTRY: usize = 12;

/// Whether a fault is that of an image whose pixels are numbers of colours.
pub fn is_of_palette(fault: &TiffError) -> bool {
    use PhotometricInterpretation::RGBPalette;
    matches!(
        fault,
        TiffError::UnsupportedError(TiffUnsupportedError::InterpretationWithBits(RGBPalette, bits)) if bits[..] == [8]
    )
}

/// A decoder of bytes in memory.
type InMemory = Decoder<Cursor<Vec<u8>>>;

/// A decoder of the same page that takes the numbers of colours for grey values, and the grey value of each number.
///
/// # Errors
/// What is wrong with the file.
pub fn as_grey<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<(InMemory, Vec<f32>), String> {
    let words = |fault: TiffError| fault.to_string();
    let colours = decoder.get_tag_u16_vec(Tag::ColorMap).map_err(words)?;
    let third = colours.len() / 3;
    if third < COLOURS {
        return Err("its table of colours is too short".to_owned());
    }
    // Some programs write colours of 8 bit.
    let white = if colours.iter().all(|part| *part < 256) {
        1.0
    } else {
        TO_EIGHT_BIT
    };
    let grey = |number: usize| {
        let colour = [0, 1, 2].map(|part| f32::from(colours[part * third + number]));
        luminance(colour) / white
    };
    let greys = (0..third).map(grey).collect();
    let page = decoder.ifd_pointer().ok_or("it has no directory")?;
    let mut bytes = Vec::new();
    let file = decoder.inner();
    let read = file.rewind().and_then(|()| file.read_to_end(&mut bytes));
    read.map_err(|fault| fault.to_string())?;
    if bytes
        .get(2..4)
        .is_some_and(|version| version.contains(&BIG))
    {
        return Err(
            "it is a BigTIFF file whose pixels are numbers of colours; save it in grey".to_owned(),
        );
    }
    take_for_grey(&mut bytes, page.0 as usize).ok_or("its directory is damaged")?;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(words)?;
    let mut pages = 0;
    while decoder.ifd_pointer() != Some(page) {
        pages += 1;
        decoder.seek_to_image(pages).map_err(words)?;
    }
    Ok((decoder, greys))
}

/// Says in the directory at a position that the pixels are grey values.
fn take_for_grey(bytes: &mut [u8], at: usize) -> Option<()> {
    let is_little = bytes.starts_with(b"II");
    let short = |bytes: &[u8]| {
        let pair = [bytes[0], bytes[1]];
        if is_little {
            u16::from_le_bytes(pair)
        } else {
            u16::from_be_bytes(pair)
        }
    };
    let count = usize::from(short(bytes.get(at..at + 2)?));
    let entries = bytes.get_mut(at + 2..at + 2 + ENTRY * count)?;
    let is_interpretation =
        |entry: &&mut [u8]| short(entry) == Tag::PhotometricInterpretation.to_u16();
    let entry = entries.chunks_exact_mut(ENTRY).find(is_interpretation)?;
    let grey = PhotometricInterpretation::BlackIsZero.to_u16();
    entry[8..10].copy_from_slice(&if is_little {
        grey.to_le_bytes()
    } else {
        grey.to_be_bytes()
    });
    Some(())
}
