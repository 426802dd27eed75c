//! A hole in a strip under tension, at small strain: Howland's stress concentration.
//!
//! A quarter is meshed: X and Y are axes of symmetry. The concentration is the stress beside the hole over the
//! mean stress of the whole strip; in a plane it does not depend on Poisson's ratio. Howland's values are
//! successive approximations by hand; a hole that is small compared with the width has Kirsch's concentration of 3.
//!
//! # References
//! R. C. J. Howland, Phil. Trans. R. Soc. Lond. A 229, 49 (1930), doi:10.1098/rsta.1930.0002

use std::f64::consts::FRAC_PI_4;
use std::path::Path;

use super::{held, solve, stress};
use crate::document::Section;
use crate::error::Error;
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::validation::case::{Computation, Outcome, Progress, check, mesh_figure, section};

/// Hole diameter over width, and the concentration: Kirsch's, then Howland's.
#[expect(clippy::approx_constant, reason = "3.14 is Howland's value")]
const HOWLAND: [(f64, f64); 6] = [
    (0.02, 3.0),
    (0.1, 3.03),
    (0.2, 3.14),
    (0.3, 3.36),
    (0.4, 3.74),
    (0.5, 4.32),
];

/// Half the width in mm.
const HALF: f64 = 20.0;
/// Half the length in mm.
const LENGTH: f64 = 160.0;
/// Mean strain: so small that the law is linear.
const STRAIN: f64 = 1e-6;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| mesh.count("cells", 4, 100));
    Box::new(move |progress| compute(cells, progress))
}

fn compute(cells: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    for (ratio, expected) in HOWLAND {
        progress.tell(&format!("diameter/width {ratio}"));
        let mesh = quarter(ratio * HALF, cells, CellShape::Quad9);
        let what = format!("stress concentration at diameter/width {ratio}");
        let actual = check(what, "–", concentration(&mesh, ratio * HALF)?);
        outcome
            .checks
            .push(actual.equal(expected, 1.0, "Kirsch 1898, Howland 1930"));
    }
    let mesh = quarter(0.5 * HALF, 6, CellShape::Quad9);
    outcome.figures.push(mesh_figure(
        "hole.png",
        "One quarter of the strip with a hole; the right side is pulled.",
        "Strip with a hole",
        &mesh,
    ));
    Ok(outcome)
}

/// A quarter of the strip with cells that grow away from the hole.
pub fn quarter(radius: f64, cells: usize, shape: CellShape) -> Mesh {
    // Cells grow in proportion to their distance.
    let ratio = HALF / radius;
    let grow = move |s: f64| (ratio.powf(s) - 1.0) / (ratio - 1.0);
    // From the hole at an angle to a point on the square around it.
    let spoke = move |angle: f64, to: [f64; 2], s: f64| {
        let from = [radius * angle.cos(), radius * angle.sin()];
        [0, 1].map(|axis| from[axis] + grow(s) * (to[axis] - from[axis]))
    };
    let lower = Block {
        map: Box::new(move |[s, t]| spoke(t * FRAC_PI_4, [HALF, HALF * (t * FRAC_PI_4).tan()], s)),
        cells: [cells, cells],
        sides: ["symmetry_y", "", "", "hole"],
    };
    let upper = Block {
        map: Box::new(move |[s, t]| {
            let angle = (1.0 + t) * FRAC_PI_4;
            spoke(angle, [HALF / angle.tan(), HALF], s)
        }),
        cells: [cells, cells],
        sides: ["", "top", "symmetry_x", "hole"],
    };
    let rest = Block {
        map: Box::new(move |[s, t]: [f64; 2]| {
            [HALF + s * (LENGTH - HALF), HALF * (t * FRAC_PI_4).tan()]
        }),
        cells: [2 * cells, cells],
        sides: ["symmetry_y", "right", "top", ""],
    };
    mesh_of_blocks(&[lower, upper, rest], shape)
}

fn concentration(mesh: &Mesh, radius: f64) -> Result<f64, Error> {
    let problem = held(&[
        ("symmetry_x", [Some(0.0), None]),
        ("symmetry_y", [None, Some(0.0)]),
        ("right", [Some(STRAIN * LENGTH), None]),
    ]);
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy)?.named("strip with a hole");
    let state = solve(&model, 1)?;
    let mean = model.reaction(&state, "right")[0] / (problem.thickness * HALF);
    let (cell, local) = mesh.locate([0.0, radius]);
    let gradient = mesh.gradient_at(&state.displacement, cell, local);
    Ok(stress(&*problem.law, gradient)[0] / mean)
}
