//! What a motion is computed for at a glance.

use std::collections::BTreeSet;

use super::problem::MovingSheet;
use super::shown::ShownSheet;
use super::solution::{Motions, larger_axis};
use crate::problem::GroupState;
use crate::results::{Block, Deformed, Headline, LoadedSheet};
use crate::studies::specimen::gauge;
use crate::units::number;

/// Force and displacement of the measured group at the begin, at their extremes and at the end, and the largest values when most energy is
/// stored, by the finite elements.
pub fn headline(sheet: &MovingSheet, motions: &Motions, shown: &[ShownSheet]) -> Vec<Block> {
    let Some(reference) = shown.iter().find(|own| own.is_reference()) else {
        return Vec::new();
    };
    let instants = motions.elements.instants();
    let specimen = &sheet.specimen;
    let states: Vec<GroupState> = instants
        .iter()
        .map(|now| GroupState {
            force: sheet
                .measured_force(&now.support_forces)
                .unwrap_or_default(),
            displacement: motions.elements.displacement_of(&specimen.group, now),
            ..GroupState::default()
        })
        .collect();
    let row = |instant: usize| (number(instants[instant].time), vec![states[instant]]);
    let stored = extreme(instants, |now| now.energy.stored);
    let fields = reference.motion.get(stored);
    let fields = fields.map(|[displacement, _]| *displacement);
    let viscous = reference.viscous.get(stored);
    let name = match specimen.grids() {
        Some(_) => "right side",
        None => &specimen.group,
    };
    let headline = Headline {
        model: reference.style.name,
        along: "time [s]",
        groups: vec![name],
        steps: telling(&states).into_iter().map(row).collect(),
        state: LoadedSheet {
            at: format!(
                "{} s, with most energy stored",
                number(instants[stored].time)
            ),
            laws: specimen.problem.laws(),
            deformed: Deformed {
                viscous: viscous.map_or(&[], |viscous| &viscous.at_nodes),
                ..Deformed::elastic(
                    reference.style.name,
                    reference.mesh,
                    fields.into_iter().collect(),
                )
            },
            // Supports were checked when the study was read.
            singular: specimen
                .problem
                .singular_points(reference.mesh)
                .unwrap_or_default(),
            gauge: gauge(&specimen.outline, reference.mesh),
        },
    };
    headline.blocks()
}

/// The first instant, the last one, and those at which displacement and force of the measured group along x or y, whichever is larger, are largest
/// and smallest.
fn telling(states: &[GroupState]) -> BTreeSet<usize> {
    let larger = |value: fn(&GroupState) -> [f64; 2]| {
        let vectors: Vec<_> = states.iter().map(value).collect();
        let axis = larger_axis(&vectors);
        move |state: &GroupState| value(state)[axis]
    };
    let displacement = larger(|state| state.displacement);
    let force = larger(|state| state.force);
    BTreeSet::from([
        0,
        states.len() - 1,
        extreme(states, displacement),
        extreme(states, |state| -displacement(state)),
        extreme(states, force),
        extreme(states, |state| -force(state)),
    ])
}

/// The first of some states at which a value is largest.
fn extreme<T>(states: &[T], value: impl Fn(&T) -> f64) -> usize {
    let numbers = (0..states.len()).rev();
    let largest = numbers.max_by(|a, b| value(&states[*a]).total_cmp(&value(&states[*b])));
    largest.unwrap_or_default()
}
