//! Conditions, scales, estimates and corrected states compared with closed forms and with the finite elements.

use std::sync::Arc;

use super::*;
use crate::corrector::climb::{Climb, ClimbSettings};
use crate::finite_element::{Element, FiniteElements};
use crate::material::{HyperelasticLaw, NeoHooke};
use crate::mesh::{CellShape, Shape};
use crate::problem::{BoundaryProblem, Drive, Load, Measures, Support};
use crate::solve::{Assembly, Loading, Stage};

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-12,
    max_iterations: 40,
};

#[test]
fn the_residual_is_the_largest_distance_over_the_largest_entry() {
    // 10 u₀ = 0 at u₀ = 3 is 3 mm away, whatever the row is multiplied by; 3 mm is the largest entry.
    let mut rows = SparseRows::new(2);
    rows.push([(0, 10.0)]);
    let condition = Linear::new("zero", rows, vec![0.0]);
    let corrector = Corrector::new(vec![Box::new(condition)], vec![1.0; 2], SETTINGS);
    let correction = corrector.correct(&[3.0, 2.0], &[3.0, 2.0]).unwrap();
    assert!((correction.steps[0].residual - 1.0).abs() < 1e-14);
    assert!(largest_difference(correction.field(), &[0.0, 2.0]) < 1e-14);
}

#[test]
fn unknowns_that_move_together_move_by_their_mean() {
    let condition = Linear::together("grip", 4, &[vec![0, 1, 3]]);
    let corrector = Corrector::new(vec![Box::new(condition)], vec![1.0; 4], SETTINGS);
    let data = [1.0, 3.0, 7.0, 5.0];
    let correction = corrector.correct(&data, &data).unwrap();
    assert!(largest_difference(correction.field(), &[3.0, 3.0, 7.0, 3.0]) < 1e-13);
}

#[test]
fn a_function_hands_on_its_curvature() {
    let rows = |value: f64| {
        let mut rows = SparseRows::new(1);
        rows.push([(0, value)]);
        rows
    };
    let square = Function::new("u² = 4", 1, move |u: &[f64]| Linearisation {
        values: vec![u[0] * u[0] - 4.0],
        jacobian: rows(2.0 * u[0]),
    });
    assert!(square.curvature(&[3.0], &[5.0]).unwrap().is_none());
    let curved = square.with_curvature(move |_, psi| rows(2.0 * psi[0]));
    assert!(curvature_error_of(&curved) < 1e-9);
}

fn curvature_error_of(condition: &dyn Condition) -> f64 {
    super::conditions::curvature_error(condition, &[3.0], &[5.0])
}

/// u₀ = 1 and 10 u₀ = 10 say the same; 10 u₀ = 5 does not.
#[test]
fn rows_of_any_length_contradict_each_other_by_their_right_hand_sides() {
    let mut rows = SparseRows::new(2);
    rows.push([(0, 1.0)]);
    rows.push([(0, 10.0)]);
    for (second, contradictory) in [(10.0, false), (5.0, true)] {
        let computed = dependence::find(&rows, &[-1.0, -second], 1.0).unwrap();
        assert_eq!(computed.contradictory, contradictory, "{second}");
        assert_eq!(computed.rows.len(), 2);
    }
}

/// ū = p + noise of variance s²/w: p = Σ w ū/Σ w, s² = Σ w (ū − p)²/(n − 1), and p is known to s/√Σ w.
#[test]
fn an_estimate_weighs_its_data() {
    let (mut data, mut weights) = (vec![1.0, 2.0, 4.0, 3.0], vec![1.0, 4.0, 0.5, 2.0]);
    let pairs = || data.iter().zip(&weights);
    let all: f64 = weights.iter().sum();
    let mean = pairs().map(|(u, w)| u * w).sum::<f64>() / all;
    let variance = pairs().map(|(u, w)| w * (u - mean).powi(2)).sum::<f64>() / 3.0;
    data.push(0.0);
    weights.push(0.0);
    let mut rows = SparseRows::new(5);
    (0..4).for_each(|row| rows.push([(row, 1.0), (4, -1.0)]));
    let same = Linear::new("the same", rows, vec![0.0; 4]);
    let corrector = Corrector::new(vec![Box::new(same)], weights, SETTINGS);
    let correction = corrector.correct(&data, &data).unwrap();
    let computed = corrector.estimate(&data, &correction, 4).unwrap();
    assert!((computed.value - mean).abs() < 1e-13);
    assert!((computed.standard_error / (variance / all).sqrt() - 1.0).abs() < 1e-12);
}

