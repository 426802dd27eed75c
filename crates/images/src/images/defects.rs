//! Pixels without information: dead ones, and saturated areas.

use super::grey::{GreyImage, range};
use super::noise::Noise;
use crate::error::Diagnostic;

/// Standard deviations beyond which noise does not explain a difference of grey values.
const FAR: f32 = 6.0;

/// Pixels that stand alone in both images with the same value, as a sensor's dead or hot pixels do: farther from the median of their eight
/// neighbours than three times the range of these, and than the noise explains.
pub fn dead(first: &GreyImage, other: &GreyImage, noise: &Noise) -> Vec<usize> {
    let [width, height] = first.size();
    if first.size() != other.size() || width < 3 || height < 3 {
        return Vec::new();
    }
    let inner = (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y)));
    let is_dead = |&(x, y): &(usize, usize)| {
        let deviation = noise.variance(f64::from(first.value(x, y))).sqrt() as f32;
        let alone = |image: &GreyImage| {
            let contrast = image.value(x, y) - median(image, x, y);
            let (low, high) = range(&image.around(x, y));
            (contrast.abs() > 3.0 * (high - low) + FAR * deviation).then_some(contrast)
        };
        let same = (first.value(x, y) - other.value(x, y)).abs() <= FAR * deviation;
        same && matches!((alone(first), alone(other)), (Some(a), Some(b)) if a * b > 0.0)
    };
    inner.filter(is_dead).map(|(x, y)| y * width + x).collect()
}

fn median(image: &GreyImage, x: usize, y: usize) -> f32 {
    let mut values = image.around(x, y);
    values.sort_by(f32::total_cmp);
    0.5 * (values[3] + values[4])
}

/// The image with the median of its neighbours in each dead pixel.
pub fn repaired(image: &GreyImage, dead: &[usize]) -> GreyImage {
    let mut repaired = image.clone();
    let width = image.size()[0];
    for &index in dead {
        repaired.values_mut()[index] = median(image, index % width, index / width);
    }
    repaired
}

/// The pixels of saturated areas: white, with at least three white neighbours.
pub fn saturated(image: &GreyImage) -> Vec<usize> {
    let ([width, height], white) = (image.size(), image.white());
    let is_area = |x: usize, y: usize| {
        let count = || {
            image
                .around(x, y)
                .iter()
                .filter(|value| **value >= white)
                .count()
        };
        image.value(x, y) >= white && count() >= 3
    };
    let inner = (1..height.saturating_sub(1))
        .flat_map(|y| (1..width.saturating_sub(1)).map(move |x| (x, y)));
    inner
        .filter(|(x, y)| is_area(*x, *y))
        .map(|(x, y)| y * width + x)
        .collect()
}

/// The warnings about so many dead and saturated pixels among all `pixels` of the region.
pub fn warnings(dead: usize, saturated: usize, pixels: usize) -> Vec<Diagnostic> {
    const MUCH: f64 = 0.001;
    let of_dead = (dead > 0).then(|| {
        let message = format!("dead pixels: {dead}");
        Diagnostic::warning("", message)
            .hint("they are left out, and filled from their neighbours in later images")
    });
    let share = saturated as f64 / pixels.max(1) as f64;
    let of_saturated = (share > MUCH).then(|| {
        let message = format!("saturated areas: {:.1} % of the pixels", 100.0 * share);
        Diagnostic::warning("", message)
            .hint("they are left out; expose shorter, or turn the light")
    });
    of_dead.into_iter().chain(of_saturated).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dead_pixel_is_found_and_a_moving_bright_spot_is_not() {
        let pattern = |shift: f32| {
            GreyImage::of(40, 40, |x, y| {
                100.0 + 20.0 * (0.4 * (x as f32 - shift)).sin() + 10.0 * (0.3 * y as f32).cos()
            })
        };
        let (mut first, mut other) = (pattern(0.0), pattern(2.0));
        for image in [&mut first, &mut other] {
            image.values_mut()[20 * 40 + 7] = 255.0;
        }
        first.values_mut()[10 * 40 + 10] = 255.0;
        other.values_mut()[10 * 40 + 12] = 255.0;
        let noise = Noise {
            base: 1.0,
            growth: 0.0,
        };
        let indices = dead(&first, &other, &noise);
        assert_eq!(indices, [20 * 40 + 7]);
        assert!(repaired(&first, &indices).value(7, 20) < 130.0);
    }
}
