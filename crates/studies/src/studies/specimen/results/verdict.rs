//! The requirements of a specimen's study, judged by finite elements whose own error is known.

use super::models::Models;
use crate::compare::area_weighted_percent;
use crate::compare::judgement::{Judgement, judge, judge_correction};
use crate::mesh::{Mesh, largest_distance};
use crate::problem::Solution;
use crate::results::{Check, Wanted};
use crate::statistics::larger;
use crate::studies::ModelKind;
use crate::studies::specimen::problem::{PlateGrids, Specimen};

/// How far a field is from the finite elements at a load factor, in %.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// Of the displacement in relative L2, weighted by area.
    pub displacement: f64,
    /// The departure of the finite elements from the affine stretch over their displacement, ‖v − a‖/‖v‖; `None` where the specimen is
    /// no plate.
    pub departure_share: Option<f64>,
    /// Of what is measured, with its sign.
    pub measured: f64,
    /// The largest distance of a node in mm.
    pub largest: f64,
}

/// The deviations of one load factor at which the corrected field and the finite elements both exist.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// Of the springs, where they reached the load factor.
    pub springs: Option<Distance>,
    /// Of the corrected field.
    pub corrected: Distance,
    /// The finite elements' own errors of displacement, departure and what is measured in %; not a number where they are not known.
    pub reference_errors: [f64; 3],
    /// Whether what is measured is negligible, of the corrected field and of the finite elements.
    pub is_negligible: bool,
}

/// A measure of the distance to the finite elements.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    Displacement,
    /// The departure from the affine stretch.
    Departure,
    /// The force or displacement of the measured group.
    Measured,
}

impl Distance {
    /// The distance relative to the departure of the finite elements from the affine stretch; `None` where the specimen is no plate.
    pub fn departure(&self) -> Option<f64> {
        let share = self.departure_share?;
        Some(if self.displacement == 0.0 {
            0.0
        } else {
            self.displacement / share
        })
    }

    /// The distance by a measure in %; `None` of the departure where the specimen is no plate.
    pub fn by(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::Displacement => Some(self.displacement),
            Measure::Departure => self.departure(),
            Measure::Measured => Some(self.measured.abs()),
        }
    }
}

impl Deviation {
    /// Of springs or corrected field.
    pub fn of(&self, kind: ModelKind) -> Option<Distance> {
        match kind {
            ModelKind::MassSpring => self.springs,
            ModelKind::Corrected => Some(self.corrected),
            ModelKind::FiniteElement => None,
        }
    }

    /// 100 (1 − e_corrected/e_mass-spring) of the displacement, in %.
    pub fn correction_percent(&self) -> Option<f64> {
        Some(100.0 * (1.0 - self.corrected.displacement / self.springs?.displacement))
    }
}

/// The deviation of a model from the finite elements at a step; `None` where one of them has not reached it.
fn distance(
    specimen: &Specimen,
    models: &Models,
    kind: ModelKind,
    step: usize,
) -> Option<Distance> {
    let (what, finest) = (&models.reference.measured, &models.reference.finest);
    let expected = models.expected(kind, step)?;
    let solution = models.of(kind);
    let Solution { mesh, states, .. } = solution;
    let field = &states.get(step)?.displacement;
    let displacement = area_weighted_percent(mesh, field, expected);
    let [value, measured] = [solution, finest].map(|solved| what.at(solved, step));
    let (value, measured) = (value?, measured?);
    let measured = match what.negligible_beside(finest, step) {
        Some(_) if what.negligible_beside(solution, step).is_some() => 0.0,
        Some(scale) => 100.0 * (value - measured) / scale,
        None if value == measured => 0.0,
        None => 100.0 * (value / measured - 1.0),
    };
    Some(Distance {
        displacement,
        departure_share: departure_share(specimen, mesh, specimen.factors[step], expected),
        measured,
        largest: largest_distance(field, expected).0,
    })
}

/// The departure of a plate's field from the affine stretch relative to the field, ‖v − a‖/‖v‖.
fn departure_share(specimen: &Specimen, mesh: &Mesh, factor: f64, field: &[f64]) -> Option<f64> {
    let affine = specimen.plate()?.0.affine(mesh, factor);
    Some(area_weighted_percent(mesh, &affine, field) / 100.0)
}

/// The deviations at each load factor, where there is a corrected field.
pub fn deviations(specimen: &Specimen, models: &Models) -> Vec<Option<Deviation>> {
    let deviation = |step: usize| {
        let of = |kind| distance(specimen, models, kind, step);
        let corrected = of(ModelKind::Corrected)?;
        let reference = &models.reference;
        let displacement = reference.displacement_percent(step).unwrap_or(f64::NAN);
        let share = corrected.departure_share.unwrap_or(f64::NAN);
        let is_negligible = |kind| {
            let solution = models.of(kind);
            reference
                .measured
                .negligible_beside(solution, step)
                .is_some()
        };
        Some(Deviation {
            springs: of(ModelKind::MassSpring),
            corrected,
            reference_errors: [
                displacement,
                displacement / share,
                reference.measured_percent(step).unwrap_or(f64::NAN),
            ],
            is_negligible: is_negligible(ModelKind::FiniteElement)
                && is_negligible(ModelKind::Corrected),
        })
    };
    (0..specimen.factors.len()).map(deviation).collect()
}

