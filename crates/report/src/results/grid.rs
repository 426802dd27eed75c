//! Grids with named arrays as data: the content of a VTK file.
//!
//! Units are part of the arrays' names. Stresses and related quantities are those of the material at the field's
//! gradient in the centre of each cell, and at each node at the mean of the gradients there.

use super::Array;
use super::sheet::Sheet;
use super::sheet_arrays::{in_cells, nodal};
use crate::mass_spring::{MassSpring, SpringState};
use crate::mesh::{CellShape, Mesh};

/// The kind of a cell of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridCell {
    /// A point.
    Vertex,
    /// Two points.
    Line,
    /// A cell of a mesh.
    Mesh(CellShape),
}

impl GridCell {
    /// The number of its points.
    pub fn points(self) -> usize {
        match self {
            Self::Vertex => 1,
            Self::Line => 2,
            Self::Mesh(shape) => shape.nodes(),
        }
    }
}

/// Points, cells, and arrays at both.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Positions at rest in mm.
    pub points: Vec<[f64; 2]>,
    /// The kinds of the cells.
    pub cells: Vec<GridCell>,
    /// The points of cell after cell.
    pub connectivity: Vec<usize>,
    /// Arrays at the points.
    pub at_points: Vec<Array>,
    /// Arrays in the cells.
    pub in_cells: Vec<Array>,
}

impl Grid {
    fn new(points: &[[f64; 2]], cells: Vec<GridCell>, connectivity: Vec<usize>) -> Self {
        Self {
            points: points.to_vec(),
            cells,
            connectivity,
            at_points: Vec::new(),
            in_cells: Vec::new(),
        }
    }

    /// Scattered points.
    pub fn scattered(positions: &[[f64; 2]], displacement: &[f64]) -> Self {
        let cells = vec![GridCell::Vertex; positions.len()];
        let grid = Self::new(positions, cells, (0..positions.len()).collect());
        grid.with([Array::displacement(displacement)])
    }

    /// A displacement field on the mesh of a sheet, with the stresses and strains that follow; without these where a cell is inverted.
    pub fn sheet(sheet: Sheet, mesh: &Mesh, displacement: &[f64]) -> Self {
        let cells = 0..mesh.cell_count();
        let kinds = cells.clone().map(|cell| GridCell::Mesh(mesh.shape(cell)));
        let connectivity = cells.flat_map(|cell| mesh.cell(cell)).copied().collect();
        Self::new(&mesh.nodes, kinds.collect(), connectivity)
            .with([Array::displacement(displacement)])
            .with(nodal(sheet, mesh, displacement))
            .with_in_cells(in_cells(sheet, mesh, displacement))
    }

    /// The springs of a lattice with a history, which is empty where it was never loaded.
    pub fn springs(model: &MassSpring, displacement: &[f64], history: &[f64]) -> Self {
        let connectivity = model.springs.iter().flat_map(|spring| spring.nodes);
        let cells = vec![GridCell::Line; model.springs.len()];
        let states = model.spring_states(displacement, history);
        let of =
            |name, value: fn(&SpringState) -> f64| Array::scalars(name, states.iter().map(value));
        let springs = model.springs.iter();
        let stiffness = (0..model.springs.len()).map(|spring| model.stiffness_at_rest(spring));
        Self::new(&model.mesh.nodes, cells, connectivity.collect())
            .with([Array::displacement(displacement)])
            .with_in_cells([
                of("force_N", |state| state.force),
                of("stretch", |state| state.stretch),
                Array::scalars("rest_length_mm", springs.clone().map(|one| one.rest_length)),
                Array::scalars("cross_section_mm2", springs.map(|one| one.area)),
                Array::scalars("stiffness_at_rest_N_per_mm", stiffness),
            ])
    }

    /// The grid with more arrays at its points.
    #[must_use]
    pub fn with(mut self, arrays: impl IntoIterator<Item = Array>) -> Self {
        self.at_points.extend(arrays);
        self
    }

    /// The grid with more arrays in its cells.
    #[must_use]
    pub fn with_in_cells(mut self, arrays: impl IntoIterator<Item = Array>) -> Self {
        self.in_cells.extend(arrays);
        self
    }
}

/// Grids of one series: those of one model at load factors, stretches, instants or frames.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSeries {
    /// The model's name for files.
    pub name: String,
    /// Its grids; those with a time are played one after the other.
    pub grids: Vec<NamedGrid>,
}

/// A grid of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedGrid {
    /// The name of its file, without extension.
    pub name: String,
    /// Its position in the series: a load factor, a stretch, or a time in s.
    pub time: Option<f64>,
    /// The grid.
    pub grid: Grid,
}

impl GridSeries {
    /// Grids with their numbers and times; the numbers in the names of the files have the given number of digits.
    fn numbered(name: &str, digits: usize, grids: impl IntoIterator<Item = (f64, Grid)>) -> Self {
        let named = |(number, (time, grid)): (usize, _)| NamedGrid {
            name: format!("{name}_{number:0digits$}"),
            time: Some(time),
            grid,
        };
        Self {
            name: name.to_owned(),
            grids: (1..).zip(grids).map(named).collect(),
        }
    }

    /// Grids at load factors or stretches: `NAME_001` and so on.
    pub fn steps(name: &str, grids: impl IntoIterator<Item = (f64, Grid)>) -> Self {
        Self::numbered(name, 3, grids)
    }

    /// Grids at instants: `NAME_00001` and so on.
    pub fn instants(name: &str, grids: impl IntoIterator<Item = (f64, Grid)>) -> Self {
        Self::numbered(name, 5, grids)
    }

    /// A single grid.
    pub fn single(name: &str, grid: Grid) -> Self {
        let grid = NamedGrid {
            name: name.to_owned(),
            time: None,
            grid,
        };
        Self {
            name: name.to_owned(),
            grids: vec![grid],
        }
    }
}
