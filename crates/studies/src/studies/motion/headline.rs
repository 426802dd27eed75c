//! What a motion is computed for at a glance.

use std::collections::BTreeSet;

use super::files::right_side;
use super::plates::PlateMotion;
use super::problem::MovingPlate;
use super::solution::ModelMotion;
use crate::dynamics::Instant;
use crate::problem::GroupState;
use crate::results::{Block, Deformed, Gauge, Headline, LoadedSheet};
use crate::units::number;

/// Force and displacement of the right side at the begin, at their extremes and at the end, and the largest values when most energy is stored, by the
/// finite elements.
pub fn headline(plate: &MovingPlate, elements: &ModelMotion, shown: &[PlateMotion]) -> Vec<Block> {
    let Some(reference) = shown.iter().find(|plate| plate.is_reference) else {
        return Vec::new();
    };
    let instants = &elements.history.instants;
    let of = |now: &Instant| GroupState {
        force: now.support_forces[1],
        displacement: [right_side(elements, now), 0.0],
        ..GroupState::default()
    };
    let row = |instant: usize| (number(instants[instant].time), vec![of(&instants[instant])]);
    let stored = extreme(instants, |now| now.energy.stored);
    let [length, width] = plate.problem.size;
    let fields = reference
        .motion
        .get(stored)
        .map(|[displacement, _]| *displacement);
    let headline = Headline {
        model: reference.name,
        along: "time [s]",
        groups: vec!["right side"],
        steps: telling(elements, instants).into_iter().map(row).collect(),
        state: LoadedSheet {
            at: format!(
                "{} s, with most energy stored",
                number(instants[stored].time)
            ),
            law: &*plate.problem.law,
            deformed: Deformed {
                viscous: reference
                    .viscous
                    .get(stored)
                    .map_or(&[], |viscous| &viscous.at_nodes),
                ..Deformed::elastic(reference.name, reference.mesh, fields.into_iter().collect())
            },
            singular: [[0.0, 0.0], [0.0, width], [length, 0.0], [length, width]].to_vec(),
            gauge: Some(Gauge::middle_half(
                reference.mesh,
                length,
                "the middle half of the length",
            )),
        },
    };
    headline.blocks()
}

/// The first instant, the last one, and those at which displacement and force of the right side are largest and smallest.
fn telling(elements: &ModelMotion, instants: &[Instant]) -> BTreeSet<usize> {
    let displacement = |now: &Instant| right_side(elements, now);
    let force = |now: &Instant| now.support_forces[1][0];
    BTreeSet::from([
        0,
        instants.len() - 1,
        extreme(instants, displacement),
        extreme(instants, |now| -displacement(now)),
        extreme(instants, force),
        extreme(instants, |now| -force(now)),
    ])
}

/// The first instant at which a value is largest.
fn extreme(instants: &[Instant], value: impl Fn(&Instant) -> f64) -> usize {
    let numbers = (0..instants.len()).rev();
    let largest = numbers.max_by(|a, b| value(&instants[*a]).total_cmp(&value(&instants[*b])));
    largest.unwrap_or_default()
}
