//! Parts of the boundary that lie on each other: the two faces of a slit, bodies that touch.
//!
//! A position on them belongs to cells of both sides, whose displacements differ. The node of another mesh is found from the side of its own cells:
//! from the centre of one of them, cell by cell without crossing the boundary, to the node.

use super::cells::{Mesh, Neighbours};
use super::interpolation::CellPoint;

/// A node of the boundary this far inside or outside of a cell that is not its own, in natural coordinates, lies on it.
const ON_CELL: f64 = 0.02;
/// A position this far outside of a cell, in natural coordinates, is in it.
const ROUNDING: f64 = 1e-9;

impl Mesh {
    /// The positions of another mesh's nodes, both of the same specimen, where parts of the boundary lie on each other; `None` where none do.
    pub(super) fn positions_by_side_of_seam(&self, other: &Self) -> Option<Vec<CellPoint>> {
        let neighbours = self
            .seams
            .get_or_init(|| self.seamed_neighbours())
            .as_ref()?;
        let mut cell_of = vec![None; other.nodes.len()];
        for cell in 0..other.cell_count() {
            for node in other.cell(cell) {
                cell_of[*node] = Some(cell);
            }
        }
        let mut on_boundary = vec![false; other.nodes.len()];
        for node in other.boundary().iter().flatten() {
            on_boundary[*node] = true;
        }
        let position = |node: usize| match cell_of[node].filter(|_| on_boundary[node]) {
            Some(cell) => {
                let (start, _) = self.locate(other.centre(cell));
                self.walk(neighbours, start, other.nodes[node])
            }
            None => self.locate(other.nodes[node]),
        };
        Some((0..other.nodes.len()).map(position).collect())
    }

    /// The neighbours of all cells where a node of the boundary lies on a cell that is not its own.
    fn seamed_neighbours(&self) -> Option<Neighbours> {
        // The cells of a grid are joined.
        if self.grid.is_some() {
            return None;
        }
        let mut nodes = self.boundary().iter().flatten();
        let is_seamed = nodes.any(|node| self.lies_on_others(*node, -ON_CELL));
        is_seamed.then(|| self.neighbours())
    }

    /// The neighbours of all cells.
    pub(super) fn neighbours(&self) -> Neighbours {
        let edges = self.edges();
        let pairs = edges.windows(2).filter(|pair| pair[0].ends == pair[1].ends);
        let pairs = pairs.map(|pair| [0, 1].map(|i| (pair[i].cell, pair[i].number)));
        Neighbours::new(self.cell_count(), pairs)
    }

    /// Whether a node lies in a cell that is not its own, deeper than `depth` in natural coordinates.
    fn lies_on_others(&self, node: usize, depth: f64) -> bool {
        let has_node = |cell: usize| self.cell(cell).contains(&node);
        self.holds_inside(self.nodes[node], depth, has_node)
    }

    /// The position at rest of a node of the boundary that a displacement moves into a cell which is not its own, deeper than `depth` in natural
    /// coordinates: there the mesh overlaps itself.
    pub fn overlap(&self, displacement: &[f64], depth: f64) -> Option<[f64; 2]> {
        let moved = |(node, [x, y]): (usize, &[f64; 2])| {
            [x + displacement[2 * node], y + displacement[2 * node + 1]]
        };
        let nodes = self.nodes.iter().enumerate().map(moved);
        let cells = (0..self.cell_count()).map(|cell| (self.shape(cell), self.cell(cell).to_vec()));
        let deformed = Self::new(nodes.collect(), cells);
        let mut boundary = self.boundary().iter().flatten();
        let overlapping = boundary.find(|node| deformed.lies_on_others(**node, depth));
        overlapping.map(|node| self.nodes[*node])
    }

    /// The cell of a position, reached from another cell across sides that cells share; beside the boundary, the nearest cell on the way.
    fn walk(&self, neighbours: &Neighbours, from: usize, point: [f64; 2]) -> CellPoint {
        let (mut cell, mut visited) = (from, vec![from]);
        let mut nearest: Option<(f64, CellPoint)> = None;
        loop {
            if let Some(local) = self.natural_coordinates(cell, point) {
                let outside = self.shape(cell).outside(local);
                if outside < ROUNDING {
                    return (cell, local);
                }
                if nearest.as_ref().is_none_or(|(least, _)| outside < *least) {
                    nearest = Some((outside, (cell, local)));
                }
            }
            let towards = self.edges_towards(cell, point).into_iter();
            let next = towards.filter_map(|edge| neighbours.across(cell, edge));
            let Some(next) = next.into_iter().find(|next| !visited.contains(next)) else {
                break;
            };
            visited.push(next);
            cell = next;
        }
        nearest.map_or_else(|| self.locate(point), |(_, position)| position)
    }

