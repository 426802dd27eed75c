//! A manufactured solution: body forces for which a chosen field is the exact one, and the order at which
//! every element comes near to it.
//!
//! ```text
//! f = −Div P(∂u/∂X),   u = L (a sin πX/L cos πY/L, b cos πX/L sin πY/L)                [MPa/mm]
//! ```

use std::f64::consts::PI;
use std::path::Path;

use super::{distorted, misfit, sheet, solve, stress};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::mesh::{CellShape, GAUSS_5, Mesh};
use crate::problem::{BoundaryProblem, Support};
use crate::results::{Axis, Line, LineChart, PALETTE, Stroke};
use crate::solve::State;
use crate::validation::case::{Check, Figure, Outcome, Prepared, Progress, Wanted};

/// For messages.
const NAME: &str = "manufactured solution";

/// Side of the square in mm.
const SIDE: f64 = 10.0;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Prepared {
    let section = root.section("mesh");
    let cells = section.count("coarsest", 2, 32);
    section.unknown_keys();
    let section = root.section("field");
    let amplitude = section.number("amplitude", Bound::Within(1e-3, 0.1));
    section.unknown_keys();
    Box::new(move |progress| compute(cells, amplitude, progress))
}

/// The chosen field.
#[derive(Clone, Copy)]
pub struct Field {
    a: f64,
    b: f64,
}

impl Field {
    fn new(amplitude: f64) -> Self {
        Self {
            a: amplitude,
            b: -0.7 * amplitude,
        }
    }

    fn displacement(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ((sx, cx), (sy, cy)) = ((PI * x / SIDE).sin_cos(), (PI * y / SIDE).sin_cos());
        [SIDE * self.a * sx * cy, SIDE * self.b * cx * sy]
    }

    /// Its displacement gradient, components 11, 12, 21, 22.
    pub fn gradient(self, [x, y]: [f64; 2]) -> [f64; 4] {
        let ((sx, cx), (sy, cy)) = ((PI * x / SIDE).sin_cos(), (PI * y / SIDE).sin_cos());
        [
            PI * self.a * cx * cy,
            -PI * self.a * sx * sy,
            -PI * self.b * sx * sy,
            PI * self.b * cx * cy,
        ]
    }

    /// −Div P by central differences of the sixth order.
    fn body_force(self, problem: &BoundaryProblem, point: [f64; 2]) -> [f64; 2] {
        const STENCIL: [(f64, f64); 3] = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
        let h = 2e-3 * SIDE;
        let mut force = [0.0; 2];
        for axis in 0..2 {
            let at = |step: f64| {
                let mut moved = point;
                moved[axis] += step;
                stress(&*problem.law, self.gradient(moved))
            };
            for (steps, weight) in STENCIL {
                let (up, down) = (at(steps * h), at(-steps * h));
                for (row, force) in force.iter_mut().enumerate() {
                    *force -= weight * (up[2 * row + axis] - down[2 * row + axis]) / h;
                }
            }
        }
        force
    }
}

fn compute(coarsest: usize, amplitude: f64, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut lines = Vec::new();
    for ((name, shape), colour) in CellShape::NAMES.into_iter().zip(PALETTE) {
        progress(name);
        let meshes = [1, 2, 4].map(|finer| coarsest * finer);
        let mut errors = Vec::new();
        for cells in meshes {
            errors.push(error(shape, cells, amplitude)?);
        }
        let degree = shape.degree() as f64;
        for (norm, label) in [(0, "L2"), (1, "H1")] {
            let order = (errors[1][norm] / errors[2][norm]).log2();
            let expected = degree + 1.0 - norm as f64;
            outcome.checks.push(Check::new(
                format!("{name}: |order in {label} − {expected}|"),
                "–",
                Wanted::AtMost(0.1),
                "approximation theory",
                (order - expected).abs(),
            ));
            let points = meshes.iter().zip(&errors);
            lines.push(Line {
                label: format!("{name}, {label}"),
                points: points
                    .map(|(cells, error)| [SIDE / *cells as f64, error[norm]])
                    .collect(),
                colour,
                stroke: if norm == 0 {
                    Stroke::Marked
                } else {
                    Stroke::Dashed
                },
            });
        }
    }
    outcome.figures.push(Figure::new(
        "manufactured_solution.png",
        "Error of every element over the size of its cells.",
        LineChart {
            title: "Manufactured solution".into(),
            x: Axis::logarithmic("size of the cells [mm]"),
            y: Axis::logarithmic("relative error [–]"),
            lines,
            band: None,
        },
    ));
    Ok(outcome)
}

