//! Deformed meshes as triangles, which a picture can shade.

use serde::{Deserialize, Serialize};

use crate::mesh::{CellShape, Mesh, vectors};
use crate::statistics::extremes;

/// Triangles on the deformed mesh, and its edge deformed and at rest; all coordinates in mm.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Surface {
    /// Where the values are.
    pub points: Vec<[f64; 2]>,
    /// The points of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The cell that each triangle is a part of.
    pub cells: Vec<u32>,
    /// Lines along the edge of the deformed sheet.
    pub outline: Vec<Vec<[f64; 2]>>,
    /// The same lines at rest.
    pub rest: Vec<Vec<[f64; 2]>>,
}

/// Cells up to which each is divided; those of a finer mesh are small enough to be shown by their corners alone.
const MOST_DIVIDED: usize = 12_000;

impl Surface {
    /// The surface of a mesh with ux, uy of node after node; cells of the second degree are divided.
    pub fn new(mesh: &Mesh, displacement: &[f64]) -> Self {
        let nodes = mesh.nodes.iter().zip(vectors(displacement));
        let moved: Vec<[f64; 2]> = nodes.map(|([x, y], [ux, uy])| [x + ux, y + uy]).collect();
        let [x, y] = [0, 1].map(|axis| Self::values(mesh, &|node| moved[node][axis]));
        let mut surface = Self {
            points: x.into_iter().zip(y).map(|(x, y)| [x, y]).collect(),
            outline: edge_lines(mesh.boundary(), &moved),
            rest: edge_lines(mesh.boundary(), &mesh.nodes),
            ..Self::default()
        };
        match Division::of(mesh) {
            Some(division) => surface.divide(mesh, &division),
            None => surface.join_corners(mesh),
        }
        surface
    }

    fn divide(&mut self, mesh: &Mesh, division: &Division) {
        let mut first = 0;
        for cell in 0..mesh.cell_count() {
            let part = division.part(mesh.shape(cell));
            for triangle in &part.triangles {
                self.triangles.push(triangle.map(|point| first + point));
                self.cells.push(cell as u32);
            }
            first += part.locals.len() as u32;
        }
    }

    /// Triangles between the corners of the cells.
    fn join_corners(&mut self, mesh: &Mesh) {
        for cell in 0..mesh.cell_count() {
            let corner = |index: usize| mesh.cell(cell)[index] as u32;
            for last in 2..mesh.shape(cell).corners() {
                self.triangles
                    .push([corner(0), corner(last - 1), corner(last)]);
                self.cells.push(cell as u32);
            }
        }
    }

    /// Quadrilaterals without an edge of their own.
    pub fn quadrilaterals(corners: &[[[f64; 2]; 4]]) -> Self {
        let halves = (0..corners.len() as u32).flat_map(|cell| {
            let first = 4 * cell;
            [[0, 1, 2], [0, 2, 3]].map(|half| half.map(|corner| first + corner))
        });
        let cells = (0..corners.len() as u32).flat_map(|cell| [cell; 2]);
        Self {
            points: corners.as_flattened().to_vec(),
            triangles: halves.collect(),
            cells: cells.collect(),
            ..Self::default()
        }
    }

    /// The values at the points of a field that is drawn. Within a cell they are limited to the range of the values at its nodes, which parabolas
    /// through stresses would exceed, so that the ends of the colour bar are in the arrays too.
    pub fn field(mesh: &Mesh, at_node: &dyn Fn(usize) -> f64) -> Vec<f64> {
        Self::sampled(mesh, at_node, |nodal| extremes(nodal.iter().copied()))
    }

    /// The values at the points of a field, interpolated from those at the nodes of the mesh that the surface was made of.
    pub fn values(mesh: &Mesh, at_node: &dyn Fn(usize) -> f64) -> Vec<f64> {
        Self::sampled(mesh, at_node, |_| [f64::NEG_INFINITY, f64::INFINITY])
    }

    /// The values at the points, each within the limits for the nodal values of its cell; NaN stays NaN.
    fn sampled(
        mesh: &Mesh,
        at_node: &dyn Fn(usize) -> f64,
        limits: impl Fn(&[f64]) -> [f64; 2],
    ) -> Vec<f64> {
        let Some(division) = Division::of(mesh) else {
            return (0..mesh.nodes.len()).map(at_node).collect();
        };
        let mut sampled = Vec::new();
        for cell in 0..mesh.cell_count() {
            let nodal: Vec<f64> = mesh.cell(cell).iter().map(|node| at_node(*node)).collect();
            let [low, high] = limits(&nodal);
            for values in &division.part(mesh.shape(cell)).values {
                let value: f64 = values.iter().zip(&nodal).map(|(n, value)| n * value).sum();
                sampled.push(if value.is_nan() {
                    value
                } else {
                    value.max(low).min(high)
                });
            }
        }
        sampled
    }
}

/// How a kind of cell is divided: points in natural coordinates, and triangles of them.
struct Part {
    shape: CellShape,
    locals: Vec<[f64; 2]>,
    /// The values of the shape functions at each point.
    values: Vec<Vec<f64>>,
    triangles: Vec<[u32; 3]>,
}

/// How the cells of a mesh are divided.
struct Division(Vec<Part>);

impl Division {
    /// `None` where there are too many cells to be divided.
    fn of(mesh: &Mesh) -> Option<Self> {
        let cells = mesh.cell_count();
        let finest = (MOST_DIVIDED as f64 / cells as f64).sqrt() as u32;
        let part = |shape: CellShape| {
            let across = match shape.degree() {
                1 => 1,
                _ => finest.clamp(2, 8),
            };
            let (locals, triangles) = if shape.is_triangle() {
                divided_triangle(across)
            } else {
                divided_square(across)
            };
            let values = locals.iter().map(|local| shape.values(*local));
            Part {
                shape,
                values: values.collect(),
                locals,
                triangles,
            }
        };
        (cells <= MOST_DIVIDED).then(|| Self(CellShape::NAMES.map(|(_, shape)| part(shape)).into()))
    }

