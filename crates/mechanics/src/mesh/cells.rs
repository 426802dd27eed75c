//! The mesh itself: nodes, cells, named groups and the boundary.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use rayon::prelude::*;

use super::buckets::Buckets;
use super::cell_shape::CellShape;
use super::geometry::{bounding_box, distance, sides};
use super::grid::Grid;

/// A named part of the boundary or of the sheet, or a set of nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// Its nodes, ascending.
    pub nodes: Vec<usize>,
    /// Its edges, if it is a part of the boundary: both ends, then the middle where there is one, with the
    /// specimen to the left.
    pub edges: Vec<Vec<usize>>,
    /// Its lines on the sheet: sides of cells that are not on the boundary, both ends, then the middle where there is one.
    pub lines: Vec<Vec<usize>>,
    /// Its cells, if it is a part of the sheet, ascending.
    pub cells: Vec<usize>,
}

impl Group {
    /// Whether it has edges, lines or cells besides its nodes.
    pub fn has_parts(&self) -> bool {
        !(self.edges.is_empty() && self.lines.is_empty() && self.cells.is_empty())
    }
}

/// An edge of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct CellEdge {
    /// Its ends, ascending.
    pub ends: [usize; 2],
    /// The cell.
    pub cell: usize,
    /// The number of the edge within the cell.
    pub number: usize,
}

/// The neighbours of the cells of a mesh, by the numbers of their edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbours(Vec<[Option<usize>; 4]>);

impl Neighbours {
    /// The neighbours of so many cells, by pairs of edges that are one: each by its cell and its number there.
    pub fn new(cells: usize, pairs: impl Iterator<Item = [(usize, usize); 2]>) -> Self {
        let mut across = vec![[None; 4]; cells];
        for [(one, edge), (other, edge_of_other)] in pairs {
            across[one][edge] = Some(other);
            across[other][edge_of_other] = Some(one);
        }
        Self(across)
    }

    /// The cell on the other side of an edge of a cell; `None` on the boundary.
    pub fn across(&self, cell: usize, edge: usize) -> Option<usize> {
        self.0[cell][edge]
    }
}

/// A flat mesh of triangles and quadrilaterals.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Reference coordinates in mm.
    pub nodes: Vec<[f64; 2]>,
    shapes: Vec<CellShape>,
    starts: Vec<usize>,
    connectivity: Vec<usize>,
    groups: BTreeMap<String, Group>,
    pub(super) grid: Option<Grid>,
    pub(super) buckets: OnceLock<Buckets>,
    pub(super) seams: OnceLock<Option<Neighbours>>,
    boundary: OnceLock<Vec<Vec<usize>>>,
}

impl Mesh {
    /// A mesh of cells with their nodes in the order of [`CellShape::natural_nodes`].
    ///
    /// # Panics
    /// When the number of a cell's nodes is not that of its kind.
    pub fn new(
        nodes: Vec<[f64; 2]>,
        cells: impl IntoIterator<Item = (CellShape, Vec<usize>)>,
    ) -> Self {
        let (mut shapes, mut starts, mut connectivity) = (Vec::new(), vec![0], Vec::new());
        for (shape, nodes) in cells {
            assert_eq!(nodes.len(), shape.nodes(), "nodes of a {shape:?}");
            shapes.push(shape);
            connectivity.extend(nodes);
            starts.push(connectivity.len());
        }
        shapes.shrink_to_fit();
        starts.shrink_to_fit();
        connectivity.shrink_to_fit();
        Self {
            nodes,
            shapes,
            starts,
            connectivity,
            groups: BTreeMap::new(),
            grid: None,
            buckets: OnceLock::new(),
            seams: OnceLock::new(),
            boundary: OnceLock::new(),
        }
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.shapes.len()
    }

    /// The kind of a cell.
    pub fn shape(&self, cell: usize) -> CellShape {
        self.shapes[cell]
    }

    /// The names of the finite elements that the cells are: `Q2`, or `T2 and Q2`.
    pub fn element_names(&self) -> String {
        let kinds = CellShape::NAMES.iter();
        let used = kinds.filter(|(_, kind)| self.shapes.contains(kind));
        let names: Vec<_> = used.map(|(name, _)| *name).collect();
        names.join(" and ")
    }

    /// The degree of its cells, the higher one where there are several.
    pub fn degree(&self) -> usize {
        let degrees = self.shapes.iter().map(|shape| shape.degree());
        degrees.max().unwrap_or(1)
    }

    /// The nodes of a cell, in the order of [`CellShape::natural_nodes`].
    pub fn cell(&self, cell: usize) -> &[usize] {
        &self.connectivity[self.starts[cell]..self.starts[cell + 1]]
    }

    /// The nodes at the corners of a cell.
    pub fn corners(&self, cell: usize) -> &[usize] {
        &self.cell(cell)[..self.shape(cell).corners()]
    }

    /// The groups by name.
    pub fn groups(&self) -> &BTreeMap<String, Group> {
        &self.groups
    }

