//! Laws that Python hands over, and laws that let a computation end.

use std::fmt;
use std::panic::resume_unwind;
use std::sync::Arc;

use gelbench::material::PlaneState;
use gelbench::material::sheet::{Kinematics, PlaneTensor, SheetResponse};
use gelbench::material::{Code, CodeLaw};
use gelbench::material::{
    EnergyDerivatives, HyperelasticLaw, InvariantLaw, Invariants, Softening, Volume,
};
use gelbench_mechanics::material::law::TensionResponse;
use gelbench_mechanics::material::sheet::COMPONENTS;
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::running::Watch;

/// An exception in a law written in Python, on its way out of a computation.
pub struct Raised(PyErr);

impl Raised {
    /// The exception.
    pub fn error(&self) -> PyErr {
        Python::attach(|py| self.0.clone_ref(py))
    }
}

/// A law of the first two invariants as a Python callable: arrays of I₁ and I₂ to an array with the rows Ψ, Ψ₁, Ψ₂, Ψ₁₁, Ψ₁₂,
/// Ψ₂₂, one for each point.
struct Callable(Py<PyAny>);

impl Callable {
    fn at_all(&self, points: &[Invariants]) -> Vec<EnergyDerivatives> {
        let found = Python::attach(|py| self.call(py, points));
        found.unwrap_or_else(|error| resume_unwind(Box::new(Raised(error))))
    }

    fn call(&self, py: Python<'_>, points: &[Invariants]) -> PyResult<Vec<EnergyDerivatives>> {
        let array = |of: fn(&Invariants) -> f64| {
            PyArray1::from_iter(py, points.iter().map(|point| 3.0 + of(point)))
        };
        let i1 = array(|point| point.i1_minus_3);
        let i2 = array(|point| point.i2_minus_3);
        let found = self.0.call1(py, (i1, i2))?;
        let found: PyReadonlyArray2<'_, f64> = found.extract(py)?;
        let rows = found.as_array();
        let row = |row: usize| EnergyDerivatives {
            energy: rows[[row, 0]],
            d1: rows[[row, 1]],
            d2: rows[[row, 2]],
            d11: rows[[row, 3]],
            d12: rows[[row, 4]],
            d22: rows[[row, 5]],
        };
        Ok((0..points.len()).map(row).collect())
    }
}

impl fmt::Debug for Callable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a law in Python")
    }
}

impl InvariantLaw for Callable {
    fn evaluate(&self, at: Invariants) -> EnergyDerivatives {
        self.at_all(&[at])[0]
    }
}

/// A law written in Python, asked at many points at once where the library asks so.
#[derive(Debug)]
pub struct PythonLaw(Arc<Callable>);

impl PythonLaw {
    /// Of a callable.
    pub fn new(evaluate: Py<PyAny>) -> Self {
        Self(Arc::new(Callable(evaluate)))
    }

    /// The states of many points, and what the law says of them; nothing where J is not positive at one.
    fn at_all(&self, gradients: [&[f64]; 4]) -> Option<(Vec<Kinematics>, Vec<EnergyDerivatives>)> {
        let points = 0..gradients[0].len();
        let at = |point: usize| {
            Kinematics::new(&gradients.map(|component| component[point]).into()).ok()
        };
        let states = points.map(at).collect::<Option<Vec<_>>>()?;
        let invariants: Vec<Invariants> = states.iter().map(|state| state.invariants).collect();
        let derivatives = self.0.at_all(&invariants);
        Some((states, derivatives))
    }
}

impl HyperelasticLaw for PythonLaw {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        self.0.stress(kinematics)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        self.0.response(kinematics)
    }

    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse {
        self.0.tension(direction, strain)
    }

    fn stresses(&self, gradients: [&[f64]; 4], mut stresses: [&mut [f64]; 4]) -> bool {
        let Some((states, derivatives)) = self.at_all(gradients) else {
            return false;
        };
        for (point, (state, derivatives)) in states.iter().zip(&derivatives).enumerate() {
            let (_, stress) = state.stress(derivatives);
            for (component, value) in stresses.iter_mut().zip(stress.iter()) {
                component[point] = *value;
            }
        }
        true
    }

    fn responses(
        &self,
        gradients: [&[f64]; 4],
        mut responses: [&mut [f64]; COMPONENTS],
        _tangents: bool,
    ) -> bool {
        let Some((states, derivatives)) = self.at_all(gradients) else {
            return false;
        };
        for (point, (state, derivatives)) in states.iter().zip(&derivatives).enumerate() {
            let components = state.response(derivatives).components();
            for (all, own) in responses.iter_mut().zip(components) {
                all[point] = own;
            }
        }
        true
    }

    fn with_volume(self: Arc<Self>, volume: Volume) -> Option<Arc<dyn HyperelasticLaw>> {
        Arc::clone(&self.0).with_volume(volume)
    }

    fn shear_modulus(&self) -> f64 {
        self.0.shear_modulus()
    }

    fn youngs_modulus(&self) -> f64 {
        self.0.youngs_modulus()
    }
}

