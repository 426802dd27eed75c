//! The start of the estimate: a polynomial through the markers that gross errors do not affect.

use nalgebra::{DMatrix, DVector};
use rand::seq::index::sample;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::statistics::{extremes, robust_deviation};

/// The largest degree.
pub const DEGREE: usize = 3;

/// A displacement field of two polynomials of one total degree.
#[derive(Clone, Debug)]
pub struct Polynomial {
    monomials: Monomials,
    coefficients: DMatrix<f64>,
}

/// All xᵃyᵇ with a + b up to the degree: x, y from the centre of the box around the markers, over half its longer side.
#[derive(Clone, Copy, Debug)]
struct Monomials {
    centre: [f64; 2],
    size: f64,
    degree: usize,
}

/// Positions and displacements of markers in mm.
pub struct Points<'a> {
    /// Positions at rest.
    pub positions: &'a [[f64; 2]],
    /// Displacements.
    pub displacements: &'a [[f64; 2]],
}

impl Monomials {
    fn new(positions: &[[f64; 2]], degree: usize) -> Self {
        let limits = [0, 1].map(|axis| extremes(positions.iter().map(|position| position[axis])));
        let half_sides = limits.map(|[low, high]| 0.5 * (high - low));
        Self {
            centre: limits.map(|[low, high]| 0.5 * (low + high)),
            size: half_sides.into_iter().fold(0.0, f64::max),
            degree,
        }
    }

    fn count(self) -> usize {
        (self.degree + 1) * (self.degree + 2) / 2
    }

    fn at(self, position: [f64; 2]) -> Vec<f64> {
        let [x, y] = [0, 1].map(|axis| (position[axis] - self.centre[axis]) / self.size);
        let powers = (0..=self.degree).flat_map(|a| (0..=self.degree - a).map(move |b| (a, b)));
        powers
            .map(|(a, b)| x.powi(a as i32) * y.powi(b as i32))
            .collect()
    }
}

impl Polynomial {
    /// The polynomial nearest to all markers; `None` where they do not determine it.
    pub fn nearest(points: &Points, degree: usize) -> Option<Self> {
        let rows = Rows::new(points, degree, 1);
        let all: Vec<usize> = (0..rows.displacements.len()).collect();
        Some(rows.polynomial(rows.through(&all)?))
    }

    /// The polynomial with the smallest distance to its nearest half of the markers: least trimmed squares, from
    /// small samples of the markers by concentration. `None` where they do not determine it.
    ///
    /// # References
    /// P. J. Rousseeuw, K. Van Driessen, Data Min. Knowl. Disc. 12, 29 (2006), doi:10.1007/s10618-005-0024-4
    pub fn trimmed(points: &Points, degree: usize) -> Option<Self> {
        const SAMPLES: usize = 300;
        const KEPT: usize = 10;
        let stride = points.positions.len().div_ceil(3000).max(1);
        let rows = Rows::new(points, degree, stride);
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let samples: Vec<_> = (0..SAMPLES)
            .filter_map(|_| rows.sample(&mut random))
            .collect();
        let mut starts: Vec<_> = samples
            .into_par_iter()
            .filter_map(|start| rows.concentrated(start, 2))
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let kept = starts.into_iter().take(KEPT);
        let concentrated = kept.filter_map(|(_, start)| rows.concentrated(start, 30));
        let best = concentrated.min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, coefficients)| rows.polynomial(coefficients))
    }

    /// The displacement at a position in mm.
    pub fn at(&self, position: [f64; 2]) -> [f64; 2] {
        let terms = DVector::from_vec(self.monomials.at(position));
        [0, 1].map(|axis| self.coefficients.column(axis).dot(&terms))
    }

    fn distances(&self, points: &Points) -> Vec<f64> {
        let pairs = points.positions.iter().zip(points.displacements);
        pairs
            .map(|(position, displacement)| {
                let [x, y] = self.at(*position);
                (displacement[0] - x).hypot(displacement[1] - y)
            })
            .collect()
    }

    /// 1 for markers near the polynomial, 0 for those whose distance from it is more than five robust deviations of all distances.
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

/// Some markers with the monomials at their positions, for many fits.
struct Rows {
    monomials: Monomials,
    /// Marker after marker.
    terms: Vec<f64>,
    displacements: Vec<[f64; 2]>,
}

