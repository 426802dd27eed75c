//! A slender cantilever under a shear force at its end, at small strain.
//!
//! ```text
//! δ = F L³/(3 E I) + (4 + 5 ν) F h² L/(24 E I),   I = t h³/12,   ν = ½                    [mm]
//! ```
//!
//! The supported section is given the warping and the contraction of that solution; a rigid clamp would be
//! stiffer.
//!
//! # References
//! S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, 3rd ed., McGraw-Hill (1970), § 21, ISBN 0-07-064720-8

use std::path::Path;

use super::{distorted, sheet, solve};
use crate::document::Section;
use crate::error::Error;
use crate::mesh::CellShape;
use crate::problem::Load;
use crate::validation::case::{Computation, Outcome, Progress, check, mean, section};

const LENGTH: f64 = 100.0;
const HEIGHT: f64 = 10.0;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| mesh.count("cells", 2, 40));
    Box::new(move |progress| compute(cells, progress))
}

fn compute(cells: usize, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let elements = CellShape::NAMES.into_iter();
    for (name, shape) in elements.filter(|(_, shape)| shape.degree() > 1) {
        progress.tell(name);
        let what = format!("{name}: deflection over the beam's");
        let deflection = check(what, "–", deflection(shape, cells)?);
        outcome
            .checks
            .push(deflection.equal(1.0, 0.2, "Timoshenko and Goodier § 21"));
    }
    Ok(outcome)
}

/// Mean deflection of the end over that of the beam.
fn deflection(shape: CellShape, cells: usize) -> Result<f64, Error> {
    let mesh = distorted([LENGTH, HEIGHT], [10 * cells, cells], shape);
    let mut problem = sheet();
    let modulus = problem.law.youngs_modulus();
    let shear = 1e-9 * modulus;
    problem
        .loads
        .push(("right".into(), Load::Traction([0.0, shear])));
    let energy = problem.finite_elements(&mesh);
    let force = shear * problem.thickness * HEIGHT;
    let inertia = problem.thickness * HEIGHT.powi(3) / 12.0;
    let mut model = problem.on(&mesh, &energy)?.named("cantilever");
    // The section at the support warps and contracts as the solution does.
    let share = force / (6.0 * modulus * inertia);
    model.impose_field("left", |[_, y]| {
        let y = y - HEIGHT / 2.0;
        let warp = -share * y * 2.5 * (y * y - HEIGHT * HEIGHT / 4.0);
        [warp, share * 1.5 * y * y * LENGTH]
    });
    let state = solve(&model, 1)?;
    let bent = force * LENGTH.powi(3) / (3.0 * modulus * inertia);
    let sheared = (4.0 + 2.5) * force * HEIGHT * HEIGHT * LENGTH / (24.0 * modulus * inertia);
    let end = mesh.groups()["right"].nodes.iter();
    let deflection = mean(end.map(|node| state.displacement[2 * node + 1]));
    Ok(deflection / (bent + sheared))
}
