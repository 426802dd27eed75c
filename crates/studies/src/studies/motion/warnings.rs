//! What a reader of a motion's figures must know about them.

use super::plates::PlateMotion;
use super::problem::MovingPlate;
use crate::finite_element::Element;
use crate::mass_spring::{self, SpringLaw};
use crate::results::models::{CORRECTED, FINITE_ELEMENTS};
use crate::results::strained::{self, StrainedSheet};
use crate::results::{Sheet, locking};
use crate::units::number;

/// The warnings about plates that move, at the given instants in s: a lattice of another ν, compression, a law of small strains, locking, and a
/// material beyond the range of its card or not stable.
pub fn warnings(plate: &MovingPlate, times: &[f64], plates: &[PlateMotion]) -> Vec<String> {
    let law = &*plate.problem.law;
    let follows_card = matches!(plate.springs, SpringLaw::Material);
    let is_alike = plate.lattice.area_term || !follows_card;
    let mut all = Vec::new();
    if !is_alike {
        all.extend(mass_spring::warning_of_plate(law));
    }
    all.extend(locking(plate, plates));
    let Some(own) = plates.iter().find(|own| own.is_reference) else {
        return all;
    };
    let states = own.motion.iter().zip(&own.viscous).zip(times);
    let states = states.map(|(([displacement, _], viscous), time)| StrainedSheet {
        load: format!("{} s", number(*time)),
        sheet: Sheet {
            law,
            thickness: plate.problem.thickness,
            past: &[],
            viscous: Some(viscous),
        },
        displacement,
    });
    let states: Vec<_> = states.collect();
    all.extend(strained::warnings(&plate.card, own.name, own.mesh, &states));
    all
}

/// The warning about bilinear cells that lock.
fn locking(plate: &MovingPlate, plates: &[PlateMotion]) -> Option<String> {
    let corrected = plates.iter().any(|own| own.name == CORRECTED.name);
    let corrected = corrected.then_some((
        CORRECTED.name,
        "The corrected motion has bilinear cells alone: rely on the finite elements",
    ));
    let elements =
        (plate.element.0 == Element::Q1).then_some((FINITE_ELEMENTS.name, locking::SECOND_DEGREE));
    let found: Vec<_> = corrected.into_iter().chain(elements).collect();
    locking::warning(&*plate.problem.law, &found)
}
