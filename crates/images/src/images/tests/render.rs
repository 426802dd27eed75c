//! A camera that shares nothing with the tracking: patterns are formulas, and a frame is what falls on its pixels.

use gelbench_base::statistics::normal_numbers;
use rayon::prelude::*;

use super::patterns::Pattern;
use crate::images::GreyImage;

/// A camera.
#[derive(Clone, Copy)]
pub struct Camera {
    pub size: [usize; 2],
    /// Standard deviation of the noise, relative to white; it grows with the root of the light if `photons`.
    pub noise: f64,
    pub photons: bool,
    /// Light at the left and at the right rim.
    pub light: [f64; 2],
    pub seed: u64,
}

impl Camera {
    pub fn new(size: [usize; 2], noise: f64, seed: u64) -> Self {
        Self {
            size,
            noise,
            photons: false,
            light: [1.0, 1.0],
            seed,
        }
    }

    /// A frame of 8 bit: `material` gives the material point that is seen at a position. Pixels integrate over their area by four points.
    pub fn frame(
        &self,
        pattern: &Pattern,
        material: impl Fn([f64; 2]) -> [f64; 2] + Sync,
    ) -> GreyImage {
        let [width, height] = self.size;
        let rows: Vec<Vec<f32>> = (0..height)
            .into_par_iter()
            .map(|row| {
                let mut normal = normal_numbers(self.seed * 1_000_003 + row as u64);
                let pixel = |column: usize| {
                    let parts = [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]];
                    let seen = parts
                        .iter()
                        .map(|[x, y]| pattern(material([column as f64 + x, row as f64 + y])));
                    let along = column as f64 / width as f64;
                    let light = self.light[0] * (1.0 - along) + self.light[1] * along;
                    let value = light * 0.25 * seen.sum::<f64>();
                    let noise = normal();
                    let size = if self.photons {
                        self.noise * value.max(0.0).sqrt()
                    } else {
                        self.noise
                    };
                    (255.0 * (value + size * noise)).round().clamp(0.0, 255.0) as f32
                };
                (0..width).map(pixel).collect()
            })
            .collect();
        GreyImage::new(width, height, rows.concat())
    }
}
