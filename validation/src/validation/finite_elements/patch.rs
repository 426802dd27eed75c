//! Patch tests, homogeneous tests and rigid turns on distorted meshes of every element.

use std::path::Path;

use super::{distorted, held, largest_error, sheet, solve, stress};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::material::curve::Mode;
use crate::mesh::{CellShape, Mesh};
use crate::problem::{BoundaryProblem, Support};
use crate::solve::assembly::derivative_errors;
use crate::statistics::larger;
use crate::validation::case::{Check, Computation, Outcome, Progress, check, section};

const SIZE: [f64; 2] = [60.0, 40.0];

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| mesh.count_pair("cells", 2, 60));
    let cells = cells.unwrap_or([2, 2]);
    let stretch = section(root, "load", |load| {
        load.number("stretch", Bound::Within(1.0, 3.0))
    });
    Box::new(move |progress| compute(cells, stretch, progress))
}

fn compute(cells: [usize; 2], stretch: f64, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    for (name, shape) in CellShape::NAMES {
        progress.tell(name);
        outcome
            .checks
            .extend(element_checks(name, shape, cells, stretch)?);
    }
    Ok(outcome)
}

fn element_checks(
    name: &str,
    shape: CellShape,
    cells: [usize; 2],
    stretch: f64,
) -> Result<Vec<Check>, Error> {
    let error = |what: &str, error: f64| check(format!("{name}: {what}"), "–", error);
    let patch = error("linear field on a distorted patch", patch(shape, cells)?);
    let mut checks = vec![patch.at_most(1e-12, "linear field")];
    for (mode_name, mode) in Mode::ALL {
        let what = format!("{mode_name} tension to λ = {stretch}, field and stress");
        let actual = error(&what, homogeneous(shape, cells, mode, stretch)?);
        checks.push(actual.at_most(1e-12, "closed form"));
    }
    let shear = stretch - 1.0;
    let what = format!("simple shear γ = {shear}, force");
    let actual = error(&what, simple_shear(shape, cells, shear)?);
    checks.push(actual.at_most(1e-12, "closed form"));
    let turn = error("rigid rotation by 90°, field", turn(shape, cells)?);
    checks.push(turn.at_most(1e-12, "rigid rotation"));
    let [residual, tangent] = derivatives(shape, cells);
    checks.extend([
        error("residual compared with differences of the energy", residual)
            .at_most(1e-7, "differences"),
        error("tangent compared with differences of the residual", tangent)
            .at_most(1e-7, "differences"),
    ]);
    Ok(checks)
}

/// Error of the nodes inside when the boundary follows a linear field.
fn patch(shape: CellShape, cells: [usize; 2]) -> Result<f64, Error> {
    let mesh = distorted(SIZE, cells, shape);
    let field = |[x, y]: [f64; 2]| [0.3 * x + 0.1 * y, -0.05 * x - 0.2 * y];
    let problem = sheet();
    let energy = problem.finite_elements(&mesh);
    let mut model = problem.on(&mesh, &energy)?.named("patch test");
    model.impose_field("boundary", field);
    let state = solve(&model, 2)?;
    Ok(largest_error(&mesh, &state.displacement, field))
}

/// Largest error of field and stress in a homogeneous test between rollers.
fn homogeneous(
    shape: CellShape,
    cells: [usize; 2],
    mode: Mode,
    stretch: f64,
) -> Result<f64, Error> {
    let mesh = distorted(SIZE, cells, shape);
    let x = stretch - 1.0;
    let across = match mode {
        Mode::Uniaxial => -x / (stretch + stretch.sqrt()),
        Mode::Planar => 0.0,
        Mode::Equibiaxial => x,
    };
    let mut supports = vec![
        ("left", [Some(0.0), None]),
        ("bottom", [None, Some(0.0)]),
        ("right", [Some(x * SIZE[0]), None]),
    ];
    if mode != Mode::Uniaxial {
        supports.push(("top", [None, Some(across * SIZE[1])]));
    }
    let problem = held(&supports);
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy)?.named(mode.name());
    let state = solve(&model, 4)?;
    let field = largest_error(&mesh, &state.displacement, |[px, py]| [x * px, across * py]);
    let force = model.reaction(&state, "right")[0];
    let actual = force / (problem.thickness * SIZE[1]);
    let exact = mode.nominal_stress(&*problem.law, x);
    Ok(larger(field, (actual / exact - 1.0).abs()))
}

/// Error of the shear force on the upper side when the boundary is sheared.
fn simple_shear(shape: CellShape, cells: [usize; 2], amount: f64) -> Result<f64, Error> {
    let mesh = distorted(SIZE, cells, shape);
    let problem = sheet();
    let energy = problem.finite_elements(&mesh);
    let mut model = problem.on(&mesh, &energy)?.named("simple shear");
    let field = |[_, y]: [f64; 2]| [amount * y, 0.0];
    model.impose_field("boundary", field);
    let state = solve(&model, 2)?;
    let inside = largest_error(&mesh, &state.displacement, field);
    // The stress of all cells: forces on the sides share their corners.
    let exact = stress(&*problem.law, [0.0, amount, 0.0, 0.0])[1];
    let mean = mean_shear_stress(&mesh, &problem, &state.displacement);
    Ok(larger(inside, (mean / exact - 1.0).abs()))
}

/// P₁₂ averaged over the area.
fn mean_shear_stress(mesh: &Mesh, problem: &BoundaryProblem, displacement: &[f64]) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for cell in 0..mesh.cell_count() {
        for (point, weight) in mesh.shape(cell).quadrature() {
            let part = weight * mesh.gradients(cell, point).1;
            let gradient = mesh.gradient_at(displacement, cell, point);
            sum += part * stress(&*problem.law, gradient)[1];
            area += part;
        }
    }
    sum / area
}

/// Error of the nodes when one side turns by 90° and nothing else holds the sheet.
fn turn(shape: CellShape, cells: [usize; 2]) -> Result<f64, Error> {
    let mesh = distorted(SIZE, cells, shape);
    let mut problem = sheet();
    let angle = std::f64::consts::FRAC_PI_2;
    let centre = [10.0, 5.0];
    let support = Support::Rotation { centre, angle };
    problem.supports.push(("left".into(), support));
    let energy = problem.finite_elements(&mesh);
    let model = problem.on(&mesh, &energy)?.named("rigid turn");
    let state = solve(&model, 4)?;
    let exact = |[x, y]: [f64; 2]| {
        let (dx, dy) = (x - centre[0], y - centre[1]);
        [-dy - dx, dx - dy]
    };
    Ok(largest_error(&mesh, &state.displacement, exact))
}

/// Relative errors of residual and tangent with respect to difference quotients, in a bent state.
fn derivatives(shape: CellShape, cells: [usize; 2]) -> [f64; 2] {
    let mesh = distorted(SIZE, cells, shape);
    let energy = sheet().finite_elements(&mesh);
    let bent = |[x, y]: &[f64; 2]| [0.2 * x + 0.002 * x * y, -0.1 * y + 0.001 * x * x];
    let u: Vec<f64> = mesh.nodes.iter().flat_map(bent).collect();
    let route = |i: usize| (1.0 + i as f64 * 0.7).sin();
    let direction: Vec<f64> = (0..u.len()).map(route).collect();
    derivative_errors(&energy, &u, &direction)
}
