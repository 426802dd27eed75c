//! Nodes, cells and named groups of a flat specimen, and fields on them.

mod angles;
mod bisect;
mod blocks;
mod buckets;
mod cell_shape;
mod cells;
mod cut;
mod faults;
pub mod geometry;
mod grid;
mod import;
mod interpolation;
mod locate;
mod nodal_field;
mod outline;
mod parts;
mod plate;
mod refine;
mod rounding;
mod seams;
mod shapes;
mod strips;
mod triangulate;

pub use angles::REENTRANT;
pub use blocks::{Block, mesh_of_blocks};
pub use cell_shape::{CellShape, GAUSS_2, GAUSS_3, GAUSS_4, GAUSS_5, QuadraturePoint, lobatto};
pub use cells::{Group, Mesh, decimals_for};
pub use cut::CutMesh;
pub use faults::{Exemptions, UnknownName};
pub use grid::{Grid, Side};
pub use import::{
    ImportFault, ImportedField, ImportedSeries, ImportedStep, MeshData, MeshReading, import,
    import_field, import_series,
};
pub use interpolation::{CellPoint, Interpolation};
pub use nodal_field::{largest_distance, vectors, weighted_distance, weighted_norm};
pub use outline::corners;
pub use outline::{Outline, OutlineFault, OutlineOfPoints, straightened};
pub use parts::Parts;
pub use rounding::Polygon;
pub use shapes::{Misfit, Rakes, Shape};
