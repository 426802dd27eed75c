//! The equilibria of one model.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use gelbench::corrector::Multipliers;
use gelbench::material::HyperelasticLaw;
use gelbench::mesh::Mesh;
use gelbench::problem::{DeformedSheet, GroupState};
use gelbench::results::{self, Grid};
use gelbench::solve::Convergence;
use gelbench_studies::studies::OneModel;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{exception, refused};
use crate::fields::{Arrays, arrays, frozen_vectors, mesh_blocks, places, rows};
use crate::running::caught;

/// What a solution needs besides its states.
pub struct Sheet {
    pub law: Arc<dyn HyperelasticLaw>,
    pub thickness: f64,
    /// What deserves attention in the study and the states.
    pub warnings: Vec<String>,
    /// The time that the library took.
    pub took: Duration,
}

/// The equilibria of one model, and the mesh that they live on.
#[pyclass(frozen, module = "gelbench._core")]
pub struct Solution {
    sheet: Sheet,
    mesh: Arc<Mesh>,
    points: Py<PyArray2<f64>>,
    groups: Vec<String>,
    states: Vec<State>,
    /// Why other load factors were not reached.
    ends: Vec<Py<PyAny>>,
}

struct State {
    factor: f64,
    displacement: Py<PyArray2<f64>>,
    residual: Py<PyArray2<f64>>,
    force: f64,
    balance: f64,
    /// The strain energy in mJ.
    energy: f64,
    at_groups: Vec<GroupState>,
    multipliers: Vec<Multipliers>,
    convergence: Convergence,
    sheet: OnceLock<DeformedSheet>,
}

impl Solution {
    pub fn new(
        py: Python<'_>,
        model: OneModel,
        mut sheet: Sheet,
        groups: Vec<String>,
    ) -> PyResult<Self> {
        sheet
            .warnings
            .extend(model.warnings.iter().map(ToString::to_string));
        let ends = model
            .ends
            .iter()
            .map(|end| exception(py, end).into_value(py).into_any())
            .collect();
        let solution = model.solution;
        let at_groups: Vec<Vec<GroupState>> = (0..solution.reached())
            .map(|step| solution.groups(step).unwrap_or_default().to_vec())
            .collect();
        let numbers = solution.balances.into_iter().zip(model.forces);
        let numbers = numbers.zip(solution.energies);
        let others = numbers.zip(at_groups).zip(model.multipliers);
        let states = solution.states.into_iter().zip(others);
        let states = states.map(
            |(state, ((((balance, force), energy), at_groups), multipliers))| {
                let array = |values| Ok::<_, PyErr>(frozen_vectors(py, values)?.unbind());
                Ok(State {
                    factor: state.factor,
                    displacement: array(state.displacement)?,
                    residual: array(state.residual)?,
                    force,
                    balance,
                    energy,
                    at_groups,
                    multipliers,
                    convergence: state.convergence,
                    sheet: OnceLock::new(),
                })
            },
        );
        Ok(Self {
            states: states.collect::<PyResult<_>>()?,
            points: places(py, &solution.mesh.nodes)?.unbind(),
            mesh: Arc::new(solution.mesh),
            sheet,
            groups,
            ends,
        })
    }

    fn state(&self, step: usize) -> PyResult<&State> {
        let state = self.states.get(step);
        state.ok_or_else(|| PyIndexError::new_err("there is no such load factor"))
    }
}

#[pymethods]
impl Solution {
    /// A copy is the same: nothing in it changes.
    fn __copy__(solution: Py<Self>) -> Py<Self> {
        solution
    }

    fn __deepcopy__(solution: Py<Self>, _memo: Py<PyAny>) -> Py<Self> {
        solution
    }

    #[getter]
    fn points(&self, py: Python<'_>) -> Py<PyArray2<f64>> {
        self.points.clone_ref(py)
    }

    #[getter]
    fn thickness(&self) -> f64 {
        self.sheet.thickness
    }

    #[getter]
    fn seconds(&self) -> f64 {
        self.sheet.took.as_secs_f64()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.sheet.warnings.clone()
    }

    #[getter]
    fn ends(&self, py: Python<'_>) -> Vec<Py<PyAny>> {
        self.ends.iter().map(|end| end.clone_ref(py)).collect()
    }

