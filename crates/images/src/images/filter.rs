//! Separable filters, with the image mirrored at its rim.

use rayon::prelude::*;

use super::grey::GreyImage;

/// The place of a mirrored index.
fn mirrored(index: isize, length: usize) -> usize {
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
        for (k, weight) in half.iter().enumerate() {
            let sides = if k == 0 {
                vec![reach]
            } else {
                vec![reach - k, reach + k]
            };
            for side in sides {
                add(out, *weight, &padded[side..side + width]);
            }
        }
    };
    let mut along = vec![0.0; width * height];
    let rows = along
        .par_chunks_mut(width)
        .zip(image.values().par_chunks(width));
    rows.for_each(|(out, values)| row(values, out));
    let mut both = vec![0.0; width * height];
    both.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for (k, weight) in half.iter().enumerate() {
            let (y, k) = (y as isize, k as isize);
            let sides = if k == 0 { vec![y] } else { vec![y - k, y + k] };
            for side in sides {
                let from = mirrored(side, height) * width;
                add(out, *weight, &along[from..from + width]);
            }
        }
    });
    GreyImage::new(width, height, both)
}

fn add(out: &mut [f32], weight: f32, values: &[f32]) {
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
