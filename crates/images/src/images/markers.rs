//! Tracked points as markers in mm.

use super::tracked::Tracked;
use crate::markers::{Frame, Marker, MarkerSeries};

/// The frames of tracked points as markers: in mm by the length of a pixel, x to the right, y up, with the origin at the centre of the lower left
/// pixel of images of `height` rows. Each frame has its number. A marker's standard deviation is √(½ tr Cov(u)).
pub fn series(frames: &[(usize, Vec<Option<Tracked>>)], height: usize, pixel: f64) -> MarkerSeries {
    let up = (height - 1) as f64;
    let marker = |(number, tracked): (usize, &Option<Tracked>)| {
        let tracked = tracked.as_ref()?;
        let ([x, y], [u, v]) = (tracked.position, tracked.displacement);
        Some(Marker {
            number,
            position: [x * pixel, (up - y) * pixel],
            displacement: [u * pixel, -v * pixel],
            standard_deviation: Some((0.5 * tracked.covariance.trace()).sqrt() * pixel),
        })
    };
    MarkerSeries {
        frames: frames
            .iter()
            .map(|(number, all)| Frame {
                number: *number,
                time: None,
                markers: all.iter().enumerate().filter_map(marker).collect(),
            })
            .collect(),
        ..MarkerSeries::default()
    }
}
