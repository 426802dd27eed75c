//! Nearest neighbours among positions in a plane.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

type Site = GeomWithData<[f64; 2], usize>;

/// The `count` nearest other positions of each position, the nearest first; of equally near ones those with the smaller number.
pub fn nearest(positions: &[[f64; 2]], count: usize) -> Vec<Vec<usize>> {
    let tree = tree(positions, 0..positions.len());
    let indices = (0..positions.len()).into_par_iter();
    indices
        .map(|index| around(&tree, positions[index], count, |other| other != index))
        .collect()
}

/// All positions in a random but reproducible order, each with the `count` nearest of those that precede it.
pub fn nearest_before(positions: &[[f64; 2]], count: usize) -> Vec<(usize, Vec<usize>)> {
    const FIRST: usize = 32;
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(1));
    let mut ranks = vec![0; positions.len()];
    for (rank, index) in order.iter().enumerate() {
        ranks[*index] = rank;
    }
    let mut all = Vec::with_capacity(order.len());
    // A tree is built for twice as many positions as precede: at least half of them are admissible neighbours.
    while all.len() < order.len() {
        let end = (2 * all.len()).max(FIRST).min(order.len());
        let tree = tree(positions, order[..end].iter().copied());
        let before = |index: &usize| {
            let is_before = |other: usize| ranks[other] < ranks[*index];
            (*index, around(&tree, positions[*index], count, is_before))
        };
        all.par_extend(order[all.len()..end].par_iter().map(before));
    }
    all
}

fn tree(positions: &[[f64; 2]], chosen: impl Iterator<Item = usize>) -> RTree<Site> {
    RTree::bulk_load(
        chosen
            .map(|index| Site::new(positions[index], index))
            .collect(),
    )
}

/// The nearest admitted positions of a tree; of those that are as far as the last one, those with the smallest numbers.
fn around(
    tree: &RTree<Site>,
    position: [f64; 2],
    count: usize,
    admits: impl Fn(usize) -> bool,
) -> Vec<usize> {
    const EQUAL: f64 = 1e-9;
    let mut result: Vec<(f64, usize)> = Vec::with_capacity(count + 1);
    for (site, square) in tree.nearest_neighbor_iter_with_distance_2(&position) {
        let last = result.len().checked_sub(1).map(|last| result[last].0);
        if result.len() >= count && last.is_some_and(|last| square > last * (1.0 + EQUAL)) {
            break;
        }
        if admits(site.data) {
            result.push((square, site.data));
        }
    }
    let rounded = |square: f64| (square.max(f64::MIN_POSITIVE).ln() / EQUAL.sqrt()).round() as i64;
    result.sort_by_cached_key(|(square, index)| (rounded(*square), *index));
    result.truncate(count);
    result.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Vec<[f64; 2]> {
        let positions = (0..9).flat_map(|i| (0..7).map(move |j| (i, j)));
        positions
            .map(|(i, j)| [f64::from(i), 1.01 * f64::from(j)])
            .collect()
    }

    #[test]
    fn neighbours_are_the_nearest_ones() {
        let positions = grid();
        let result = nearest(&positions, 4);
        // (4, 3) in the middle.
        let mut middle = result[31].clone();
        middle.sort_unstable();
        assert_eq!(middle, [24, 30, 32, 38]);
        assert_eq!(result[0][0], 7);
    }

    #[test]
    fn those_before_are_the_nearest_of_those_before() {
        let positions = grid();
        let all = nearest_before(&positions, 5);
        assert_eq!(all.len(), positions.len());
        let far = |a: usize, b: usize| {
            (positions[a][0] - positions[b][0]).hypot(positions[a][1] - positions[b][1])
        };
        for (step, (index, before)) in all.iter().enumerate() {
            let earlier: Vec<usize> = all[..step].iter().map(|(index, _)| *index).collect();
            assert_eq!(before.len(), step.min(5));
            let most = before
                .iter()
                .map(|other| far(*index, *other))
                .fold(0.0, f64::max);
            let nearer = earlier
                .iter()
                .filter(|other| far(*index, **other) < most - 1e-9);
            assert!(nearer.count() < 5 && before.iter().all(|other| earlier.contains(other)));
        }
    }
}
