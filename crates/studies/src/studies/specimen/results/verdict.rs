//! What a specimen's study requires, judged by finite elements with an error of their own.

use super::models::Models;
use crate::compare::judgement::{Judgement, judge, judge_correction};
use crate::results::{Check, Wanted};
use crate::statistics::larger;
use crate::studies::specimen::problem::Specimen;

/// The deviations of one load factor at which the corrected field and the finite elements both exist, in %.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// Of the springs' displacement and of what is measured, where they reached the load factor.
    pub springs: Option<[f64; 2]>,
    /// Of the corrected displacement, and of what is measured, with its sign.
    pub corrected: [f64; 2],
    /// The finite elements' own errors of both; not a number where they are not known.
    pub own: [f64; 2],
    /// Whether what is measured is none, of the corrected field and of the finite elements.
    pub measures_none: bool,
}

impl Deviation {
    /// 100 (1 − e_corrected/e_mass-spring) of the displacement, in %.
    pub fn correction_percent(&self) -> Option<f64> {
        let [springs, _] = self.springs?;
        Some(100.0 * (1.0 - self.corrected[0] / springs))
    }
}

/// A deviation and the finite elements' own error, of all load factors together.
///
/// The largest true deviation lies between d − e at the load factor with the largest measured one, d, and the largest
/// d + e of all load factors.
fn worst(pairs: impl Iterator<Item = [f64; 2]> + Clone) -> [f64; 2] {
    let [deviation, own] = pairs.clone().fold([f64::NEG_INFINITY, 0.0], |most, pair| {
        if pair[0] > most[0] || pair[0].is_nan() {
            pair
        } else {
            most
        }
    });
    let above = pairs.map(|[d, e]| d + e - deviation);
    // A number that is not known stays so.
    [deviation, above.fold(own, larger)]
}

/// The requirements, over all load factors with a corrected field and finite elements.
pub fn checks(specimen: &Specimen, models: &Models, deviations: &[Deviation]) -> Vec<Check> {
    let mut checks = Vec::new();
    if !deviations.is_empty() {
        let remedy = models.reference.remedy(specimen);
        checks.extend(deviation_checks(specimen, models, deviations, remedy));
        checks.extend(correction_check(specimen, deviations, remedy));
    }
    checks.extend(models.reference.goal_check(specimen));
    checks
}

const SOURCE: &str = "the study's tolerance";

/// Why what is measured needs no comparison.
const NOTHING: &str = "nothing to compare: both are zero relative to the forces on single nodes, or to the largest displacement";

fn deviation_checks(
    specimen: &Specimen,
    models: &Models,
    deviations: &[Deviation],
    remedy: &str,
) -> [Check; 2] {
    let limits = specimen.tolerances;
    let what = models.reference.measured.name();
    let named = [
        ("displacement", limits.displacement_percent),
        (what, limits.force_percent),
    ];
    [0, 1].map(|which| {
        let (name, limit) = named[which];
        let pairs = deviations.iter();
        let pairs = pairs.map(|own| [own.corrected[which].abs(), own.own[which]]);
        let [deviation, own] = worst(pairs);
        let nothing = which == 1 && deviations.iter().all(|own| own.measures_none);
        let judgement = if nothing {
            Judgement::Exact(NOTHING)
        } else {
            judge(deviation, own, limit, remedy)
        };
        let quantity = format!("corrected {name} from the finite elements");
        Check::new(quantity, "%", Wanted::AtMost(limit), SOURCE, deviation).judged(judgement, own)
    })
}

/// How much of the springs' deviation the correction takes away, where the springs have a field.
fn correction_check(specimen: &Specimen, deviations: &[Deviation], remedy: &str) -> Option<Check> {
    let wanted = specimen.tolerances.correction_percent;
    let mut found: Option<(f64, f64, Judgement)> = None;
    for deviation in deviations {
        let (Some([springs, _]), Some(correction)) =
            (deviation.springs, deviation.correction_percent())
        else {
            continue;
        };
        let pair = [springs, deviation.corrected[0]];
        let judgement = judge_correction(pair, deviation.own[0], 100.0 - wanted, remedy);
        // A ratio of two roundings is no correction, and none is needed.
        let value = match judgement {
            Judgement::Exact(_) => 100.0,
            _ => correction,
        };
        if found.as_ref().is_none_or(|(least, ..)| value < *least) {
            found = Some((value, deviation.own[0], judgement));
        }
    }
    let (value, own, judgement) = found?;
    let quantity = "correction of the displacement";
    let check = Check::new(quantity, "%", Wanted::AtLeast(wanted), SOURCE, value);
    Some(check.judged(judgement, own))
}

#[cfg(test)]
mod tests {
    use super::worst;

    #[test]
    fn the_worst_of_all_load_factors_comes_with_what_is_not_known_about_it() {
        let [deviation, own] = worst([[1.0, 0.01], [2.0, 0.02]].into_iter());
        assert!(deviation == 2.0 && (own - 0.02).abs() < 1e-12);
        // A smaller deviation that could be larger than the largest one.
        let [deviation, own] = worst([[1.9, 0.5], [2.0, 0.02]].into_iter());
        assert!(deviation == 2.0 && (own - 0.4).abs() < 1e-12);
        assert!(worst([[1.0, f64::NAN], [2.0, 0.0]].into_iter())[1].is_nan());
        assert!(worst([[1.0, 0.1], [f64::NAN, 0.0], [3.0, 0.1]].into_iter())[0].is_nan());
    }
}
