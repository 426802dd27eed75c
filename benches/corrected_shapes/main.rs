//! The climb on any shape compared with finite elements: time, error, memory and work, from some hundred nodes to about a million.
//!
//! ```text
//! cargo bench --bench corrected_shapes              all of it, about a quarter of an hour and 7 GB
//! cargo bench --bench corrected_shapes -- --quick   up to 32,000 nodes
//! cargo bench --bench corrected_shapes -- --path    a hundred load factors, and grips in the hand, on some 10,000 nodes
//! cargo bench --bench corrected_shapes -- --spent   time per unknown, as published solvers tell it
//! cargo bench --bench corrected_shapes -- Cook      shapes with such a word in their names alone
//! ```
//!
//! Every time runs from the problem to field and reactions, with all meshes and analysis, on one thread; it is the shortest of several
//! runs in which all contestants take turns (one run where it takes more than 3 s). Writes `output/bench/corrected_shapes.csv`, which
//! has the columns of `corrected_plate.csv` and the shape, and `.png`.
//!
//! | contestant | what it is |
//! |---|---|
//! | climb | `shape_climb::climb` with the default tolerance, 1/1000 of the discretisation error |
//! | fast climb | the same with `ClimbSettings::FAST` |
//! | Newton with multigrid | Newton's method with the climb's multigrid, begun with the equilibrium of the mesh before, on all meshes |
//! | finite elements, nested guess | the same with a sparse factor of every tangent: the best direct opponent |
//! | finite elements, one mesh | with factors on the finest mesh alone, in load steps where it must |
//!
//! The opponents know the mesh's own error and stop as early as it allows (see `opponent.rs`, `measure.rs`). Equal accuracy means any
//! mesh: linear and quadratic cells, equal or graded towards clamped corners and the corners of holes, as coarse as the accuracy
//! allows.
//!
//! Errors are root mean square differences of displacements over the area, at places that few meshes have as nodes, from a converged
//! field (quadratic elements, graded), relative to the root mean square displacement. The force is that on the grip, or the strain
//! energy where loads are given.
//!
//! The exit code is 0 when all aims are met, 1 when one is not (its line says FAIL), 3 when something has no solution, and
//! 4 when a file cannot be written.

#[path = "../common/columns.rs"]
mod columns;
#[path = "../common/lines.rs"]
mod lines;
mod measure;
mod meshes;
mod opponent;
mod path;
mod reference;
mod shapes;
mod spent;
mod table;
mod verdict;
mod way;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use gelbench::error::Error;
use gelbench::material::Card;
use gelbench::mesh::CellShape;
use gelbench::output;
use peak_alloc::PeakAlloc;
use rayon::{ThreadPool, ThreadPoolBuilder};

use measure::{Bench, Progress, Run};
use reference::Reference;
use shapes::{Case, Family};
use table::Row;
use verdict::Verdicts;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const FOLDER: &str = "output/bench";
/// What the climb's field may differ from that of the direct path on a path, over its discretisation error.
const SHARE: f64 = 0.1;
/// Nodes of the smallest meshes.
const LEAST: usize = 300;

/// What is measured: nodes at most.
pub struct Extent {
    /// Of equal cells: of the families that have a mesh of about 10⁵ nodes, and of the others of their kind.
    equal: [usize; 2],
    /// Of equal linear cells: the largest mesh, of any family.
    largest: usize,
    graded: usize,
    reference: usize,
    /// Of finite elements on one mesh, with equal cells and graded.
    one_mesh: [usize; 2],
    /// Of finite elements with a nested guess, linear and quadratic.
    nested: [usize; 2],
    /// Of all other ways than the fast climb, which are compared with the exact solution on the mesh.
    exact: usize,
    /// Of the comparison with two threads.
    two_threads: usize,
    /// Gradings and families of each shape and kind of cells.
    gradings: usize,
    families: usize,
}

const FULL: Extent = Extent {
    equal: [600_000, 60_000],
    largest: 1_150_000,
    graded: 30_000,
    reference: 130_000,
    one_mesh: [150_000, 5_000],
    nested: [1_150_000, 300_000],
    exact: 300_000,
    two_threads: 60_000,
    gradings: 2,
    families: 2,
};
const QUICK: Extent = Extent {
    equal: [32_000; 2],
    largest: 0,
    graded: 15_000,
    reference: 50_000,
    one_mesh: [50_000, 5_000],
    nested: [50_000; 2],
    exact: 50_000,
    two_threads: 10_000,
    gradings: 1,
    families: 1,
};

/// Nodes about which times are compared at the same nodes.
pub const COMPARED: f64 = 1e5;

fn main() -> ExitCode {
    let has = |option: &str| std::env::args().any(|argument| argument == option);
    let [one, two] = [1, 2].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads")
    });
    lines::ended(one.install(|| match (has("--path"), has("--quick")) {
        (true, _) => paths(),
        _ if has("--spent") => spent(),
        (_, true) => bench(&QUICK, &two),
        _ => bench(&FULL, &two),
    }))
}

