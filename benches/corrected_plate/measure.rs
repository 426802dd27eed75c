//! Times, errors and memory of every way on every grid.

use std::time::{Duration, Instant};

use gelbench::corrector::DifferenceScheme;
use gelbench::corrector::climb::Field;
use gelbench::error::Error;
use gelbench::finite_element::Element;
use gelbench::problem::ClampedPlate;
use rayon::ThreadPool;

use super::MEMORY;
use super::opponent::{Guess, Opponent};
use super::reference::{Reference, relative_percent};
use super::way::{Found, Way, element, go};

/// A way measured on one grid.
pub struct Run {
    pub way: Way,
    pub cells: [usize; 2],
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
    /// Keeps the shorter times.
    fn improve(&mut self, found: &Found) {
        let evaluation = (self.seconds / self.work_units).min(found.evaluation);
        self.seconds = self.seconds.min(found.seconds);
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

/// Turns at least and at most, the time after which no more are begun, and the time of every contestant in a turn.
const TURNS: std::ops::Range<usize> = 2..8;
const ENOUGH: Duration = Duration::from_secs(4);
const TURN: Duration = Duration::from_millis(250);

impl Bench<'_> {
    /// Measures all ways on one grid, turn by turn; `corrected` tells whether the climb is one of them.
    pub fn grid(&self, cells: [usize; 2], corrected: bool) -> Result<Vec<Run>, Error> {
        let errors = [DifferenceScheme::Gauss, DifferenceScheme::Biquadratic]
            .map(|scheme| self.own_error(cells, scheme));
        let [linear, quadratic] = errors;
        let errors = [linear?, quadratic?];
        let contestants = contestants(corrected, &errors);
        let mut runs = Vec::new();
        let mut fields: Vec<Field> = Vec::new();
        for (way, threads, error) in &contestants {
            let before = MEMORY.current_usage();
            MEMORY.reset_peak_usage();
            let found = self.go(*way, cells, *threads, *error)?;
            let bytes = (MEMORY.peak_usage() - before) as f64;
            runs.push(self.run(*way, cells, *threads, &found, bytes));
            fields.push(found.field);
        }
        self.compare(&mut runs, &fields, &errors);
        drop(fields);
        self.repeat(&mut runs, &contestants)?;
        Ok(runs)
    }

    fn go(&self, way: Way, cells: [usize; 2], threads: usize, error: f64) -> Result<Found, Error> {
        self.pools[threads - 1].install(|| go(way, self.problem, cells, self.stretch, error))
    }

    /// The error of a grid's equations relative to the departure from affine, by a climb.
    fn own_error(&self, cells: [usize; 2], scheme: DifferenceScheme) -> Result<f64, Error> {
        let found = self.go(Way::Climb(scheme), cells, 1, f64::NAN)?;
        Ok(0.01 * self.reference.departure_percent(&found.grid, &found.field))
    }

    fn run(&self, way: Way, cells: [usize; 2], threads: usize, found: &Found, bytes: f64) -> Run {
        let nodes = found.grid.nodes();
        Run {
            way,
            cells,
            nodes,
            threads,
            seconds: found.seconds,
            force: found.force,
            departure_percent: self.reference.departure_percent(&found.grid, &found.field),
            force_percent: self.reference.force_percent(found.force),
            iterations: found.iterations,
            bytes_per_node: bytes / nodes as f64,
            work_units: found.seconds / found.evaluation,
            difference_percent: f64::NAN,
            same_bits: true,
        }
    }

    /// Compares the fields of the climb with the finite elements at the same nodes, iterated once more, and with
    /// those of one thread.
    fn compare(&self, runs: &mut [Run], fields: &[Field], errors: &[f64; 2]) {
        let found = |way: Way, runs: &[Run]| runs.iter().position(|run| run.way == way);
        for (scheme, error) in [DifferenceScheme::Gauss, DifferenceScheme::Biquadratic]
            .into_iter()
            .zip(errors)
        {
            let Some(first) = found(Way::Climb(scheme), runs) else {
                continue;
            };
            let mut direct = Opponent::new(self.problem, runs[first].cells, element(scheme));
            let mut u = direct.start(Guess::Nested, self.stretch, *error);
            // A thousandth of the error: one or two iterations more than the opponent's.
            direct.solve(&mut u, self.stretch, 1e-3 * error);
            direct.iterate(&mut u);
            let exact = Field::of_nodes(&direct.grid, &u);
            for (run, field) in runs.iter_mut().zip(fields) {
                if [Way::Climb(scheme), Way::Newton(scheme)].contains(&run.way) {
                    run.difference_percent =
                        relative_percent(&direct.grid, field, &exact, self.stretch);
                    run.same_bits = run.way == Way::Newton(scheme) || *field == fields[first];
                }
            }
        }
    }

    /// Goes all ways again, in turns, and keeps the shortest times.
    fn repeat(&self, runs: &mut [Run], contestants: &[(Way, usize, f64)]) -> Result<(), Error> {
        let start = Instant::now();
        for turn in 0..TURNS.end {
            if turn >= TURNS.start && start.elapsed() > ENOUGH {
                break;
            }
            for (run, (way, threads, error)) in runs.iter_mut().zip(contestants) {
                let begin = Instant::now();
                while begin.elapsed() < TURN {
                    run.improve(&self.go(*way, run.cells, *threads, *error)?);
                }
            }
        }
        Ok(())
    }
}

fn contestants(corrected: bool, [linear, quadratic]: &[f64; 2]) -> Vec<(Way, usize, f64)> {
    let mut all = Vec::new();
    for (scheme, error) in [
        (DifferenceScheme::Gauss, *linear),
        (DifferenceScheme::Biquadratic, *quadratic),
    ] {
        if corrected {
            all.push((Way::Climb(scheme), 1, error));
            all.push((Way::Climb(scheme), 2, error));
            all.push((Way::Newton(scheme), 1, error));
        }
    }
    for (element, error) in [(Element::Q1, *linear), (Element::Q2, *quadratic)] {
        for guess in [Guess::Affine, Guess::Nested] {
            all.push((Way::FiniteElements(element, guess), 1, error));
        }
    }
    all
}
