//! Computations outside of the GIL, which Ctrl-C and exceptions of callbacks end.
//!
//! A computation runs in a thread of its own, and the calling one looks for signals. A computation that is to stop unwinds where it reports its
//! progress or calls the material: [`crate::law::Watched`].

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use gelbench::error::Error;
use pyo3::prelude::*;

use crate::errors::{exception, internal, interrupted};

/// How long the calling thread waits before it looks for signals again.
const PATIENCE: Duration = Duration::from_millis(50);

/// The stack of a computation's thread: that of a program's first one.
const STACK: usize = 8 << 20;

/// The payload of the panic that stops a computation; the exception is in its [`Watch`].
pub struct Stopped;

/// Takes the progress of a computation, and stops it.
#[derive(Default)]
pub struct Watch {
    stopped: AtomicBool,
    raised: Mutex<Option<PyErr>>,
    progress: Option<Py<PyAny>>,
}

impl Watch {
    /// Ends the computation if it is to end.
    pub fn check(&self) {
        if self.stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
    }

    /// Calls the progress callback.
    pub fn report(&self, what: &str) {
        self.check();
        let Some(callback) = &self.progress else {
            return;
        };
        let outcome = Python::attach(|py| callback.call1(py, (what,)).map(drop));
        outcome.unwrap_or_else(|error| self.fail(error));
    }

    /// Ends the computation with an exception.
    pub fn fail(&self, error: PyErr) -> ! {
        self.stop(error);
        resume_unwind(Box::new(Stopped))
    }

    fn stop(&self, error: PyErr) {
        let mut raised = self.raised.lock().unwrap_or_else(|lock| lock.into_inner());
        raised.get_or_insert(error);
        self.stopped.store(true, Ordering::Relaxed);
    }

    fn reason(&self) -> Option<PyErr> {
        let mut raised = self.raised.lock().unwrap_or_else(|lock| lock.into_inner());
        raised.take()
    }
}

/// Runs a computation that can be stopped; its result, or the exception.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Arc<Watch>) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let watch = Arc::new(Watch {
        progress,
        ..Watch::default()
    });
    let ended = py.detach(|| in_thread(&watch, work));
    match ended {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => Err(watch.reason().unwrap_or_else(|| exception(py, &error))),
        Err(payload) => Err(watch.reason().unwrap_or_else(|| of_panic(&*payload))),
    }
}

/// What a piece of work computes, or the payload of its panic.
type Computed<T> = Result<Result<T, Error>, Box<dyn Any + Send>>;

fn in_thread<T: Send>(
    watch: &Arc<Watch>,
    work: impl FnOnce(&Arc<Watch>) -> Result<T, Error> + Send,
) -> Computed<T> {
    scope(|scope| {
        let (sender, ended) = channel();
        let body = move || {
            let result = catch_unwind(AssertUnwindSafe(|| work(watch)));
            // The calling thread waits; nothing else listens.
            sender.send(()).ok();
            result
        };
        let worker = match Builder::new().stack_size(STACK).spawn_scoped(scope, body) {
            Ok(worker) => worker,
            Err(cause) => return Err(Box::new(cause.to_string()) as Box<dyn Any + Send>),
        };
        while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(PATIENCE) {
            if let Err(signal) = Python::attach(|py| py.check_signals()) {
                watch.stop(signal);
            }
        }
        worker.join().and_then(|result| result)
    })
}

/// Runs a short computation, whose panic becomes an exception.
pub fn caught<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let result = py.detach(|| catch_unwind(AssertUnwindSafe(work)));
    result.map_err(|payload| of_panic(&*payload))
}

fn of_panic(payload: &(dyn Any + Send)) -> PyErr {
    if payload.is::<Stopped>() {
        return interrupted();
    }
    internal(payload)
}
