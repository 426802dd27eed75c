//! Plates and specimens of one model, and study files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use gelbench::budget::Budget;
use gelbench::document::with_files;
use gelbench::error::{Diagnostic, Error};
use gelbench::kinds;
use gelbench::mesh::{CellShape, MeshData};
use gelbench::studies::{Kind, Loaded, PreparedStudy, Progress};
use gelbench::units::{self, Dimension};
use gelbench_mechanics::material::softened_law::check_memory;
use gelbench_studies::studies::specimen::{self, Along, Specimen};
use gelbench_studies::studies::{ModelKind, plate};
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors::{choice, exception, input, raised, refused};
use crate::material::{MaterialCard, watched};
use crate::results::Results;
use crate::running::{Watch, run as run_watched};
use crate::solution::{Sheet, Solution};

/// What may be used.
pub fn budget(allow_large: bool) -> Budget {
    if allow_large {
        Budget::LARGE
    } else {
        Budget::USUAL
    }
}

/// Cards in memory, by the names that a study has for them.
type Files = BTreeMap<PathBuf, Vec<u8>>;

fn texts(warnings: &[Diagnostic]) -> Vec<String> {
    warnings.iter().map(ToString::to_string).collect()
}

/// Computes all models of a plate or a specimen whose study has the text `study`, and compares them.
#[pyfunction]
#[pyo3(signature = (study, material, files, mesh=None, progress=None, allow_large=false))]
pub fn run_sheet(
    py: Python<'_>,
    study: String,
    material: &MaterialCard,
    files: Files,
    mesh: Option<&GivenMesh>,
    progress: Option<Py<PyAny>>,
    allow_large: bool,
) -> PyResult<Results> {
    run_watched(py, progress, |watch| {
        let mut read = read_sheet(&study, files, mesh, allow_large)?;
        let card = watched(material.in_study(&read.content.card), watch);
        read.content = read.content.with_card(card);
        let (kind, name) = sheet_kind(&read.content);
        let progress = |what: &str| watch.report(what);
        let ready = specimen::ready(kind, name.into(), &study, read);
        let results = ready.compute(Progress::to(&progress))?;
        Ok(Results::new(results, name.into()))
    })
}

/// Reads the study of a plate or a specimen, and raises what is wrong with it.
#[pyfunction]
#[pyo3(signature = (study, files, mesh=None))]
pub fn check_sheet(
    py: Python<'_>,
    study: &str,
    files: Files,
    mesh: Option<&GivenMesh>,
) -> PyResult<()> {
    // Whether a study is too large is checked for the models that are solved.
    let read = py.detach(|| read_sheet(study, files, mesh, true));
    raised(py, read.map(drop))
}

/// The kind of a study, and its name.
fn sheet_kind(specimen: &Specimen) -> (&'static Kind, &'static str) {
    match specimen.along {
        Along::Stretch => (&plate::PLATE, plate::KIND),
        Along::LoadFactor => (specimen_kind(), specimen::KIND),
    }
}

fn read_sheet(
    study: &str,
    files: Files,
    mesh: Option<&GivenMesh>,
    allow_large: bool,
) -> Result<Loaded<Specimen>, Error> {
    let budget = budget(allow_large);
    let read = with_files(files, || match mesh {
        Some(GivenMesh(mesh)) => {
            let file = Path::new(specimen::KIND);
            specimen::load_on(mesh, specimen_kind(), file, study, budget)
        }
        None => kinds::read_sheet(Path::new("sheet"), study, budget),
    })?;
    if !read.content.regions.is_empty() {
        let message = "the study states several materials, and a sheet in Python has the one that it is given";
        return Err(Error::input(
            message,
            "compute the study's file: gelbench.run",
        ));
    }
    Ok(read)
}

/// A mesh of the caller's.
#[pyclass(frozen, module = "gelbench._core")]
pub struct GivenMesh(MeshData);

#[pymethods]
impl GivenMesh {
    /// Places of the nodes, cells by VTK's numbers of their kinds, groups of nodes and of lines.
    #[new]
    fn new(
        py: Python<'_>,
        places: PyReadonlyArray2<'_, f64>,
        cells: Vec<(u8, PyReadonlyArray2<'_, i64>)>,
        nodes: BTreeMap<String, PyReadonlyArray1<'_, i64>>,
        lines: BTreeMap<String, PyReadonlyArray2<'_, i64>>,
    ) -> PyResult<Self> {
        let count = places.shape()[0];
        let number = |node: &i64| usize::try_from(*node).ok().filter(|node| *node < count);
        let numbers = |nodes: &[i64]| {
            let wrong = nodes.iter().find(|node| number(node).is_none());
            let message = |node| format!("the mesh has no node {node}: it has {count}");
            match wrong {
                Some(node) => Err(exception(
                    py,
                    &input(message(node), "nodes are counted from 0"),
                )),
                None => Ok(nodes.iter().filter_map(number).collect::<Vec<_>>()),
            }
        };
        let mut data = MeshData {
            positions: places
                .as_slice()?
                .chunks_exact(3)
                .map(|place| [place[0], place[1], place[2]])
                .collect(),
            ..MeshData::default()
        };
        for (kind, points) in cells {
            let shape = raised(py, shape(kind))?;
            for cell in points.as_slice()?.chunks(points.shape()[1].max(1)) {
                data.cells.push((shape, numbers(cell)?));
            }
        }
        for (name, members) in nodes {
            data.nodes.insert(name, numbers(members.as_slice()?)?);
        }
        for (name, pairs) in lines {
            let points = numbers(pairs.as_slice()?)?;
            let ends = points.chunks_exact(2).map(|ends| [ends[0], ends[1]]);
            data.lines.insert(name, ends.collect());
        }
        Ok(Self(data))
    }
}

/// The kind of a cell by VTK's number.
fn shape(kind: u8) -> Result<CellShape, Error> {
    CellShape::of_vtk_number(kind).ok_or_else(|| {
        let message = format!("cells of VTK type {kind} are not supported");
        let hint =
            "use triangles of 3 or 6 nodes (5, 22) and quadrilaterals of 4, 8 or 9 (9, 23, 28)";
        input(message, hint)
    })
}

fn specimen_kind() -> &'static Kind {
    kinds::named(specimen::KIND).expect("specimens are a kind of study")
}

