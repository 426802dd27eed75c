//! Meshes of curved blocks: each block is the image of the unit square.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::cell_shape::CellShape;
use super::cells::Mesh;

/// A part of a specimen that is the image of the unit square.
pub struct Block<'a> {
    /// The image in mm of a point (s, t) of the unit square; must keep the orientation.
    pub map: Box<dyn Fn([f64; 2]) -> [f64; 2] + 'a>,
    /// Cells along s and t.
    pub cells: [usize; 2],
    /// Names of the sides t = 0, s = 1, t = 1 and s = 0; a side with an empty name belongs to no group.
    pub sides: [&'a str; 4],
}

/// Merges the blocks where they touch; neighbours must have the same number of cells along a common side.
///
/// Triangles are made by halving quadrilaterals along diagonals that alternate. Nodes in the middle of an
/// edge lie on the image of the block, so that curved edges are curved.
///
/// # Panics
/// When a block has no cells.
pub fn mesh_of_blocks(blocks: &[Block], shape: CellShape) -> Mesh {
    let mut builder = Builder::new(blocks);
    for block in blocks {
        builder.add(block, shape);
    }
    let mut mesh = Mesh::new(builder.nodes, builder.cells);
    for (name, nodes) in &builder.groups {
        mesh.name_nodes(name, nodes);
    }
    mesh
}

struct Builder {
    nodes: Vec<[f64; 2]>,
    cells: Vec<(CellShape, Vec<usize>)>,
    groups: BTreeMap<String, BTreeSet<usize>>,
    /// The nodes on the sides of blocks by the square of a fine grid that they lie in.
    squares: HashMap<[i64; 2], usize>,
    /// Side of such a square in mm: nodes nearer to each other than this are one.
    fine: f64,
}

impl Builder {
    fn new(blocks: &[Block]) -> Self {
        let corners = blocks.iter().flat_map(|block| {
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|corner| (block.map)(corner))
        });
        let size = corners
            .flatten()
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        Self {
            nodes: Vec::new(),
            cells: Vec::new(),
            groups: BTreeMap::new(),
            squares: HashMap::new(),
            fine: 1e-8 * size.max(f64::MIN_POSITIVE),
        }
    }

    /// The node at a position, a new one where there is none.
    fn node(&mut self, position: [f64; 2]) -> usize {
        let square = position.map(|x| (x / self.fine).round() as i64);
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            if let Some(node) = self.squares.get(&[square[0] + dx, square[1] + dy]) {
                return *node;
            }
        }
        let node = self.inner_node(position);
        self.squares.insert(square, node);
        node
    }

    /// The node at a position inside of a block, where no other block has one.
    fn inner_node(&mut self, position: [f64; 2]) -> usize {
        self.nodes.push(position);
        self.nodes.len() - 1
    }

    fn add(&mut self, block: &Block, shape: CellShape) {
        let [nx, ny] = block.cells;
        assert!(nx > 0 && ny > 0, "a block of cells");
        // A grid of half cells contains every node of every kind of cell.
        let mut grid = vec![None; (2 * nx + 1) * (2 * ny + 1)];
        let mut at = |builder: &mut Self, i: usize, j: usize| {
            let known = &mut grid[i * (2 * ny + 1) + j];
            if let Some(node) = known {
                return *node;
            }
            let position = (block.map)([i as f64 / (2 * nx) as f64, j as f64 / (2 * ny) as f64]);
            let sides = [j == 0, i == 2 * nx, j == 2 * ny, i == 0];
            let node = if sides.contains(&true) {
                builder.node(position)
            } else {
                builder.inner_node(position)
            };
            *known = Some(node);
            for (name, on) in block.sides.iter().zip(sides) {
                if on && !name.is_empty() {
                    builder
                        .groups
                        .entry((*name).to_owned())
                        .or_default()
                        .insert(node);
                }
            }
            node
        };
        for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
            for corners in pieces(shape, (i + j) % 2 == 0) {
                let nodes = positions(shape, &corners).into_iter();
                let nodes = nodes.map(|[x, y]| at(self, 2 * i + x, 2 * j + y)).collect();
                self.cells.push((shape, nodes));
            }
        }
    }
}

