//! Paths of many load factors beside direct ones.

use std::sync::Arc;

use super::cases::{Case, all, case, distance};
use crate::corrector::climb::ClimbSettings;
use crate::corrector::shape_climb::systems::departure;
use crate::corrector::shape_climb::{Climb, ShapeClimb};
use crate::error::{Error, SolveFault};
use crate::material::NeoHooke;
use crate::mesh::{CellShape, Shape};
use crate::problem::{BoundaryProblem, Load, Support};

fn followed(case: &Case, factors: &[f64]) -> Vec<ShapeClimb> {
    let mut climb = Climb::new(&case.problem, &case.meshes, ClimbSettings::FAST);
    let mut states = Vec::new();
    let done = climb.follow(factors, &mut |own| states.push(own.clone()));
    done.unwrap_or_else(|fault| panic!("{}: {fault}", case.name));
    states
}

#[test]
fn no_state_of_a_path_differs_from_the_direct_one_by_a_tenth_of_the_discretisation_error() {
    // Up and down, and one load factor twice.
    let factors = [0.2, 0.35, 0.5, 0.65, 0.65, 0.8, 0.7, 0.5];
    for case in all() {
        let states = followed(&case, &factors);
        for (own, exact) in states.iter().zip(case.direct(&factors)) {
            assert_eq!(own.state.factor, exact.factor);
            let off = distance(&own.state.displacement, &exact.displacement);
            let error = own.discretisation_error;
            let told = format!("{} at {}: {off} of {error}", case.name, exact.factor);
            println!("{told}");
            assert!(off <= 0.1 * error, "{told}");
            assert!(own.iteration_error <= 0.1 * error, "{told}");
            let balance = case.with_model(|model| model.reactions(&own.state).balance());
            assert!(balance.relative() < 2e-3, "{told}: {}", balance.relative());
            let [work] = own.work[..] else { continue };
            let by_factors = work.linearisations > 0 && work.iterations == 0;
            let serves = if case.is_symmetric {
                !by_factors
            } else {
                work.iterations == 0
            };
            assert!(serves, "{told}: {work:?}");
        }
    }
}

/// Three states and more are extrapolated and corrected on the tangents that are at hand: a tangent for five states at most.
#[test]
fn most_states_of_a_path_take_no_tangent_and_few_iterations() {
    let law: Arc<dyn crate::material::HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    for place in [0, 1, 4, 5] {
        let case = case(place, &law, CellShape::Quad4, "neo-hooke");
        let factors: Vec<f64> = (1..=40).map(|step| 0.025 * f64::from(step)).collect();
        let states = followed(&case, &factors);
        let between = &states[1..39];
        let sum = |pick: fn(&ShapeClimb) -> usize| between.iter().map(pick).sum::<usize>();
        let tangents = sum(|own| own.work[0].linearisations);
        let iterations = sum(|own| own.work[0].iterations);
        let told = format!(
            "{}: {tangents} tangents, {iterations} iterations",
            case.name
        );
        assert!(tangents <= 8 && iterations <= 4 * 38, "{told}");
        assert!(
            states.iter().all(|own| own.state.history.is_empty()),
            "{told}"
        );
    }
}

/// A bore is blown up beyond its largest pressure: the states before are told, and the end has the words of the direct path.
#[test]
fn a_path_beyond_the_largest_load_tells_the_states_before_and_why_it_ends() {
    let problem = BoundaryProblem {
        thickness: 2.0,
        law: Arc::new(NeoHooke { c10: 0.05 }),
        supports: ["start", "end"]
            .map(|name| (name.to_owned(), Support::Roller))
            .into(),
        loads: vec![("inside".to_owned(), Load::Pressure(0.2))],
    };
    let ring = Shape::RingSector {
        radii: [10.0, 20.0],
        angle: std::f64::consts::FRAC_PI_2,
    };
    let meshes: Vec<_> = (0..3)
        .map(|level| ring.mesh(2 << level, CellShape::Quad4))
        .collect();
    let mut climb = Climb::new(&problem, &meshes, ClimbSettings::FAST);
    let factors: Vec<f64> = (1..=20).map(|step| 0.05 * f64::from(step)).collect();
    let mut told = Vec::new();
    let end = climb.follow(&factors, &mut |own| told.push(own.state.factor));
    let fault = end.unwrap_err();
    let energy = problem.finite_elements(&meshes[2]);
    let model = problem.on(&meshes[2], &energy).unwrap();
    let direct = model
        .solve(&factors, super::cases::EXACT, &|_| ())
        .unwrap_err();
    assert_eq!(told.len(), direct.states.len(), "{fault} beside {direct}");
    assert!(told.len() > 3, "{told:?}");
    let Error::Solve { fault, .. } = fault else {
        panic!("{fault}");
    };
    assert!(matches!(fault, SolveFault::LoadMaximum { .. }), "{fault}");
}

/// One mesh alone tells no discretisation error: its states are found with factors, as exactly as by the direct path.
#[test]
fn a_path_on_one_mesh_is_the_direct_one() {
    let law: Arc<dyn crate::material::HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    let mut case = case(1, &law, CellShape::Triangle6, "neo-hooke");
    case.meshes.drain(..2);
    let factors = [0.0, 0.3, 0.6, 1.0];
    for (own, exact) in followed(&case, &factors).iter().zip(case.direct(&factors)) {
        let off = distance(&own.state.displacement, &exact.displacement);
        assert!(off < 1e-8, "{off}");
        assert!(own.discretisation_error.is_nan());
    }
}

/// The state of rest tells no errors, and those before it are told by the others.
#[test]
fn a_path_to_rest_states_its_errors() {
    let law: Arc<dyn crate::material::HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    let case = case(0, &law, CellShape::Quad4, "neo-hooke");
    let factors = [0.6, 0.4, 0.2, 0.0];
    let states = followed(&case, &factors);
    for (own, exact) in states.iter().zip(case.direct(&factors[..3])) {
        let off = distance(&own.state.displacement, &exact.displacement);
        let error = own.discretisation_error;
        assert!(error > 0.0 && off <= 0.1 * error, "{off} of {error}");
    }
    assert!(states[3].state.displacement.iter().all(|u| u.abs() < 1e-9));
}

/// ‖u‖ counts no rigid motion, and is in proportion to a small strain.
#[test]
fn departures_are_from_the_nearest_rigid_motion() {
    let mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(4, CellShape::Quad9);
    let field = |angle: f64, strain: f64| -> Vec<f64> {
        let (sine, cosine) = f64::sin_cos(angle);
        let moved = mesh.nodes.iter().flat_map(|[x, y]| {
            let [x1, y1] = [x + strain * x, y - strain * y];
            [
                7.0 + cosine * x1 - sine * y1 - x,
                -3.0 + sine * x1 + cosine * y1 - y,
            ]
        });
        moved.collect()
    };
    let strained = departure(&mesh, &field(0.0, 0.01));
    assert!(strained > 0.05, "{strained}");
    for angle in [0.0, 0.4, 3.0, -2.0] {
        assert!(departure(&mesh, &field(angle, 0.0)) < 1e-13, "{angle}");
        let turned = departure(&mesh, &field(angle, 0.01));
        assert!((turned / strained - 1.0).abs() < 1e-10, "{angle}: {turned}");
        let less = departure(&mesh, &field(angle, 0.001));
        assert!((less / strained - 0.1).abs() < 1e-10, "{angle}: {less}");
    }
}
