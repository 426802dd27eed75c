use std::sync::Arc;

use super::*;
use crate::error::Error;
use crate::material::{Card, HyperelasticLaw};
use crate::problem::Support;
use crate::solve::NewtonSettings;

mod coverage;
mod pads;
mod positions;
mod truth;
mod uneven;
mod verdicts;

use truth::{C10, THICKNESS, estimate_mesh, noisy, sheet};
pub(super) use truth::{
    SIZE, STRETCH, Truth, estimate_on, grid, law, measured_force, rectangle, right, solved,
    specimen, with_grips,
};

#[test]
fn noise_on_unknown_and_rigid_grips_falls_by_four_fifths() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let markers = truth.markers(0.3, 1);
    for (condition, most) in [(EdgeCondition::Unknown, 0.06), (EdgeCondition::Rigid, 0.05)] {
        let result = estimate_on(&mesh, &markers, &with_grips(condition));
        let error = truth.error(&mesh, &result.displacement);
        assert!(error < most, "{condition:?}: {error}");
        assert!((result.noise / 0.3 - 1.0).abs() < 0.1, "{}", result.noise);
        let force = &result.forces[right(&result)].force[0];
        let wrong = (force.value - truth.force).abs();
        assert!(
            wrong < 3.0 * force.standard_error && wrong < 0.05 * truth.force,
            "{force:?}"
        );
    }
}

#[test]
fn known_grips_leave_the_markers_to_be_judged() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let mut knowledge = with_grips(EdgeCondition::Known([Some(0.0), Some(0.0)]));
    knowledge.edges[1].1 = EdgeCondition::Known([Some(STRETCH * SIZE[0]), Some(0.0)]);
    knowledge.noise = Some(0.3);
    let result = estimate_on(&mesh, &truth.markers(0.3, 1), &knowledge);
    assert!(truth.error(&mesh, &result.displacement) < 2e-3);
    assert!(
        result.known_noise
            && (result.noise - 0.3).abs() < 1e-12
            && result.effective_parameters == 0.0
    );
    let far = result
        .markers
        .iter()
        .flatten()
        .filter(|marker| marker.standardised_residual > 2.4477);
    let share = far.count() as f64 / result.markers.len() as f64;
    assert!((share - 0.05).abs() < 0.03, "{share}");
}

#[test]
fn multipliers_are_derivatives_of_the_misfit_by_forces() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let markers = truth.markers(0.3, 4);
    let mut knowledge = with_grips(EdgeCondition::Known([Some(0.0), Some(0.0)]));
    knowledge.edges[1].1 = EdgeCondition::Known([Some(STRETCH * SIZE[0]), Some(0.0)]);
    let result = estimate_on(&mesh, &markers, &knowledge);
    let node = mesh
        .nodes
        .iter()
        .position(|node| *node == [30.0, 15.0])
        .unwrap();
    let misfit = |force: f64| {
        let held = |x: f64| Support::Displacement([Some(x), Some(0.0)]);
        let problem = sheet(vec![
            ("left".into(), held(0.0)),
            ("right".into(), held(STRETCH * SIZE[0])),
        ]);
        let energy = problem.finite_elements(&mesh);
        let mut forces = vec![0.0; 2 * mesh.nodes.len()];
        forces[2 * node] = force;
        let mut discretised = problem.on(&mesh, &energy).unwrap();
        discretised.add_forces(&forces);
        let newton = NewtonSettings {
            tolerance: 1e-12,
            max_iterations: 30,
        };
        let state = discretised
            .solve(&[1.0], newton, &|_| ())
            .unwrap()
            .remove(0);
        let square = |marker: &Marker| {
            let computed = mesh.displacement_at(&state.displacement, marker.position);
            let [x, y] = [0, 1].map(|axis| computed[axis] - marker.displacement[axis]);
            0.5 * (x * x + y * y)
        };
        markers.iter().map(square).sum::<f64>()
    };
    let slope = (misfit(1e-3) - misfit(-1e-3)) / 2e-3;
    let multiplier = result.multipliers[2 * node];
    assert!(
        (slope + multiplier).abs() < 1e-4 * slope.abs(),
        "{slope} {multiplier}"
    );
}

#[test]
fn without_noise_the_truth_comes_back() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let grips = with_grips(EdgeCondition::Rigid);
    let result = estimate_on(&mesh, &truth.markers(0.0, 1), &grips);
    assert!(truth.error(&mesh, &result.displacement) < 2e-3);
    assert!(result.noise < 2e-3);
}

#[test]
fn wrong_input_is_refused() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let good = truth.markers(0.1, 1);
    let message = |markers: &[Marker], knowledge: &Knowledge| match estimate(
        &specimen(&mesh),
        markers,
        knowledge,
    ) {
        Err(fault @ Error::Input(_)) => fault.to_string(),
        other => panic!("{:?}", other.map(|_| ())),
    };
    let grips = with_grips(EdgeCondition::Unknown);
    let change = |change: &dyn Fn(&mut Marker)| {
        let mut markers = good.clone();
        change(&mut markers[7]);
        markers
    };
    let nan = change(&|marker| marker.displacement[1] = f64::NAN);
    assert!(message(&nan, &grips).contains("marker 7"));
    let one = change(&|marker| marker.standard_deviation = Some(0.1));
    assert!(message(&one, &grips).contains("1 of 231 markers"));
    let far: Vec<Marker> = good
        .iter()
        .map(|marker| Marker {
            position: marker.position.map(|x| x + 1000.0),
            ..*marker
        })
        .collect();
    assert!(message(&far, &grips).contains("0 of 231 markers lie on the mesh"));
    assert!(
        message(&good, &with_grips(EdgeCondition::Free)).contains("the specimen is not loaded")
    );
    assert!(message(&good[..2], &grips).contains("2 of 2"));
    let line: Vec<Marker> = good
        .iter()
        .filter(|marker| marker.position[1] == 0.0)
        .copied()
        .collect();
    assert!(message(&line, &grips).contains("affine"));
}

