//! Multigrid finds what a factor finds: shapes × elements × laws × supports × loads, and says the same where there is nothing to find.

use std::path::Path;
use std::sync::Arc;

use gelbench::material::{Card, HyperelasticLaw, NeoHooke};
use gelbench::mesh::{CellShape, Mesh, Shape};
use gelbench::problem::{BoundaryProblem, Drive, Load, Support};
use gelbench::solve::{LinearSolver, NewtonSettings, PathEnd, State};
use gelbench_mechanics::mesh::Grid;

use crate::common::sheets::{DOG_BONE, RING, STRIP_WITH_HOLE, held, named};

const SETTINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-10,
    max_iterations: 40,
};

fn pva() -> Arc<dyn HyperelasticLaw> {
    Card::load("pva-10", Path::new(".")).unwrap().law
}

fn neo_hooke() -> Arc<dyn HyperelasticLaw> {
    Arc::new(NeoHooke { c10: 0.05 })
}

struct Case {
    name: &'static str,
    mesh: Mesh,
    problem: BoundaryProblem,
}

fn cases() -> Vec<Case> {
    let (hole, bone, ring) = (STRIP_WITH_HOLE, DOG_BONE, RING);
    let graded = |kind| {
        let grid = Grid::new([150.0, 50.0], [24, 8], 2.0);
        Mesh::of_grid(grid, kind)
    };
    let grips = |by: f64| named([("left", held(0.0, 0.0)), ("right", held(by, 0.0))]);
    let case = |name, mesh, law: &Arc<dyn HyperelasticLaw>, supports, loads| Case {
        name,
        mesh,
        problem: BoundaryProblem {
            thickness: 2.0,
            law: Arc::clone(law),
            regions: Vec::new(),
            supports,
            loads,
        },
    };
    let (pva, soft) = (pva(), neo_hooke());
    let pulled = Support::Grip([Drive::Force(2.0), Drive::Displacement(0.0)]);
    let turned = Support::Rotation {
        centre: [100.0, 20.0],
        angle: 0.4,
    };
    vec![
        case(
            "hole, Q2",
            hole.mesh(16, CellShape::Quad9),
            &pva,
            grips(30.0),
            vec![],
        ),
        case(
            "hole, T2",
            hole.mesh(16, CellShape::Triangle6),
            &soft,
            grips(30.0),
            vec![],
        ),
        case(
            "hole, T1, traction",
            hole.mesh(24, CellShape::Triangle3),
            &soft,
            named([("left", held(0.0, 0.0))]),
            named([("right", Load::Traction([0.02, 0.005]))]),
        ),
        case(
            "hole, Q1, rollers",
            hole.mesh(24, CellShape::Quad4),
            &pva,
            named([
                ("left", Support::Roller),
                ("bottom", Support::Roller),
                ("right", Support::Displacement([Some(20.0), None])),
            ]),
            vec![],
        ),
        case(
            "hole, Q2, rigid grip with a force",
            hole.mesh(16, CellShape::Quad9),
            &pva,
            named([("left", held(0.0, 0.0)), ("right", pulled)]),
            vec![],
        ),
        case(
            "hole, Q1, turned and under pressure",
            hole.mesh(24, CellShape::Quad4),
            &soft,
            named([("left", held(0.0, 0.0)), ("right", turned)]),
            named([("hole", Load::Pressure(0.02))]),
        ),
        case(
            "dog-bone, Q2",
            bone.mesh(12, CellShape::Quad9),
            &pva,
            grips(40.0),
            vec![],
        ),
        case(
            "ring sector under pressure, Q2",
            ring.mesh(12, CellShape::Quad9),
            &soft,
            named([("start", Support::Roller), ("end", Support::Roller)]),
            named([("inside", Load::Pressure(0.02))]),
        ),
        case(
            "graded plate, Q1",
            graded(CellShape::Quad4),
            &pva,
            grips(75.0),
            vec![],
        ),
        case(
            "graded plate, Q2",
            graded(CellShape::Quad9),
            &pva,
            grips(75.0),
            vec![],
        ),
    ]
}