    /// Names a group of nodes. The boundary edges within it belong to it; where not all of its nodes are on the
    /// boundary, so do the cells within it and their sides.
    pub fn name_nodes(&mut self, name: &str, nodes: &BTreeSet<usize>) {
        let within = |part: &[usize]| part.iter().all(|node| nodes.contains(node));
        let outer: BTreeSet<usize> = self.boundary().iter().flatten().copied().collect();
        let edges = self.boundary().iter().filter(|edge| within(edge));
        let mut group = Group {
            nodes: nodes.iter().copied().collect(),
            edges: edges.cloned().collect(),
            ..Group::default()
        };
        if !nodes.is_subset(&outer) {
            group.lines = self.inner_sides();
            group.lines.retain(|side| within(side));
            let cells = 0..self.cell_count();
            group.cells = cells.filter(|cell| within(self.cell(*cell))).collect();
        }
        self.put_group(name, group);
    }

    /// Names the part of the boundary whose edges have all nodes where `inside` holds.
    pub fn name_boundary(&mut self, name: &str, inside: impl Fn([f64; 2]) -> bool) {
        let within = |edge: &&Vec<usize>| edge.iter().all(|node| inside(self.nodes[*node]));
        let edges = self.boundary().iter().filter(within).cloned().collect();
        self.name_edges(name, edges);
    }

    /// Names a group of boundary edges.
    pub fn name_edges(&mut self, name: &str, edges: Vec<Vec<usize>>) {
        let group = Group {
            edges,
            ..Group::default()
        };
        self.put_group(name, group);
    }

    /// Names a group, to which the nodes of its edges, lines and cells belong.
    pub(super) fn put_group(&mut self, name: &str, mut group: Group) {
        let of_cells = group.cells.iter().flat_map(|cell| self.cell(*cell));
        let of_sides = group.edges.iter().chain(&group.lines).flatten();
        group.nodes.extend(of_cells.chain(of_sides));
        group.nodes.sort_unstable();
        group.nodes.dedup();
        self.groups.insert(name.to_owned(), group);
    }

    /// The edges that belong to one cell alone, each with the specimen to its left.
    pub fn boundary(&self) -> &[Vec<usize>] {
        self.boundary
            .get_or_init(|| self.sides_of(|cells| cells == 1))
    }

    /// The sides that cells share.
    pub(super) fn inner_sides(&self) -> Vec<Vec<usize>> {
        self.sides_of(|cells| cells > 1)
    }

    /// The sides shared by a wanted number of cells, each with the first of them to its left.
    fn sides_of(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let edges = self.edges();
        let sides = edges.chunk_by(|one, other| one.ends == other.ends);
        let wanted = sides.filter(|cells| is_wanted(cells.len()));
        wanted.map(|cells| self.edge_nodes(cells[0])).collect()
    }

    /// The edges of all cells by their ends, with those of neighbouring cells one after the other.
    pub fn edges(&self) -> Vec<CellEdge> {
        let mut edges = Vec::with_capacity(4 * self.cell_count());
        for cell in 0..self.cell_count() {
            let nodes = self.cell(cell);
            for (number, local) in self.shape(cell).edges().iter().enumerate() {
                let [a, b] = [nodes[local[0]], nodes[local[1]]];
                let ends = [a.min(b), a.max(b)];
                edges.push(CellEdge { ends, cell, number });
            }
        }
        edges.par_sort_unstable();
        edges
    }

    /// Both ends of an edge of a cell, then the middle where there is one, with the cell to the left.
    pub(super) fn edge_nodes(&self, edge: CellEdge) -> Vec<usize> {
        let nodes = self.cell(edge.cell);
        let local = self.shape(edge.cell).edge(edge.number).into_iter();
        local.map(|node| nodes[node]).collect()
    }

    /// Centre of a cell in mm: the mean of its corners.
    pub fn centre(&self, cell: usize) -> [f64; 2] {
        let corners = self.corners(cell);
        [0, 1].map(|axis| {
            let sum: f64 = corners.iter().map(|node| self.nodes[*node][axis]).sum();
            sum / corners.len() as f64
        })
    }

    /// Lower left and upper right corner of the box around all nodes, in mm.
    pub fn bounding_box(&self) -> [[f64; 2]; 2] {
        bounding_box(self.nodes.iter().copied())
    }

    /// Sides of the box around all nodes, in mm.
    pub fn size(&self) -> [f64; 2] {
        sides(self.nodes.iter().copied())
    }

    /// Length of the diagonal of the box around all nodes, in mm.
    pub fn diagonal(&self) -> f64 {
        let [low, high] = self.bounding_box();
        distance(low, high)
    }

    /// Middle of the box around all nodes, in mm.
    pub fn middle(&self) -> [f64; 2] {
        let [low, high] = self.bounding_box();
        [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]))
    }

    /// `node 12 (35.0, 7.3) mm along x`, for messages.
    pub fn describe_unknown(&self, unknown: usize) -> String {
        let [x, y] = self.nodes[unknown / 2];
        let (node, axis) = (unknown / 2, ["x", "y"][unknown % 2]);
        let decimals = decimals_for(0.1 * self.diagonal());
        format!("node {node} ({x:.decimals$}, {y:.decimals$}) mm along {axis}")
    }

    /// `cell 80 near (150.0, 0.0) mm`, for messages.
    pub fn describe_cell(&self, cell: usize) -> String {
        let [x, y] = self.centre(cell);
        let decimals = decimals_for(self.cell_area(cell).sqrt());
        format!("cell {cell} near ({x:.decimals$}, {y:.decimals$}) mm")
    }
}

/// The decimals that distinguish positions on bodies, or cells, of a size in mm: one for sizes of a tenth and larger.
pub fn decimals_for(size: f64) -> usize {
    (-size.log10().floor()).clamp(1.0, 9.0) as usize
}
