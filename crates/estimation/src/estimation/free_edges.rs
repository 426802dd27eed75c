//! Which of the edges without a stated condition are free, as decided by the data.

use nalgebra::{DMatrix, DVector};

use super::equations::Equations;
use super::input::{Edge, EdgeCondition, Knowledge, Physics, Task, singular_corners};
use super::outcome::EdgeForce;
use super::regression::{Fit, Robust, VarianceComponents, weighted_square};
use super::search::{MOST_STEPS, NearestField};
use crate::error::Error;
use crate::statistics::f_tail;

/// Probability that one of several free edges is refused although all are free; it is shared equally among them.
const LEVEL: f64 = 0.01;

/// Steps of a trial: a free edge that does not contradict the data takes few.
const TRIAL_STEPS: usize = 20;

/// Searches, and decides which of the edges without a stated condition are free. Where the physics is weighted, edges are decided in exact
/// equilibrium, and the search begins there: otherwise forces on the interior could represent the load of an edge.
///
/// # Errors
/// As the search with the edges as they are.
pub fn search<'a>(task: &Task<'a>, edges: Vec<Edge>) -> Result<NearestField<'a>, Error> {
    if task.knowledge.physics == Physics::Exact {
        return decided(task, edges);
    }
    let knowledge = Knowledge {
        physics: Physics::Exact,
        ..task.knowledge.clone()
    };
    let exact = Task {
        knowledge: &knowledge,
        ..task.clone()
    };
    let Ok(field) = decided(&exact, edges.clone()) else {
        return decided(task, edges);
    };
    let weighted = nearest_from(task, &field.equations.edges, MOST_STEPS, &field);
    weighted.map_err(|fault| match fault {
        Error::Input(_) => Error::input(
            "the data do not determine forces on the interior beside the motion of the edges",
            "state more about the edges (free, rigid, known), or let equilibrium hold exactly (--physics exact)",
        ),
        fault => fault,
    })
}

/// Searches with all edges to be tested free. Where the data contradict one of them, searches with the edges as they are, then with those to be
/// tested freed one after the other, the longest first. Where many edges that follow the markers lead to no solution, the search begins with all
/// of them free, and releases those that the data contradict.
fn decided<'a>(task: &Task<'a>, edges: Vec<Edge>) -> Result<NearestField<'a>, Error> {
    if let Some(confirmed) = all_free(task, &edges) {
        return Ok(confirmed);
    }
    match nearest(task, &edges, MOST_STEPS) {
        Ok(field) if field.ends_at_gross_errors(&field.markers(None)) => Ok(field),
        Ok(field) => from_loaded(task, field, edges),
        Err(fault) => from_free(task, edges).map_err(|_| fault),
    }
}

fn nearest<'a>(task: &Task<'a>, edges: &[Edge], most: usize) -> Result<NearestField<'a>, Error> {
    Equations::new(task, edges)?.run(most)
}

/// The same from a field with other edges; if that leads to no solution, from the usual start.
fn nearest_from<'a>(
    task: &Task<'a>,
    edges: &[Edge],
    most: usize,
    before: &NearestField,
) -> Result<NearestField<'a>, Error> {
    let nearest_field = Equations::new(task, edges)?.run_near(before, most);
    nearest_field.or_else(|_| nearest(task, edges, most))
}

/// The edges to be tested, the longest first.
fn open(edges: &[Edge]) -> Vec<usize> {
    let mut open: Vec<usize> = (0..edges.len())
        .filter(|edge| edges[*edge].tested)
        .collect();
    let length = |edge: usize| edges[edge].segment.length();
    open.sort_by(|a, b| length(*b).total_cmp(&length(*a)));
    open
}

/// The edges with some of them free.
fn freed(given: &[Edge], open: &[usize]) -> Vec<Edge> {
    let mut edges = given.to_vec();
    for index in open {
        edges[*index].condition = EdgeCondition::Free;
    }
    edges
}

/// The nearest field with all edges to be tested free, if loading any of them, in one linearised step, reduces the misfit no more than noise
/// would. Not used with robust weights, because gross errors could hide the effect of such an edge.
fn all_free<'a>(task: &Task<'a>, given: &[Edge]) -> Option<NearestField<'a>> {
    let open = open(given);
    if open.is_empty() || task.knowledge.robust != Robust::No {
        return None;
    }
    let mut edges = freed(given, &open);
    let mut free = nearest(task, &edges, MOST_STEPS).ok()?;
    if free.ends_at_gross_errors(&free.markers(None)) {
        return None;
    }
    let level = LEVEL / open.len() as f64;
    for index in open {
        let mut loaded = edges.clone();
        loaded[index].condition = given[index].condition;
        let equations = Equations::new(task, &loaded).ok()?;
        let scored = equations.score(&free, false).ok()?;
        let loaded = (&scored.fit, &scored.linear.design, &scored.variances);
        let probability = probability(loaded, &mut free, level);
        edges[index].probability = Some(probability);
        if probability < level {
            return None;
        }
    }
    settle(task, free, edges).ok()
}

