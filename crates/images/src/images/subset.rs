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

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix2, Vector2};

use super::gradient::Reference;
use super::noise::{Classes, Noise};
use super::spline::Spline;
use super::warp::{DEGREES, Order, Warp, functions};

/// A pixel of a subset: distance from the centre, grey value, smoothed gradient and gradient.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    x: f32,
    y: f32,
    value: f32,
    smooth: [f32; 2],
    slope: [f32; 2],
}

/// A subset of the first image.
#[derive(Clone, Debug)]
pub struct Subset {
    centre: [f64; 2],
    count: usize,
    half: f64,
    overlap: f64,
    noise: Noise,
    pixels: Vec<Pixel>,
    matrices: Matrices,
}

/// What the pixels of a subset give once for all.
#[derive(Clone, Debug)]
struct Matrices {
    step: Cholesky<f64, Dyn>,
    spread: DMatrix<f64>,
    sum: DVector<f64>,
    weighted: DVector<f64>,
    value: f64,
    square: f64,
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
struct Sums {
    count: f64,
    products: [f64; 12],
    value: f64,
    square: f64,
    product: f64,
}

impl Subset {
    /// The usable pixels of a square of 2 half + 1 pixels about a pixel. `None` where fewer than `LEAST_SHARE` of them are usable, or where
    /// the pattern does not determine the displacement.
    pub fn new(
        reference: &Reference,
        centre: [usize; 2],
        half: usize,
        order: Order,
        noise: &Noise,
    ) -> Option<Self> {
        let [width, height] = reference.image.size();
        let [x, y] = centre;
        let mut pixels = Vec::with_capacity((2 * half + 1).pow(2));
        for row in y.saturating_sub(half)..=(y + half).min(height - 1) {
            for column in x.saturating_sub(half)..=(x + half).min(width - 1) {
                let at = row * width + column;
                if reference.usable[at] {
                    pixels.push(Pixel {
                        x: column as f32 - x as f32,
                        y: row as f32 - y as f32,
                        value: reference.image.values()[at],
                        smooth: [0, 1].map(|axis| reference.smooth[axis].values()[at]),
                        slope: [0, 1].map(|axis| reference.gradient[axis].values()[at]),
                    });
                }
            }
        }
        let whole = ((2 * half + 1) * (2 * half + 1)) as f64;
        if (pixels.len() as f64) < LEAST_SHARE * whole {
            return None;
        }
        let (half, count) = (half.max(1) as f64, order.functions());
        Self::of_pixels(
            pixels,
            centre.map(|c| c as f64),
            half,
            count,
            reference.overlap,
            *noise,
        )
    }

    fn of_pixels(
        pixels: Vec<Pixel>,
        centre: [f64; 2],
        half: f64,
        count: usize,
        overlap: f64,
        noise: Noise,
    ) -> Option<Self> {
        let matrices = Matrices::new(&pixels, half, count, overlap, &noise)?;
        Some(Self {
            centre,
            count,
            half,
            overlap,
            noise,
            pixels,
            matrices,
        })
    }

    /// The same pixels with the displacement alone unknown.
    pub fn translating(&self) -> Option<Self> {
        Self::of_pixels(
            self.pixels.clone(),
            self.centre,
            self.half,
            1,
            self.overlap,
            self.noise,
        )
    }

    /// The centre in pixels.
    pub fn centre(&self) -> [f64; 2] {
        self.centre
    }

    /// The mean of the pixels' places in pixels.
    pub fn middle(&self) -> [f64; 2] {
        let count = self.pixels.len() as f64;
        let sum = |part: fn(&Pixel) -> f32| {
            self.pixels
                .iter()
                .map(|pixel| f64::from(part(pixel)))
                .sum::<f64>()
                / count
        };
        [
            self.centre[0] + sum(|pixel| pixel.x),
            self.centre[1] + sum(|pixel| pixel.y),
        ]
    }

    /// The covariance of a displacement that an image of the same noise would have without deformation, in pixels².
    pub fn expected_covariance(&self) -> Matrix2<f64> {
        self.covariance(
            Matrix2::identity(),
            1.0,
            self.matrices.value / self.pixels.len() as f64,
            &self.noise,
        )
    }

