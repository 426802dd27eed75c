//! Spikes: single values far from both of their neighbours, as of a disturbed cable or a lost count.
//!
//! ```text
//! dᵢ = yᵢ − y between its neighbours at tᵢ,   a spike of size s has   dᵢ = s,   dᵢ₋₁, dᵢ₊₁ ≈ −s/2,   s = ½ (dᵢ − dᵢ₋₁ − dᵢ₊₁)
//! ```
//!
//! A corner has a large dᵢ alone. Spikes enter the noise that is estimated of a signal, so that neither the misfit nor the intervals show
//! them.

/// How many standard deviations of s a spike is: with a corner below it, noise does not reach so far.
const CLEARLY: f64 = 8.0;
/// The standard deviation of s over that of d, √(9/4 : 3/2).
const OF_SIZE: f64 = 1.2247;

/// The share of dᵢ that its neighbours have, with the other sign; alternating noise has more, a corner less.
const BESIDE: [f64; 2] = [0.25, 0.75];

/// This share of d is free of spikes, and the standard deviation of the smallest such share of normal values over that of all of them.
const SOUND: f64 = 0.9;
const OF_SOUND: f64 = 0.7893;

/// How many times the least step of a rounded signal a spike is.
const STEPS: f64 = 2.5;

/// The instants with spikes.
pub fn spikes(times: &[f64], values: &[f64]) -> Vec<usize> {
    let inner = 1..values.len().saturating_sub(1);
    let off: Vec<f64> = inner
        .map(|i| values[i] - between(times, values, [i - 1, i, i + 1]))
        .collect();
    let mut sizes: Vec<f64> = off.iter().map(|d| d.abs()).collect();
    if sizes.is_empty() {
        return Vec::new();
    }
    sizes.sort_by(f64::total_cmp);
    let sound = &sizes[..(SOUND * sizes.len() as f64).ceil() as usize];
    let squares: f64 = sound.iter().map(|d| d * d).sum();
    let noise = (squares / sound.len() as f64).sqrt() / OF_SOUND;
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let step = steps
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let least = (CLEARLY * OF_SIZE * noise).max(STEPS * step);
    let is_spike = |three: &[f64]| {
        let size = 0.5 * (three[1] - three[0] - three[2]).abs();
        let is_opposite = |beside: f64| {
            let share = -beside / three[1];
            share > BESIDE[0] && share < BESIDE[1]
        };
        noise > 0.0 && size > least && is_opposite(three[0]) && is_opposite(three[2])
    };
    let triples = off.windows(3).enumerate();
    let found = triples.filter(|(_, three)| is_spike(three));
    found.map(|(i, _)| i + 2).collect()
}

/// The values with their spikes replaced by what their neighbours tell.
pub fn bridged(times: &[f64], values: &[f64], spikes: &[usize]) -> Vec<f64> {
    let mut bridged = values.to_vec();
    for i in spikes {
        bridged[*i] = between(times, values, [i - 1, *i, i + 1]);
    }
    bridged
}

/// The value at the middle instant on the line through its neighbours.
fn between(times: &[f64], values: &[f64], [before, i, after]: [usize; 3]) -> f64 {
    let share = (times[i] - times[before]) / (times[after] - times[before]);
    values[before] + share * (values[after] - values[before])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    /// 2000 instants of a motion with noise, rounded to a quantum if there is one.
    fn sampled(
        motion: impl Fn(f64) -> f64,
        [noise, quantum]: [f64; 2],
        seed: u64,
    ) -> [Vec<f64>; 2] {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let times: Vec<f64> = (0..2000).map(|i| f64::from(i) / 200.0).collect();
        let values = times.iter().map(|t| {
            let draw: f64 = StandardNormal.sample(&mut random);
            let value = motion(*t) + noise * draw;
            if quantum > 0.0 {
                (value / quantum).round() * quantum
            } else {
                value
            }
        });
        let values = values.collect();
        [times, values]
    }

    #[test]
    fn spikes_are_found_where_they_are_and_sound_signals_have_none() {
        let sine = |t: f64| (TAU * 0.7 * t).sin();
        let triangle = |t: f64| 4.0 * (t - (t + 0.5).floor()).abs();
        let step = |t: f64| if t < 5.0 { 0.0 } else { 1.0 };
        for seed in 0..10 {
            for noise in [
                [0.0, 0.0],
                [0.02, 0.0],
                [1e-4, 0.0],
                [0.02, 0.05],
                [0.0, 0.05],
                [3e-3, 0.01],
            ] {
                for motion in [&sine as &dyn Fn(f64) -> f64, &triangle, &step] {
                    let [times, values] = sampled(motion, noise, seed);
                    assert_eq!(spikes(&times, &values), [0_usize; 0], "{noise:?}");
                }
            }
            let [times, sound] = sampled(sine, [0.02, 0.0], seed);
            let mut values = sound.clone();
            let wrong: Vec<usize> = (0..40).map(|i| 20 + 49 * i).collect();
            for i in &wrong {
                values[*i] += 0.4;
            }
            let found = spikes(&times, &values);
            let hits = wrong.iter().filter(|i| found.contains(i)).count();
            assert!(hits >= 38 && found.len() == hits, "{found:?}");
            let mended = bridged(&times, &values, &found);
            assert!(
                wrong
                    .iter()
                    .filter(|i| (mended[**i] - sound[**i]).abs() > 0.15)
                    .count()
                    <= 2
            );
        }
    }
}
