//! Bodies that hold the sheet: all sides with one name move and pull as one body, and share the reactions of the nodes where they meet.

use crate::estimation::input::{EdgeCondition, Segment};
use crate::mesh::Mesh;
use crate::problem::corner_forces::{Hold, Share, reaction_shares, shared_rests};

/// A body that holds the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The name of its edges.
    pub name: String,
    /// Numbers of its edges.
    pub edges: Vec<usize>,
    /// The reactions along x and along y that make up its force.
    pub shares: [Vec<Share>; 2],
    /// The rests of reactions at corners along x and along y that are shared with other bodies, though they may
    /// belong to any of them: the share, and the reactions that make it up.
    pub rests: [Vec<(f64, Vec<Share>)>; 2],
    /// Where bodies meet, known displacements take precedence over rigid ones and these over unknown ones.
    pub rank: usize,
}

impl Body {
    /// The force for given reactions, two numbers per node.
    pub fn force(&self, reactions: &[f64]) -> [f64; 2] {
        [0, 1].map(|axis| of_reactions(&self.shares[axis], reactions, axis))
    }

    /// The standard deviation along an axis of the part that may belong to others, if all divisions of it are equally likely.
    pub fn division_error(&self, reactions: &[f64], axis: usize) -> f64 {
        let square = |(share, factors): &(f64, Vec<Share>)| {
            (share * of_reactions(factors, reactions, axis)).powi(2) / 3.0
        };
        self.rests[axis].iter().map(square).sum::<f64>().sqrt()
    }
}

/// The sum of some shares of reactions along an axis.
fn of_reactions(shares: &[Share], reactions: &[f64], axis: usize) -> f64 {
    let parts = shares.iter();
    parts
        .map(|(node, factor)| factor * reactions[2 * node + axis])
        .sum()
}

/// The bodies behind the edges of a mesh that are not free, in the order of their first edges.
pub fn bodies<'a>(
    mesh: &Mesh,
    edges: impl Iterator<Item = (&'a Segment, EdgeCondition)>,
) -> Vec<Body> {
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
    let (_, members): (Vec<_>, Vec<Vec<usize>>) = groups.into_iter().unzip();
    let of_members = members.iter().map(|members| hold(mesh, &edges, members));
    let owned: Vec<Hold> = of_members.collect();
    let holds: Vec<&Hold> = owned.iter().collect();
    let rests = [0, 1].map(|axis| shared_rests(mesh, &holds, axis));
    let rests_of = |body: usize| {
        rests.each_ref().map(|rests| {
            let shared = rests.iter().filter(|rest| rest.bodies.contains(&body));
            shared
                .map(|rest| (1.0 / rest.bodies.len() as f64, rest.factors.clone()))
                .collect()
        })
    };
    let shares = reaction_shares(mesh, &holds).into_iter();
    let all = shares.zip(holds).zip(members).enumerate();
    let body = |(index, ((shares, hold), members)): (usize, ((_, &Hold), Vec<usize>))| Body {
        name: edges[members[0]].0.name.clone(),
        edges: members,
        shares,
        rests: rests_of(index),
        rank: hold.rank,
    };
    all.map(body).collect()
}

/// The nodes and sides held by the body behind some edges.
fn hold(mesh: &Mesh, edges: &[(&Segment, EdgeCondition)], members: &[usize]) -> Hold {
    let condition = edges[members[0]].1;
    let nodes_of = |wanted: &dyn Fn(&Segment) -> bool| {
        let segments = members.iter().map(|edge| edges[*edge].0);
        let chosen = segments.filter(|segment| wanted(segment));
        chosen
            .flat_map(|segment| segment.nodes.iter().copied())
            .collect()
    };
    let holds = |axis: usize| match condition {
        EdgeCondition::Known(values) => values[axis].is_some(),
        _ => true,
    };
    Hold {
        rank: condition.rank(),
        nodes: [0, 1].map(|axis| nodes_of(&|_| holds(axis))),
        sides: Hold::sides(mesh, &nodes_of(&|segment| !segment.inside)),
    }
}

#[cfg(test)]
mod corner_tests;
#[cfg(test)]
mod tests {
    use crate::estimation::edges::edge_motion::EdgeMotion;
    use std::collections::BTreeSet;

    use super::*;
    use crate::estimation::input::segments;
    use crate::mesh::CellShape;

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
        let all = bodies(&mesh, conditions);
        assert_eq!(all.len(), 2);
        let pad = all.iter().find(|body| body.name == "pad").unwrap();
        assert_eq!(pad.edges.len(), 2);
        let right = all.iter().find(|body| body.name == "right").unwrap();
        let corner = mesh.nodes.iter().position(|node| *node == [6.0, 0.0]);
        let factor = |body: &Body, wanted: usize| {
            let mut shares = body.shares[1].iter();
            shares
                .find(|(node, _)| *node == wanted)
                .map(|(_, factor)| *factor)
        };
        // The rest of the reaction at the corner with the bottom belongs to the pad.
        assert_eq!(factor(pad, corner.unwrap()), Some(1.0));
        assert_eq!(factor(right, corner.unwrap()), None);
        // The tractions at the next node belong to its edge: that of the middle node is four times that of an end.
        let neighbour = mesh.nodes.iter().position(|node| *node == [6.0, 0.5]);
        let [first, other] = [right, pad].map(|body| factor(body, neighbour.unwrap()).unwrap());
        assert!((first - 1.25).abs() < 1e-12 && (other + 0.25).abs() < 1e-12);
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
        assert_eq!(
            EdgeMotion::new(&mesh, &pairs, &BTreeSet::new(), 0.5).parameters(),
            3
        );
    }
}