    fn covariance(&self, f: Matrix2<f64>, gain: f64, other: f64, noise: &Noise) -> Matrix2<f64> {
        let Matrices {
            step,
            spread,
            value,
            ..
        } = &self.matrices;
        let left = step.solve(spread);
        let both = step.solve(&left.transpose());
        let block = Matrix2::new(both[(0, 0)], both[(0, 1)], both[(1, 0)], both[(1, 1)]);
        let own = noise.variance(value / self.pixels.len() as f64);
        let other = gain * gain * noise.variance(other) * (1.0 / f.determinant()).max(1.0);
        f * (0.5 * (block + block.transpose())) * f.transpose() * (own + other)
    }

    /// Finds the subset in another image from a first guess; `None` where it does not converge within the image.
    pub fn find(mut self, image: &Spline, guess: Warp, noise: &Noise) -> Option<Match> {
        const MOST: usize = 40;
        /// Pixels.
        const SMALL: f64 = 1e-3;
        let (mut warp, whole) = (guess, self.pixels.len() as f64);
        let count = self.count.max(3);
        for _ in 0..MOST {
            let place = |x: f64, y: f64| warp.at(x, y, count);
            let sums = loop {
                match self.sums(image, &place) {
                    Ok(sums) => break sums,
                    Err(inside) => {
                        if (inside.len() as f64) < LEAST_SHARE * whole {
                            return None;
                        }
                        self = Self::of_pixels(
                            inside,
                            self.centre,
                            self.half,
                            self.count,
                            self.overlap,
                            self.noise,
                        )?;
                    }
                }
            };
            let f = warp.deformation_gradient();
            let q = self.step(&sums, noise);
            let mut largest = 0.0_f64;
            for k in 0..self.count {
                let scale = self.half.powi(-DEGREES[k]);
                let change = f * Vector2::new(q[2 * k], q[2 * k + 1]);
                largest += change.norm();
                warp.terms[k][0] += change.x * scale;
                warp.terms[k][1] += change.y * scale;
            }
            let sound = largest.is_finite() && warp.deformation_gradient().determinant() > 0.05;
            if !sound || largest > 2.0 * self.half {
                return None;
            }
            if largest < SMALL {
                return self.found(image, warp, noise);
            }
        }
        None
    }

    /// Finds the shift of the subset beyond a displacement given at each of its pixels, whose gradient at the centre is F − 1. Returns the
    /// shift, its covariance and the match's figures.
    pub fn shift(
        mut self,
        image: &Spline,
        field: &dyn Fn([f64; 2]) -> Option<[f64; 2]>,
        f: Matrix2<f64>,
        noise: &Noise,
    ) -> Option<Match> {
        const MOST: usize = 40;
        const SMALL: f64 = 1e-3;
        let whole = self.pixels.len() as f64;
        let mut shift = [0.0; 2];
        let known: Vec<Option<[f64; 2]>> = self
            .pixels
            .iter()
            .map(|pixel| {
                field([
                    self.centre[0] + f64::from(pixel.x),
                    self.centre[1] + f64::from(pixel.y),
                ])
            })
            .collect();
        let mut places = known.into_iter();
        let mut displaced = Vec::new();
        self.pixels.retain(|_| match places.next().flatten() {
            Some(displacement) => {
                displaced.push(displacement);
                true
            }
            None => false,
        });
        self = Self::of_pixels(
            self.pixels,
            self.centre,
            self.half,
            1,
            self.overlap,
            self.noise,
        )?;
        for _ in 0..MOST {
            if (self.pixels.len() as f64) < LEAST_SHARE * whole {
                return None;
            }
            let mut order = displaced.iter();
            let sums = self.sums_of(image, |_, _| {
                let [x, y] = *order.next().unwrap_or(&[0.0; 2]);
                [x + shift[0], y + shift[1]]
            });
            let sums = sums.ok()?;
            let q = self.step(&sums, noise);
            let change = f * Vector2::new(q[0], q[1]);
            shift = [shift[0] + change.x, shift[1] + change.y];
            if !(change.norm() <= 2.0 * self.half) {
                return None;
            }
            if change.norm() < SMALL {
                let warp = Warp::affine(shift, f - Matrix2::identity());
                return self.concluded(&sums, warp, noise);
            }
        }
        None
    }

