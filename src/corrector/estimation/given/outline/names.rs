//! Names of the parts of a boundary.

use std::collections::{BTreeMap, BTreeSet};

use super::{Segment, segments};
use crate::mesh::Mesh;

/// Numbers parts that no group names and that would have one name, as they follow each other; numbers that named ones have are left out.
pub fn number_alike(all: &mut [Segment]) {
    let named = all.iter().filter(|part| part.condition.is_some());
    let taken: BTreeSet<String> = named.map(|part| part.name.clone()).collect();
    let is_taken = |base: &str, number: usize| taken.contains(&format!("{base} {number}"));
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for part in all.iter().filter(|part| part.condition.is_none()) {
        *counts.entry(part.name.clone()).or_default() += 1;
    }
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for part in all.iter_mut().filter(|part| part.condition.is_none()) {
        let is_alone = counts[&part.name] == 1;
        if is_alone && !(1..=taken.len() + 1).any(|number| is_taken(&part.name, number)) {
            continue;
        }
        let number = numbers.entry(part.name.clone()).or_default();
        *number += 1;
        while is_taken(&part.name, *number) {
            *number += 1;
        }
        part.name = format!("{} {number}", part.name);
    }
}

/// Makes groups of the parts between corners that are named as results name them, such as `bottom 2` of a side in pieces; other names,
/// and those of groups, are left as they are.
pub fn name_parts<'a>(mesh: &mut Mesh, names: impl Iterator<Item = &'a str>) {
    let wanted: Vec<&str> = names
        .filter(|name| !mesh.groups().contains_key(*name))
        .collect();
    // A mesh that cannot be divided is told of where it is used.
    let Some(parts) = (!wanted.is_empty())
        .then(|| segments(mesh, &[]).ok())
        .flatten()
    else {
        return;
    };
    for part in parts.iter().filter(|part| wanted.contains(&&*part.name)) {
        let within = |edge: &&Vec<usize>| {
            let mut runs = part.nodes.windows(edge.len());
            runs.any(|run| run[0] == edge[0] && run[run.len() - 1] == edge[1])
        };
        let edges = mesh.boundary().iter().filter(within).cloned().collect();
        mesh.name_edges(&part.name, edges);
    }
}

/// The smallest group of the mesh that all of an edge belongs to.
pub fn group_of(mesh: &Mesh, nodes: &[usize]) -> Option<String> {
    let groups = mesh.groups().iter();
    let has = |node: &usize, members: &[usize]| members.binary_search(node).is_ok();
    let whole = groups.filter(|(_, group)| {
        !group.edges.is_empty() && nodes.iter().all(|node| has(node, &group.nodes))
    });
    let smallest = whole.min_by_key(|(_, group)| group.nodes.len());
    smallest.map(|(name, _)| name.clone())
}

/// Where a part lies.
pub fn describe(mesh: &Mesh, nodes: &[usize], outer: bool) -> String {
    let at = |node: usize| {
        let [x, y] = mesh.nodes[node];
        format!("({x:.1}, {y:.1})")
    };
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    match (outer, first == last) {
        (true, true) => "the outer edge".to_owned(),
        (false, true) => format!("the hole at {} mm", at(first)),
        _ => format!("edge {} to {} mm", at(first), at(last)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Outline;

    /// A U whose lower side is one piece and whose upper one is two.
    #[test]
    fn parts_of_a_side_are_named_as_results_name_them() {
        let corners = [
            [0.0, 0.0],
            [30.0, 0.0],
            [30.0, 20.0],
            [20.0, 20.0],
            [20.0, 8.0],
            [10.0, 8.0],
            [10.0, 20.0],
            [0.0, 20.0],
        ];
        let outline = Outline::of_lines(vec![corners.to_vec()]).unwrap();
        for shape in [
            crate::mesh::CellShape::Triangle3,
            crate::mesh::CellShape::Triangle6,
        ] {
            let mut mesh = outline.mesh(2.5, shape);
            let names = |mesh: &Mesh, groups: &[&str]| -> BTreeSet<String> {
                segments(mesh, groups)
                    .unwrap()
                    .into_iter()
                    .map(|part| part.name)
                    .collect()
            };
            let before = names(&mesh, &[]);
            assert!(
                before.contains("top 1") && before.contains("top 2"),
                "{before:?}"
            );
            name_parts(&mut mesh, ["top 2", "left", "nowhere"].into_iter());
            assert!(!mesh.groups().contains_key("nowhere"));
            let part = &mesh.groups()["top 2"];
            let length: f64 = part
                .edges
                .iter()
                .map(|edge| (mesh.nodes[edge[0]][0] - mesh.nodes[edge[1]][0]).abs())
                .sum();
            assert!((length - 10.0).abs() < 1e-9, "{length}");
            assert_eq!(names(&mesh, &["top 2"]), before);
        }
    }
}
