//! Many runs of a study.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use gelbench::error::Error;
use gelbench::sweep::{
    self, BaseStudy, FittedParameters, Method, Points, Row, Run, Sampling, Setting, Shard, Share,
    SweepFolder, Values, Variable,
};
use gelbench_studies::studies::sections::read_text;
use gelbench_studies::studies::{Steps, name};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{choice, input, raised, refused};
use crate::fields::frozen;
use crate::results::drawn;
use crate::running::run as run_watched;
use crate::study::budget;

/// The values of a key: a text as behind `--vary KEY=`, or a text for each.
#[derive(FromPyObject)]
pub enum Varied {
    Text(String),
    Listed(Vec<String>),
}

/// A distribution: key, whether it is normal, its two numbers, their unit.
type Distribution = (String, bool, [f64; 2], String);

fn variable(key: &str, values: &Varied) -> Result<Variable, Error> {
    Ok(match values {
        Varied::Text(text) => Variable::parse(&format!("{key}={text}"))?,
        Varied::Listed(texts) => Variable::listed(key, texts)?,
    })
}

/// The distributions among what is varied.
#[pyfunction]
pub fn distributions(py: Python<'_>, vary: Vec<(String, Varied)>) -> PyResult<Vec<Distribution>> {
    let of = |(key, values): &(String, Varied)| {
        let variable = variable(key, values)?;
        match variable.values {
            Values::Between(ends, unit) => Ok((variable.key, false, ends, unit)),
            Values::Normal(normal, unit) => Ok((variable.key, true, normal, unit)),
            Values::Listed(_) => {
                let hint = "give LOW..HIGH or MEAN+-DEVIATION, followed by a unit";
                Err(input(format!("`{key}` is not a distribution"), hint))
            }
        }
    };
    raised(py, vary.iter().map(of).collect())
}

/// The text of a study or a fit.
#[pyfunction]
pub fn text_of_file(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    raised(py, py.detach(|| read_text(&path)))
}

const METHODS: [(&str, Method); 2] = [("sobol", Method::Sobol), ("random", Method::Random)];

/// A study with what is varied.
#[pyclass(frozen, module = "gelbench._core")]
pub struct Sweep {
    sweep: sweep::Sweep,
    runs: Vec<Run>,
}

