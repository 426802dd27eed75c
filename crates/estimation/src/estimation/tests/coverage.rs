//! Whether standard errors and levels are what they claim to be, over seeds of noise.
//!
//! Bounds are those of χ², the normal or Poisson's distribution at some four standard deviations: what is tested holds by
//! far on sound code, and fails where an error is a fifth too small.

use rayon::prelude::*;

use super::{SIZE, STRETCH, THICKNESS, Truth, estimate_on, grid, law, noisy, right, with_grips};
use crate::estimation::*;
use crate::material::sheet::{Kinematics, PlaneTensor};
use crate::mesh::{CellShape, Mesh};

const SEEDS: u64 = 40;

/// Estimates of markers with noise on a mesh whose discretisation error is far below it.
fn estimates(truth: &Truth, knowledge: &Knowledge, noise: f64) -> (Mesh, Vec<FieldEstimate>) {
    let mesh = Mesh::plate(SIZE, [10, 6], CellShape::Quad9);
    let one = |seed| {
        let markers = truth.markers(noise, 100 + seed);
        estimate_on(&mesh, &markers, knowledge)
    };
    let all = (0..SEEDS).into_par_iter().map(one).collect();
    (mesh, all)
}

#[test]
fn standard_errors_are_the_scatter_over_seeds() {
    let truth = Truth::new();
    let (mesh, all) = estimates(&truth, &with_grips(EdgeCondition::Rigid), 0.5);
    let exact: Vec<f64> = mesh.nodes.iter().flat_map(|node| truth.at(*node)).collect();
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
    // Six parameters of the grips for each seed: the mean of z² has a standard deviation of about 0.1.
    let displacement = mean(
        all.iter()
            .flat_map(|result| {
                let pairs = result
                    .displacement
                    .iter()
                    .zip(&exact)
                    .zip(&result.displacement_error);
                pairs.map(|((u, exact), error)| ((u - exact) / error).powi(2))
            })
            .collect(),
    );
    assert!((displacement - 1.0).abs() < 0.33, "{displacement}");
    let force = |result: &FieldEstimate| result.forces[right(result)].force[0];
    // One force for each seed: √(2/40) = 0.22.
    let square = mean(
        all.iter()
            .map(|result| {
                let force = force(result);
                ((force.value - truth.force) / force.standard_error).powi(2)
            })
            .collect(),
    );
    assert!(square > 0.4 && square < 1.9, "{square}");
    for result in &all {
        let force = force(result);
        let [low, high] = force.interval;
        let half = result.reach * force.standard_error;
        assert!(
            (high - force.value - half).abs() < 1e-12 && (force.value - low - half).abs() < 1e-12
        );
        assert!(result.reach > 1.95 && result.reach < 1.98);
        assert!(result.contradiction.is_none(), "{:?}", result.contradiction);
    }
    let held = all.iter().filter(|result| {
        let [low, high] = force(result).interval;
        (low..high).contains(&truth.force)
    });
    let held = held.count();
    assert!(held >= 34, "{held} of 40 intervals of the force hold it");
    // One of a thousand sound markers is taken for an outlier: 9.2 of 9240.
    let outliers = all
        .iter()
        .flat_map(|result| result.markers.iter().flatten());
    let outliers = outliers.filter(|marker| marker.outlier).count();
    assert!((1..=22).contains(&outliers), "{outliers}");
}

#[test]
fn without_noise_the_intervals_hold_the_truth() {
    let truth = Truth::on(Mesh::of_grid(
        crate::mesh::Grid::new(SIZE, [48, 28], 3.0),
        CellShape::Quad9,
    ));
    let markers = truth.markers(0.0, 1);
    let mesh = Mesh::plate(SIZE, [14, 7], CellShape::Quad9);
    let result = estimate_on(&mesh, &markers, &with_grips(EdgeCondition::Rigid));
    assert!(result.contradiction.is_none(), "{:?}", result.contradiction);
    for edge in &result.forces {
        let wanted = match edge.edge.as_str() {
            "right" => truth.force,
            _ => -truth.force,
        };
        let [low, high] = edge.force[0].interval;
        assert!(
            low < wanted && wanted < high && high - low < 0.05 * truth.force,
            "{wanted} {low} {high}"
        );
    }
    let exact = mesh.nodes.iter().flat_map(|node| truth.at(*node));
    let pairs = exact
        .zip(&result.displacement)
        .zip(&result.displacement_error);
    let inside = pairs.filter(|((exact, u), error)| (exact - *u).abs() <= result.reach * **error);
    let cover = inside.count() as f64 / result.displacement.len() as f64;
    assert!(cover > 0.85, "{cover} of the displacements");
    let cover = stress_cover(&truth, &mesh, &result);
    assert!(cover > 0.9, "{cover} of the stresses");
}

