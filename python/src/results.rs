//! The results of a study, as the command reports them.

use std::path::{Path, PathBuf};

use gelbench::error::Error;
use gelbench::output::ResultFolder;
use gelbench::results::{self, Content, Drawing, GridSeries};
use gelbench_report::output::{self, vtk};
use gelbench_report::results::NamedGrid;
use numpy::PyArray2;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{raised, refused};
use crate::fields::{Arrays, arrays, blocks, places};

/// A picture as a PNG.
pub fn drawn(drawing: &Drawing) -> Result<Vec<u8>, Error> {
    output::png(drawing).map_err(|fault| refused(fault.to_string()))
}

/// The results of a study.
#[pyclass(frozen, module = "gelbench._core")]
pub struct Results {
    pub results: results::Results,
    /// The file that was read.
    pub file: PathBuf,
    /// The folder that the study names for its results.
    pub folder: Option<PathBuf>,
    pub with_report: bool,
    /// Fields and tables of frames, which the command writes as it goes.
    pub of_frames: OfFrames,
}

/// Fields and tables of frames.
#[derive(Default)]
pub struct OfFrames {
    pub series: Vec<GridSeries>,
    /// Tables by file name.
    pub tables: Vec<(String, String)>,
}

impl OfFrames {
    fn write(&self, files: &mut ResultFolder) -> Result<(), Error> {
        for series in &self.series {
            output::write_grids(files, series)?;
        }
        if !self.series.is_empty() {
            files.add("vtk/view.py", vtk::VIEW.as_bytes())?;
        }
        let mut tables = self.tables.iter();
        tables.try_for_each(|(name, table)| files.add(name, table.as_bytes()))
    }
}

impl Results {
    /// With a report, in the usual folder.
    pub fn new(results: results::Results, file: PathBuf) -> Self {
        Self {
            results,
            file,
            folder: None,
            with_report: true,
            of_frames: OfFrames::default(),
        }
    }

    fn series(&self) -> &[GridSeries] {
        match self.of_frames.series.as_slice() {
            [] => &self.results.outcome.grids,
            series => series,
        }
    }

    fn grid(&self, series: usize, number: usize) -> PyResult<&NamedGrid> {
        self.series()
            .get(series)
            .and_then(|series| series.grids.get(number))
            .ok_or_else(|| PyIndexError::new_err("there is no such field"))
    }
}

#[pymethods]
impl Results {
    /// A copy is the same: nothing in it changes.
    fn __copy__(results: Py<Self>) -> Py<Self> {
        results
    }

    fn __deepcopy__(results: Py<Self>, _memo: Py<PyAny>) -> Py<Self> {
        results
    }

    #[getter]
    fn passed(&self) -> bool {
        self.results.passed()
    }

    #[getter]
    fn title(&self) -> &str {
        &self.results.title
    }

    #[getter]
    fn kind(&self) -> &str {
        self.results.kind
    }

    #[getter]
    fn seconds(&self) -> f64 {
        self.results.seconds
    }

    #[getter]
    fn summary(&self) -> String {
        self.results.summary()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.results.warnings().collect()
    }

    #[getter]
    fn doubts(&self) -> Vec<String> {
        self.results.outcome.doubts().collect()
    }

    /// The text of `report.json`.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| format!("{:#}\n", self.results.json()))
    }

    /// The text of `report.md`.
    fn markdown(&self, py: Python<'_>) -> String {
        py.detach(|| {
            let figures = &self.results.outcome.figures;
            output::markdown(&self.results.report(), figures)
        })
    }

    /// Names and captions of the pictures.
    fn pictures(&self) -> Vec<(String, String)> {
        let figures = self.results.outcome.figures.iter();
        figures
            .map(|figure| (figure.name.clone(), figure.caption.clone()))
            .collect()
    }

    /// Names and texts of the tables.
    fn tables(&self) -> Vec<(String, String)> {
        let files = self.results.outcome.files.iter();
        let of_study = files.filter_map(|(name, content)| match content {
            Content::Text(text) => Some((name.clone(), text.clone())),
            Content::Picture(_) => None,
        });
        of_study
            .chain(self.of_frames.tables.iter().cloned())
            .collect()
    }

    /// A picture as a PNG.
    fn picture<'py>(&self, py: Python<'py>, number: usize) -> PyResult<Bound<'py, PyBytes>> {
        let figures = &self.results.outcome.figures;
        let figure = figures
            .get(number)
            .ok_or_else(|| PyIndexError::new_err("there is no such picture"))?;
        let picture = raised(py, py.detach(|| drawn(&figure.drawing)))?;
        Ok(PyBytes::new(py, &picture))
    }

    /// The names of the fields, with the load factors, stretches or times of each.
    fn fields(&self) -> Vec<(String, Vec<Option<f64>>)> {
        let times = |series: &GridSeries| series.grids.iter().map(|grid| grid.time).collect();
        let named = |series: &GridSeries| (series.name.clone(), times(series));
        self.series().iter().map(named).collect()
    }

    fn field_points<'py>(
        &self,
        py: Python<'py>,
        series: usize,
        number: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        places(py, &self.grid(series, number)?.grid.points)
    }

    fn field_cells<'py>(
        &self,
        py: Python<'py>,
        series: usize,
        number: usize,
    ) -> PyResult<Bound<'py, PyAny>> {
        let grid = &self.grid(series, number)?.grid;
        let blocks = blocks(py, &grid.cells, &grid.connectivity)?;
        Ok(blocks.into_pyobject(py)?.into_any())
    }

    fn field_arrays<'py>(
        &self,
        py: Python<'py>,
        series: usize,
        number: usize,
    ) -> PyResult<Arrays<'py>> {
        arrays(py, self.grid(series, number)?.grid.clone())
    }

    /// Writes what the command writes, into a folder or the one that the study names; the files.
    #[pyo3(signature = (folder=None))]
    fn write(&self, py: Python<'_>, folder: Option<PathBuf>) -> PyResult<Vec<PathBuf>> {
        let usual = || Path::new("output").join(&self.results.name);
        let folder = folder.or_else(|| self.folder.clone()).unwrap_or_else(usual);
        let written = py.detach(|| {
            let mut files = ResultFolder::open(&folder, "run", &[&self.file])?;
            self.of_frames.write(&mut files)?;
            output::write(&self.results, self.with_report, &mut files)?;
            files.finish()
        });
        raised(py, written)
    }
}