    fn part(&self, shape: CellShape) -> &Part {
        let part = self.0.iter().find(|part| part.shape == shape);
        part.expect("every kind of cell is divided")
    }
}

/// Squares of four triangles that meet in the middle.
fn divided_square(across: u32) -> (Vec<[f64; 2]>, Vec<[u32; 3]>) {
    let at = |i: f64| 2.0 * i / f64::from(across) - 1.0;
    let lines = 0..=across;
    let mut locals: Vec<[f64; 2]> = lines
        .clone()
        .flat_map(|j| (lines.clone()).map(move |i| [at(f64::from(i)), at(f64::from(j))]))
        .collect();
    let mut triangles = Vec::new();
    for (j, i) in (0..across).flat_map(|j| (0..across).map(move |i| (j, i))) {
        let first = j * (across + 1) + i;
        let [a, b, c, d] = [first, first + 1, first + across + 2, first + across + 1];
        let middle = locals.len() as u32;
        locals.push([at(f64::from(i) + 0.5), at(f64::from(j) + 0.5)]);
        triangles.extend([
            [a, b, middle],
            [b, c, middle],
            [c, d, middle],
            [d, a, middle],
        ]);
    }
    (locals, triangles)
}

fn divided_triangle(across: u32) -> (Vec<[f64; 2]>, Vec<[u32; 3]>) {
    let at = |i: u32| f64::from(i) / f64::from(across);
    let rows = (0..=across).flat_map(|j| (0..=across - j).map(move |i| [at(i), at(j)]));
    let mut triangles = Vec::new();
    let mut first = 0;
    for j in 0..across {
        let length = across - j + 1;
        let above = first + length;
        for i in 0..across - j {
            triangles.push([first + i, first + i + 1, above + i]);
            if i + 1 < across - j {
                triangles.push([first + i + 1, above + i + 1, above + i]);
            }
        }
        first = above;
    }
    (rows.collect(), triangles)
}

/// Lines along edges with their nodes at `positions`, curved ones in short pieces.
pub fn edge_lines(edges: &[Vec<usize>], positions: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let line = |edge: &Vec<usize>| match edge[..] {
        [from, to, middle] => {
            let at = |step: i32| {
                let s = f64::from(step) / 4.0 - 1.0;
                let shares = [0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s];
                [0, 1].map(|axis| {
                    let nodes = [from, to, middle].into_iter().zip(shares);
                    nodes
                        .map(|(node, share)| share * positions[node][axis])
                        .sum()
                })
            };
            (0..=8).map(at).collect()
        }
        _ => edge.iter().map(|node| positions[*node]).collect(),
    };
    edges.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;
    use crate::results::displacements;

    fn area(surface: &Surface) -> f64 {
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|point| surface.points[point as usize]);
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
        };
        surface.triangles.iter().map(of).sum()
    }

    #[test]
    fn the_triangles_of_every_element_cover_the_deformed_sheet_once() {
        let shape = Shape::Strip { size: [3.0, 1.0] };
        for (name, kind) in CellShape::NAMES {
            let mesh = shape.mesh(2, kind);
            let u = displacements(&mesh, |[x, _]| [0.5 * x, 0.0]);
            let surface = Surface::new(&mesh, &u);
            assert!((area(&surface) - 4.5).abs() < 1e-12, "{name}");
            let doubled = Surface::values(&mesh, &|node| 2.0 * mesh.nodes[node][1]);
            for (point, value) in surface.points.iter().zip(doubled) {
                assert!((value - 2.0 * point[1]).abs() < 1e-12, "{name}");
            }
            assert_eq!(surface.outline.len(), mesh.boundary().len());
            // One node stands out: the parabolas beside it would fall below the others.
            let peak = |node: usize| f64::from(u8::from(node == 5));
            let [low, high] = extremes(Surface::field(&mesh, &peak));
            assert_eq!([low, high], [0.0, 1.0], "{name}");
            // What is inside out has no stress, and is drawn as such.
            let hole = |node: usize| if node == 5 { f64::NAN } else { 1.0 };
            let shown = Surface::field(&mesh, &hole);
            assert!(shown.iter().any(|value| value.is_nan()), "{name}");
        }
    }

    #[test]
    fn curved_elements_are_followed() {
        let (size, radius) = ([30.0, 10.0], 2.5);
        let mesh = Shape::StripWithHole { size, radius }.mesh(4, CellShape::Quad9);
        let surface = Surface::new(&mesh, &vec![0.0; 2 * mesh.nodes.len()]);
        let exact = 300.0 - std::f64::consts::PI * radius * radius;
        assert!((area(&surface) / exact - 1.0).abs() < 1e-3);
        let on_hole = |[x, y]: &[f64; 2]| ((x - 15.0).hypot(*y) - radius).abs() < 0.01;
        let mut lines = surface.outline.iter();
        assert!(lines.any(|line| line.len() == 9 && line.iter().all(on_hole)));
    }

    #[test]
    fn the_cells_of_a_fine_mesh_are_shown_by_their_corners() {
        let mesh = Mesh::plate([3.0, 1.0], [130, 100], CellShape::Quad9);
        let surface = Surface::new(&mesh, &vec![0.0; 2 * mesh.nodes.len()]);
        assert_eq!(surface.triangles.len(), 2 * mesh.cell_count());
        assert!((area(&surface) - 3.0).abs() < 1e-9);
    }
}
