//! Rows that no specimen can have measured: a glitch of the load cell, a first row before the zero was set.

use crate::statistics::{extremes, median};

/// A spike is at least so many times the usual change of the change from row to row.
const USUAL: f64 = 10.0;
/// And at least this share of the range of all other stresses.
const SHARE: f64 = 0.05;
/// A first or last row, which has neighbours on one side alone, must be off by this share of the range.
const SHARE_AT_ENDS: f64 = 0.2;
/// Fewer rows than this have no usual change.
const FEWEST: usize = 12;

/// The rows at which the stress leaves the curve of its neighbours and returns at once, while the strain goes on: those of tests that were
/// recorded along their path. A turn of the strain is none of them, nor is a specimen that tears.
pub fn gross_rows(strains: &[f64], stresses: &[f64]) -> Vec<usize> {
    let count = stresses.len();
    if count < FEWEST {
        return Vec::new();
    }
    let bends = stresses
        .windows(3)
        .map(|own| (own[0] - 2.0 * own[1] + own[2]).abs());
    let usual = USUAL * median(bends);
    let mut sorted = stresses.to_vec();
    sorted.sort_by(f64::total_cmp);
    // The range without the outermost hundredth, in which the gross rows are.
    let margin = 1 + count / 100;
    let range = sorted[count - 1 - margin] - sorted[margin];
    let goes_on =
        |row: usize| (strains[row] - strains[row - 1]) * (strains[row + 1] - strains[row]) >= 0.0;
    let is_spike = |row: &usize| {
        let [before, own, after] = [row - 1, *row, row + 1].map(|row| stresses[row]);
        let height = (own - before).abs().min((own - after).abs());
        let returns = (own - before) * (own - after) > 0.0;
        let step = (after - before).abs();
        returns && goes_on(*row) && height > usual.max(SHARE * range).max(USUAL * step)
    };
    let mut gross: Vec<usize> = (1..count - 1).filter(is_spike).collect();
    let is_off = |own: usize, next: [usize; 4]| {
        let [low, high] = extremes(next.map(|row| stresses[row]));
        let jump = (stresses[own] - stresses[next[0]]).abs();
        let way = (strains[own] - strains[next[0]]).abs();
        let [shortest, longest] = extremes(next.map(|row| strains[row]));
        let off = jump > (SHARE_AT_ENDS * range).max(USUAL * (high - low)).max(usual);
        off && way <= longest - shortest
    };
    if is_off(0, [1, 2, 3, 4]) {
        gross.insert(0, 0);
    }
    gross
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve of a gel with noise of a thousandth, loaded and unloaded so many times.
    fn record(turns: usize) -> (Vec<f64>, Vec<f64>) {
        let rows = 60 * turns;
        let strains = (0..rows).map(|row| {
            let share = (row % 60) as f64 / 60.0;
            if (row / 60) % 2 == 0 {
                share
            } else {
                1.0 - share
            }
        });
        let strains: Vec<f64> = strains.collect();
        let noise = |row: usize| 1e-3 * (12.9898 * row as f64).sin();
        let stresses = strains.iter().enumerate();
        let stresses = stresses
            .map(|(row, x)| (3.0 * x).exp_m1() / 19.0 + noise(row))
            .collect();
        (strains, stresses)
    }

    #[test]
    fn glitches_are_gross_and_turns_steep_ends_and_noise_are_not() {
        for turns in [1, 2, 5] {
            let (strains, mut stresses) = record(turns);
            assert!(gross_rows(&strains, &stresses).is_empty(), "{turns}");
            stresses[0] = 0.7;
            stresses[20] = -0.4;
            assert_eq!(gross_rows(&strains, &stresses), [0, 20], "{turns}");
        }
        let coarse: Vec<f64> = (0..16).map(|row| f64::from(row) / 15.0).collect();
        let steep: Vec<f64> = coarse.iter().map(|x| (8.0 * x).exp_m1()).collect();
        assert!(gross_rows(&coarse, &steep).is_empty());
    }
}
