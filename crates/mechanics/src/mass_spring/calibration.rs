//! Cross-sections of springs on a mesh of any shape.
//!
//! The springs of a cell together have the stiffness tensor
//!
//! ```text
//! C_ijkl = E/(A t) Σ a x₀ nᵢ nⱼ nₖ nₗ                                                     [MPa]
//! ```
//!
//! with a the cross-section, x₀ the length and n the direction of a spring, A the area of the cell. It is symmetric
//! in all indices (Cauchy's relations), so the nearest isotropic sheet has ν = ⅓: C₁₁₁₁ = C₂₂₂₂ = 9/8 E, C₁₁₂₂ =
//! C₁₂₁₂ = 3/8 E. The cross-sections of a cell approximate this tensor in the least-squares sense, with none below
//! zero, and among equally good ones are those nearest to Van Gelder's
//!
//! ```text
//! a = t A/x₀   for each edge of a triangle; quadrilaterals are halved along both diagonals   [mm²]
//! ```
//!
//! # References
//! A. Van Gelder, J. Graph. Tools 3(2), 21 (1998), doi:10.1080/10867651.1998.10487490

use nalgebra::{DMatrix, DVector};

use super::spring::{CrossSections, Spring};
use crate::mesh::Mesh;
use crate::mesh::geometry::{distance, polygon_area};
use crate::problem::CellLaws;

/// The springs of a mesh whose cells have laws: edges, and both diagonals of quadrilaterals.
pub fn springs(mesh: &Mesh, laws: &CellLaws, thickness: f64) -> Vec<Spring> {
    let mut all = CrossSections::default();
    for cell in 0..mesh.cell_count() {
        let corners = mesh.corners(cell);
        let positions: Vec<[f64; 2]> = corners.iter().map(|node| mesh.nodes[*node]).collect();
        let pairs = pairs(corners.len());
        let sections = sections(&positions, &pairs);
        for ([a, b], section) in pairs.iter().zip(sections) {
            let ends = [corners[*a], corners[*b]];
            all.add(ends, laws.number(cell), thickness * section);
        }
    }
    all.springs(&mesh.nodes)
}

/// All pairs of corners; a spring joins each pair.
fn pairs(corners: usize) -> Vec<[usize; 2]> {
    let all = (0..corners).flat_map(|b| (0..b).map(move |a| [a, b]));
    all.collect()
}

/// Cross-sections over the thickness of the springs of one cell, in mm.
fn sections(corners: &[[f64; 2]], pairs: &[[usize; 2]]) -> Vec<f64> {
    let area = polygon_area(corners);
    let vector = |[a, b]: &[usize; 2]| [0, 1].map(|axis| corners[*b][axis] - corners[*a][axis]);
    // Components 1111, 1112, 1122, 1222, 2222, with the square roots of their multiplicities in the tensor.
    let often = [1.0, 2.0, 6.0_f64.sqrt(), 2.0, 1.0];
    let target = [9.0 / 8.0, 0.0, 3.0 / 8.0, 0.0, 9.0 / 8.0];
    let column = |pair: &[usize; 2]| {
        let [x, y] = vector(pair);
        let length = x.hypot(y);
        let (c, s) = (x / length, y / length);
        let powers = [
            c.powi(4),
            c.powi(3) * s,
            c * c * s * s,
            c * s.powi(3),
            s.powi(4),
        ];
        (0..5).map(move |i| often[i] * powers[i] * length / area)
    };
    let matrix = DMatrix::from_iterator(5, pairs.len(), pairs.iter().flat_map(column));
    let target = DVector::from_fn(5, |i, _| often[i] * target[i]);
    let start = van_gelder(corners, pairs);
    let mut free: Vec<usize> = (0..pairs.len()).collect();
    loop {
        // The smallest change of Van Gelder's sections that comes nearest to the target.
        let columns = matrix.select_columns(&free);
        let before = DVector::from_iterator(free.len(), free.iter().map(|i| start[*i]));
        let missing = &target - &columns * &before;
        let Ok(change) = columns.svd(true, true).solve(&missing, 1e-10) else {
            return start;
        };
        let solution = before + change;
        let mut sections = vec![0.0; pairs.len()];
        for (index, section) in free.iter().zip(solution.iter()) {
            sections[*index] = *section;
        }
        let most = sections.iter().copied().fold(0.0, f64::max);
        let count = free.len();
        free.retain(|i| sections[*i] >= -1e-12 * most);
        if free.len() == count {
            return sections
                .into_iter()
                .map(|section| section.max(0.0))
                .collect();
        }
    }
}

