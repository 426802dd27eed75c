//! A climbed field as a deformed sheet on a mesh.

use std::sync::Arc;

use super::{Climb, ClimbSolution, Field, Grid};
use crate::corrector::DifferenceScheme;
use crate::mesh::{CellShape, Mesh};
use crate::problem::DeformedSheet;

impl Climb<'_> {
    /// A climbed field, to be evaluated at any point of the plate. Its cells are those of the difference scheme, its nodes in the order of
    /// [`Field::to_nodes`](super::Field::to_nodes), and its groups the sides `left`, `right`, `bottom`, `top`; nine-node cells pass
    /// through the bicubic scheme's field at further nodes half way between the grid's.
    pub fn deformed(&self, climbed: &ClimbSolution) -> DeformedSheet {
        let (grid, field) = self.grid().with_cells(&climbed.field);
        let law = Arc::clone(&self.problem.law);
        DeformedSheet::new(grid.mesh(grid.degree), field.to_nodes(), law)
    }
}

/// The displacements at the nodes of [`DifferenceScheme::mesh`] from those at the nodes of a plate's mesh of four-node cells: ux, uy of
/// node after node.
pub fn between_nodes(scheme: DifferenceScheme, mesh: &Mesh, displacement: &[f64]) -> Vec<f64> {
    let lines = mesh.grid();
    let grid = Grid {
        coordinates: [0, 1].map(|axis| lines.lines(axis)),
        degree: scheme.side(),
    };
    let field = Field::of_nodes(&grid, displacement);
    grid.with_cells(&field).1.to_nodes()
}

impl Grid {
    /// The grid, and a field on it, whose elements are cells of meshes: with further lines half way between the grid's where they are cubic.
    fn with_cells(&self, field: &Field) -> (Self, Field) {
        if !self.has_cubics() {
            return (self.clone(), field.clone());
        }
        let lines = self.coordinates.each_ref().map(|positions| &positions[..]);
        let halved = Self::new(lines, 2);
        let between = field.onto(self, &halved);
        (halved, between)
    }

    /// The mesh of cells with `side` spans of the grid along each axis, one (four nodes) or two (nine nodes).
    pub(super) fn mesh(&self, side: usize) -> Mesh {
        let shape = [CellShape::Quad4, CellShape::Quad9][side - 1];
        Mesh::of_lines(&self.coordinates, shape)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::corrector::climb::ClimbSettings;
    use crate::material::Card;
    use crate::problem::ClampedPlate;

    /// On few elements the sheet of the bicubic scheme is what the scheme takes its field for at any point; nodes of others are kept.
    #[test]
    fn the_sheet_of_a_bicubic_field_passes_through_its_cubics() {
        let card = Card::load("neo-hooke", Path::new(".")).unwrap();
        let problem = ClampedPlate {
            size: [30.0, 12.0],
            thickness: 1.0,
            law: card.law,
            stretches: vec![0.3],
        };
        let scheme = DifferenceScheme::Bicubic;
        let mut climb = Climb::graded(&problem, [12, 6], scheme, 2.0, ClimbSettings::FAST);
        let mut climbed = climb.correct(0.3).unwrap();
        let grid = climb.grid().clone();
        let cubic = |[x, y]: [f64; 2]| {
            [
                0.01 * x + 1e-4 * x * x * y,
                2e-4 * x * y * y - 1e-5 * y.powi(3),
            ]
        };
        let [x, y] = &grid.coordinates;
        let positions = x.iter().flat_map(|x| y.iter().map(|y| cubic([*x, *y])));
        let values: Vec<f64> = positions.flatten().collect();
        climbed.field = Field::of_nodes(&grid, &values);
        let sheet = climb.deformed(&climbed);
        for (position, u) in sheet
            .mesh()
            .nodes
            .iter()
            .zip(sheet.displacement().chunks_exact(2))
        {
            let expected = cubic(*position);
            assert!(
                (0..2).all(|axis| (u[axis] - expected[axis]).abs() < 1e-13),
                "{position:?}"
            );
        }
        assert_eq!(sheet.mesh().cell_count(), 12 * 6);
    }

    #[test]
    fn the_mesh_of_an_even_grid_is_that_of_the_plate() {
        for (side, shape) in [(1, CellShape::Quad4), (2, CellShape::Quad9)] {
            let mesh = Grid::even([30.0, 10.0], [6, 4]).mesh(side);
            let plate = Mesh::plate([30.0, 10.0], [6 / side, 4 / side], shape);
            assert_eq!(mesh.nodes, plate.nodes);
            assert_eq!(mesh.groups(), plate.groups());
            assert!((0..mesh.cell_count()).all(|cell| mesh.cell(cell) == plate.cell(cell)));
        }
    }
}
