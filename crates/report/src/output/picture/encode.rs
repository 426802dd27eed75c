//! Pixels as PNG files.

use png::{BitDepth, ColorType, Encoder, EncodingError, Filter, PixelDimensions, Unit};
use tiny_skia::Pixmap;

use super::look::Look;

/// A part of a picture: left, top, width, height in pixels.
pub(super) type Part = [u32; 4];

/// All of a picture.
pub(super) fn full(picture: &Pixmap) -> Part {
    [0, 0, picture.width(), picture.height()]
}

/// Red, green and blue of a part; pictures are opaque.
pub(super) fn colours(picture: &Pixmap, [left, top, width, height]: Part) -> Vec<u8> {
    let line = |y: u32| {
        let start = 4 * (y * picture.width() + left) as usize;
        &picture.data()[start..start + 4 * width as usize]
    };
    let mut colours = Vec::with_capacity(3 * (width * height) as usize);
    for pixel in (top..top + height).flat_map(|y| line(y).chunks_exact(4)) {
        colours.extend_from_slice(&pixel[..3]);
    }
    colours
}

/// Writes pictures of a size as a PNG. Their colours are few and repeat: without a filter they take less room and half the time.
pub(super) fn encoder<'a>(
    bytes: &'a mut Vec<u8>,
    picture: &Pixmap,
) -> Encoder<'a, &'a mut Vec<u8>> {
    let mut encoder = Encoder::new(bytes, picture.width(), picture.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_filter(Filter::NoFilter);
    encoder
}

/// A picture as a PNG; for a look that is printed with its size on paper.
pub(super) fn encode(picture: &Pixmap, look: Option<Look>) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = encoder(&mut bytes, picture);
    if let Some(look) = look.filter(|look| look.is_printed()) {
        let on_a_metre = (f64::from(look.pixels()) * 1000.0 / look.millimetres()).round() as u32;
        encoder.set_pixel_dims(Some(PixelDimensions {
            xppu: on_a_metre,
            yppu: on_a_metre,
            unit: Unit::Meter,
        }));
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&colours(picture, full(picture)))?;
    writer.finish()?;
    Ok(bytes)
}