/// Corners of the cells that a square of 2 × 2 half cells is cut into.
fn pieces(shape: CellShape, rising: bool) -> Vec<Vec<[usize; 2]>> {
    let [a, b, c, d] = [[0, 0], [2, 0], [2, 2], [0, 2]];
    match (shape.is_triangle(), rising) {
        (false, _) => vec![vec![a, b, c, d]],
        (true, true) => vec![vec![a, b, c], vec![a, c, d]],
        (true, false) => vec![vec![a, b, d], vec![b, c, d]],
    }
}

/// All nodes of a cell from its corners.
fn positions(shape: CellShape, corners: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut positions = corners.to_vec();
    if shape.degree() == 2 {
        for i in 0..corners.len() {
            let (from, to) = (corners[i], corners[(i + 1) % corners.len()]);
            positions.push([0, 1].map(|axis| (from[axis] + to[axis]) / 2));
        }
    }
    if shape == CellShape::Quad9 {
        positions.push([1, 1]);
    }
    positions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_merged_and_their_sides_named() {
        for (_, shape) in CellShape::NAMES {
            let block = |left: f64, sides| Block {
                map: Box::new(move |[s, t]| [left + s, 2.0 * t]),
                cells: [2, 2],
                sides,
            };
            let blocks = [
                block(0.0, ["bottom", "", "", "left"]),
                block(1.0, ["bottom", "right", "", ""]),
            ];
            let mesh = mesh_of_blocks(&blocks, shape);
            let area = mesh.area();
            assert!((area - 4.0).abs() < 1e-13, "{shape:?}: {area}");
            let lines = 2 * shape.degree() + 1;
            assert_eq!(mesh.groups()["left"].nodes.len(), lines, "{shape:?}");
            assert_eq!(
                mesh.groups()["bottom"].nodes.len(),
                2 * lines - 1,
                "{shape:?}"
            );
            assert_eq!(mesh.groups()["bottom"].edges.len(), 4, "{shape:?}");
            let bottom = &mesh.groups()["bottom"].edges[0];
            assert!(
                mesh.nodes[bottom[1]][0] > mesh.nodes[bottom[0]][0],
                "the specimen is to the left"
            );
        }
    }

    #[test]
    fn points_are_found_in_curved_cells_and_beside_them() {
        let ring = Block {
            map: Box::new(|[s, t]: [f64; 2]| {
                let (sine, cosine) = (2.0 * s).sin_cos();
                [-(1.0 + t) * cosine, (1.0 + t) * sine]
            }),
            cells: [6, 3],
            sides: ["inside", "", "outside", ""],
        };
        let mesh = mesh_of_blocks(&[ring], CellShape::Quad9);
        let field = |[x, y]: [f64; 2]| [x - 2.0 * y, 0.5 * x + y];
        let u: Vec<f64> = mesh.nodes.iter().flat_map(|node| field(*node)).collect();
        for (angle, radius) in [(0.1_f64, 1.2), (1.0, 1.5), (1.9, 1.99), (0.77, 1.01)] {
            let point = [-radius * angle.cos(), radius * angle.sin()];
            let (cell, local) = mesh.locate(point);
            assert!(mesh.shape(cell).outside(local) < 1e-9, "{point:?}");
            let (interpolated, exact) = (mesh.displacement_at(&u, point), field(point));
            assert!((interpolated[0] - exact[0]).hypot(interpolated[1] - exact[1]) < 1e-12);
        }
        // A little outside: the nearest cell is used.
        let (cell, local) = mesh.locate([-2.01 * 0.2_f64.cos(), 2.01 * 0.2_f64.sin()]);
        assert!(mesh.shape(cell).outside(local) < 0.1);
    }
}