impl Rows {
    /// The rows of every `stride`-th marker.
    fn new(points: &Points, degree: usize, stride: usize) -> Self {
        let monomials = Monomials::new(points.positions, degree);
        let positions = points.positions.iter().step_by(stride);
        let displacements = points.displacements.iter().step_by(stride);
        Self {
            monomials,
            terms: positions
                .flat_map(|position| monomials.at(*position))
                .collect(),
            displacements: displacements.copied().collect(),
        }
    }

    fn polynomial(&self, coefficients: DMatrix<f64>) -> Polynomial {
        Polynomial {
            monomials: self.monomials,
            coefficients,
        }
    }

    /// The coefficients of a polynomial through as few markers as determine it.
    fn sample(&self, random: &mut impl Rng) -> Option<DMatrix<f64>> {
        let (all, count) = (self.displacements.len(), self.monomials.count());
        let chosen = (all >= count).then(|| sample(random, all, count));
        self.through(&chosen?.into_vec())
    }

    /// The coefficients nearest to some markers; `None` where these do not determine them.
    fn through(&self, chosen: &[usize]) -> Option<DMatrix<f64>> {
        let count = self.monomials.count();
        if chosen.len() < count {
            return None;
        }
        let mut normal = DMatrix::zeros(count, count);
        let mut target = DMatrix::zeros(count, 2);
        for index in chosen {
            let row = &self.terms[index * count..(index + 1) * count];
            for (i, factor) in row.iter().enumerate() {
                for (j, other) in row[i..].iter().enumerate() {
                    normal[(i + j, i)] += factor * other;
                }
                for axis in [0, 1] {
                    target[(i, axis)] += factor * self.displacements[*index][axis];
                }
            }
        }
        let factor = normal.cholesky()?;
        let weakest = factor.l_dirty().diagonal().min();
        (weakest >= 1e-6).then(|| factor.solve(&target))
    }

    /// The square of each marker's distance from a polynomial.
    fn squares(&self, coefficients: &DMatrix<f64>) -> Vec<f64> {
        let count = self.monomials.count();
        let rows = self.terms.chunks_exact(count).zip(&self.displacements);
        let square = |(row, displacement): (&[f64], &[f64; 2])| {
            let off = [0, 1].map(|axis| {
                let factors = &coefficients.as_slice()[axis * count..];
                let terms = row.iter().zip(factors);
                displacement[axis] - terms.map(|(term, factor)| term * factor).sum::<f64>()
            });
            off[0] * off[0] + off[1] * off[1]
        };
        rows.map(square).collect()
    }

    /// Fits the nearest half repeatedly; returns the sum of its squared distances, and the last fit.
    fn concentrated(&self, start: DMatrix<f64>, most: usize) -> Option<(f64, DMatrix<f64>)> {
        let (mut coefficients, mut least) = (start, f64::INFINITY);
        let half = self.displacements.len() / 2 + 1;
        for _ in 0..most {
            let squares = self.squares(&coefficients);
            let mut order: Vec<usize> = (0..squares.len()).collect();
            if half < order.len() {
                order.select_nth_unstable_by(half, |a, b| squares[*a].total_cmp(&squares[*b]));
                order.truncate(half);
                order.sort_unstable();
            }
            let sum = order.iter().map(|index| squares[*index]).sum();
            if sum >= least {
                break;
            }
            least = sum;
            coefficients = self.through(&order)?;
        }
        Some((least, coefficients))
    }
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
        let positions = grid();
        let mut displacements: Vec<_> = positions.iter().map(|position| field(*position)).collect();
        for index in (0..positions.len()).step_by(3) {
            displacements[index] = [30.0 + index as f64, -20.0];
        }
        let points = Points {
            positions: &positions,
            displacements: &displacements,
        };
        let polynomial = Polynomial::trimmed(&points, DEGREE).unwrap();
        for position in &positions {
            let (a, b) = (polynomial.at(*position), field(*position));
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-8);
        }
        let plain = Polynomial::nearest(&points, DEGREE).unwrap();
        assert!((plain.at([10.0, 10.0])[0] - field([10.0, 10.0])[0]).abs() > 1.0);
    }

    #[test]
    fn too_few_markers_determine_nothing() {
        let positions = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
        let displacements = [[0.0; 2]; 3];
        let points = Points {
            positions: &positions,
            displacements: &displacements,
        };
        assert!(Polynomial::nearest(&points, 1).is_none());
        assert!(Polynomial::trimmed(&points, 1).is_none());
    }
}
