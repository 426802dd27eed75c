//! Errors, by who must act on them: the author of a file, the author of a model, or the owner of the disk.

use std::fmt;
use std::path::PathBuf;

mod diagnostic;
mod names;

pub use diagnostic::{Diagnostic, Severity, Source};
pub use names::{nearest, suggestion};

/// Why a solver did not reach a solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveFault {
    /// An element has turned inside out, has shrunk to zero size, or is strained beyond the limit of its law.
    #[error(
        "{element} inverts or collapses, or reaches a strain at which its law has no stress, even with shorter steps"
    )]
    Inverted {
        /// The element, named with its place, as in `cell 80 near (150.0, 0.0) mm`.
        element: String,
    },
    /// The tangent has a direction of no or negative stiffness.
    #[error("the tangent stiffness is not positive definite: a loss of stability")]
    NotPositiveDefinite,
    /// A body with a direction of no or negative stiffness before any load acts.
    #[error(
        "unstable at rest: before any load acts, a mode that is largest at {position} has no stiffness, or a negative one"
    )]
    UnstableAtRest {
        /// Where the mode is largest.
        position: String,
    },
    /// A material whose stress falls with strain.
    #[error("material unstable in {element} at {state}")]
    MaterialUnstable {
        /// The element, named with its place.
        element: String,
        /// The state that is not stable, as in `I₁ = 5.10`.
        state: String,
    },
    /// A motion driven by the loads has lost its stiffness: the load has reached its maximum, or a part snaps through.
    #[error(
        "no equilibrium beyond load factor {factor:.4}: limit point, the load has reached a maximum, or a part of the body snaps through; the motion is largest at {position}"
    )]
    LoadMaximum {
        /// The last load factor with an equilibrium.
        factor: f64,
        /// The unknown that moves most, named with its place.
        position: String,
    },
    /// A direction without stiffness in which the loads do not push: the sheet buckles, wrinkles or necks.
    #[error(
        "the tangent stiffness is not positive definite: buckling, wrinkling or necking; the mode is largest at {position}"
    )]
    Buckling {
        /// The unknown that moves most, named with its place.
        position: String,
    },
    /// A motion without strain that no support prevents.
    #[error("{0}")]
    FreeMotion(String),
    /// The machine does not have enough memory for a factor.
    #[error("not enough memory to factorise the system of equations")]
    OutOfMemory,
    /// The tangent cannot be factorised at all.
    #[error(
        "the system of equations is singular: the supports leave a rigid-body motion free, or conditions depend on each other"
    )]
    Singular,
    /// Conditions that cannot be imposed together.
    #[error(
        "conditions {}: {}{}",
        if *contradictory { "contradict each other" } else { "depend on each other" },
        rows.join("; "),
        if *more > 0 { format!("; and {more} more") } else { String::new() }
    )]
    Dependent {
        /// The rows that take part, named with their condition and their node.
        rows: Vec<String>,
        /// How many more take part.
        more: usize,
        /// Whether no field satisfies all of them.
        contradictory: bool,
    },
    /// The iteration ended without reaching its tolerance.
    #[error(
        "no convergence in {iterations} iterations: the relative residual is {residual:.2e}, the tolerance {tolerance:.0e}"
    )]
    Stalled {
        /// Iterations done.
        iterations: usize,
        /// Residual relative to its scale.
        residual: f64,
        /// The tolerance that was asked for.
        tolerance: f64,
    },
    /// A search for parameters that ended where their sum of squares still falls.
    #[error("the search ended at no minimum of the sum of squares")]
    NoMinimum,
    /// A search for the strains of the bars of a sheet that ended where its markers were not measured.
    #[error(
        "with this law no strains of the bars bring the markers there: {missing:.1e} are missing"
    )]
    MarkersMissed {
        /// The strain that is missing.
        missing: f64,
    },
    /// A motion that needs more steps than are allowed.
    #[error(
        "about {needed:.1e} steps of at most {longest:.1e} s are needed, and {allowed:.1e} are allowed"
    )]
    TooManySteps {
        /// Steps to the end.
        needed: f64,
        /// The longest step in s that is stable, or follows the motion.
        longest: f64,
        /// The steps that are allowed.
        allowed: f64,
    },
    /// A motion that gains energy without work, however short its steps.
    #[error(
        "the time integration is unstable after {time:.6} s, even with steps down to {step:.1e} s"
    )]
    Explodes {
        /// The last time in s at which the motion was sound.
        time: f64,
        /// The shortest step in s that was tried.
        step: f64,
    },
    /// A fault of finding a field near measured displacements, which is no evidence against the law.
    #[error(
        "verdict: the data cannot judge, as no equilibrium with this law, thickness and conditions was reached near the markers: {0}"
    )]
    OfMeasured(Box<Self>),
    /// A number is not finite, so nothing computed from it means anything.
    #[error("{0} is not a finite number")]
    NotFinite(String),
}

