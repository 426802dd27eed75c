//! Motion in time: Newton's equation of motion for any energy of nodal displacements, Eq. 1–5 of the publication.
//!
//! ```text
//! M ü + ∂Π/∂u + f_v(u, u̇) = f(t)                                                        [N]
//! ```
//!
//! M is the lumped mass, Π the strain energy of springs or finite elements, f_v the viscous forces, f(t) the loads;
//! supports prescribe unknowns as functions of time. Units are mm, s, tonne, N and mJ.

mod central;
mod dashpots;
pub mod frequency;
mod history;
mod implicit;
mod march;
mod mass;
mod motion;
mod sheet;
pub mod spring;
mod state;
mod step_forces;
mod time_function;
pub mod viscosity;

pub use dashpots::Dashpots;
pub use history::{EnergyBalance, History, Instant};
pub use march::{Integrator, MotionEnd, Step, TimeSettings, follow};
pub use mass::lumped_mass;
pub use motion::{Motion, MovingForce, MovingSupport, Start};
pub use sheet::SheetViscosity;
pub use step_forces::StepForces;
pub use time_function::TimeFunction;
pub use viscosity::{Memory, Viscosity};

#[cfg(test)]
mod forced_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod viscous_tests;
