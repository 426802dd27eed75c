//! A manufactured solution: body forces for which a chosen field is the exact one, and the order at which
//! every element converges to it.
//!
//! ```text
//! f = −Div P(∂u/∂X),   u = L (a sin πX/L cos πY/L, b cos πX/L sin πY/L)                [MPa/mm]
//! ```

use std::f64::consts::PI;
use std::path::Path;

use super::{distorted, sheet, solve, stress};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::mesh::{CellShape, GAUSS_5, Mesh};
use crate::problem::{BoundaryProblem, Support};
use crate::results::{Axis, Line, LineChart, PALETTE, Stroke};
use crate::solve::State;
use crate::validation::case::{
    Check, Computation, Figure, Outcome, Progress, Squares, check, failed, line, section,
};

/// For messages.
const NAME: &str = "manufactured solution";

/// Side of the square in mm.
const SIDE: f64 = 10.0;

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let cells = section(root, "mesh", |mesh| mesh.count("coarsest", 2, 32));
    let amplitude = section(root, "field", |field| {
        field.number("amplitude", Bound::Within(1e-3, 0.1))
    });
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
        progress.tell(name);
        let convergence = Convergence::new(name, shape, coarsest, amplitude)?;
        outcome.checks.extend(convergence.checks());
        lines.extend(convergence.lines(colour));
    }
    let x = Axis::logarithmic("size of the cells [mm]");
    let y = Axis::logarithmic("relative error [–]");
    outcome.figures.push(Figure::new(
        "manufactured_solution.png",
        "Error of each element type against cell size.",
        LineChart::new("Manufactured solution", x, y, lines),
    ));
    Ok(outcome)
}

/// Relative errors in L2 and in H1.
struct Errors {
    l2: f64,
    h1: f64,
}

/// An element on three meshes, each twice as fine as the one before.
struct Convergence {
    name: &'static str,
    shape: CellShape,
    /// Sizes of the cells in mm.
    sizes: [f64; 3],
    errors: [Errors; 3],
}

impl Convergence {
    fn new(
        name: &'static str,
        shape: CellShape,
        coarsest: usize,
        amplitude: f64,
    ) -> Result<Self, Error> {
        let cells = [1, 2, 4].map(|finer| coarsest * finer);
        let [coarse, middle, fine] = cells.map(|cells| Errors::new(shape, cells, amplitude));
        Ok(Self {
            name,
            shape,
            sizes: cells.map(|cells| SIDE / cells as f64),
            errors: [coarse?, middle?, fine?],
        })
    }

