//! Alternatives tried on a basis: those of forces, stiffness, law and picture, and those of edges.

use super::alternatives::Column;
use super::linear_model::{Model, Reference};
use super::rows::Rows;
use crate::error::Error;
use crate::estimation::equations::Equations;
use crate::estimation::input::{Edge, EdgeCondition};
use crate::estimation::outcome::{Alternative, Contradiction, Reason, Trial};
use crate::estimation::search::{NearestField, Scored};
use crate::estimation::uncertainty::{Granted, MovedEdge};
use crate::statistics::CorrelatedNoise;

/// The probability under noise below which an alternative contradicts the equations: so small because seven are tried, and the data choose the
/// smoothness.
pub const LEVEL: f64 = 1e-5;

/// Free edges are taken for loaded ones, rather than misplaced, where their residual is more than this multiple of that of released edges.
const ALMOST: f64 = 3.0;

/// The conditions that an edge may have instead of a stated one.
const OTHER_CONDITIONS: [EdgeCondition; 4] = [
    EdgeCondition::Free,
    EdgeCondition::Rigid,
    EdgeCondition::Known([Some(0.0), None]),
    EdgeCondition::Known([None, Some(0.0)]),
];

/// The basis on which alternatives are tried.
pub struct Basis<'a> {
    pub rows: &'a Rows,
    pub granted: &'a [Granted],
    pub base: &'a Model,
    pub reference: Reference,
}

impl Basis<'_> {
    /// The trials of edges: released one by one, with other conditions, or at other positions, after `together`, the trial with all edges released;
    /// and the stated conditions that the data contradict at a level.
    pub fn of_edges(
        &self,
        nearest_field: &mut NearestField,
        (together, level): (Option<Trial>, f64),
    ) -> Result<(Vec<Trial>, Option<Contradiction>), Error> {
        let each = self.edge_by_edge(nearest_field);
        let contradiction = contradicted(together.as_ref(), &each, level);
        let mut trials: Vec<Trial> = together.filter(|_| each.len() > 1).into_iter().collect();
        let first = contradiction.iter().find_map(|all| all.edges.first());
        if let Some((name, _)) = first {
            trials.extend(self.other_conditions(nearest_field, name));
        }
        trials.extend(each);
        let moved = nearest_field.moved_edges()?.into_iter();
        trials.extend(moved.filter_map(|edge| self.moved(nearest_field, edge)));
        Ok((trials, contradiction))
    }

    /// Whether no alternative, nor the model `all` with all edges released, improves the fit at a level once the outer free edges, which only
    /// markers show, are released, and whether the residual of these edges as they are is small enough for misplaced free edges.
    pub fn explains_all(
        &self,
        nearest_field: &NearestField,
        (columns, noise): (&[Column], Option<&CorrelatedNoise>),
        (all, level): (Option<&Model>, f64),
    ) -> bool {
        let is_shown = |name: &str| {
            let edges = nearest_field.equations.edges.iter();
            let mut shown = edges.filter(|edge| edge.has_strip() && edge.segment.outer);
            shown.any(|edge| edge.segment.name == name)
        };
        let Some(loaded) = self.released(nearest_field, &is_shown) else {
            return false;
        };
        let residual = |model: &Model| model.residual_rms(self.rows, nearest_field);
        if residual(self.base) > ALMOST * residual(&loaded) {
            return false;
        }
        let reference = Reference::new(self.rows, noise, &loaded, None, columns);
        let improves = |alternative: &Alternative, model: &Model| {
            reference.test(alternative.clone(), model).probability < level
        };
        if all.is_some_and(|model| improves(&Alternative::Edges, model)) {
            return false;
        }
        let mut columns = columns.iter();
        !columns
            .any(|(alternative, design)| improves(alternative, &loaded.with(self.rows, [design])))
    }

    /// The model with some edges released, and with the admitted changes.
    fn released(
        &self,
        nearest_field: &NearestField,
        is_released: &dyn Fn(&str) -> bool,
    ) -> Option<Model> {
        let scored = released(nearest_field, is_released)?;
        Some(self.model(nearest_field, scored))
    }

    /// The model of a regression, with the admitted changes.
    fn model(&self, nearest_field: &NearestField, scored: Scored) -> Model {
        Model::of_score(self.rows, nearest_field, scored).granting(self.rows, self.granted)
    }

    pub fn try_columns(&self, nearest_field: &NearestField, columns: &[Column]) -> Vec<Trial> {
        let trials = columns.iter().map(|(alternative, design)| {
            let model = self.base.with(self.rows, [design]);
            self.try_out(nearest_field, alternative.clone(), &model)
        });
        trials.collect()
    }

    pub fn try_out(
        &self,
        nearest_field: &NearestField,
        alternative: Alternative,
        model: &Model,
    ) -> Trial {
        Trial {
            residual_rms: model.residual_rms(self.rows, nearest_field),
            ..self.reference.test(alternative, model)
        }
    }

    /// The trial of each of the edges with a stated condition, released alone.
    fn edge_by_edge(&self, nearest_field: &NearestField) -> Vec<Trial> {
        let names = stated(&nearest_field.equations.edges).into_iter();
        let trials = names.filter_map(|name| {
            let model = self.released(nearest_field, &|other| other == name)?;
            Some(self.try_out(nearest_field, Alternative::Edge(name.to_owned()), &model))
        });
        trials.collect()
    }

    /// The trials of an edge with a stated condition under each of the other conditions.
    fn other_conditions(&self, nearest_field: &NearestField, name: &str) -> Vec<Trial> {
        let trials = OTHER_CONDITIONS.into_iter().filter_map(|condition| {
            let scored = with_condition(nearest_field, condition, &|other| other == name)?;
            let model = self.model(nearest_field, scored);
            let edge = name.to_owned();
            let alternative = Alternative::Condition { edge, condition };
            Some(self.try_out(nearest_field, alternative, &model))
        });
        trials.collect()
    }

    /// The trial of an edge at another position, with its distance; `None` where the data do not determine the distance.
    fn moved(&self, nearest_field: &NearestField, (part, design): MovedEdge) -> Option<Trial> {
        let outwards = self.reference.factor(self.rows, self.base, &design)?;
        let model = self.base.with(self.rows, [&design]);
        Some(self.try_out(
            nearest_field,
            Alternative::MovedEdge { part, outwards },
            &model,
        ))
    }
}

