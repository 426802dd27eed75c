//! Each kind of condition: its rows, its Jacobian, its curvature, and that it is met.

use super::*;
use crate::mesh::{Mesh, Side};
use crate::solve::Assembly;
use crate::solve::vector::moved;

/// One condition of each kind.
fn every_kind<'a>(
    plate: &'a PlateCorrector,
    assembly: &'a Assembly,
    mesh: &Mesh,
    state: &State,
) -> Vec<Box<dyn Condition + 'a>> {
    let (size, energy) = (state.displacement.len(), plate.energy());
    let edge = |side| -> Vec<usize> {
        let nodes = (0..mesh.nodes.len()).filter(|node| mesh.on(side, *node));
        nodes.map(|node| 2 * node).collect()
    };
    let [left, right] = [Side::Left, Side::Right].map(edge);
    let inner = (0..mesh.nodes.len()).filter(|node| !mesh.on_grip(*node));
    let inner: Vec<usize> = inner.flat_map(|node| [2 * node, 2 * node + 1]).collect();
    let held = left.into_iter().map(|i| (i, 0.0));
    vec![
        Box::new(Equilibrium::new("balance", energy, assembly, inner)),
        Box::new(Linear::prescribed("left", size, held)),
        Box::new(Linear::together(
            "rigid grip",
            size,
            std::slice::from_ref(&right),
        )),
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
    let conditions: Vec<Box<dyn Condition>> = vec![Box::new(Equilibrium::new(
        "inside",
        plate.energy(),
        &assembly,
        (20..90).collect(),
    ))];
    let rest = vec![0.0; u.len()];
    for (condition, field) in conditions
        .iter()
        .flat_map(|condition| [(condition, u), (condition, &rest)])
    {
        let error = curvature_error(&**condition, field, &noise(condition.rows()));
        assert!(error < 1e-5, "{}: {error:.1e}", condition.name());
    }
}