    fn sums(
        &self,
        image: &Spline,
        place: &dyn Fn(f64, f64) -> [f64; 2],
    ) -> Result<Sums, Vec<Pixel>> {
        self.sums_of(image, place)
    }

    /// The sums, or the pixels that are inside of the image where some are not.
    fn sums_of(
        &self,
        image: &Spline,
        mut place: impl FnMut(f64, f64) -> [f64; 2],
    ) -> Result<Sums, Vec<Pixel>> {
        let mut sums = Sums {
            count: self.pixels.len() as f64,
            products: [0.0; 12],
            value: 0.0,
            square: 0.0,
            product: 0.0,
        };
        let scale = 1.0 / self.half;
        let mut outside = false;
        let mut is_inside = vec![];
        for (index, pixel) in self.pixels.iter().enumerate() {
            let (x, y) = (f64::from(pixel.x), f64::from(pixel.y));
            let [u, v] = place(x, y);
            let Some(value) = image.value(self.centre[0] + x + u, self.centre[1] + y + v) else {
                if !outside {
                    is_inside = vec![true; self.pixels.len()];
                    outside = true;
                }
                is_inside[index] = false;
                continue;
            };
            let value = f64::from(value);
            let phi = functions(x * scale, y * scale);
            let weighted = pixel.smooth.map(|slope| f64::from(slope) * value);
            for k in 0..self.count {
                sums.products[2 * k] += phi[k] * weighted[0];
                sums.products[2 * k + 1] += phi[k] * weighted[1];
            }
            sums.value += value;
            sums.square += value * value;
            sums.product += value * f64::from(pixel.value);
        }
        if outside {
            let pixels = self.pixels.iter().zip(is_inside);
            return Err(pixels
                .filter(|(_, inside)| *inside)
                .map(|(pixel, _)| *pixel)
                .collect());
        }
        Ok(sums)
    }

    /// Variances of both images without noise, and their covariance.
    fn moments(&self, sums: &Sums, noise: &Noise) -> [f64; 3] {
        let Matrices { value, square, .. } = &self.matrices;
        let (own, other) = (value / sums.count, sums.value / sums.count);
        let first = square / sums.count - own * own - noise.variance(own);
        let gain = Spline::noise_gain(0.5, 0.0);
        let second = sums.square / sums.count - other * other - gain * noise.variance(other);
        [first, second, sums.product / sums.count - own * other]
    }

    /// b, with the variance of the other image's noise taken out.
    fn gain(&self, sums: &Sums, noise: &Noise) -> f64 {
        let [first, second, product] = self.moments(sums, noise);
        let gain = product / second;
        if second > 0.0 && gain > 0.0 && gain.is_finite() {
            gain
        } else {
            (first / second).abs().sqrt().clamp(0.1, 10.0)
        }
    }

    /// q.
    fn step(&self, sums: &Sums, noise: &Noise) -> DVector<f64> {
        let Matrices {
            step,
            sum,
            weighted,
            value,
            square,
            ..
        } = &self.matrices;
        let mean = value / sums.count;
        let own = square - value * mean;
        let other = sums.product - mean * sums.value;
        let products =
            DVector::from_iterator(sum.len(), sums.products[..sum.len()].iter().copied());
        // Σ J⊥ I₁
        let left = products - sum * (sums.value / sums.count) - weighted * (other / own);
        step.solve(&(left * -self.gain(sums, noise)))
    }

    fn found(&self, image: &Spline, warp: Warp, noise: &Noise) -> Option<Match> {
        let count = self.count.max(3);
        let sums = self.sums(image, &|x, y| warp.at(x, y, count)).ok()?;
        self.concluded(&sums, warp, noise)
    }

