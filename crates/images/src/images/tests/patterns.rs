//! Patterns on specimens, as formulas.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A pattern on the specimen: lightness from 0 to about 1 at each material point in pixels.
pub type Pattern = Box<dyn Fn([f64; 2]) -> f64 + Sync>;

/// Blobs of random positions and sizes, about 4 pixels wide at half height.
pub fn speckle(seed: u64) -> Pattern {
    const CELL: f64 = 5.0;
    const COUNT: usize = 128;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut number = |low: f64, high: f64| random.random_range(low..high);
    let blobs: Vec<[f64; 4]> = (0..COUNT * COUNT)
        .map(|_| {
            [
                number(0.0, CELL),
                number(0.0, CELL),
                number(1.3, 2.1),
                number(0.4, 1.0),
            ]
        })
        .collect();
    Box::new(move |[x, y]| {
        let (column, row) = ((x / CELL).floor(), (y / CELL).floor());
        let mut sum = 0.0;
        for (i, j) in (-2..=2).flat_map(|j| (-2..=2).map(move |i| (f64::from(i), f64::from(j)))) {
            let wrap = |at: f64| at.rem_euclid(COUNT as f64) as usize;
            let [a, b, size, light] = blobs[wrap(row + j) * COUNT + wrap(column + i)];
            let (dx, dy) = (x - (column + i) * CELL - a, y - (row + j) * CELL - b);
            sum += light * (-(dx * dx + dy * dy) / (2.0 * size * size)).exp();
        }
        0.1 + 0.75 * sum.min(1.6) / 1.6
    })
}

/// Waves of all directions whose amplitude grows with their length, as in images of nature.
pub fn natural(seed: u64) -> Pattern {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let waves: Vec<[f64; 4]> = (0..120)
        .map(|_| {
            let length = 5.0 * 12.0_f64.powf(random.random::<f64>());
            let (angle, phase) = (
                random.random_range(0.0..std::f64::consts::TAU),
                random.random_range(0.0..std::f64::consts::TAU),
            );
            let k = std::f64::consts::TAU / length;
            [
                k * angle.cos(),
                k * angle.sin(),
                phase,
                0.012 * length.sqrt(),
            ]
        })
        .collect();
    Box::new(move |[x, y]| {
        0.5 + waves
            .iter()
            .map(|[a, b, c, d]| d * (a * x + b * y + c).sin())
            .sum::<f64>()
    })
}

/// Tags as in magnetic resonance: a lattice of dark lines.
pub fn tags(distance: f64) -> Pattern {
    Box::new(move |[x, y]| {
        let wave = |x: f64| (std::f64::consts::PI * x / distance).sin().abs();
        0.1 + 0.8 * (wave(x) * wave(y)).sqrt()
    })
}

/// Threads 7 pixels apart over and under each other, each of a lightness of its own that varies along it.
pub fn weave(seed: u64) -> Pattern {
    const APART: f64 = 7.0;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let threads: Vec<[f64; 3]> = (0..2048)
        .map(|_| {
            [0.4, 40.0, 0.0]
                .map(|least: f64| least + (1.0 - 0.5 * least.min(1.0)) * random.random::<f64>())
        })
        .collect();
    Box::new(move |[x, y]| {
        let thread = |across: f64, along: f64, first: usize| {
            let number = (across / APART).floor();
            let [light, length, phase] = threads[first + number as usize % 1024];
            let round = (std::f64::consts::PI * across / APART).sin().abs();
            let varied = 1.0 + 0.3 * (std::f64::consts::TAU * (along / length + phase)).sin();
            light * varied * (0.3 + 0.7 * round)
        };
        let over = (std::f64::consts::TAU * x / (2.0 * APART)).sin()
            * (std::f64::consts::TAU * y / (2.0 * APART)).sin();
        let share = 0.5 + 0.5 * (3.0 * over).tanh();
        0.75 * (share * thread(x, y, 0) + (1.0 - share) * thread(y, x, 1024))
    })
}
