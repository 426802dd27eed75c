//! Pixels as PNG files.

use png::{BitDepth, ColorType, Encoder, EncodingError, Filter};
use resvg::tiny_skia::Pixmap;

/// A part of a picture: left, top, width, height in pixels.
pub(super) type Part = [u32; 4];

/// All of a picture.
pub(super) fn whole(picture: &Pixmap) -> Part {
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

/// A picture as a PNG.
pub(super) fn encode(picture: &Pixmap) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut writer = encoder(&mut bytes, picture).write_header()?;
    writer.write_image_data(&colours(picture, whole(picture)))?;
    writer.finish()?;
    Ok(bytes)
}
