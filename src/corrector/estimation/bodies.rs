//! Bodies that hold the sheet: all sides of one name move and pull as one, and every node belongs to one body along each axis.

use std::collections::BTreeSet;

use super::knowledge::EdgeCondition;
use super::outline::Segment;

/// What holds the sheet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Body {
    /// The name of its edges.
    pub name: String,
    /// Numbers of its edges.
    pub edges: Vec<usize>,
    /// Its nodes along x and along y: those that no body before it holds.
    pub nodes: [Vec<usize>; 2],
    /// Its turn where bodies meet: known displacements go before rigid ones and these before unknown ones.
    pub turn: usize,
}

/// The bodies behind the edges that are not free, in the order of their first edges.
pub fn bodies<'a>(edges: impl Iterator<Item = (&'a Segment, EdgeCondition)>) -> Vec<Body> {
    let edges: Vec<_> = edges.collect();
    let mut groups: Vec<(Option<usize>, Vec<usize>)> = Vec::new();
    for (index, (segment, condition)) in edges.iter().enumerate() {
        if *condition == EdgeCondition::Free {
            continue;
        }
        let named = segment.condition;
        match groups
            .iter_mut()
            .find(|(name, _)| named.is_some() && *name == named)
        {
            Some((_, members)) => members.push(index),
            None => groups.push((named, vec![index])),
        }
    }
    let rank = |group: &(Option<usize>, Vec<usize>)| match edges[group.1[0]].1 {
        EdgeCondition::Known(_) => 0,
        EdgeCondition::Rigid => 1,
        EdgeCondition::Unknown | EdgeCondition::Free => 2,
    };
    groups.sort_by_key(|group| (rank(group), group.1[0]));
    let mut taken: [BTreeSet<usize>; 2] = Default::default();
    let body = |(turn, (_, members)): (usize, (Option<usize>, Vec<usize>))| {
        let (first, condition) = edges[members[0]];
        let holds = |axis: usize| match condition {
            EdgeCondition::Known(values) => values[axis].is_some(),
            _ => true,
        };
        let nodes = [0, 1].map(|axis| {
            let all = members.iter().flat_map(|edge| &edges[*edge].0.nodes);
            let all = all.filter(|_| holds(axis)).copied();
            all.filter(|node| taken[axis].insert(*node)).collect()
        });
        Body {
            name: first.name.clone(),
            edges: members,
            nodes,
            turn,
        }
    };
    let mut all: Vec<Body> = groups.into_iter().enumerate().map(body).collect();
    all.sort_by_key(|body| body.edges[0]);
    all
}

#[cfg(test)]
mod tests {
    use super::super::edge_motion::EdgeMotion;
    use super::super::outline::segments;
    use super::*;
    use crate::mesh::{CellShape, Mesh};

    #[test]
    fn sides_of_one_name_are_one_body_and_corners_belong_to_one() {
        let mut mesh = Mesh::plate([6.0, 4.0], [6, 4], CellShape::Quad9);
        let groups = mesh.groups();
        let both = ["left", "bottom"]
            .iter()
            .flat_map(|name| groups[*name].nodes.clone());
        let both: BTreeSet<usize> = both.collect();
        mesh.name_nodes("pad", &both);
        let parts = segments(&mesh, &["pad", "right"]).unwrap();
        let conditions = parts.iter().map(|part| {
            let condition = match part.name.as_str() {
                "pad" => EdgeCondition::Rigid,
                "right" => EdgeCondition::Unknown,
                _ => EdgeCondition::Free,
            };
            (part, condition)
        });
        let found = bodies(conditions);
        assert_eq!(found.len(), 2);
        let pad = found.iter().find(|body| body.name == "pad").unwrap();
        assert_eq!(pad.edges.len(), 2);
        assert_eq!(pad.nodes[0].len(), both.len());
        let right = found.iter().find(|body| body.name == "right").unwrap();
        // The corner with the bottom belongs to the pad.
        assert_eq!(right.nodes[1].len(), 8);
    }

    #[test]
    fn all_sides_of_one_name_move_as_one_body() {
        let mut mesh = Mesh::plate([6.0, 4.0], [6, 4], CellShape::Quad9);
        let sides = ["left", "right"].map(|name| mesh.groups()[name].nodes.clone());
        mesh.name_nodes("frame", &sides.concat().into_iter().collect());
        let parts = segments(&mesh, &["frame"]).unwrap();
        let named = parts.iter().filter(|part| part.condition.is_some());
        let pairs: Vec<_> = named.map(|part| (part, EdgeCondition::Rigid)).collect();
        assert_eq!(pairs.len(), 2);
        assert_eq!(EdgeMotion::new(&mesh, &pairs, 0.5).parameters(), 3);
    }
}
