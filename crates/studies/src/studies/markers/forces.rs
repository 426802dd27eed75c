//! The forces of a correction in words: their intervals, whether they rest on the card alone, and the effects of an unknown edge and of
//! the pictures' scale.

use super::MarkerStudy;
use crate::estimation::{Answer, FieldEstimate};
use crate::statistics::{Estimate, farthest};
use crate::units::{decimals, number};

/// The interval of a force through the edges of the mesh; empty for a force without uncertainty.
pub fn interval(estimate: &FieldEstimate, force: &Estimate) -> String {
    let [low, high] = force.interval;
    if low >= high {
        return String::new();
    }
    if !estimate.has_intervals() {
        return "none".to_owned();
    }
    let (ends, _) = without_growth(estimate, force);
    ends.map(|end| decimals(end, 4)).join(" … ")
}

/// The force with an edge farther out, where that is more.
pub fn farther_out(estimate: &FieldEstimate, force: &Estimate) -> Option<f64> {
    let is_known = estimate.has_intervals() && force.interval[0] < force.interval[1];
    without_growth(estimate, force).1.filter(|_| is_known)
}

/// Why an estimate has no intervals.
pub fn reason(estimate: &FieldEstimate) -> &'static str {
    match estimate.verdict.answer {
        Answer::NotExplained => "not explained",
        _ if estimate.unknown_edges().is_some() => "the free edges are not known well enough",
        _ => "the noise is that of gross errors",
    }
}

/// The interval through the edges of the mesh, and the force with an edge farther out.
fn without_growth(estimate: &FieldEstimate, force: &Estimate) -> ([f64; 2], Option<f64>) {
    let half = estimate.reach * force.standard_error;
    let [low, high] = force.interval;
    let [less, more] = [force.value - half - low, high - force.value - half];
    match half.max(less).max(more) {
        _ if half <= 0.0 => ([low, high], None),
        most if most == less => ([low + less, high], Some(low)),
        most if most == more => ([low, high - more], Some(high)),
        _ => ([low, high], None),
    }
}

/// On what the size of the forces is based, where that is the card.
pub fn basis(study: &MarkerStudy, estimate: &FieldEstimate) -> Option<String> {
    let name = &study.card.name;
    if !estimate.is_given_the_law || !estimate.has_intervals() {
        return None;
    }
    let deviations = estimate.law_deviations.iter().flatten();
    let others = match study.regions[..] {
        [] => "",
        _ => " The regions are as stiff as their cards, whose error no interval includes.",
    };
    let of_card = match deviations.copied().reduce(f64::max) {
        None => format!(
            "Forces and stresses are given the card `{name}`, which records no uncertainty: its relative error in stiffness is one of theirs \
             that no interval includes, and that only a measured force shows (--force)."
        ),
        Some(most) => format!(
            "Intervals of forces and stresses include the uncertainty that the card `{name}` records, up to ± {} N; that another law may fit \
             as well is not in it.",
            decimals(estimate.reach * most, 4)
        ),
    };
    Some(of_card + others)
}

impl MarkerStudy {
    /// An estimate whose intervals of forces include an edge up to a marker's spacing farther out: one more row of
    /// markers would fit in else. The force grows with the width as far as the strain energy along the free edges shows; a
    /// modulus that follows a measured force falls by as much.
    pub(super) fn with_unknown_edge(&self, mut estimate: FieldEstimate) -> FieldEstimate {
        let Some(gap) = self.unknown_gap else {
            return estimate;
        };
        let growth = estimate.growth * gap;
        for force in estimate.forces.iter_mut().flat_map(|edge| &mut edge.force) {
            *force = force.widened(growth * force.value);
        }
        for (_, unit, modulus) in &mut estimate.parameters {
            if *unit == "MPa" {
                *modulus = modulus.lower_by(growth);
            }
        }
        estimate
    }
}

/// The relative error of the pictures' scale that is reported: a specimen 1 mm nearer to a camera 1 m away.
const SCALE_ERROR: f64 = 1e-3;

/// A force along an axis, with its change by an error of the scale.
struct Changed<'a> {
    edge: &'a str,
    axis: &'static str,
    force: &'a Estimate,
    change: f64,
}

/// The magnitude of the largest force of a frame along an axis in N.
pub fn largest(estimate: &FieldEstimate) -> f64 {
    let forces = estimate.forces.iter().flat_map(|edge| &edge.force);
    farthest(forces.map(|force| force.value)).abs()
}

/// The forces of a frame that are not small.
fn changes(estimate: &FieldEstimate) -> Vec<Changed<'_>> {
    /// Share of the largest force.
    const SMALL: f64 = 1e-2;
    let largest = largest(estimate);
    let pairs = estimate.forces.iter().zip(&estimate.scale_change.forces);
    let all = pairs.flat_map(|(edge, change)| {
        [0, 1].map(|axis| Changed {
            edge: &edge.edge,
            axis: ["x", "y"][axis],
            force: &edge.force[axis],
            change: SCALE_ERROR * change[axis].abs(),
        })
    });
    all.filter(|changed| changed.force.value.abs() > SMALL * largest)
        .collect()
}

impl Changed<'_> {
    /// In % of the force; in N where the force is less, such as that of a closed edge in balance.
    fn words(&self) -> String {
        let share = self.change / self.force.value.abs();
        let by = if share < 1.0 {
            format!("{:.2} %", 100.0 * share)
        } else {
            format!("{} N", number(self.change))
        };
        format!("{} along {} by {by}", self.edge, self.axis)
    }
}

/// The effect of an error of the scale on a frame, for a report.
pub fn scale_paragraph(estimate: &FieldEstimate, deviation: f64) -> Option<String> {
    let changed: Vec<String> = changes(estimate).iter().map(Changed::words).collect();
    let included = if deviation > 0.0 {
        let percent = 100.0 * deviation;
        format!("intervals include a standard deviation of the scale of {percent:.3} %")
    } else {
        "no interval includes this unless it is stated with --scale-error".to_owned()
    };
    (!changed.is_empty()).then(|| {
        format!(
            "A scale error of {} % in the picture of the last frame, as from a specimen 1 mm nearer to a camera 1 m away, would change the force on {}: \
             {included}.",
            100.0 * SCALE_ERROR,
            changed.join(", on ")
        )
    })
}

/// A line where such an error changes a force by more than its interval allows, and the scale is not stated.
pub fn scale_line(frame: usize, estimate: &FieldEstimate, deviation: f64) -> Option<String> {
    if deviation != 0.0 || !estimate.is_explained() {
        return None;
    }
    let is_large = |changed: &Changed| {
        let [low, high] = changed.force.interval;
        changed.change > 0.5 * (high - low)
    };
    let large = changes(estimate).into_iter().filter(is_large);
    let worst = large.max_by(|a, b| a.change.total_cmp(&b.change))?;
    Some(format!(
        "a scale error of {} % in the picture of frame {frame} would change the force on {}, more than its interval allows: state it with --scale-error",
        100.0 * SCALE_ERROR,
        worst.words()
    ))
}
