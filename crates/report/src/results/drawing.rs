//! Drawings as data: charts, fields, fields that move, outlines.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashSet};

use serde::{Deserialize, Serialize};

use super::surface::edge_lines;
use super::{Animation, FieldFigure, LineChart};
use crate::mesh::{Group, Mesh};

/// The content of a picture.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum Drawing {
    /// Charts one below the other, with their heights in points.
    Charts(Vec<(LineChart, u32)>),
    /// Fields on deformed plates.
    Field(FieldFigure),
    /// Fields that move.
    Animation(Animation),
    /// A mesh.
    Mesh(MeshFigure),
}

impl Drawing {
    /// Charts of one height in points, one below the other; `None` where there are none.
    pub fn charts(charts: impl IntoIterator<Item = LineChart>, height: u32) -> Option<Self> {
        let charts: Vec<_> = charts.into_iter().map(|chart| (chart, height)).collect();
        (!charts.is_empty()).then_some(Self::Charts(charts))
    }

    /// Whether it has only charts without a point.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Charts(charts) => {
                let mut lines = charts.iter().flat_map(|(chart, _)| &chart.lines);
                lines.all(|line| line.points.is_empty())
            }
            Self::Field(_) | Self::Animation(_) | Self::Mesh(_) => false,
        }
    }
}

/// A mesh at rest by its lines, in mm.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct MeshFigure {
    /// Heading.
    pub title: String,
    /// The outlines of the cells, each a closed line.
    pub cells: Vec<Vec<[f64; 2]>>,
    /// The groups that have names.
    pub groups: Vec<NamedLines>,
}

/// A group of a mesh: lines along its edges, or points, each drawn as a line between equal positions.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct NamedLines {
    /// Its name.
    pub name: String,
    /// Its lines in mm; of a region its outline.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// Of a region its cells, by their numbers.
    pub cells: Vec<usize>,
}

impl From<LineChart> for Drawing {
    fn from(chart: LineChart) -> Self {
        const HEIGHT: u32 = 480;
        Self::Charts(vec![(chart, HEIGHT)])
    }
}

impl From<FieldFigure> for Drawing {
    fn from(figure: FieldFigure) -> Self {
        Self::Field(figure)
    }
}

/// A mesh with its named groups, those of the same part as one; curved edges are drawn through their middles.
pub fn mesh_outlines(title: &str, mesh: &Mesh) -> Drawing {
    let cells = 0..mesh.cell_count();
    // Groups of the same part share a line: one would hide the others.
    let mut parts: Vec<(&Group, Vec<&str>)> = Vec::new();
    // Single tines are drawn as those of their side.
    let groups = mesh.groups().iter();
    for (name, group) in groups.filter(|(name, _)| !name.contains("-tine-")) {
        let is_same = |(other, _): &&mut (&Group, Vec<&str>)| {
            other.nodes == group.nodes && other.edges.is_empty() == group.edges.is_empty()
        };
        match parts.iter_mut().find(is_same) {
            Some((_, names)) => names.push(name),
            None => parts.push((group, vec![name])),
        }
    }
    // Later groups are drawn over earlier ones: a side must be visible on the whole boundary.
    parts.sort_by_key(|(group, _)| Reverse((group.cells.len(), group.edges.len().max(1))));
    let first_line = parts.partition_point(|(group, _)| !group.cells.is_empty());
    let is_hidden = |index: usize| {
        let later = parts.iter().skip(first_line.max(index + 1));
        let later: HashSet<&Vec<usize>> = later.flat_map(|(group, _)| &group.edges).collect();
        let group = parts[index].0;
        let is_side = index >= first_line && !group.edges.is_empty() && group.lines.is_empty();
        is_side && group.edges.iter().all(|edge| later.contains(edge))
    };
    let shown = (0..parts.len()).filter(|index| !is_hidden(*index));
    let groups = shown.map(|index| named(mesh, parts[index].0, &parts[index].1));
    Drawing::Mesh(MeshFigure {
        title: title.to_owned(),
        cells: cells.map(|cell| cell_outline(mesh, cell)).collect(),
        groups: groups.collect(),
    })
}

fn named(mesh: &Mesh, group: &Group, names: &[&str]) -> NamedLines {
    let lines = if !group.cells.is_empty() {
        edge_lines(&rim(mesh, &group.cells), &mesh.nodes)
    } else if group.edges.is_empty() && group.lines.is_empty() {
        let nodes = group.nodes.iter();
        nodes.map(|node| vec![mesh.nodes[*node]; 2]).collect()
    } else {
        edge_lines(&[&group.edges[..], &group.lines].concat(), &mesh.nodes)
    };
    NamedLines {
        name: names.join(" = "),
        lines,
        cells: group.cells.clone(),
    }
}

/// The edges around cells: those of one of them only.
fn rim(mesh: &Mesh, cells: &[usize]) -> Vec<Vec<usize>> {
    let mut edges: BTreeMap<[usize; 2], Option<Vec<usize>>> = BTreeMap::new();
    for cell in cells {
        for edge in mesh.shape(*cell).edges() {
            let edge: Vec<usize> = edge.iter().map(|node| mesh.cell(*cell)[*node]).collect();
            let ends = [edge[0].min(edge[1]), edge[0].max(edge[1])];
            let seen = edges.contains_key(&ends);
            edges.insert(ends, (!seen).then_some(edge));
        }
    }
    edges.into_values().flatten().collect()
}

fn cell_outline(mesh: &Mesh, cell: usize) -> Vec<[f64; 2]> {
    let nodes = mesh.cell(cell);
    let edges = mesh.shape(cell).edges();
    let edges = edges
        .iter()
        .map(|edge| edge.iter().map(|node| nodes[*node]).collect());
    let edges: Vec<Vec<usize>> = edges.collect();
    let mut positions: Vec<[f64; 2]> = Vec::new();
    for line in edge_lines(&edges, &mesh.nodes) {
        positions.extend(&line[..line.len() - 1]);
    }
    positions.extend(positions.first().copied());
    positions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellShape, Shape};

    #[test]
    fn only_what_is_seen_of_the_groups_is_named() {
        let mut mesh = Shape::Strip { size: [30.0, 10.0] }.mesh(4, CellShape::Quad9);
        let nodes = (0..mesh.nodes.len()).filter(|node| mesh.nodes[*node][0] < 15.1);
        mesh.name_nodes("region", &nodes.collect());
        let Drawing::Mesh(figure) = mesh_outlines("", &mesh) else {
            panic!("a mesh is drawn as one")
        };
        let names: Vec<&str> = figure.groups.iter().map(|group| &*group.name).collect();
        assert!(!names.contains(&"boundary"), "{names:?}");
        for side in ["left", "right", "bottom", "top"] {
            assert!(names.contains(&side), "{names:?}");
        }
        let region = &figure.groups[0];
        assert_eq!(region.name, "region");
        assert_eq!(2 * region.cells.len(), mesh.cell_count());
        assert!(region.lines.len() < region.cells.len() * 4);
    }
}
