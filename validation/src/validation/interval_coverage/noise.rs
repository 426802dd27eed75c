//! Noise of markers that correlates over some of their spacings.

use nalgebra::{DMatrix, DVector};

use crate::markers::Marker;
use crate::statistics::nearest;
use crate::validation::case::{mean, normal_numbers_of_stream};

/// What makes noise of white numbers.
pub struct CorrelatedDraws {
    /// The root of e^(−d/ℓ) of all pairs; nothing where the noise is white.
    root: Option<DMatrix<f64>>,
}

impl CorrelatedDraws {
    /// Noise at places that correlates as e^(−d/ℓ), ℓ so many times the mean spacing of the places.
    pub fn new(positions: &[[f64; 2]], length: Option<f64>) -> Self {
        let distance = |i: usize, j: usize| {
            let [a, b]: [[f64; 2]; 2] = [positions[i], positions[j]];
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        let nearest = nearest(positions, 1).into_iter().enumerate();
        let spacing = mean(nearest.map(|(i, others)| distance(i, others[0])));
        let root = length.and_then(|length| {
            let correlation = |i: usize, j: usize| (-distance(i, j) / (length * spacing)).exp();
            let all = DMatrix::from_fn(positions.len(), positions.len(), correlation);
            all.cholesky().map(|factor| factor.unpack())
        });
        Self { root }
    }

    /// Adds noise of a standard deviation in mm to both components.
    pub fn disturb(&self, markers: &mut [Marker], noise: f64, seed: u64) {
        for axis in [0, 1] {
            let draws = normal_numbers_of_stream(seed, 1 + axis as u64).take(markers.len());
            let white = DVector::from_iterator(markers.len(), draws);
            let values = match &self.root {
                Some(root) => root * white,
                None => white,
            };
            for (marker, value) in markers.iter_mut().zip(values.iter()) {
                marker.displacement[axis] += noise * value;
            }
        }
    }
}