    /// The errors of the three meshes in both norms.
    fn norms(&self) -> [(&'static str, [f64; 3]); 2] {
        [
            ("L2", self.errors.each_ref().map(|errors| errors.l2)),
            ("H1", self.errors.each_ref().map(|errors| errors.h1)),
        ]
    }

    fn checks(&self) -> [Check; 2] {
        let degree = self.shape.degree() as f64;
        let [l2, h1] = self.norms();
        [(l2, degree + 1.0), (h1, degree)].map(|((norm, [_, middle, fine]), expected)| {
            let order = (middle / fine).log2();
            let what = format!("{}: |order in {norm} − {expected}|", self.name);
            check(what, "–", (order - expected).abs()).at_most(0.1, "approximation theory")
        })
    }

    fn lines(&self, colour: [u8; 3]) -> [Line; 2] {
        let [l2, h1] = self.norms();
        [(l2, Stroke::Marked), (h1, Stroke::Dashed)].map(|((norm, errors), stroke)| {
            let label = format!("{}, {norm}", self.name);
            line(&label, &self.sizes, &errors, colour, stroke)
        })
    }
}

/// The solution on a distorted mesh and the exact field.
pub struct Solved {
    /// The distorted mesh.
    pub mesh: Mesh,
    /// The equilibrium on it.
    pub state: State,
    /// The exact field.
    pub field: Field,
}

impl Solved {
    /// Solves so many cells along a side under a field of some amplitude.
    ///
    /// # Errors
    /// [`Error::Solve`] where there is no equilibrium.
    pub fn new(shape: CellShape, cells: usize, amplitude: f64) -> Result<Self, Error> {
        let mesh = distorted([SIDE; 2], [cells; 2], shape);
        let field = Field::new(amplitude);
        let problem = sheet();
        let energy = problem.finite_elements(&mesh);
        let mut model = problem.on(&mesh, &energy)?.named(NAME);
        model.impose_field("boundary", |point| field.displacement(point));
        model.add_forces(&forces(&mesh, &problem, field));
        let state = solve(&model, 1)?;
        drop(model);
        Ok(Self { mesh, state, field })
    }
}

/// The solution between four rollers, on which the chosen field slides without shear.
pub struct Pull {
    /// The distorted mesh.
    pub mesh: Mesh,
    /// The equilibrium on it.
    pub state: State,
    /// The force of the right side in N.
    pub computed: f64,
    /// The exact one.
    pub exact: f64,
    /// The field that a unit motion of the side brings about.
    pub influence: Vec<f64>,
}

impl Pull {
    /// Solves so many cells along a side under a field of some amplitude.
    ///
    /// # Errors
    /// [`Error::Solve`] where there is no equilibrium.
    pub fn new(shape: CellShape, cells: usize, amplitude: f64) -> Result<Self, Error> {
        let mesh = distorted([SIDE; 2], [cells; 2], shape);
        let field = Field::new(amplitude);
        let sides = ["left", "right", "bottom", "top"];
        let problem = BoundaryProblem {
            supports: sides.map(|side| (side.into(), Support::Roller)).into(),
            ..sheet()
        };
        let energy = problem.finite_elements(&mesh);
        let mut model = problem.on(&mesh, &energy)?.named(NAME);
        model.add_forces(&forces(&mesh, &problem, field));
        let state = solve(&model, 1)?;
        let mut influences = model.influences(std::slice::from_ref(&state), "right", 0);
        let influence = influences
            .remove(0)
            .map_err(failed(NAME, "load factor 1"))?;
        let computed = model.reaction(&state, "right")[0];
        drop(model);
        Ok(Self {
            mesh,
            state,
            computed,
            exact: side_force(&problem, field),
            influence,
        })
    }
}

/// t ∫ P₁₁ dY along the right side in N, by a midpoint rule: P₁₁ is even about both ends, so that it is exact but for
/// rounding.
fn side_force(problem: &BoundaryProblem, field: Field) -> f64 {
    const POINTS: usize = 200;
    let step = SIDE / POINTS as f64;
    let positions = (0..POINTS).map(|i| [SIDE, (i as f64 + 0.5) * step]);
    let stresses = positions.map(|position| stress(&*problem.law, field.gradient(position))[0]);
    problem.thickness * step * stresses.sum::<f64>()
}

impl Errors {
    /// On a distorted mesh.
    fn new(shape: CellShape, cells: usize, amplitude: f64) -> Result<Self, Error> {
        let Solved { mesh, state, field } = Solved::new(shape, cells, amplitude)?;
        let u = &state.displacement;
        let (mut values, mut gradients) = (Squares::default(), Squares::default());
        each_point(&mesh, |cell, local, position, volume| {
            let weights = mesh.shape(cell).values(local);
            let computed = [0, 1].map(|axis| -> f64 {
                let nodes = mesh.cell(cell).iter().zip(&weights);
                nodes
                    .map(|(node, weight)| weight * u[2 * node + axis])
                    .sum()
            });
            values.add(volume, &computed, &field.displacement(position));
            let computed = mesh.gradient_at(u, cell, local);
            gradients.add(volume, &computed, &field.gradient(position));
        });
        Ok(Self {
            l2: values.relative(),
            h1: gradients.relative(),
        })
    }
}

/// Nodal forces in N of the body force.
fn forces(mesh: &Mesh, problem: &BoundaryProblem, field: Field) -> Vec<f64> {
    let mut forces = vec![0.0; 2 * mesh.nodes.len()];
    each_point(mesh, |cell, local, position, area| {
        let density = field.body_force(problem, position);
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
            call(cell, local, mesh.position(cell, local), area);
        }
    }
}
