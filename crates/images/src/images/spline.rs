//! The cubic B-spline through the pixels of an image.
//!
//! ```text
//! I(x, y) = Σ c(i, j) β(x − i) β(y − j)        β: cubic B-spline, I(i, j) = the pixel's value
//! ```
//!
//! The coefficients c follow from the values by two recursions along each axis (M. Unser, IEEE Signal Process. Mag. 16, 22 (1999)).

use std::sync::OnceLock;

use rayon::prelude::*;

use super::filter::mirrored;
use super::grey::GreyImage;

/// The pole of the cubic B-spline, √3 − 2.
const POLE: f32 = -0.267_949_2;

/// Distance in pixels beyond which a value does not change a coefficient, to the precision of the latter.
const REACH: usize = 14;

/// Rows and columns of coefficients before the first pixel and behind the last one.
const BEFORE: usize = 1;
const BEHIND: usize = 2;

/// The cubic B-spline through the pixels of an image.
#[derive(Clone, Debug)]
pub struct Spline {
    width: usize,
    height: usize,
    stride: usize,
    coefficients: Vec<f32>,
}

/// The recursions from row to row, in all columns at the same time.
fn along_rows(values: &mut [f32], width: usize) {
    let height = values.len() / width;
    let combine = |values: &mut [f32], from: usize, to: usize, sign: f32| {
        for x in 0..width {
            let other = values[from * width + x];
            let target = &mut values[to * width + x];
            *target = if sign > 0.0 {
                *target + POLE * other
            } else {
                POLE * (other - *target)
            };
        }
    };
    if height < 2 {
        return;
    }
    values.iter_mut().for_each(|value| *value *= 6.0);
    // c⁺(0) = Σ zᵏ s(k), mirrored.
    let reach = REACH.min(height - 1);
    let first: Vec<f32> = (0..width)
        .map(|x| {
            (0..=reach)
                .map(|k| POLE.powi(k as i32) * values[k * width + x])
                .sum()
        })
        .collect();
    values[..width].copy_from_slice(&first);
    (1..height).for_each(|y| combine(values, y - 1, y, 1.0));
    let last = (height - 1) * width;
    for x in 0..width {
        let (end, before) = (values[last + x], values[last - width + x]);
        values[last + x] = POLE / (POLE * POLE - 1.0) * (end + POLE * before);
    }
    (0..height - 1)
        .rev()
        .for_each(|y| combine(values, y + 1, y, -1.0));
}

fn transposed(values: &[f32], width: usize) -> Vec<f32> {
    let height = values.len() / width;
    let mut turned = vec![0.0; values.len()];
    turned
        .par_chunks_mut(height)
        .enumerate()
        .for_each(|(x, out)| {
            for (y, out) in out.iter_mut().enumerate() {
                *out = values[y * width + x];
            }
        });
    turned
}

/// The values of the four B-splines that are not zero at a distance t from 0 to 1 behind the second one's middle.
#[inline]
fn weights(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    let (t2, s2) = (t * t, s * s);
    [
        s2 * s / 6.0,
        2.0 / 3.0 - 0.5 * t2 * (2.0 - t),
        2.0 / 3.0 - 0.5 * s2 * (2.0 - s),
        t2 * t / 6.0,
    ]
}

impl Spline {
    /// Through the pixels of an image.
    pub fn new(image: &GreyImage) -> Self {
        let [width, height] = image.size();
        let mut values = image.values().to_vec();
        along_rows(&mut values, width);
        let mut turned = transposed(&values, width);
        along_rows(&mut turned, height);
        let values = transposed(&turned, height);
        let stride = width + BEFORE + BEHIND;
        let pixel =
            |index: usize, length: usize| mirrored(index as isize - BEFORE as isize, length);
        let mut coefficients = vec![0.0; stride * (height + BEFORE + BEHIND)];
        coefficients
            .par_chunks_mut(stride)
            .enumerate()
            .for_each(|(y, row)| {
                let from = &values[pixel(y, height) * width..];
                row.iter_mut()
                    .enumerate()
                    .for_each(|(x, out)| *out = from[pixel(x, width)]);
            });
        Self {
            width,
            height,
            stride,
            coefficients,
        }
    }

    /// The value at a position; `None` outside of the pixels' centres.
    #[inline]
    pub fn value(&self, x: f64, y: f64) -> Option<f32> {
        let inside =
            x >= 0.0 && y >= 0.0 && x <= (self.width - 1) as f64 && y <= (self.height - 1) as f64;
        if !inside {
            return None;
        }
        let (column, row) = (x as usize, y as usize);
        let across = weights((x - column as f64) as f32);
        let down = weights((y - row as f64) as f32);
        let start = row * self.stride + column;
        let mut columns = [0.0; 4];
        for (k, weight) in down.iter().enumerate() {
            let line = &self.coefficients[start + k * self.stride..][..4];
            for (sum, coefficient) in columns.iter_mut().zip(line) {
                *sum += weight * coefficient;
            }
        }
        Some(
            columns
                .iter()
                .zip(across)
                .map(|(sum, weight)| sum * weight)
                .sum(),
        )
    }