/// The solution on a distorted mesh and the exact field.
pub fn solved(
    shape: CellShape,
    cells: usize,
    amplitude: f64,
) -> Result<(Mesh, State, Field), Error> {
    let mesh = distorted([SIDE; 2], [cells; 2], shape);
    let field = Field::new(amplitude);
    let problem = sheet();
    let energy = problem.finite_elements(&mesh);
    let mut model = problem.on(&mesh, &energy).map_err(misfit)?;
    model.impose_field("boundary", |point| field.displacement(point));
    model.add_forces(&forces(&mesh, &problem, field));
    let state = solve(&model, NAME, 1)?;
    drop(model);
    Ok((mesh, state, field))
}

/// The force of the right side in N and the exact one.
pub struct Force {
    pub found: f64,
    pub exact: f64,
    /// The field that a unit motion of the side brings about.
    pub influence: Vec<f64>,
}

/// The solution between four rollers, on which the chosen field slides without shear, and the force of the right one.
pub fn between_rollers(
    shape: CellShape,
    cells: usize,
    amplitude: f64,
) -> Result<(Mesh, State, Force), Error> {
    let mesh = distorted([SIDE; 2], [cells; 2], shape);
    let field = Field::new(amplitude);
    let sides = ["left", "right", "bottom", "top"];
    let problem = BoundaryProblem {
        supports: sides.map(|side| (side.into(), Support::Roller)).into(),
        ..sheet()
    };
    let energy = problem.finite_elements(&mesh);
    let mut model = problem.on(&mesh, &energy).map_err(misfit)?;
    model.add_forces(&forces(&mesh, &problem, field));
    let state = solve(&model, NAME, 1)?;
    let influence = model.influence(&state, "right", 0);
    let force = Force {
        found: model.reaction(&state, "right")[0],
        exact: side_force(&problem, field),
        influence: influence.map_err(|fault| Error::Solve {
            model: NAME.to_owned(),
            step: "load factor 1".to_owned(),
            fault,
        })?,
    };
    drop(model);
    Ok((mesh, state, force))
}

/// t ∫ P₁₁ dY along the right side in N, by a midpoint rule: P₁₁ is even about both ends, so that it is exact but for
/// rounding.
fn side_force(problem: &BoundaryProblem, field: Field) -> f64 {
    const POINTS: usize = 200;
    let step = SIDE / POINTS as f64;
    let places = (0..POINTS).map(|i| [SIDE, (i as f64 + 0.5) * step]);
    let stresses = places.map(|place| stress(&*problem.law, field.gradient(place))[0]);
    problem.thickness * step * stresses.sum::<f64>()
}

/// Relative errors in L2 and in H1 on a distorted mesh.
fn error(shape: CellShape, cells: usize, amplitude: f64) -> Result<[f64; 2], Error> {
    let (mesh, state, field) = solved(shape, cells, amplitude)?;
    let mut sums = [[0.0; 2]; 2];
    each_point(&mesh, |cell, local, place, volume| {
        let u = &state.displacement;
        let values = mesh.shape(cell).values(local);
        let found = [0, 1].map(|axis| {
            let nodes = mesh.cell(cell).iter().zip(&values);
            nodes
                .map(|(node, value)| value * u[2 * node + axis])
                .sum::<f64>()
        });
        let exact = field.displacement(place);
        for axis in 0..2 {
            sums[0][0] += volume * (found[axis] - exact[axis]).powi(2);
            sums[0][1] += volume * exact[axis].powi(2);
        }
        let exact = field.gradient(place);
        for (found, exact) in mesh.gradient_at(u, cell, local).iter().zip(exact) {
            sums[1][0] += volume * (found - exact).powi(2);
            sums[1][1] += volume * exact.powi(2);
        }
    });
    Ok(sums.map(|[error, size]| (error / size).sqrt()))
}

/// Nodal forces in N of the body force.
fn forces(mesh: &Mesh, problem: &BoundaryProblem, field: Field) -> Vec<f64> {
    let mut forces = vec![0.0; 2 * mesh.nodes.len()];
    each_point(mesh, |cell, local, place, area| {
        let density = field.body_force(problem, place);
        let values = mesh.shape(cell).values(local);
        for (node, value) in mesh.cell(cell).iter().zip(values) {
            for axis in 0..2 {
                forces[2 * node + axis] += problem.thickness * area * value * density[axis];
            }
        }
    });
    forces
}

/// Calls with cell, reference point, place and area of every point of a rule that is finer than the elements'.
fn each_point(mesh: &Mesh, mut call: impl FnMut(usize, [f64; 2], [f64; 2], f64)) {
    for cell in 0..mesh.cell_count() {
        let shape = mesh.shape(cell);
        for (local, weight) in shape.product_quadrature(&GAUSS_5) {
            let area = weight * mesh.gradients(cell, local).1;
            call(cell, local, mesh.place(cell, local), area);
        }
    }
}
