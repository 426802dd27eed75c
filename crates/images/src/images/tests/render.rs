//! A camera that shares nothing with the tracking: patterns are formulas, and a frame is what falls on its pixels.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use crate::images::GreyImage;

/// A pattern on the specimen: lightness from 0 to about 1 at each material point in pixels.
pub type Pattern = Box<dyn Fn([f64; 2]) -> f64 + Sync>;

/// Blobs of random places and sizes, about 4 pixels wide at half height.
pub fn speckle(seed: u64) -> Pattern {
    const CELL: f64 = 5.0;
    const COUNT: usize = 128;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut number = |low: f64, high: f64| random.random_range(low..high);
    let blobs: Vec<[f64; 4]> = (0..COUNT * COUNT)
        .map(|_| {
            [
                number(0.0, CELL),
                number(0.0, CELL),
                number(1.3, 2.1),
                number(0.4, 1.0),
            ]
        })
        .collect();
    Box::new(move |[x, y]| {
        let (column, row) = ((x / CELL).floor(), (y / CELL).floor());
        let mut sum = 0.0;
        for (i, j) in (-2..=2).flat_map(|j| (-2..=2).map(move |i| (f64::from(i), f64::from(j)))) {
            let wrap = |at: f64| at.rem_euclid(COUNT as f64) as usize;
            let [a, b, size, light] = blobs[wrap(row + j) * COUNT + wrap(column + i)];
            let (dx, dy) = (x - (column + i) * CELL - a, y - (row + j) * CELL - b);
            sum += light * (-(dx * dx + dy * dy) / (2.0 * size * size)).exp();
        }
        0.1 + 0.75 * sum.min(1.6) / 1.6
    })
}

/// Waves of all directions whose amplitude grows with their length, as in images of nature.
pub fn natural(seed: u64) -> Pattern {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let waves: Vec<[f64; 4]> = (0..120)
        .map(|_| {
            let length = 5.0 * 12.0_f64.powf(random.random::<f64>());
            let (angle, phase) = (
                random.random_range(0.0..std::f64::consts::TAU),
                random.random_range(0.0..std::f64::consts::TAU),
            );
            let k = std::f64::consts::TAU / length;
            [
                k * angle.cos(),
                k * angle.sin(),
                phase,
                0.012 * length.sqrt(),
            ]
        })
        .collect();
    Box::new(move |[x, y]| {
        0.5 + waves
            .iter()
            .map(|[a, b, c, d]| d * (a * x + b * y + c).sin())
            .sum::<f64>()
    })
}

/// Tags as in magnetic resonance: a lattice of dark lines.
pub fn tags(distance: f64) -> Pattern {
    Box::new(move |[x, y]| {
        let wave = |x: f64| (std::f64::consts::PI * x / distance).sin().abs();
        0.1 + 0.8 * (wave(x) * wave(y)).sqrt()
    })
}

/// A camera.
#[derive(Clone, Copy)]
pub struct Camera {
    pub size: [usize; 2],
    /// Standard deviation of the noise, relative to white; it grows with the root of the light if `photons`.
    pub noise: f64,
    pub photons: bool,
    /// Light at the left and at the right rim.
    pub light: [f64; 2],
    /// Whether values are rounded to 8 bit.
    pub rounded: bool,
    pub seed: u64,
}

impl Camera {
    pub fn new(size: [usize; 2], noise: f64, seed: u64) -> Self {
        Self {
            size,
            noise,
            photons: false,
            light: [1.0, 1.0],
            rounded: true,
            seed,
        }
    }

    /// A frame: `material` gives the material point that is seen at a place. Pixels integrate over their area by four points.
    pub fn frame(
        &self,
        pattern: &Pattern,
        material: impl Fn([f64; 2]) -> [f64; 2] + Sync,
    ) -> GreyImage {
        let [width, height] = self.size;
        let rows: Vec<Vec<f32>> = (0..height)
            .into_par_iter()
            .map(|row| {
                let mut random = ChaCha8Rng::seed_from_u64(self.seed * 1_000_003 + row as u64);
                let pixel = |column: usize| {
                    let parts = [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]];
                    let seen = parts
                        .iter()
                        .map(|[x, y]| pattern(material([column as f64 + x, row as f64 + y])));
                    let along = column as f64 / width as f64;
                    let light = self.light[0] * (1.0 - along) + self.light[1] * along;
                    let value = light * 0.25 * seen.sum::<f64>();
                    let noise: f64 = StandardNormal.sample(&mut random);
                    let size = if self.photons {
                        self.noise * value.max(0.0).sqrt()
                    } else {
                        self.noise
                    };
                    let value = 255.0 * (value + size * noise);
                    (if self.rounded {
                        value.round().clamp(0.0, 255.0)
                    } else {
                        value
                    }) as f32
                };
                (0..width).map(pixel).collect()
            })
            .collect();
        GreyImage::new(width, height, rows.concat())
    }
}
