//! What files and pictures of a corrected frame hold in common: nominal stress, and residuals of markers.

use crate::estimation::{FieldEstimate, StressEstimate};
use crate::markers::Frame;
use crate::statistics::nearest;

/// The components xx, xy, yx, yy of the nominal stress from those of the first Piola–Kirchhoff stress, its transpose.
pub fn nominal([p11, p12, p21, p22]: [f64; 4]) -> [f64; 4] {
    [p11, p21, p12, p22]
}

/// The components xx, xy, yx, yy of the nominal stress of a cell in MPa.
pub fn nominal_stress(cell: &StressEstimate) -> [f64; 4] {
    nominal(cell.first_piola_kirchhoff_stress)
}

/// What is left of a marker, and NaN where it has no place on the mesh.
pub struct Residual {
    /// Measured less corrected displacement in mm.
    pub residual: [f64; 2],
    /// Its length in standard deviations.
    pub standardised: f64,
    /// The robust weight, 0 to 1.
    pub trust: f64,
    /// One for an outlier, zero otherwise.
    pub outlier: f64,
}

/// What is left of every marker of a frame.
pub fn residuals(estimate: &FieldEstimate) -> impl Iterator<Item = Residual> {
    estimate.markers.iter().map(|marker| match marker {
        Some(marker) => Residual {
            residual: marker.residual,
            standardised: marker.standardised_residual,
            trust: marker.trust,
            outlier: f64::from(u8::from(marker.outlier)),
        },
        None => Residual {
            residual: [f64::NAN; 2],
            standardised: f64::NAN,
            trust: f64::NAN,
            outlier: f64::NAN,
        },
    })
}

/// The mean of what is left of every marker and its eight nearest neighbours in mm, which noise alone would make a third of its own
/// size; NaN where a marker has no place on the mesh.
pub fn misfits(frame: &Frame, estimate: &FieldEstimate) -> Vec<[f64; 2]> {
    const NEIGHBOURS: usize = 8;
    let pairs = frame.markers.iter().zip(&estimate.markers).enumerate();
    let known = pairs.filter_map(|(index, (marker, left))| {
        left.filter(|left| !left.outlier)
            .map(|left| (index, marker.place, left.residual))
    });
    let known: Vec<_> = known.collect();
    let places: Vec<[f64; 2]> = known.iter().map(|(_, place, _)| *place).collect();
    let mut all = vec![[f64::NAN; 2]; frame.markers.len()];
    for (own, others) in nearest(&places, NEIGHBOURS).into_iter().enumerate() {
        let members = others.iter().chain([&own]);
        let sum = members.fold([0.0; 2], |sum, one| {
            let residual = known[*one].2;
            [sum[0] + residual[0], sum[1] + residual[1]]
        });
        all[known[own].0] = sum.map(|sum| sum / (others.len() + 1) as f64);
    }
    all
}
