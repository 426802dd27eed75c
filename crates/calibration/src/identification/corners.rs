//! Corners of a motion, as of a machine at constant rates, which one smooth spline cannot follow, and spikes of a signal.
//!
//! The second difference over k instants, xᵢ₊ₖ − 2 xᵢ + xᵢ₋ₖ where they are even and else twice the distance of xᵢ from the chord, is k
//! times the change of the rate within k instants of a corner, and small elsewhere; for a smooth motion it is nowhere many times larger than in its surroundings. Rounding of the
//! recording alone makes it up to two steps of the last digit.

use std::ops::Range;

use super::smoothing::RESOLUTION;
use crate::solve::vector::largest;
use crate::statistics::median;

/// Strides of the differences.
const STRIDES: [usize; 4] = [1, 2, 4, 8];

/// Strides at which spikes are looked for: they last one or two instants.
const STRIDES_OF_SPIKES: [usize; 2] = [1, 2];

/// The share of a spike's difference that those beside it have with the other sign: half of it without noise.
const OPPOSED: f64 = 0.25;

/// The surroundings of an instant, in strides.
const SURROUNDINGS: usize = 6;

/// How many times larger than the median of its surroundings a corner's difference is: noise alone reaches six.
const SIGNIFICANT: f64 = 10.0;

/// The steps of the last digit that a corner's difference exceeds: a slow motion rests on one digit for many instants, so that the
/// median is zero.
const STEPS_OF_LAST_DIGIT: f64 = 2.5;

/// Fewest corners that count: a single one is a jerk, or chance.
const FEWEST: usize = 4;

/// The number of corners of a motion sampled at some times, in `runs` of instants without a gap; `None` where there are too few to count.
pub fn corners(times: &[f64], motion: &[f64], runs: &[Range<usize>]) -> Option<usize> {
    let least = least(motion);
    let counts = STRIDES.map(|stride| {
        let runs = runs
            .iter()
            .map(|run| Differences::new(times, motion, run, stride));
        runs.map(|one| one.corners(least)).sum::<usize>()
    });
    counts.into_iter().max().filter(|count| *count >= FEWEST)
}

/// The instants whose value is far from those on both sides, which agree with their own neighbours: of a spike s in a smooth signal the
/// second differences are s, −2s and s, where a corner has one large difference and a step has two.
pub fn spikes(times: &[f64], signal: &[f64], runs: &[Range<usize>]) -> Vec<usize> {
    let least = 2.0 * least(signal).max(RESOLUTION * largest(signal));
    let mut result: Vec<usize> = Vec::new();
    for stride in STRIDES_OF_SPIKES {
        for run in runs {
            result.extend(Differences::new(times, signal, run, stride).spikes(least));
        }
    }
    result.sort_unstable();
    result.dedup();
    result
}

/// The size that a corner's difference exceeds.
fn least(signal: &[f64]) -> f64 {
    let changes = signal.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let last_digit = changes.filter(|change| *change > 0.0);
    STEPS_OF_LAST_DIGIT * last_digit.fold(f64::INFINITY, f64::min)
}

/// The second differences of a signal over a stride in one run of instants.
struct Differences {
    values: Vec<f64>,
    stride: usize,
    /// The instant of the first one.
    first: usize,
}

impl Differences {
    fn new(times: &[f64], signal: &[f64], run: &Range<usize>, stride: usize) -> Self {
        let difference = |i: usize| {
            let [first, middle, last] = [i, i + stride, i + 2 * stride];
            let share = (times[middle] - times[first]) / (times[last] - times[first]);
            let chord = signal[first] + share * (signal[last] - signal[first]);
            2.0 * (chord - signal[middle])
        };
        let end = run.end.saturating_sub(2 * stride);
        Self {
            values: (run.start..end).map(difference).collect(),
            stride,
            first: run.start + stride,
        }
    }

    /// Whether a difference is many times larger than those around it, and larger than `least`.
    fn is_large(&self, i: usize, least: f64) -> bool {
        let reach = SURROUNDINGS * self.stride;
        let around = i.saturating_sub(reach)..(i + reach + 1).min(self.values.len());
        let sizes = self.values[around].iter().map(|value| value.abs());
        self.values[i].abs() > (SIGNIFICANT * median(sizes)).max(least)
    }

    fn corners(&self, least: f64) -> usize {
        let mut result: Vec<usize> = Vec::new();
        for i in 0..self.values.len() {
            let is_first = result.last().is_none_or(|last| i - last > 4 * self.stride);
            if is_first && self.is_large(i, least) {
                result.push(i);
            }
        }
        result.len()
    }

    /// Chance makes the differences around some instant small, so that a spike's is large beside those of the whole run too.
    fn spikes(&self, least: f64) -> Vec<usize> {
        let usual = median(self.values.iter().map(|value| value.abs()));
        let least = least.max(SIGNIFICANT * usual);
        let opposes = |i: usize, beside: Option<usize>| {
            let [size, sign] = [self.values[i].abs(), self.values[i].signum()];
            let other = beside.and_then(|beside| self.values.get(beside));
            other.is_some_and(|other| -sign * other > OPPOSED * size)
        };
        let is_spike = |i: &usize| {
            opposes(*i, i.checked_sub(self.stride))
                && opposes(*i, Some(i + self.stride))
                && self.is_large(*i, least)
        };
        let spikes = (0..self.values.len()).filter(is_spike);
        spikes.map(|i| self.first + i).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::slice;

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
        corners(&times, &motion, slice::from_ref(&(0..times.len())))
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
        let all = 0..times.len();
        assert_eq!(corners(&times, &motion, slice::from_ref(&all)), None);
    }

    /// Wrong values are spikes; steps of dry friction, corners, bursts and noise are none.
    #[test]
    fn spikes_are_values_far_from_those_on_both_sides() {
        let times: Vec<f64> = (0..1200).map(|i| f64::from(i) / 120.0).collect();
        let all = 0..times.len();
        let spikes_of = |value: &dyn Fn(f64) -> f64, noise: f64, wrong: &[usize]| {
            let mut normal = normal_numbers(5);
            let mut signal: Vec<f64> = times.iter().map(|t| value(*t) + noise * normal()).collect();
            wrong.iter().for_each(|i| signal[*i] += 0.5);
            spikes(&times, &signal, slice::from_ref(&all))
        };
        let smooth = |t: f64| (TAU * t).sin() + 0.5 * (3.1 * TAU * t).sin();
        let friction = |t: f64| smooth(t) + 0.8 * (TAU * t).cos().signum();
        let triangle = |t: f64| 4.0 * (t - (t + 0.5).floor()).abs();
        let burst = |t: f64| (2.0 * TAU * t).sin() * (-0.5 * t).exp();
        for noise in [0.0, 1e-3, 0.02] {
            for value in [&smooth as &dyn Fn(f64) -> f64, &friction, &triangle, &burst] {
                assert!(spikes_of(value, noise, &[]).is_empty(), "{noise}");
            }
            let wrong = [40, 401, 402, 777];
            assert_eq!(spikes_of(&smooth, noise, &wrong), wrong, "{noise}");
        }
    }
}
