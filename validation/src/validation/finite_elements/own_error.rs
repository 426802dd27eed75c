//! The error estimate compared with true errors, the order of the force with graded cells, and local refinement
//! compared with uniform refinement.

use std::path::Path;

use crate::document::Section;
use crate::error::Error;
use crate::mesh::CellShape;
use crate::validation::case::{Computation, Outcome, Progress, section};
use refinement::Refinement;

mod graded;
mod refinement;
mod smooth;

struct Settings {
    /// Cells along a side of the smooth problems.
    smooth: usize,
    /// Cells across the coarsest clamped plate.
    plate: usize,
    refinement: Refinement,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, _folder: &Path) -> Computation {
    let settings = Settings {
        smooth: section(root, "smooth", |smooth| smooth.count("cells", 8, 64)),
        plate: section(root, "plate", |plate| plate.count("coarsest", 4, 20)),
        refinement: section(root, "adaptive", |adaptive| Refinement {
            coarsest: adaptive.count("coarsest", 2, 16),
            halvings: adaptive.count("halvings", 1, 4),
        }),
    };
    Box::new(move |progress| compute(&settings, progress))
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    let mut forces = Vec::new();
    for (name, shape) in CellShape::NAMES {
        progress.tell(name);
        outcome
            .checks
            .extend(smooth::checks(name, shape, settings.smooth)?);
        let force = smooth::Force::new(name, shape, settings.smooth)?;
        outcome.checks.extend(force.check());
        forces.push(force);
    }
    outcome.blocks.extend(smooth::force_table(&forces));
    let exact = graded::compare(settings.plate, &mut outcome, progress)?;
    progress.tell("local refinement");
    settings.refinement.compare(exact, &mut outcome)?;
    Ok(outcome)
}
