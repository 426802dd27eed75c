//! Times, errors and memory of every way on every mesh.

use std::time::{Duration, Instant};

use gelbench::error::Error;
use gelbench::mesh::{Interpolation, Mesh};
use gelbench::solve::Potential;
use rayon::ThreadPool;

use super::meshes::Layout;
use super::reference::Reference;
use super::shapes::Family;
use super::way::{Gone, Told, Way, go};
use super::{Extent, MEMORY, distance, opponent};

/// A way measured on one mesh.
#[derive(Clone)]
pub struct Run {
    pub shape: &'static str,
    pub way: Way,
    pub layout: Layout,
    pub nodes: usize,
    /// Shortest time in s.
    pub seconds: f64,
    pub iterations: usize,
    /// Displacement against the reference, and force or strain energy, in percent.
    pub error_percent: f64,
    pub force_percent: f64,
    /// Distance from the exact solution of the same equations, over the size of the field in percent, and over the error of that solution.
    pub difference_percent: f64,
    pub difference_share: f64,
    /// The same over the error that the climb states.
    pub stated_share: f64,
    /// The most memory held at once.
    pub bytes_per_node: f64,
    /// Time in evaluations of F on the finest mesh.
    pub work_units: f64,
    /// Whether the climb's field is that of two threads to the last bit; none where that was not looked at.
    pub same_bits: Option<bool>,
}

/// What all runs of a shape share.
pub struct Bench<'a> {
    pub reference: &'a Reference,
    /// Of two threads.
    pub two: &'a ThreadPool,
    pub extent: &'a Extent,
}

/// When opponents stop: imbalances for Newton's method with multigrid, and shares of the mesh's error for factors. Each takes the first with
/// which its field is as accurate as the exact solution on the mesh, or differs from it by a tenth of its error at most.
const TOLERANCES: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8];
const STOPS: [f64; 6] = [1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-6];
const LEFT: f64 = 0.1;
const AS_ACCURATE: f64 = 1.02;

/// What the coarser meshes of a family tell.
#[derive(Default)]
pub struct Progress {
    /// The places among tolerances and stops that opponents have come to, in the order of [`Way::ALL`].
    stops: [usize; Way::ALL.len()],
    /// Whether finite elements on one mesh are quicker with a line search.
    steps: bool,
    /// Errors of the exact solutions in percent.
    errors: Vec<f64>,
}

/// Over the reference's own error, errors that are known by it; finer ones follow from those of the two meshes before.
pub const SURE: f64 = 10.0;

/// Turns at least and at most, the time after which no more are begun, the time of every contestant in a turn, and that from which on a
/// run is not worth another one.
const TURNS: std::ops::Range<usize> = 1..7;
const ENOUGH: Duration = Duration::from_millis(400);
const TURN: Duration = Duration::from_millis(25);
const LONG: f64 = 3.0;
/// Nodes up to which a line search is tried on one mesh even where Newton's method without one finds the field.
const FEW: usize = 3_000;

/// A finest mesh with what its fields are compared with.
struct Compared<'a> {
    family: &'a Family<'a>,
    levels: usize,
    mesh: Mesh,
    on: Interpolation,
    /// The exact solution of its equations; none where only climbs are measured.
    exact: Option<Vec<f64>>,
    /// Of that solution in percent, or about.
    error_percent: f64,
    /// Time of an evaluation of F in s.
    evaluation: f64,
}

