//! Nested correction on any shape: it leads to the equilibrium of the finest mesh, and states its discretisation error.

use std::path::Path;
use std::sync::Arc;

use gelbench::corrector::CorrectorSettings;
use gelbench::corrector::nested::{NestedCorrection, NestedMeshes};
use gelbench::corrector::specimen::correct;
use gelbench::material::{Card, HyperelasticLaw, NeoHooke};
use gelbench::mesh::{CellShape, Mesh, Shape};
use gelbench::problem::{BoundaryProblem, Drive, Load, Support};
use gelbench::solve::{LinearSolver, NewtonSettings, Stage};
use gelbench_corrector::corrector::specimen::correct_without_multipliers;

use crate::common::sheets::{DOG_BONE, RING, STRIP_WITH_HOLE, held, named};

const SETTINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-11,
    max_iterations: 40,
};

struct Case {
    name: &'static str,
    shape: Shape,
    /// Cells across the coarsest mesh.
    across: usize,
    kind: CellShape,
    problem: BoundaryProblem,
}

fn cases() -> Vec<Case> {
    let (hole, bone, ring) = (STRIP_WITH_HOLE, DOG_BONE, RING);
    let pva = Card::load("pva-10", Path::new(".")).unwrap().law;
    let soft: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    let grips = |by: f64| named([("left", held(0.0, 0.0)), ("right", held(by, 0.0))]);
    let pulled = Support::Grip([Drive::Force(2.0), Drive::Displacement(0.0)]);
    let case =
        |name, (shape, across, kind), law: &Arc<dyn HyperelasticLaw>, supports, loads| Case {
            name,
            shape,
            across,
            kind,
            problem: BoundaryProblem {
                thickness: 2.0,
                law: Arc::clone(law),
                regions: Vec::new(),
                supports,
                loads,
            },
        };
    vec![
        case(
            "hole, Q1",
            (hole, 6, CellShape::Quad4),
            &pva,
            grips(50.0),
            vec![],
        ),
        case(
            "hole, T1, force",
            (hole, 6, CellShape::Triangle3),
            &soft,
            named([("left", held(0.0, 0.0)), ("right", pulled)]),
            vec![],
        ),
        case(
            "hole, Q2",
            (hole, 4, CellShape::Quad9),
            &pva,
            grips(50.0),
            vec![],
        ),
        case(
            "dog-bone, Q1",
            (bone, 6, CellShape::Quad4),
            &pva,
            grips(50.0),
            vec![],
        ),
        case(
            "ring sector under pressure, Q1",
            (ring, 3, CellShape::Quad4),
            &soft,
            named([("start", Support::Roller), ("end", Support::Roller)]),
            named([("inside", Load::Pressure(0.02))]),
        ),
    ]
}

fn root_mean_square(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    let sum: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / (0.5 * a.len() as f64)).sqrt()
}

fn correct_on(problem: &BoundaryProblem, meshes: &[Mesh]) -> NestedCorrection {
    NestedMeshes::new(problem, meshes).correct(1.0).unwrap()
}

/// The stated error against meshes with cells a quarter as large, or half where they are quadratic.
#[test]
fn the_stated_discretisation_error_is_true_within_two() {
    for case in cases() {
        // With three meshes the ratio of two changes is all that is known, which is too little.
        let (levels, finest) = match case.kind {
            CellShape::Quad9 => (4, 5),
            _ => (4, 6),
        };
        let meshes = (0..finest).map(|level| case.shape.mesh(case.across << level, case.kind));
        let meshes: Vec<Mesh> = meshes.collect();
        let corrected = correct_on(&case.problem, &meshes[..levels]);
        let finer = correct_on(&case.problem, &meshes);
        let interpolation = meshes[finest - 1].interpolation_on(&meshes[levels - 1]);
        let there = interpolation.apply(&finer.state.displacement);
        let true_error = root_mean_square(&corrected.state.displacement, &there);
        let ratio = corrected.discretisation_error / true_error;
        assert!(
            (0.5..2.0).contains(&ratio),
            "{}: stated over true {ratio}",
            case.name
        );
    }
}

#[test]
fn nested_meshes_lead_to_the_field_with_multipliers_and_to_that_without() {
    for case in cases() {
        let meshes = [1, 2].map(|halves| case.shape.mesh(halves * case.across, case.kind));
        let start = correct_on(&case.problem, &meshes).state.displacement;
        let [_, mesh] = meshes;
        let energy = case.problem.finite_elements(&mesh);
        let model = case.problem.on(&mesh, &energy).unwrap();
        let with = correct(
            &model,
            &start,
            &start,
            Stage::first(1.0),
            CorrectorSettings::default(),
        )
        .unwrap();
        for solver in [LinearSolver::Direct, LinearSolver::Multigrid] {
            let model = case.problem.on(&mesh, &energy).unwrap().solved_by(solver);
            let without =
                correct_without_multipliers(&model, &start, Stage::first(1.0), SETTINGS).unwrap();
            for field in [&start, &without.displacement] {
                let apart = root_mean_square(&with.state.displacement, field);
                assert!(apart < 1e-7, "{}: {apart} mm", case.name);
            }
        }
    }
}
