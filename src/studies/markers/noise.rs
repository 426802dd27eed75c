//! What is said of the noise of markers, in words.

use super::MarkerStudy;
use crate::corrector::estimation::FieldEstimate;

/// What is said of the noise and of gross errors, frame by frame.
pub fn remarks(field: &MarkerStudy, estimates: &[FieldEstimate]) -> impl Iterator<Item = String> {
    let frames = field.series.frames.iter().zip(estimates);
    frames.flat_map(|(frame, estimate)| {
        let told = [field.of_gross_errors(estimate), unevenness(estimate)];
        let told = told.into_iter().flatten();
        told.map(|told| format!("frame {}: {told}", frame.number))
            .collect::<Vec<_>>()
    })
}

fn unevenness(estimate: &FieldEstimate) -> Option<String> {
    let range = |[low, high]: [f64; 2]| match high - low > 1e-6 * high {
        true => format!("{low:.2e} to {high:.2e} mm"),
        false => format!("{low:.2e} mm"),
    };
    let [x, y] = estimate.noise_range?.map(range);
    Some(format!(
        "the noise differs between markers, ux {x} and uy {y}: noisier markers get less weight"
    ))
}
