//! A ring under internal pressure. At small strain: Lamé's solution; at large strain: a round ring, and the displacements
//! and the supports' forces of a solution in one dimension.
//!
//! ```text
//! u(a) = (p a/E) ((b² + a²)/(b² − a²) + ν),   ν = ½                                      [mm]
//! R = p t r(a)      force of the supports on either line of symmetry of a quarter          [N]
//! ```
//!
//! # References
//! S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed., McGraw-Hill (1970), § 28, ISBN 0-07-064720-8

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use super::{held, sheet, solve};
use crate::document::Section;
use crate::error::Error;
use crate::mesh::{Block, CellShape, Mesh, mesh_of_blocks};
use crate::problem::Load;
use crate::solve::State;
use crate::validation::case::{
    Check, Computation, Outcome, Progress, check, largest, mean, mesh_figure, section,
};

mod one_dimension;

use one_dimension::Ring;

const INNER: f64 = 10.0;
const OUTER: f64 = 20.0;

/// Over Young's modulus.
const LARGE_PRESSURE: f64 = 0.12;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| mesh.count("cells", 4, 100));
    Box::new(move |progress| compute(cells, progress))
}

fn compute(cells: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let modulus = sheet().law.youngs_modulus();
    let pressure = 1e-6 * modulus;
    let squares = (OUTER * OUTER + INNER * INNER) / (OUTER * OUTER - INNER * INNER);
    let exact = pressure * INNER / modulus * (squares + 0.5);
    for (name, shape) in CellShape::NAMES {
        progress.tell(name);
        let mesh = quarter(cells, shape);
        let actual = inflate(&mesh, pressure, 1)?[0];
        let what = format!("{name}: inner displacement over Lamé's");
        let tolerance = if shape.degree() == 1 { 0.5 } else { 0.01 };
        let source = "Timoshenko and Goodier § 28";
        outcome
            .checks
            .push(check(what, "–", actual / exact).equal(1.0, tolerance, source));
    }
    let mesh = quarter(cells, CellShape::Quad9);
    let [grown, round] = inflate(&mesh, LARGE_PRESSURE * modulus, 6)?;
    let bore = 1.0 + grown / INNER;
    let what = format!("inflated to {bore:.2} of the inner radius: out of round");
    let source = "axisymmetry under a follower pressure";
    outcome
        .checks
        .push(check(what, "–", round).at_most(1e-5, source));
    for stretch in [1.5, 2.0] {
        outcome
            .checks
            .extend(compared_with_one_dimension(&mesh, stretch)?);
    }
    outcome.figures.push(mesh_figure(
        "ring.png",
        "One quarter of the ring; the pressure acts inside.",
        "Ring under pressure",
        &quarter(6, CellShape::Quad9),
    ));
    Ok(outcome)
}

/// The bore, the outside and the supports' forces under the pressure that stretches the bore so far in one dimension.
fn compared_with_one_dimension(mesh: &Mesh, stretch: f64) -> Result<Vec<Check>, Error> {
    let ring = Ring {
        radii: [INNER, OUTER],
        slope: &|_| sheet().law.shear_modulus() / 2.0,
    };
    let [pressure, outside] = ring.pressure(stretch);
    let solved = Inflated::new(mesh, pressure, 6)?;
    let radius = |group: &str| mean(deformed_radii(mesh, group, &solved.state));
    let force = pressure * sheet().thickness * INNER * stretch;
    let check = |what: &str, unit, computed| {
        check(
            format!("bore to {stretch} of its radius: {what}"),
            unit,
            computed,
        )
    };
    let adjacent = |what, unit, expected, computed| {
        let source = "one-dimensional solution by Runge-Kutta";
        check(what, unit, computed).equal(expected, 0.01, source)
    };
    let [across, along] = solved.forces.map(|force| -force);
    Ok(vec![
        adjacent(
            "radius of the bore",
            "mm",
            INNER * stretch,
            radius("inside"),
        ),
        adjacent("outer radius", "mm", OUTER + outside, radius("outside")),
        adjacent("force on the vertical line of symmetry", "N", force, across),
        adjacent(
            "force on the horizontal line of symmetry",
            "N",
            force,
            along,
        ),
        check(
            "unbalanced forces and moments, relative",
            "–",
            solved.unbalanced,
        )
        .at_most(1e-9, "global equilibrium"),
    ])
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
    let inflated = Inflated::new(&mesh, LARGE_PRESSURE * sheet().law.youngs_modulus(), 6)?;
    Ok((mesh, inflated.state))
}

/// A quarter under pressure.
struct Inflated {
    state: State,
    /// Of the supports across the vertical and the horizontal line of symmetry, in N.
    forces: [f64; 2],
    /// What is left of all forces and moments, relative.
    unbalanced: f64,
}

impl Inflated {
    fn new(mesh: &Mesh, pressure: f64, steps: usize) -> Result<Self, Error> {
        let mut problem = held(&[
            ("symmetry_x", [Some(0.0), None]),
            ("symmetry_y", [None, Some(0.0)]),
        ]);
        let load = Load::Pressure(pressure);
        problem.loads.push(("inside".into(), load));
        let energy = problem.finite_elements(mesh);
        let model = problem.on(mesh, &energy)?.named("ring");
        let state = solve(&model, steps)?;
        let reactions = model.reactions(&state);
        let force = |group, axis: usize| reactions.at_group(group).force[axis];
        Ok(Self {
            forces: [force("symmetry_x", 0), force("symmetry_y", 1)],
            unbalanced: reactions.balance().relative(),
            state,
        })
    }
}

/// The deformed distances of a group's nodes from the centre in mm.
fn deformed_radii(mesh: &Mesh, group: &str, state: &State) -> Vec<f64> {
    let radius = |node: &usize| {
        let position =
            [0, 1].map(|axis| mesh.nodes[*node][axis] + state.displacement[2 * node + axis]);
        position[0].hypot(position[1])
    };
    mesh.groups()[group].nodes.iter().map(radius).collect()
}

/// The mean radial displacement of the inner edge in mm, and how far it is from round, relative.
fn inflate(mesh: &Mesh, pressure: f64, steps: usize) -> Result<[f64; 2], Error> {
    let inflated = Inflated::new(mesh, pressure, steps)?;
    let radii = deformed_radii(mesh, "inside", &inflated.state);
    let mean = mean(radii.iter().copied());
    let out = largest(radii.iter().map(|radius| radius - mean));
    Ok([mean - INNER, out / mean])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pressure or a thickness that is a hundredth off misses this.
    #[test]
    fn a_bore_stretched_to_twice_its_radius_is_that_of_the_one_dimensional_solution() {
        let mesh = quarter(6, CellShape::Quad9);
        for stretch in [1.5, 2.0] {
            for check in compared_with_one_dimension(&mesh, stretch).unwrap() {
                assert!(check.passed(), "{check:?}");
            }
        }
    }
}
