//! The climb on any shape: springs are solved and corrected on the coarsest of some meshes, and the field climbs from mesh to mesh.
//!
//! On each finer mesh the field and an estimate of its next change are interpolated, the governing equation is linearised, mostly once, and
//! a few conjugate-gradient iterations compute the correction. Each takes one multigrid cycle on the tangents that the coarser meshes
//! already have (see [`Ladder`](crate::solve::Ladder)). The iteration may leave a share of the discretisation error, which follows from the
//! changes: a change s shrinks by a ratio q from mesh to mesh, and all finer meshes would add s q/(1 − q).
//!
//! **More states.** A [`Climb`] keeps its systems of equations. [`Climb::follow`] extrapolates each state of a path
//! from those before, and [`Interactive`] follows groups that are moved by hand, along the tangent:
//!
//! ```text
//! u(s) ≈ Σ uₖ Lₖ(s)                three states before, or two and that of rest
//! u + Δu,   K Δu = −K_h Δu_h       u_h: what the hand holds
//! ```
//!
//! A few iterations on the finest mesh alone then reduce the imbalance b to
//!
//! ```text
//! √(b · K⁻¹ b) ≤ ¼ τ e √(2 W)/‖u‖        [√mJ]
//! ```
//!
//! with the tolerance τ, the discretisation error e, the strain energy W, and the size ‖u‖ of the field: its root mean square
//! departure from the nearest rigid motion. The remaining error is as smooth as the field, or up to four times as soft. e/‖u‖ is
//! linear between the first and the last state of a path, which are climbed; in the hand it is that of the first state. The
//! finest tangent is recomputed where the iterations that it has cost beyond those of a tangent at the current state are worth
//! one, and the coarser tangents where a step still takes many iterations. Stability is checked whenever a tangent is computed.
//!
//! All supports, loads, laws and elements are admitted; where the iteration does not converge, load steps and factorisations are used.
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

/// Corrects the springs' field at a load factor on the last of some meshes, coarse to fine, each with about half the spacing of the one before.
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
    /// The systems of the last climb.
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
        // A second set of systems would double the memory.
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
