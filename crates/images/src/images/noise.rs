//! The noise of pixels, which grows with the intensity where photons are counted.

use super::grey::GreyImage;

/// Var(I) = base + growth · I, in grey values squared.
///
/// The base is the noise of the electronics and of rounding, the growth that of photons (EMVA Standard 1288).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// The variance at zero intensity.
    pub base: f64,
    /// Its growth with each grey value.
    pub growth: f64,
}

/// The variance of rounding to whole grey values.
const ROUNDING: f64 = 1.0 / 12.0;

/// Width of the blocks of pixels from which the noise of an image alone is estimated.
const BLOCK: usize = 8;

/// Sums of squares over classes of intensity.
#[derive(Clone, Debug)]
pub(super) struct Classes {
    width: f64,
    classes: Vec<[f64; 3]>,
}

impl Classes {
    const COUNT: usize = 16;

    pub fn new(white: f32) -> Self {
        Self {
            width: f64::from(white.max(1.0)) / Self::COUNT as f64,
            classes: vec![[0.0; 3]; Self::COUNT],
        }
    }

    /// Adds the square of a residual whose variance is that of one pixel.
    pub fn add(&mut self, intensity: f64, square: f64) {
        let class = (intensity / self.width).max(0.0) as usize;
        let [count, intensities, squares] = &mut self.classes[class.min(Self::COUNT - 1)];
        (*count, *intensities, *squares) =
            (*count + 1.0, *intensities + intensity, *squares + square);
    }

    pub fn join(mut self, other: &Self) -> Self {
        let classes = self.classes.iter_mut().flatten();
        classes
            .zip(other.classes.iter().flatten())
            .for_each(|(class, other)| *class += other);
        self
    }

    /// The line through the mean squares, each weighted by its precision.
    pub fn noise(&self) -> Option<Noise> {
        let means: Vec<[f64; 3]> = self
            .classes
            .iter()
            .filter(|[count, ..]| *count >= 30.0)
            .map(|[n, i, s]| [*n, i / n, (s / n).max(1e-12)])
            .collect();
        let total: f64 = means.iter().map(|[n, ..]| n).sum();
        if means.is_empty() {
            return None;
        }
        let level = means.iter().map(|[n, _, s]| n * s).sum::<f64>() / total;
        let constant = Noise {
            base: level,
            growth: 0.0,
        };
        // The variance of a mean square is 2 s²/n; s itself must not weigh, or low squares would win.
        let mut line = constant;
        for _ in 0..5 {
            let weighted = means
                .iter()
                .map(|[n, i, s]| (n / line.variance(*i).powi(2), *i, *s));
            let sums = weighted.fold([0.0; 5], |[w, wi, wii, ws, wis], (weight, i, s)| {
                let (a, b) = (weight * i, weight * s);
                [w + weight, wi + a, wii + a * i, ws + b, wis + b * i]
            });
            let [w, wi, wii, ws, wis] = sums;
            let determinant = w * wii - wi * wi;
            let growth = (w * wis - wi * ws) / determinant;
            let base = (ws - growth * wi) / w;
            if determinant <= 1e-9 * w * wii || growth <= 0.0 || !growth.is_finite() {
                return Some(constant);
            }
            line = if base > 0.0 {
                Noise { base, growth }
            } else {
                Noise {
                    base: 0.0,
                    growth: wis / wii,
                }
            };
        }
        Some(line)
    }
}

impl Noise {
    /// The variance of a pixel of an intensity; at least that of rounding.
    pub fn variance(&self, intensity: f64) -> f64 {
        (self.base + self.growth * intensity.max(0.0)).max(ROUNDING)
    }

    /// A first estimate from an image alone, by the second differences across the least structured tenth of blocks: too large where the
    /// pattern is fine, and a fifth too small where there is none (J. Immerkær, Comput. Vis. Image Underst. 64, 300 (1996)).
    ///
    /// ```text
    /// N = [1 −2 1; −2 4 −2; 1 −2 1] ∗ I,   Var(N) = 36 Var(I)
    /// ```
    pub fn of_image(image: &GreyImage, usable: &[bool]) -> Self {
        let [width, height] = image.size();
        let square = |x: usize, y: usize| {
            let [a, b, c, d, e, f, g, h] = image.around(x, y);
            let response = a + c + f + h - 2.0 * (b + d + e + g) + 4.0 * image.value(x, y);
            f64::from(response).powi(2) / 36.0
        };
        let mut blocks = Vec::new();
        for y in (1..height.saturating_sub(BLOCK)).step_by(BLOCK) {
            for x in (1..width.saturating_sub(BLOCK)).step_by(BLOCK) {
                let pixels = (0..BLOCK * BLOCK).map(|k| (x + k % BLOCK, y + k / BLOCK));
                if pixels.clone().all(|(x, y)| usable[y * width + x]) {
                    let sum: f64 = pixels.map(|(x, y)| square(x, y)).sum();
                    blocks.push(sum / (BLOCK * BLOCK) as f64);
                }
            }
        }
        blocks.sort_by(f64::total_cmp);
        let least = blocks.get(blocks.len() / 10).copied();
        Self {
            base: least.unwrap_or(ROUNDING).max(ROUNDING),
            growth: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gelbench_base::statistics::normal_numbers;

    #[test]
    fn noise_and_its_growth_are_found_from_residuals() {
        let truth = Noise {
            base: 4.0,
            growth: 0.2,
        };
        let mut normal = normal_numbers(1);
        let mut classes = Classes::new(255.0);
        for k in 0..100_000 {
            let intensity = 20.0 + f64::from(k % 200);
            let value = normal();
            classes.add(intensity, truth.variance(intensity) * value * value);
        }
        let estimate = classes.noise().unwrap();
        assert!(
            (estimate.base / truth.base - 1.0).abs() < 0.2,
            "{estimate:?}"
        );
        assert!(
            (estimate.growth / truth.growth - 1.0).abs() < 0.05,
            "{estimate:?}"
        );
    }

    #[test]
    fn the_noise_of_a_smooth_image_is_found_from_it_alone() {
        let mut normal = normal_numbers(2);
        let mut image = GreyImage::of(200, 200, |x, y| {
            100.0 + 50.0 * (0.2 * x as f32).sin() * (0.15 * y as f32).cos()
        });
        for value in image.values_mut() {
            *value += 3.0 * normal() as f32;
        }
        let deviation = Noise::of_image(&image, &vec![true; 40_000])
            .variance(100.0)
            .sqrt();
        assert!((deviation / 3.0 - 1.0).abs() < 0.25, "{deviation}");
    }
}