impl SolveFault {
    /// The fault of finding a field near measured displacements: a missing solution is put down to the data rather than to the cells.
    #[must_use]
    pub fn of_measured(self) -> Self {
        match self {
            Self::Inverted { .. } | Self::NotPositiveDefinite | Self::Stalled { .. } => {
                Self::OfMeasured(Box::new(self))
            }
            other => other,
        }
    }

    /// What a user can try.
    pub fn advice(&self) -> &'static str {
        match self {
            Self::Inverted { .. } => {
                "end the path or motion before it: laws of chains end at their full length (`jm`, `lambda_m`), tables at their last row; if a few \
                 cells alone are distorted, refine the mesh there"
            }
            Self::NotPositiveDefinite => {
                "look at the card's stable range with `gelbench materials show`, or take smaller steps of load or time"
            }
            Self::UnstableAtRest { .. } => {
                "take less distorted cells, or leave the springs out, models = [\"corrected\", \"finite-element\"]: in skewed cells some springs would need \
                 negative constants to reproduce the material's stiffness and get none, so that a node may be held by a single spring"
            }
            Self::MaterialUnstable { .. } => {
                "look at the card's stable range with `gelbench materials show`, or take a law that is stable there"
            }
            Self::LoadMaximum { .. } => {
                "prescribe the displacement instead of the force or pressure"
            }
            Self::Buckling { .. } => {
                "end the path before this point: beyond it the sheet leaves its plane, folds, or localises its strain"
            }
            Self::Dependent { .. } => "leave out one of the conditions named",
            Self::FreeMotion(_) => "add a support",
            Self::OutOfMemory => "take fewer cells, or a machine with more memory",
            Self::Singular => "look at the supports and the corrector's conditions",
            Self::Stalled { .. } => {
                "take smaller steps up to this point (stretches, load factors, or the interval of a motion), or raise the iteration limit"
            }
            Self::NoMinimum => {
                "keep parameters near values that are expected (`--bound`), take more starts (`--starts`), or choose a law with fewer parameters"
            }
            Self::MarkersMissed { .. } => {
                "look at the distance of the markers and at which axis is which; keep parameters near values that are expected (`--bound`), or choose \
                 another law"
            }
            Self::Explodes { .. } => {
                "look at the supports and loads at that time; take shorter steps or generalised-α, and if generalised-α fails, `spectral_radius = 1`"
            }
            Self::TooManySteps { .. } => {
                "take a shorter duration, longer steps, softer springs or less damping, or use --allow-large"
            }
            Self::OfMeasured(_) => {
                "check that the markers cover the whole mesh (else state what is known of its edges, or give a mesh that ends where the markers do), \
                 that they are on the right body, and whether their places are those in the frame (--places frame)"
            }
            Self::NotFinite(_) => "look at the material's parameters and the load",
        }
    }
}

/// Everything that can end a run early.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The input is wrong; all of its faults at once.
    #[error("{}", list(.0))]
    Input(Vec<Diagnostic>),
    /// A model has no solution that could be found.
    #[error("{model} at {step}: {fault}")]
    Solve {
        /// The model, such as `finite elements (Q2, 120 × 40)`.
        model: String,
        /// The load step, such as `50 % stretch`.
        step: String,
        /// What happened.
        fault: SolveFault,
    },
    /// A file could not be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        cause: String,
    },
}

fn list(diagnostics: &[Diagnostic]) -> String {
    diagnostics
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n")
}

impl From<Diagnostic> for Error {
    fn from(fault: Diagnostic) -> Self {
        Self::Input(vec![fault])
    }
}

impl Error {
    /// Refuses an input with faults.
    ///
    /// # Errors
    /// [`Error::Input`] with all of them, if there are any.
    pub fn refuse(faults: Vec<Diagnostic>) -> Result<(), Self> {
        if faults.is_empty() {
            Ok(())
        } else {
            Err(Self::Input(faults))
        }
    }

    /// One fault of the input that has no place in a file, and its remedy.
    pub fn input(message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self::Input(vec![Diagnostic::error("", message).hint(hint)])
    }

    /// The same error with every fault of an input changed.
    #[must_use]
    pub fn map_faults(self, change: impl FnMut(Diagnostic) -> Diagnostic) -> Self {
        match self {
            Self::Input(faults) => Self::Input(faults.into_iter().map(change).collect()),
            other => other,
        }
    }

    /// A write error for `path`.
    pub fn write(path: impl Into<PathBuf>, cause: impl fmt::Display) -> Self {
        Self::Write {
            path: path.into(),
            cause: cause.to_string(),
        }
    }

    /// What a user can try, where a solver failed.
    pub fn advice(&self) -> Option<&'static str> {
        match self {
            Self::Solve { fault, .. } => Some(fault.advice()),
            _ => None,
        }
    }

    /// The command's exit code: 2 input, 3 no solution, 4 cannot write.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Solve { .. } => 3,
            Self::Write { .. } => 4,
        }
    }
}
