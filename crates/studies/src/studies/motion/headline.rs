//! The main results of a motion.

use std::collections::BTreeSet;

use super::problem::MovingSheet;
use super::solution::{ModelMotion, Motions};
use crate::problem::GroupState;
use crate::results::Block;
use crate::studies::series::{ModelSeries, larger_axis};
use crate::units::number;

/// Force and displacement of the measured group at the beginning, at their extremes and at the end, and the largest values when most energy is
/// stored, by the finite elements.
pub fn headline(sheet: &MovingSheet, motions: &Motions, reference: &ModelSeries) -> Vec<Block> {
    let ModelMotion {
        history, groups, ..
    } = &motions.elements;
    let time = |instant: usize| number(history.instants[instant].time);
    let stored = extreme(&history.instants, |now| now.energy.stored);
    let specimen = &sheet.specimen;
    let name = match specimen.grids() {
        Some(_) => "right side",
        None => &specimen.group,
    };
    let listed = significant(groups).into_iter();
    reference.headline(
        specimen,
        (reference.kind.style().name, "time [s]", vec![name]),
        listed.map(|instant| (instant, time(instant))),
        (
            stored,
            format!("{} s, with most energy stored", time(stored)),
        ),
    )
}

/// The first instant, the last one, and those at which displacement and force of the measured group along x or y, whichever is larger, are largest
/// and smallest.
fn significant(states: &[GroupState]) -> BTreeSet<usize> {
    let larger = |value: fn(&GroupState) -> [f64; 2]| {
        let axis = larger_axis(states.iter().map(value));
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
