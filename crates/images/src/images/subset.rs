//! A subset of the first image, and where it is found in another one.
//!
//! With J = ĝ φ (two entries for each function φ), freed of what gain and offset could explain, J⊥ = J − J̄ − Ĩ (Ĩ·J)/(Ĩ·Ĩ),
//!
//! ```text
//! q = A⁻¹ Σ J⊥ (I₀ − b I₁(X + u)),   A = Σ J⊥ (g φ)ᵀ − v ⟨k̂, k⟩ Σ φφᵀ,   p ← p + F q,   until Σ J⊥ I₁(X + u) = 0
//! ```
//!
//! A belongs to the first image and is factorised once, as F carries a displacement there into one in the other image (the inverse
//! composition of Baker and Matthews, to first order). The covariance of the displacement is
//!
//! ```text
//! Cov(p₀) = F [A⁻¹ Σ J⊥J⊥ᵀ A⁻ᵀ]₀₀ Fᵀ (v(I₀) + b² v(I₁) max(1, 1/det F))
//! ```
//!
//! where 1/det F counts that fewer pixels of a compressed image are behind as many values.

use nalgebra::{DVector, Matrix2, Vector2};

use super::gradient::Reference;
use super::matrices::{Matrices, Pixel};
use super::noise::{Classes, Noise};
use super::spline::Spline;
use super::warp::{DEGREES, Order, Warp, functions};

/// A subset of the first image, with the noise of both images.
#[derive(Clone, Debug)]
pub struct Subset {
    centre: [f64; 2],
    count: usize,
    half: f64,
    overlap: f64,
    noise: Noise,
    pixels: Vec<Pixel>,
    /// The number of pixels before any was carried out of an image.
    full_count: usize,
    matrices: Matrices,
}

/// Where a subset was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The displacement in the subset.
    pub warp: Warp,
    /// Covariance of the displacement at the centre in pixels².
    pub covariance: Matrix2<f64>,
    /// The squared correlation with the noise taken out: 1 where the pattern is the same.
    pub similarity: f64,
    /// b.
    pub gain: f64,
    /// a.
    pub offset: f64,
    /// The mean square of I₀ − a − b I₁.
    pub misfit: f64,
}

/// The least share of a subset's pixels that must be inside of the other image.
const LEAST_SHARE: f64 = 0.5;

/// Sums over the pixels with values of the other image.
#[derive(Default)]
struct Sums {
    count: f64,
    products: [f64; 12],
    value: f64,
    square: f64,
    product: f64,
}

impl Subset {
    /// The usable pixels of a square of 2 half + 1 pixels about a pixel. `None` where fewer than half of them are usable, or where the pattern
    /// does not determine the displacement.
    pub fn new(
        reference: &Reference,
        centre: [usize; 2],
        half: usize,
        order: Order,
    ) -> Option<Self> {
        Self::of_square(reference, centre, 2 * half + 1, order.functions())
    }

    /// A square of `width` pixels of which the displacement alone is unknown, its gradient known. Squares whose centres are `width` apart
    /// share no pixel.
    pub fn patch(reference: &Reference, centre: [usize; 2], width: usize) -> Option<Self> {
        Self::of_square(reference, centre, width, 1)
    }

    fn of_square(
        reference: &Reference,
        centre: [usize; 2],
        width: usize,
        count: usize,
    ) -> Option<Self> {
        let size = reference.image.size();
        let [columns, rows] = [0, 1].map(|axis| {
            let from = centre[axis].saturating_sub(width / 2);
            from..(centre[axis] + width - width / 2).min(size[axis])
        });
        let mut pixels = Vec::with_capacity(width * width);
        for row in rows {
            for column in columns.clone() {
                let at = row * size[0] + column;
                if reference.usable[at] {
                    pixels.push(Pixel {
                        x: column as f32 - centre[0] as f32,
                        y: row as f32 - centre[1] as f32,
                        value: reference.image.values()[at],
                        smooth: [0, 1].map(|axis| reference.smooth[axis].values()[at]),
                        slope: [0, 1].map(|axis| reference.gradient[axis].values()[at]),
                    });
                }
            }
        }
        if (pixels.len() as f64) < LEAST_SHARE * (width * width) as f64 {
            return None;
        }
        let half = (width / 2).max(1) as f64;
        Some(Self {
            matrices: Matrices::new(&pixels, half, count, reference.overlap, &reference.noise)?,
            centre: centre.map(|c| c as f64),
            count,
            half,
            overlap: reference.overlap,
            noise: reference.noise,
            full_count: pixels.len(),
            pixels,
        })
    }

