//! A system whose supports and loads follow one load factor, and its equilibria.

use serde::{Deserialize, Serialize};

use super::convergence::Convergence;
use super::iterative::LinearSolver;
use super::potential::Potential;

/// The position of a body on its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage<'a> {
    /// The load factor.
    pub factor: f64,
    /// What the body remembers of the load factors before; empty where it was never loaded, or has no memory.
    pub history: &'a [f64],
}

impl Stage<'static> {
    /// The stage of a body that was never loaded before, or has no memory.
    pub fn first(factor: f64) -> Self {
        Self {
            factor,
            history: &[],
        }
    }
}

impl Stage<'_> {
    /// The state that is reached here in one load step.
    pub fn reached(
        self,
        displacement: Vec<f64>,
        residual: Vec<f64>,
        convergence: Convergence,
    ) -> State {
        State {
            factor: self.factor,
            displacement,
            residual,
            history: self.history.to_vec(),
            load_steps: 1,
            convergence,
        }
    }
}

/// A system whose supports and loads follow one load factor.
pub trait Loading {
    /// Marks the unknowns that supports hold.
    fn held(&self) -> Vec<bool>;

    /// Writes the displacements that supports impose at a load factor, and those of tied unknowns, which count
    /// as held, after the ones that they follow.
    fn impose(&self, factor: f64, displacement: &mut [f64]);

    /// The potential at a load factor of a body with a history; its pattern must depend on neither.
    fn potential<'a>(&'a self, factor: f64, history: &'a [f64]) -> Box<dyn Potential + 'a>;

    /// The history of a body that has come to an equilibrium: empty for one without memory.
    fn remembered(&self, _state: &State) -> Vec<f64> {
        Vec::new()
    }

    /// How systems with the tangent are solved.
    fn linear_solver(&self) -> LinearSolver {
        LinearSolver::Automatic
    }

    /// A first guess at a load factor; held unknowns are imposed afterwards. `None` where the linear
    /// prediction from the state before is the best guess.
    fn guess(&self, factor: f64, previous: Option<&State>) -> Option<Vec<f64>>;

    /// The longest step of the load factor towards another one: a turn taken in a single step is one of many possible ones.
    fn longest_step(&self, _factor: f64) -> f64 {
        f64::INFINITY
    }

    /// Whether an equilibrium must lie on the branch of those before it; where the states between are not known, any branch will do.
    fn follows_its_branch(&self) -> bool {
        true
    }

    /// Names an element of the potential with its position, for messages.
    fn describe(&self, element: usize) -> String;

    /// Names an unknown with its position, for messages.
    fn describe_unknown(&self, unknown: usize) -> String;
}

/// An equilibrium at one load factor.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct State {
    /// The load factor.
    pub factor: f64,
    /// The unknowns.
    pub displacement: Vec<f64>,
    /// ∂Π/∂u: zero at free unknowns, reactions at held ones.
    pub residual: Vec<f64>,
    /// What the body remembers of the load factors before; empty where it was never loaded, or has no memory.
    pub history: Vec<f64>,
    /// Number of equilibria from the state before to this one, this one included; 1 when it was reached in a single step.
    pub load_steps: usize,
    /// Convergence of the last of them.
    pub convergence: Convergence,
}

impl State {
    /// The position on the path.
    pub fn stage(&self) -> Stage<'_> {
        Stage {
            factor: self.factor,
            history: &self.history,
        }
    }
}
