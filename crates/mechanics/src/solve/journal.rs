//! Equilibria of a path that are kept, so that an interrupted computation resumes where it was.

use serde::{Deserialize, Serialize};

use super::loading::State;

/// An equilibrium with what the path after it depends on.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Milestone {
    /// The equilibrium.
    pub state: State,
    /// The longest step of the load factor that is tried after it.
    pub step: f64,
}

/// Keeps the equilibria of a computation, so that an interrupted one resumes where it was.
pub trait Journal {
    /// Begins the next path of the computation; returns the equilibria kept of it, from its first load factor on.
    fn begin(&self) -> Vec<Milestone>;

    /// Keeps the next equilibrium of the path that was begun last.
    fn keep(&self, milestone: Milestone);
}

/// An observer of a path.
#[derive(Clone, Copy)]
pub struct Attendance<'a> {
    /// Called with each load factor that is reached.
    pub reached: &'a dyn Fn(f64),
    /// Called with each intermediate load factor, where one takes several steps.
    pub on_the_way: &'a dyn Fn(f64),
    /// Where equilibria are kept, if anywhere.
    pub journal: Option<&'a dyn Journal>,
}

impl<'a> Attendance<'a> {
    /// An observer that is called with load factors and keeps nothing.
    pub fn reporting(reached: &'a dyn Fn(f64)) -> Self {
        Self {
            reached,
            on_the_way: &|_| (),
            journal: None,
        }
    }
}
