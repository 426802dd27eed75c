//! The verdict on an estimate: whether its residuals are white, correlated as noise is, or no noise.
//!
//! Correlated noise is found by restricted likelihood twice: with the equations as they are, for the intervals, and with every
//! alternative of [`alternatives`] and all edges released, where the residuals are noise more surely. An alternative contradicts the
//! equations where it is likelier than noise would make it, each under the likelier of the two noises ([`Reference`], in one
//! linearised step).

use super::equations::Equations;
use super::input::{Edge, EdgeCondition};
use super::mesh_error::MeshError;
use super::outcome::{
    Alternative, Answer, Contradiction, ForceCheck, NoiseCorrelation, Reason, Trial, Verdict, Worst,
};
use super::search::{NearestField, Scored};
use super::uncertainty::MovedEdge;
use crate::error::Error;
use crate::statistics::{CorrelatedNoise, nearest, normal_tail};

mod alternatives;
mod linear_model;
mod rows;

use alternatives::{Column, Granted};
pub use linear_model::{Model, Reference};
pub use rows::{Rows, soundness};

/// Probability under noise below which an alternative contradicts the equations. Seven are tried, and smoothness is chosen by the data.
const LEVEL: f64 = 1e-5;

/// The same where few values are independent and the correlation is uncertain: right equations have come to 1e-8 with noise correlated
/// over six spacings, a wrong law to 1e-35 (`gelbench validate interval-coverage`).
const STRICT: f64 = 1e-12;

/// An alternative explains something where it leaves less than this share of the misfit.
const EXPLAINS: f64 = 0.98;

/// With fewer independent values than this beside the parameters, correlated noise cannot be distinguished from a misfit, and its
/// likeliest length is too uncertain for valid intervals: by their coverage, `gelbench validate interval-coverage`.
const INDEPENDENT: f64 = 100.0;

/// The conditions that an edge may have instead of a stated one.
const OTHER_CONDITIONS: [EdgeCondition; 4] = [
    EdgeCondition::Free,
    EdgeCondition::Rigid,
    EdgeCondition::Known([Some(0.0), None]),
    EdgeCondition::Known([None, Some(0.0)]),
];

/// The noise that was found, and the verdict.
#[derive(Default)]
pub struct Judgement {
    /// The correlation of the noise with the equations as they are, the likeliest first; nothing for white noise. Where the data
    /// cannot judge, those that are hardly less likely follow.
    pub noises: Vec<CorrelatedNoise>,
    /// The verdict without measured forces.
    pub verdict: Verdict,
    /// The statements on edges that the data contradict.
    pub contradiction: Option<Contradiction>,
}

/// Judges the residuals of the sound markers.
///
/// # Errors
/// Where the tangent cannot be used to solve systems.
pub fn judge(
    nearest_field: &mut NearestField,
    edges: &[Edge],
    mesh_error: Option<&MeshError>,
) -> Result<Judgement, Error> {
    let all = released(nearest_field, edges, &|_| true);
    let (fit, variances) = match &all {
        Some(all) => (&all.fit, &all.variances),
        None => (&nearest_field.fit, &nearest_field.variances),
    };
    let sound = soundness(&nearest_field.observations().weights, fit, variances);
    let Some(rows) = Rows::new(nearest_field, &sound, mesh_error) else {
        return Ok(Judgement::default());
    };
    let granted = nearest_field.granted(edges, mesh_error)?;
    let knowledge_of_edges = nearest_field.equations.task.knowledge.edge_gap;
    let base = Model::of_search(&rows, nearest_field).granting(&rows, &granted);
    let mut noises = base.noises(&rows);
    let noise = noises.first();
    let columns = nearest_field.alternatives()?;
    let all =
        all.map(|scored| Model::of_score(&rows, nearest_field, scored).granting(&rows, &granted));
    let basis = Basis {
        reference: Reference::new(&rows, noise, &base, all.as_ref(), &columns),
        rows: &rows,
        base: &base,
    };
    let mut trials = basis.try_columns(nearest_field, &columns);
    let together = all
        .as_ref()
        .map(|model| basis.try_out(nearest_field, Alternative::Edges, model));
    let correlation = noise.map(|noise| rows.correlation(noise));
    let few = few(correlation, nearest_field);
    let level = if few.is_some() { STRICT } else { LEVEL };
    let mut against = improvement(trials.iter().chain(&together), level);
    let mut unknown_edges = None;
    if let (Some(_), Some(gap), Some(model)) = (against, knowledge_of_edges, &all) {
        let loaded = Basis {
            reference: Reference::new(&rows, noise, model, None, &columns),
            rows: &rows,
            base: model,
        };
        let beyond = loaded.try_columns(nearest_field, &columns);
        if improvement(beyond.iter(), level).is_none() {
            unknown_edges = Some(Reason::UnknownEdges(gap));
            against = None;
        }
    }
    let mut contradiction = None;
    if against.is_some() {
        let (of_edges, contradicted) =
            basis.of_edges(nearest_field, edges, &granted, (together, level))?;
        trials.extend(of_edges);
        contradiction = contradicted;
    }
    // An alternative that hardly changes the misfit explains nothing.
    let residual_rms = base.residual_rms(&rows, nearest_field);
    trials.retain(|trial| trial.residual_rms < EXPLAINS * residual_rms);
    trials.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let undecided = unknown_edges.or(few);
    let answer = answer(against, undecided, correlation);
    if answer != Answer::Undecided {
        noises.truncate(1);
    }
    let verdict = Verdict {
        answer,
        correlation,
        worst: against.and_then(|_| rows.worst(nearest_field)),
        reasons: against.or(undecided).into_iter().collect(),
        trials,
        residual_rms: Some(residual_rms).filter(|rms| rms.is_finite()),
    };
    Ok(Judgement {
        noises,
        verdict,
        contradiction,
    })
}

