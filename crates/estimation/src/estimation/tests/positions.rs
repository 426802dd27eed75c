//! Intervals at each position: the mean coverage over a specimen does not show where they are too narrow.

use super::*;
use crate::mesh::{CellShape, Mesh, Shape};

const WHOLE: [f64; 2] = [100.0, 60.0];
const WINDOW: [f64; 2] = [40.0, 36.0];
const SPACING: f64 = 1.5;
const NOISE: f64 = 0.05;
const SEEDS: u64 = 6;

fn strip(size: [f64; 2], across: usize) -> Mesh {
    let radius = 5.0;
    Shape::StripWithHole { size, radius }.mesh(across, CellShape::Quad9)
}

/// A position of the window around the hole in the coordinates of the complete strip.
fn in_strip(position: [f64; 2]) -> [f64; 2] {
    [position[0] + 0.5 * (WHOLE[0] - WINDOW[0]), position[1]]
}

/// Markers half a spacing inside of the window.
fn positions(window: &Mesh) -> Vec<[f64; 2]> {
    let counts = WINDOW.map(|side| (side / SPACING).round());
    let at = |axis: usize, index: f64| (index + 0.5) / counts[axis] * WINDOW[axis];
    let grid = (0..counts[0] as u32).flat_map(|i| (0..counts[1] as u32).map(move |j| [i, j]));
    grid.map(|[i, j]| [at(0, i.into()), at(1, j.into()) - 0.5 * WINDOW[1]])
        .filter(|position| window.outside(*position) < 1e-6)
        .collect()
}

/// The edges of a window in a sheet, of which nothing is known, bend most where the hole is near.
#[test]
fn few_stresses_of_a_window_are_twice_as_far_off_as_stated() {
    let (complete, window) = (Truth::on(strip(WHOLE, 24)), strip(WINDOW, 12));
    let exact = |cell: usize| -> [f64; 4] {
        complete.stress(in_strip(window.position(cell, window.shape(cell).centre())))
    };
    let knowledge = Knowledge {
        unnamed: Unnamed::Loaded,
        ..Knowledge::default()
    };
    let positions = positions(&window);
    let mut squares = vec![[[0.0; 2]; 4]; window.cell_count()];
    for seed in 0..SEEDS {
        let markers = noisy(
            &positions,
            &|position| complete.at(in_strip(position)),
            NOISE,
            seed,
        );
        let result = estimate_on(&window, &markers, &knowledge);
        for (cell, (stress, sums)) in result.cells.iter().zip(&mut squares).enumerate() {
            let exact = exact(cell);
            for (component, sum) in sums.iter_mut().enumerate() {
                let off = stress.first_piola_kirchhoff_stress[component] - exact[component];
                sum[0] += off * off;
                sum[1] += stress.stress_error[component].powi(2);
            }
        }
    }
    let ratio = |[error, stated]: [f64; 2]| (error / stated).sqrt();
    let far = squares.iter().flatten().filter(|sums| ratio(**sums) > 2.0);
    let share = far.count() as f64 / (4 * squares.len()) as f64;
    assert!(share < 0.012, "{share}");
}
