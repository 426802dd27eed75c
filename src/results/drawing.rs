//! Drawings as data: charts, fields, fields that move, outlines.

use super::{Animation, FieldFigure, LineChart};
use crate::mesh::Mesh;

/// What a picture shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// Charts one below the other, with their heights in points.
    Charts(Vec<(LineChart, u32)>),
    /// Fields on deformed plates.
    Field(FieldFigure),
    /// Fields that move.
    Animation(Animation),
    /// A heading, and the outlines of cells, each a closed line, in mm.
    Outlines(String, Vec<Vec<[f64; 2]>>),
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

/// A mesh; curved edges are drawn through their middles.
pub fn mesh_outlines(title: &str, mesh: &Mesh) -> Drawing {
    let outline = |cell: usize| {
        let nodes = mesh.cell(cell);
        let shape = mesh.shape(cell);
        let mut places = Vec::new();
        for edge in shape.edges() {
            let along = [0, 1, 2, 3].map(|i| f64::from(i) / 4.0);
            let [from, to] = [edge[0], edge[1]].map(|node| shape.natural_nodes()[node]);
            for share in along {
                let local = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                let values = shape.values(local);
                places.push([0, 1].map(|axis| {
                    let shares = nodes.iter().zip(&values);
                    shares
                        .map(|(node, value)| value * mesh.nodes[*node][axis])
                        .sum()
                }));
            }
        }
        places.extend(places.first().copied());
        places
    };
    let cells = (0..mesh.cell_count()).map(outline).collect();
    Drawing::Outlines(title.to_owned(), cells)
}