#[pymethods]
impl Sweep {
    /// Of a study's path and text, files in memory that the text names, what is varied, and how points are drawn.
    #[new]
    #[pyo3(signature = (path, text, files, vary, points, fit, samples, method, seed, allow_large))]
    #[expect(
        clippy::too_many_arguments,
        reason = "each is a keyword of gelbench.sweep"
    )]
    fn new(
        py: Python<'_>,
        path: PathBuf,
        text: String,
        files: BTreeMap<PathBuf, Vec<u8>>,
        vary: Vec<(String, Varied)>,
        points: Option<Vec<(String, Vec<String>)>>,
        fit: Option<(String, String)>,
        samples: Option<usize>,
        method: &str,
        seed: u32,
        allow_large: bool,
    ) -> PyResult<Self> {
        let planned = || -> Result<Self, Error> {
            let variables = vary.iter().map(|(key, values)| variable(key, values));
            let points = points.as_deref().map(Points::of_columns).transpose();
            let fitted = fit.map(|(name, text)| FittedParameters::parse(&name, &text));
            let sweep = sweep::Sweep {
                variables: variables.collect::<Result<_, _>>()?,
                points: points?,
                fitted: fitted.transpose()?,
                sampling: Sampling {
                    samples,
                    method: choice("method", method, &METHODS)?,
                    seed,
                },
                study: BaseStudy {
                    path,
                    text,
                    files: files.into_iter().collect(),
                    budget: budget(allow_large),
                },
            };
            let runs = sweep.runs()?;
            sweep.study.read()?;
            Ok(Self { sweep, runs })
        };
        raised(py, py.detach(planned))
    }

    fn __len__(&self) -> usize {
        self.runs.len()
    }

    /// What is set in every run: heads with units, and the values.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let runs = self.runs.iter().map(|run| &run.settings[..]);
        columns(py, &self.sweep.keys(), runs)
    }

    /// Computes the runs, or those of one part of so many, or puts the parts in a folder together.
    #[pyo3(signature = (part, join, folder, inputs, program, progress=None))]
    #[expect(
        clippy::too_many_arguments,
        reason = "each is a keyword of gelbench.sweep"
    )]
    fn run(
        &self,
        py: Python<'_>,
        part: Option<(usize, usize)>,
        join: Option<usize>,
        folder: Option<PathBuf>,
        inputs: Vec<PathBuf>,
        program: PathBuf,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<SweepTable> {
        run_watched(py, progress, |watch| {
            let share = share(part, join)?;
            let ended = |number: usize| watch.report(&format!("run {number}"));
            let attend = || watch.check();
            let mut table = SweepTable::of(&self.sweep, Vec::new());
            let Some(folder) = folder else {
                let in_share = self.runs.iter().filter(|run| match share {
                    Share::Shard(shard) => shard.holds(run),
                    _ => true,
                });
                let share_runs: Vec<Run> = in_share.cloned().collect();
                let keep = |row: &Row| {
                    ended(row.number);
                    Ok(())
                };
                table.rows = self
                    .sweep
                    .compute(&share_runs, HashMap::new(), &keep, &attend)?;
                return Ok(table);
            };
            let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
            let open = SweepFolder::open(&self.sweep, share, &folder, &inputs, Some(&program));
            let mut folder = open?;
            table.rows = folder.rows(&ended, &attend)?;
            let (files, warnings) = folder.finish(&table.rows)?;
            table.files = files;
            table.warnings = warnings.iter().map(ToString::to_string).collect();
            Ok(table)
        })
    }

    /// The tables of all parts as one.
    fn join(&self, py: Python<'_>, tables: Vec<PyRef<'_, SweepTable>>) -> PyResult<SweepTable> {
        let rows = tables.iter().flat_map(|table| table.rows.clone());
        let rows = raised(py, sweep::join(&self.runs, rows.collect()))?;
        Ok(SweepTable::of(&self.sweep, rows))
    }
}

fn share(part: Option<(usize, usize)>, join: Option<usize>) -> Result<Share, Error> {
    match (part, join) {
        (None, None) => Ok(Share::Whole),
        (None, Some(parts)) => Ok(Share::Join(parts)),
        (Some((part, parts)), None) => Shard::new(part, parts).map(Share::Shard).ok_or_else(|| {
            let message = format!("there is no part {part} of {parts}");
            input(
                message,
                "give the part, counted from 1, and the number of parts",
            )
        }),
        (Some(_), Some(_)) => Err(refused("compute one part or join all parts, not both")),
    }
}

/// What is set in every run: heads with units, and the values.
fn columns<'py, 'a>(
    py: Python<'py>,
    keys: &[String],
    runs: impl Iterator<Item = &'a [Setting]> + Clone,
) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let column = |(place, key): (usize, &String)| {
        let settings: Vec<&Setting> = runs.clone().map(|settings| &settings[place]).collect();
        let unit = settings.first().map_or("", |setting| setting.unit());
        Ok((sweep::headed(key, unit), values(py, &settings)?))
    };
    keys.iter().enumerate().map(column).collect()
}

/// Numbers as an array, texts as a list.
fn values<'py>(py: Python<'py>, settings: &[&Setting]) -> PyResult<Bound<'py, PyAny>> {
    let numbers: Option<Vec<f64>> = settings.iter().map(|setting| setting.value()).collect();
    match numbers {
        Some(numbers) => Ok(frozen(PyArray1::from_vec(py, numbers))?.into_any()),
        None => {
            let words: Vec<String> = settings
                .iter()
                .map(|setting| setting.plain_text())
                .collect();
            Ok(words.into_pyobject(py)?.into_any())
        }
    }
}

