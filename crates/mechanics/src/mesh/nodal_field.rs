//! Fields of vectors at nodes: ux, uy of node after node.

use super::geometry::distance;

/// A field of vectors at nodes, as the solvers store it: x and y of node after node.
pub trait NodalField {
    /// The vectors of node after node.
    fn vectors(&self) -> impl Iterator<Item = [f64; 2]> + Clone;

    /// √(Σ w |u|²) over the nodes with their weights w.
    fn weighted_norm(&self, weights: &[f64]) -> f64;

    /// √(Σ w |u − v|²) over the nodes with their weights w.
    fn weighted_distance(&self, other: &Self, weights: &[f64]) -> f64;

    /// max |u − v| over the nodes, and the first node where it is found.
    fn largest_distance(&self, other: &Self) -> (f64, usize);
}

impl NodalField for [f64] {
    fn vectors(&self) -> impl Iterator<Item = [f64; 2]> + Clone {
        self.chunks_exact(2).map(|u| [u[0], u[1]])
    }

    fn weighted_norm(&self, weights: &[f64]) -> f64 {
        let terms = self.vectors().zip(weights);
        let sum: f64 = terms.map(|([x, y], w)| w * (x.powi(2) + y.powi(2))).sum();
        sum.sqrt()
    }

    fn weighted_distance(&self, other: &Self, weights: &[f64]) -> f64 {
        let terms = self.vectors().zip(other.vectors()).zip(weights);
        let square = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).powi(2) + (b - d).powi(2);
        terms
            .map(|((u, v), w)| w * square(u, v))
            .sum::<f64>()
            .sqrt()
    }

    fn largest_distance(&self, other: &Self) -> (f64, usize) {
        let distances = self
            .vectors()
            .zip(other.vectors())
            .map(|(u, v)| distance(v, u));
        let indexed = distances.zip(0..);
        indexed.fold(
            (0.0, 0),
            |most, now| if now.0 > most.0 { now } else { most },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_norms_and_distances_are_those_of_the_nodes() {
        let (u, v) = ([3.0, 4.0, 1.0, -1.0], [0.0, 0.0, 1.0, 2.0]);
        assert_eq!(u.vectors().collect::<Vec<_>>(), [[3.0, 4.0], [1.0, -1.0]]);
        assert_eq!(
            u.weighted_norm(&[2.0, 3.0]),
            f64::sqrt(2.0 * 25.0 + 3.0 * 2.0)
        );
        assert_eq!(u.weighted_distance(&v, &[1.0, 1.0]), f64::sqrt(25.0 + 9.0));
        assert_eq!(v.largest_distance(&u), (5.0, 0));
    }
}
