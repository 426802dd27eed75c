//! What a study requires of its corrected field, and whether it is met.

use super::Results;
use crate::compare::judgement::{Judgement, ROUNDING_PERCENT, judge, judge_correction};
use crate::compare::{Deviation, StepComparison};
use crate::problem::ClampedPlate;
use crate::results::{Check, Wanted};
use crate::studies::plate::problem::Study;

/// How the reference becomes a better one.
const REMEDY: &str = "take finer `finite_element.cells`, or a `finite_element.grading` near 2";

/// Where the limits come from.
const SOURCE: &str = "the study's tolerance";

/// A deviation of the corrected field, and the reference's own error of the same quantity.
struct Measure {
    name: &'static str,
    limit: f64,
    deviation: fn(&Deviation) -> f64,
    own: fn(&Results, usize) -> Option<f64>,
}

impl Results {
    /// Every requirement on the corrected field with its worst value over all stretches.
    pub fn requirements(&self, study: &Study) -> Vec<Check> {
        let tolerances = &study.tolerances;
        let displacement = Measure {
            name: "displacement",
            limit: tolerances.displacement_percent,
            deviation: |deviation| deviation.displacement_percent,
            own: |results, step| Some(results.comparison[step].reference?.displacement_percent),
        };
        let departure = tolerances.departure_percent.map(|limit| Measure {
            name: "departure from affine",
            limit,
            deviation: |deviation| deviation.departure_percent,
            own: |results, step| Some(results.comparison[step].reference?.departure_percent),
        });
        let force = Measure {
            name: "force",
            limit: tolerances.force_percent,
            deviation: |deviation| deviation.force_percent.abs(),
            own: Self::own_force_percent,
        };
        let measures = [Some(displacement), departure, Some(force)];
        let largest = measures.iter().flatten();
        let largest = largest.map(|measure| self.largest(study, measure));
        largest.chain([self.correction(study)]).collect()
    }

    /// The worst deviation over all stretches, judged with the largest own error over all of them: a force may be right by
    /// accident at one stretch.
    fn largest(&self, study: &Study, measure: &Measure) -> Check {
        let compared = || self.comparison.iter().enumerate();
        let deviations = compared().filter_map(|(_, step)| step.corrected.as_ref());
        let deviation = worst(deviations.map(measure.deviation), f64::max);
        let judged = compared().filter(|(_, step)| step.corrected.is_some());
        let own = judged.map(|(step, _)| (measure.own)(self, step).unwrap_or(f64::NAN));
        let own_error = worst(own, f64::max);
        let judgement = if study.is_its_own_reference() {
            its_own_reference()
        } else {
            judge(deviation, own_error, measure.limit, REMEDY)
        };
        let missing = self.stretches_without(|step| step.corrected.is_none());
        let judgement =
            self.unless_missing(judgement, missing, "the corrected field is not compared");
        let wanted = Wanted::AtMost(measure.limit);
        Check::new(measure.name, "%", wanted, SOURCE, deviation).judged(judgement, own_error)
    }

    fn correction(&self, study: &Study) -> Check {
        let limit = study.tolerances.correction_percent;
        let own = |step: &StepComparison| step.reference.map_or(f64::NAN, |r| r.departure_percent);
        let pair = |step: &StepComparison| {
            let [before, after] = step.pair()?.map(|deviation| deviation.departure_percent);
            Some(([before, after], own(step)))
        };
        let pairs: Vec<_> = self.comparison.iter().filter_map(pair).collect();
        let judged = pairs.iter().map(|(pair, own)| {
            if study.is_its_own_reference() {
                its_own_reference()
            } else {
                judge_correction(*pair, *own, 100.0 - limit, REMEDY)
            }
        });
        let judgement = judged.max_by_key(severity).unwrap_or(Judgement::Fail);
        let missing = self.stretches_without(|step| step.pair().is_none());
        let rounding = |([before, _], own): &([f64; 2], f64)| {
            *before <= ROUNDING_PERCENT && *own <= ROUNDING_PERCENT
        };
        let measured = || pairs.iter().filter(|pair| !rounding(pair));
        let corrections = measured().map(|([before, after], _)| 100.0 * (1.0 - after / before));
        let own = measured().map(|([before, _], own)| 100.0 * own / before);
        let judgement = self.unless_missing(judgement, missing, "the correction is not known");
        let least = worst(corrections, f64::min);
        let wanted = Wanted::AtLeast(limit);
        Check::new("correction of the departure", "%", wanted, SOURCE, least)
            .judged(judgement, worst(own, f64::max))
    }

    /// What is not known at all stretches can have failed at one, but it cannot have passed.
    fn unless_missing(&self, judgement: Judgement, missing: Vec<String>, what: &str) -> Judgement {
        let failed = judgement == Judgement::Fail && missing.len() < self.comparison.len();
        if missing.is_empty() || failed {
            return judgement;
        }
        Judgement::CannotBeJudged {
            reason: format!("{what} at a stretch of {}", missing.join(", ")),
            remedy: "see which model has ended there, and why".into(),
        }
    }

    fn stretches_without(&self, is_missing: impl Fn(&StepComparison) -> bool) -> Vec<String> {
        let missing = self.comparison.iter().filter(|step| is_missing(step));
        missing
            .map(|step| format!("{} %", ClampedPlate::percent(step.stretch)))
            .collect()
    }
}

/// Which of several judgements counts.
fn severity(judgement: &Judgement) -> usize {
    match judgement {
        Judgement::Exact(_) => 0,
        Judgement::Pass | Judgement::PassByMargin => 1,
        Judgement::CannotBeJudged { .. } => 2,
        Judgement::Fail => 3,
    }
}

fn its_own_reference() -> Judgement {
    Judgement::CannotBeJudged {
        reason: "the finite elements solve the corrected field's own equations on the same nodes"
            .into(),
        remedy: REMEDY.into(),
    }
}

/// The largest or smallest value; not a number when one of them is none.
fn worst(values: impl Iterator<Item = f64>, pick: fn(f64, f64) -> f64) -> f64 {
    let either = |a: f64, b: f64| {
        if a.is_nan() || b.is_nan() {
            f64::NAN
        } else {
            pick(a, b)
        }
    };
    values.reduce(either).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_not_a_number_is_the_worst() {
        assert_eq!(worst([3.0, 1.0, 2.0].into_iter(), f64::max), 3.0);
        assert_eq!(worst([3.0, 1.0, 2.0].into_iter(), f64::min), 1.0);
        assert!(worst([3.0, f64::NAN, 2.0].into_iter(), f64::max).is_nan());
        assert!(worst([].into_iter(), f64::max).is_nan());
    }
}
