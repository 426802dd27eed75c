//! The matrices of a subset that depend on the first image alone: those of the steps and of the covariance.

use gelbench_mechanics::solve::vector::add_scaled;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::noise::Noise;
use super::warp::{DEGREES, functions};

/// A pixel of a subset: distance from the centre, grey value, smoothed gradient and gradient.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    pub x: f32,
    pub y: f32,
    pub value: f32,
    pub smooth: [f32; 2],
    pub slope: [f32; 2],
}

/// The sums over the pixels of a subset that depend on the first image alone, in the symbols of [`subset`](super::subset).
#[derive(Clone, Debug)]
pub struct Matrices {
    /// The factor of A.
    pub step: Cholesky<f64, Dyn>,
    /// Σ J⊥J⊥ᵀ.
    pub spread: DMatrix<f64>,
    /// Σ J.
    pub sum: DVector<f64>,
    /// Σ J Ĩ.
    pub weighted: DVector<f64>,
    /// Σ I₀.
    pub value: f64,
    /// Σ I₀².
    pub square: f64,
}

/// Sums over the pixels of the smoothed gradient ĝ, the gradient g and the grey value I without its mean.
struct PatternSums {
    /// Σ φₖ times ĝx, ĝy, gx, gy, and these times I.
    with_functions: [[f64; 8]; MOST_FUNCTIONS],
    /// Σ φₖ φₗ times ĝx gx, ĝx gy, ĝy gx, ĝy gy, ĝx ĝx, ĝx ĝy, ĝy ĝy and 1, for l ≤ k.
    with_products: [[f64; 8]; MOST_FUNCTIONS * (MOST_FUNCTIONS + 1) / 2],
    /// Σ I², the mean taken out.
    variation: f64,
}

const MOST_FUNCTIONS: usize = DEGREES.len();

impl PatternSums {
    fn new(pixels: &[Pixel], mean: f64, half: f64, count: usize) -> Self {
        let scale = 1.0 / half;
        let mut sums = Self {
            with_functions: [[0.0; 8]; _],
            with_products: [[0.0; 8]; _],
            variation: 0.0,
        };
        for pixel in pixels {
            let phi = functions(f64::from(pixel.x) * scale, f64::from(pixel.y) * scale);
            let [p, q] = pixel.smooth.map(f64::from);
            let [r, s] = pixel.slope.map(f64::from);
            let value = f64::from(pixel.value) - mean;
            sums.variation += value * value;
            let factors = [p, q, r, s, p * value, q * value, r * value, s * value];
            let products = [p * r, p * s, q * r, q * s, p * p, p * q, q * q, 1.0];
            let mut pair = 0;
            for k in 0..count {
                add_scaled(&mut sums.with_functions[k], phi[k], &factors);
                for other in &phi[..=k] {
                    add_scaled(&mut sums.with_products[pair], phi[k] * other, &products);
                    pair += 1;
                }
            }
        }
        sums
    }

    /// A vector with two entries for each function: those at two positions of [`Self::with_functions`].
    fn vector(&self, count: usize, positions: [usize; 2]) -> DVector<f64> {
        DVector::from_fn(2 * count, |row, _| {
            self.with_functions[row / 2][positions[row % 2]]
        })
    }

    /// A matrix with two rows and columns for each function: those at two by two positions of [`Self::with_products`].
    fn matrix(&self, count: usize, positions: [[usize; 2]; 2]) -> DMatrix<f64> {
        DMatrix::from_fn(2 * count, 2 * count, |row, column| {
            let (k, l) = ((row / 2).max(column / 2), (row / 2).min(column / 2));
            self.with_products[k * (k + 1) / 2 + l][positions[row % 2][column % 2]]
        })
    }
}

impl Matrices {
    pub fn new(
        pixels: &[Pixel],
        half: f64,
        count: usize,
        overlap: f64,
        noise: &Noise,
    ) -> Option<Self> {
        let number = pixels.len() as f64;
        let values = || pixels.iter().map(|pixel| f64::from(pixel.value));
        let value = values().sum::<f64>();
        let mean = value / number;
        let sums = PatternSums::new(pixels, mean, half, count);
        if sums.variation <= 0.0 {
            return None;
        }
        let [sum, slopes] = [[0, 1], [2, 3]].map(|at| sums.vector(count, at));
        let [weighted, slopes_weighted] = [[4, 5], [6, 7]].map(|at| sums.vector(count, at));
        let variation = sums.variation;
        let mut step = sums.matrix(count, [[0, 1], [2, 3]]);
        step -= &sum * slopes.transpose() / number
            + &weighted * slopes_weighted.transpose() / variation;
        let mut spread = sums.matrix(count, [[4, 5], [5, 6]]);
        spread -= &sum * sum.transpose() / number + &weighted * weighted.transpose() / variation;
        // What the noise alone contributes to Σ ĝ·g φφᵀ, to both components alike.
        let of_noise = noise.variance(mean) * overlap;
        let shapes = sums.matrix(count, [[7, 7], [7, 7]]);
        for (row, column) in (0..2 * count).flat_map(|row| (0..2 * count).map(move |c| (row, c))) {
            if row % 2 == column % 2 {
                step[(row, column)] -= of_noise * shapes[(row, column)];
            }
        }
        let step = 0.5 * (&step + step.transpose());
        Some(Self {
            step: Cholesky::new(step)?,
            spread,
            sum,
            weighted,
            value,
            square: values().map(|value| value * value).sum(),
        })
    }
}
