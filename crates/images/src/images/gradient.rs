//! The first image: its gradients, and its usable pixels.

use super::filter::{gaussian, symmetric};
use super::grey::GreyImage;
use super::noise::Noise;
use super::spline::Spline;

/// An image whose pattern is looked for in others.
///
/// Its gradient is needed twice: exactly, g, to say by how much the misfit changes with a displacement, and smoothed, ĝ, to weigh the misfit
/// with little noise. Any ĝ gives an estimate without bias; its variance is smallest for
///
/// ```text
/// minimise over s   Σ ĝ² / (Σ ĝ·g − N v ⟨k̂, k⟩)²        ĝ = Gauss(s) ∗ g, v: variance of a pixel, k: filters of the gradients
/// ```
///
/// where N v ⟨k̂, k⟩ is what the noise alone contributes to Σ ĝ·g.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The image.
    pub image: GreyImage,
    /// ∂I/∂x and ∂I/∂y.
    pub gradient: [GreyImage; 2],
    /// The smoothed ones.
    pub smooth: [GreyImage; 2],
    /// ⟨k̂, k⟩ of one component, in 1/pixel².
    pub overlap: f64,
    /// The noise of its pixels.
    pub noise: Noise,
    /// Which pixels show the pattern: those of the specimen without dead and saturated ones.
    pub usable: Vec<bool>,
}

/// Standard deviations in pixels of the smoothings that are tried.
const SMOOTHING: [f64; 8] = [0.0, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0];

fn smoothed(image: &GreyImage, deviation: f64) -> GreyImage {
    if deviation > 0.0 {
        symmetric(image, &gaussian(deviation))
    } else {
        image.clone()
    }
}

/// ⟨k̂, k⟩ of ∂/∂x: the sum of products of the responses to one pixel.
fn overlap(deviation: f64) -> f64 {
    const LENGTH: usize = 65;
    let middle = LENGTH / 2;
    let pulse = GreyImage::of(LENGTH, LENGTH, |x, y| {
        f32::from(u8::from(x == middle && y == middle))
    });
    let [along, _] = Spline::new(&pulse).gradients();
    let smooth = smoothed(&along, deviation);
    let pairs = along.values().iter().zip(smooth.values());
    pairs.map(|(a, b)| f64::from(a * b)).sum()
}

/// The sum of the products of two gradients over the usable pixels.
fn product(a: &[GreyImage; 2], b: &[GreyImage; 2], usable: &[bool]) -> f64 {
    let sum = |axis: usize| -> f64 {
        let pairs = a[axis].values().iter().zip(b[axis].values());
        let pairs = pairs.zip(usable).filter(|(_, flag)| **flag);
        pairs.map(|((a, b), _)| f64::from(a * b)).sum()
    };
    sum(0) + sum(1)
}

impl Reference {
    /// Of an image, its usable pixels, and the noise.
    pub fn new(image: GreyImage, usable: Vec<bool>, noise: Noise) -> Self {
        let gradient = Spline::new(&image).gradients();
        let count = usable.iter().filter(|flag| **flag).count().max(1) as f64;
        let counted = || usable.iter().zip(image.values()).filter(|(flag, _)| **flag);
        let mean = counted().map(|(_, value)| f64::from(*value)).sum::<f64>() / count;
        let total_noise = count * noise.variance(mean);
        let tried = SMOOTHING.iter().map(|&deviation| {
            let smooth = [0, 1].map(|axis| smoothed(&gradient[axis], deviation));
            let overlap = overlap(deviation);
            let signal = product(&smooth, &gradient, &usable) - 2.0 * total_noise * overlap;
            let variance = if signal > 0.0 {
                product(&smooth, &smooth, &usable) / signal.powi(2)
            } else {
                f64::INFINITY
            };
            (variance, smooth, overlap)
        });
        let best = tried.min_by(|a, b| a.0.total_cmp(&b.0));
        let (_, smooth, overlap) = best.expect("smoothings are tried");
        Self {
            image,
            gradient,
            smooth,
            overlap,
            noise,
            usable,
        }
    }
}
