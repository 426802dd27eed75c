//! The weights of markers where none are stated: all alike, unless some are farther off than noise can be.
//!
//! ```text
//! m e^(−d²/2) < 10⁻³      d: the largest standardised residual of m markers
//! ```
//!
//! holds where noise gives such a residual in less than one of a thousand frames. Many gross errors hide each other, because they enlarge the
//! estimated noise: then the median of all d is far below that of normal noise. Markers with such residuals are gross errors as long as they
//! are few, or lie scattered among the others. Many that lie together are a misfit of the equations, which must not be weighted away; nor may
//! they enlarge the noise by which this misfit is judged, because with a noise that is large enough any law fits.

use super::MarkerStudy;
use super::quantities::{outliers, rounding, used};
use crate::error::Error;
use crate::estimation::{Answer, FieldEstimate, Knowledge, MarkerEstimate, Reason, Robust};
use crate::markers::Marker;
use crate::statistics::nearest;

/// The largest share of gross errors among markers, wherever they lie; and where they are scattered.
const MOST: f64 = 0.1;
const MOST_SCATTERED: f64 = 0.45;

/// The scatter by the median over that by squares below which many markers may be gross errors.
const IN_DOUBT: f64 = 0.75;

/// Neighbours of an outlier among which other outliers are counted.
const AROUND: usize = 4;

/// Probability by noise below which a marker is a gross error.
const CHANCE: f64 = 1e-3;

impl MarkerStudy {
    /// The estimate with the stated weights, else with Tukey's where there are gross errors; these may also be why no estimate with equal
    /// weights is found.
    pub(super) fn weighted(
        &self,
        markers: &[Marker],
        knowledge: Knowledge,
        solve: &dyn Fn(&Knowledge) -> Result<FieldEstimate, Error>,
    ) -> Result<FieldEstimate, Error> {
        let estimate = solve(&Knowledge {
            ends_at_gross_errors: self.conditions.robust.is_none(),
            ..knowledge.clone()
        });
        let in_doubt = match &estimate {
            Ok(estimate) => {
                has_gross_errors(estimate)
                    || MarkerEstimate::scatter_by_median(&estimate.markers) < IN_DOUBT
            }
            Err(fault) => matches!(fault, Error::Solve { .. }),
        };
        if self.conditions.robust.is_some() || !in_doubt {
            return estimate.map(|estimate| judged_with(estimate, None));
        }
        let robust = Knowledge {
            robust: Robust::Tukey,
            ..knowledge.clone()
        };
        match solve(&robust).ok().filter(has_gross_errors) {
            Some(without) if !has_many(&without) || are_scattered(markers, &without) => Ok(without),
            without => {
                let has_ended = |estimate: &FieldEstimate| estimate.displacement.is_empty();
                let complete = match estimate {
                    Ok(estimate) if has_ended(&estimate) => solve(&knowledge),
                    estimate => estimate,
                };
                complete.map(|estimate| judged_with(estimate, without))
            }
        }
    }
}

/// The verdict on an estimate with full weights for all markers, given that without gross errors where there are many that lie together. What
/// the sound markers contradict is not explained; where gross errors make up the noise, nothing can be judged.
fn judged_with(mut estimate: FieldEstimate, without: Option<FieldEstimate>) -> FieldEstimate {
    let noise = estimate.noise;
    let in_doubt = without.is_some() || has_hidden(&estimate);
    let verdict = &mut estimate.verdict;
    if verdict.answer == Answer::NotExplained || !in_doubt {
        return estimate;
    }
    match without.map(|other| other.verdict) {
        Some(other) if other.answer == Answer::NotExplained => *verdict = other,
        _ => {
            verdict.answer = Answer::Undecided;
            verdict.reasons.push(Reason::GrossErrors(noise));
        }
    }
    estimate
}

fn has_gross_errors(estimate: &FieldEstimate) -> bool {
    let markers = estimate.markers.iter().flatten();
    let outliers = markers.filter(|marker| marker.outlier);
    let residuals = outliers.map(|marker| marker.standardised_residual);
    let largest = residuals.fold(0.0, f64::max);
    used(estimate) as f64 * (-0.5 * largest * largest).exp() < CHANCE
}

