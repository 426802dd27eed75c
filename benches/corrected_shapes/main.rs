//! The climb on any shape compared with finite elements at the same nodes, on one thread.
//!
//! ```text
//! cargo bench --bench corrected_shapes              up to half a million nodes, some minutes
//! cargo bench --bench corrected_shapes -- --quick   up to 50,000 nodes
//! cargo bench --bench corrected_shapes -- --path    a hundred load factors, and grips in the hand, on some 10,000 nodes
//! ```
//!
//! Every time runs from the problem to field and reactions, with all meshes and analysis; it is the shortest of several runs in which
//! all contestants take turns. Writes `output/bench/corrected_shapes.csv`. The exit code is 1 when the climb's field differs from
//! that of the direct path by more than a tenth of its stated discretisation error anywhere.
//!
//! | contestant | what it is |
//! |---|---|
//! | climb | `shape_climb::climb` with the default tolerance, 1/1000 of the discretisation error |
//! | fast climb | the same with `ClimbSettings::FAST` |
//! | multigrid | Newton's method with multigrid, begun with the equilibrium of the mesh before, on all meshes |
//! | direct | the same with a sparse factor of every tangent: the best direct opponent |
//! | direct, one mesh | finite elements on the finest mesh alone, in load steps where it must |

mod path;
mod shapes;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use gelbench::corrector::climb::ClimbSettings;
use gelbench::corrector::shape_climb::{ShapeClimb, climb};
use gelbench::error::Error;
use gelbench::material::Card;
use gelbench::mesh::Mesh;
use gelbench::output;
use gelbench::problem::BoundaryProblem;
use gelbench::solve::{LinearSolver, NewtonSettings, State};
use rayon::ThreadPoolBuilder;

use shapes::Case;

/// As exact as the comparison needs: a relative residual of 1e-6 is far below the discretisation error.
const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-6,
    max_iterations: 40,
};
/// Nodes of the largest mesh at most.
const MOST: [usize; 2] = [600_000, 50_000];
/// Nodes of the smallest mesh that is measured.
const LEAST: usize = 1_000;
/// What the climb's field may differ from that of the direct path, over its discretisation error.
const SHARE: f64 = 0.1;