    /// The mean of the pixels' positions in pixels.
    pub fn middle(&self) -> [f64; 2] {
        let count = self.pixels.len() as f64;
        let mean = |part: fn(&Pixel) -> f32| {
            let parts = self.pixels.iter().map(|pixel| f64::from(part(pixel)));
            parts.sum::<f64>() / count
        };
        [
            self.centre[0] + mean(|pixel| pixel.x),
            self.centre[1] + mean(|pixel| pixel.y),
        ]
    }

    /// The root mean square of both components' standard deviations that an image of the same noise would give without deformation, in pixels.
    pub fn expected_deviation(&self) -> f64 {
        let mean = self.matrices.value / self.pixels.len() as f64;
        let covariance = self.covariance(Matrix2::identity(), 1.0, mean);
        (0.5 * covariance.trace()).sqrt()
    }

    fn covariance(&self, f: Matrix2<f64>, gain: f64, other: f64) -> Matrix2<f64> {
        let Matrices {
            step,
            spread,
            value,
            ..
        } = &self.matrices;
        let solved = step.solve(spread);
        let both = step.solve(&solved.transpose());
        let block = Matrix2::new(both[(0, 0)], both[(0, 1)], both[(1, 0)], both[(1, 1)]);
        let variance = self.noise.variance(value / self.pixels.len() as f64);
        let other = gain * gain * self.noise.variance(other) * (1.0 / f.determinant()).max(1.0);
        f * (0.5 * (block + block.transpose())) * f.transpose() * (variance + other)
    }

    /// Finds the subset in another image from a first guess; `None` where it does not converge within the image.
    pub fn find(mut self, image: &Spline, guess: Warp) -> Option<Match> {
        const MOST: usize = 40;
        /// Pixels.
        const SMALL: f64 = 1e-3;
        let mut warp = guess;
        for _ in 0..MOST {
            let (sums, length) = self.improve(image, &mut warp)?;
            if length < SMALL {
                return Some(self.concluded(&sums, &warp, warp));
            }
        }
        None
    }

    /// One step of [`Self::find`]: the displacement by the images' misfit linearised about a guess, for patches whose noise would lead a search
    /// astray.
    pub fn find_linear(mut self, image: &Spline, guess: Warp) -> Option<Match> {
        let mut warp = guess;
        let (sums, _) = self.improve(image, &mut warp)?;
        Some(self.concluded(&sums, &guess, warp))
    }

    /// Takes one step; gives the sums before it and its length in pixels. `None` where it leads too far.
    fn improve(&mut self, image: &Spline, warp: &mut Warp) -> Option<(Sums, f64)> {
        let sums = self.sums_inside(image, warp)?;
        let f = warp.deformation_gradient();
        let q = self.step(&sums);
        let mut largest = 0.0_f64;
        for k in 0..self.count {
            let scale = self.half.powi(-DEGREES[k]);
            let change = f * Vector2::new(q[2 * k], q[2 * k + 1]);
            largest += change.norm();
            warp.terms[k][0] += change.x * scale;
            warp.terms[k][1] += change.y * scale;
        }
        let sound = largest.is_finite() && warp.deformation_gradient().determinant() > 0.05;
        (sound && largest <= 2.0 * self.half).then_some((sums, largest))
    }

    /// The sums about a field without the pixels that it carries out of the image; `None` where these are most.
    fn sums_inside(&mut self, image: &Spline, warp: &Warp) -> Option<Sums> {
        loop {
            match self.sums(image, warp) {
                Ok(sums) => return Some(sums),
                Err(inside) => {
                    if (inside.len() as f64) < LEAST_SHARE * self.full_count as f64 {
                        return None;
                    }
                    self.matrices =
                        Matrices::new(&inside, self.half, self.count, self.overlap, &self.noise)?;
                    self.pixels = inside;
                }
            }
        }
    }