/// Evidence against the equations counts most, then that there can be none.
fn answer(
    against: Option<Reason>,
    few: Option<Reason>,
    correlation: Option<NoiseCorrelation>,
) -> Answer {
    match (against, few, correlation) {
        (Some(_), ..) => Answer::NotExplained,
        (None, Some(_), _) => Answer::Undecided,
        (None, None, Some(_)) => Answer::Correlated,
        (None, None, None) => Answer::Explained,
    }
}

/// The basis on which alternatives are tried.
struct Basis<'a> {
    rows: &'a Rows,
    base: &'a Model,
    reference: Reference,
}

impl Basis<'_> {
    /// What edges explain, released one by one, with other conditions, or elsewhere; and the stated conditions that are contradicted at a level,
    /// beside the trial with all edges released.
    fn of_edges(
        &self,
        nearest_field: &mut NearestField,
        edges: &[Edge],
        granted: &[Granted],
        (together, level): (Option<Trial>, f64),
    ) -> Result<(Vec<Trial>, Option<Contradiction>), Error> {
        let each = self.edge_by_edge(nearest_field, edges, granted);
        let contradiction = contradicted(together.as_ref(), &each, level);
        let mut trials: Vec<Trial> = together.filter(|_| each.len() > 1).into_iter().collect();
        let first = contradiction.iter().find_map(|all| all.edges.first());
        if let Some((name, _)) = first {
            trials.extend(self.other_conditions(nearest_field, edges, granted, name));
        }
        trials.extend(each);
        let moved = nearest_field.moved_edges(edges)?.into_iter();
        trials.extend(moved.filter_map(|edge| self.moved(nearest_field, edge)));
        Ok((trials, contradiction))
    }

    /// What each of some columns explains.
    fn try_columns(&self, nearest_field: &NearestField, columns: &[Column]) -> Vec<Trial> {
        let trials = columns.iter().map(|(alternative, design)| {
            let model = self.base.with(self.rows, [design]);
            self.try_out(nearest_field, alternative.clone(), &model)
        });
        trials.collect()
    }

    fn try_out(
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

    /// What each of the edges with a stated condition explains by itself where it is released.
    fn edge_by_edge(
        &self,
        nearest_field: &NearestField,
        edges: &[Edge],
        granted: &[Granted],
    ) -> Vec<Trial> {
        let names = stated(edges).into_iter();
        let trials = names.filter_map(|name| {
            let scored = released(nearest_field, edges, &|other| other == name)?;
            let model =
                Model::of_score(self.rows, nearest_field, scored).granting(self.rows, granted);
            Some(self.try_out(nearest_field, Alternative::Edge(name.to_owned()), &model))
        });
        trials.collect()
    }

    /// What an edge with a stated condition explains with each of those that it may have instead.
    fn other_conditions(
        &self,
        nearest_field: &NearestField,
        edges: &[Edge],
        granted: &[Granted],
        name: &str,
    ) -> Vec<Trial> {
        let trials = OTHER_CONDITIONS.into_iter().filter_map(|condition| {
            let scored = with_condition(nearest_field, edges, condition, &|other| other == name)?;
            let model =
                Model::of_score(self.rows, nearest_field, scored).granting(self.rows, granted);
            let edge = name.to_owned();
            let alternative = Alternative::Condition { edge, condition };
            Some(self.try_out(nearest_field, alternative, &model))
        });
        trials.collect()
    }

    /// What an edge at another position explains, and how far away it lies; `None` where the data do not determine that.
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
fn improvement<'a>(trials: impl Iterator<Item = &'a Trial>, level: f64) -> Option<Reason> {
    let probability = trials.map(|trial| trial.probability).fold(1.0, f64::min);
    (probability < level).then_some(Reason::Alternative(probability))
}

