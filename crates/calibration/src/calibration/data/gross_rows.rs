//! Rows that no specimen can have measured: a glitch of the load cell, a first row before the zero was set.

use crate::statistics::{extremes, median};

/// The least height of a spike over the median of the second differences.
const USUAL: f64 = 10.0;
/// Its least height as a share of the range of all other stresses.
const SHARE: f64 = 0.05;
/// The first row, which has neighbours on one side alone, must deviate by this share of the range.
const SHARE_AT_ENDS: f64 = 0.2;
/// Fewer rows do not determine the median.
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
        .map(|triple| (triple[0] - 2.0 * triple[1] + triple[2]).abs());
    let usual = USUAL * median(bends);
    let mut sorted = stresses.to_vec();
    sorted.sort_by(f64::total_cmp);
    // The range without the outermost hundredth, in which the gross rows are.
    let margin = 1 + count / 100;
    let range = sorted[count - 1 - margin] - sorted[margin];
    let goes_on =
        |row: usize| (strains[row] - strains[row - 1]) * (strains[row + 1] - strains[row]) >= 0.0;
    let is_spike = |row: &usize| {
        let [before, middle, after] = [row - 1, *row, row + 1].map(|row| stresses[row]);
        let height = (middle - before).abs().min((middle - after).abs());
        let returns = (middle - before) * (middle - after) > 0.0;
        let step = (after - before).abs();
        returns && goes_on(*row) && height > usual.max(SHARE * range).max(USUAL * step)
    };
    let mut gross: Vec<usize> = (1..count - 1).filter(is_spike).collect();
    let is_off = |end: usize, next: [usize; 4]| {
        let [low, high] = extremes(next.map(|row| stresses[row]));
        let jump = (stresses[end] - stresses[next[0]]).abs();
        let direction = (strains[end] - strains[next[0]]).abs();
        let [shortest, longest] = extremes(next.map(|row| strains[row]));
        let off = jump > (SHARE_AT_ENDS * range).max(USUAL * (high - low)).max(usual);
        off && direction <= longest - shortest
    };
    if is_off(0, [1, 2, 3, 4]) {
        gross.insert(0, 0);
    }
    gross
}

/// The least stress of an intact specimen, and the largest one of a torn specimen, as shares of the largest.
const INTACT: f64 = 0.9;
const TORN: f64 = 0.1;
/// A specimen tears within this many rows, or while the strain grows by this share of its range.
const TEARING_ROWS: usize = 5;
const GOES_ON: f64 = 0.01;
/// The strain of a specimen that is not unloaded decreases by no more than this share of its range.
const STANDS: f64 = 0.02;

/// The rows after a rupture: the stress falls quickly from its largest value to almost zero and stays there, while the strain does not
/// decrease. In relaxation, the stress falls slowly.
pub fn torn_rows(strains: &[f64], stresses: &[f64]) -> Vec<usize> {
    if stresses.len() < FEWEST {
        return Vec::new();
    }
    let at_rest = median(stresses.iter().copied().take(TEARING_ROWS));
    let size = |stress: &f64| (stress - at_rest).abs();
    let most = stresses.iter().map(size).fold(0.0, f64::max);
    let Some(last_intact) = stresses.iter().rposition(|y| size(y) >= INTACT * most) else {
        return Vec::new();
    };
    let first = last_intact + 1;
    let torn = stresses[first..]
        .iter()
        .position(|y| size(y) <= TORN * most);
    let Some(torn) = torn.map(|rows| first + rows) else {
        return Vec::new();
    };
    let [low, high] = extremes(strains.iter().copied());
    let direction = (strains[last_intact] - strains[0]).signum();
    let further = |row: usize| direction * (strains[row] - strains[last_intact]) / (high - low);
    let stands = (first..strains.len()).all(|row| further(row) >= -STANDS);
    let tears = torn - last_intact <= TEARING_ROWS || further(torn) > GOES_ON;
    let is_last = stresses[torn..].iter().all(|y| size(y) <= TORN * most);
    if stands && tears && is_last && direction != 0.0 {
        (first..stresses.len()).collect()
    } else {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curve of a gel with noise of a thousandth, loaded and unloaded in turn.
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

    #[test]
    fn rows_behind_a_rupture_are_found_and_unloading_and_relaxation_are_none() {
        for sign in [1.0, -1.0] {
            let (pull, _) = record(1);
            let stress = |x: &f64| 0.3 + sign * (3.0 * x).exp_m1();
            let complete: Vec<f64> = pull.iter().map(stress).collect();
            assert!(torn_rows(&pull, &complete).is_empty());
            let behind: Vec<f64> = (60..75).map(|row| f64::from(row) / 60.0).collect();
            let strains = [pull.clone(), behind.clone()].concat();
            let stands = [pull.clone(), vec![pull[59]; 15]].concat();
            let torn = [complete.clone(), vec![0.3 + 0.01 * sign; 15]].concat();
            let all: Vec<usize> = (60..75).collect();
            assert_eq!(torn_rows(&strains, &torn), all);
            assert_eq!(torn_rows(&stands, &torn), all);
            // Back to rest within a few rows.
            let back = [pull.clone(), vec![0.0; 15]].concat();
            assert!(torn_rows(&back, &torn).is_empty());
            let decay =
                (0..90).map(|row| 0.3 + (complete[59] - 0.3) * (-0.1 * f64::from(row)).exp());
            let held = [pull.clone(), vec![pull[59]; 90]].concat();
            let relaxing = [complete.clone(), decay.collect()].concat();
            assert!(torn_rows(&held, &relaxing).is_empty());
        }
    }
}
