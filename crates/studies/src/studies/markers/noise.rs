//! What is said of the noise of markers, in words.

use super::MarkerStudy;
use super::of_frames::{OfFrame, once};
use crate::estimation::FieldEstimate;
use crate::markers::Frame;

/// What is said of gross errors and of the noise, once for all frames.
pub fn remarks(field: &MarkerStudy, estimates: &[FieldEstimate]) -> Vec<String> {
    let frames = || field.series.frames.iter().zip(estimates);
    let errors = frames().map(|(frame, estimate)| (frame, field.of_gross_errors(estimate)));
    let noise = frames().map(|(frame, estimate)| (frame, unevenness(estimate)));
    let of_kind = |remarks: &mut dyn Iterator<Item = (&Frame, Option<String>)>| {
        let messages = remarks.filter_map(|(frame, remark)| {
            Some(OfFrame {
                frame: frame.number,
                message: remark?,
                hint: String::new(),
            })
        });
        once(&field.frame_numbers(), messages.collect())
    };
    let all = [of_kind(&mut { errors }), of_kind(&mut { noise })];
    all.into_iter()
        .flatten()
        .map(|remark| remark.message)
        .collect()
}

fn unevenness(estimate: &FieldEstimate) -> Option<String> {
    let range = |[low, high]: [f64; 2]| {
        if high - low > 1e-6 * high {
            format!("{low:.2e} to {high:.2e} mm")
        } else {
            format!("{low:.2e} mm")
        }
    };
    let [x, y] = estimate.noise_range?.map(range);
    Some(format!(
        "the noise differs between markers, ux {x} and uy {y}: noisier markers get less weight"
    ))
}