fn main() -> ExitCode {
    let has = |option: &str| std::env::args().any(|argument| argument == option);
    let most = MOST[usize::from(has("--quick"))];
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    match pool.expect("a thread").install(|| match has("--path") {
        true => paths(),
        false => bench(most),
    }) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn bench(most: usize) -> Result<bool, Error> {
    let law = Card::load("pva-10", Path::new("."))?.law;
    let mut csv =
        "shape,nodes,contestant,seconds,discretisation_error_mm,difference_over_error\n".to_owned();
    let mut passes = true;
    println!(
        "times in s, and over that of the fast climb; difference to the direct path over the discretisation error"
    );
    for case in shapes::all(&law) {
        let levels = (1..).take_while(|level| case.nodes(*level) <= most);
        for level in levels.filter(|level| case.nodes(*level) >= LEAST) {
            let row = Row::measure(&case, level + 1)?;
            println!("{}", row.told(case.name));
            csv += &row.csv(case.name);
            passes &= row.differences.iter().all(|share| *share <= SHARE);
        }
    }
    let path = Path::new("output/bench/corrected_shapes.csv");
    println!("{}", output::save(path, csv.as_bytes())?.display());
    println!(
        "{} difference to the direct path: at most {SHARE} of the discretisation error",
        if passes { "pass" } else { "FAIL" }
    );
    Ok(passes)
}

/// Nodes of the meshes on which paths are followed, about.
const PATH_NODES: [usize; 2] = [10_000, 30_000];

/// Paths on strips with a hole.
fn paths() -> Result<bool, Error> {
    let law = Card::load("pva-10", Path::new("."))?.law;
    let mut passes = true;
    for case in shapes::all(&law) {
        if !case.name.starts_with("strip with hole") {
            continue;
        }
        let nodes: Vec<usize> = case.meshes(6).iter().map(|mesh| mesh.nodes.len()).collect();
        let nearest = PATH_NODES.map(|wanted| {
            let levels = 2..nodes.len();
            levels.min_by_key(|level| nodes[*level].abs_diff(wanted))
        });
        for level in std::collections::BTreeSet::from(nearest)
            .into_iter()
            .flatten()
        {
            passes &= path::bench(&case, level + 1)?;
        }
    }
    println!(
        "{} difference to the direct path: at most {SHARE} of the discretisation error",
        if passes { "pass" } else { "FAIL" }
    );
    Ok(passes)
}

const NAMES: [&str; 5] = [
    "fast climb",
    "climb",
    "multigrid",
    "direct",
    "direct, one mesh",
];

/// What was measured on the meshes of one case.
struct Row {
    nodes: usize,
    /// In the order of [`NAMES`].
    seconds: [f64; 5],
    error: f64,
    /// Of the fast climb and of the climb.
    differences: [f64; 2],
    iterations: [usize; 2],
}

impl Row {
    fn measure(case: &Case, levels: usize) -> Result<Self, Error> {
        let nodes = case.nodes(levels - 1);
        let repetitions = if nodes > 100_000 { 2 } else { 4 };
        let mut seconds = [f64::INFINITY; 5];
        let (mut climbed, mut direct) = (Vec::new(), Vec::new());
        for _ in 0..repetitions {
            climbed.clear();
            for (place, settings) in [ClimbSettings::FAST, ClimbSettings::default()]
                .into_iter()
                .enumerate()
            {
                climbed.push(timed(&mut seconds[place], || {
                    climb(&case.problem, &case.meshes(levels), 1.0, settings)
                })?);
            }
            for (place, solver) in [(2, LinearSolver::Multigrid), (3, LinearSolver::Direct)] {
                direct = timed(&mut seconds[place], || {
                    nested(&case.problem, &case.meshes(levels), solver)
                })?;
            }
            timed(&mut seconds[4], || {
                let meshes = case.meshes(levels);
                nested(&case.problem, &meshes[levels - 1..], LinearSolver::Direct)
            })?;
        }
        let error = climbed[1].discretisation_error;
        let difference = |own: &ShapeClimb| distance(&own.state.displacement, &direct) / error;
        Ok(Self {
            nodes: direct.len() / 2,
            seconds,
            error,
            differences: [difference(&climbed[0]), difference(&climbed[1])],
            iterations: [0, 1]
                .map(|own| climbed[own].work.last().map_or(0, |work| work.iterations)),
        })
    }

    fn told(&self, name: &str) -> String {
        let mut told = format!("{name:22} {:8} nodes:", self.nodes);
        for (name, seconds) in NAMES.iter().zip(self.seconds) {
            told += &format!("  {name} {seconds:.3} ({:.1})", seconds / self.seconds[0]);
        }
        let [fast, exact] = self.differences;
        let [few, more] = self.iterations;
        told + &format!(
            "  differences {fast:.4}, {exact:.5}; iterations on the finest mesh {few}, {more}"
        )
    }

    fn csv(&self, name: &str) -> String {
        let differences = [
            self.differences[0],
            self.differences[1],
            f64::NAN,
            0.0,
            f64::NAN,
        ];
        let rows = NAMES.iter().zip(self.seconds).zip(differences);
        let row = |((contestant, seconds), difference)| {
            format!(
                "\"{name}\",{},\"{contestant}\",{seconds:.4},{:.3e},{difference:.3e}\n",
                self.nodes, self.error
            )
        };
        rows.map(row).collect()
    }
}

/// Does some work and keeps its time where it is the shortest.
fn timed<T>(shortest: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let found = work();
    *shortest = shortest.min(start.elapsed().as_secs_f64());
    found
}

/// The field on the last of some meshes by Newton's method, begun on each with that of the mesh before.
fn nested(
    problem: &BoundaryProblem,
    meshes: &[Mesh],
    solver: LinearSolver,
) -> Result<Vec<f64>, Error> {
    let mut coarser: Option<(&Mesh, State)> = None;
    for mesh in meshes {
        let energy = problem.finite_elements(mesh);
        let model = problem
            .on(mesh, &energy)
            .map_err(|fault| Error::Input(vec![fault]))?;
        let mut model = model.solved_by(solver);
        if let Some((mesh, state)) = &coarser {
            model = model.near(mesh, std::slice::from_ref(state));
        }
        let state = model.reach(&[1.0], NEWTON)?;
        coarser = Some((mesh, state));
    }
    Ok(coarser
        .map(|(_, state)| state.displacement)
        .unwrap_or_default())
}

/// Root mean square over the nodes in mm.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    (squares.sum::<f64>() / (0.5 * a.len() as f64)).sqrt()
}