/// Noise with too few independent values, which is no evidence against the equations.
fn few(correlation: Option<NoiseCorrelation>, nearest_field: &NearestField) -> Option<Reason> {
    let few =
        |one: &NoiseCorrelation| 2.0 * one.independent - nearest_field.fit.effective < INDEPENDENT;
    correlation.filter(few).map(|one| Reason::Few {
        length: one.length,
        independent: one.independent,
    })
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
fn released(
    nearest_field: &NearestField,
    edges: &[Edge],
    goes: &dyn Fn(&str) -> bool,
) -> Option<Scored> {
    with_condition(nearest_field, edges, EdgeCondition::Unknown, goes)
}

/// The same with another condition of these edges; `None` too where they have it.
fn with_condition(
    nearest_field: &NearestField,
    edges: &[Edge],
    condition: EdgeCondition,
    goes: &dyn Fn(&str) -> bool,
) -> Option<Scored> {
    let mut relaxed = edges.to_vec();
    let mut any = false;
    for edge in &mut relaxed {
        if is_stated(edge) && goes(&edge.segment.name) {
            any |= edge.condition != condition;
            edge.condition = condition;
        }
    }
    let search = any
        .then(|| Equations::new(&nearest_field.equations.task, &relaxed).ok())
        .flatten()?;
    match condition {
        EdgeCondition::Unknown => search.score_released(nearest_field).ok(),
        _ => search.score(nearest_field).ok(),
    }
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

impl Verdict {
    /// Adds the comparison of measured forces with those of the field.
    pub(super) fn with_forces(mut self, checks: &[ForceCheck]) -> Self {
        let size = |check: &&ForceCheck| check.standardised.abs();
        let worst = checks.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        if let Some(worst) = worst.filter(|check| check.contradicts()) {
            self.answer = Answer::NotExplained;
            self.reasons.push(Reason::Force(worst.standardised.abs()));
            let factor = worst.measured.force / worst.estimated;
            if factor > 0.0 && factor.is_finite() {
                self.trials.push(Trial {
                    alternative: Alternative::Factor(factor),
                    residual_rms: f64::NAN,
                    probability: normal_tail(worst.standardised),
                    gain: worst.standardised.powi(2) - 2.0,
                });
                self.trials.sort_by(|a, b| b.gain.total_cmp(&a.gain));
            }
        }
        self
    }
}

impl Rows {
    fn correlation(&self, noise: &CorrelatedNoise) -> NoiseCorrelation {
        NoiseCorrelation {
            length: noise.correlation.length,
            share: noise.correlation.share,
            independent: noise.correlation.independent(self.sites.positions()),
            evidence: noise.evidence,
        }
    }

    /// The place at which the mean residual of a marker and its neighbours is largest.
    fn worst(&self, nearest_field: &NearestField) -> Option<Worst> {
        const NEIGHBOURS: usize = 8;
        let around = nearest(self.sites.positions(), NEIGHBOURS);
        let mean = |index: usize| {
            let members = around[index].iter().chain([&index]);
            let sum = members.fold([0.0; 2], |sum, one| {
                let row = 2 * self.chosen[*one];
                [0, 1].map(|axis| sum[axis] + nearest_field.fit.residual[row + axis])
            });
            sum.map(|sum| sum / (around[index].len() + 1) as f64)
        };
        let all = (0..self.chosen.len()).map(|index| (index, mean(index)));
        let size = |[x, y]: [f64; 2]| x.hypot(y);
        let worst = all.max_by(|a, b| size(a.1).total_cmp(&size(b.1)));
        worst.map(|(index, misfit)| Worst {
            position: self.sites.positions()[index],
            misfit,
        })
    }
}