impl Bench<'_> {
    /// Measures all ways on one mesh, turn by turn.
    pub fn mesh(
        &self,
        family: &Family,
        level: usize,
        progress: &mut Progress,
    ) -> Result<Vec<Run>, Error> {
        let compared = self.compared(family, level + 1, progress)?;
        let mut runs: Vec<(Run, Told)> = Vec::new();
        for way in self.ways(&compared) {
            if way != Way::OneMesh {
                runs.extend(self.tuned(&compared, way, false, progress)?);
                continue;
            }
            let plain = match progress.steps {
                true => None,
                false => self.tuned(&compared, way, false, progress)?,
            };
            let few = compared.mesh.nodes.len() <= FEW;
            let in_steps = match plain.is_none() || few {
                true => self.tuned(&compared, way, true, progress)?,
                false => None,
            };
            let both = plain.into_iter().chain(in_steps);
            let quickest = both.min_by(|a, b| a.0.seconds.total_cmp(&b.0.seconds));
            progress.steps = !few && quickest.as_ref().is_some_and(|(_, told)| told.steps);
            runs.extend(quickest);
        }
        self.repeat(&mut runs, &compared)?;
        Ok(runs.into_iter().map(|(run, _)| run).collect())
    }

    /// The first run of a way that stops as early as its mesh allows; `None` where it leads nowhere.
    fn tuned(
        &self,
        compared: &Compared,
        way: Way,
        steps: bool,
        progress: &mut Progress,
    ) -> Result<Option<(Run, Told)>, Error> {
        let stop = &mut progress.stops[way as usize];
        loop {
            let told = told(compared, *stop, steps);
            let Some(run) = self.first(compared, way, told)? else {
                return Ok(None);
            };
            let accurate = run.error_percent <= AS_ACCURATE * compared.error_percent
                || run.difference_share <= LEFT
                || run.difference_share.is_nan();
            if way.is_climb() || accurate || *stop + 1 == STOPS.len() {
                return Ok(Some((run, told)));
            }
            *stop += 1;
        }
    }

    fn ways(&self, compared: &Compared) -> Vec<Way> {
        let (nodes, extent) = (compared.mesh.nodes.len(), self.extent);
        let place = usize::from(compared.family.kind == compared.family.case.kinds[1]);
        let one_mesh = extent.one_mesh[usize::from(compared.family.grading != 1.0)];
        let ways = Way::ALL.into_iter().filter(|way| match way {
            Way::FastClimb => true,
            Way::Climb | Way::Multigrid => nodes <= extent.exact,
            Way::Nested => nodes <= extent.nested[place],
            Way::OneMesh => nodes <= one_mesh,
        });
        ways.collect()
    }

    fn compared<'b>(
        &self,
        family: &'b Family<'b>,
        levels: usize,
        progress: &mut Progress,
    ) -> Result<Compared<'b>, Error> {
        let problem = &family.case.problem;
        let mut meshes = family.meshes(levels);
        let nodes = meshes[levels - 1].nodes.len();
        let exact = match nodes <= self.extent.exact {
            true => Some(opponent::nested(problem, &meshes, [1e-3, 1e-15])?.u),
            false => None,
        };
        let mesh = meshes.pop().expect("a mesh");
        let on = self.reference.on(&mesh);
        let energy = problem.finite_elements(&mesh);
        let mut forces = vec![0.0; 2 * nodes];
        let at = exact.clone().unwrap_or_else(|| forces.clone());
        let evaluations = (0..3).map(|_| {
            let start = Instant::now();
            energy.add_forces(&at, &mut forces).expect("admissible");
            start.elapsed().as_secs_f64()
        });
        let evaluation = evaluations.fold(f64::INFINITY, f64::min);
        let measured = exact
            .as_ref()
            .map_or(0.0, |exact| self.reference.error_percent(&on, exact));
        let error_percent = match progress.errors[..] {
            [.., before, last] if measured < SURE * self.reference.own_percent => {
                last * (last / before).min(1.0)
            }
            _ => measured,
        };
        progress.errors.push(error_percent);
        Ok(Compared {
            family,
            levels,
            mesh,
            on,
            exact,
            error_percent,
            evaluation,
        })
    }

    /// The first time on a way, with everything that is not time; `None` where it leads nowhere.
    fn first(&self, compared: &Compared, way: Way, told: Told) -> Result<Option<Run>, Error> {
        let (family, levels) = (compared.family, compared.levels);
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let Some(gone) = go(way, family, levels, told)? else {
            return Ok(None);
        };
        let bytes = (MEMORY.peak_usage() - before) as f64;
        let mut run = self.run(compared, way, &gone, bytes);
        if way.is_climb() && compared.mesh.nodes.len() <= self.extent.two_threads {
            let other = self.two.install(|| go(way, family, levels, told))?;
            run.same_bits = other.map(|other| other.u == gone.u);
        }
        Ok(Some(run))
    }

    fn run(&self, compared: &Compared, way: Way, gone: &Gone, bytes: f64) -> Run {
        let (nodes, case) = (compared.mesh.nodes.len(), compared.family.case);
        let exact = compared.exact.as_ref();
        let of_exact = |value: &dyn Fn(&Vec<f64>) -> f64| exact.map_or(f64::NAN, value);
        let reference = self.reference;
        let difference =
            of_exact(&|exact| reference.difference_percent(&compared.on, &gone.u, exact));
        Run {
            shape: case.name,
            way,
            layout: compared.family.layout(compared.levels - 1),
            nodes,
            seconds: gone.seconds,
            iterations: gone.iterations,
            error_percent: reference.error_percent(&compared.on, &gone.u),
            force_percent: reference.force_percent(case, &compared.mesh, &gone.u),
            difference_percent: difference,
            difference_share: difference / compared.error_percent,
            stated_share: of_exact(&|exact| distance(&gone.u, exact) / gone.stated),
            bytes_per_node: bytes / nodes as f64,
            work_units: gone.seconds / compared.evaluation,
            same_bits: None,
        }
    }

    /// Goes all ways again, in turns, and keeps the shortest times.
    fn repeat(&self, runs: &mut [(Run, Told)], compared: &Compared) -> Result<(), Error> {
        let start = Instant::now();
        for turn in 0..TURNS.end {
            if turn >= TURNS.start && start.elapsed() > ENOUGH {
                break;
            }
            for (run, told) in runs.iter_mut().filter(|(run, _)| run.seconds < LONG) {
                let begin = Instant::now();
                while begin.elapsed() < TURN {
                    let gone = go(run.way, compared.family, compared.levels, *told)?;
                    run.seconds = gone.map_or(run.seconds, |gone| run.seconds.min(gone.seconds));
                }
            }
        }
        for (run, _) in runs {
            run.work_units = run.seconds / compared.evaluation;
        }
        Ok(())
    }
}

/// What opponents are told at a place among their stops.
fn told(compared: &Compared, stop: usize, steps: bool) -> Told {
    let error = 0.01 * compared.error_percent;
    Told {
        error: [error, STOPS[stop] * error],
        tolerance: TOLERANCES[stop],
        steps,
    }
}
