//! Whether the data contradict what is said of the edges.
//!
//! Edges that are said to be free, rigid or known are released, to move in unknown smooth ways, in one linearised step from the
//! field that was found. Where the misfit falls by more than noise would let it (F test), something is wrong with what was
//! said, or with law and thickness.

use super::equations::Equations;
use super::field_estimate::Contradiction;
use super::knowledge::EdgeCondition;
use super::mesh_error::MeshError;
use super::regression::{Fit, Trade};
use super::search::NearestField;
use super::task::{Edge, Task};
use crate::statistics::f_tail;

/// Probability below which the data contradict. Smoothness is chosen by the data too, which the test does not count; small
/// values leave room for that.
const LEVEL: f64 = 1e-4;

/// Misfits below this share of the displacement are those of the equations' solution.
const ROUNDING: f64 = 1e-6;

/// Twice the mesh's own error, squared.
const MESH: f64 = 4.0;

/// Looks at the edges that are said to be free, rigid or known.
pub fn contradiction(
    task: &Task,
    found: &NearestField,
    edges: &[Edge],
    own: Option<&MeshError>,
) -> Option<Contradiction> {
    let said =
        |edge: &Edge| edge.segment.condition.is_some() && edge.condition != EdgeCondition::Unknown;
    let let_go = |goes: &dyn Fn(usize) -> bool| {
        let mut relaxed = edges.to_vec();
        for (index, edge) in relaxed.iter_mut().enumerate() {
            if said(edge) && goes(index) {
                edge.condition = EdgeCondition::Unknown;
            }
        }
        // Data that do not determine so much contradict nothing.
        let score = Equations::new(task, &relaxed).and_then(|search| search.score(found));
        score.map_or(1.0, |score| probability(found, &score, own))
    };
    if !edges.iter().any(said) {
        return None;
    }
    let probability = let_go(&|_| true);
    if probability >= LEVEL {
        return None;
    }
    let alone = edges.iter().enumerate().filter(|(_, edge)| said(edge));
    let alone = alone.map(|(index, edge)| {
        let own = let_go(&|other| other == index);
        (edge.segment.name.clone(), own)
    });
    let mut alone: Vec<(String, f64)> = alone.filter(|(_, p)| *p < LEVEL).collect();
    alone.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    Some(Contradiction {
        probability,
        edges: alone,
    })
}

fn probability(found: &NearestField, (fit, trade): &(Fit, Trade), own: Option<&MeshError>) -> f64 {
    let weights = &found.equations.task.observations.weights;
    let weight = |row: usize| weights[row / 2] * trade.trust[row / 2];
    let sum = |values: &[f64]| -> f64 {
        let squares = values.iter().enumerate();
        squares.map(|(row, r)| weight(row) * r * r).sum()
    };
    let count = fit.residual.len() as f64;
    let more = (fit.effective - found.fit.effective).max(1.0);
    let rest = (count - fit.effective).max(1.0);
    let (before, after) = (
        sum(found.fit.residual.as_slice()),
        sum(fit.residual.as_slice()),
    );
    // What the mesh gets wrong, up to twice what is told of it, counts as noise; a misfit of its size says nothing.
    let mesh = own.map_or(0.0, |own| MESH * sum(&own.markers));
    let moved = found
        .equations
        .task
        .observations
        .displacements
        .as_flattened();
    let nothing = mesh + ROUNDING * ROUNDING * sum(moved);
    if before <= nothing {
        return 1.0;
    }
    let noise = (after / rest + nothing / count).max(f64::MIN_POSITIVE);
    let ratio = (before - after).max(0.0) / more / noise;
    f_tail([more, rest], ratio)
}