/// The alternative that contradicts the equations, if one does.
pub fn improvement<'a>(trials: impl Iterator<Item = &'a Trial>, level: f64) -> Option<Reason> {
    let probability = trials.map(|trial| trial.probability).fold(1.0, f64::min);
    (probability < level).then_some(Reason::Alternative(probability))
}

/// The names of the edges with a stated condition, except those that moved in an unknown way.
fn stated(edges: &[Edge]) -> Vec<&str> {
    let stated = edges.iter().filter(|edge| is_stated(edge));
    let mut names: Vec<&str> = stated.map(|edge| edge.segment.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Whether the condition of an edge is stated, or is that of a hole: free.
fn is_stated(edge: &Edge) -> bool {
    let segment = &edge.segment;
    let stated = segment.condition.is_some() || !segment.outer;
    stated && !segment.inside && edge.condition != EdgeCondition::Unknown
}

/// The regression with some of the edges with stated conditions released; `None` where there are none, or where the data do not determine so much.
pub fn released(
    nearest_field: &NearestField,
    is_released: &dyn Fn(&str) -> bool,
) -> Option<Scored> {
    with_condition(nearest_field, EdgeCondition::Unknown, is_released)
}

/// The same with another condition of these edges; `None` also where they have it already.
fn with_condition(
    nearest_field: &NearestField,
    condition: EdgeCondition,
    is_released: &dyn Fn(&str) -> bool,
) -> Option<Scored> {
    let mut relaxed = nearest_field.equations.edges.clone();
    let mut any = false;
    for edge in &mut relaxed {
        if is_stated(edge) && is_released(&edge.segment.name) {
            any |= edge.condition != condition;
            edge.condition = condition;
        }
    }
    let search = any
        .then(|| Equations::new(&nearest_field.equations.task, &relaxed).ok())
        .flatten()?;
    let settle = condition != EdgeCondition::Unknown;
    search.score(nearest_field, settle).ok()
}

fn contradicted(together: Option<&Trial>, each: &[Trial], level: f64) -> Option<Contradiction> {
    let probability = together.map_or(1.0, |trial| trial.probability);
    let named = |trial: &Trial| match &trial.alternative {
        Alternative::Edge(name) => Some((name.clone(), trial.probability)),
        _ => None,
    };
    let mut edges: Vec<(String, f64)> = each
        .iter()
        .filter(|trial| trial.probability < LEVEL)
        .filter_map(named)
        .collect();
    edges.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    (probability < level).then_some(Contradiction { probability, edges })
}
