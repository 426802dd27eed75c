//! Where a sheet is under compression, which it cannot bear: it would wrinkle or buckle out of its plane.

use super::state::{LocalState, cell_states};
use crate::material::{HyperelasticLaw, PlaneState};
use crate::mesh::Mesh;

/// Compression below this share of the sheet's mean stress is not counted. The largest stress would be no measure: at a
/// clamped corner it grows with every refinement.
const NEGLIGIBLE: f64 = 1e-3;

/// Stresses below this share of E₀ are what rounding leaves.
const ROUNDING: f64 = 1e-10;

/// The compression of a sheet, cell by cell, at the centres of the cells.
#[derive(Clone, Debug)]
pub struct Wrinkling {
    /// The smaller principal Cauchy stress in the plane in MPa.
    pub smallest: Vec<f64>,
    /// Whether a cell of a thin sheet is under compression; never in plane strain.
    pub compressed: Vec<bool>,
    /// The share of the reference area under compression in %.
    pub area_percent: f64,
}

impl Wrinkling {
    /// The compression of a displacement field.
    pub fn new(law: &dyn HyperelasticLaw, mesh: &Mesh, displacement: &[f64]) -> Self {
        Self::of_cells(law, mesh, &cell_states(law, mesh, &[displacement], &[]))
    }

    /// The compression of the states in the cells; a cell that is folded at its centre has no stress and no say.
    pub fn of_cells(law: &dyn HyperelasticLaw, mesh: &Mesh, states: &[LocalState]) -> Self {
        let stresses: Vec<[f64; 2]> = states.iter().map(LocalState::principal_cauchy).collect();
        let areas: Vec<f64> = (0..mesh.cell_count())
            .map(|cell| mesh.cell_area(cell))
            .collect();
        let all: f64 = areas.iter().sum();
        let pairs = stresses.iter().zip(&areas);
        let loaded: f64 = pairs
            .filter(|([larger, _], _)| !larger.is_nan())
            .map(|([larger, smaller], area)| area * larger.abs().max(smaller.abs()))
            .sum();
        let smallest: Vec<f64> = stresses.iter().map(|[_, smaller]| *smaller).collect();
        let rounding = ROUNDING * law.youngs_modulus();
        let limit = -(NEGLIGIBLE * loaded / all).max(rounding);
        let is_thin = law.plane_state() == PlaneState::Stress;
        let compressed = smallest.iter().map(|stress| is_thin && *stress < limit);
        let compressed: Vec<bool> = compressed.collect();
        let under = areas.iter().zip(&compressed);
        let under: f64 = under
            .filter_map(|(area, compressed)| compressed.then_some(area))
            .sum();
        Self {
            smallest,
            compressed,
            area_percent: 100.0 * under / all,
        }
    }
}

/// The warning about the states of a model, each at a load that is named; nothing without compression.
pub fn warning<'a>(
    law: &dyn HyperelasticLaw,
    mesh: &Mesh,
    states: impl Iterator<Item = (String, &'a [f64])>,
) -> Option<String> {
    let shares = states.map(|(load, u)| (Wrinkling::new(law, mesh, u).area_percent, load));
    let told: Vec<String> = shares
        .filter(|(percent, _)| *percent > 0.0)
        .map(|(percent, load)| format!("{percent:.1} % at {load}"))
        .collect();
    (!told.is_empty()).then(|| of_parts(&format!("{} of the area", told.join(", "))))
}

