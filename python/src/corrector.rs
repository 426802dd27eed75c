//! The corrector for conditions that Python hands over.

use gelbench::corrector::{
    Condition, Corrector, CorrectorSettings, Linearisation, Multipliers, Solver,
};
use gelbench::error::Error;
use gelbench::solve::{Inadmissible, SparseRows};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::errors::{choice, exception, input};
use crate::running::{Watch, run};

/// A sparse matrix by rows: begins of rows, columns, values.
type Csr<'py> = (
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, f64>,
);

/// The rows of a sparse matrix of the condition `name` with so many columns.
fn sparse_rows(name: &str, columns: usize, matrix: &Csr<'_>) -> PyResult<SparseRows> {
    let (begins, places, values) = matrix;
    let (begins, places, values) = (begins.as_slice()?, places.as_slice()?, values.as_slice()?);
    let wrong = |what: String| {
        let message = format!("conditions: a matrix of `{name}` {what}");
        let hint = "indptr must ascend from 0 to the number of entries; indices are columns counted from 0";
        Python::attach(|py| Err(exception(py, &input(message, hint))))
    };
    let mut rows = SparseRows::new(columns);
    for ends in begins.windows(2) {
        let range = ends[0] as usize..ends[1] as usize;
        let (Some(places), Some(values)) = (places.get(range.clone()), values.get(range)) else {
            return wrong(format!(
                "has a row from entry {} to {}, and {} entries",
                ends[0],
                ends[1],
                values.len().min(places.len())
            ));
        };
        let outside = |place: &&i64| !usize::try_from(**place).is_ok_and(|index| index < columns);
        if let Some(place) = places.iter().find(outside) {
            return wrong(format!(
                "has an entry in column {place}, and {columns} columns"
            ));
        }
        let row = places.iter().zip(values);
        rows.push(row.map(|(column, value)| (*column as usize, *value)));
    }
    Ok(rows)
}

/// A group of conditions from Python. The callable `linearise` returns values and the Jacobian by rows at a field.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given {
    name: String,
    rows: usize,
    linearise: Py<PyAny>,
    curvature: Option<Py<PyAny>>,
    unknowns: Option<Vec<usize>>,
}

/// Conditions of Python in a computation that can be ended.
struct PythonCondition<'a> {
    given: Given,
    watch: &'a Watch,
}

impl PythonCondition<'_> {
    fn call(&self, u: &[f64]) -> Linearisation {
        self.watch.check();
        let linearisation = Python::attach(|py| {
            let pair = self
                .given
                .linearise
                .call1(py, (PyArray1::from_slice(py, u),))?;
            let (values, jacobian): (PyReadonlyArray1<'_, f64>, Csr<'_>) = pair.extract(py)?;
            Ok(Linearisation {
                values: values.as_slice()?.to_vec(),
                jacobian: sparse_rows(&self.given.name, u.len(), &jacobian)?,
            })
        });
        linearisation.unwrap_or_else(|error| self.watch.fail(error))
    }
}

impl Condition for PythonCondition<'_> {
    fn name(&self) -> &str {
        &self.given.name
    }

    fn rows(&self) -> usize {
        self.given.rows
    }

    fn linearise(&self, u: &[f64]) -> Result<Linearisation, Inadmissible> {
        let linearisation = self.call(u);
        // A trial field at which the conditions have no value is too long a step.
        if linearisation.values.iter().all(|value| value.is_finite()) {
            Ok(linearisation)
        } else {
            Err(Inadmissible { element: 0 })
        }
    }

    fn curvature(
        &self,
        u: &[f64],
        multipliers: &[f64],
    ) -> Result<Option<SparseRows>, Inadmissible> {
        let Some(curvature) = &self.given.curvature else {
            return Ok(None);
        };
        self.watch.check();
        let matrix = Python::attach(|py| {
            let field = PyArray1::from_slice(py, u);
            let multipliers = PyArray1::from_slice(py, multipliers);
            let matrix = curvature.call1(py, (field, multipliers))?;
            let matrix: Csr<'_> = matrix.extract(py)?;
            sparse_rows(&self.given.name, u.len(), &matrix)
        });
        Ok(Some(matrix.unwrap_or_else(|error| self.watch.fail(error))))
    }

    fn unknowns(&self) -> Option<&[usize]> {
        self.given.unknowns.as_deref()
    }
}

/// When a correction ends.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    tolerance: f64,
    movement: f64,
    max_steps: usize,
    solver: String,
}

const SOLVERS: [(&str, Solver); 5] = [
    ("automatic", Solver::Automatic),
    ("dense", Solver::Dense),
    ("cholesky", Solver::Cholesky),
    ("kkt", Solver::Kkt),
    ("symmetric", Solver::Symmetric),
];

impl Settings {
    fn read(&self) -> Result<CorrectorSettings, Error> {
        Ok(CorrectorSettings {
            tolerance: self.tolerance,
            movement: self.movement,
            max_steps: self.max_steps,
            solver: choice("solver", &self.solver, &SOLVERS)?,
        })
    }
}

/// Value, standard error and 95 % interval.
type Estimate = (f64, f64, (f64, f64));

/// Field, residuals of the steps, shares of the steps, multipliers, estimates.
type Corrected<'py> = (
    Bound<'py, PyArray1<f64>>,
    Vec<f64>,
    Vec<f64>,
    Vec<(String, Bound<'py, PyArray1<f64>>)>,
    Vec<Estimate>,
);

/// The field nearest to `data` that satisfies the conditions, sought from `start`.
#[pyfunction]
#[pyo3(signature = (data, start, weights, conditions, settings, estimate, progress=None))]
#[expect(clippy::too_many_arguments, reason = "the problem's parts")]
pub fn corrected<'py>(
    py: Python<'py>,
    data: PyReadonlyArray1<'py, f64>,
    start: PyReadonlyArray1<'py, f64>,
    weights: PyReadonlyArray1<'py, f64>,
    conditions: Vec<Given>,
    settings: Settings,
    estimate: Vec<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Corrected<'py>> {
    let data = data.as_slice()?.to_vec();
    let start = start.as_slice()?.to_vec();
    let weights = weights.as_slice()?.to_vec();
    let (field, residuals, lengths, multipliers, estimates) = run(py, progress, |watch| {
        let conditions = conditions
            .into_iter()
            .map(|given| Box::new(PythonCondition { given, watch }) as Box<dyn Condition + '_>);
        let corrector = Corrector::new(conditions.collect(), weights, settings.read()?);
        let failed = |fault| Error::Solve {
            model: "corrector".into(),
            step: "the given field".into(),
            fault,
        };
        let solution = corrector.correct(&data, &start).map_err(failed)?;
        let one = |unknown: &usize| {
            let estimated = corrector
                .estimate(&data, &solution, *unknown)
                .map_err(failed)?;
            Ok((
                estimated.value,
                estimated.standard_error,
                estimated.interval.into(),
            ))
        };
        let estimates = estimate
            .iter()
            .map(one)
            .collect::<Result<Vec<Estimate>, Error>>()?;
        Ok((
            solution.field().to_vec(),
            solution.steps.iter().map(|step| step.residual).collect(),
            solution.steps.iter().map(|step| step.length).collect(),
            solution.multipliers,
            estimates,
        ))
    })?;
    let named = |one: Multipliers| (one.name, PyArray1::from_vec(py, one.values));
    let multipliers = multipliers.into_iter().map(named).collect();
    let field = PyArray1::from_vec(py, field);
    Ok((field, residuals, lengths, multipliers, estimates))
}
