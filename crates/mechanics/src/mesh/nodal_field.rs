//! Fields of vectors at nodes, as the solvers store them: x and y of node after node.

use super::geometry::distance;

/// The vectors of node after node.
pub fn vectors(field: &[f64]) -> impl Iterator<Item = [f64; 2]> + Clone {
    field.chunks_exact(2).map(|u| [u[0], u[1]])
}

/// √(Σ w |u|²) over the nodes with their weights w.
pub fn weighted_norm(field: &[f64], weights: &[f64]) -> f64 {
    let terms = vectors(field).zip(weights);
    let sum: f64 = terms.map(|([x, y], w)| w * (x.powi(2) + y.powi(2))).sum();
    sum.sqrt()
}

/// √(Σ w |u − v|²) over the nodes with their weights w.
pub fn weighted_distance(field: &[f64], other: &[f64], weights: &[f64]) -> f64 {
    let terms = vectors(field).zip(vectors(other)).zip(weights);
    let square = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).powi(2) + (b - d).powi(2);
    terms
        .map(|((u, v), w)| w * square(u, v))
        .sum::<f64>()
        .sqrt()
}

/// max |u − v| over the nodes, and the first node where it is found.
pub fn largest_distance(field: &[f64], other: &[f64]) -> (f64, usize) {
    let distances = vectors(field)
        .zip(vectors(other))
        .map(|(u, v)| distance(v, u));
    let indexed = distances.zip(0..);
    indexed.fold(
        (0.0, 0),
        |most, now| if now.0 > most.0 { now } else { most },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_norms_and_distances_are_those_of_the_nodes() {
        let (u, v) = ([3.0, 4.0, 1.0, -1.0], [0.0, 0.0, 1.0, 2.0]);
        assert_eq!(vectors(&u).collect::<Vec<_>>(), [[3.0, 4.0], [1.0, -1.0]]);
        assert_eq!(
            weighted_norm(&u, &[2.0, 3.0]),
            f64::sqrt(2.0 * 25.0 + 3.0 * 2.0)
        );
        assert_eq!(
            weighted_distance(&u, &v, &[1.0, 1.0]),
            f64::sqrt(25.0 + 9.0)
        );
        assert_eq!(largest_distance(&v, &u), (5.0, 0));
    }
}