/// The least number of degrees of freedom from which the distribution of the noise is judged.
const FEWEST: f64 = 20.0;

/// Whether gross errors are so many that they make up the noise of an estimate that gives all markers their weight.
fn has_hidden(estimate: &FieldEstimate) -> bool {
    estimate.robust == Robust::No
        && estimate.degrees_of_freedom >= FEWEST
        && estimate.noise > rounding(estimate)
        && MarkerEstimate::scatter_by_median(&estimate.markers) < MarkerEstimate::GROSS_ERRORS
}

/// Whether outliers are scattered at random: the share of outliers among the neighbours of an outlier is that among all markers, within four
/// standard deviations. Of random sets less than one in a thousand is beyond three; outliers in patches are beyond ten.
fn are_scattered(markers: &[Marker], estimate: &FieldEstimate) -> bool {
    const DEVIATIONS: f64 = 4.0;
    let pairs = markers.iter().zip(&estimate.markers);
    let used: Vec<_> = pairs
        .filter_map(|(marker, estimate)| Some((marker.position, estimate.as_ref()?.outlier)))
        .collect();
    let positions: Vec<[f64; 2]> = used.iter().map(|(position, _)| *position).collect();
    let around = nearest(&positions, AROUND);
    let outliers = (0..used.len()).filter(|index| used[*index].1);
    let (mut count, mut alike, mut neighbours) = (0.0, 0.0, 0.0);
    for index in outliers {
        count += 1.0;
        neighbours += around[index].len() as f64;
        alike += around[index].iter().filter(|other| used[**other].1).count() as f64;
    }
    let share = count / used.len() as f64;
    // Each pair is counted from both ends.
    let deviation = (2.0 * share * (1.0 - share) / neighbours).sqrt();
    share < MOST_SCATTERED && alike / neighbours < share + DEVIATIONS * deviation
}

/// Whether there are more outliers than gross errors can be.
pub(super) fn has_many(estimate: &FieldEstimate) -> bool {
    outliers(estimate) as f64 > MOST * used(estimate) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::Verdict;

    /// An estimate with an answer and markers of which a tenth have `far` times the residual of the others.
    fn estimated(answer: Answer, far: f64) -> FieldEstimate {
        let marker = |index: usize| {
            let near = 1.0 / (0.9 + 0.1 * far * far).sqrt();
            let standardised_residual = if index.is_multiple_of(10) {
                far * near
            } else {
                near
            };
            Some(MarkerEstimate {
                residual: [standardised_residual, 0.0],
                standardised_residual,
                trust: 1.0,
                outlier: false,
            })
        };
        FieldEstimate {
            markers: (0..100).map(marker).collect(),
            displacement: vec![10.0, 0.0],
            noise: 1.0,
            degrees_of_freedom: 190.0,
            verdict: Verdict {
                answer,
                ..Verdict::default()
            },
            ..FieldEstimate::default()
        }
    }

    #[test]
    fn noise_that_is_made_up_by_gross_errors_explains_nothing() {
        let judged = |far: f64, without: Option<Answer>| {
            let without = without.map(|answer| estimated(answer, 1.0));
            judged_with(estimated(Answer::Correlated, far), without)
        };
        // Noise alone, and noise of which a tenth of the markers makes up nearly all.
        assert_eq!(judged(1.2, None).verdict.answer, Answer::Correlated);
        let hidden = judged(20.0, None);
        assert_eq!(hidden.verdict.answer, Answer::Undecided);
        assert!(!hidden.is_explained() && !hidden.has_intervals());
        assert!(hidden.verdict.reasons[0].words().contains("gross errors"));
        // What the sound markers contradict is not explained, what they cannot is undecided.
        let refuted = judged(1.2, Some(Answer::NotExplained));
        assert_eq!(refuted.verdict.answer, Answer::NotExplained);
        let undecided = judged(1.2, Some(Answer::Explained));
        assert_eq!(undecided.verdict.answer, Answer::Undecided);
    }
}