/// A strip whose sides are not named: the long ones are free, the short ones are pulled.
#[test]
fn the_data_decide_which_edges_are_free() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    for noise in [0.02, 0.3] {
        let markers = truth.markers(noise, 3);
        let result = estimate_on(&mesh, &markers, &Knowledge::default());
        let condition = |name: &str| {
            let edge = result
                .edges
                .iter()
                .find(|edge| edge.edge.starts_with(name))
                .unwrap();
            (edge.condition, edge.probability)
        };
        for free in ["bottom", "top"] {
            assert_eq!(
                condition(free).0,
                EdgeCondition::Free,
                "{noise} {:?}",
                result.edges
            );
        }
        for loaded in ["right", "left"] {
            let (condition, probability) = condition(loaded);
            assert_eq!(condition, EdgeCondition::Unknown);
            assert!(probability.unwrap() < 1e-6);
        }
        assert!(truth.error(&mesh, &result.displacement) < 0.2 * noise);
        let loaded = Knowledge {
            unnamed: Unnamed::Loaded,
            ..Knowledge::default()
        };
        let inside = estimate_on(&mesh, &markers, &loaded);
        assert!(
            inside
                .edges
                .iter()
                .all(|edge| edge.condition == EdgeCondition::Unknown)
        );
        assert!(truth.error(&mesh, &inside.displacement) < 0.5 * noise);
    }
}

#[test]
fn a_modulus_is_found_with_the_field() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let card = Card::load("neo-hooke", std::path::Path::new(".")).unwrap();
    let knowledge = Knowledge {
        forces: vec![measured_force(truth.force * 1.01, truth.force * 0.01)],
        law: Some(RegressedLaw::of_card(&card, &["c10"]).unwrap()),
        ..with_grips(EdgeCondition::Unknown)
    };
    let result = estimate_on(&mesh, &truth.markers(0.3, 5), &knowledge);
    let (key, unit, modulus) = &result.parameters[0];
    assert_eq!([&**key, &**unit], ["c10", "MPa"]);
    assert!(modulus.standard_error > 0.008 * C10 && modulus.standard_error < 0.03 * C10);
    assert!(
        (modulus.value - C10).abs() < 3.0 * modulus.standard_error,
        "{modulus:?}"
    );
    let without = Knowledge {
        forces: Vec::new(),
        ..knowledge
    };
    let message = estimate(&specimen(&mesh), &truth.markers(0.3, 5), &without).unwrap_err();
    assert!(message.to_string().contains("without a measured force"));
}

#[test]
fn gross_errors_are_found() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let mut markers = truth.markers(0.3, 9);
    let wrong = |index: &usize| index % 20 == 3;
    let count = markers.len();
    for index in (0..count).filter(wrong) {
        markers[index].displacement[index / 20 % 2] += 2.4 + 0.05 * index as f64;
    }
    for robust in [Robust::Huber, Robust::Tukey] {
        let knowledge = Knowledge {
            robust,
            ..with_grips(EdgeCondition::Unknown)
        };
        let result = estimate_on(&mesh, &markers, &knowledge);
        for (index, marker) in result.markers.iter().enumerate() {
            let marker = marker.unwrap();
            let alarm = marker.outlier && !wrong(&index);
            assert!(
                !alarm && (marker.outlier || !wrong(&index)),
                "{robust:?} {index} {marker:?}"
            );
        }
        assert!(truth.error(&mesh, &result.displacement) < 0.08);
        assert!((result.noise / 0.3 - 1.0).abs() < 0.12, "{}", result.noise);
    }
    let plain = estimate_on(&mesh, &markers, &with_grips(EdgeCondition::Unknown));
    assert!(truth.error(&mesh, &plain.displacement) > 0.1);
}

#[test]
fn forces_on_the_interior_make_up_for_a_wrong_law_and_vanish_with_the_right_one() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let markers = truth.markers(0.02, 2);
    let pva = Card::load("pva-10", std::path::Path::new(".")).unwrap();
    let run = |law: Arc<dyn HyperelasticLaw>, physics: Physics| {
        let wrong = Specimen {
            laws: law.into(),
            ..specimen(&mesh)
        };
        let knowledge = Knowledge {
            physics,
            ..with_grips(EdgeCondition::Rigid)
        };
        let result = estimate(&wrong, &markers, &knowledge).unwrap();
        (truth.error(&mesh, &result.displacement), result)
    };
    let (exact, plain) = run(Arc::clone(&pva.law), Physics::Exact);
    let (weighted, forced) = run(Arc::clone(&pva.law), Physics::Weighted);
    assert!(weighted < 0.5 * exact, "{weighted} {exact}");
    let noises = (plain.noise, forced.noise);
    assert!(
        plain.noise > 1.02 * forced.noise && (forced.noise / 0.02 - 1.0).abs() < 0.15,
        "{noises:?}"
    );
    let (exact, _) = run(law(), Physics::Exact);
    let (weighted, right) = run(law(), Physics::Weighted);
    assert!(weighted < 1.5 * exact, "{weighted} {exact}");
    let size = |result: &FieldEstimate| {
        result
            .interior_forces
            .iter()
            .map(|f| f * f)
            .sum::<f64>()
            .sqrt()
    };
    assert!(
        size(&right) < 0.05 * size(&forced),
        "{} {}",
        size(&right),
        size(&forced)
    );
}
