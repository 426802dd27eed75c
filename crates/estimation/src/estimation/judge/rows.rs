//! The rows of sound markers in the last regression, over the noise.

use nalgebra::DMatrix;

use crate::estimation::regression::{Fit, VarianceComponents, squares};
use crate::estimation::search::{MESH_ERROR_FACTOR, MeshError, NearestField};
use crate::statistics::{Sites, chi_squared_limit, extremes, nearest};

/// The least number of markers whose residuals can show a correlation.
const FEWEST: usize = 30;

/// Rows of sound markers: trusted by at least one half, and not outliers.
pub struct Rows {
    /// Numbers of the markers among those on the mesh.
    pub chosen: Vec<usize>,
    /// Their positions.
    pub sites: Sites,
    /// 1/√(s²/(w ω) + e²) of each component of each marker: s the noise's standard deviation, e the discretisation error there, a common factor
    /// of which is also an admitted change.
    scales: Vec<f64>,
    /// Difference of the largest and the smallest coordinates, in mm.
    pub extent: [f64; 2],
    /// √(area of the box over the number of markers), in mm.
    pub spacing: f64,
}

impl Rows {
    /// The rows; `None` where there are few, or where the residuals are no more than the discretisation error and the rounding of numbers.
    pub fn new(
        nearest_field: &NearestField,
        sound: &[f64],
        mesh_error: Option<&MeshError>,
    ) -> Option<Self> {
        let observations = nearest_field.observations();
        let count = observations.positions.len();
        let mut chosen: Vec<usize> = (0..count).filter(|row| sound[*row] > 0.0).collect();
        // Where most markers are outliers, sound ones cannot be distinguished.
        if 2 * chosen.len() < count {
            chosen = (0..count).collect();
        }
        if chosen.len() < FEWEST || leaves_nothing(nearest_field, &chosen, mesh_error) {
            return None;
        }
        let scale = |marker: &usize| {
            let trust = if sound[*marker] > 0.0 {
                sound[*marker]
            } else {
                1.0
            };
            [0, 1].map(|axis| {
                let row = 2 * marker + axis;
                let mesh = mesh_error.map_or(0.0, |error| error.markers[row]);
                let weight = observations.weights[row] * trust / nearest_field.variances.sound;
                weight.sqrt().recip().hypot(mesh).recip()
            })
        };
        let scales: Vec<f64> = chosen.iter().flat_map(scale).collect();
        let positions: Vec<[f64; 2]> = chosen
            .iter()
            .map(|row| observations.positions[*row])
            .collect();
        let extent = [0, 1].map(|axis| {
            let [low, high] = extremes(positions.iter().map(|position| position[axis]));
            (high - low).max(f64::MIN_POSITIVE)
        });
        Some(Self {
            sites: Sites::new(positions),
            spacing: (extent[0] * extent[1] / chosen.len() as f64).sqrt(),
            extent,
            chosen,
            scales,
        })
    }

    /// The indices and the positions of at most some thousands of the sound markers, in clusters that show short and long distances alike.
    pub fn clusters(&self) -> (Vec<usize>, Sites) {
        const MOST: usize = 3000;
        const TOGETHER: usize = 30;
        let positions = self.sites.positions();
        if positions.len() <= MOST {
            return ((0..positions.len()).collect(), self.sites.clone());
        }
        let around = nearest(positions, TOGETHER - 1);
        let first = (0..positions.len()).step_by(positions.len() * TOGETHER / MOST);
        let mut chosen: Vec<usize> = first
            .flat_map(|index| around[index].iter().copied().chain([index]))
            .collect();
        chosen.sort_unstable();
        chosen.dedup();
        let sites = Sites::new(chosen.iter().map(|index| positions[*index]).collect());
        (chosen, sites)
    }

    /// Rows of these markers out of a matrix with two rows for each marker on the mesh, over the noise.
    pub fn scaled(&self, design: DMatrix<f64>) -> DMatrix<f64> {
        let (before, columns) = design.shape();
        let rows = 2 * self.chosen.len();
        let mut values: Vec<f64> = design.data.into();
        // In ascending order no value is written over before it is read.
        for column in 0..columns {
            for (row, scale) in self.scales.iter().enumerate() {
                let source = column * before + 2 * self.chosen[row / 2] + row % 2;
                values[column * rows + row] = scale * values[source];
            }
        }
        values.truncate(rows * columns);
        DMatrix::from_vec(rows, columns, values)
    }
}

/// The trust of every marker on the mesh in a fit; zero for markers that are trusted by less than one half, or off by
/// more than normal noise would be in one of a thousand.
///
/// For a fit with released edges it distinguishes gross errors from markers that a wrong condition leaves far off.
pub fn soundness(weights: &[f64], fit: &Fit, variances: &VarianceComponents) -> Vec<f64> {
    const TRUSTED: f64 = 0.5;
    const FALSE_ALARMS: f64 = 1e-3;
    let limit = chi_squared_limit(2.0, FALSE_ALARMS);
    let rows = squares(&fit.residual, weights).zip(&variances.trust);
    let trust = |(square, trust): (f64, &f64)| {
        if *trust >= TRUSTED && square / variances.sound <= limit {
            *trust
        } else {
            0.0
        }
    };
    rows.map(trust).collect()
}

/// Whether the residuals are no more than twice the discretisation error, or a millionth of the displacement.
fn leaves_nothing(
    nearest_field: &NearestField,
    rows: &[usize],
    mesh_error: Option<&MeshError>,
) -> bool {
    const ROUNDING: f64 = 1e-6;
    let sum = |values: &dyn Fn(usize) -> f64| -> f64 {
        let entries = rows.iter().flat_map(|row| [2 * row, 2 * row + 1]);
        entries.map(|entry| values(entry).powi(2)).sum()
    };
    let observations = nearest_field.observations();
    let residual = sum(&|entry| nearest_field.fit.residual[entry]);
    let moved = sum(&|entry| observations.displacements[entry / 2][entry % 2]);
    let mesh = mesh_error.map_or(0.0, |mesh_error| sum(&|entry| mesh_error.markers[entry]));
    residual <= (MESH_ERROR_FACTOR.powi(2) * mesh).max(ROUNDING * ROUNDING * moved)
}