/// A law as it is, which ends the computation that asks it if that is to end.
pub struct Watched {
    law: Arc<dyn HyperelasticLaw>,
    watch: Arc<Watch>,
}

impl Watched {
    /// A law under a watch.
    pub fn law(law: &Arc<dyn HyperelasticLaw>, watch: &Arc<Watch>) -> Arc<dyn HyperelasticLaw> {
        Arc::new(Self {
            law: Arc::clone(law),
            watch: Arc::clone(watch),
        })
    }
}

impl fmt::Debug for Watched {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.law.fmt(formatter)
    }
}

impl HyperelasticLaw for Watched {
    fn stress(&self, kinematics: &Kinematics) -> (f64, PlaneTensor) {
        self.watch.check();
        self.law.stress(kinematics)
    }

    fn response(&self, kinematics: &Kinematics) -> SheetResponse {
        self.watch.check();
        self.law.response(kinematics)
    }

    fn tension(&self, direction: [f64; 2], strain: f64) -> TensionResponse {
        self.watch.check();
        self.law.tension(direction, strain)
    }

    fn biaxial(&self, strains: [f64; 2]) -> [f64; 2] {
        self.law.biaxial(strains)
    }

    fn stresses(&self, gradients: [&[f64]; 4], stresses: [&mut [f64]; 4]) -> bool {
        self.watch.check();
        self.law.stresses(gradients, stresses)
    }

    fn responses(
        &self,
        gradients: [&[f64]; 4],
        responses: [&mut [f64]; COMPONENTS],
        tangents: bool,
    ) -> bool {
        self.watch.check();
        self.law.responses(gradients, responses, tangents)
    }

    fn in_code(&self, code: Code, bulk_modulus: f64) -> Option<CodeLaw> {
        self.law.in_code(code, bulk_modulus)
    }

    fn softening(&self) -> Option<Softening> {
        self.law.softening()
    }

    fn volume_ratio(&self, kinematics: &Kinematics) -> f64 {
        self.law.volume_ratio(kinematics)
    }

    fn thickness_stretch(&self, kinematics: &Kinematics) -> f64 {
        self.law.thickness_stretch(kinematics)
    }

    fn thickness_gradient(&self, kinematics: &Kinematics) -> PlaneTensor {
        self.law.thickness_gradient(kinematics)
    }

    fn thickness_stress(&self, kinematics: &Kinematics) -> f64 {
        self.law.thickness_stress(kinematics)
    }

    fn cauchy_stress(&self, kinematics: &Kinematics, stress: &PlaneTensor) -> [f64; 3] {
        self.law.cauchy_stress(kinematics, stress)
    }

    fn plane_state(&self) -> PlaneState {
        self.law.plane_state()
    }

    fn is_for_small_strains(&self) -> bool {
        self.law.is_for_small_strains()
    }

    fn in_plane_strain(&self) -> Option<Arc<dyn HyperelasticLaw>> {
        self.law.in_plane_strain()
    }

    fn bulk_modulus(&self) -> Option<f64> {
        self.law.bulk_modulus()
    }

    fn with_volume(self: Arc<Self>, volume: Volume) -> Option<Arc<dyn HyperelasticLaw>> {
        Arc::clone(&self.law).with_volume(volume)
    }

    fn statements(&self) -> Vec<(&'static str, String)> {
        self.law.statements()
    }

    fn is_objective(&self) -> bool {
        self.law.is_objective()
    }

    fn is_isotropic(&self) -> bool {
        self.law.is_isotropic()
    }

    fn shear_modulus(&self) -> f64 {
        self.law.shear_modulus()
    }

    fn youngs_modulus(&self) -> f64 {
        self.law.youngs_modulus()
    }
}
