//! The climb on any shape: springs on the coarsest of some meshes, corrected there, then from mesh to mesh.
//!
//! On each finer mesh the field is interpolated, with about what the mesh before has added, the governing equation is linearised, mostly
//! once, and a few conjugate-gradient iterations bring the correction, each with one cycle of multigrid on the tangents that the
//! coarser meshes already have (see [`Ladder`](crate::solve::Ladder)). What the iteration may leave is a share of the discretisation
//! error, which the meshes tell: changes s shrink by a ratio q from mesh to mesh, and all finer ones would add s q/(1 − q).
//!
//! **More states.** A [`Climb`] keeps its systems. [`Climb::follow`] extrapolates each state of a path from those before,
//! and [`Interactive`] follows groups that are moved by hand, along its tangent:
//!
//! ```text
//! u(s) ≈ Σ uₖ Lₖ(s)                three states before, or two and that of rest
//! u + Δu,   K Δu = −K_h Δu_h       u_h: what the hand holds
//! ```
//!
//! On the finest mesh alone a few iterations then take the imbalance b as far down as
//!
//! ```text
//! √(b · K⁻¹ b) ≤ ¼ τ e √(2 W)/‖u‖        [√mJ]
//! ```
//!
//! with the tolerance τ, the discretisation error e, the strain energy W, and the size ‖u‖ of the field: its root mean square departure from the
//! nearest rigid motion. What is left is as smooth as the field, or up to four times as soft. e/‖u‖ is taken from the first and the last
//! state of a path, which are climbed, linearly between; in the hand from the state that it begins with. The finest
//! tangent is taken anew where the iterations that it has cost beyond those of its own place are worth one, and those of the coarser meshes where a
//! step takes many iterations yet. Whether a state is stable is looked at where a tangent is taken.
//!
//! All supports, loads, laws and elements; where the iteration does not lead to the end, load steps and factors do.
//!
//! ```
//! use std::sync::Arc;
//!
//! use gelbench::corrector::climb::ClimbSettings;
//! use gelbench::corrector::shape_climb::{Climb, Interactive};
//! use gelbench::material::NeoHooke;
//! use gelbench::mesh::{CellShape, Mesh, Shape};
//! use gelbench::problem::{BoundaryProblem, Grip, RigidMotion, Support};
//!
//! let strip = Shape::StripWithHole { size: [40.0, 20.0], radius: 4.0 };
//! let meshes: Vec<Mesh> = (0..3).map(|level| strip.mesh(3 << level, CellShape::Quad4)).collect();
//! let problem = BoundaryProblem {
//!     thickness: 2.0,
//!     law: Arc::new(NeoHooke { c10: 0.05 }),
//!     supports: vec![
//!         ("left".into(), Support::Displacement([Some(0.0), Some(0.0)])),
//!         ("right".into(), Support::Displacement([Some(20.0), Some(0.0)])),
//!     ],
//!     loads: Vec::new(),
//! };
//! let mut climb = Climb::new(&problem, &meshes, ClimbSettings::FAST);
//! let factors: Vec<f64> = (1..=10).map(|step| 0.1 * f64::from(step)).collect();
//! let mut errors = Vec::new();
//! climb.follow(&factors, &mut |climbed| errors.push(climbed.discretisation_error))?;
//! assert!(errors[9] > errors[0]);
//!
//! let mut hand = Interactive::new(climb, 0.5)?;
//! let turned = RigidMotion { displacement: [10.0, 2.0], angle: 0.1 };
//! hand.move_grips(&[("right", Grip::Motion(turned))])?;
//! assert!(hand.at_group("right").force[1] > 0.0);
//! # Ok::<(), gelbench::error::Error>(())
//! ```

use super::climb::ClimbSettings;
use crate::error::Error;
use crate::material::softened_law::check_memory;
use crate::mesh::Mesh;
use crate::problem::BoundaryProblem;

mod ascent;
mod field;
mod hand;
mod levels;
mod path;
mod systems;
#[cfg(test)]
mod tests;

use ascent::Ascent;
pub use field::{ShapeClimb, ShapeWork};
pub use hand::Interactive;
use levels::Levels;
use systems::Systems;

/// Corrects the springs' field at a load factor on the last of some meshes of a problem, coarse to fine: each with about half the spacing
/// of the one before.
///
/// # Errors
/// [`Error::Input`] where a mesh does not suit the problem, [`Error::Solve`] where no field was found.
///
/// # Panics
/// Without a mesh.
pub fn climb(
    problem: &BoundaryProblem,
    meshes: &[Mesh],
    factor: f64,
    settings: ClimbSettings,
) -> Result<ShapeClimb, Error> {
    Ok(Climb::new(problem, meshes, settings)
        .ascent(factor)?
        .climbed())
}

/// The meshes of a problem, ready to correct at any load factor.
pub struct Climb<'a> {
    levels: Levels<'a>,
    settings: ClimbSettings,
    /// Of the climb that was made last.
    systems: Option<Systems>,
}

impl<'a> Climb<'a> {
    /// Prepares some meshes of a problem, coarse to fine: each with about half the spacing of the one before.
    ///
    /// # Panics
    /// Without a mesh.
    pub fn new(problem: &'a BoundaryProblem, meshes: &'a [Mesh], settings: ClimbSettings) -> Self {
        Self {
            levels: Levels::new(problem, meshes),
            settings,
            systems: None,
        }
    }

    /// Corrects the springs' field at one load factor.
    ///
    /// # Errors
    /// [`Error::Input`] where a mesh does not suit the problem, [`Error::Solve`] where no field was found.
    pub fn correct(&mut self, factor: f64) -> Result<ShapeClimb, Error> {
        // Two sets of systems would need twice the memory.
        self.systems = None;
        let mut ascent = self.ascent(factor)?;
        self.systems = Some(ascent.systems(&self.levels, self.settings.tolerance)?);
        Ok(ascent.climbed())
    }

    fn ascent(&self, factor: f64) -> Result<Ascent, Error> {
        check_memory(&*self.levels.problem.law, "the climb")?;
        Ascent::of(&self.levels, factor, self.settings)
    }
}
