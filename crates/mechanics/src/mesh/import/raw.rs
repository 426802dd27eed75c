//! What files hold before it is a flat mesh.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use super::sides::name_sides;
use crate::document::file;
use crate::mesh::cell_shape::CellShape;
use crate::mesh::cells::{Group, Mesh};
use crate::mesh::geometry::{check_size, polygon_area};
use crate::mesh::refine::key;

/// Why the contents of a file of another program cannot be read, as a predicate that follows the file's name: "is cut off".
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct ImportFault {
    pub(super) reason: String,
    /// The remedy, where it is not to give another file.
    pub remedy: Option<String>,
}

impl From<String> for ImportFault {
    fn from(reason: String) -> Self {
        Self {
            reason,
            remedy: None,
        }
    }
}

impl From<&str> for ImportFault {
    fn from(reason: &str) -> Self {
        reason.to_owned().into()
    }
}

/// Displacements by the file's own number of the node.
pub type Displacements = HashMap<u64, [f64; 2]>;

/// A step of a field: its time, where the file states it, and its displacements.
pub type Step = (Option<f64>, Displacements);

/// What a file holds, before it is a flat mesh: positions in the file's unit, and elements by their kinds.
#[derive(Default)]
pub struct Raw {
    /// Positions by the file's own number.
    pub positions: HashMap<u64, [f64; 3]>,
    /// Cells in the order of the file.
    pub cells: Vec<(CellShape, Vec<u64>)>,
    /// Ends of lines, and points, by the name of their group.
    pub lines: BTreeMap<String, Vec<[u64; 2]>>,
    pub points: BTreeMap<String, Vec<u64>>,
    /// Nodes by the name of their group, to which the edges between them belong.
    pub sets: BTreeMap<String, Vec<u64>>,
    /// Numbers of cells by the name of their group.
    pub areas: BTreeMap<String, Vec<usize>>,
    /// Whether elements are stated to be of plane strain.
    pub is_plane_strain: bool,
}

/// The bytes of a file.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, ImportFault> {
    let bytes = file::read_bytes(path, file::MOST_OF_DATA);
    bytes.map_err(|fault| format!("cannot be read: {fault}").into())
}

/// The text of a file.
pub fn read_text(path: &Path) -> Result<String, ImportFault> {
    String::from_utf8(read_bytes(path)?).map_err(|_| BINARY.into())
}

pub const BINARY: &str = "is a binary file; save it as ASCII (Mesh.Binary = 0 in Gmsh) or as .vtu";

impl Raw {
    /// The nodes of the cells, in the order that they have in the mesh.
    pub fn used(&self) -> BTreeSet<u64> {
        let nodes = self.cells.iter().flat_map(|(_, nodes)| nodes);
        nodes.copied().collect()
    }

    /// Makes triangles of quadrilaterals that have one corner twice, as some codes write them; where sides have nodes in their middle, that of
    /// the side without a length is the corner too.
    pub fn collapse_quadrilaterals(&mut self) {
        for (shape, nodes) in &mut self.cells {
            let corners = 4.min(nodes.len());
            let doubled = (0..corners).filter(|at| nodes[*at] == nodes[(at + 1) % corners]);
            let sides: Vec<usize> = doubled.collect();
            let [side] = sides[..] else {
                continue;
            };
            match shape {
                CellShape::Quad4 => *shape = CellShape::Triangle3,
                CellShape::Quad8 if nodes[4 + side] == nodes[side] => {
                    nodes.remove(4 + side);
                    *shape = CellShape::Triangle6;
                }
                _ => continue,
            }
            nodes.remove(side);
        }
    }

    /// Makes nodes that are not farther from each other than a tolerance, in the file's unit, one.
    pub fn merge_nodes(&mut self, tolerance: f64) {
        let mut squares: HashMap<[i64; 2], Vec<u64>> = HashMap::new();
        let mut merged: HashMap<u64, u64> = HashMap::new();
        for name in self.used() {
            let Some([x, y, _]) = self.positions.get(&name) else {
                continue;
            };
            // Beyond 2⁵³ squares numbers are no longer told apart.
            let [i, j] = [x, y].map(|x| (x / tolerance).clamp(-9e15, 9e15).floor() as i64);
            let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
            let others = around.filter_map(|square| squares.get(&square)).flatten();
            let near = |other: &&u64| {
                let [a, b, _] = self.positions[*other];
                (a - x).hypot(b - y) <= tolerance
            };
            match others.filter(near).min() {
                Some(first) => {
                    merged.insert(name, *first);
                }
                None => squares.entry([i, j]).or_default().push(name),
            }
        }
        let cells = self.cells.iter_mut().flat_map(|(_, nodes)| nodes);
        let lines = self.lines.values_mut().flatten().flatten();
        let points = self.points.values_mut().chain(self.sets.values_mut());
        for node in cells.chain(lines).chain(points.flatten()) {
            *node = merged.get(node).copied().unwrap_or(*node);
        }
    }

