//! What of a path is kept, so that a computation that was broken off goes on where it was.

use serde::{Deserialize, Serialize};

use super::loading::State;

/// An equilibrium with what the path after it depends on.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Milestone {
    /// The equilibrium.
    pub state: State,
    /// The longest step of the load factor that is tried after it.
    pub step: f64,
}

/// Keeps the equilibria of a computation, so that one that was broken off goes on where it was.
pub trait Journal {
    /// Begins the next path of the computation; returns what was kept of it, from its first load factor on.
    fn begin(&self) -> Vec<Milestone>;

    /// Keeps the next equilibrium of the path that was begun last.
    fn keep(&self, milestone: Milestone);
}

/// Who attends a path.
#[derive(Clone, Copy)]
pub struct Attendance<'a> {
    /// Is told each load factor that is reached.
    pub reached: &'a dyn Fn(f64),
    /// Is told each load factor on the way to one, where it takes several steps.
    pub on_the_way: &'a dyn Fn(f64),
    /// Where equilibria are kept, if anywhere.
    pub journal: Option<&'a dyn Journal>,
}

impl<'a> Attendance<'a> {
    /// One that is told, and keeps nothing.
    pub fn told(reached: &'a dyn Fn(f64)) -> Self {
        Self {
            reached,
            on_the_way: &|_| (),
            journal: None,
        }
    }
}