/// Whether the finite elements are too coarse for something that they have to judge.
pub fn is_open(specimen: &Specimen, models: &Models) -> bool {
    let judged: Vec<_> = deviations(specimen, models).into_iter().flatten().collect();
    let open = |check: &Check| matches!(check.judgement(), Judgement::CannotBeJudged { .. });
    checks(specimen, models, &judged).iter().any(open)
}

/// A deviation and the finite elements' own error, of all load factors together.
///
/// The largest true deviation lies between d − e at the load factor with the largest measured one, d, and the largest
/// d + e of all load factors.
fn worst(pairs: impl Iterator<Item = [f64; 2]> + Clone) -> [f64; 2] {
    let [deviation, error] = pairs.clone().fold([f64::NEG_INFINITY, 0.0], |most, pair| {
        if pair[0] > most[0] || pair[0].is_nan() {
            pair
        } else {
            most
        }
    });
    let above = pairs.map(|[d, e]| d + e - deviation);
    // An error that is not known stays NaN.
    [deviation, above.fold(error, larger)]
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

/// The reason why negligible forces or displacements are not compared.
const NOTHING: &str = "nothing to compare: both are zero relative to the forces on single nodes, or to the largest displacement";

/// The judgement by finite elements that solve the corrected field's own equations.
fn own_reference() -> Judgement {
    Judgement::CannotBeJudged {
        reason: "the finite elements solve the corrected field's own equations on the same nodes"
            .into(),
        remedy: "take finer `finite_element.cells`".into(),
    }
}

fn deviation_checks(
    specimen: &Specimen,
    models: &Models,
    deviations: &[Deviation],
    remedy: &str,
) -> Vec<Check> {
    let limits = specimen.tolerances;
    let what = models.reference.measured.name();
    let judged = [
        (
            Measure::Displacement,
            "displacement",
            Some(limits.displacement_percent),
        ),
        (Measure::Departure, "departure", limits.departure_percent),
        (Measure::Measured, what, Some(limits.force_percent)),
    ];
    let check = |(measure, name, limit): (Measure, &str, Option<f64>)| {
        let limit = limit?;
        let pairs = deviations.iter();
        let pairs = pairs.map(|entry| {
            [
                entry.corrected.by(measure).unwrap_or(f64::NAN),
                entry.reference_errors[measure as usize],
            ]
        });
        let [deviation, error] = worst(pairs);
        let nothing =
            measure == Measure::Measured && deviations.iter().all(|entry| entry.is_negligible);
        let judgement = if nothing {
            Judgement::Exact(NOTHING)
        } else if is_own_reference(specimen) {
            own_reference()
        } else {
            judge(deviation, error, limit, remedy)
        };
        let quantity = format!("corrected {name} from the finite elements");
        let check = Check::new(quantity, "%", Wanted::AtMost(limit), SOURCE, deviation);
        Some(check.judged(judgement, error))
    };
    judged.into_iter().filter_map(check).collect()
}

fn is_own_reference(specimen: &Specimen) -> bool {
    specimen.grids().is_some_and(PlateGrids::is_own_reference)
}

/// How much of the springs' deviation the correction takes away, where the springs have a field.
fn correction_check(specimen: &Specimen, deviations: &[Deviation], remedy: &str) -> Option<Check> {
    let wanted = specimen.tolerances.correction_percent;
    let mut least: Option<(f64, f64, Judgement)> = None;
    for deviation in deviations {
        let (Some(springs), Some(correction)) = (deviation.springs, deviation.correction_percent())
        else {
            continue;
        };
        let pair = [springs.displacement, deviation.corrected.displacement];
        let judgement = if is_own_reference(specimen) {
            own_reference()
        } else {
            judge_correction(pair, deviation.reference_errors[0], 100.0 - wanted, remedy)
        };
        // A ratio of two roundings is no correction, and none is needed.
        let value = match judgement {
            Judgement::Exact(_) => 100.0,
            _ => correction,
        };
        if least.as_ref().is_none_or(|(before, ..)| value < *before) {
            least = Some((value, deviation.reference_errors[0], judgement));
        }
    }
    let (value, error, judgement) = least?;
    let quantity = "correction of the displacement";
    let check = Check::new(quantity, "%", Wanted::AtLeast(wanted), SOURCE, value);
    Some(check.judged(judgement, error))
}

#[cfg(test)]
mod tests {
    use super::worst;

    #[test]
    fn the_worst_of_all_load_factors_comes_with_what_is_not_known_about_it() {
        let [deviation, error] = worst([[1.0, 0.01], [2.0, 0.02]].into_iter());
        assert!(deviation == 2.0 && (error - 0.02).abs() < 1e-12);
        // A smaller deviation that could be larger than the largest one.
        let [deviation, error] = worst([[1.9, 0.5], [2.0, 0.02]].into_iter());
        assert!(deviation == 2.0 && (error - 0.4).abs() < 1e-12);
        assert!(worst([[1.0, f64::NAN], [2.0, 0.0]].into_iter())[1].is_nan());
        assert!(worst([[1.0, 0.1], [f64::NAN, 0.0], [3.0, 0.1]].into_iter())[0].is_nan());
    }
}