/// Frees edges as long as the data do not contradict it and two remain loaded: a single loaded edge would exclude every force, even where the
/// data do not determine the force.
fn from_loaded<'a>(
    task: &Task<'a>,
    mut nearest_field: NearestField<'a>,
    mut edges: Vec<Edge>,
) -> Result<NearestField<'a>, Error> {
    let open = open(&edges);
    let level = LEVEL / open.len() as f64;
    for index in open {
        let mut freed = edges.clone();
        freed[index].condition = EdgeCondition::Free;
        let loaded = freed.iter().filter(|edge| edge.is_loaded()).count();
        if loaded == 0 {
            break;
        }
        if nearest_field.is_pulled(index)? {
            edges[index].probability = Some(0.0);
            continue;
        }
        // Where no equilibrium with the free edge is found, the edge is not free.
        let mut trial = nearest_from(task, &freed, TRIAL_STEPS, &nearest_field);
        let probability = trial.as_mut().map_or(0.0, |trial| {
            probability(nearest_field.fitted(), trial, level)
        });
        edges[index].probability = Some(probability);
        if let (Ok(trial), true) = (trial, probability >= level && loaded > 1) {
            edges[index].condition = EdgeCondition::Free;
            nearest_field = trial;
        }
    }
    settle(task, nearest_field, edges)
}

/// Releases edges that are free at first, where the data contradict that.
fn from_free<'a>(task: &Task<'a>, given: Vec<Edge>) -> Result<NearestField<'a>, Error> {
    let open = open(&given);
    let mut edges = freed(&given, &open);
    let level = LEVEL / open.len() as f64;
    let mut nearest_field = nearest(task, &edges, MOST_STEPS)?;
    for index in open {
        let mut released = edges.clone();
        released[index].condition = given[index].condition;
        let Ok(trial) = nearest_from(task, &released, TRIAL_STEPS, &nearest_field) else {
            continue;
        };
        let probability = probability(trial.fitted(), &mut nearest_field, level);
        if probability < level {
            (edges, nearest_field) = (released, trial);
        }
        edges[index].probability = Some(probability);
    }
    settle(task, nearest_field, edges)
}

/// The nearest field when all tested edges, free or loaded, are edges of the body: fields may then be singular at other corners.
fn settle<'a>(
    task: &Task<'a>,
    mut nearest_field: NearestField<'a>,
    mut edges: Vec<Edge>,
) -> Result<NearestField<'a>, Error> {
    let before = singular_corners(&edges);
    for edge in edges.iter_mut().filter(|edge| edge.tested) {
        edge.of_body = true;
    }
    if singular_corners(&edges) != before {
        nearest_field = nearest_from(task, &edges, MOST_STEPS, &nearest_field)?;
    }
    nearest_field.equations.edges = edges;
    Ok(nearest_field)
}

/// The probability that noise alone causes the difference of the misfits with an edge free and loaded. If it is below the level, the
/// probability that noise and the admitted changes cause it: the discretisation error, and edges that only markers show.
fn probability(
    (loaded, design, variances): (&Fit, &DMatrix<f64>, &VarianceComponents),
    free: &mut NearestField,
    level: f64,
) -> f64 {
    let count = loaded.residual.len() as f64;
    let more = (loaded.effective - free.fit.effective).max(1.0);
    let rest = (count - loaded.effective).max(1.0);
    let rounding = free.rounding(variances).max(f64::MIN_POSITIVE);
    let of_misfits = |before: f64, after: f64| {
        let noise = before.max(rounding);
        let ratio = (after - before).max(0.0) / more / (noise / rest);
        f_tail([more, rest], ratio)
    };
    let [before, after] = [loaded, &free.fit].map(|fit| free.misfit(fit, variances));
    let probability = of_misfits(before, after);
    if probability >= level {
        return probability;
    }
    let mesh_error = free.mesh_error().map(|error| error.markers.clone());
    let Ok(granted) = free.granted(mesh_error.as_deref()) else {
        return probability;
    };
    let by_granted = |fit, design| free.granted_misfit(&granted, (fit, design), variances);
    of_misfits(
        before - by_granted(loaded, design),
        after - by_granted(&free.fit, &free.linear.design),
    )
}

impl NearestField<'_> {
    /// Whether the edge needs no trial because its force is large and well known: more than a third of the largest one, and more than ten
    /// times its standard error.
    fn is_pulled(&self, index: usize) -> Result<bool, Error> {
        const LARGE: f64 = 1.0 / 3.0;
        const SURE: f64 = 10.0;
        let forces = self.forces(1.0, None, &[])?;
        let bodies = self.equations.bodies.iter();
        let force = bodies
            .zip(&forces)
            .find(|(body, _)| body.edges.contains(&index));
        let size = |force: &EdgeForce| force.force[0].value.hypot(force.force[1].value);
        let error = |force: &EdgeForce| {
            let [x, y] = force.force.map(|along| along.standard_error);
            x.hypot(y)
        };
        let most = forces.iter().map(size).fold(0.0, f64::max);
        Ok(force.is_some_and(|(_, force)| {
            size(force) > LARGE * most && size(force) > SURE * error(force)
        }))
    }

    /// Σ w ω r² of residuals of a millionth of the displacements: data without noise have no more digits.
    fn rounding(&self, variances: &VarianceComponents) -> f64 {
        const ROUNDING: f64 = 1e-6;
        let observations = self.observations();
        let components = observations.displacements.iter().flatten().copied();
        let moved = DVector::from_iterator(2 * observations.displacements.len(), components);
        ROUNDING * ROUNDING * weighted_square(&moved, &observations.weights, &variances.trust)
    }

    /// Σ w ω r² of a regression, with the trust ω of variances.
    pub fn misfit(&self, fit: &Fit, variances: &VarianceComponents) -> f64 {
        let weights = &self.observations().weights;
        weighted_square(&fit.residual, weights, &variances.trust)
    }

    fn fitted(&self) -> (&Fit, &DMatrix<f64>, &VarianceComponents) {
        (&self.fit, &self.linear.design, &self.variances)
    }
}
