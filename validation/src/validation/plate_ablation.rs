//! Example 1, Part II: what the plate's correction depends on.
//!
//! Which known conditions T are imposed decides; the springs, their topology and the start do not.

use std::path::Path;

use super::case::{Block, Check, Computation, Outcome, Progress, check, section};
use super::plate::{NEWTON, Plate};
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::solve::Newton;
use crate::units::Dimension;
use fields::Fields;
use lattices::Disturbance;

mod fields;
mod known_conditions;
mod lattices;
mod springs_or_affine;

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let plate = Plate::read(root, folder);
    let disturbance = section(root, "springs", |section| Disturbance {
        share: section.quantity("disturbance", Dimension::Ratio, Bound::Within(0.0, 0.95)),
        seed: section.count("seed", 0, usize::MAX) as u64,
    });
    Box::new(move |progress| compute(&plate, disturbance, progress))
}

fn compute(plate: &Plate, disturbance: Disturbance, progress: Progress) -> Result<Outcome, Error> {
    progress.tell("reference");
    let fields = Fields::new(plate)?;
    let mut outcome = Outcome::default();
    known_conditions::compare(&fields, progress, &mut outcome)?;
    springs_or_affine::compare(&fields, &mut outcome)?;
    lattices::compare(&fields, disturbance, progress, &mut outcome)?;
    outcome
        .checks
        .push(plain_newton(&fields, &mut outcome.blocks)?);
    Ok(outcome)
}

/// Newton's method on the corrector's own equations from the affine stretch: the honest opponent.
fn plain_newton(fields: &Fields, blocks: &mut Vec<Block>) -> Result<Check, Error> {
    let plate = fields.plate;
    let corrector = plate.corrector(&fields.lattice);
    let potential = corrector.energy();
    let held = plate.problem.held(&fields.lattice.mesh);
    let mut field = fields.affine.clone();
    let mut residual = vec![0.0; field.len()];
    let names = corrector.names();
    let log = Newton::new(potential, &held)
        .and_then(|mut newton| {
            newton.solve(potential, &mut field, &mut residual, NEWTON, &|cell| {
                names.element(cell)
            })
        })
        .map_err(|fault| plate.fault(fault))?;
    blocks.push(Block::paragraph(format!(
        "With all of T imposed there are as many conditions as unknowns, so each step is a Newton step. From the mass-spring \
         field it takes {} steps; plain Newton on the same equations from the affine stretch takes {}.",
        fields.corrected.steps.len() - 1,
        log.iterations()
    )));
    let what = "plain Newton from the affine stretch, relative L2 distance";
    Ok(check(what, "–", fields.far(&field)).at_most(1e-8, "the same equations"))
}
