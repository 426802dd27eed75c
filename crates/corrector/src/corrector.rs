//! The corrective technique: the field nearest to a given one that satisfies the governing equation and
//! what is known at the boundary.
//!
//! ```text
//! minimise ½ ‖u − ū‖²_W   subject to   F(u) = 0,  T(u) = 0
//! L(u, ζ, η) = ½ (u − ū)ᵀ W (u − ū) + ζᵀ F(u) + ηᵀ T(u)
//! ```
//!
//! The conditions are linearised about the current field and the [projection](factor) of ū onto the linearised
//! conditions is repeated until they are satisfied. ζ and η are the sensitivities of the minimum of ½ ‖u − ū‖²_W to
//! the right-hand sides: for a condition written as c(u) = b with the multiplier ψ (ζ or η), ∂(minimum)/∂b = −ψ.
//!
//! Where F and T together give as many conditions as there are unknowns, ū does not influence the result: each step
//! is then a Newton step that starts at ū, whatever W is, and the multipliers show how far ū was from equilibrium.
//! With fewer conditions it is a genuine least-squares problem.
//!
//! The corrector does not depend on how ū was obtained.
//!
//! # References
//! H. Mohammadi, W. Wan: A novel numerical corrective technique to mass spring systems

pub mod climb;
pub mod condition;
mod correction;
mod dependence;
mod difference_scheme;
pub mod estimate;
pub mod factor;
pub mod matrix;
pub mod motion;
pub mod nested;
pub mod plate;
mod sampling;
pub mod specimen;
mod step;
mod system;

pub use condition::{Condition, Equilibrium, Function, Linear, Linearisation};
pub use correction::{Correction, CorrectorSettings, Describe, Multipliers, Step};
pub use difference_scheme::DifferenceScheme;
pub use factor::{Factor, Projection, Solver};
pub use matrix::CorrectionMatrix;
pub use plate::PlateCorrector;
pub use system::Corrector;

#[cfg(test)]
mod tests;
