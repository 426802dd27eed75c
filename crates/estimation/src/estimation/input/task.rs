//! The task of a search: mesh, edges and data.

use std::collections::{BTreeMap, BTreeSet};

use super::knowledge::{EdgeCondition, Knowledge, Specimen, Unnamed};
use super::observations::Observations;
use super::outline::{Segment, parts};
use crate::error::Error;
use crate::markers::Marker;
use crate::mesh::Mesh;

/// A part of the boundary with its condition.
#[derive(Clone, Debug)]
pub struct Edge {
    pub segment: Segment,
    pub condition: EdgeCondition,
    /// Whether the data choose between loaded and free.
    pub tested: bool,
    /// The probability of the misfit if the edge is free, where the data have chosen.
    pub probability: Option<f64>,
    /// Whether it is an edge of the body, at whose corners fields may be singular. Where a mesh ends inside of the
    /// body it is not; as long as the data choose, it is taken as one.
    pub of_body: bool,
}

impl Edge {
    /// A part of the boundary with its known condition.
    fn new(segment: Segment, knowledge: &Knowledge) -> Self {
        let open = segment.outer && segment.condition.is_none();
        let condition = match segment.condition {
            Some(number) => knowledge.edges[number].1,
            None if open && knowledge.unnamed != Unnamed::Free => EdgeCondition::Unknown,
            None => EdgeCondition::Free,
        };
        Self {
            segment,
            condition,
            tested: open && knowledge.unnamed == Unnamed::Tested,
            probability: None,
            of_body: !open,
        }
    }
}

/// The nodes at which edges of the body meet that are not free.
pub fn singular_corners(edges: &[Edge]) -> BTreeSet<usize> {
    let mut ends: BTreeMap<usize, (usize, bool)> = BTreeMap::new();
    for edge in edges.iter().filter(|edge| edge.is_loaded()) {
        for node in edge.segment.ends() {
            let (count, of_body) = ends.entry(node).or_insert((0, true));
            (*count, *of_body) = (*count + 1, *of_body && edge.of_body);
        }
    }
    let singular = ends
        .into_iter()
        .filter(|(_, (count, of_body))| *count > 1 && *of_body);
    singular.map(|(node, _)| node).collect()
}

/// The boundary with its known conditions, and the markers on the mesh.
///
/// # Errors
/// [`Error::Input`] when the data, the mesh and the conditions do not match.
pub fn observe(
    mesh: &Mesh,
    markers: &[Marker],
    knowledge: &Knowledge,
) -> Result<(Vec<Edge>, Observations), Error> {
    let edges = Edge::of_boundary(mesh, knowledge)?;
    knowledge.check()?;
    let observations = Observations::new(mesh, markers, knowledge.noise)?;
    Ok((edges, observations))
}

/// What a field is estimated from.
#[derive(Clone)]
pub struct Task<'a> {
    pub specimen: Specimen<'a>,
    pub observations: &'a Observations,
    pub knowledge: &'a Knowledge,
}

impl Edge {
    /// All parts of the boundary of a mesh, and the pads on it.
    ///
    /// # Errors
    /// [`Error::Input`] when the mesh does not have them.
    pub fn of_boundary(mesh: &Mesh, knowledge: &Knowledge) -> Result<Vec<Self>, Error> {
        let segments = parts(mesh, &knowledge.edges)?;
        let edges = segments.into_iter();
        Ok(edges.map(|segment| Self::new(segment, knowledge)).collect())
    }

    /// Whether the edge is not free.
    pub fn is_loaded(&self) -> bool {
        self.condition != EdgeCondition::Free
    }

    /// Whether the edge is free, so that a strip of the sheet may lie outside of it.
    pub fn has_strip(&self) -> bool {
        !self.is_loaded() && !self.segment.inside
    }
}
