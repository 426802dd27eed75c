//! A cross whose arms are joined by arcs of circles, as curved blocks.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2};

use super::super::blocks::Block;
use super::super::strips::count;

/// The blocks of a cross of some length and width from tip to tip, with arms of one width and fillets of a radius between them: one in the
/// middle, one beside each side of it up to the end of the fillets, and one for the rest of each arm.
pub fn cruciform(
    size: [f64; 2],
    arm_width: f64,
    fillet: f64,
    across: usize,
) -> Vec<Block<'static>> {
    let half = 0.5 * arm_width;
    // Where an arc is cut by the diagonal, and where it ends.
    let (corner, end) = (half + fillet * (1.0 - 1.0 / SQRT_2), half + fillet);
    let cells = |length: f64| count(length / arm_width * across as f64);
    let middle = [0.5 * size[0], 0.0];
    let mut blocks = vec![Block {
        map: Box::new(move |share: [f64; 2]| {
            [0, 1].map(|axis| middle[axis] + corner * (2.0 * share[axis] - 1.0))
        }),
        cells: [across, across],
        sides: [""; 4],
    }];
    let tips = ["right", "top", "left", "bottom"];
    for (quarter, tip) in tips.into_iter().enumerate() {
        let (sine, cosine) = (quarter as f64 * FRAC_PI_2).sin_cos();
        let turned = move |[x, y]: [f64; 2]| {
            [
                middle[0] + cosine * x - sine * y,
                middle[1] + sine * x + cosine * y,
            ]
        };
        blocks.push(Block {
            map: Box::new(move |[s, t]| {
                let angle = (1.0 + s) * FRAC_PI_4;
                let edge = [end - fillet * angle.cos(), end - fillet * angle.sin()];
                turned([edge[0], (2.0 * t - 1.0) * edge[1]])
            }),
            cells: [cells(end - corner).max(2), across],
            sides: ["fillets", "", "fillets", ""],
        });
        let length = 0.5 * size[quarter % 2];
        blocks.push(Block {
            map: Box::new(move |[s, t]| {
                let x = match s {
                    1.0 => length,
                    _ => end + s * (length - end),
                };
                turned([x, (2.0 * t - 1.0) * half])
            }),
            cells: [cells(length - end), across],
            sides: ["arms", tip, "arms", ""],
        });
    }
    blocks
}
