//! What a reader of a motion's figures must know about them.

use super::problem::MovingSheet;
use super::shown::ShownSheet;
use crate::mass_spring::{self, SpringLaw};
use crate::results::models::CORRECTED;
use crate::results::strained::{self, StrainedSheet};
use crate::results::{Sheet, locking};
use crate::units::number;

/// The warnings about sheets that move, at the given instants in s: a lattice of another ν, compression, a law of small strains, locking, and a
/// material beyond the range of its card or not stable.
pub fn warnings(sheet: &MovingSheet, times: &[f64], shown: &[ShownSheet]) -> Vec<String> {
    let law = &*sheet.specimen.problem.law;
    let follows_card = matches!(sheet.springs, SpringLaw::Material);
    let grids = sheet.specimen.grids();
    let mut all = Vec::new();
    if follows_card {
        all.extend(match grids {
            Some(grids) if grids.lattice.area_term => None,
            Some(_) => mass_spring::warning_of_plate(law),
            None => mass_spring::warning(law),
        });
    }
    all.extend(locking(sheet, shown));
    let Some(own) = shown.iter().find(|own| own.is_reference()) else {
        return all;
    };
    let states = own.motion.iter().zip(&own.viscous).zip(times);
    let states = states.map(|(([displacement, _], viscous), time)| StrainedSheet {
        load: format!("{} s", number(*time)),
        sheet: Sheet {
            viscous: Some(viscous),
            ..sheet.specimen.sheet()
        },
        displacement,
    });
    let states: Vec<_> = states.collect();
    all.extend(strained::warnings(
        &[&sheet.specimen.card],
        own.style.name,
        own.mesh,
        &states,
    ));
    all
}

/// The warning about cells of the first degree that lock.
fn locking(sheet: &MovingSheet, shown: &[ShownSheet]) -> Option<String> {
    let found: Vec<_> = shown
        .iter()
        .filter(|own| own.is_reference() || own.style == CORRECTED)
        .filter(|own| locking::locks(own.mesh))
        .map(|own| (own.style.name, locking::SECOND_DEGREE))
        .collect();
    locking::warning(&*sheet.specimen.problem.law, &found)
}
