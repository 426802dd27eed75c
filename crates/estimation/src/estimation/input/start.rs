//! The start of the estimate: a polynomial through the markers that gross errors do not affect.

use nalgebra::{DMatrix, DVector};
use rand::seq::index::sample;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::statistics::{extremes, robust_deviation};

/// The largest degree.
pub const DEGREE: usize = 3;

/// A displacement field of two polynomials of one total degree.
#[derive(Clone, Debug)]
pub struct Polynomial {
    centre: [f64; 2],
    size: f64,
    degree: usize,
    coefficients: DMatrix<f64>,
}

/// Places and displacements of markers in mm.
pub struct Points<'a> {
    /// Places.
    pub places: &'a [[f64; 2]],
    /// Displacements.
    pub displacements: &'a [[f64; 2]],
}

impl Polynomial {
    /// The polynomial nearest to all markers; `None` where they do not determine it.
    pub fn nearest(points: &Points, degree: usize) -> Option<Self> {
        let all: Vec<usize> = (0..points.places.len()).collect();
        Self::through(points, degree, &all)
    }

    /// The polynomial with the smallest distance to its nearest half of the markers: least trimmed squares, from
    /// small samples of the markers by concentration. `None` where they do not determine it.
    ///
    /// # References
    /// P. J. Rousseeuw, K. Van Driessen, Data Min. Knowl. Disc. 12, 29 (2006), doi:10.1007/s10618-005-0024-4
    pub fn trimmed(points: &Points, degree: usize) -> Option<Self> {
        const SAMPLES: usize = 300;
        const KEPT: usize = 10;
        let stride = points.places.len().div_ceil(3000).max(1);
        let some: Vec<usize> = (0..points.places.len()).step_by(stride).collect();
        let half = some.len() / 2 + 1;
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut found: Vec<(f64, Self)> = (0..SAMPLES)
            .filter_map(|_| {
                let start = Self::of_sample(points, degree, &some, &mut random)?;
                start.concentrated(points, &some, half, 2)
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let better = found.into_iter().take(KEPT);
        let better = better.filter_map(|(_, start)| start.concentrated(points, &some, half, 30));
        let best = better.min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, polynomial)| polynomial)
    }

    fn of_sample(
        points: &Points,
        degree: usize,
        some: &[usize],
        random: &mut impl Rng,
    ) -> Option<Self> {
        let count = terms([0.0; 2], degree).len();
        if some.len() < count {
            return None;
        }
        let chosen = sample(random, some.len(), count).into_iter();
        let chosen: Vec<usize> = chosen.map(|index| some[index]).collect();
        Self::through(points, degree, &chosen)
    }

    /// Fits the nearest `half` repeatedly; returns the sum of their squared distances, and the last fit.
    fn concentrated(
        self,
        points: &Points,
        some: &[usize],
        half: usize,
        most: usize,
    ) -> Option<(f64, Self)> {
        let (mut polynomial, mut least) = (self, f64::INFINITY);
        for _ in 0..most {
            let distances = polynomial.distances(points);
            let mut order = some.to_vec();
            order.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
            order.truncate(half);
            let sum = order.iter().map(|index| distances[*index].powi(2)).sum();
            if sum >= least {
                break;
            }
            least = sum;
            polynomial = Self::through(points, polynomial.degree, &order)?;
        }
        Some((least, polynomial))
    }

    fn through(points: &Points, degree: usize, chosen: &[usize]) -> Option<Self> {
        let [centre, size] = frame(points.places);
        let local = |index: usize| local(points.places[index], centre, size[0]);
        let count = terms([0.0; 2], degree).len();
        if chosen.len() < count {
            return None;
        }
        let rows: Vec<f64> = chosen
            .iter()
            .flat_map(|index| terms(local(*index), degree))
            .collect();
        let design = DMatrix::from_row_slice(chosen.len(), count, &rows);
        let values = DMatrix::from_fn(chosen.len(), 2, |row, axis| {
            points.displacements[chosen[row]][axis]
        });
        let factor = (design.transpose() * &design).cholesky()?;
        let weakest = factor.l_dirty().diagonal().min();
        if weakest < 1e-6 {
            return None;
        }
        Some(Self {
            coefficients: factor.solve(&(design.transpose() * values)),
            centre,
            size: size[0],
            degree,
        })
    }

