//! The solids above the sheet.

use std::collections::BTreeMap;

use crate::mesh::CellShape;
use crate::output::export::model::Model;

/// The columns of nodes above the nodes of the sheet: their numbers from the middle of the sheet upwards.
pub struct Columns(pub BTreeMap<usize, Vec<usize>>);

impl Columns {
    pub fn new(model: &Model) -> Self {
        let mut heights: BTreeMap<usize, usize> = BTreeMap::new();
        for (shape, nodes) in &model.cells {
            for (position, node) in nodes.iter().enumerate() {
                let three = match shape {
                    CellShape::Triangle3 | CellShape::Quad4 => false,
                    CellShape::Triangle6 | CellShape::Quad8 => position < shape.corners(),
                    CellShape::Quad9 => true,
                };
                heights.insert(*node, if three { 3 } else { 2 });
            }
        }
        let mut next = 1;
        let columns = heights.into_iter().map(|(node, height)| {
            let levels = next..next + height;
            next = levels.end;
            (node, levels.collect())
        });
        Self(columns.collect())
    }

    pub fn lower(&self, node: usize) -> usize {
        self.0[&node][0]
    }

    pub fn upper(&self, node: usize) -> usize {
        self.0[&node][self.0[&node].len() - 1]
    }

    /// The middle one of three.
    pub fn middle(&self, node: usize) -> usize {
        self.0[&node][1]
    }

    pub fn all<'a>(&'a self, nodes: &'a [usize]) -> impl Iterator<Item = usize> + 'a {
        nodes.iter().flat_map(|node| self.0[node].iter().copied())
    }

    /// The nodes of the solid on a cell, in FEBio's order: corners, edges below, above and between, faces, centre.
    pub fn solid(&self, shape: CellShape, nodes: &[usize]) -> Vec<usize> {
        let (corners, rest) = nodes.split_at(shape.corners());
        let (sides, centre) = rest.split_at(rest.len().min(shape.corners()));
        let mut solid = Vec::new();
        for layer in [corners, sides] {
            solid.extend(layer.iter().map(|node| self.lower(*node)));
            solid.extend(layer.iter().map(|node| self.upper(*node)));
        }
        if shape.degree() == 2 {
            solid.extend(corners.iter().map(|node| self.middle(*node)));
        }
        for node in centre {
            solid.extend(sides.iter().map(|side| self.middle(*side)));
            solid.extend([self.lower(*node), self.upper(*node), self.middle(*node)]);
        }
        solid
    }

    /// The outer face on an edge, its normal outwards.
    pub fn face(&self, shape: CellShape, edge: &[usize]) -> (&'static str, Vec<usize>) {
        let (a, b) = (edge[0], edge[1]);
        let mut face = vec![self.lower(a), self.lower(b), self.upper(b), self.upper(a)];
        let Some(side) = edge.get(2) else {
            return ("quad4", face);
        };
        face.extend([
            self.lower(*side),
            self.middle(b),
            self.upper(*side),
            self.middle(a),
        ]);
        if shape == CellShape::Quad9 {
            face.push(self.middle(*side));
            return ("quad9", face);
        }
        ("quad8", face)
    }

    /// The shares of a force on a node of the sheet that its column carries: those of a constant traction.
    pub fn shares(&self, model: &Model, node: usize) -> &'static [f64] {
        let nine = model
            .cells
            .iter()
            .all(|(shape, _)| *shape == CellShape::Quad9);
        match self.0[&node].len() {
            2 => &[0.5, 0.5],
            _ if nine => &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
            _ => &[-0.5, 2.0, -0.5],
        }
    }
}
