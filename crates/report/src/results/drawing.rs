//! Drawings as data: charts, fields, fields that move, outlines.

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

/// A group of a mesh: lines along its edges, or points, each drawn as a line between equal places.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct NamedLines {
    /// Its name.
    pub name: String,
    /// Its lines in mm.
    pub lines: Vec<Vec<[f64; 2]>>,
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

/// A mesh with its named groups, those of the same nodes as one; curved edges are drawn through their middles.
pub fn mesh_outlines(title: &str, mesh: &Mesh) -> Drawing {
    let cells = 0..mesh.cell_count();
    // Groups of the same part share a line: one would hide the others.
    let mut parts: Vec<(&Group, Vec<&str>)> = Vec::new();
    for (name, group) in mesh.groups() {
        let is_same = |(own, _): &&mut (&Group, Vec<&str>)| {
            own.nodes == group.nodes && own.edges.is_empty() == group.edges.is_empty()
        };
        match parts.iter_mut().find(is_same) {
            Some((_, names)) => names.push(name),
            None => parts.push((group, vec![name])),
        }
    }
    let named = parts.into_iter().map(|(group, names)| NamedLines {
        name: names.join(" = "),
        lines: if !group.edges.is_empty() {
            edge_lines(&group.edges, &mesh.nodes)
        } else {
            points(group, mesh)
        },
    });
    let mut groups: Vec<NamedLines> = named.collect();
    // Later groups are drawn over earlier ones: a side must be visible on the whole boundary.
    groups.sort_by_key(|group| std::cmp::Reverse(group.lines.len()));
    Drawing::Mesh(MeshFigure {
        title: title.to_owned(),
        cells: cells.map(|cell| cell_outline(mesh, cell)).collect(),
        groups,
    })
}

fn cell_outline(mesh: &Mesh, cell: usize) -> Vec<[f64; 2]> {
    let nodes = mesh.cell(cell);
    let edges = mesh.shape(cell).edges();
    let edges = edges
        .iter()
        .map(|edge| edge.iter().map(|node| nodes[*node]).collect());
    let edges: Vec<Vec<usize>> = edges.collect();
    let mut places: Vec<[f64; 2]> = Vec::new();
    for line in edge_lines(&edges, &mesh.nodes) {
        places.extend(&line[..line.len() - 1]);
    }
    places.extend(places.first().copied());
    places
}

fn points(group: &Group, mesh: &Mesh) -> Vec<Vec<[f64; 2]>> {
    let nodes = group.nodes.iter();
    nodes.map(|node| vec![mesh.nodes[*node]; 2]).collect()
}
