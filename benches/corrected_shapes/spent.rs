//! Processor time per unknown and load state, for comparison with published solvers.

use std::time::Instant;

use gelbench::corrector::climb::ClimbSettings;
use gelbench::corrector::shape_climb::climb;
use gelbench::error::Error;

use super::COMPARED;
use super::opponent::by_multigrid;
use super::shapes::{Case, Family};

/// Of the largest reaction: about that of the published solver.
const TOLERANCE: f64 = 1e-9;
/// Runs, of which the shortest counts.
const REPETITIONS: usize = 3;

/// Prints what one thread spends on meshes of about 10⁵ nodes, from the problem to the field: all meshes, patterns and tangents included.
pub fn bench(cases: &[Case]) -> Result<(), Error> {
    println!(
        "µs of one thread per unknown and load state: fast climb; climb; Newton's method with the climb's multigrid to {TOLERANCE:.0e} \
         of the largest reaction"
    );
    for case in cases {
        for kind in case.kinds {
            let [family, other] = case.families(1.0, kind).map(|own| (far(&own), own));
            let (level, family) = if family.0.1 < other.0.1 {
                (family.0.0, family.1)
            } else {
                (other.0.0, other.1)
            };
            let spent = spent(&family, level + 1)?;
            println!(
                "  {:40} {:7} nodes  {:6.2} {:6.2} {:6.2}",
                family.name(),
                family.nodes(level),
                spent[0],
                spent[1],
                spent[2]
            );
        }
    }
    Ok(())
}

/// The level nearest to the nodes that are compared, and how far it is.
fn far(family: &Family) -> (usize, f64) {
    let far = |level: usize| (family.nodes(level) as f64 / COMPARED).ln().abs();
    let levels = (1..10).map(|level| (level, far(level)));
    let nearest = levels.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.expect("levels")
}

fn spent(family: &Family, levels: usize) -> Result<[f64; 3], Error> {
    let problem = &family.case.problem;
    let mut shortest = [f64::INFINITY; 3];
    for _ in 0..REPETITIONS {
        for (place, shortest) in shortest.iter_mut().enumerate() {
            let begin = Instant::now();
            let meshes = family.meshes(levels);
            let nodes = meshes[levels - 1].nodes.len();
            match place {
                0 => drop(climb(problem, &meshes, 1.0, ClimbSettings::FAST)?),
                1 => drop(climb(problem, &meshes, 1.0, ClimbSettings::default())?),
                _ => drop(by_multigrid(problem, &meshes, TOLERANCE)?),
            }
            let spent = 1e6 * begin.elapsed().as_secs_f64() / (2 * nodes) as f64;
            *shortest = shortest.min(spent);
        }
    }
    Ok(shortest)
}