/// Measures everything; the number of aims that are not met.
fn bench(extent: &Extent, two: &ThreadPool) -> Result<usize, Error> {
    let law = Card::load("pva-10", Path::new("."))?.law;
    let (mut runs, mut verdicts) = (Vec::new(), Verdicts::default());
    let wanted: Vec<String> = std::env::args()
        .skip(1)
        .filter(|own| !own.starts_with('-'))
        .collect();
    let is_wanted =
        |case: &Case| wanted.is_empty() || wanted.iter().any(|own| case.name.contains(own));
    for case in shapes::all(&law).into_iter().filter(is_wanted) {
        let reference = Reference::new(&case, extent.reference)?;
        println!(
            "{}: reference {}, {} nodes, own error about {:.1e} %",
            case.name, reference.layout, reference.nodes, reference.own_percent
        );
        let bench = Bench {
            reference: &reference,
            two,
            extent,
        };
        let own = shape(&case, &bench)?;
        verdicts.shape(case.name, &own, &reference);
        runs.extend(own);
    }
    let rows = Row::all(&runs);
    let columns: Vec<_> = rows.iter().map(Row::columns).collect();
    columns::print(&columns);
    let missed = verdicts.print();
    let picture = table::picture(&runs, &verdicts);
    let picture = picture.map_err(|fault| Error::write("corrected_shapes.png", fault))?;
    for (name, bytes) in [
        ("corrected_shapes.csv", columns::csv(&columns)),
        ("corrected_shapes.png", picture),
    ] {
        let path = Path::new(FOLDER).join(name);
        // That of the run before.
        let _ = std::fs::remove_file(&path);
        output::save(&path, &bytes)?;
        println!("{}", path.display());
    }
    Ok(missed)
}

/// Measures all meshes of a shape.
fn shape(case: &Case, bench: &Bench) -> Result<Vec<Run>, Error> {
    let extent = bench.extent;
    let gradings = case.gradings.iter().take(extent.gradings).copied();
    let mut runs = Vec::new();
    for grading in std::iter::once(1.0).chain(gradings) {
        for (family, levels) in meshes_of(case, grading, extent) {
            let mut progress = Progress::default();
            for level in levels {
                let own = match bench.mesh(&family, level, &mut progress) {
                    Err(Error::Solve { step, fault, .. }) => {
                        println!("{}: no solution at {step}: {fault}", family.layout(level));
                        break;
                    }
                    other => other?,
                };
                own.iter().for_each(table::print_run);
                runs.extend(own);
            }
        }
    }
    Ok(runs)
}

/// The families of a shape with a grading, each with the levels that are measured.
fn meshes_of<'a>(case: &'a Case, grading: f64, extent: &Extent) -> Vec<(Family<'a>, Vec<usize>)> {
    let mut all = Vec::new();
    for kind in case.kinds {
        let families = case.families(grading, kind);
        let far = |family: &Family| {
            let nodes = family.levels(LEAST..=extent.equal[0]).into_iter();
            let far = nodes.map(|level| (family.nodes(level) as f64 / COMPARED).ln().abs());
            far.fold(f64::INFINITY, f64::min)
        };
        let mut families: Vec<_> = families.to_vec();
        families.sort_by(|a, b| far(a).total_cmp(&far(b)));
        for (number, family) in families.into_iter().take(extent.families).enumerate() {
            let most = match grading == 1.0 {
                true => extent.equal[number],
                false => extent.graded,
            };
            let mut levels = family.levels(LEAST..=most);
            if grading == 1.0 && kind == case.kinds[0] {
                levels.extend(family.levels(extent.equal[0] + 1..=extent.largest));
            }
            all.push((family, levels));
        }
    }
    all
}

/// What is spent per unknown on all shapes; no aim is set for it.
fn spent() -> Result<usize, Error> {
    let law = Card::load("pva-10", Path::new("."))?.law;
    spent::bench(&shapes::all(&law))?;
    Ok(0)
}

/// Nodes of the meshes on which paths are followed, about.
const PATH_NODES: [usize; 2] = [10_000, 30_000];

/// Paths on strips with a hole; the number of aims that are not met.
fn paths() -> Result<usize, Error> {
    let law = Card::load("pva-10", Path::new("."))?.law;
    let cases = shapes::all(&law);
    let mut passes = true;
    for (kind, base) in [(CellShape::Quad4, 6), (CellShape::Quad9, 4)] {
        let family = Family {
            case: &cases[0],
            kind,
            grading: 1.0,
            base,
        };
        let nodes: Vec<usize> = family
            .meshes(6)
            .iter()
            .map(|mesh| mesh.nodes.len())
            .collect();
        let nearest = PATH_NODES.map(|wanted| {
            let levels = 2..nodes.len();
            levels.min_by_key(|level| nodes[*level].abs_diff(wanted))
        });
        for level in std::collections::BTreeSet::from(nearest)
            .into_iter()
            .flatten()
        {
            passes &= path::bench(&family, level + 1)?;
        }
    }
    println!(
        "{} difference to the direct path: at most {SHARE} of the discretisation error",
        if passes { "pass" } else { "FAIL" }
    );
    Ok(usize::from(!passes))
}

/// Does some work and keeps its time where it is the shortest.
fn timed<T>(shortest: &mut f64, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let found = work();
    *shortest = shortest.min(start.elapsed().as_secs_f64());
    found
}

/// Root mean square over the nodes in mm.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    (squares.sum::<f64>() / (0.5 * a.len() as f64)).sqrt()
}
