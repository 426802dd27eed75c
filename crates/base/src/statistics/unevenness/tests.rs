//! Noise of one size and of several, on grids.

use super::*;
use crate::statistics::normal_numbers;

fn grid([columns, rows]: [usize; 2]) -> Vec<[f64; 2]> {
    let positions = (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j)));
    positions
        .map(|(i, j)| [1e3 + 2.0 * i as f64, 3.0 * j as f64])
        .collect()
}

fn noise(
    seed: u64,
    positions: &[[f64; 2]],
    size: impl Fn([f64; 2]) -> f64,
) -> Vec<Option<[f64; 2]>> {
    let mut normal = normal_numbers(seed);
    positions
        .iter()
        .map(|position| Some([normal(), normal()].map(|value| value * size(*position))))
        .collect()
}

#[test]
fn even_noise_is_hardly_ever_uneven() {
    for cells in [[8, 5], [20, 10], [40, 20]] {
        let positions = grid(cells);
        let alarms = (0..400).filter(|seed| {
            let z = noise(*seed, &positions, |_| 0.3);
            Unevenness::of(&positions, &z).is_some()
        });
        let alarms = alarms.count();
        assert!(alarms <= 1, "{cells:?}: {alarms} of 400");
    }
}

/// Noise that grows fourfold along the sheet, or towards its edges, is found with its size.
#[test]
fn noise_that_grows_is_found() {
    let positions = grid([40, 20]);
    let along = |[x, _]: [f64; 2]| 4.0_f64.powf((x - 1e3) / 78.0);
    let outwards = |[x, y]: [f64; 2]| {
        let [x, y] = [(x - 1039.0) / 39.0, (y - 28.5) / 28.5];
        1.0 + x * x + y * y
    };
    let margin = |[_, y]: [f64; 2]| if y % 57.0 == 0.0 { 3.0 } else { 1.0 };
    let sizes: [&dyn Fn([f64; 2]) -> f64; 3] = [&along, &outwards, &margin];
    for size in sizes {
        for seed in 0..20 {
            let z = noise(seed, &positions, size);
            let unevenness = Unevenness::of(&positions, &z).expect("uneven");
            let pairs = positions.iter().zip(&unevenness.factors);
            let mut far: Vec<f64> = pairs
                .map(|(position, [x, _])| x / size(*position))
                .collect();
            far.sort_by(f64::total_cmp);
            let [low, high] = [far[40], far[760]];
            assert!(high / low < 2.0, "{seed}: {low} {high}");
        }
    }
}

/// With few markers, noise that is fourfold at both ends is found in most cases.
#[test]
fn few_places_tell_of_noise_that_grows_much() {
    let positions = grid([15, 6]);
    let outwards = |[x, _]: [f64; 2]| 1.0 + 3.0 * ((x - 1014.0) / 14.0).powi(2);
    let detected = (0..200).filter(|seed| {
        let z = noise(*seed, &positions, outwards);
        Unevenness::of(&positions, &z).is_some()
    });
    let detected = detected.count();
    assert!(detected >= 120, "{detected} of 200");
}

/// As of ultrasound, which sees along its beam better than across.
#[test]
fn components_of_different_noise_are_found() {
    let positions = grid([20, 10]);
    for seed in 0..20 {
        let mut z = noise(seed, &positions, |_| 1.0);
        z.iter_mut().flatten().for_each(|vector| vector[1] *= 0.2);
        let unevenness = Unevenness::of(&positions, &z).expect("uneven");
        let [x, y] = unevenness.factors[0];
        assert!((x / y / 5.0 - 1.0).abs() < 0.3, "{seed}: {x} {y}");
    }
}

/// A smooth misfit much larger than the noise is not taken for noise.
#[test]
fn a_misfit_is_not_taken_for_noise() {
    let positions = grid([40, 20]);
    for seed in 0..20 {
        let mut z = noise(seed, &positions, |_| 1.0);
        for (vector, [x, y]) in z.iter_mut().flatten().zip(&positions) {
            vector[0] += 6.0 * (-((x - 1e3) / 25.0).powi(2)).exp();
            vector[1] += 3.0 * (y / 30.0).sin();
        }
        assert_eq!(Unevenness::of(&positions, &z), None, "{seed}");
    }
}

/// As where subsets of image correlation overlap: of one size everywhere, also at the margin.
#[test]
fn noise_that_correlates_is_not_uneven() {
    const REACH: usize = 8;
    let positions = grid([40, 20]);
    let wide = grid([40 + 2 * REACH, 20 + 2 * REACH]);
    let rows = 20 + 2 * REACH;
    for length in [0.5_f64, 1.0, 1.5, 2.5] {
        let weights: Vec<f64> = (0..=2 * REACH)
            .map(|step| (-0.5 * ((step as f64 - REACH as f64) / length).powi(2)).exp())
            .collect();
        let alarms = (0..40).filter(|seed| {
            let white = noise(*seed, &wide, |_| 1.0);
            let smooth = (0..40)
                .flat_map(|i| (0..20).map(move |j| [i, j]))
                .map(|[i, j]| {
                    let mut sum = [0.0; 2];
                    for (a, across) in weights.iter().enumerate() {
                        for (b, along) in weights.iter().enumerate() {
                            let z = white[(i + a) * rows + j + b].unwrap();
                            (0..2).for_each(|axis| sum[axis] += across * along * z[axis]);
                        }
                    }
                    Some(sum)
                });
            let smooth: Vec<_> = smooth.collect();
            Unevenness::of(&positions, &smooth).is_some()
        });
        let alarms = alarms.count();
        assert!(alarms <= 2, "{length}: {alarms} of 40");
    }
}

/// As of noise in proportion to each component of a displacement that grows along the sheet.
#[test]
fn noise_that_grows_in_one_component_alone_is_found_in_that_one() {
    let positions = grid([40, 20]);
    let along = |[x, _]: [f64; 2]| 10.0_f64.powf((x - 1e3) / 78.0);
    for seed in 0..20 {
        let mut z = noise(seed, &positions, |_| 1.0);
        for (vector, position) in z.iter_mut().flatten().zip(&positions) {
            vector[0] *= along(*position);
        }
        let unevenness = Unevenness::of(&positions, &z).expect("uneven");
        let (first, last) = (unevenness.factors[0], unevenness.factors[799]);
        let [x, y] = [0, 1].map(|axis| last[axis] / first[axis]);
        assert!(x > 4.0 && x < 20.0, "{seed}: {x}");
        assert!((0.5..2.0).contains(&y), "{seed}: {y}");
    }
}

#[test]
fn places_in_a_line_at_one_place_or_without_noise_are_answered() {
    let line: Vec<[f64; 2]> = (0..50).map(|i| [f64::from(i), 0.0]).collect();
    let one = vec![[3.0, 4.0]; 50];
    let repeated: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i / 10), 0.0]).collect();
    for positions in [&line, &one, &repeated] {
        let z = noise(1, positions, |_| 1.0);
        assert_eq!(Unevenness::of(positions, &z), None);
    }
    let grid = grid([10, 10]);
    assert_eq!(Unevenness::of(&grid, &vec![Some([0.0; 2]); 100]), None);
}

#[test]
fn factors_have_a_geometric_mean_of_one() {
    let positions = grid([40, 20]);
    let z = noise(1, &positions, |[x, _]| 0.1 + ((x - 1e3) / 20.0).powi(2));
    let unevenness = Unevenness::of(&positions, &z).expect("uneven");
    let logarithms = unevenness
        .factors
        .iter()
        .flatten()
        .map(|factor| factor.ln());
    assert!(logarithms.sum::<f64>().abs() < 1e-9);
}