    /// The sums, or the pixels that are inside of the image where some are not.
    fn sums(&self, image: &Spline, warp: &Warp) -> Result<Sums, Vec<Pixel>> {
        let mut sums = Sums {
            count: self.pixels.len() as f64,
            ..Sums::default()
        };
        let (scale, functions_of_warp) = (1.0 / self.half, warp.functions());
        let mut outside = Vec::new();
        for (index, pixel) in self.pixels.iter().enumerate() {
            let (x, y) = (f64::from(pixel.x), f64::from(pixel.y));
            let [u, v] = warp.at(x, y, functions_of_warp);
            let Some(value) = image.value(self.centre[0] + x + u, self.centre[1] + y + v) else {
                outside.push(index);
                continue;
            };
            let value = f64::from(value);
            let phi = functions(x * scale, y * scale);
            let weighted = pixel.smooth.map(|slope| f64::from(slope) * value);
            for (sum, phi) in sums.products.chunks_exact_mut(2).zip(&phi).take(self.count) {
                sum[0] += phi * weighted[0];
                sum[1] += phi * weighted[1];
            }
            sums.value += value;
            sums.square += value * value;
            sums.product += value * f64::from(pixel.value);
        }
        if outside.is_empty() {
            return Ok(sums);
        }
        let inside = (0..self.pixels.len()).filter(|index| outside.binary_search(index).is_err());
        Err(inside.map(|index| self.pixels[index]).collect())
    }

    /// Variances of both images without noise, and their covariance.
    fn moments(&self, sums: &Sums) -> [f64; 3] {
        let noise = &self.noise;
        let Matrices { value, square, .. } = &self.matrices;
        let (mean, other) = (value / sums.count, sums.value / sums.count);
        let first = square / sums.count - mean * mean - noise.variance(mean);
        let gain = Spline::noise_gain(0.5, 0.0);
        let second = sums.square / sums.count - other * other - gain * noise.variance(other);
        [first, second, sums.product / sums.count - mean * other]
    }

    /// b, with the variance of the other image's noise taken out.
    fn gain(&self, sums: &Sums) -> f64 {
        let [first, second, product] = self.moments(sums);
        let gain = product / second;
        if second > 0.0 && gain > 0.0 && gain.is_finite() {
            gain
        } else {
            (first / second).abs().sqrt().clamp(0.1, 10.0)
        }
    }

    /// q.
    fn step(&self, sums: &Sums) -> DVector<f64> {
        let Matrices {
            step,
            sum,
            weighted,
            value,
            square,
            ..
        } = &self.matrices;
        let mean = value / sums.count;
        let variation = square - value * mean;
        let other = sums.product - mean * sums.value;
        let products =
            DVector::from_iterator(sum.len(), sums.products[..sum.len()].iter().copied());
        // Σ J⊥ I₁
        let residual = products - sum * (sums.value / sums.count) - weighted * (other / variation);
        step.solve(&(residual * -self.gain(sums)))
    }

    /// The match at a field `warp`, with the covariance and similarity of the sums about the field `about`.
    fn concluded(&self, sums: &Sums, about: &Warp, warp: Warp) -> Match {
        let Matrices { value, square, .. } = &self.matrices;
        let [first, second, product] = self.moments(sums);
        let gain = self.gain(sums);
        let (mean, other) = (value / sums.count, sums.value / sums.count);
        let similarity = if first > 0.0 && second > 0.0 && product > 0.0 {
            product * product / (first * second)
        } else {
            0.0
        };
        let [mean_square, other_square] = [
            square / sums.count - mean * mean,
            sums.square / sums.count - other * other,
        ];
        Match {
            warp,
            covariance: self.covariance(about.deformation_gradient(), gain, other),
            similarity,
            gain,
            offset: mean - gain * other,
            misfit: mean_square - 2.0 * gain * product + gain * gain * other_square,
        }
    }

    /// Adds the squares of the residuals, each divided by the variance that a pixel of unit variance gives it.
    pub(super) fn classify(&self, image: &Spline, fit: &Match, classes: &mut Classes) {
        let count = fit.warp.functions();
        for pixel in &self.pixels {
            let (x, y) = (f64::from(pixel.x), f64::from(pixel.y));
            let [u, v] = fit.warp.at(x, y, count);
            let [x, y] = [self.centre[0] + x + u, self.centre[1] + y + v];
            if let Some(value) = image.value(x, y) {
                let intensity = f64::from(pixel.value);
                let residual = intensity - fit.offset - fit.gain * f64::from(value);
                let gain = 1.0 + fit.gain.powi(2) * Spline::noise_gain(x, y);
                classes.add(intensity, residual * residual / gain);
            }
        }
    }
}
