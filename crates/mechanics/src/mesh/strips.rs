//! Strips of varying width, and strips with a hole, as curved blocks.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::rc::Rc;

use super::blocks::Block;

/// A number of cells, at least one. Halves are rounded up, whatever the rounding of a conversion of units.
pub fn count(cells: f64) -> usize {
    const ROUNDING: f64 = 1e-9;
    ((cells * (1.0 + ROUNDING)).round() as usize).max(1)
}

/// The length over the width of a strip whose half width varies along it, in the mean along it.
pub fn lengths(length: f64, half_width: &impl Fn(f64) -> f64) -> f64 {
    Lengths::new(length, half_width).total()
}

/// A part of a strip up to a position along it.
pub struct Part {
    /// Where it ends.
    pub to: f64,
    /// Least number of cells along it.
    pub least: usize,
}

/// A strip whose half width varies along it, as blocks of its parts from 0 on: corners of its outline, between them, are nodes.
pub fn strip<'a>(
    parts: &[Part],
    across: usize,
    half_width: impl Fn(f64) -> f64 + Copy + 'a,
) -> Vec<Block<'a>> {
    let length = parts[parts.len() - 1].to;
    let lengths = Rc::new(Lengths::new(length, &half_width));
    let mut from = 0.0;
    let blocks = parts.iter().map(|Part { to, least }| {
        let [start, end] = [std::mem::replace(&mut from, *to), *to];
        let [before, after] = [start, end].map(|x| lengths.up_to(x));
        let lengths = Rc::clone(&lengths);
        Block {
            map: Box::new(move |[s, t]| {
                let x = match s {
                    0.0 => start,
                    1.0 => end,
                    _ => lengths.position(before + s * (after - before)),
                };
                [x, (2.0 * t - 1.0) * half_width(x)]
            }),
            cells: [count((after - before) * across as f64).max(*least), across],
            sides: [
                "bottom",
                if end == length { "right" } else { "" },
                "top",
                if start == 0.0 { "left" } else { "" },
            ],
        }
    });
    blocks.collect()
}

/// Positions along a strip that lie closer where it is narrower: l(x) = ∫ dx/width grows by equal amounts between them.
struct Lengths {
    /// x and l(x).
    table: Vec<[f64; 2]>,
}

impl Lengths {
    fn new(length: f64, half_width: &impl Fn(f64) -> f64) -> Self {
        const STEPS: usize = 2000;
        let step = length / STEPS as f64;
        let mut table = vec![[0.0, 0.0]];
        for i in 1..=STEPS {
            let middle = (i as f64 - 0.5) * step;
            let before = table[i - 1][1];
            table.push([i as f64 * step, before + step / (2.0 * half_width(middle))]);
        }
        Self { table }
    }

    /// The length over the width, in the mean along the strip.
    fn total(&self) -> f64 {
        self.table[self.table.len() - 1][1]
    }

    /// l up to a position.
    fn up_to(&self, x: f64) -> f64 {
        self.interpolated(x, [0, 1])
    }

    /// The position with some l.
    fn position(&self, l: f64) -> f64 {
        self.interpolated(l, [1, 0])
    }

    /// The value in one column of the table at a value of the other.
    fn interpolated(&self, value: f64, [given, wanted]: [usize; 2]) -> f64 {
        let next = self.table.partition_point(|row| row[given] < value);
        let next = next.clamp(1, self.table.len() - 1);
        let [low, high] = [self.table[next - 1], self.table[next]];
        low[wanted]
            + (high[wanted] - low[wanted]) * (value - low[given]) / (high[given] - low[given])
    }
}

/// A strip with a hole: four blocks between the hole and a square around it, with so many cells between them at least, and a block at each
/// end.
pub fn with_hole(
    [length, width]: [f64; 2],
    radius: f64,
    across: usize,
    adjacent: usize,
) -> Vec<Block<'static>> {
    let half = width.min(length) / 2.0;
    let middle = length / 2.0;
    let around = count(across as f64 / 2.0) * 2;
    let radial = count((half - radius) / width * across as f64 * 1.2).max(adjacent);
    let ends = count((middle - half) / width * across as f64);
    // The side of the square that lies in the direction `quarter` · 90°.
    let spoke = move |quarter: f64, side: [&'static str; 2]| {
        let [outer, hole] = side;
        Block {
            map: Box::new(move |[s, t]: [f64; 2]| {
                let angle = (2.0 * t - 1.0) * FRAC_PI_4;
                let (from, to) = (
                    [radius * angle.cos(), radius * angle.sin()],
                    [half, half * angle.tan()],
                );
                let [x, y] = [0, 1].map(|axis| from[axis] + s * (to[axis] - from[axis]));
                let (sine, cosine) = (quarter * FRAC_PI_2).sin_cos();
                [middle + cosine * x - sine * y, sine * x + cosine * y]
            }),
            cells: [radial, around],
            sides: ["", outer, "", hole],
        }
    };
    let end_side = |side: &'static str| if middle > half { "" } else { side };
    let mut blocks = vec![
        spoke(0.0, [end_side("right"), "hole"]),
        spoke(1.0, ["top", "hole"]),
        spoke(2.0, [end_side("left"), "hole"]),
        spoke(3.0, ["bottom", "hole"]),
    ];
    if middle > half {
        for (start, sides) in [
            (0.0, ["bottom", "", "top", "left"]),
            (middle + half, ["bottom", "right", "top", ""]),
        ] {
            blocks.push(Block {
                map: Box::new(move |[s, t]: [f64; 2]| {
                    let angle = (2.0 * t - 1.0) * FRAC_PI_4;
                    [start + s * (middle - half), half * angle.tan()]
                }),
                cells: [ends, around],
                sides,
            });
        }
    }
    blocks
}
