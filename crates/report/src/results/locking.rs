//! Cells that lock: far too stiff where a sheet can hardly change its area.
//!
//! # Reference
//! J. C. Nagtegaal, D. M. Parks, J. R. Rice, Comput. Methods Appl. Mech. Eng. 4, 153 (1974), doi:10.1016/0045-7825(74)90032-2

use crate::material::HyperelasticLaw;
use crate::material::stability::in_plane_poisson_ratio;
use crate::mesh::{CellShape, Mesh};

/// ν in the plane, 1 for an area that cannot change, beyond which cells of the first degree are too stiff: in plane strain that of
/// ν = 0.45. A strip with a hole on 24 bilinear cells across is 0.6 % too stiff there, 2 % at ν = 0.49; on 12 cells 2, 5 and, at
/// ν = 0.4999, 110 %.
const NEARLY_CONSTANT: f64 = 0.8;

/// Whether a mesh has cells of the first degree that lock: four triangles around a node where two straight lines
/// cross do not, because one of their four conditions of constant area follows from the others.
pub fn locks(mesh: &Mesh) -> bool {
    let mut around = vec![0; mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        mesh.cell(cell).iter().for_each(|node| around[*node] += 1);
    }
    let mut on_boundary = vec![false; mesh.nodes.len()];
    for node in mesh.boundary().iter().flatten() {
        on_boundary[*node] = true;
    }
    let is_crossing = |node: &usize| around[*node] == 4 && !on_boundary[*node];
    let (mut triangles, mut crossed) = (0, 0);
    for cell in 0..mesh.cell_count() {
        match mesh.shape(cell) {
            CellShape::Quad4 => return true,
            CellShape::Triangle3 => {
                triangles += 1;
                crossed += usize::from(mesh.cell(cell).iter().any(is_crossing));
            }
            CellShape::Triangle6 | CellShape::Quad8 | CellShape::Quad9 => (),
        }
    }
    // Along the boundary some have none even where all others do.
    2 * crossed < triangles
}

/// The remedy for finite elements that lock.
pub const SECOND_DEGREE: &str = "Take finite elements of the second degree (`element = \"Q2\"`)";

/// The reason of locking for a sheet that can hardly change its area; `None` for others.
pub fn reason(law: &dyn HyperelasticLaw) -> Option<String> {
    law.bulk_modulus()?;
    let nu = in_plane_poisson_ratio(law);
    (nu > NEARLY_CONSTANT).then(|| {
        format!(
            "the sheet is nearly incompressible in its plane (ν = {nu:.4} there), and cells of the first degree lock"
        )
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::material::volume::bulk_modulus;
    use crate::material::{NeoHooke, PlaneState, Volume, VolumeEnergy};
    use crate::mesh::{Outline, Shape};

    #[test]
    fn quadrilaterals_of_the_first_degree_lock_and_crossed_triangles_do_not() {
        let strip = Shape::Strip { size: [40.0, 20.0] };
        for (shape, expected) in [
            (CellShape::Quad4, true),
            (CellShape::Triangle3, false),
            (CellShape::Quad9, false),
            (CellShape::Triangle6, false),
        ] {
            assert_eq!(locks(&strip.mesh(6, shape)), expected, "{shape:?}");
        }
        let rectangle = vec![[0.0, 0.0], [40.0, 0.0], [40.0, 20.0], [0.0, 20.0]];
        let scattered = Outline::of_lines(vec![rectangle]);
        assert!(locks(&scattered.unwrap().mesh(3.0, CellShape::Triangle3)));
    }

    #[test]
    fn only_sheets_that_hardly_change_their_area_are_told() {
        let locks = |plane, poisson| {
            let law = Arc::new(NeoHooke { c10: 0.05 });
            let volume = Volume {
                bulk_modulus: bulk_modulus(0.1, poisson),
                energy: VolumeEnergy::default(),
                plane,
            };
            let law = law.with_volume(volume).unwrap();
            reason(&*law).is_some()
        };
        assert!(locks(PlaneState::Strain, 0.49));
        assert!(!locks(PlaneState::Strain, 0.4));
        assert!(!locks(PlaneState::Stress, 0.4999));
    }
}