/// Van Gelder's sections over the thickness, in mm.
fn van_gelder(corners: &[[f64; 2]], pairs: &[[usize; 2]]) -> Vec<f64> {
    let triangles: &[([usize; 3], f64)] = match corners.len() {
        3 => &[([0, 1, 2], 1.0)],
        _ => &[
            ([0, 1, 2], 0.5),
            ([0, 2, 3], 0.5),
            ([0, 1, 3], 0.5),
            ([1, 2, 3], 0.5),
        ],
    };
    let section = |pair: &[usize; 2]| -> f64 {
        let [from, to] = pair.map(|corner| corners[corner]);
        let length = distance(from, to);
        let adjacent = triangles
            .iter()
            .filter(|(triangle, _)| pair.iter().all(|c| triangle.contains(c)));
        let shares = adjacent
            .map(|(triangle, share)| share * polygon_area(&triangle.map(|corner| corners[corner])));
        shares.sum::<f64>() / length
    };
    pairs.iter().map(section).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::material::NeoHooke;
    use crate::mesh::CellShape;

    fn one_law() -> CellLaws {
        Arc::new(NeoHooke { c10: 0.05 }).into()
    }

    /// C of a mesh of E = 1 MPa and t = 1 mm: components 1111, 1122, 2222, 1112.
    fn tensor(mesh: &Mesh, area: f64) -> [f64; 4] {
        let mut sums = [0.0; 4];
        for spring in springs(mesh, &one_law(), 1.0) {
            let [from, to] = spring.nodes.map(|node| mesh.nodes[node]);
            let n = [0, 1].map(|axis| (to[axis] - from[axis]) / spring.rest_length);
            let weight = spring.area * spring.rest_length / area;
            let parts = [
                n[0].powi(4),
                (n[0] * n[1]).powi(2),
                n[1].powi(4),
                n[0].powi(3) * n[1],
            ];
            for (sum, part) in sums.iter_mut().zip(parts) {
                *sum += weight * part;
            }
        }
        sums
    }

    #[test]
    fn quadrilaterals_have_the_tensor_of_the_sheet() {
        for cells in [[6, 6], [6, 4], [8, 6]] {
            let mesh = Mesh::plate([6.0, 6.0], cells, CellShape::Quad4);
            let computed = tensor(&mesh, 36.0);
            for (computed, expected) in computed.iter().zip([9.0 / 8.0, 3.0 / 8.0, 9.0 / 8.0, 0.0])
            {
                assert!((computed - expected).abs() < 1e-12, "{cells:?}: {computed}");
            }
        }
    }

    /// As the guide states: C₁₁₂₂ = C₁₂₁₂ is 3/7 of the sheet's, and C₁₁₁₁ − C₁₁₂₂²/C₁₁₁₁ = 1.10 E.
    #[test]
    fn halved_squares_are_too_stiff_in_tension_and_too_soft_in_shear() {
        let mesh = Mesh::plate([6.0, 6.0], [6, 6], CellShape::Quad4).triangulated();
        let computed = tensor(&mesh, 36.0);
        for (computed, expected) in computed.iter().zip([9.0 / 8.0, 9.0 / 56.0, 9.0 / 8.0]) {
            assert!((computed - expected).abs() < 1e-12, "{computed}");
        }
    }

    #[test]
    fn equilateral_triangles_have_it_too_and_no_section_is_negative() {
        let h = 3.0_f64.sqrt() / 2.0;
        let nodes = vec![[0.0, 0.0], [1.0, 0.0], [0.5, h], [4.0, 0.1]];
        let mesh = Mesh::new(nodes.clone(), [(CellShape::Triangle3, vec![0, 1, 2])]);
        let computed = tensor(&mesh, 0.5 * h);
        assert!((computed[0] - 9.0 / 8.0).abs() < 1e-12 && (computed[1] - 3.0 / 8.0).abs() < 1e-12);
        let slender = Mesh::new(nodes, [(CellShape::Triangle3, vec![0, 3, 2])]);
        assert!(
            springs(&slender, &one_law(), 1.0)
                .iter()
                .all(|spring| spring.area >= 0.0)
        );
    }
}