/// The warning about parts of a sheet, such as `7.9 % at 30 % stretch of the area`.
pub fn of_parts(parts: &str) -> String {
    format!(
        "part of the sheet is under compression, where a thin sheet would wrinkle and lose stress that the plane solution still carries: {parts} \
         (array `wrinkling` of the finite elements' VTK files)."
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::NeoHooke;
    use crate::mesh::CellShape;

    /// The share and the stresses of a plate of 4 × 1 mm with a displacement field.
    fn of(field: impl Fn([f64; 2]) -> [f64; 2]) -> Wrinkling {
        let mesh = Mesh::plate([4.0, 1.0], [8, 8], CellShape::Quad9);
        let u: Vec<f64> = mesh.nodes.iter().flat_map(|node| field(*node)).collect();
        Wrinkling::new(&NeoHooke { c10: 0.05 }, &mesh, &u)
    }

    #[test]
    fn tension_has_no_compression_and_bending_has_it_on_one_side() {
        let contraction = 1.2_f64.powf(-0.5) - 1.0;
        let pulled = of(|[x, y]| [0.2 * x, contraction * y]);
        assert_eq!(pulled.area_percent, 0.0);
        assert!(pulled.smallest.iter().all(|stress| stress.abs() < 1e-12));
        let squeezed = of(|[x, _]| [-0.1 * x, 0.0]);
        assert!((squeezed.area_percent - 100.0).abs() < 1e-9);
        // σ₁ = 2 C₁₀ (λ² − λ⁻²) with the width kept.
        let expected = 0.1 * (0.81 - 1.0 / 0.81);
        assert!((squeezed.smallest[0] - expected).abs() < 1e-14);
        let bent = of(|[x, y]| [1e-4 * x * (y - 0.5), -0.5e-4 * x * x]);
        assert!(
            (bent.area_percent - 50.0).abs() < 1e-9,
            "{}",
            bent.area_percent
        );
    }

    #[test]
    fn a_rigid_motion_has_no_compression() {
        let (sine, cosine) = 0.3_f64.sin_cos();
        let turned = |[x, y]: [f64; 2]| {
            [
                3.0 + (cosine - 1.0) * x - sine * y,
                1.0 + sine * x + (cosine - 1.0) * y,
            ]
        };
        let found = of(turned);
        assert!(found.smallest.iter().any(|stress| *stress != 0.0));
        assert_eq!(found.area_percent, 0.0);
    }

    #[test]
    fn a_cell_that_is_folded_in_its_middle_has_no_stress_and_no_say() {
        let pulled = of(|[x, _]| [0.2 * x, 0.0]);
        let folded = of(|[x, y]| {
            let middle = (x - 4.0).abs() < 1e-9 && (y - 0.0625).abs() < 1e-9;
            [0.2 * x - if middle { 1.0 } else { 0.0 }, 0.0]
        });
        let cells = folded.smallest.iter().zip(&pulled.smallest);
        let other: Vec<f64> = cells.filter(|(a, b)| a != b).map(|(a, _)| *a).collect();
        assert!(
            matches!(other[..], [stress] if stress.is_nan()),
            "{other:?}"
        );
        assert_eq!(folded.area_percent, 0.0);
    }

    /// A thousandth of the mean stress is where compression begins to count.
    #[test]
    fn compression_counts_from_a_thousandth_of_the_mean_stress_on() {
        let (along, c10) = (1.2_f64, 0.05);
        for (share, counted) in [(0.5e-3, 0.0), (2e-3, 100.0)] {
            // σ₂ = −s σ₁ with σᵢ = 2 C₁₀ (λᵢ² − λ₃²), λ₁ λ₂ λ₃ = 1, is quadratic in λ₂².
            let [two, four] = [2, 4].map(|power| along.powi(power));
            let root = (share * share * four * four + 4.0 * two * (1.0 + share)).sqrt();
            let across = ((root - share * four) / (2.0 * two)).sqrt();
            let through = 1.0 / (along * across);
            let stress = |stretch: f64| 2.0 * c10 * (stretch * stretch - through * through);
            assert!((stress(across) + share * stress(along)).abs() < 1e-15);
            let found = of(|[x, y]| [(along - 1.0) * x, (across - 1.0) * y]);
            assert!((found.area_percent - counted).abs() < 1e-9, "{share}");
            assert!((found.smallest[3] - stress(across)).abs() < 1e-14);
        }
    }

    /// As at a singular corner, where the largest stress is that of the smallest cell.
    #[test]
    fn a_peak_of_the_stress_in_one_cell_hides_no_compression() {
        let squeezed = |[x, y]: [f64; 2]| {
            let middle = (x - 4.0).abs() < 1e-9 && (y - 0.0625).abs() < 1e-9;
            [0.2 * x + if middle { 2.0 } else { 0.0 }, -0.09 * y]
        };
        let found = of(squeezed);
        let largest = found
            .smallest
            .iter()
            .fold(0.0, |most: f64, s| most.max(s.abs()));
        assert!(
            found.area_percent > 95.0,
            "{} {largest}",
            found.area_percent
        );
    }
}