    fn concluded(&self, sums: &Sums, warp: Warp, noise: &Noise) -> Option<Match> {
        let Matrices { value, square, .. } = &self.matrices;
        let [first, second, product] = self.moments(sums, noise);
        let gain = self.gain(sums, noise);
        let (own, other) = (value / sums.count, sums.value / sums.count);
        let similarity = if first > 0.0 && second > 0.0 && product > 0.0 {
            product * product / (first * second)
        } else {
            0.0
        };
        let [own_square, other_square] = [
            square / sums.count - own * own,
            sums.square / sums.count - other * other,
        ];
        Some(Match {
            warp,
            covariance: self.covariance(warp.deformation_gradient(), gain, other, noise),
            similarity,
            gain,
            offset: own - gain * other,
            misfit: own_square - 2.0 * gain * product + gain * gain * other_square,
        })
    }

    /// Adds the squares of the residuals, each divided by the variance that a pixel of unit variance gives it.
    pub(super) fn classify(&self, image: &Spline, found: &Match, classes: &mut Classes) {
        let count = self.count.max(3);
        for pixel in &self.pixels {
            let (x, y) = (f64::from(pixel.x), f64::from(pixel.y));
            let [u, v] = found.warp.at(x, y, count);
            let [x, y] = [self.centre[0] + x + u, self.centre[1] + y + v];
            if let Some(value) = image.value(x, y) {
                let own = f64::from(pixel.value);
                let residual = own - found.offset - found.gain * f64::from(value);
                let gain = 1.0 + found.gain.powi(2) * Spline::noise_gain(x, y);
                classes.add(own, residual * residual / gain);
            }
        }
    }
}

impl Matrices {
    fn new(pixels: &[Pixel], half: f64, count: usize, overlap: f64, noise: &Noise) -> Option<Self> {
        let size = 2 * count;
        let (scale, number) = (1.0 / half, pixels.len() as f64);
        let mut step = DMatrix::zeros(size, size);
        let mut spread = DMatrix::zeros(size, size);
        let mut shapes: DMatrix<f64> = DMatrix::zeros(count, count);
        let [mut sum, mut weighted, mut slopes, mut slopes_weighted] =
            [(); 4].map(|()| DVector::zeros(size));
        let (mut value, mut square) = (0.0, 0.0);
        let mean = pixels
            .iter()
            .map(|pixel| f64::from(pixel.value))
            .sum::<f64>()
            / number;
        for pixel in pixels {
            let phi = functions(f64::from(pixel.x) * scale, f64::from(pixel.y) * scale);
            let smooth = pixel.smooth.map(f64::from);
            let slope = pixel.slope.map(f64::from);
            let own = f64::from(pixel.value);
            value += own;
            square += own * own;
            for k in 0..count {
                for axis in [0, 1] {
                    let (row, j, s) = (2 * k + axis, smooth[axis] * phi[k], slope[axis] * phi[k]);
                    sum[row] += j;
                    weighted[row] += j * (own - mean);
                    slopes[row] += s;
                    slopes_weighted[row] += s * (own - mean);
                }
                for l in 0..count {
                    let product = phi[k] * phi[l];
                    shapes[(k, l)] += product;
                    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        step[(2 * k + a, 2 * l + b)] += product * smooth[a] * slope[b];
                        spread[(2 * k + a, 2 * l + b)] += product * smooth[a] * smooth[b];
                    }
                }
            }
        }
        let variation = square - number * mean * mean;
        if variation <= 0.0 {
            return None;
        }
        step -= &sum * slopes.transpose() / number
            + &weighted * slopes_weighted.transpose() / variation;
        spread -= &sum * sum.transpose() / number + &weighted * weighted.transpose() / variation;
        let of_noise = noise.variance(mean) * overlap;
        for k in 0..count {
            for l in 0..count {
                for axis in [0, 1] {
                    step[(2 * k + axis, 2 * l + axis)] -= of_noise * shapes[(k, l)];
                }
            }
        }
        let step = 0.5 * (&step + step.transpose());
        Some(Self {
            step: Cholesky::new(step)?,
            spread,
            sum,
            weighted,
            value,
            square,
        })
    }
}
