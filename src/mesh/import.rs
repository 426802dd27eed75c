//! Meshes of other programs: Gmsh (ASCII, 2.2 and 4.1) and VTK (`.vtu`, `.vtk`).
//!
//! Lines with a physical group make up the named parts of the boundary. Whatever the file names, the edges on the
//! four sides of the mesh's box are `left`, `right`, `bottom` and `top`, and all edges of the boundary `boundary`.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use super::{CellShape, Mesh};

mod field;
mod frd;
mod gmsh;
mod pvd;
mod vtk;

pub use field::{ImportedField, ImportedSeries, ImportedStep, import_field, import_series};

/// What a file holds, before it is a flat mesh: places in the file's unit, and elements by their kinds.
#[derive(Default)]
struct Raw {
    /// Places by the file's own number.
    places: HashMap<u64, [f64; 3]>,
    /// Cells in the order of the file.
    cells: Vec<(CellShape, Vec<u64>)>,
    /// Ends of lines, and points, by the name of their group.
    lines: BTreeMap<String, Vec<[u64; 2]>>,
    points: BTreeMap<String, Vec<u64>>,
}

/// Reads a mesh; `unit` is the length of the file's unit in mm.
///
/// # Errors
/// Says what the file holds that cannot be read, or what is wrong with it.
pub fn import(path: &Path, unit: f64) -> Result<Mesh, String> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    let raw = match ending.as_deref() {
        Some("msh") => gmsh::read(&read_text(path)?)?,
        Some("vtu" | "vtk") => vtk::read(path)?,
        _ => return Err("is no .msh, .vtu or .vtk file".into()),
    };
    raw.mesh(unit)
}

/// The text of a file.
fn read_text(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|cause| format!("cannot be read: {cause}"))?;
    String::from_utf8(bytes).map_err(|_| BINARY.to_owned())
}

const BINARY: &str = "is a binary file; save it as ASCII (Mesh.Binary = 0 in Gmsh) or as .vtu";

impl Raw {
    /// The nodes of the cells, in the order that they have in the mesh.
    fn used(&self) -> BTreeSet<u64> {
        let nodes = self.cells.iter().flat_map(|(_, nodes)| nodes);
        nodes.copied().collect()
    }

    fn mesh(self, unit: f64) -> Result<Mesh, String> {
        if self.cells.is_empty() {
            return Err("holds no triangles or quadrilaterals".into());
        }
        let used = self.used();
        let (mut nodes, mut names) = (Vec::new(), HashMap::new());
        let mut height: Option<f64> = None;
        for name in used {
            let Some([x, y, z]) = self.places.get(&name) else {
                return Err(format!(
                    "has a cell with the node {name}, which it does not hold"
                ));
            };
            if [x, y, z].iter().any(|x| !x.is_finite()) {
                return Err(format!("has the node {name} at a place that is no number"));
            }
            let plane = *height.get_or_insert(*z);
            if (z - plane).abs() > 1e-9 * (x.abs() + y.abs()).max(1e-300) {
                return Err(format!(
                    "is not flat: the node {name} lies at z = {z}, others at {plane}"
                ));
            }
            names.insert(name, nodes.len());
            nodes.push([unit * x, unit * y]);
        }
        let cells: Vec<_> = self
            .cells
            .iter()
            .map(|(shape, own)| {
                let own: Vec<usize> = own.iter().map(|name| names[name]).collect();
                (*shape, counter_clockwise(*shape, own, &nodes))
            })
            .collect();
        let mut mesh = Mesh::new(nodes, cells);
        for cell in 0..mesh.cell_count() {
            for (point, _) in mesh.shape(cell).quadrature() {
                let jacobian = mesh.gradients(cell, point).1;
                if jacobian.is_nan() || jacobian <= 0.0 {
                    return Err(format!("has a folded cell: {}", mesh.describe_cell(cell)));
                }
            }
        }
        name_sides(&mut mesh);
        for (name, ends) in &self.points {
            let nodes = ends
                .iter()
                .filter_map(|node| names.get(node).copied())
                .collect();
            mesh.put_group(name, nodes, Vec::new());
        }
        let edges: HashMap<[usize; 2], Vec<usize>> = mesh
            .boundary()
            .iter()
            .map(|edge| ([edge[0].min(edge[1]), edge[0].max(edge[1])], edge.clone()))
            .collect();
        for (name, lines) in &self.lines {
            let ends = lines
                .iter()
                .filter_map(|[a, b]| Some([*names.get(a)?, *names.get(b)?]));
            let ends = ends.map(|[a, b]| [a.min(b), a.max(b)]);
            let own = ends.filter_map(|ends| edges.get(&ends).cloned()).collect();
            mesh.name_edges(name, own);
        }
        Ok(mesh)
    }
}

/// The nodes of a cell in the order that leaves its area to the left.
fn counter_clockwise(shape: CellShape, nodes: Vec<usize>, places: &[[f64; 2]]) -> Vec<usize> {
    let corners = shape.corners();
    let area: f64 = (0..corners)
        .map(|i| {
            let (a, b) = (places[nodes[i]], places[nodes[(i + 1) % corners]]);
            a[0] * b[1] - b[0] * a[1]
        })
        .sum();
    if area >= 0.0 {
        return nodes;
    }
    // The first corner stays; the middle between corners i and i + 1 follows them.
    let mut turned = vec![nodes[0]];
    turned.extend(nodes[1..corners].iter().rev());
    turned.extend(nodes[corners..].iter().take(corners).rev());
    turned.extend(nodes.iter().skip(2 * corners));
    turned
}

/// Names the boundary and its parts on the four sides of the mesh's box.
fn name_sides(mesh: &mut Mesh) {
    let [low, high] = mesh.bounding_box();
    let near = 1e-9 * (high[0] - low[0]).max(high[1] - low[1]);
    for (name, axis, value) in [
        ("left", 0, low[0]),
        ("right", 0, high[0]),
        ("bottom", 1, low[1]),
        ("top", 1, high[1]),
    ] {
        mesh.name_boundary(name, |place| (place[axis] - value).abs() <= near);
    }
    mesh.name_boundary("boundary", |_| true);
}

#[cfg(test)]
mod tests;
