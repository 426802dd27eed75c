//! Images of half the size, a quarter, and so on.

use super::filter::symmetric;
use super::grey::GreyImage;

/// The binomial filter before each halving (P. Burt, E. Adelson, IEEE Trans. Commun. 31, 532 (1983)).
const BINOMIAL: [f32; 3] = [6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// An image of half the size: pixel (x, y) of it is pixel (2x, 2y).
pub fn halved(image: &GreyImage) -> GreyImage {
    let smooth = symmetric(image, &BINOMIAL);
    let [width, height] = image.size().map(|length| length.div_ceil(2));
    GreyImage::of(width, height, |x, y| smooth.value(2 * x, 2 * y))
}

/// Every second flag.
pub fn halved_flags(flags: &[bool], [width, height]: [usize; 2]) -> Vec<bool> {
    let rows = (0..height).step_by(2);
    rows.flat_map(|y| (0..width).step_by(2).map(move |x| flags[y * width + x]))
        .collect()
}
