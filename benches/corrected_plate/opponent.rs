//! The finite elements as quick as gelbench's own parts allow: ordering and symbolic factorisation once, the best
//! guess at hand, and no more Newton iterations than the mesh is worth.
//!
//! **Ordering and threads** (faer 0.24, one state at 100 %, seconds, best of three on a busy machine with two cores):
//!
//! | nodes | analysis: AMD, dissection | factorisation: AMD, dissection | factor in MB |
//! |---|---|---|---|
//! | Q1 240 × 80 | 0.071, 0.034 | 0.057, 0.042 | 24, 25 |
//! | Q1 600 × 200 | 0.33, 0.20 | 0.31, 0.27 | 194, 194 |
//! | Q2 600 × 200 | 0.40, 0.35 | 0.35, 0.39 | 190, 196 |
//! | Q1 1000 × 334 | 1.46, 0.69 | 3.03, 1.14 | 877, 603 |
//! | Q2 1000 × 334 | 1.44, 0.59 | 1.01, 1.05 | 610, 609 |
//!
//! Nested dissection by coordinates is therefore gelbench's order for large meshes. faer's factorisation by two
//! threads was slower than by one on this machine (600 × 200: 0.54 against 0.30 s, 1000 × 334: 3.8 against 2.5 s).

use gelbench::corrector::DifferenceScheme;
use gelbench::mesh::Mesh;
use gelbench::problem::ClampedPlate;
use gelbench_corrector::corrector::climb::{Field, Grid};
use gelbench_mechanics::problem::sheet_energy::SheetEnergy;
use gelbench_mechanics::solve::{Assembly, Cholesky};

use super::method::Layout;

/// Where the iteration begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guess {
    /// At the affine stretch, as the built-in finite elements do.
    Affine,
    /// At the field of half as many cells along both axes, graded in the same way and found in the same way: the climb's own
    /// idea, with factorisations.
    Nested,
}

impl Guess {
    pub fn name(self) -> &'static str {
        match self {
            Self::Affine => "affine",
            Self::Nested => "nested",
        }
    }
}

/// Finite elements prepared on one grid of nodes.
pub struct Opponent<'a> {
    problem: &'a ClampedPlate,
    layout: Layout,
    pub grid: Grid,
    scheme: DifferenceScheme,
    mesh: Mesh,
    energy: SheetEnergy,
    assembly: Assembly,
    cholesky: Cholesky,
}

/// Cells along Y below which a nested guess goes no coarser.
const COARSEST: usize = 10;
/// How many times as large the error of a mesh with half as many elements is, at least about.
const COARSER: f64 = 3.0;
/// Newton iterations at most.
const ITERATIONS: usize = 12;

impl<'a> Opponent<'a> {
    /// Meshes the plate by the finite elements whose equations are those of a scheme.
    pub fn new(problem: &'a ClampedPlate, layout: Layout, scheme: DifferenceScheme) -> Self {
        let mesh = scheme.graded(problem.size, layout.cells, layout.grading);
        let energy = scheme.energy(problem, &mesh);
        let assembly = Assembly::new(&energy, &problem.held(&mesh));
        let cholesky = assembly.analyse();
        Self {
            problem,
            layout,
            // Between meshes, cubics through the four nodes around each place are smoother than the elements' own.
            grid: Grid {
                degree: 1,
                ..layout.grid(problem.size, scheme.side())
            },
            scheme,
            cholesky: cholesky.expect("enough memory"),
            assembly,
            mesh,
            energy,
        }
    }

    /// The displacements that the iteration begins at.
    pub fn start(&self, guess: Guess, stretch: f64, error: f64) -> Vec<f64> {
        let coarser = self.layout.halved(self.scheme.side());
        let coarser =
            coarser.filter(|layout| guess == Guess::Nested && layout.cells[1] >= COARSEST);
        let Some(layout) = coarser else {
            return self.problem.affine(&self.mesh, stretch);
        };
        let mut coarser = Self::new(self.problem, layout, self.scheme);
        let error = COARSER * error;
        let mut u = coarser.start(guess, stretch, error);
        coarser.solve(&mut u, stretch, error);
        let field = Field::of_nodes(&coarser.grid, &u);
        field.onto(&coarser.grid, &self.grid).to_nodes()
    }

    /// Newton's iteration. A step of relative size s leaves an error of 0.8 s² (measured on this plate): it ends when
    /// s² is below a tenth of the mesh's own `error`, both relative to the departure from the affine stretch.
    /// Returns the iterations.
    pub fn solve(&mut self, u: &mut [f64], stretch: f64, error: f64) -> usize {
        for iteration in 1..=ITERATIONS {
            let step = self.iterate(u);
            let share = step / self.departure(u, stretch);
            if share * share <= 0.1 * error {
                return iteration;
            }
        }
        panic!("Newton's iteration does not converge");
    }

    /// One Newton iteration; the norm of its step.
    pub fn iterate(&mut self, u: &mut [f64]) -> f64 {
        let (mut residual, mut stiffness) = (vec![0.0; u.len()], Vec::new());
        self.assembly
            .linearise(&self.energy, u, &mut residual, &mut stiffness)
            .expect("admissible fields");
        self.cholesky.factorise(&stiffness).expect("a stable state");
        let free = self.assembly.free();
        let mut step: Vec<f64> = free.iter().map(|unknown| -residual[*unknown]).collect();
        self.cholesky.substitute(&mut step);
        for (unknown, step) in free.iter().zip(&step) {
            u[*unknown] += step;
        }
        step.iter().map(|step| step * step).sum::<f64>().sqrt()
    }

    /// The norm of a field's departure from the affine stretch.
    fn departure(&self, u: &[f64], stretch: f64) -> f64 {
        let nodes = self.mesh.nodes.iter().zip(u.chunks_exact(2));
        let squares = nodes.map(|([x, _], u)| (u[0] - stretch * x).powi(2) + u[1].powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Force on the moving grip in N: the virtual work of all forces in a uniform stretch, which feels what the
    /// iteration left far less than the sum of the reactions does.
    pub fn force(&self, u: &[f64]) -> f64 {
        let mut residual = vec![0.0; u.len()];
        Assembly::residual(&self.energy, u, &mut residual).expect("admissible fields");
        let nodes = self.mesh.nodes.iter().zip(residual.chunks_exact(2));
        let length = self.problem.size[0];
        nodes.map(|([x, _], force)| x / length * force[0]).sum()
    }
}
