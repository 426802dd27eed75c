//! A climbed field as a deformed sheet on a mesh.

use std::sync::Arc;

use super::{Climb, ClimbSolution, Grid};
use crate::mesh::{CellShape, Mesh, Side};
use crate::problem::DeformedSheet;

impl Climb<'_> {
    /// The mesh of the finest grid: its nodes in the order of [`Field::to_nodes`](super::Field::to_nodes), its cells
    /// those of the difference scheme, its groups the sides `left`, `right`, `bottom`, `top`.
    pub fn mesh(&self) -> Mesh {
        self.grid().mesh(self.scheme.side())
    }

    /// A climbed field, to be evaluated at any point of the plate.
    pub fn deformed(&self, climbed: &ClimbSolution) -> DeformedSheet {
        let law = Arc::clone(&self.problem.law);
        DeformedSheet::new(self.mesh(), climbed.field.to_nodes(), law)
    }
}

impl Grid {
    /// The mesh of cells with `side` spans of the grid along each axis, one (four nodes) or two (nine nodes).
    fn mesh(&self, side: usize) -> Mesh {
        let [x, y] = &self.coordinates;
        let nodes = x.iter().flat_map(|x| y.iter().map(|y| [*x, *y])).collect();
        let shape = [CellShape::Quad4, CellShape::Quad9][side - 1];
        let steps = |axis: usize| (0..self.cells()[axis]).step_by(side);
        let cells = steps(0).flat_map(|i| steps(1).map(move |j| [i, j]));
        let mut mesh = Mesh::new(
            nodes,
            cells.map(|[i, j]| {
                let node = |[a, b]: &[f64; 2]| {
                    let step = |natural: f64| ((natural + 1.0) * side as f64 / 2.0) as usize;
                    (i + step(*a)) * y.len() + j + step(*b)
                };
                (shape, shape.natural_nodes().iter().map(node).collect())
            }),
        );
        let last = [x, y].map(|places| places[places.len() - 1]);
        for (side, axis, at) in [
            (Side::Left, 0, 0.0),
            (Side::Right, 0, last[0]),
            (Side::Bottom, 1, 0.0),
            (Side::Top, 1, last[1]),
        ] {
            mesh.name_boundary(side.name(), |place| place[axis] == at);
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mesh_of_an_even_grid_is_that_of_the_plate() {
        for (side, shape) in [(1, CellShape::Quad4), (2, CellShape::Quad9)] {
            let own = Grid::even([30.0, 10.0], [6, 4]).mesh(side);
            let plate = Mesh::plate([30.0, 10.0], [6 / side, 4 / side], shape);
            assert_eq!(own.nodes, plate.nodes);
            assert_eq!(own.groups(), plate.groups());
            assert!((0..own.cell_count()).all(|cell| own.cell(cell) == plate.cell(cell)));
        }
    }
}
