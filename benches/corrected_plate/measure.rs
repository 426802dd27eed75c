//! Times, errors and memory of every way on every grid.

use std::time::{Duration, Instant};

use gelbench::corrector::DifferenceScheme;
use gelbench::error::Error;
use gelbench::problem::ClampedPlate;
use gelbench_corrector::corrector::climb::{Field, Grid};
use rayon::ThreadPool;

use super::MEMORY;
use super::method::{Layout, Method, Solution, go};
use super::opponent::{Guess, Opponent};
use super::reference::{Reference, relative_percent};

/// A way measured on one grid.
pub struct Run {
    pub method: Method,
    pub layout: Layout,
    pub nodes: usize,
    pub threads: usize,
    /// Shortest time in s.
    pub seconds: f64,
    pub force: f64,
    /// Departure from affine against the reference, and the force, in percent.
    pub departure_percent: f64,
    pub force_percent: f64,
    pub iterations: usize,
    /// The most memory held at once.
    pub bytes_per_node: f64,
    /// Time in evaluations of F on the finest grid.
    pub work_units: f64,
    /// Distance from the solution of the same equations by factorisations, in percent of the departure from affine;
    /// not a number for finite elements.
    pub difference_percent: f64,
    /// Whether the field is that of one thread to the last bit.
    pub same_bits: bool,
}

impl Run {
    /// Whether it went a way, on one thread.
    pub fn is(&self, method: Method) -> bool {
        self.method == method && self.threads == 1
    }

    /// Keeps the shorter times.
    fn improve(&mut self, actual: &Solution) {
        let evaluation = (self.seconds / self.work_units).min(actual.evaluation);
        self.seconds = self.seconds.min(actual.seconds);
        self.work_units = self.seconds / evaluation;
    }
}

/// What all runs share.
pub struct Bench<'a> {
    pub problem: &'a ClampedPlate,
    pub reference: &'a Reference,
    pub stretch: f64,
    /// Pools of one and two threads.
    pub pools: &'a [ThreadPool; 2],
}

/// The climb's schemes; their finite elements are linear, quadratic and cubic.
pub const SCHEMES: [DifferenceScheme; 3] = [
    DifferenceScheme::Gauss,
    DifferenceScheme::Biquadratic,
    DifferenceScheme::Bicubic,
];

/// The solution of a grid's equations: finite elements that are iterated further.
struct Exact {
    scheme: DifferenceScheme,
    /// Its error relative to the departure from affine.
    error: f64,
    grid: Grid,
    field: Field,
}

/// What is left of the solution of a grid's equations at most, relative to the departure from affine, ten times over.
const EXACT: f64 = 1e-11;

/// Turns at least and at most, the time after which no more are begun, and the time of every contestant in a turn.
const TURNS: std::ops::Range<usize> = 2..8;
const ENOUGH: Duration = Duration::from_secs(4);
const TURN: Duration = Duration::from_millis(250);

impl Bench<'_> {
    /// Measures all ways on one grid, turn by turn; `corrected` tells whether the climb is one of them.
    pub fn grid(&self, layout: Layout, corrected: bool) -> Result<Vec<Run>, Error> {
        let schemes = SCHEMES.into_iter().filter(|scheme| layout.suits(*scheme));
        let exact: Vec<Exact> = schemes.map(|scheme| self.exact(layout, scheme)).collect();
        let contestants = contestants(layout, corrected, &exact);
        let mut runs = Vec::new();
        let mut fields: Vec<Field> = Vec::new();
        for (method, threads, error) in &contestants {
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let actual = self.go(*method, layout, *threads, *error)?;
            let bytes = (MEMORY.peak_usage() - before) as f64;
            runs.push(self.run(*method, layout, *threads, &actual, bytes));
            fields.push(actual.field);
        }
        compare(&mut runs, &fields, &exact, self.stretch);
        drop((fields, exact));
        self.repeat(&mut runs, &contestants)?;
        Ok(runs)
    }

    fn go(
        &self,
        method: Method,
        layout: Layout,
        threads: usize,
        error: f64,
    ) -> Result<Solution, Error> {
        self.pools[threads - 1].install(|| go(method, self.problem, layout, self.stretch, error))
    }

    fn exact(&self, layout: Layout, scheme: DifferenceScheme) -> Exact {
        let mut direct = Opponent::new(self.problem, layout, scheme);
        let mut u = direct.start(Guess::Nested, self.stretch, EXACT);
        direct.solve(&mut u, self.stretch, EXACT);
        let field = Field::of_nodes(&direct.grid, &u);
        Exact {
            scheme,
            error: 0.01 * self.reference.departure_percent(&direct.grid, &field),
            grid: direct.grid,
            field,
        }
    }

    fn run(
        &self,
        method: Method,
        layout: Layout,
        threads: usize,
        actual: &Solution,
        bytes: f64,
    ) -> Run {
        let nodes = actual.grid.nodes();
        Run {
            method,
            layout,
            nodes,
            threads,
            seconds: actual.seconds,
            force: actual.force,
            departure_percent: self
                .reference
                .departure_percent(&actual.grid, &actual.field),
            force_percent: self.reference.force_percent(actual.force),
            iterations: actual.iterations,
            bytes_per_node: bytes / nodes as f64,
            work_units: actual.seconds / actual.evaluation,
            difference_percent: f64::NAN,
            same_bits: true,
        }
    }

    /// Goes all ways again, in turns, and keeps the shortest times.
    fn repeat(&self, runs: &mut [Run], contestants: &[(Method, usize, f64)]) -> Result<(), Error> {
        let start = Instant::now();
        for turn in 0..TURNS.end {
            if turn >= TURNS.start && start.elapsed() > ENOUGH {
                break;
            }
            for (run, (method, threads, error)) in runs.iter_mut().zip(contestants) {
                let begin = Instant::now();
                while begin.elapsed() < TURN {
                    run.improve(&self.go(*method, run.layout, *threads, *error)?);
                }
            }
        }
        Ok(())
    }
}

/// Compares the fields of the climb with the solutions of the same equations, and with those of one thread.
fn compare(runs: &mut [Run], fields: &[Field], exact: &[Exact], stretch: f64) {
    for exact in exact {
        let climb = Method::Climb(exact.scheme);
        let Some(first) = runs.iter().position(|run| run.method == climb) else {
            continue;
        };
        for (run, field) in runs.iter_mut().zip(fields) {
            if run.method == climb {
                run.difference_percent =
                    relative_percent(&exact.grid, field, &exact.field, stretch);
                run.same_bits = *field == fields[first];
            }
        }
    }
}

/// The ways on a grid, with threads and the grid's error: on equal cells the climb by one and two threads. The bicubic climb goes on
/// every grid that suits it.
fn contestants(layout: Layout, corrected: bool, exact: &[Exact]) -> Vec<(Method, usize, f64)> {
    let mut all = Vec::new();
    for Exact { scheme, error, .. } in exact {
        let scheme = *scheme;
        let corrected = corrected || scheme == DifferenceScheme::Bicubic;
        if corrected {
            all.push((Method::Climb(scheme), 1, *error));
        }
        if corrected && layout.grading == 1.0 {
            all.push((Method::Climb(scheme), 2, *error));
        }
    }
    for Exact { scheme, error, .. } in exact {
        for guess in [Guess::Affine, Guess::Nested] {
            all.push((Method::FiniteElements(*scheme, guess), 1, *error));
        }
    }
    all
}
