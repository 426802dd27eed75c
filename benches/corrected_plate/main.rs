//! The corrected plate compared with finite elements: time, error, memory and work, from a thousand nodes to over a million.
//!
//! ```text
//! cargo bench --bench corrected_plate              all of it, some minutes and 6 GB
//! cargo bench --bench corrected_plate -- --quick   grids up to a quarter of a million nodes
//! cargo bench --bench corrected_plate -- --equal-accuracy   what is best at equal accuracy alone
//! ```
//!
//! Equal accuracy means any grid: cells of all degrees, equal or graded towards the corners, where the field is singular, as coarse
//! as the accuracy allows.
//!
//! A plate of 150 × 50 × 2 mm of 10 % PVA hydrogel (`pva-10`), stretched by 100 %. Every time runs from the problem to
//! field and force, with grids, meshes and analysis, on one thread where nothing else is said; it is the shortest of
//! several runs in which all contestants take turns. Errors are departures from the affine stretch in relative L2 and
//! forces, against a converged field. Writes `output/bench/corrected_plate.csv` and `.png`.
//!
//! The exit code is 0 when all aims are met, 1 when one is not (its line says FAIL), 3 when something has no solution, and
//! 4 when a file cannot be written.

mod measure;
mod method;
mod opponent;
mod reference;
mod table;
mod verdict;

use std::path::Path;
use std::process::ExitCode;

use gelbench::error::Error;
use gelbench::material::Card;
use gelbench::problem::ClampedPlate;
use gelbench_report::output;
use peak_alloc::PeakAlloc;
use rayon::ThreadPoolBuilder;

use measure::Bench;
use method::Layout;
use reference::{PUBLISHED_FORCE, Reference};
use table::Row;
use verdict::Verdicts;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const STRETCH: f64 = 1.0;
const FOLDER: &str = "output/bench";
/// Cells along X and Y of the grids on which the climb is measured.
const CORRECTED: [[usize; 2]; 7] = [
    [60, 20],
    [120, 40],
    [240, 80],
    [480, 160],
    [600, 200],
    [960, 320],
    [1920, 640],
];
/// Further grids of nodes for finite elements of equal accuracy.
const FURTHER: [[usize; 2]; 11] = [
    [36, 12],
    [48, 16],
    [72, 24],
    [96, 32],
    [144, 48],
    [192, 64],
    [288, 96],
    [360, 120],
    [576, 192],
    [768, 256],
    [1200, 400],
];
/// Gradings, and the cells of graded grids, which the climb and finite elements are measured on.
const GRADINGS: [f64; 4] = [1.5, 2.0, 2.5, 3.0];
const GRADED: [[usize; 2]; 17] = [
    [24, 8],
    [36, 12],
    [48, 16],
    [54, 18],
    [60, 20],
    [72, 24],
    [96, 32],
    [108, 36],
    [120, 40],
    [144, 48],
    [192, 64],
    [216, 72],
    [240, 80],
    [288, 96],
    [360, 120],
    [480, 160],
    [600, 200],
];
/// Cells of equal grids above which nothing is best at equal accuracy.
const BEST: usize = 30_000;
/// Nodes above which grids are left out by `--quick`.
const QUICK: usize = 250_000;

fn main() -> ExitCode {
    let asked = |name: &str| std::env::args().any(|argument| argument == name);
    match bench(asked("--quick"), asked("--equal-accuracy")) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(missed) => {
            eprintln!("{missed} aims are not met: see the lines that say FAIL");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
    }
}

/// All grids up to so many equal cells, and whether the climb is measured on them.
fn layouts(most: usize) -> Vec<(Layout, bool)> {
    let mut equal: Vec<([usize; 2], bool)> = CORRECTED.map(|cells| (cells, true)).to_vec();
    equal.extend(FURTHER.map(|cells| (cells, false)));
    equal.sort_unstable();
    equal.retain(|(cells, _)| cells[0] * cells[1] <= most);
    let equal = equal.into_iter();
    let equal = equal.map(|(cells, corrected)| (Layout::equal(cells), corrected));
    let graded = GRADINGS
        .into_iter()
        .flat_map(|grading| GRADED.map(|cells| (Layout { cells, grading }, true)));
    equal.chain(graded).collect()
}

/// Measures everything; the number of aims that are not met.
fn bench(quick: bool, equal_accuracy: bool) -> Result<usize, Error> {
    let problem = ClampedPlate {
        size: [150.0, 50.0],
        thickness: 2.0,
        law: Card::load("pva-10", Path::new("."))?.law,
        stretches: vec![STRETCH],
    };
    let pools = [1, 2].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads")
    });
    let reference = pools[1].install(|| Reference::new(&problem, STRETCH))?;
    println!(
        "reference: force {:.6} N (published {PUBLISHED_FORCE} N), own departure below {:.1e} %",
        reference.force, reference.error_percent
    );
    let bench = Bench {
        problem: &problem,
        reference: &reference,
        stretch: STRETCH,
        pools: &pools,
    };
    let mut runs = Vec::new();
    for (layout, corrected) in layouts(if equal_accuracy {
        BEST
    } else if quick {
        QUICK
    } else {
        usize::MAX
    }) {
        let measured = bench.grid(layout, corrected)?;
        measured.iter().for_each(table::print_run);
        runs.extend(measured);
    }
    let rows = Row::all(&runs);
    println!("\n{}", table::columns(&rows).block().plain());
    let mut verdicts = Verdicts::new(&reference);
    verdicts.equal_accuracy(&runs);
    if !equal_accuracy {
        verdicts.rows(&rows);
    }
    let missed = verdicts.print();
    let folder = Path::new(FOLDER);
    let picture = table::picture(&runs);
    let picture = picture.map_err(|fault| Error::write("corrected_plate.png", fault))?;
    for (name, bytes) in [
        (
            "corrected_plate.csv",
            table::columns(&rows).csv().into_bytes(),
        ),
        ("corrected_plate.png", picture),
    ] {
        let path = folder.join(name);
        // That of the run before.
        let _ = std::fs::remove_file(&path);
        output::save(&path, &bytes)?;
        println!("{}", path.display());
    }
    Ok(missed)
}
