//! Meshes and arrays as Python has them.

use gelbench::mesh::Mesh;
use gelbench::results::{Array, Grid};
use gelbench_report::results::{Components, GridCell};
use numpy::{IxDyn, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Numbers, `width` a row, without a copy.
pub fn rows(py: Python<'_>, values: Vec<f64>, width: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = values.len() / width;
    PyArray1::from_vec(py, values).reshape([count, width])
}

/// Forbids Python to write into an array.
pub fn frozen<'py, T>(array: Bound<'py, T>) -> PyResult<Bound<'py, T>> {
    let flags = PyDict::new(array.py());
    flags.set_item("write", false)?;
    array.as_any().call_method("setflags", (), Some(&flags))?;
    Ok(array)
}

/// Vectors, one a row, that Python cannot write into, nor allow itself to: what they are views of is frozen too.
pub fn frozen_vectors(py: Python<'_>, values: Vec<f64>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = values.len() / 2;
    frozen(frozen(PyArray1::from_vec(py, values))?.reshape([count, 2])?)
}

/// Places in mm, one a row; read-only.
pub fn places<'py>(py: Python<'py>, points: &[[f64; 2]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    frozen_vectors(py, points.as_flattened().to_vec())
}

/// Cells of one kind: its VTK number, the numbers of the cells, and their points.
type Block<'py> = (u8, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray2<i64>>);

/// VTK's number of a kind of cells.
fn vtk_number(cell: GridCell) -> u8 {
    match cell {
        GridCell::Vertex => 1,
        GridCell::Line => 3,
        GridCell::Mesh(shape) => shape.vtk_number(),
    }
}

/// The cells, sorted by kind.
pub fn blocks<'py>(
    py: Python<'py>,
    cells: &[GridCell],
    connectivity: &[usize],
) -> PyResult<Vec<Block<'py>>> {
    let mut groups: Vec<(u8, usize, Vec<i64>, Vec<i64>)> = Vec::new();
    let mut first = 0;
    for (number, cell) in cells.iter().enumerate() {
        let kind = vtk_number(*cell);
        let points = &connectivity[first..first + cell.points()];
        first += cell.points();
        let at = groups.iter().position(|(known, ..)| *known == kind);
        let at = at.unwrap_or_else(|| {
            groups.push((kind, cell.points(), Vec::new(), Vec::new()));
            groups.len() - 1
        });
        groups[at].2.push(number as i64);
        groups[at]
            .3
            .extend(points.iter().map(|point| *point as i64));
    }
    let block = |(kind, width, numbers, points): (u8, usize, Vec<i64>, Vec<i64>)| {
        let shape = [numbers.len(), width];
        let points = PyArray1::from_vec(py, points).reshape(shape)?;
        Ok((kind, PyArray1::from_vec(py, numbers), points))
    };
    groups.into_iter().map(block).collect()
}

/// The cells of a mesh.
pub fn mesh_blocks<'py>(py: Python<'py>, mesh: &Mesh) -> PyResult<Vec<Block<'py>>> {
    let cells = 0..mesh.cell_count();
    let kinds: Vec<_> = cells
        .clone()
        .map(|cell| GridCell::Mesh(mesh.shape(cell)))
        .collect();
    let points: Vec<_> = cells.flat_map(|cell| mesh.cell(cell)).copied().collect();
    blocks(py, &kinds, &points)
}

/// Arrays by their names, read-only: one number each, or rows of components.
fn named(py: Python<'_>, arrays: Vec<Array>) -> PyResult<Bound<'_, PyDict>> {
    let by_name = PyDict::new(py);
    for array in arrays {
        let width = array.components.count();
        let count = array.values.len() / width;
        let shape = match array.components {
            Components::Scalar => IxDyn(&[count]),
            _ => IxDyn(&[count, width]),
        };
        let values = frozen(PyArray1::from_vec(py, array.values))?;
        let values: Bound<'_, PyArrayDyn<f64>> = values.reshape(shape)?;
        by_name.set_item(array.name, frozen(values)?)?;
    }
    Ok(by_name)
}

/// The arrays of a grid at its points and in its cells.
pub type Arrays<'py> = (Bound<'py, PyDict>, Bound<'py, PyDict>);

/// The arrays at the points and in the cells of a grid.
pub fn arrays(py: Python<'_>, grid: Grid) -> PyResult<Arrays<'_>> {
    Ok((named(py, grid.at_points)?, named(py, grid.in_cells)?))
}
