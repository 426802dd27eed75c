//! Ways to the field, each from nothing but the problem, with their times.

use std::time::Instant;

use gelbench::corrector::climb::ClimbSettings;
use gelbench::corrector::shape_climb::{ShapeClimb, climb};
use gelbench::error::Error;

use super::opponent::{self, Found};
use super::shapes::Family;

/// A way to the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The climb with `ClimbSettings::FAST`.
    FastClimb,
    /// The climb with the default tolerance, 1/1000 of the discretisation error.
    Climb,
    /// Newton's method with the climb's multigrid, begun with the equilibrium of the mesh before, on all meshes.
    Multigrid,
    /// Finite elements with a factor of every tangent, begun with the field of the mesh before, on all meshes.
    Nested,
    /// Finite elements with factors on the finest mesh alone.
    OneMesh,
}

impl Way {
    pub const ALL: [Self; 5] = [
        Self::FastClimb,
        Self::Climb,
        Self::Multigrid,
        Self::Nested,
        Self::OneMesh,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::FastClimb => "fast climb",
            Self::Climb => "climb",
            Self::Multigrid => "Newton with multigrid",
            Self::Nested => "finite elements, nested guess",
            Self::OneMesh => "finite elements, one mesh",
        }
    }

    /// What the climb may leave of its discretisation error.
    pub fn settings(self) -> Option<ClimbSettings> {
        match self {
            Self::FastClimb => Some(ClimbSettings::FAST),
            Self::Climb => Some(ClimbSettings::default()),
            _ => None,
        }
    }

    pub fn is_climb(self) -> bool {
        self.settings().is_some()
    }

    pub fn is_finite_elements(self) -> bool {
        matches!(self, Self::Nested | Self::OneMesh)
    }
}

/// What a way is told before it begins.
#[derive(Clone, Copy)]
pub struct Told {
    /// The mesh's own error relative to the size of the field, which tells finite elements when to stop: on the way and at last.
    pub error: [f64; 2],
    /// The imbalance, over the largest reaction, at which Newton's method with multigrid, or with a line search, stops.
    pub tolerance: f64,
    /// Whether finite elements on one mesh take a line search, and load steps where they must.
    pub steps: bool,
}

/// What a way came to.
pub struct Gone {
    pub u: Vec<f64>,
    /// From the problem to field and reactions, meshes and analysis included, in s.
    pub seconds: f64,
    /// Iterations on the finest mesh.
    pub iterations: usize,
    /// The climb's own estimate of its discretisation error: root mean square over the nodes in mm.
    pub stated: f64,
}

/// Goes one way on so many meshes of a family; `None` where it leads nowhere.
pub fn go(way: Way, family: &Family, levels: usize, told: Told) -> Result<Option<Gone>, Error> {
    let problem = &family.case.problem;
    let start = Instant::now();
    let meshes = match way {
        Way::OneMesh => vec![family.mesh(levels - 1)],
        _ => family.meshes(levels),
    };
    if let Some(settings) = way.settings() {
        let own = climb(problem, &meshes, 1.0, settings)?;
        return Ok(Some(climbed(own, start)));
    }
    let found = match way {
        Way::Multigrid => Some(opponent::by_multigrid(problem, &meshes, told.tolerance)?),
        Way::Nested => Some(opponent::nested(problem, &meshes, told.error)?),
        _ if told.steps => Some(opponent::in_steps(problem, &meshes[0], told.tolerance)?),
        _ => opponent::on_one_mesh(problem, &meshes[0], told.error[1], family.case.gripped)?,
    };
    Ok(found.map(|Found { u, iterations }| Gone {
        u,
        seconds: start.elapsed().as_secs_f64(),
        iterations,
        stated: f64::NAN,
    }))
}

fn climbed(own: ShapeClimb, start: Instant) -> Gone {
    Gone {
        seconds: start.elapsed().as_secs_f64(),
        iterations: own.work.last().map_or(0, |work| work.iterations),
        stated: own.discretisation_error,
        u: own.state.displacement,
    }
}
