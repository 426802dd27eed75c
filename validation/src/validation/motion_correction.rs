//! The corrector in time: a released plate, and a noisy recorded motion.
//!
//! The reference is quadratic finite elements on nodes half as far apart, integrated by generalised-α, with half the
//! step too. It never shares its mesh with the corrector.

use std::path::Path;

use super::case::{Computation, Outcome, Progress, section};
use super::plate::Plate;
use crate::document::{Bound, Section};
use crate::error::Error;
use crate::material::viscosity::ViscousMaterial;
use crate::units::Dimension;
use bodies::PlateInTime;
use recorded::Recording;
use released::Release;

mod bodies;
mod recorded;
mod released;

struct Settings {
    plate: PlateInTime,
    release: Release,
    recording: Recording,
}

/// Reads a study of this case.
pub fn prepare(root: &Section, folder: &Path) -> Computation {
    let plate = Plate::read(root, folder);
    bodies::check_even(&root.section("plate"), plate.cells);
    let recording = section(root, "recording", Recording::read);
    let settings = section(root, "motion", |motion| Settings {
        plate: PlateInTime {
            plate,
            density: motion.quantity("density", Dimension::Density, Bound::Positive),
            material: ViscousMaterial {
                shear_viscosity: motion.quantity(
                    "viscosity",
                    Dimension::Viscosity,
                    Bound::Positive,
                ),
                ..ViscousMaterial::default()
            },
        },
        release: Release {
            periods: motion.count("periods", 1, 100),
            steps: motion.count("steps", 20, 10_000),
            window: motion.count("window", 1, 1000),
        },
        recording,
    });
    Box::new(move |progress| compute(&settings, progress))
}

fn compute(settings: &Settings, progress: Progress) -> Result<Outcome, Error> {
    let mut outcome = Outcome::default();
    progress.tell("released plate");
    settings
        .release
        .compare(&settings.plate, progress, &mut outcome)?;
    progress.tell("recorded motion");
    settings
        .recording
        .compare(&settings.plate, progress, &mut outcome)?;
    Ok(outcome)
}
