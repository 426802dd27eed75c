//! The outline of a specimen, and its meshes.

use crate::budget::Need;
use crate::mesh::{CellShape, Mesh, Rakes, Shape};
use crate::units::number;

use super::Refinement;
use super::grids::{GridCorrection, HALVINGS, PlateGrids};

/// The outline of a specimen, and how finely it is meshed.
pub enum Outline {
    /// A shape by its measures.
    Shape {
        /// The shape.
        shape: Shape,
        /// Cells of the lattice across it.
        cells: usize,
        /// Their kind.
        lattice: CellShape,
        /// The finite elements.
        element: CellShape,
    },
    /// The mesh of a file.
    File {
        /// The mesh.
        mesh: Box<Mesh>,
        /// The finite elements on it.
        element: CellShape,
        /// Whether straight edges are the outline itself where they turn as chords of a curve would.
        polygons: bool,
        /// How often the finite elements' cells are halved, up to two times.
        halvings: usize,
    },
    /// A rectangle between two grips on grids of lines.
    Grid(PlateGrids),
}

impl Outline {
    /// A coarse mesh with the groups of the specimen.
    pub fn coarse(&self) -> Mesh {
        match self {
            Self::Shape { shape, .. } => shape.mesh(2, CellShape::Quad4),
            Self::File { mesh, .. } => (**mesh).clone(),
            Self::Grid(grids) => Mesh::plate(grids.size, [2, 2], CellShape::Quad4),
        }
    }

    /// The least and the largest coordinates in mm, without rounding.
    pub fn bounding_box(&self) -> [[f64; 2]; 2] {
        let [low, high] = self.coarse().bounding_box();
        let size = (high[0] - low[0]).max(high[1] - low[1]);
        [low, high].map(|corner| corner.map(|position| without_rounding(position, size)))
    }

    /// The extent along both axes in mm.
    pub fn size(&self) -> [f64; 2] {
        let [low, high] = self.bounding_box();
        [0, 1].map(|axis| high[axis] - low[axis])
    }

    /// The memory and work of so many states on the finest of the finite elements' meshes.
    pub fn need(&self, states: usize, refinement: Option<Refinement>) -> Need {
        let cells = match self {
            Self::Shape {
                shape,
                cells,
                element,
                ..
            } => {
                let coarser = if element.degree() == 2 { 2.0 } else { 1.0 };
                let halves = if element.is_triangle() { 2.0 } else { 1.0 };
                halves * shape.cell_count(4.0 * *cells as f64 / coarser)
            }
            Self::File { mesh, halvings, .. } => {
                mesh.cell_count() as f64 * 4_f64.powi(*halvings as i32)
            }
            Self::Grid(grids) => grids.elements.cells.iter().product::<usize>() as f64,
        };
        let cells = refinement.map_or(cells, |goal| {
            let last = self.first_cells().max(goal.most_cells as f64);
            // All cells of the last mesh are halved once more, where these are not too many.
            last.max((4.0 * last).min(Refinement::MOST_HALVED as f64))
        });
        Need::of_states(2.0 * nodes_per_cell(self.element()) * cells, states as f64).on_cells(cells)
    }

    /// About how many triangles local refinement begins with on the mesh of a file.
    fn first_cells(&self) -> f64 {
        match self {
            Self::File { mesh, .. } => {
                let halves = if mesh.shape(0).is_triangle() {
                    1.0
                } else {
                    2.0
                };
                halves * mesh.cell_count() as f64
            }
            Self::Shape { .. } | Self::Grid(_) => 0.0,
        }
    }

    /// The finite element.
    fn element(&self) -> CellShape {
        match self {
            Self::Shape { element, .. } | Self::File { element, .. } => *element,
            Self::Grid(grids) => grids.elements.element.shape(),
        }
    }

    /// Whether it is a shape by its measures.
    pub fn is_shape(&self) -> bool {
        matches!(self, Self::Shape { .. })
    }

    /// A description with its measures.
    pub fn describe(&self) -> String {
        match self {
            Self::Shape { shape, .. } => describe(*shape),
            Self::Grid(PlateGrids {
                size: [length, width],
                ..
            }) => format!("a plate of {length} × {width} mm"),
            Self::File { .. } => {
                let [[left, bottom], [right, top]] = self.bounding_box();
                format!(
                    "the sheet of a mesh file, x from {left} to {right} mm and y from {bottom} to {top} mm"
                )
            }
        }
    }

