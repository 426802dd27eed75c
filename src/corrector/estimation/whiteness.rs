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

use std::collections::HashMap;

use nalgebra::DMatrix;

use super::field_estimate::{MarkerEstimate, Whiteness};
use super::mesh_error::MeshError;
use super::search::NearestField;

/// Neighbours of a marker.
const NEIGHBOURS: usize = 4;

/// Numbers of markers and their neighbours.
type Pairs = Vec<[usize; 2]>;

impl NearestField<'_> {
    /// The correlation of what is left of neighbours; `None` where few markers are left, or what is left is no more than the
    /// mesh's own error and the rounding of numbers.
    pub fn whiteness(
        &self,
        markers: &[Option<MarkerEstimate>],
        own: Option<&MeshError>,
    ) -> Option<Whiteness> {
        const FEWEST: usize = 30;
        const TRUSTED: f64 = 0.5;
        let observations = self.equations.task.observations;
        let sound = |row: &usize| {
            let outlier = markers[observations.chosen[*row]].is_some_and(|marker| marker.outlier);
            self.trade.trust[*row] >= TRUSTED && !outlier
        };
        let rows: Vec<usize> = (0..observations.places.len()).filter(sound).collect();
        if rows.len() < FEWEST || self.leaves_nothing(&rows, own) {
            return None;
        }
        let places: Vec<[f64; 2]> = rows.iter().map(|row| observations.places[*row]).collect();
        let pairs = neighbours(&places);
        let scale = |row: usize| (observations.weights[row] / self.trade.sound).sqrt();
        let z = |index: usize, axis: usize| {
            scale(rows[index]) * self.fit.residual[2 * rows[index] + axis]
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
        })
    }

    /// Whether what is left is no more than twice the mesh's own error, or a millionth of the displacement.
    fn leaves_nothing(&self, rows: &[usize], own: Option<&MeshError>) -> bool {
        const ROUNDING: f64 = 1e-6;
        let sum = |values: &dyn Fn(usize) -> f64| -> f64 {
            let entries = rows.iter().flat_map(|row| [2 * row, 2 * row + 1]);
            entries.map(|entry| values(entry).powi(2)).sum()
        };
        let observations = self.equations.task.observations;
        let left = sum(&|entry| self.fit.residual[entry]);
        let moved = sum(&|entry| observations.displacements[entry / 2][entry % 2]);
        let mesh = own.map_or(0.0, |own| sum(&|entry| own.markers[entry]));
        left <= (4.0 * mesh).max(ROUNDING * ROUNDING * moved)
    }

    /// E[I].
    fn expected(&self, rows: &[usize], pairs: &Pairs) -> f64 {
        let weights = &self.equations.task.observations.weights;
        let scale = |row: usize| {
            (weights[row / 2] * self.trade.trust[row / 2] / self.trade.variance).sqrt()
        };
        let design = &self.linear.design;
        let scaled = DMatrix::from_fn(design.nrows(), design.ncols(), |row, column| {
            scale(row) * design[(row, column)]
        });
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

/// √Var[I] of two components at so many places.
fn deviation(places: usize, pairs: &Pairs) -> f64 {
    let weight = 1.0 / NEIGHBOURS as f64;
    let mutual: std::collections::HashSet<&[usize; 2]> = pairs.iter().collect();
    // Both components have the same neighbours.
    let first: f64 = pairs
        .iter()
        .map(|[i, j]| match mutual.contains(&[*j, *i]) {
            true => 0.5 * (2.0 * weight).powi(2),
            // The pair (j, i) has the same sum.
            false => weight.powi(2),
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

/// Each place with its nearest neighbours.
fn neighbours(places: &[[f64; 2]]) -> Pairs {
    let ends = places.iter().fold(
        [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
        |[low, high], p| {
            [
                [low[0].min(p[0]), low[1].min(p[1])],
                [high[0].max(p[0]), high[1].max(p[1])],
            ]
        },
    );
    let area = (ends[1][0] - ends[0][0]).max(1e-300) * (ends[1][1] - ends[0][1]).max(1e-300);
    let side = 2.0 * (area / places.len() as f64).sqrt();
    let square = |p: [f64; 2]| [0, 1].map(|axis| ((p[axis] - ends[0][axis]) / side) as i64);
    let mut squares: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (index, place) in places.iter().enumerate() {
        squares.entry(square(*place)).or_default().push(index);
    }
    let distance =
        |i: usize, j: usize| (places[i][0] - places[j][0]).hypot(places[i][1] - places[j][1]);
    let near = |i: usize, reach: i64| {
        let [x, y] = square(places[i]);
        let around =
            (-reach..=reach).flat_map(|dx| (-reach..=reach).map(move |dy| [x + dx, y + dy]));
        let others = around.filter_map(|key| squares.get(&key)).flatten();
        let mut others: Vec<(f64, usize)> = others
            .filter(|j| **j != i)
            .map(|j| (distance(i, *j), *j))
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        others
    };
    let mut pairs = Vec::with_capacity(NEIGHBOURS * places.len());
    for i in 0..places.len() {
        let mut reach = 1;
        let mut found = near(i, reach);
        // Beyond the squares that were looked at there may be nearer ones.
        while found.len() < NEIGHBOURS || found[NEIGHBOURS - 1].0 > reach as f64 * side {
            reach *= 2;
            found = near(i, reach);
            if found.len() + 1 == places.len() {
                break;
            }
        }
        pairs.extend(found.iter().take(NEIGHBOURS).map(|(_, j)| [i, *j]));
    }
    pairs
}
