//! Corners of a motion, as of a machine at constant rates, which one smooth spline cannot follow.
//!
//! The second difference over k instants, xᵢ₊ₖ − 2 xᵢ + xᵢ₋ₖ where they are even and else twice the distance of xᵢ from the chord, is k
//! times the change of the rate within k instants of a corner, and small elsewhere; for a smooth motion it is nowhere many times larger than in its surroundings. Rounding of the
//! recording alone makes it up to two steps of the last digit.

use crate::statistics::median;

/// Strides of the differences.
const STRIDES: [usize; 4] = [1, 2, 4, 8];

/// The surroundings of an instant, in strides.
const SURROUNDINGS: usize = 6;

/// How many times larger than the median of its surroundings a corner's difference is: noise alone reaches six.
const SIGNIFICANT: f64 = 10.0;

/// The steps of the last digit that a corner's difference exceeds: a slow motion rests on one digit for many instants, so that the
/// median is zero.
const STEPS_OF_LAST_DIGIT: f64 = 2.5;

/// Fewest corners that count: a single one is a jerk, or chance.
const FEWEST: usize = 4;

/// The number of corners of a motion sampled at some times; `None` where there are too few to count.
pub fn corners(times: &[f64], motion: &[f64]) -> Option<usize> {
    let changes = motion.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let last_digit = changes.filter(|change| *change > 0.0);
    let least = STEPS_OF_LAST_DIGIT * last_digit.fold(f64::INFINITY, f64::min);
    let counts = STRIDES.map(|stride| at_stride([times, motion], stride, least).len());
    counts.into_iter().max().filter(|count| *count >= FEWEST)
}

/// Where differences of a stride are those of corners, and larger than `least`.
fn at_stride([times, motion]: [&[f64]; 2], stride: usize, least: f64) -> Vec<usize> {
    let Some(count) = motion.len().checked_sub(2 * stride) else {
        return Vec::new();
    };
    let difference = |i: usize| {
        let [first, middle, last] = [i, i + stride, i + 2 * stride];
        let share = (times[middle] - times[first]) / (times[last] - times[first]);
        let chord = motion[first] + share * (motion[last] - motion[first]);
        2.0 * (chord - motion[middle])
    };
    let sizes: Vec<f64> = (0..count).map(|i| difference(i).abs()).collect();
    let mut result: Vec<usize> = Vec::new();
    for (i, size) in sizes.iter().enumerate() {
        let around =
            i.saturating_sub(SURROUNDINGS * stride)..(i + SURROUNDINGS * stride + 1).min(count);
        let is_first = result
            .last()
            .is_none_or(|last| i + stride - last > 4 * stride);
        let significant = SIGNIFICANT * median(sizes[around].iter().copied());
        if is_first && *size > significant.max(least) {
            result.push(i + stride);
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::statistics::normal_numbers;

    /// The corners of a motion over ten periods of 120 instants.
    fn sampled(position: impl Fn(f64) -> f64, noise: f64) -> Option<usize> {
        let mut normal = normal_numbers(7);
        let times: Vec<f64> = (0..1200).map(|i| f64::from(i) / 120.0).collect();
        let motion: Vec<f64> = times
            .iter()
            .map(|t| position(*t) + noise * normal())
            .collect();
        corners(&times, &motion)
    }

    #[test]
    fn triangles_and_trapezoids_have_corners_and_smooth_motions_have_none() {
        let triangle = |t: f64| 4.0 * (t - (t + 0.5).floor()).abs();
        let hold = |t: f64| triangle(t).min(1.5);
        for noise in [0.0, 1e-4, 3e-3] {
            assert!(sampled(triangle, noise) >= Some(15), "{noise}");
            assert!(sampled(hold, noise) >= Some(15), "{noise}");
        }
        let sine = |t: f64| (TAU * t).sin();
        let decay = |t: f64| (TAU * t).sin() * (-0.5 * t).exp();
        let two = |t: f64| (TAU * t).sin() + 0.5 * (3.1 * TAU * t).sin();
        let chirp = |t: f64| (TAU * 0.3 * t * t).sin();
        for noise in [0.0, 1e-4, 3e-3, 0.1] {
            for smooth in [&sine as &dyn Fn(f64) -> f64, &decay, &two, &chirp] {
                assert_eq!(sampled(smooth, noise), None, "{noise}");
            }
        }
    }

    /// Slow motions and turning points rest on one digit for many instants.
    #[test]
    fn digits_of_a_recording_are_no_corners() {
        let slow = |t: f64| 50.0 * (TAU * 0.05 * t).sin();
        let returning = |t: f64| 50.0 * (TAU * 0.5 * t).sin();
        for smooth in [&slow as &dyn Fn(f64) -> f64, &returning] {
            let rounded = |t: f64| smooth(t).round() / 50.0;
            assert_eq!(sampled(rounded, 0.0), None);
        }
        let triangle = |t: f64| (1000.0 * (t - (t + 0.5).floor()).abs()).round() / 1000.0;
        assert!(sampled(triangle, 0.0) >= Some(15));
    }

    #[test]
    fn rows_that_are_missing_are_no_corners() {
        let instants = (0..1200).filter(|i| ![100, 217, 400, 533, 700, 911, 912].contains(i));
        let times: Vec<f64> = instants.map(|i| f64::from(i) / 120.0).collect();
        let motion: Vec<f64> = times.iter().map(|t| (TAU * t).sin()).collect();
        assert_eq!(corners(&times, &motion), None);
    }
}