    /// The mesh of the springs and of the corrector; that of a file has a node wherever the file has one.
    pub fn lattice(&self) -> Mesh {
        match self {
            Self::Shape {
                shape,
                cells,
                lattice,
                ..
            } => shape.mesh(*cells, *lattice),
            Self::File { mesh, .. } if mesh.degree() == 1 => (**mesh).clone(),
            Self::File { mesh, .. } => mesh.refined().linear(),
            Self::Grid(grids) => grids.lattice(),
        }
    }

    /// The mesh of the corrected field: the finite elements with about as many nodes as the lattice, or a grid with as many cells.
    pub fn corrected_mesh(&self) -> Mesh {
        match self {
            Self::Shape { .. } | Self::File { .. } => self.reference_mesh(0),
            Self::Grid(grids) => {
                let GridCorrection {
                    scheme, grading, ..
                } = grids.correction;
                scheme.graded(grids.size, grids.cells, grading)
            }
        }
    }

    /// The mesh of the corrected field after coarser ones of the same shape, each with half the cells across; that of a file is alone.
    pub fn nested_meshes(&self) -> Vec<Mesh> {
        /// Cells of a lattice across from which on a mesh has a coarser one.
        const FEWEST: usize = 6;
        let Self::Shape {
            shape,
            cells,
            element,
            ..
        } = self
        else {
            return vec![self.corrected_mesh()];
        };
        let coarser = |cells: &usize| (*cells >= FEWEST).then(|| cells.div_ceil(2));
        let of_lattices = std::iter::successors(Some(*cells), coarser);
        let cells = of_lattices.map(|cells| coarsest_cells(cells, *element));
        let meshes = cells.map(|cells| shape.mesh_halved(cells, 0, *element));
        let mut meshes: Vec<Mesh> = meshes.collect();
        meshes.reverse();
        meshes
    }

    /// The mesh of the finite elements of a level: each has cells of half the size of those of the one before. At level 2
    /// they are half as large as the lattice's where they are quadratic, and a quarter where they are linear or the mesh is
    /// that of a file, so that their error is small compared with that of the corrected field, whose mesh is that of level 0.
    pub fn reference_mesh(&self, level: usize) -> Mesh {
        match self {
            Self::Shape {
                shape,
                cells,
                element,
                ..
            } => shape.mesh_halved(coarsest_cells(*cells, *element), level, *element),
            Self::File { mesh, .. } => {
                let refined = (0..level).fold((**mesh).clone(), |mesh, _| mesh.refined());
                self.elements_on(&refined)
            }
            Self::Grid(grids) => grids.elements.mesh(grids.size, level),
        }
    }

    /// The mesh of the finest level.
    pub fn finest_mesh(&self) -> Mesh {
        self.reference_mesh(self.halvings())
    }

    /// How often the cells of the finite elements are halved.
    pub fn halvings(&self) -> usize {
        match self {
            Self::Shape { .. } | Self::Grid(_) => HALVINGS,
            Self::File { halvings, .. } => *halvings,
        }
    }

    /// Takes finite elements whose cells are halved once less; false where they are not halved, or are those of a shape, which
    /// may be given fewer cells.
    pub fn halve_less(&mut self) -> bool {
        match self {
            Self::File { halvings, .. } if *halvings > 0 => {
                *halvings -= 1;
                true
            }
            _ => false,
        }
    }

    /// A file's mesh, halved once, with its edges on the curves that they stand for, see [`Mesh::rounded`], and the whole
    /// change to those curves over the change to this mesh; `None` where there are none, or its cells are not halved.
    pub fn rounded_mesh(&self) -> Option<(Mesh, f64)> {
        let Self::File { mesh, polygons, .. } = self else {
            return None;
        };
        if self.halvings() == 0 || *polygons && mesh.degree() == 1 {
            return None;
        }
        // The distance of chords from a curve falls with h², that of parabolas with h⁴.
        let factor = if mesh.degree() == 1 {
            4.0 / 3.0
        } else {
            16.0 / 15.0
        };
        Some((self.elements_on(&mesh.rounded()?), factor))
    }

