//! Noise that is not the same everywhere, and corners at which fields are singular.

use super::*;
use crate::markers::Marker;
use crate::mesh::{CellShape, Mesh};
use crate::problem::{BoundaryProblem, Load};
use crate::statistics::extremes;

/// 31 × 16 positions, the outermost on the edges.
fn grid() -> Vec<[f64; 2]> {
    let positions =
        (0..31).flat_map(|i| (0..16).map(move |j| [2.0 * f64::from(i), 2.0 * f64::from(j)]));
    positions.collect()
}

/// Markers of a field with noise whose size depends on the position and the component.
fn markers(
    field: &dyn Fn([f64; 2]) -> [f64; 2],
    size: &dyn Fn([f64; 2]) -> [f64; 2],
    seed: u64,
) -> Vec<Marker> {
    let mut all = noisy(&grid(), &|_| [0.0; 2], 1.0, seed);
    for Marker {
        position,
        displacement,
        ..
    } in &mut all
    {
        let (u, size) = (field(*position), size(*position));
        *displacement = [0, 1].map(|axis| u[axis] + size[axis] * displacement[axis]);
    }
    all
}

/// The noise of image correlation whose subsets extend past the edge, of an inclined camera, of ultrasound.
#[test]
fn uneven_noise_is_neither_laid_to_grips_and_edges_nor_left_out_of_intervals() {
    let (truth, mesh) = (Truth::new(), estimate_mesh());
    let outwards = |[x, _]: [f64; 2]| [0.02 * (1.0 + 3.0 * (x / 30.0 - 1.0).powi(2)); 2];
    let along = |[x, _]: [f64; 2]| [0.02 * (1.0 + 4.0 * x / SIZE[0]); 2];
    let margin = |[_, y]: [f64; 2]| {
        if y == 0.0 || y == SIZE[1] {
            [0.06; 2]
        } else {
            [0.02; 2]
        }
    };
    let aslant = |_: [f64; 2]| [0.1, 0.02];
    let sizes: [&dyn Fn([f64; 2]) -> [f64; 2]; 4] = [&outwards, &along, &margin, &aslant];
    let (mut held, mut explained) = (0, 0);
    for size in sizes {
        for seed in 0..4 {
            let markers = markers(&|position| truth.at(position), size, seed);
            let knowledge = with_grips(EdgeCondition::Rigid);
            let result = estimate_on(&mesh, &markers, &knowledge);
            explained += usize::from(result.verdict.answer != Answer::NotExplained);
            let [low, high] = result.forces[right(&result)].force[0].interval;
            held += usize::from(low < truth.force && truth.force < high);
            let [least, most] = extremes(result.noise_range.expect("uneven").into_iter().flatten());
            assert!(most > 2.0 * least, "{least} {most}");
        }
    }
    assert!(
        explained >= 15 && held >= 13,
        "{explained} and {held} of 16"
    );
}

/// A sheet clamped at three sides and pulled at the fourth by a traction; no condition is stated. The displacement is singular at the corners
/// between, and the force is that of the traction.
#[test]
fn forces_of_unknown_edges_that_meet_in_singular_corners_are_in_their_intervals() {
    let traction = [0.05, 0.01];
    let clamp = |name: &str| (name.to_owned(), Support::Displacement([Some(0.0); 2]));
    let problem = BoundaryProblem {
        loads: vec![("right".into(), Load::Traction(traction))],
        ..sheet(["left", "bottom", "top"].map(clamp).to_vec())
    };
    let fine = Mesh::plate(SIZE, [52, 28], CellShape::Quad9);
    let energy = problem.finite_elements(&fine);
    let model = problem.on(&fine, &energy).unwrap();
    let states = model.solve(&[0.5, 1.0], NewtonSettings::default(), &|_| ());
    let field = &states.unwrap()[1].displacement;
    // Cells as large as the markers are apart, as those that are made.
    let mesh = Mesh::plate(SIZE, [30, 15], CellShape::Quad9);
    let knowledge = Knowledge {
        unnamed: Unnamed::Loaded,
        edges: ["left", "bottom", "right", "top"]
            .map(|name| (name.to_owned(), EdgeCondition::Unknown))
            .to_vec(),
        ..Knowledge::default()
    };
    for seed in 0..4 {
        let at = |position| fine.displacement_at(field, position);
        let markers = markers(&at, &|_| [0.01; 2], seed);
        let result = estimate_on(&mesh, &markers, &knowledge);
        for (axis, component) in result.forces[right(&result)].force.iter().enumerate() {
            let exact = traction[axis] * SIZE[1] * THICKNESS;
            let [low, high] = component.interval;
            assert!(low < exact && exact < high, "{seed}: {component:?} {exact}");
            assert!(
                component.standard_error < 0.1 * traction[0] * SIZE[1] * THICKNESS,
                "{component:?}"
            );
        }
    }
}
