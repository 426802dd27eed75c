//! The motion of a released plate, corrected with the start, the supports and all loads known.

use super::bodies::{Bodies, Fields, Models, PlateInTime, Steps, fault, percent};
use crate::corrector::motion::WindowSettings;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::results::{Axis, LineChart, PALETTE, Stroke};
use crate::validation::case::{
    Block, Check, Claim, Figure, Outcome, Progress, check, line, number,
};

/// How long the plate moves, and how the motion is corrected.
pub struct Release {
    pub periods: usize,
    /// In a period.
    pub steps: usize,
    /// Steps that are corrected together.
    pub window: usize,
}

/// Steps between the instants that are compared.
const STRIDE: usize = 8;

/// Motions at the nodes of the lattice, at the instants that are compared.
struct Motions {
    /// Of the reference.
    exact: Fields,
    /// Of the reference with steps twice as long.
    coarse: Fields,
    springs: Fields,
    corrected: Fields,
}

impl Release {
    pub fn compare(
        &self,
        plate: &PlateInTime,
        progress: Progress,
        outcome: &mut Outcome,
    ) -> Result<(), Error> {
        let models = Models::new(plate, plate.plate.cells);
        let viscosities = models.viscosities();
        let bodies = models.bodies(&viscosities)?;
        let period = bodies.reference.period()?;
        let step = period / self.steps as f64;
        let (motions, work) = self.motions(&bodies, step, progress)?;
        outcome.checks.extend(self.checks(&motions));
        outcome.claims.push(self.claim(&motions));
        outcome.blocks.push(Block::paragraph(format!(
            "Period {} s, step {} s; {work}. With the initial state, the supports and all loads known, the correction is \
             Newton's method in time: its result does not depend on the springs.",
            number(period),
            number(step)
        )));
        let times = (0..motions.exact.len()).map(|i| step * (STRIDE * i) as f64);
        let times: Vec<f64> = times.collect();
        let figures = [
            motions.tip(&models.lattice.mesh, &times),
            motions.errors(&times),
        ];
        outcome.figures.extend(figures);
        Ok(())
    }

    /// All motions, and what the correction took, in words.
    fn motions(
        &self,
        bodies: &Bodies,
        step: f64,
        progress: Progress,
    ) -> Result<(Motions, String), Error> {
        let coarse = Steps {
            step,
            count: self.periods * self.steps,
            every: STRIDE,
            finer: 1,
        };
        progress.tell("finite elements");
        let exact = bodies.exact(Steps { finer: 2, ..coarse })?;
        let every_step = Steps { every: 1, ..coarse };
        let coarse = bodies.exact(coarse)?;
        progress.tell("springs");
        let springs = bodies.springs.integrate(every_step)?;
        progress.tell("corrector");
        let [length, width] = bodies.scheme.mesh.grid().size;
        let windows = WindowSettings {
            steps: self.window,
            tolerance: 1e-9,
            max_iterations: 20,
            size: length.max(width),
        };
        let actual = bodies.equation(step)?;
        let actual = actual.correct(&springs, &bodies.scheme.motion.start, windows, &|_| ());
        let actual = actual.map_err(|end| fault(end.fault))?;
        let compared = |fields: &[Vec<f64>]| fields.iter().step_by(STRIDE).cloned().collect();
        let work = format!(
            "{} windows of up to {} steps, {} Newton steps, {} factorisations",
            actual.windows, self.window, actual.iterations, actual.factorisations
        );
        let motions = Motions {
            exact,
            coarse,
            springs: compared(&springs),
            corrected: compared(&actual.displacement),
        };
        Ok((motions, work))
    }

    fn checks(&self, motions: &Motions) -> [Check; 3] {
        let [before, after] = motions.deviations();
        let gain = format!(
            "error of the springs over error of the corrected motion, {} periods",
            self.periods
        );
        let half = "reference: change on halving the step, over the corrected deviation";
        let change = percent(&motions.coarse, &motions.exact);
        [
            check(gain, "–", before / after).at_least(5.0, "finite elements on another mesh"),
            check("springs: deviation over space and time", "%", before)
                .at_least(1.0, "springs must deviate for the test"),
            check(half, "–", change / after).at_most(0.5, "converged in time"),
        ]
    }

    fn claim(&self, motions: &Motions) -> Claim {
        let [before, after] = motions.deviations().map(number);
        Claim {
            claim: "§ 3.2: in dynamics the technique improves the results to within 10 % of finite elements",
            reproduced: format!(
                "{} periods of a released plate: {before} % by springs, {after} % corrected",
                self.periods
            ),
        }
    }
}

impl Motions {
    /// Of the springs and of the corrected motion, in %.
    fn deviations(&self) -> [f64; 2] {
        [&self.springs, &self.corrected].map(|fields| percent(fields, &self.exact))
    }

    /// The middle of the free end over time.
    fn tip(&self, mesh: &Mesh, times: &[f64]) -> Figure {
        const INK: [u8; 3] = [60, 60, 60];
        let [length, width] = mesh.grid().size;
        let far = |node: &usize| {
            let [x, y] = mesh.nodes[*node];
            (x - length).hypot(y - 0.5 * width)
        };
        let nodes = 0..mesh.nodes.len();
        let tip = nodes.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
        let line = |label, fields: &Fields, colour, stroke| {
            let along: Vec<f64> = fields.iter().map(|field| field[2 * tip]).collect();
            line(label, times, &along, colour, stroke)
        };
        let lines = vec![
            line("finite elements", &self.exact, INK, Stroke::Solid),
            line("springs", &self.springs, PALETTE[1], Stroke::Solid),
            line("corrected", &self.corrected, PALETTE[0], Stroke::Dashed),
        ];
        let (x, y) = ("time [s]", "displacement [mm]");
        let chart = LineChart::new("A released plate: the free end", x, y, lines);
        let caption = "Displacement of the middle of the free end.";
        Figure::new("motion_correction.png", caption, chart)
    }

    /// The deviation of each instant over the root mean square of all.
    fn errors(&self, times: &[f64]) -> Figure {
        let squares = self.exact.iter().flatten().map(|u| u * u);
        let size = (squares.sum::<f64>() / self.exact.len() as f64).sqrt();
        let line = |label, fields: &Fields, colour| {
            let error = |(u, v): (&Vec<f64>, &Vec<f64>)| {
                let squares = u.iter().zip(v).map(|(u, v)| (u - v).powi(2));
                100.0 * squares.sum::<f64>().sqrt() / size
            };
            let errors: Vec<f64> = fields.iter().zip(&self.exact).map(error).collect();
            line(label, times, &errors, colour, Stroke::Solid)
        };
        let lines = vec![
            line("springs", &self.springs, PALETTE[1]),
            line("corrected", &self.corrected, PALETTE[0]),
        ];
        let title = "Deviation from the finite elements over the amplitude of the motion";
        let (x, y) = ("time [s]", Axis::logarithmic("deviation [%]"));
        Figure::new(
            "motion_correction_error.png",
            "Deviation from the finite elements against time.",
            LineChart::new(title, x, y, lines),
        )
    }
}