/// The share of stresses in the middle of cells, farther than a fifth of the width from the corners, within their intervals.
fn stress_cover(truth: &Truth, mesh: &Mesh, result: &FieldEstimate) -> f64 {
    let (mut inside, mut count) = (0.0, 0.0);
    for (cell, stress) in result.cells.iter().enumerate() {
        let position = mesh.position(cell, mesh.shape(cell).centre());
        let near = |x: f64, y: f64| (position[0] - x).hypot(position[1] - y) < 0.2 * SIZE[1];
        if [0.0, SIZE[0]]
            .iter()
            .any(|x| near(*x, 0.0) || near(*x, SIZE[1]))
        {
            continue;
        }
        let exact = truth.stress(position);
        let computed = stress.first_piola_kirchhoff_stress.iter();
        for ((exact, computed), error) in exact.iter().zip(computed).zip(&stress.stress_error) {
            let within = (exact - computed).abs() <= result.reach * error;
            inside += f64::from(u8::from(within));
            count += 1.0;
        }
    }
    inside / count
}

#[test]
fn an_edge_is_free_only_where_noise_could_have_made_the_misfit() {
    let truth = Truth::new();
    let mesh = Mesh::plate(SIZE, [10, 6], CellShape::Quad9);
    let knowledge = Knowledge {
        edges: vec![("right".to_owned(), EdgeCondition::Unknown)],
        ..Knowledge::default()
    };
    let mut weak = 0;
    for (seed, share) in [(0, 0.4), (1, 0.6), (2, 0.8), (3, 1.0), (4, 1.3), (5, 1.6)] {
        let markers = truth.markers(share * STRETCH * SIZE[0], seed);
        let result = estimate_on(&mesh, &markers, &knowledge);
        for edge in &result.edges {
            let Some(probability) = edge.probability else {
                continue;
            };
            let is_free = edge.condition == EdgeCondition::Free;
            // One in a hundred, shared by three edges.
            assert_eq!(is_free, probability >= 0.01 / 3.0, "{edge:?}");
            weak += usize::from(!is_free && probability > 1e-11);
        }
    }
    assert!(weak > 0, "no edge was refused by a small probability");
}

#[test]
fn noise_that_correlates_between_neighbours_is_not_white() {
    let truth = Truth::new();
    let mesh = Mesh::plate(SIZE, [10, 6], CellShape::Quad9);
    let mut markers = truth.markers(0.2, 5);
    let wave = |[x, y]: [f64; 2]| 0.3 * (x / 5.0).sin() * (y / 5.0).cos();
    for marker in &mut markers {
        let wave = wave(marker.position);
        marker.displacement = marker.displacement.map(|u| u + wave);
    }
    let result = estimate_on(&mesh, &markers, &with_grips(EdgeCondition::Rigid));
    assert_ne!(result.verdict.answer, Answer::Explained);
}

/// The edges of a sheet that hardly carries a force cannot be distinguished from free ones; one loaded edge alone would exclude every force.
#[test]
fn forces_too_small_to_be_seen_have_intervals_that_hold_them() {
    let mesh = Mesh::plate(SIZE, [10, 6], CellShape::Quad9);
    let mut knowledge = with_grips(EdgeCondition::Free);
    knowledge
        .edges
        .retain(|(name, _)| ["bottom", "top"].contains(&&**name));
    for strain in [1e-4_f64, 3e-4] {
        let slopes = [strain, (1.0 + strain).powf(-0.5) - 1.0];
        let gradient = PlaneTensor::from([slopes[0], 0.0, 0.0, slopes[1]]);
        let stress = law().stress(&Kinematics::new(&gradient).unwrap()).1[0];
        let force = stress * THICKNESS * SIZE[1];
        let field = |[x, y]: [f64; 2]| [slopes[0] * x, slopes[1] * y];
        let holds = (0..SEEDS).into_par_iter().filter(|seed| {
            let markers = noisy(&grid(), &field, 0.02, 900 + seed);
            let result = estimate_on(&mesh, &markers, &knowledge);
            let forces = result.forces.iter().map(|edge| edge.force[0].interval);
            let right = |[low, high]: [f64; 2]| low <= force && force <= high;
            let mirrored = |[low, high]: [f64; 2]| low <= -force && -force <= high;
            let all: Vec<[f64; 2]> = forces.collect();
            all.is_empty()
                || all.iter().any(|one| right(*one)) && all.iter().any(|one| mirrored(*one))
        });
        let share = holds.count() as f64 / SEEDS as f64;
        assert!(share > 0.85, "{strain}: {share}");
    }
}