    fn __len__(&self) -> usize {
        self.states.len()
    }

    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(mesh_blocks(py, &self.mesh)?.into_pyobject(py)?.into_any())
    }

    fn group_nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let nodes_by_name = PyDict::new(py);
        for (name, group) in self.mesh.groups() {
            let nodes = group.nodes.iter().map(|node| *node as i64);
            nodes_by_name.set_item(name, PyArray1::from_iter(py, nodes))?;
        }
        Ok(nodes_by_name)
    }

    fn factors(&self) -> Vec<f64> {
        self.states.iter().map(|state| state.factor).collect()
    }

    fn forces(&self) -> Vec<f64> {
        self.states.iter().map(|state| state.force).collect()
    }

    fn balance(&self, step: usize) -> PyResult<f64> {
        Ok(self.state(step)?.balance)
    }

    fn energy(&self, step: usize) -> PyResult<f64> {
        Ok(self.state(step)?.energy)
    }

    fn residuals(&self, step: usize) -> PyResult<Vec<f64>> {
        Ok(self.state(step)?.convergence.residuals.clone())
    }

    fn displacement(&self, py: Python<'_>, step: usize) -> PyResult<Py<PyArray2<f64>>> {
        Ok(self.state(step)?.displacement.clone_ref(py))
    }

    fn residual(&self, py: Python<'_>, step: usize) -> PyResult<Py<PyArray2<f64>>> {
        Ok(self.state(step)?.residual.clone_ref(py))
    }

    /// Force, moment and mean displacement at each group that is held, loaded or measured.
    fn at_groups<'py>(&self, py: Python<'py>, step: usize) -> PyResult<Bound<'py, PyDict>> {
        let states_by_name = PyDict::new(py);
        for (name, state) in self.groups.iter().zip(&self.state(step)?.at_groups) {
            states_by_name.set_item(name, (state.force, state.moment, state.displacement))?;
        }
        Ok(states_by_name)
    }

    fn multipliers<'py>(&self, py: Python<'py>, step: usize) -> PyResult<Bound<'py, PyDict>> {
        let values_by_name = PyDict::new(py);
        for one in &self.state(step)?.multipliers {
            values_by_name.set_item(&one.name, PyArray1::from_slice(py, &one.values))?;
        }
        Ok(values_by_name)
    }

    /// The arrays at the nodes and in the cells, as VTK files hold them.
    fn arrays<'py>(&self, py: Python<'py>, step: usize) -> PyResult<Arrays<'py>> {
        let displacement = self.state(step)?.displacement.bind(py).readonly();
        let displacement = displacement.as_slice()?;
        let Sheet { law, thickness, .. } = &self.sheet;
        let grid = caught(py, || {
            let sheet = results::Sheet {
                laws: law.into(),
                thickness: *thickness,
                past: &[],
                viscous: None,
            };
            Grid::sheet(sheet, &self.mesh, displacement)
        })?;
        arrays(py, grid)
    }

    /// Displacement [mm], Cauchy stress 11, 22, 12 [MPa] and principal stretches at points by their places at rest.
    fn at<'py>(
        &self,
        py: Python<'py>,
        step: usize,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<[Bound<'py, PyArray2<f64>>; 3]> {
        let state = self.state(step)?;
        let values = points.as_slice()?;
        let field = state.displacement.bind(py).readonly();
        let field = field.as_slice()?;
        let values_at_points = caught(py, || {
            let sheet = state.sheet.get_or_init(|| {
                let law = Arc::clone(&self.sheet.law);
                DeformedSheet::new((*self.mesh).clone(), field.to_vec(), law)
            });
            let places = values.chunks_exact(2).map(|place| [place[0], place[1]]);
            let asked = places.map(|place| {
                let [s11, s12, s22] = sheet.stress_at(place)?.cauchy;
                let stretches = sheet.principal_stretches_at(place)?;
                Ok((sheet.displacement_at(place)?, [s11, s22, s12], stretches))
            });
            asked.collect::<Result<Vec<_>, gelbench::problem::PointFault>>()
        })?;
        let values_at_points =
            values_at_points.map_err(|fault| exception(py, &refused(fault.to_string())))?;
        debug_assert_eq!(values_at_points.len(), points.shape()[0]);
        let of = |values: Vec<f64>, width| rows(py, values, width);
        Ok([
            of(values_at_points.iter().flat_map(|(u, ..)| *u).collect(), 2)?,
            of(
                values_at_points.iter().flat_map(|(_, s, _)| *s).collect(),
                3,
            )?,
            of(values_at_points.iter().flat_map(|(.., l)| *l).collect(), 3)?,
        ])
    }
}
