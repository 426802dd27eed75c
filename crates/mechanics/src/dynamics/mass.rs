//! The lumped mass of a sheet.

use crate::mesh::{GAUSS_5, Mesh};

/// The mass of each unknown in tonne: that of its node, density × thickness × tributary area.
///
/// ```text
/// mₐ = m_cell ∫ Nₐ² dA / Σ_b ∫ N_b² dA                                              [tonne]
/// ```
///
/// The diagonal of the consistent mass, scaled to the mass of the cell (Hinton, Rock and Zienkiewicz): positive on
/// every cell shape; a quarter of a parallelogram's mass on each of four nodes, Simpson's weights on nine.
///
/// `density` is in tonne/mm³, `thickness` in mm.
///
/// # References
/// E. Hinton, T. Rock, O. C. Zienkiewicz, Earthq. Eng. Struct. Dyn. 4, 245 (1976), doi:10.1002/eqe.4290040305
pub fn lumped_mass(mesh: &Mesh, density: f64, thickness: f64) -> Vec<f64> {
    let mut mass = vec![0.0; 2 * mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        let shape = mesh.shape(cell);
        let mut squares = vec![0.0; shape.nodes()];
        let mut area = 0.0;
        for (local, weight) in shape.product_quadrature(&GAUSS_5) {
            let (_, jacobian) = mesh.gradients(cell, local);
            area += weight * jacobian;
            for (square, value) in squares.iter_mut().zip(shape.values(local)) {
                *square += weight * jacobian * value * value;
            }
        }
        let scale = density * thickness * area / squares.iter().sum::<f64>();
        for (node, square) in mesh.cell(cell).iter().zip(squares) {
            mass[2 * node] += scale * square;
            mass[2 * node + 1] += scale * square;
        }
    }
    mass
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::CellShape;

    #[test]
    fn the_mass_of_a_plate_is_shared_by_tributary_areas() {
        let of = |shape| {
            let mesh = Mesh::plate([6.0, 4.0], [3, 2], shape);
            (lumped_mass(&mesh, 2.0, 0.5), mesh)
        };
        for (shape, corner) in [(CellShape::Quad4, 1.0), (CellShape::Quad9, 4.0 / 36.0)] {
            let (mass, mesh) = of(shape);
            let total: f64 = mass.iter().step_by(2).sum();
            assert!((total - 24.0).abs() < 1e-12, "{shape:?}: {total}");
            let at = |x: f64, y: f64| mesh.nodes.iter().position(|node| *node == [x, y]).unwrap();
            assert!((mass[2 * at(0.0, 0.0)] - corner).abs() < 1e-12);
            assert!((mass[2 * at(2.0, 2.0) + 1] - 4.0 * corner).abs() < 1e-12);
        }
    }

    #[test]
    fn every_cell_shape_has_positive_masses() {
        let nodes = [[0.0, 0.0], [2.0, 0.0], [0.5, 1.5]];
        let middle = |a: usize, b: usize| [0, 1].map(|i| 0.5 * (nodes[a][i] + nodes[b][i]));
        let mut all = nodes.to_vec();
        all.extend([middle(0, 1), middle(1, 2), middle(2, 0)]);
        let mesh = Mesh::new(all, [(CellShape::Triangle6, (0..6).collect())]);
        let mass = lumped_mass(&mesh, 1.0, 1.0);
        // The consistent diagonal of a straight triangle: 1/30 and 8/45 of its mass.
        assert!((mass[0] - 1.5 / 19.0).abs() < 1e-12, "{mass:?}");
        assert!((mass[10] - 1.5 * 16.0 / 57.0).abs() < 1e-12, "{mass:?}");
    }
}
