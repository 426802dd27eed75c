//! What an error of the pictures' scale does to the forces, in words.

use crate::estimation::FieldEstimate;
use crate::statistics::Estimate;
use crate::units::number;

/// The relative error that is told of: a specimen 1 mm nearer to a camera 1 m away.
const TOLD: f64 = 1e-3;

/// Forces below this share of the largest one are not told of.
const SMALL: f64 = 1e-2;

/// A force along an axis, with what the error that is told of changes of it.
struct Changed<'a> {
    edge: &'a str,
    axis: &'static str,
    force: &'a Estimate,
    change: f64,
}

/// The forces of a frame that are not small.
fn changes(estimate: &FieldEstimate) -> Vec<Changed<'_>> {
    let values = estimate.forces.iter().flat_map(|own| &own.force);
    let largest = values.fold(0.0_f64, |most, force| most.max(force.value.abs()));
    let pairs = estimate.forces.iter().zip(&estimate.scale_change.forces);
    let all = pairs.flat_map(|(own, change)| {
        [0, 1].map(|axis| Changed {
            edge: &own.edge,
            axis: ["x", "y"][axis],
            force: &own.force[axis],
            change: TOLD * change[axis].abs(),
        })
    });
    all.filter(|own| own.force.value.abs() > SMALL * largest)
        .collect()
}

/// In % of the force; in N where the force is less, such as that of a closed edge in balance.
fn amount(own: &Changed) -> String {
    let share = own.change / own.force.value.abs();
    let by = if share < 1.0 {
        format!("{:.2} %", 100.0 * share)
    } else {
        format!("{} N", number(own.change))
    };
    format!("{} along {} by {by}", own.edge, own.axis)
}

/// What such an error changes in a frame, for a report.
pub fn paragraph(estimate: &FieldEstimate, deviation: f64) -> Option<String> {
    let changed: Vec<String> = changes(estimate).iter().map(amount).collect();
    let held = if deviation > 0.0 {
        format!(
            "intervals include a standard deviation of the scale of {:.3} %",
            100.0 * deviation
        )
    } else {
        "no interval includes this unless it is stated with --scale-error".to_owned()
    };
    (!changed.is_empty()).then(|| {
        format!(
            "A scale error of {} % in the picture of the last frame, as from a specimen 1 mm nearer to a camera 1 m away, would change the force on {}: \
             {held}.",
            100.0 * TOLD,
            changed.join(", on ")
        )
    })
}

/// A line where such an error changes a force by more than its interval says, and nothing is said of the scale.
pub fn line(frame: usize, estimate: &FieldEstimate, deviation: f64) -> Option<String> {
    let is_larger = |own: &&Changed| {
        let [low, high] = own.force.interval;
        own.change > 0.5 * (high - low)
    };
    let changes = changes(estimate);
    let worst = changes
        .iter()
        .filter(is_larger)
        .max_by(|a, b| a.change.total_cmp(&b.change));
    let worst = worst.filter(|_| deviation == 0.0 && estimate.is_explained())?;
    Some(format!(
        "a scale error of {} % in the picture of frame {frame} would change the force on {}, more than its interval allows: state it with --scale-error\n",
        100.0 * TOLD,
        amount(worst)
    ))
}
