//! Local refinement where the estimated error is, compared with uniform refinement.

use super::graded::{Exact, SIZE, STRETCH};
use super::smooth::on;
use crate::error::Error;
use crate::finite_element::error_estimate::{EnergyError, bulk};
use crate::mesh::{CellShape, Mesh, Shape};
use crate::results::{Axis, Line, LineChart, PALETTE, Stroke};
use crate::validation::case::{
    Block, Check, Figure, Outcome, check, line, mesh_figure, number, table,
};
use crate::validation::finite_elements::{held, solve};

/// The part of the squared error that is refined in a round.
const SHARE: f64 = 0.5;

/// Where refinement begins, and how often uniform refinement halves the cells.
pub struct Refinement {
    pub coarsest: usize,
    pub halvings: usize,
}

/// One mesh of a refinement.
struct Round {
    triangles: Mesh,
    force_percent: f64,
    estimate: EnergyError,
}

/// Meshes of uniform and of local refinement.
struct Rounds {
    uniform: Vec<Round>,
    local: Vec<Round>,
}

impl Refinement {
    /// Refines locally until the force is as good as on the finest uniform mesh, and compares the numbers of cells.
    pub fn compare(&self, exact: Exact, outcome: &mut Outcome) -> Result<(), Error> {
        let rounds = self.rounds(exact)?;
        outcome.checks.push(rounds.check());
        outcome.blocks.push(rounds.table());
        outcome.figures.extend(rounds.figures());
        Ok(())
    }

    fn rounds(&self, exact: Exact) -> Result<Rounds, Error> {
        let first = Shape::Strip { size: SIZE }.mesh(self.coarsest, CellShape::Triangle3);
        let mut uniform = vec![Round::new(first.clone(), exact)?];
        for _ in 0..self.halvings {
            let finer = last(&uniform).triangles.refined();
            uniform.push(Round::new(finer, exact)?);
        }
        let goal = last(&uniform);
        let mut local = vec![Round::new(first, exact)?];
        while last(&local).force_percent > goal.force_percent
            && last(&local).cells() <= goal.cells()
        {
            let marked = bulk(&last(&local).estimate.cells, SHARE);
            let finer = last(&local).triangles.refined_where(&marked);
            local.push(Round::new(finer, exact)?);
        }
        Ok(Rounds { uniform, local })
    }
}

fn last(rounds: &[Round]) -> &Round {
    &rounds[rounds.len() - 1]
}

impl Round {
    /// T2 elements on the plate of some triangles.
    fn new(triangles: Mesh, exact: Exact) -> Result<Self, Error> {
        let mesh = triangles.quadratic();
        let problem = held(&[
            ("left", [Some(0.0); 2]),
            ("right", [Some(STRETCH * SIZE[0]), Some(0.0)]),
        ]);
        let energy = problem.finite_elements(&mesh);
        let model = problem.on(&mesh, &energy)?.named("local refinement");
        let state = solve(&model, 1)?;
        let force = model.reaction(&state, "right")[0];
        Ok(Self {
            triangles,
            force_percent: 100.0 * (force / exact.force - 1.0).abs(),
            estimate: on(&mesh, &state.displacement, |solved| {
                solved.energy_estimate()
            }),
        })
    }

    fn cells(&self) -> usize {
        self.triangles.cell_count()
    }

    fn row(&self, name: &str) -> Vec<String> {
        vec![
            name.to_owned(),
            self.cells().to_string(),
            number(self.force_percent),
            number(self.estimate.percent()),
        ]
    }
}

impl Rounds {
    fn check(&self) -> Check {
        let (uniform, local) = (last(&self.uniform), last(&self.local));
        let (most, error) = (uniform.cells(), number(uniform.force_percent));
        let what = format!(
            "plate, T2: cells of local over {most} of uniform refinement, at {error} % force error"
        );
        let share = local.cells() as f64 / most as f64;
        check(what, "–", share).at_most(0.25, "the same error with fewer cells")
    }

    fn table(&self) -> Block {
        let head = "T2, refinement | cells | error of the force [%] | error of the field by recovery, energy norm [%]";
        let uniform = self.uniform.iter().map(|round| round.row("uniform"));
        let local = self.local.iter().map(|round| round.row("local"));
        table(head, uniform.chain(local))
    }

    fn figures(&self) -> [Figure; 2] {
        let line = |label: &str, rounds: &[Round], colour| -> Line {
            let cells: Vec<f64> = rounds.iter().map(|round| round.cells() as f64).collect();
            let errors: Vec<f64> = rounds.iter().map(|round| round.force_percent).collect();
            line(label, &cells, &errors, colour, Stroke::Marked)
        };
        let lines = vec![
            line("uniform refinement", &self.uniform, PALETTE[0]),
            line("local refinement", &self.local, PALETTE[1]),
        ];
        let (x, y) = (
            Axis::logarithmic("cells"),
            Axis::logarithmic("error of the force [%]"),
        );
        let chart = LineChart::new("Force of the clamped plate, T2", x, y, lines);
        let caption = "Error of the plate's force against the number of cells.";
        [
            Figure::new("own_error.png", caption, chart),
            mesh_figure(
                "own_error_mesh.png",
                "The last mesh of the local refinement.",
                "Refined where the estimated error is large",
                &last(&self.local).triangles,
            ),
        ]
    }
}