/// The rows of a sweep.
#[pyclass(frozen, module = "gelbench._core")]
pub struct SweepTable {
    name: String,
    keys: Vec<String>,
    /// What steps run along.
    along: Steps,
    rows: Vec<Row>,
    files: Vec<PathBuf>,
    warnings: Vec<String>,
}

impl SweepTable {
    fn of(sweep: &sweep::Sweep, rows: Vec<Row>) -> Self {
        Self {
            name: name(&sweep.study.path),
            keys: sweep.keys(),
            along: sweep.study.steps_run_along(),
            rows,
            files: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

#[pymethods]
impl SweepTable {
    /// Of the text of a table.
    #[staticmethod]
    fn parse(py: Python<'_>, name: String, keys: Vec<String>, table: &[u8]) -> PyResult<Self> {
        let rows = sweep::read(Path::new(&name), &keys, table);
        Ok(Self {
            rows: raised(py, rows)?,
            name,
            keys,
            // A table does not tell the kind of its study.
            along: Steps::Unknown,
            files: Vec::new(),
            warnings: Vec::new(),
        })
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn keys(&self) -> Vec<String> {
        self.keys.clone()
    }

    #[getter]
    fn files(&self) -> Vec<PathBuf> {
        self.files.clone()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        let cautions = sweep::cautions(&self.rows);
        self.warnings.iter().cloned().chain(cautions).collect()
    }

    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// The text of `sweep.csv`.
    fn csv<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| sweep::write(&self.keys, &self.rows)))
    }

    /// The text of `sweep.json`.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| format!("{:#}\n", sweep::json(&self.keys, &self.rows)))
    }

    fn numbers<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let numbers = self.rows.iter().map(|row| row.number as i64);
        PyArray1::from_iter(py, numbers)
    }

    fn passed<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_iter(py, self.rows.iter().map(|row| row.passed))
    }

    fn faults(&self) -> Vec<&str> {
        self.rows.iter().map(|row| row.fault.as_str()).collect()
    }

    /// The warnings of each run, as one text.
    fn run_warnings(&self) -> Vec<String> {
        self.rows.iter().map(Row::joined_warnings).collect()
    }

    /// What was set: heads with units, and the values.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let rows = self.rows.iter().map(|row| &row.settings[..]);
        columns(py, &self.keys, rows)
    }

    /// The figures by their names, NaN where a run has none.
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyArray1<f64>>)>> {
        let columns = py.detach(|| {
            let names = sweep::names(&self.rows);
            let mut columns = vec![vec![f64::NAN; self.rows.len()]; names.len()];
            let places: HashMap<&str, usize> = names.iter().copied().zip(0..).collect();
            for (line, row) in self.rows.iter().enumerate() {
                for (name, value) in &row.figures {
                    columns[places[name.as_str()]][line] = *value;
                }
            }
            let names = names.into_iter().map(str::to_owned);
            names.zip(columns).collect::<Vec<_>>()
        });
        let columns = columns.into_iter();
        columns
            .map(|(name, column)| Ok((name, frozen(PyArray1::from_vec(py, column))?)))
            .collect()
    }

    /// Names of the report's pictures, and each as a PNG.
    fn pictures<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyBytes>)>> {
        let drawn = py.detach(|| {
            let figures = sweep::figures(&self.keys, &self.rows, self.along);
            let drawn = figures
                .iter()
                .map(|figure| Ok((figure.name.clone(), drawn(&figure.drawing)?)));
            drawn.collect::<Result<Vec<_>, Error>>()
        });
        let drawn = raised(py, drawn)?.into_iter();
        Ok(drawn
            .map(|(name, picture)| (name, PyBytes::new(py, &picture)))
            .collect())
    }
}
