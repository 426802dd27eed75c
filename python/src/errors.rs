//! The library's errors as Python's exceptions, which `gelbench._errors` defines.

use gelbench::error::{Diagnostic, Error, Severity, SolveFault};
use gelbench_base::error::nearest;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The exception of an error, with the library's own text.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    converted(py, error).unwrap_or_else(|fault| fault)
}

/// A result of the library, whose error becomes an exception.
pub fn raised<T>(py: Python<'_>, result: Result<T, Error>) -> PyResult<T> {
    result.map_err(|error| exception(py, &error))
}

fn converted(py: Python<'_>, error: &Error) -> PyResult<PyErr> {
    let module = py.import("gelbench._errors")?;
    let raised = match error {
        Error::Input(faults) => {
            let class = module.getattr("Fault")?;
            let descriptions = faults.iter().map(|fault| described(&class, fault));
            let described = descriptions.collect::<PyResult<Vec<_>>>()?;
            module
                .getattr("InputError")?
                .call1((without_warnings(faults).to_string(), described))?
        }
        Error::Solve { model, step, fault } => {
            let keywords = PyDict::new(py);
            keywords.set_item("model", model)?;
            keywords.set_item("step", step)?;
            keywords.set_item("cause", fault.to_string())?;
            keywords.set_item("cell", position(fault))?;
            keywords.set_item("advice", fault.advice())?;
            let class = module.getattr("SolveError")?;
            class.call((error.to_string(),), Some(&keywords))?
        }
        Error::Write { .. } => module.getattr("WriteError")?.call1((error.to_string(),))?,
    };
    Ok(PyErr::from_value(raised))
}

/// The faults that must be mended; warnings are among the attributes of the exception.
fn without_warnings(faults: &[Diagnostic]) -> Error {
    let errors: Vec<Diagnostic> = faults
        .iter()
        .filter(|fault| fault.severity == Severity::Error)
        .cloned()
        .collect();
    Error::Input(if errors.is_empty() {
        faults.to_vec()
    } else {
        errors
    })
}

fn described<'py>(class: &Bound<'py, PyAny>, fault: &Diagnostic) -> PyResult<Bound<'py, PyAny>> {
    let position = fault.position.as_ref();
    class.call1((
        fault.message.as_str(),
        fault.key.as_str(),
        fault.hint.as_deref(),
        position.map(|(source, _)| source.name.as_str()),
        position.map(|(source, span)| source.line(span.start)),
        fault.severity == Severity::Warning,
        fault.to_string(),
    ))
}

/// Where a solver failed, in words.
fn position(fault: &SolveFault) -> Option<&str> {
    match fault {
        SolveFault::OfMeasured(fault) => position(fault),
        SolveFault::Inverted { element } | SolveFault::MaterialUnstable { element, .. } => {
            Some(element)
        }
        SolveFault::LoadMaximum { position, .. }
        | SolveFault::Buckling { position }
        | SolveFault::UnstableAtRest { position } => Some(position),
        _ => None,
    }
}

/// One fault of what Python hands over.
pub fn input(message: impl Into<String>, hint: impl Into<String>) -> Error {
    Error::input(message, hint)
}

/// One fault whose message contains the remedy.
pub fn refused(message: impl Into<String>) -> Error {
    Diagnostic::error("", message).into()
}

/// The choice of a name; `what` is the argument.
pub fn choice<T: Copy>(what: &str, name: &str, names: &[(&str, T)]) -> Result<T, Error> {
    let entry = names.iter().find(|(known, _)| *known == name);
    entry.map(|(_, choice)| *choice).ok_or_else(|| {
        let known: Vec<_> = names.iter().map(|(known, _)| *known).collect();
        let near =
            nearest(name, known.iter().copied()).map(|near| format!("did you mean `{near}`? "));
        let hint = format!(
            "{}use one of {}",
            near.unwrap_or_default(),
            known.join(", ")
        );
        input(format!("{what} `{name}` is not known"), hint)
    })
}

/// A fault of gelbench itself.
pub fn internal(payload: &(dyn std::any::Any + Send)) -> PyErr {
    let message = payload
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| payload.downcast_ref::<&str>().copied());
    let text = message.unwrap_or("unknown");
    PyRuntimeError::new_err(format!(
        "a fault of gelbench itself, please report it: {text}"
    ))
}

/// What is raised where a computation was stopped without any other reason.
pub fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}
