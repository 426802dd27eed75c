//! Separable filters, with the image mirrored at its rim.

use rayon::prelude::*;

use super::grey::GreyImage;

/// The index of the value that stands at an index outside of a line, where the line is mirrored at its ends.
pub fn mirrored(index: isize, length: usize) -> usize {
    let last = length as isize - 1;
    if last <= 0 {
        return 0;
    }
    let folded = index.rem_euclid(2 * last);
    folded.min(2 * last - folded) as usize
}

/// An image filtered with symmetric weights along x and along y: `half[0]` is the weight in the middle.
pub fn symmetric(image: &GreyImage, half: &[f32]) -> GreyImage {
    let [width, height] = image.size();
    let reach = half.len() - 1;
    let row = |values: &[f32], out: &mut [f32]| {
        let at = |x: usize| values[mirrored(x as isize - reach as isize, width)];
        let padded: Vec<f32> = (0..width + 2 * reach).map(at).collect();
        for (shift, weight) in shifts(half) {
            let from = reach.saturating_add_signed(shift);
            add_scaled(out, weight, &padded[from..from + width]);
        }
    };
    let mut along = vec![0.0; width * height];
    let rows = along
        .par_chunks_mut(width)
        .zip(image.values().par_chunks(width));
    rows.for_each(|(out, values)| row(values, out));
    let mut both = vec![0.0; width * height];
    both.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (shift, weight) in shifts(half) {
            let from = mirrored(y as isize + shift, height) * width;
            add_scaled(out, weight, &along[from..from + width]);
        }
    });
    GreyImage::new(width, height, both)
}

/// The shifts 0, −1, 1, −2, 2 … with their weights.
fn shifts(half: &[f32]) -> impl Iterator<Item = (isize, f32)> {
    let both = |(k, weight): (isize, &f32)| {
        let weight = *weight;
        let sides = [-k, k].into_iter().skip(usize::from(k == 0));
        sides.map(move |shift| (shift, weight))
    };
    (0..).zip(half).flat_map(both)
}

fn add_scaled(out: &mut [f32], weight: f32, values: &[f32]) {
    out.iter_mut()
        .zip(values)
        .for_each(|(out, value)| *out += weight * value);
}

/// The weights of a Gaussian of a standard deviation in pixels, which sum to 1 over both sides.
pub fn gaussian(deviation: f64) -> Vec<f32> {
    let reach = (4.0 * deviation).ceil() as usize;
    let weight = |k: usize| (-0.5 * (k as f64 / deviation).powi(2)).exp();
    let sum = weight(0) + 2.0 * (1..=reach).map(weight).sum::<f64>();
    (0..=reach).map(|k| (weight(k) / sum) as f32).collect()
}
