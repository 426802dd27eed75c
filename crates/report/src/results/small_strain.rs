//! Fields outside of the range of a law for small strains.

use nalgebra::Matrix2;

use super::BESIDE_CORNERS;
use crate::material::HyperelasticLaw;
use crate::mesh::Mesh;

/// Strains and rotations in rad up to which linear elasticity is accepted: its stresses are wrong by some times the
/// strain, and by the square of the rotation.
const SMALL: [f64; 2] = [0.05, 0.1];

/// The strain |λ − 1| and the rotation in rad that a small share of some cells exceeds, by their centres.
fn extremes((mesh, cells): (&Mesh, &[usize]), displacement: &[f64]) -> [f64; 2] {
    let (mut strains, mut rotations) = (Vec::new(), Vec::new());
    for cell in cells.iter().copied() {
        let [xx, xy, yx, yy] = mesh.gradient_at(displacement, cell, mesh.shape(cell).centre());
        let stretches = Matrix2::new(1.0 + xx, xy, yx, 1.0 + yy).singular_values();
        let area = mesh.cell_area(cell);
        strains.push((area, (stretches.max() - 1.0).max(1.0 - stretches.min())));
        rotations.push((area, (yx - xy).atan2(2.0 + xx + yy).abs()));
    }
    [strains, rotations].map(exceeded_by_some)
}

/// The largest value that more than a small share of the area reaches.
fn exceeded_by_some(mut values: Vec<(f64, f64)>) -> f64 {
    values.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut remaining: f64 = BESIDE_CORNERS * values.iter().map(|(area, _)| area).sum::<f64>();
    let reached = values.iter().find(|(area, _)| {
        remaining -= area;
        remaining < 0.0
    });
    reached.map_or(0.0, |(_, value)| *value)
}

/// The reason why a field is in some cells of a mesh outside of the range of a law for small strains and rotations; `None` for other laws.
pub fn reason(
    law: &dyn HyperelasticLaw,
    cells: (&Mesh, &[usize]),
    displacement: &[f64],
) -> Option<String> {
    if !law.is_for_small_strains() {
        return None;
    }
    let [strain, rotation] = extremes(cells, displacement);
    (strain > SMALL[0] || rotation > SMALL[1]).then(|| {
        format!(
            "linear elasticity assumes strains and rotations that are small compared with 1, and here they reach {:.0} % and {:.0}°",
            100.0 * strain,
            rotation.to_degrees()
        )
    })
}

/// The remedy.
pub const LARGE_STRAINS: &str = "Take a law for large strains, such as `neo-hooke` with `[volume]`";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{LinearElastic, NeoHooke, PlaneState};
    use crate::mesh::CellShape;
    use crate::results::displacements;

    fn reason(law: &dyn HyperelasticLaw, mesh: &Mesh, displacement: &[f64]) -> Option<String> {
        let cells: Vec<usize> = (0..mesh.cell_count()).collect();
        super::reason(law, (mesh, &cells), displacement)
    }

    #[test]
    fn large_strains_and_large_rotations_are_told_of_linear_elasticity_alone() {
        let mesh = Mesh::plate([4.0, 1.0], [4, 2], CellShape::Quad4);
        let linear = LinearElastic {
            shear_modulus: 0.05,
            lame_modulus: 0.1,
            plane: PlaneState::Stress,
        };
        let turned = |angle: f64| {
            let (sine, cosine) = angle.sin_cos();
            displacements(&mesh, |[x, y]| {
                [(cosine - 1.0) * x - sine * y, sine * x + (cosine - 1.0) * y]
            })
        };
        let pulled = |strain: f64| displacements(&mesh, |[x, _]| [strain * x, 0.0]);
        assert_eq!(reason(&linear, &mesh, &pulled(0.04)), None);
        assert_eq!(reason(&linear, &mesh, &turned(-0.09)), None);
        let message = reason(&linear, &mesh, &pulled(0.4)).unwrap();
        assert!(message.ends_with("40 % and 0°"), "{message}");
        let message = reason(&linear, &mesh, &turned(-0.35)).unwrap();
        assert!(message.ends_with("0 % and 20°"), "{message}");
        // One cell of two hundred is not the sheet.
        let fine = Mesh::plate([4.0, 1.0], [20, 10], CellShape::Quad4);
        let mut spot = vec![0.0; 2 * fine.nodes.len()];
        spot[0] = -0.2;
        assert_eq!(reason(&linear, &fine, &spot), None);
        assert_eq!(reason(&NeoHooke { c10: 0.05 }, &mesh, &pulled(0.4)), None);
    }
}
