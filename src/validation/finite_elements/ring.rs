//! A ring under pressure inside, at small strain: Lamé's solution, and turned pressure at large strain.
//!
//! ```text
//! u(a) = (p a/E) ((b² + a²)/(b² − a²) + ν),   ν = ½                                      [mm]
//! ```
//!
//! # References
//! S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed., McGraw-Hill (1970), § 28, ISBN 0-07-064720-8

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use super::{held, misfit, sheet, solve};
use crate::boundary::Load;
use crate::document::Section;
use crate::error::Error;
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::solve::State;
use crate::validation::{Check, Outcome, Prepared, Progress, Wanted, mesh_figure};

const INNER: f64 = 10.0;
const OUTER: f64 = 20.0;

/// Over Young's modulus.
const LARGE_PRESSURE: f64 = 0.12;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let cells = section.count("cells", 4, 100);
    section.unknown_keys();
    Box::new(move |progress| compute(cells, progress))
}

fn compute(cells: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let modulus = sheet().law.youngs_modulus();
    let pressure = 1e-6 * modulus;
    let squares = (OUTER * OUTER + INNER * INNER) / (OUTER * OUTER - INNER * INNER);
    let exact = pressure * INNER / modulus * (squares + 0.5);
    for (name, shape) in CellShape::NAMES {
        progress(name);
        let mesh = quarter(cells, shape);
        let found = inflate(&mesh, pressure, 1)?[0];
        outcome.checks.push(Check::new(
            format!("{name}: inner displacement over Lamé's"),
            "–",
            Wanted::Equal(1.0, if shape.degree() == 1 { 0.5 } else { 0.01 }),
            "Timoshenko and Goodier § 28",
            found / exact,
        ));
    }
    let mesh = quarter(cells, CellShape::Quad9);
    let [grown, round] = inflate(&mesh, LARGE_PRESSURE * modulus, 6)?;
    outcome.checks.push(Check::new(
        format!(
            "inflated to {:.2} of the inner radius: out of round",
            1.0 + grown / INNER
        ),
        "–",
        Wanted::AtMost(1e-5),
        "symmetry of a pressure that follows the surface",
        round,
    ));
    outcome.figures.push(mesh_figure(
        "ring.png",
        "A quarter of the ring; the pressure acts inside.",
        "Ring under pressure",
        &quarter(6, CellShape::Quad9),
    ));
    Ok(outcome)
}

fn quarter(cells: usize, shape: CellShape) -> Mesh {
    let block = Block {
        map: Box::new(|[s, t]: [f64; 2]| {
            let radius = INNER + s * (OUTER - INNER);
            let (sine, cosine) = (t * FRAC_PI_2).sin_cos();
            [radius * cosine, radius * sine]
        }),
        cells: [cells, 2 * cells],
        sides: ["symmetry_y", "outside", "symmetry_x", "inside"],
    };
    mesh_of_blocks(&[block], shape)
}

/// A quarter of the ring, and its state at the large pressure.
pub fn blown_up(cells: usize, shape: CellShape) -> Result<(Mesh, State), Error> {
    let mesh = quarter(cells, shape);
    let state = pressed(&mesh, LARGE_PRESSURE * sheet().law.youngs_modulus(), 6)?;
    Ok((mesh, state))
}

fn pressed(mesh: &Mesh, pressure: f64, steps: usize) -> Result<State, Error> {
    let mut problem = held(&[
        ("symmetry_x", [Some(0.0), None]),
        ("symmetry_y", [None, Some(0.0)]),
    ]);
    problem
        .loads
        .push(("inside".into(), Load::Pressure(pressure)));
    let energy = problem.finite_elements(mesh);
    let model = problem.on(mesh, &energy).map_err(misfit)?;
    solve(&model, "ring", steps)
}

/// The mean radial displacement of the inner edge in mm, and how far it is from round, relative.
fn inflate(mesh: &Mesh, pressure: f64, steps: usize) -> Result<[f64; 2], Error> {
    let state = pressed(mesh, pressure, steps)?;
    let radii = mesh.groups()["inside"].nodes.iter().map(|node| {
        let place =
            [0, 1].map(|axis| mesh.nodes[*node][axis] + state.displacement[2 * node + axis]);
        place[0].hypot(place[1])
    });
    let radii: Vec<f64> = radii.collect();
    let mean = radii.iter().sum::<f64>() / radii.len() as f64;
    let out = radii
        .iter()
        .fold(0.0, |most: f64, radius| most.max((radius - mean).abs()));
    Ok([mean - INNER, out / mean])
}
