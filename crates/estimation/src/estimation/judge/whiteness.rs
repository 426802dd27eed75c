//! Whether the markers' residuals are white noise: Moran's I over neighbours.
//!
//! ```text
//! I = Σᵢⱼ wᵢⱼ zᵢ zⱼ / Σᵢ zᵢ² · N/S₀,   wᵢⱼ = 1/4 for the four nearest neighbours j of marker i, S₀ = Σ wᵢⱼ
//! E[I] = −Σᵢⱼ wᵢⱼ Bᵢⱼ/(N − tr B) · N/S₀,   B = 2H − H²,   H = Ã M⁻¹ Ãᵀ,   Ã = √(W/v) A
//! Var[I] = (N² S₁ − N S₂ + 3 S₀²)/((N² − 1) S₀²) − 1/(N − 1)²
//! S₁ = ½ Σᵢⱼ (wᵢⱼ + wⱼᵢ)²,   S₂ = Σᵢ (Σⱼ wᵢⱼ + Σⱼ wⱼᵢ)²
//! ```
//!
//! z are residuals over the noise, x beside x and y beside y, N of them; those of markers without trust and of outliers are left
//! out. (I − H)² is the covariance of what a fit leaves of white noise, so that E[I] is a little below zero.
//!
//! # References
//! P. A. P. Moran, Biometrika 37, 17 (1950), doi:10.1093/biomet/37.1-2.17;
//! A. D. Cliff, J. K. Ord, Spatial Processes (1981), chapter 8 (residuals of a regression)

use super::rows::Rows;
use crate::estimation::outcome::{VariogramBin, Whiteness};
use crate::estimation::regression::MarkerRows;
use crate::estimation::search::NearestField;
use crate::estimation::uncertainty::MeshError;
use crate::statistics::{Sites, nearest};

/// Neighbours of a marker.
const NEIGHBOURS: usize = 4;

/// Numbers of markers and their neighbours.
type Pairs = Vec<[usize; 2]>;

impl NearestField<'_> {
    /// The correlation of what is left of neighbours; `None` where few markers are left, or what is left is no more than the
    /// mesh's own error and the rounding of numbers.
    pub fn whiteness(&self, sound: &[f64], own: Option<&MeshError>) -> Option<Whiteness> {
        let observations = self.equations.task.observations;
        let Rows {
            chosen: rows,
            sites,
            spacing,
            ..
        } = Rows::new(self, sound, own)?;
        let around = nearest(sites.places(), NEIGHBOURS).into_iter().enumerate();
        let pairs: Pairs = around
            .flat_map(|(i, others)| others.into_iter().map(move |j| [i, j]))
            .collect();
        let z = |index: usize, axis: usize| {
            let row = 2 * rows[index] + axis;
            (observations.weights[row] / self.variances.sound).sqrt() * self.fit.residual[row]
        };
        let moran = |axes: &[usize]| {
            let product = |[i, j]: &[usize; 2]| -> f64 {
                axes.iter().map(|axis| z(*i, *axis) * z(*j, *axis)).sum()
            };
            let squares =
                (0..rows.len()).flat_map(|i| axes.iter().map(move |axis| z(i, *axis).powi(2)));
            let whole: f64 = squares.sum();
            pairs.iter().map(product).sum::<f64>() / NEIGHBOURS as f64 / whole
        };
        Some(Whiteness {
            correlation: moran(&[0, 1]),
            of_components: [moran(&[0]), moran(&[1])],
            expected: self.expected(&rows, &pairs),
            deviation: deviation(rows.len(), &pairs),
            variogram: variogram(&sites, spacing, &z),
        })
    }

    /// E[I].
    fn expected(&self, rows: &[usize], pairs: &Pairs) -> f64 {
        let rows_of_markers = MarkerRows {
            design: &self.linear.design,
            weights: &self.equations.task.observations.weights,
            variances: &self.variances,
        };
        let scaled = rows_of_markers.scaled();
        let covariance = &self.fit.covariance;
        let twice = covariance * 2.0 - covariance * (scaled.tr_mul(&scaled)) * covariance;
        let spread = &scaled * twice;
        let entry = |i: usize, j: usize| spread.row(i).dot(&scaled.row(j));
        let both = |i: usize, j: usize| -> f64 {
            [0, 1]
                .iter()
                .map(|axis| entry(2 * rows[i] + axis, 2 * rows[j] + axis))
                .sum()
        };
        let trace: f64 = (0..rows.len()).map(|i| both(i, i)).sum();
        let product: f64 = pairs.iter().map(|[i, j]| both(*i, *j)).sum();
        -product / NEIGHBOURS as f64 / (2.0 * rows.len() as f64 - trace).max(1.0)
    }
}

/// γ(h) = ½ mean (zᵢ − zⱼ)² of pairs in classes of distance that are one spacing wide.
fn variogram(sites: &Sites, spacing: f64, z: &dyn Fn(usize, usize) -> f64) -> Vec<VariogramBin> {
    const CLASSES: usize = 12;
    const MOST: usize = 1500;
    let places = sites.places();
    let stride = places.len().div_ceil(MOST).max(1);
    let mut sums = [([0.0; 2], 0.0, 0); CLASSES];
    for i in (0..places.len()).step_by(stride) {
        for j in 0..places.len() {
            let [a, b] = [places[i], places[j]];
            let distance = (a[0] - b[0]).hypot(a[1] - b[1]);
            let class = (distance / spacing + 0.5) as usize;
            // Of places that are all looked at, each pair once.
            if class == 0 || class > CLASSES || (stride == 1 && j <= i) {
                continue;
            }
            let (squares, far, pairs) = &mut sums[class - 1];
            (0..2).for_each(|axis| squares[axis] += (z(i, axis) - z(j, axis)).powi(2));
            (*far, *pairs) = (*far + distance, *pairs + 1);
        }
    }
    let known = sums.iter().filter(|(.., pairs)| *pairs > 0);
    let bin = |(squares, far, pairs): &([f64; 2], f64, usize)| VariogramBin {
        distance: far / *pairs as f64,
        pairs: *pairs,
        of_components: squares.map(|square| 0.5 * square / *pairs as f64),
    };
    known.map(bin).collect()
}

/// √Var[I] of two components at so many places.
fn deviation(places: usize, pairs: &Pairs) -> f64 {
    let weight = 1.0 / NEIGHBOURS as f64;
    let mutual: std::collections::HashSet<&[usize; 2]> = pairs.iter().collect();
    // Both components have the same neighbours.
    let first: f64 = pairs
        .iter()
        .map(|[i, j]| {
            if mutual.contains(&[*j, *i]) {
                0.5 * (2.0 * weight).powi(2)
            } else {
                weight.powi(2)
            }
        })
        .sum::<f64>()
        * 2.0;
    let mut incoming = vec![1.0; places];
    pairs.iter().for_each(|[_, j]| incoming[*j] += weight);
    let second: f64 = 2.0 * incoming.iter().map(|sum| sum * sum).sum::<f64>();
    let (count, whole) = (2.0 * places as f64, 2.0 * places as f64);
    let square = (count * count * first - count * second + 3.0 * whole * whole)
        / ((count * count - 1.0) * whole * whole)
        - (count - 1.0).powi(-2);
    square.max(0.0).sqrt()
}