fn solve(case: &Case, solver: LinearSolver, factors: &[f64]) -> Result<Vec<State>, PathEnd> {
    let energy = case.problem.finite_elements(&case.mesh);
    let model = case.problem.on(&case.mesh, &energy).unwrap();
    model.solved_by(solver).solve(factors, SETTINGS, &|_| ())
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0_f64, |size, b| size.max(b.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size
}

#[test]
fn multigrid_finds_the_equilibrium_that_a_factor_finds() {
    for case in cases() {
        let [by_factor, by_multigrid] = [LinearSolver::Direct, LinearSolver::Multigrid]
            .map(|solver| solve(&case, solver, &[0.5, 1.0]).unwrap());
        for (one, other) in by_factor.iter().zip(&by_multigrid) {
            let apart = largest_difference(&other.displacement, &one.displacement);
            assert!(apart < 1e-8, "{}: {apart}", case.name);
            let apart = largest_difference(&other.residual, &one.residual);
            assert!(apart < 1e-8, "{}: reactions {apart}", case.name);
            // The steps are inexact: it is not the factor that found it.
            let same = one.convergence.residuals == other.convergence.residuals;
            assert!(!same, "{}", case.name);
        }
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads_nor_on_the_place() {
    let case = &cases()[0];
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build()
            .unwrap()
            .install(|| solve(case, LinearSolver::Multigrid, &[1.0]).unwrap())
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one, three);
    let mut far = case.mesh.clone();
    far.nodes.iter_mut().for_each(|node| node[0] += 300.0);
    let far = Case {
        name: case.name,
        mesh: far,
        problem: case.problem.clone(),
    };
    let moved = solve(&far, LinearSolver::Multigrid, &[1.0]).unwrap();
    let apart = largest_difference(&moved[0].displacement, &one[0].displacement);
    assert!(apart < 1e-8, "{apart}");
}

#[test]
fn what_has_no_equilibrium_is_told_in_the_same_words() {
    let column = Shape::Strip { size: [100.0, 8.0] };
    let supports = named([("left", held(0.0, 0.0)), ("right", held(-20.0, 0.0))]);
    let case = Case {
        name: "a pressed column",
        mesh: column.mesh(4, CellShape::Quad9),
        problem: BoundaryProblem {
            thickness: 2.0,
            law: neo_hooke(),
            regions: Vec::new(),
            supports,
            loads: vec![],
        },
    };
    let [by_factor, by_multigrid] = [LinearSolver::Direct, LinearSolver::Multigrid]
        .map(|solver| solve(&case, solver, &[1.0]).unwrap_err());
    assert_eq!(by_factor.fault, by_multigrid.fault);
    assert!((by_factor.reached() - by_multigrid.reached()).abs() < 1e-3);
}

/// A guess from a coarser mesh changes the way and not the result, and saves iterations.
#[test]
fn first_guesses_of_a_coarser_mesh_lead_to_the_same_equilibria_in_fewer_iterations() {
    let shape = Shape::StripWithHole {
        size: [100.0, 40.0],
        radius: 8.0,
    };
    let problem = BoundaryProblem {
        thickness: 2.0,
        law: pva(),
        regions: Vec::new(),
        supports: named([("left", held(0.0, 0.0)), ("right", held(50.0, 0.0))]),
        loads: vec![],
    };
    let meshes = [8, 16].map(|across| shape.mesh(across, CellShape::Quad9));
    let energies = meshes.each_ref().map(|mesh| problem.finite_elements(mesh));
    let model = |index: usize| problem.on(&meshes[index], &energies[index]).unwrap();
    let factors = [0.4, 1.0];
    let coarse = model(0).solve(&factors, SETTINGS, &|_| ()).unwrap();
    let alone = model(1).solve(&factors, SETTINGS, &|_| ()).unwrap();
    for solver in [LinearSolver::Direct, LinearSolver::Multigrid] {
        let nested = model(1).near(&meshes[0], &coarse).solved_by(solver);
        let nested = nested.solve(&factors, SETTINGS, &|_| ()).unwrap();
        for (one, other) in alone.iter().zip(&nested) {
            assert!(largest_difference(&other.displacement, &one.displacement) < 1e-8);
            let iterations = [one, other].map(|state| state.convergence.iterations());
            assert!(other.load_steps == 1, "{iterations:?}");
            if solver == LinearSolver::Direct {
                assert!(iterations[1] < iterations[0], "{iterations:?}");
            }
        }
    }
}
