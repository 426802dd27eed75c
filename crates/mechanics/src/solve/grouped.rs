//! Items in groups, one group after the other in one list.

/// Items by so many groups in the order in which they come: where each group begins, and the items.
pub fn grouped<T: Copy + Default>(
    groups: usize,
    items: impl Iterator<Item = (usize, T)> + Clone,
) -> (Vec<usize>, Vec<T>) {
    let mut starts = vec![0; groups + 1];
    for (group, _) in items.clone() {
        starts[group + 1] += 1;
    }
    for group in 0..groups {
        starts[group + 1] += starts[group];
    }
    let (mut next, mut all) = (starts.clone(), vec![T::default(); starts[groups]]);
    for (group, item) in items {
        all[next[group]] = item;
        next[group] += 1;
    }
    (starts, all)
}