    /// The displacement at a place in mm.
    pub fn at(&self, place: [f64; 2]) -> [f64; 2] {
        let terms = DVector::from_vec(terms(local(place, self.centre, self.size), self.degree));
        [0, 1].map(|axis| self.coefficients.column(axis).dot(&terms))
    }

    fn distances(&self, points: &Points) -> Vec<f64> {
        let pairs = points.places.iter().zip(points.displacements);
        pairs
            .map(|(place, displacement)| {
                let [x, y] = self.at(*place);
                (displacement[0] - x).hypot(displacement[1] - y)
            })
            .collect()
    }

    /// 1 for markers near the polynomial, 0 for those that are far off in terms of the spread of all.
    pub fn trust(&self, points: &Points) -> Vec<f64> {
        const FAR: f64 = 5.0;
        let distances = self.distances(points);
        let limit = FAR * robust_deviation(distances.iter().copied());
        distances
            .iter()
            .map(|d| f64::from(u8::from(*d <= limit)))
            .collect()
    }
}

/// The middle of the box around places, and half its longer side (twice).
fn frame(places: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let limits = [0, 1].map(|axis| extremes(places.iter().map(|place| place[axis])));
    let size = limits
        .iter()
        .fold(0.0_f64, |size, [low, high]| size.max(0.5 * (high - low)));
    [limits.map(|[low, high]| 0.5 * (low + high)), [size; 2]]
}

fn local(place: [f64; 2], centre: [f64; 2], size: f64) -> [f64; 2] {
    [0, 1].map(|axis| (place[axis] - centre[axis]) / size)
}

/// All xᵃyᵇ with a + b up to the degree.
fn terms([x, y]: [f64; 2], degree: usize) -> Vec<f64> {
    let powers = (0..=degree).flat_map(|a| (0..=degree - a).map(move |b| (a, b)));
    powers
        .map(|(a, b)| x.powi(a as i32) * y.powi(b as i32))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Vec<[f64; 2]> {
        let columns = (0..12).flat_map(|i| (0..9).map(move |j| (i, j)));
        columns
            .map(|(i, j)| [f64::from(i) * 3.0, f64::from(j) * 2.5])
            .collect()
    }

    fn field([x, y]: [f64; 2]) -> [f64; 2] {
        [0.4 * x - 1e-4 * x * y * y, -0.2 * y + 3e-3 * x * x]
    }

    #[test]
    fn a_third_of_wrong_markers_does_not_move_it() {
        let places = grid();
        let mut displacements: Vec<_> = places.iter().map(|place| field(*place)).collect();
        for index in (0..places.len()).step_by(3) {
            displacements[index] = [30.0 + index as f64, -20.0];
        }
        let points = Points {
            places: &places,
            displacements: &displacements,
        };
        let found = Polynomial::trimmed(&points, DEGREE).unwrap();
        for place in &places {
            let (a, b) = (found.at(*place), field(*place));
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-8);
        }
        let plain = Polynomial::nearest(&points, DEGREE).unwrap();
        assert!((plain.at([10.0, 10.0])[0] - field([10.0, 10.0])[0]).abs() > 1.0);
    }

    #[test]
    fn too_few_markers_determine_nothing() {
        let places = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
        let displacements = [[0.0; 2]; 3];
        let points = Points {
            places: &places,
            displacements: &displacements,
        };
        assert!(Polynomial::nearest(&points, 1).is_none());
        assert!(Polynomial::trimmed(&points, 1).is_none());
    }
}
