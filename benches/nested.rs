//! Nested correction of a strip with a hole, and finite elements on its finest mesh alone, side by side: `cargo bench --bench nested`.
//!
//! Neo-Hooke's law, pulled by half of its length, one thread: springs on a mesh with four cells across are corrected there and carried from mesh
//! to mesh. The opponent starts from rest on the finest mesh, with load steps where it needs them.

use std::sync::Arc;
use std::time::Instant;

use gelbench::corrector::nested::NestedMeshes;
use gelbench::material::NeoHooke;
use gelbench::mesh::{CellShape, Mesh};
use gelbench::problem::BoundaryProblem;
use gelbench::solve::NewtonSettings;

#[expect(dead_code, reason = "other shapes are those of tests")]
#[path = "../tests/common/sheets.rs"]
mod sheets;

use sheets::{STRIP_WITH_HOLE, held, named};

const NEWTON: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 60,
};

/// Cells across the coarsest mesh.
const COARSEST: usize = 4;

/// Seconds, the least of three.
fn seconds(mut run: impl FnMut()) -> f64 {
    let runs = (0..3).map(|_| {
        let begin = Instant::now();
        run();
        begin.elapsed().as_secs_f64()
    });
    runs.fold(f64::INFINITY, f64::min)
}

fn compare(problem: &BoundaryProblem, kind: CellShape, halvings: u32) {
    let meshes = (0..=halvings).map(|level| STRIP_WITH_HOLE.mesh(COARSEST << level, kind));
    let meshes: Vec<Mesh> = meshes.collect();
    let finest = &meshes[halvings as usize];
    let nested = seconds(|| {
        let field = NestedMeshes::new(problem, &meshes).correct(1.0);
        field.expect("a corrected field");
    });
    let alone = seconds(|| {
        let energy = problem.finite_elements(finest);
        let model = problem.on(finest, &energy).expect("a problem");
        model.reach(&[1.0], NEWTON).expect("an equilibrium");
    });
    println!(
        "| {kind:?} | {} | {nested:.4} | {alone:.4} | {:.2} |",
        finest.nodes.len(),
        alone / nested
    );
}

fn main() {
    let ends = named([("left", held(0.0, 0.0)), ("right", held(50.0, 0.0))]);
    let problem = BoundaryProblem::supported(2.0, Arc::new(NeoHooke { c10: 0.05 }), ends);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    one.expect("a thread").install(|| {
        println!("| cells | nodes | nested [s] | one mesh [s] | one mesh over nested |");
        println!("|---|---|---|---|---|");
        for (kind, halvings) in [(CellShape::Quad4, [2, 4, 5]), (CellShape::Quad9, [1, 3, 4])] {
            for halvings in halvings {
                compare(&problem, kind, halvings);
            }
        }
    });
}