    /// The triangles that local refinement begins with: as coarse as the coarsest of three meshes.
    pub fn first_triangles(&self) -> Mesh {
        match self {
            Self::Shape { shape, cells, .. } => shape.mesh(*cells / 2, CellShape::Triangle3),
            Self::File { mesh, .. } => mesh.triangulated(),
            Self::Grid(grids) => grids.lattice().triangulated(),
        }
    }

    /// The mesh of the study's elements on some cells.
    pub fn elements_on(&self, cells: &Mesh) -> Mesh {
        match (self.element().degree(), cells.degree()) {
            (1, 1) => cells.clone(),
            (1, _) => cells.linear(),
            _ => self.fitted(cells.quadratic()),
        }
    }

    /// A refined mesh with its sides on the outline; the outline of a file is that of its mesh.
    pub fn fitted(&self, mut mesh: Mesh) -> Mesh {
        if let Self::Shape { shape, .. } = self {
            shape.fit(&mut mesh);
        }
        mesh
    }
}

/// A description of a shape with its measures.
fn describe(shape: Shape) -> String {
    match shape {
        Shape::Strip {
            size: [length, width],
        } => format!("a strip of {length} × {width} mm"),
        Shape::StripWithHole {
            size: [length, width],
            radius,
        } => format!(
            "a strip of {length} × {width} mm with a hole of {} mm diameter in its middle",
            2.0 * radius
        ),
        Shape::NotchedStrip {
            size: [length, width],
            depth,
            half_length,
        } => format!(
            "a strip of {length} × {width} mm with two notches of {depth} mm depth and {} mm length",
            2.0 * half_length
        ),
        Shape::DogBone {
            size: [length, width],
            narrow,
            shoulder,
        } => format!(
            "a dumb-bell of {length} × {width} mm with a narrow part of {} × {} mm and shoulders of {shoulder} mm length",
            narrow[0], narrow[1]
        ),
        Shape::SquareOnRakes(Rakes {
            size: [length, width],
            tines,
            spacing,
            inset,
            radius,
        }) => format!(
            "a sheet of {length} × {width} mm on rakes of {tines} tines of {} mm diameter at each side, {spacing} mm apart and {inset} mm from the edge",
            2.0 * radius
        ),
        Shape::Cruciform {
            size: [length, width],
            arm_width,
            fillet,
        } => format!(
            "a cruciform of {length} × {width} mm with arms of {arm_width} mm width and fillets of {fillet} mm radius"
        ),
        Shape::RingSector {
            radii: [inner, outer],
            angle,
        } => format!(
            "a sector of {}° of a ring with radii of {inner} and {outer} mm",
            number(angle.to_degrees())
        ),
    }
}

/// Cells across a shape of the coarsest finite elements, which have about as many nodes as a lattice of so many cells.
fn coarsest_cells(cells: usize, element: CellShape) -> usize {
    match element.degree() {
        1 => cells,
        _ => cells / 2,
    }
}

/// A coordinate without rounding errors, which are small compared with the size of the mesh.
fn without_rounding(position: f64, size: f64) -> f64 {
    const ROUNDING: f64 = 1e-12;
    if position.abs() < ROUNDING * size {
        0.0
    } else {
        format!("{position:.11e}").parse().unwrap_or(position)
    }
}

/// The nodes of a large mesh over its cells.
fn nodes_per_cell(shape: CellShape) -> f64 {
    match shape {
        CellShape::Triangle3 => 0.5,
        CellShape::Quad4 => 1.0,
        CellShape::Triangle6 => 2.0,
        CellShape::Quad8 => 3.0,
        CellShape::Quad9 => 4.0,
    }
}

#[cfg(test)]
mod tests {
    use super::without_rounding;

    #[test]
    fn coordinates_are_shown_without_rounding_errors() {
        let rounded = |position: f64| without_rounding(position, 20.0).to_string();
        assert_eq!(rounded(6.123233995736766e-16), "0");
        assert_eq!(rounded(20.000000000000004), "20");
        assert_eq!(rounded(0.1 + 0.2), "0.3");
        assert_eq!(rounded(-12.345678), "-12.345678");
    }
}