/// Solves one model of a plate or a specimen whose study has the text `study`, on the mesh given if there is one.
#[pyfunction]
#[pyo3(signature = (study, material, files, model, mesh=None, progress=None, allow_large=false))]
#[expect(clippy::too_many_arguments, reason = "the problem's parts")]
pub fn solve_sheet(
    py: Python<'_>,
    study: &str,
    material: &MaterialCard,
    files: Files,
    model: &str,
    mesh: Option<&GivenMesh>,
    progress: Option<Py<PyAny>>,
    allow_large: bool,
) -> PyResult<Solution> {
    let kind = raised(py, choice("model", model, &ModelKind::NAMES))?;
    let work = |watch: &Arc<Watch>| {
        let Loaded {
            content: read,
            warnings,
            ..
        } = read_sheet(study, files, mesh, allow_large)?;
        let card = material.in_study(&read.card);
        let mut sheet = Sheet {
            law: Arc::clone(&card.law),
            thickness: read.problem.thickness,
            warnings: texts(&warnings),
            took: Duration::ZERO,
        };
        let read = read.with_card(watched(card, watch));
        check_memory(&*read.problem.law, "a single model in Python")?;
        let report = |what: &str| watch.report(what);
        let start = Instant::now();
        let solved = specimen::one_model(&read, kind, Progress::to(&report))?;
        sheet.took = start.elapsed();
        let groups = read.groups().into_iter().map(str::to_owned).collect();
        Ok((solved, sheet, groups))
    };
    let (solved, sheet, groups) = run_watched(py, progress, work)?;
    Solution::new(py, solved, sheet, groups)
}

/// A study of any kind: a file, or a text with the files that it names and no disk has.
fn ready(
    path: &Path,
    allow_large: bool,
    text: Option<String>,
    files: Files,
) -> Result<PreparedStudy, Error> {
    let budget = budget(allow_large);
    match text {
        Some(text) => with_files(files, || kinds::read_given(path, text, budget)),
        None => kinds::read(path, budget),
    }
}

/// Computes a study of any kind.
#[pyfunction]
#[pyo3(signature = (path, progress=None, allow_large=false, text=None, files=Files::new()))]
pub fn run(
    py: Python<'_>,
    path: PathBuf,
    progress: Option<Py<PyAny>>,
    allow_large: bool,
    text: Option<String>,
    files: Files,
) -> PyResult<Results> {
    run_watched(py, progress, |watch| {
        let ready = ready(&path, allow_large, text, files)?;
        let (folder, with_report) = (ready.output.folder.clone(), ready.output.report);
        let report = |what: &str| watch.report(what);
        let results = ready.compute(Progress::to(&report))?;
        Ok(Results {
            folder,
            with_report,
            ..Results::new(results, path)
        })
    })
}

/// A text with a unit as a number in `unit`: mm, N, MPa, s, rad, or a ratio without one.
#[pyfunction]
pub fn quantity(py: Python<'_>, text: &str, unit: &str) -> PyResult<f64> {
    let known = [
        ("mm", Dimension::Length),
        ("N", Dimension::Force),
        ("MPa", Dimension::Stress),
        ("s", Dimension::Time),
        ("rad", Dimension::Angle),
    ];
    let entry = known.iter().find(|(name, _)| *name == unit);
    let dimension = entry.map_or(Dimension::Ratio, |(_, dimension)| *dimension);
    units::parse(text, dimension)
        .map_err(|fault| exception(py, &refused(format!("\"{text}\": {fault}"))))
}

/// Reads a study of any kind and tells what it will compute, and what deserves attention.
#[pyfunction]
#[pyo3(signature = (path, allow_large=false, text=None, files=Files::new()))]
pub fn check(
    py: Python<'_>,
    path: PathBuf,
    allow_large: bool,
    text: Option<String>,
    files: Files,
) -> PyResult<(String, Vec<String>)> {
    let checked = py.detach(|| {
        let ready = ready(&path, allow_large, text, files)?;
        let warnings = ready.warnings.iter().map(ToString::to_string).collect();
        Ok((ready.about, warnings))
    });
    raised(py, checked)
}