    pub fn mesh(self, unit: f64) -> Result<Mesh, ImportFault> {
        if self.cells.is_empty() {
            return Err("contains no triangles or quadrilaterals".into());
        }
        let (nodes, names) = self.nodes(unit)?;
        let sized = check_size(nodes.iter().copied());
        sized.map_err(|measures| format!("has nodes that {measures}"))?;
        let cells: Vec<_> = self
            .cells
            .iter()
            .map(|(shape, cell)| {
                let cell: Vec<usize> = cell.iter().map(|name| names[name]).collect();
                (*shape, counter_clockwise(*shape, cell, &nodes))
            })
            .collect();
        let mut mesh = Mesh::new(nodes, cells);
        name_sides(&mut mesh);
        self.name_points(&mut mesh, &names);
        self.name_lines(&mut mesh, &names);
        self.name_sets(&mut mesh, &names)?;
        self.name_areas(&mut mesh);
        Ok(mesh)
    }

    /// The nodes of the cells in mm, and their numbers in the mesh by those of the file.
    fn nodes(&self, unit: f64) -> Result<(Vec<[f64; 2]>, Numbers), ImportFault> {
        let (mut nodes, mut names) = (Vec::new(), HashMap::new());
        let mut height: Option<f64> = None;
        let used = self.used();
        let positions = used.iter().filter_map(|name| self.positions.get(name));
        let coordinates = positions.flat_map(|[x, y, _]| [x.abs(), y.abs()]);
        let largest = coordinates.fold(0.0, f64::max);
        for name in used {
            let Some([x, y, z]) = self.positions.get(&name) else {
                return Err(
                    format!("has a cell with the node {name}, which it does not contain").into(),
                );
            };
            if [x, y, z].iter().any(|x| !x.is_finite()) {
                return Err(format!("has the node {name} at a place that is not a number").into());
            }
            let plane = *height.get_or_insert(*z);
            if (z - plane).abs() > 1e-9 * largest {
                return Err(format!(
                    "is not flat: the node {name} lies at z = {z}, others at {plane}; a sheet lies in the plane of x and y"
                )
                .into());
            }
            names.insert(name, nodes.len());
            nodes.push([unit * x, unit * y]);
        }
        Ok((nodes, names))
    }

    fn name_points(&self, mesh: &mut Mesh, names: &Numbers) {
        for (name, ends) in &self.points {
            let nodes = ends.iter().filter_map(|node| names.get(node).copied());
            let nodes: Vec<usize> = nodes.collect();
            if !nodes.is_empty() {
                let group = Group {
                    nodes,
                    ..Group::default()
                };
                mesh.put_group(name, group);
            }
        }
    }

    /// Names parts of the boundary and lines on the sheet; points of the same name belong to them.
    fn name_lines(&self, mesh: &mut Mesh, names: &Numbers) {
        if self.lines.is_empty() {
            return;
        }
        let inner = mesh.inner_sides();
        for (name, lines) in &self.lines {
            let ends = lines
                .iter()
                .filter_map(|[a, b]| Some([*names.get(a)?, *names.get(b)?]));
            let ends: BTreeSet<[usize; 2]> = ends.map(|[a, b]| key(a, b)).collect();
            let on_lines = |sides: &[Vec<usize>]| -> Vec<Vec<usize>> {
                let named = |side: &&Vec<usize>| ends.contains(&key(side[0], side[1]));
                sides.iter().filter(named).cloned().collect()
            };
            let points = self.points.get(name).into_iter().flatten();
            let group = Group {
                nodes: points.filter_map(|node| names.get(node).copied()).collect(),
                edges: on_lines(mesh.boundary()),
                lines: on_lines(&inner),
                ..Group::default()
            };
            if group.has_parts() {
                mesh.put_group(name, group);
            }
        }
    }

    fn name_sets(&self, mesh: &mut Mesh, names: &Numbers) -> Result<(), ImportFault> {
        for (name, set) in &self.sets {
            let nodes = set.iter().filter_map(|node| names.get(node).copied());
            let nodes: BTreeSet<usize> = nodes.collect();
            if nodes.is_empty() {
                return Err(format!("has the group `{name}` without a node of its cells").into());
            }
            mesh.name_nodes(name, &nodes);
        }
        Ok(())
    }

    /// Names parts of the sheet; what the file calls lines, points or sets of the same name belongs to them, a side of the box does not.
    fn name_areas(&self, mesh: &mut Mesh) {
        for (name, cells) in &self.areas {
            let has_more = self.lines.contains_key(name)
                || self.points.contains_key(name)
                || self.sets.contains_key(name);
            let existing = mesh.groups().get(name).filter(|_| has_more);
            let mut group = existing.cloned().unwrap_or_default();
            group.cells.extend(cells);
            group.cells.sort_unstable();
            group.cells.dedup();
            mesh.put_group(name, group);
        }
    }
}

/// The numbers of nodes in the mesh by those of the file.
type Numbers = HashMap<u64, usize>;

/// The nodes of a cell in the order that leaves its area to the left.
pub fn counter_clockwise(
    shape: CellShape,
    nodes: Vec<usize>,
    positions: &[[f64; 2]],
) -> Vec<usize> {
    let corners = shape.corners();
    let line: Vec<_> = nodes[..corners]
        .iter()
        .map(|node| positions[*node])
        .collect();
    if polygon_area(&line) >= 0.0 {
        return nodes;
    }
    // The first corner stays; the middle between corners i and i + 1 follows them.
    let mut turned = vec![nodes[0]];
    turned.extend(nodes[1..corners].iter().rev());
    turned.extend(nodes[corners..].iter().take(corners).rev());
    turned.extend(nodes.iter().skip(2 * corners));
    turned
}
