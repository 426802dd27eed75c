//! The verdict on an estimate: whether its residuals are white, correlated as noise is, or no noise.
//!
//! Correlated noise is found by restricted likelihood twice: with the equations as they are, for the intervals, and with every
//! alternative of [`alternatives`] and all edges released, where the residuals are noise more surely. An alternative contradicts the
//! equations where it is likelier than noise would make it, each under the likelier of the two noises ([`Reference`], in one
//! linearised step).

use super::outcome::{
    Alternative, Answer, Contradiction, ForceCheck, NoiseCorrelation, Reason, Trial, Verdict, Worst,
};
use super::search::{MeshError, NearestField};
use crate::error::Error;
use crate::statistics::{CorrelatedNoise, nearest, normal_tail};

mod alternatives;
mod basis;
mod linear_model;
mod rows;

use alternatives::Column;
use basis::{Basis, LEVEL, improvement, released};
pub use linear_model::{Model, Reference};
pub use rows::{Rows, soundness};

/// The level instead of [`LEVEL`] where few values are independent and the correlation is uncertain: right equations have had probabilities
/// down to 1e-8 with noise correlated over six spacings, a wrong law 1e-35 (`gelbench validate interval-coverage`).
const STRICT: f64 = 1e-12;

/// An alternative explains the data better where its residuals are below this share of those of the equations.
const EXPLAINS: f64 = 0.98;

/// With fewer independent values than this beside the parameters, correlated noise cannot be distinguished from a misfit, and its
/// likeliest length is too uncertain for valid intervals: by their coverage, `gelbench validate interval-coverage`.
const INDEPENDENT: f64 = 100.0;

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
    mesh_error: Option<&MeshError>,
) -> Result<Judgement, Error> {
    let all = released(nearest_field, &|_| true);
    let (fit, variances) = match &all {
        Some(all) => (&all.fit, &all.variances),
        None => (&nearest_field.fit, &nearest_field.variances),
    };
    let sound = soundness(&nearest_field.observations().weights, fit, variances);
    let Some(rows) = Rows::new(nearest_field, &sound, mesh_error) else {
        return Ok(Judgement::default());
    };
    let at_markers = mesh_error.map(|error| &error.markers[..]);
    let granted = nearest_field.granted(at_markers)?;
    let base = Model::of_search(&rows, nearest_field).granting(&rows, &granted);
    let noises = base.noises(&rows);
    let columns = nearest_field.alternatives()?;
    let all =
        all.map(|scored| Model::of_score(&rows, nearest_field, scored).granting(&rows, &granted));
    let basis = Basis {
        reference: Reference::new(&rows, noises.first(), &base, all.as_ref(), &columns),
        rows: &rows,
        granted: &granted,
        base: &base,
    };
    judgement(&basis, nearest_field, (&columns, all.as_ref()), noises)
}

/// Tries the alternatives, among them the model with all edges released, and draws the conclusion.
fn judgement(
    basis: &Basis,
    nearest_field: &mut NearestField,
    (columns, all): (&[Column], Option<&Model>),
    mut noises: Vec<CorrelatedNoise>,
) -> Result<Judgement, Error> {
    let mut trials = basis.try_columns(nearest_field, columns);
    let together = all.map(|model| basis.try_out(nearest_field, Alternative::Edges, model));
    let noise = noises.first();
    let correlation = noise.map(|noise| basis.rows.correlation(noise));
    let few = few(correlation, nearest_field);
    let level = if few.is_some() { STRICT } else { LEVEL };
    let improvement = improvement(trials.iter().chain(&together), level);
    let gap = nearest_field.equations.task.knowledge.edge_gap.filter(|_| {
        improvement.is_some() && basis.explains_all(nearest_field, (columns, noise), (all, level))
    });
    let unknown_edges = gap.map(Reason::UnknownEdges);
    let against = improvement.filter(|_| unknown_edges.is_none());
    let mut contradiction = None;
    if against.is_some() {
        let (of_edges, contradicted) = basis.of_edges(nearest_field, (together, level))?;
        trials.extend(of_edges);
        contradiction = contradicted;
    }
    // An alternative that hardly changes the misfit explains nothing.
    let residual_rms = basis.base.residual_rms(basis.rows, nearest_field);
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
        worst: against.and_then(|_| basis.rows.worst(nearest_field)),
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

/// Evidence against the equations takes precedence over reasons why the data cannot judge.
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

/// The reason why the data cannot judge, where the noise has too few independent values.
fn few(correlation: Option<NoiseCorrelation>, nearest_field: &NearestField) -> Option<Reason> {
    let few =
        |one: &NoiseCorrelation| 2.0 * one.independent - nearest_field.fit.effective < INDEPENDENT;
    correlation.filter(few).map(|one| Reason::Few {
        length: one.length,
        independent: one.independent,
    })
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

    /// The position at which the mean residual of a marker and its neighbours is largest.
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