/// The scheme of the Gauss points has the equations of Q1 elements, that of pairs of cells those of Q2: force, width,
/// energy and field are theirs, by both paths.
#[test]
fn a_corrected_state_is_that_of_the_finite_elements_on_the_same_nodes() {
    let problem = ClampedPlate {
        size: [30.0, 10.0],
        ..problem()
    };
    let plate = MassSpring::new(&problem, [12, 4], LatticeSettings { area_term: false });
    let data = &plate.solve(&problem, TIGHT, &|_| ()).unwrap()[0];
    for (scheme, cells, element) in [
        (DifferenceScheme::Gauss, [12, 4], Element::Q1),
        (DifferenceScheme::Biquadratic, [6, 2], Element::Q2),
    ] {
        let model = FiniteElements::new(&problem, cells, element);
        let expected = &model.solve(&problem, TIGHT, &|_| ()).unwrap()[0];
        let expected = Measures::of(&model.mesh, expected);
        let corrector = PlateCorrector::new(&problem, &plate.mesh, scheme, SETTINGS);
        let settings = ClimbSettings {
            tolerance: 1e-7,
            max_iterations: 60,
        };
        let mut climb = Climb::even(&problem, [12, 4], scheme, settings);
        let field = &data.displacement;
        let direct = corrector.correct(field, STRETCH, KnownConditions::ALL);
        let climbed = corrector.climb(&mut climb, field, STRETCH);
        for corrected in [direct.unwrap(), climbed.unwrap()] {
            let (state, computed) = (corrected.state, corrected.measures);
            for (computed, expected) in [
                (computed.force, expected.force),
                (computed.mid_width, expected.mid_width),
                (computed.energy, expected.energy),
                (state.convergence.energy, expected.energy),
            ] {
                assert!(
                    (computed / expected - 1.0).abs() < 1e-6,
                    "{computed} {expected}"
                );
            }
        }
    }
}

/// A strip clamped on the left, pulled by a rigid grip with a force and by a traction on its upper side: the corrected
/// field is the finite elements' equilibrium, and its multipliers are balanced by the distance to the data.
#[test]
fn a_corrected_specimen_is_in_equilibrium_with_loads_supports_and_ties() {
    let mesh = Shape::Strip { size: [12.0, 6.0] }.mesh(3, CellShape::Quad4);
    let law: Arc<dyn HyperelasticLaw> = Arc::new(NeoHooke { c10: 0.05 });
    let boundary = BoundaryProblem {
        thickness: 2.0,
        law,
        regions: Vec::new(),
        supports: vec![
            ("left".into(), Support::Displacement([Some(0.0); 2])),
            (
                "right".into(),
                Support::Grip([Drive::Force(0.8), Drive::Displacement(0.5)]),
            ),
        ],
        loads: vec![("top".into(), Load::Traction([0.002, 0.003]))],
    };
    let energy = boundary.finite_elements(&mesh);
    let model = boundary.on(&mesh, &energy).unwrap();
    let state = model.solve(&[1.0], TIGHT, &|_| ()).unwrap().remove(0);
    let numbers = noise(state.displacement.len()).into_iter();
    let data: Vec<f64> = numbers
        .zip(&state.displacement)
        .map(|(n, u)| u + 0.05 * n)
        .collect();
    let computed = specimen::correct(
        &model,
        &data,
        &state.displacement,
        Stage::first(1.0),
        SETTINGS,
    )
    .unwrap();
    assert!(largest_difference(&computed.state.displacement, &state.displacement) < 1e-8);
    // Stationary in every unknown: W (u − ū) + Bᵀ ψ = 0.
    let psi: Vec<f64> = computed
        .correction
        .multipliers
        .iter()
        .flat_map(|condition| condition.values.clone())
        .collect();
    let pull = computed
        .correction
        .factor
        .jacobian()
        .multiply_transposed(&psi);
    let moved = difference(computed.correction.field(), &data);
    assert!(largest(&moved) > 0.01);
    let unbalanced: Vec<f64> = moved.iter().zip(&pull).map(|(a, b)| a + b).collect();
    assert!(largest(&unbalanced) < 1e-9, "{:.1e}", largest(&unbalanced));
    let mut residual = vec![0.0; data.len()];
    let potential = model.potential(1.0, &[]);
    let stored = Assembly::residual(&*potential, &state.displacement, &mut residual).unwrap();
    assert!((computed.state.convergence.energy / stored - 1.0).abs() < 1e-8);
    assert_eq!(potential.unknowns(), data.len());
}

#[test]
fn no_more_steps_are_taken_than_allowed() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let plate = plate_corrector(&problem, &springs.mesh);
    let conditions = plate.conditions(STRETCH, KnownConditions::ALL);
    let settings = CorrectorSettings {
        max_steps: 1,
        ..SETTINGS
    };
    let data = &uncorrected.displacement;
    let corrector = Corrector::new(conditions, vec![1.0; data.len()], settings);
    let fault = corrector.correct(data, data).map(|_| ()).unwrap_err();
    assert!(
        matches!(fault, SolveFault::Stalled { iterations: 1, .. }),
        "{fault}"
    );
}
