//! What the pixels of a subset give once for all: the matrices of the steps and of the covariance.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::noise::Noise;
use super::warp::functions;

/// A pixel of a subset: distance from the centre, grey value, smoothed gradient and gradient.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    pub x: f32,
    pub y: f32,
    pub value: f32,
    pub smooth: [f32; 2],
    pub slope: [f32; 2],
}

/// What the pixels of a subset give once for all.
#[derive(Clone, Debug)]
pub struct Matrices {
    pub step: Cholesky<f64, Dyn>,
    pub spread: DMatrix<f64>,
    pub sum: DVector<f64>,
    pub weighted: DVector<f64>,
    pub value: f64,
    pub square: f64,
}

impl Matrices {
    pub fn new(
        pixels: &[Pixel],
        half: f64,
        count: usize,
        overlap: f64,
        noise: &Noise,
    ) -> Option<Self> {
        let size = 2 * count;
        let (scale, number) = (1.0 / half, pixels.len() as f64);
        let mut step = DMatrix::zeros(size, size);
        let mut spread = DMatrix::zeros(size, size);
        let mut shapes: DMatrix<f64> = DMatrix::zeros(count, count);
        let [mut sum, mut weighted, mut slopes, mut slopes_weighted] =
            [(); 4].map(|()| DVector::zeros(size));
        let (mut value, mut square) = (0.0, 0.0);
        let values = pixels.iter().map(|pixel| f64::from(pixel.value));
        let mean = values.sum::<f64>() / number;
        for pixel in pixels {
            let phi = functions(f64::from(pixel.x) * scale, f64::from(pixel.y) * scale);
            let smooth = pixel.smooth.map(f64::from);
            let slope = pixel.slope.map(f64::from);
            let intensity = f64::from(pixel.value);
            value += intensity;
            square += intensity * intensity;
            for k in 0..count {
                for axis in [0, 1] {
                    let (row, j, s) = (2 * k + axis, smooth[axis] * phi[k], slope[axis] * phi[k]);
                    sum[row] += j;
                    weighted[row] += j * (intensity - mean);
                    slopes[row] += s;
                    slopes_weighted[row] += s * (intensity - mean);
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
        take_noise(&mut step, &shapes, noise.variance(mean) * overlap);
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

/// Takes what the noise alone contributes to Σ ĝ·g φφᵀ out of both components.
fn take_noise(step: &mut DMatrix<f64>, shapes: &DMatrix<f64>, of_noise: f64) {
    for (k, l) in (0..shapes.nrows()).flat_map(|k| (0..shapes.ncols()).map(move |l| (k, l))) {
        for axis in [0, 1] {
            step[(2 * k + axis, 2 * l + axis)] -= of_noise * shapes[(k, l)];
        }
    }
}
