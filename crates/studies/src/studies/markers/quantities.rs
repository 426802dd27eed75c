//! Quantities of a corrected frame that several files and pictures show: nominal stress, and residuals of markers.

use crate::estimation::{FieldEstimate, MarkerEstimate, StressEstimate};
use crate::markers::{Frame, Marker};
use crate::statistics::{farthest, nearest};

/// The number of markers on the mesh.
pub fn used(estimate: &FieldEstimate) -> usize {
    estimate.markers.iter().flatten().count()
}

/// The number of outliers.
pub fn outliers(estimate: &FieldEstimate) -> usize {
    let markers = estimate.markers.iter().flatten();
    markers.filter(|marker| marker.outlier).count()
}

/// Root mean square of the components of the markers' residuals in mm.
pub fn residual_rms(estimate: &FieldEstimate) -> f64 {
    let markers = estimate.markers.iter().flatten();
    let squares: f64 = markers
        .flat_map(|marker| marker.residual)
        .map(|r| r * r)
        .sum();
    (squares / (2 * used(estimate).max(1)) as f64).sqrt()
}

/// The largest distance of the given field from the corrected one at its nodes, in mm.
pub fn largest_correction(estimate: &FieldEstimate) -> f64 {
    let markers = estimate.markers.iter().flatten();
    let lengths = markers.map(|marker| marker.residual[0].hypot(marker.residual[1]));
    lengths.fold(0.0, f64::max)
}

/// The largest standard error of a displacement in mm.
pub fn largest_error(estimate: &FieldEstimate) -> f64 {
    let pairs = estimate.displacement_error.chunks_exact(2);
    pairs.map(|pair| pair[0].hypot(pair[1])).fold(0.0, f64::max)
}

/// The components xx, xy, yx, yy of the nominal stress from those of the first Piola–Kirchhoff stress, its transpose.
pub fn nominal([p11, p12, p21, p22]: [f64; 4]) -> [f64; 4] {
    [p11, p21, p12, p22]
}

/// The components xx, xy, yx, yy of the nominal stress of a cell in MPa.
pub fn nominal_stress(cell: &StressEstimate) -> [f64; 4] {
    nominal(cell.first_piola_kirchhoff_stress)
}

/// Of all markers of a frame: the residual along x and y in mm, its length in standard deviations, the robust weight, and one for an
/// outlier, zero otherwise; NaN where a marker does not lie on the mesh.
pub fn residuals(estimate: &FieldEstimate) -> impl Iterator<Item = [f64; 5]> {
    let of = |marker: MarkerEstimate| {
        let [x, y] = marker.residual;
        let outlier = f64::from(u8::from(marker.outlier));
        [x, y, marker.standardised_residual, marker.trust, outlier]
    };
    let markers = estimate.markers.iter();
    markers.map(move |marker| marker.map_or([f64::NAN; 5], of))
}

/// The markers on the mesh that are no outliers: the index of each among those of the frame, the marker, and its residual in mm.
pub fn sound<'a>(
    frame: &'a Frame,
    estimate: &'a FieldEstimate,
) -> impl Iterator<Item = (usize, &'a Marker, [f64; 2])> {
    let pairs = frame.markers.iter().zip(&estimate.markers).enumerate();
    pairs.filter_map(|(index, (marker, estimate))| {
        let estimate = estimate.filter(|estimate| !estimate.outlier)?;
        Some((index, marker, estimate.residual))
    })
}

/// The mean residual of every marker and its eight nearest neighbours in mm, which for noise alone is a third of the residual; NaN where a
/// marker does not lie on the mesh or is an outlier.
pub fn misfits(frame: &Frame, estimate: &FieldEstimate) -> Vec<[f64; 2]> {
    const NEIGHBOURS: usize = 8;
    let sound: Vec<_> = sound(frame, estimate).collect();
    let positions: Vec<[f64; 2]> = sound.iter().map(|(_, marker, _)| marker.position).collect();
    let mut all = vec![[f64::NAN; 2]; frame.markers.len()];
    for (marker, others) in nearest(&positions, NEIGHBOURS).into_iter().enumerate() {
        let members = others.iter().chain([&marker]);
        let sum = members.fold([0.0; 2], |sum, one| {
            [0, 1].map(|axis| sum[axis] + sound[*one].2[axis])
        });
        all[sound[marker].0] = sum.map(|sum| sum / (others.len() + 1) as f64);
    }
    all
}

/// Residuals up to this size in mm are rounding, as those of a computed field.
pub fn rounding(estimate: &FieldEstimate) -> f64 {
    const SHARE: f64 = 1e-6;
    SHARE * farthest(estimate.displacement.iter().copied()).abs()
}