    /// The edges of a cell beyond whose chords a point lies, those it is farthest from first.
    fn edges_towards(&self, cell: usize, point: [f64; 2]) -> Vec<usize> {
        let centre = self.centre(cell);
        let edges = self.shape(cell).edges().into_iter().enumerate();
        let crossed = edges.filter_map(|(number, edge)| {
            let [a, b] = [edge[0], edge[1]].map(|node| self.nodes[self.cell(cell)[node]]);
            let along = [b[0] - a[0], b[1] - a[1]];
            let side = |position: [f64; 2]| {
                along[0] * (position[1] - a[1]) - along[1] * (position[0] - a[0])
            };
            // Positive beyond the chord, whichever way the cell is numbered.
            let distance = -side(point) * side(centre).signum() / along[0].hypot(along[1]);
            (distance > 0.0).then_some((distance, number))
        });
        let mut crossed: Vec<(f64, usize)> = crossed.collect();
        crossed.sort_by(|one, other| other.0.total_cmp(&one.0));
        crossed.into_iter().map(|(_, number)| number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellShape;

    /// Two plates of 4 × 1 mm, the upper one on the lower, with nodes of their own from `x = slit` on; shifted and turned.
    fn slit(cells: [usize; 2], (shape, is_split): (CellShape, bool), slit: f64) -> Mesh {
        let plate = Mesh::plate([4.0, 2.0], cells, shape);
        let is_upper = |cell: usize| plate.centre(cell)[1] > 1.0;
        let is_doubled = |[x, y]: [f64; 2]| (y - 1.0).abs() < 1e-12 && x > slit;
        let mut nodes = plate.nodes.clone();
        let twin: Vec<usize> = plate
            .nodes
            .iter()
            .enumerate()
            .map(|(node, position)| {
                if is_doubled(*position) {
                    nodes.push(*position);
                    nodes.len() - 1
                } else {
                    node
                }
            })
            .collect();
        let cells = (0..plate.cell_count()).map(|cell| {
            let corners = plate.cell(cell).iter();
            let corners = corners.map(|node| if is_upper(cell) { twin[*node] } else { *node });
            (plate.shape(cell), corners.collect::<Vec<usize>>())
        });
        let halves = |(kind, corners): (CellShape, Vec<usize>)| match corners[..] {
            [a, b, c, d] if is_split => vec![
                (CellShape::Triangle3, vec![a, b, c]),
                (CellShape::Triangle3, vec![a, c, d]),
            ],
            _ => vec![(kind, corners)],
        };
        let cells: Vec<_> = cells.flat_map(halves).collect();
        let turned = |[x, y]: [f64; 2]| [700.0 + 0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y];
        Mesh::new(nodes.into_iter().map(turned).collect(), cells)
    }

    /// The upper plate moves up, and the lower one down.
    fn opened(mesh: &Mesh) -> Vec<f64> {
        let mut field = vec![0.0; 2 * mesh.nodes.len()];
        for cell in 0..mesh.cell_count() {
            let [x, y] = mesh.centre(cell);
            let upper = -0.6 * (x - 700.0) + 0.8 * y > 1.0;
            for node in mesh.cell(cell) {
                field[2 * node + 1] = if upper { 1.0 } else { -1.0 };
            }
        }
        field
    }

    #[test]
    fn fields_are_taken_from_the_own_side_of_a_seam() {
        let (bilinear, triangles) = ((CellShape::Quad4, false), (CellShape::Quad4, true));
        for shape in [bilinear, triangles, (CellShape::Quad9, false)] {
            // All nodes of the seam are doubled: two bodies that touch.
            let [coarse, fine] = [[4, 2], [12, 6]].map(|cells| slit(cells, shape, -1.0));
            for (from, to) in [(&coarse, &fine), (&fine, &coarse), (&fine, &fine)] {
                let computed = from.displacement_on(&opened(from), to);
                assert_eq!(from.interpolation_on(to).apply(&opened(from)), computed);
                for (computed, expected) in computed.iter().zip(opened(to)) {
                    assert!((computed - expected).abs() < 1e-12, "{shape:?}");
                }
            }
        }
    }

    #[test]
    fn slits_are_seams_and_joined_cells_are_not() {
        let is_seamed = |mesh: &Mesh| mesh.positions_by_side_of_seam(mesh).is_some();
        assert!(is_seamed(&slit([8, 4], (CellShape::Quad9, false), 2.2)));
        assert!(!is_seamed(&slit([8, 4], (CellShape::Quad9, false), 9.0)));
        assert!(!is_seamed(&Mesh::plate(
            [3.0, 1.0],
            [3, 2],
            CellShape::Quad4
        )));
    }
}