    /// ∂I/∂x and ∂I/∂y at all pixels, in grey values per pixel.
    pub fn gradients(&self) -> [GreyImage; 2] {
        let stride = self.stride;
        let derivative = |step: usize, other: usize| {
            let mut values = vec![0.0; self.width * self.height];
            values
                .par_chunks_mut(self.width)
                .enumerate()
                .for_each(|(y, row)| {
                    for (x, out) in row.iter_mut().enumerate() {
                        let at = (y + BEFORE) * stride + x + BEFORE;
                        let slope =
                            |at: usize| self.coefficients[at + step] - self.coefficients[at - step];
                        *out = (slope(at - other) + 4.0 * slope(at) + slope(at + other)) / 12.0;
                    }
                });
            GreyImage::new(self.width, self.height, values)
        };
        [derivative(1, stride), derivative(stride, 1)]
    }

    /// The variance of the value at a position, relative to that of the pixels' white noise: 1 at a pixel, less between pixels.
    pub fn noise_gain(x: f64, y: f64) -> f64 {
        const STEPS: usize = 32;
        static TABLE: OnceLock<Vec<f64>> = OnceLock::new();
        let table = TABLE.get_or_init(|| {
            const LENGTH: usize = 41;
            // The response to one pixel along one axis; the columns are alike.
            let pulse = GreyImage::of(LENGTH, 3, |x, _| f32::from(u8::from(x == LENGTH / 2)));
            let spline = Spline::new(&pulse);
            let gain = |step: usize| {
                let values = (1..LENGTH - 2)
                    .map(|x| spline.value(x as f64 + step as f64 / STEPS as f64, 1.0));
                values
                    .map(|value| f64::from(value.unwrap_or(0.0)).powi(2))
                    .sum()
            };
            (0..=STEPS).map(gain).collect()
        });
        let gain = |x: f64| table[((x - x.floor()) * STEPS as f64).round() as usize];
        gain(x) * gain(y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(x: f64, y: f64) -> f64 {
        100.0
            + 40.0 * (0.5 * x + 0.2).sin() * (0.4 * y - 0.1).cos()
            + 10.0 * (0.3 * x + 0.6 * y).sin()
    }

    #[test]
    fn the_spline_passes_through_the_pixels_and_waves_between_them() {
        let image = GreyImage::of(60, 50, |x, y| waves(x as f64, y as f64) as f32);
        let spline = Spline::new(&image);
        for (x, y) in [(0, 0), (59, 49), (17, 20), (0, 30)] {
            let value = spline.value(x as f64, y as f64).unwrap();
            assert!((value - image.value(x, y)).abs() < 1e-3, "{x} {y}: {value}");
        }
        for (x, y) in [(20.5, 20.5), (30.25, 15.7), (12.9, 33.3)] {
            let value = f64::from(spline.value(x, y).unwrap());
            assert!((value - waves(x, y)).abs() < 0.05, "{x} {y}: {value}");
        }
        assert_eq!(spline.value(59.01, 10.0), None);
        assert_eq!(spline.value(10.0, -0.01), None);
    }

    #[test]
    fn the_gradients_are_those_of_the_waves() {
        let image = GreyImage::of(60, 50, |x, y| waves(x as f64, y as f64) as f32);
        let [along, down] = Spline::new(&image).gradients();
        let step = 1e-5;
        for (x, y) in [(20_usize, 21_usize), (33, 14)] {
            let (a, b) = (x as f64, y as f64);
            let slope_x = (waves(a + step, b) - waves(a - step, b)) / (2.0 * step);
            let slope_y = (waves(a, b + step) - waves(a, b - step)) / (2.0 * step);
            assert!((f64::from(along.value(x, y)) - slope_x).abs() < 0.05);
            assert!((f64::from(down.value(x, y)) - slope_y).abs() < 0.05);
        }
    }

    #[test]
    fn noise_is_smoothed_between_pixels() {
        assert!((Spline::noise_gain(3.0, 5.0) - 1.0).abs() < 1e-4);
        let middle = Spline::noise_gain(3.5, 5.0);
        // Σ η(k + ½)² of the cardinal cubic spline η.
        assert!((middle - 0.7).abs() < 0.1, "{middle}");
    }
}
