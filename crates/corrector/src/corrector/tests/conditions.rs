//! Each kind of condition: its rows, its Jacobian, its curvature, and that it is met.

use super::*;
use crate::mesh::{Mesh, Side};
use crate::solve::Assembly;
use crate::solve::vector::moved;

/// The nodes of the boundary of a plate, counter-clockwise, up to the sixth on the left side from above.
fn boundary(mesh: &Mesh) -> Vec<(usize, [f64; 2])> {
    let on = |side| -> Vec<usize> {
        let nodes = 0..mesh.nodes.len();
        nodes.filter(|node| mesh.on(side, *node)).collect()
    };
    let mut line = on(Side::Bottom);
    line.extend(on(Side::Right).into_iter().skip(1));
    line.extend(on(Side::Top).into_iter().rev().skip(1));
    line.extend(on(Side::Left).into_iter().rev().skip(1).take(5));
    line.into_iter()
        .map(|node| (node, mesh.nodes[node]))
        .collect()
}

/// One condition of each kind, with a little more area and force than a field has.
fn every_kind<'a>(
    plate: &'a PlateCorrector,
    assembly: &'a Assembly,
    mesh: &Mesh,
    state: &State,
) -> Vec<Box<dyn Condition + 'a>> {
    let (u, size, energy) = (
        &state.displacement,
        state.displacement.len(),
        plate.energy(),
    );
    let edge = |side| -> Vec<usize> {
        let nodes = (0..mesh.nodes.len()).filter(|node| mesh.on(side, *node));
        nodes.map(|node| 2 * node).collect()
    };
    let [left, right] = [Side::Left, Side::Right].map(edge);
    let line = boundary(mesh);
    let enclosed = EnclosedArea::new("area", line.clone(), 0.0)
        .values(u)
        .unwrap()[0];
    let force = 1.01 * crate::problem::Measures::of(mesh, state).force;
    let inner = (0..mesh.nodes.len()).filter(|node| !mesh.on_grip(*node));
    let inner: Vec<usize> = inner.flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let loads: Vec<f64> = noise(inner.len()).iter().map(|n| 1e-3 * n).collect();
    let held = left.into_iter().map(|i| (i, 0.0));
    vec![
        Box::new(Equilibrium::new("loaded", energy, assembly, inner).with_loads(loads)),
        Box::new(Linear::prescribed("left", size, held)),
        Box::new(Linear::together(
            "rigid grip",
            size,
            std::slice::from_ref(&right),
        )),
        Box::new(TotalForce::new("force", energy, assembly, right, force)),
        Box::new(EnclosedArea::new("area", line, 1.01 * enclosed)),
        Box::new(Linear::new("none", SparseRows::new(size), Vec::new())),
    ]
}

#[test]
fn every_kind_of_condition_is_met_and_has_the_right_jacobian() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let plate = plate_corrector(&problem, &springs.mesh);
    let size = uncorrected.displacement.len();
    let u = &uncorrected.displacement;
    let assembly = Assembly::new(plate.energy(), &vec![false; size]);
    let conditions = every_kind(&plate, &assembly, &springs.mesh, &uncorrected);
    let direction = noise(size);
    for condition in &conditions {
        let jacobian = condition.linearise(u).unwrap().jacobian;
        assert_eq!(jacobian.len(), condition.rows(), "{}", condition.name());
        let at = |step: f64| condition.values(&moved(u, step, &direction)).unwrap();
        let slope: Vec<f64> = difference(&at(1e-5), &at(-1e-5))
            .iter()
            .map(|d| d / 2e-5)
            .collect();
        let error = largest_difference(&slope, &jacobian.multiply(&direction));
        assert!(
            error < 1e-5 * largest(&slope).max(1.0),
            "{}: {error:.1e}",
            condition.name()
        );
    }
    let corrector = Corrector::new(conditions, vec![1.0; size], SETTINGS);
    let corrected = corrector.correct(u, u).unwrap();
    assert!(largest(&corrector.values(corrected.field()).unwrap()) < 1e-7);
}

#[test]
fn a_corrected_field_passes_through_measured_points() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let corrector = plate_corrector(&problem, &springs.mesh);
    let mut conditions = corrector.conditions(STRETCH, FREE_GRIPS);
    let points = [([7.3, 4.1], [3.5, 0.6]), ([22.0, 12.9], [11.1, -0.2])];
    conditions.push(Box::new(plate::measured_points(
        "markers",
        &springs.mesh,
        &points,
    )));
    let data = &uncorrected.displacement;
    let corrector = Corrector::new(conditions, vec![1.0; data.len()], SETTINGS);
    let corrected = corrector.correct(data, data).unwrap();
    for (place, expected) in points {
        let found = springs.mesh.displacement_at(corrected.field(), place);
        assert!(largest_difference(&found, &expected) < 1e-9, "{found:?}");
    }
}

/// The curvature Σ ψᵢ ∂²cᵢ/∂u∂u times a direction is the change of Bᵀ ψ along it.
pub fn curvature_error(condition: &dyn Condition, u: &[f64], psi: &[f64]) -> f64 {
    let direction = noise(u.len());
    let pull = |step: f64| {
        let linear = condition.linearise(&moved(u, step, &direction)).unwrap();
        linear.jacobian.multiply_transposed(psi)
    };
    // Near rest the energy of a tension curve has terms of ε² |ε|, which a short step leaves out.
    let step = if largest(u) > 0.0 { 1e-4 } else { 1e-6 };
    let slope = difference(&pull(step), &pull(-step));
    let slope: Vec<f64> = slope.iter().map(|d| d / (2.0 * step)).collect();
    let curvature = condition
        .curvature(u, psi)
        .unwrap()
        .expect("a curved condition");
    largest_difference(&curvature.multiply(&direction), &slope) / largest(&slope)
}

#[test]
fn curvatures_are_derivatives_of_the_jacobians() {
    let problem = problem();
    let (springs, uncorrected) = lattice(&problem);
    let plate = plate_corrector(&problem, &springs.mesh);
    let u = &uncorrected.displacement;
    let assembly = Assembly::new(plate.energy(), &vec![false; u.len()]);
    let corners = [0, 63, 69, 6].map(|node| (node, springs.mesh.nodes[node]));
    let force: Vec<usize> = (0..u.len()).rev().step_by(2).take(7).collect();
    let conditions: Vec<Box<dyn Condition>> = vec![
        Box::new(Equilibrium::new(
            "inside",
            plate.energy(),
            &assembly,
            (20..90).collect(),
        )),
        Box::new(TotalForce::new(
            "force",
            plate.energy(),
            &assembly,
            force,
            1.0,
        )),
        Box::new(EnclosedArea::new("area", corners.to_vec(), 600.0)),
    ];
    let rest = vec![0.0; u.len()];
    for (condition, field) in conditions.iter().flat_map(|own| [(own, u), (own, &rest)]) {
        let error = curvature_error(&**condition, field, &noise(condition.rows()));
        assert!(error < 1e-5, "{}: {error:.1e}", condition.name());
    }
}
