//! Nearest neighbours among places of a plane.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rstar::RTree;
use rstar::primitives::GeomWithData;

type Site = GeomWithData<[f64; 2], usize>;

/// The `count` nearest other places of each place, the nearest first; of equally near ones those with the smaller number.
pub fn nearest(positions: &[[f64; 2]], count: usize) -> Vec<Vec<usize>> {
    let sites = positions.iter().enumerate();
    let tree = RTree::bulk_load(
        sites
            .map(|(index, position)| Site::new(*position, index))
            .collect(),
    );
    let others = |index: usize| {
        let others = around(&tree, positions[index], count + 1).into_iter();
        others.filter(|other| *other != index).take(count).collect()
    };
    (0..positions.len()).map(others).collect()
}

/// All places in a random but reproducible order, each with the `count` nearest of those before it.
pub fn nearest_before(positions: &[[f64; 2]], count: usize) -> Vec<(usize, Vec<usize>)> {
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(1));
    let mut tree = RTree::new();
    let visit = |index: usize| {
        let before = around(&tree, positions[index], count);
        tree.insert(Site::new(positions[index], index));
        (index, before)
    };
    order.into_iter().map(visit).collect()
}

/// The nearest of a tree, those that are as far as the last one only by their numbers.
fn around(tree: &RTree<Site>, position: [f64; 2], count: usize) -> Vec<usize> {
    const EQUAL: f64 = 1e-9;
    let mut result: Vec<(f64, usize)> = Vec::new();
    for (site, square) in tree.nearest_neighbor_iter_with_distance_2(&position) {
        let last = result.len().checked_sub(1).map(|last| result[last].0);
        if result.len() >= count && last.is_some_and(|last| square > last * (1.0 + EQUAL)) {
            break;
        }
        result.push((square, site.data));
    }
    let rounded = |square: f64| (square.max(f64::MIN_POSITIVE).ln() / EQUAL.sqrt()).round();
    result.sort_by(|a, b| rounded(a.0).total_cmp(&rounded(b.0)).then(a.1.cmp(&b.1)));
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
