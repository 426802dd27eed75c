//! Edges moved to their imposed displacements without inverting the adjacent cells.
//!
//! On a fine mesh an edge cannot move by more than the size of a cell at once. The inner nodes are then moved too, by the tangent,
//! Δu = −K⁻¹ K_B Δu_B, each move as large as leaves all cells admissible.

use crate::error::SolveFault;
use crate::solve::vector::moved;
use crate::solve::{Assembly, Newton, Potential};

/// The largest number of moves, and the shortest one.
const MOST_MOVES: usize = 40;
const SHORTEST: f64 = 1.0 / 256.0;

/// Gives the held unknowns of a field the values that they have in `wanted`.
///
/// # Errors
/// A [`SolveFault`] where even the shortest move inverts a cell, or the tangent cannot be factorised.
pub fn approach(
    newton: &mut Newton,
    potential: &dyn Potential,
    field: &mut Vec<f64>,
    wanted: &[f64],
    describe: &dyn Fn(usize) -> String,
) -> Result<(), SolveFault> {
    let mut held = vec![true; field.len()];
    for unknown in newton.free() {
        held[*unknown] = false;
    }
    let jump = |field: &[f64]| -> Vec<f64> {
        let pairs = field.iter().zip(wanted).zip(&held);
        pairs
            .map(|((u, wanted), held)| if *held { wanted - u } else { 0.0 })
            .collect()
    };
    let imposed = moved(field, 1.0, &jump(field));
    let mut residual = vec![0.0; field.len()];
    if Assembly::residual(potential, &imposed, &mut residual).is_ok() {
        *field = imposed;
        return Ok(());
    }
    for _ in 0..MOST_MOVES {
        let motion = jump(field);
        let inside = newton
            .tangent
            .predict(potential, field, &motion, describe)?;
        let change = moved(&motion, 1.0, &inside);
        if advance(potential, field, &change, describe)? == 1.0 {
            return Ok(());
        }
    }
    Err(SolveFault::Singular)
}

/// Adds the largest share of a change, halved from 1, at which all cells are admissible; returns the share.
fn advance(
    potential: &dyn Potential,
    field: &mut Vec<f64>,
    change: &[f64],
    describe: &dyn Fn(usize) -> String,
) -> Result<f64, SolveFault> {
    let mut residual = vec![0.0; field.len()];
    let mut share = 1.0;
    loop {
        let next = moved(field, share, change);
        match Assembly::residual(potential, &next, &mut residual) {
            Ok(_) => {
                *field = next;
                return Ok(share);
            }
            Err(fault) if share <= SHORTEST => {
                return Err(SolveFault::Inverted {
                    element: describe(fault.element),
                });
            }
            Err(_) => share *= 0.5,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::material::Card;
    use crate::mesh::{CellShape, Mesh};
    use crate::problem::sheet_energy::SheetEnergy;

    #[test]
    fn an_edge_moves_by_more_than_a_cell_and_inverts_none() {
        let mesh = Mesh::plate([10.0, 10.0], [40, 40], CellShape::Quad4);
        let law = Card::load("neo-hooke", Path::new(".")).unwrap().law;
        let energy = SheetEnergy::of_mesh(law, &mesh, 1.0);
        let held: Vec<bool> = mesh
            .nodes
            .iter()
            .flat_map(|[x, _]| [*x == 0.0 || *x == 10.0; 2])
            .collect();
        let mut newton = Newton::new(&energy, &held).unwrap();
        let pressed = |[x, _]: [f64; 2]| if x == 10.0 { [-1.5, 0.3] } else { [0.0; 2] };
        let wanted: Vec<f64> = mesh.nodes.iter().flat_map(|node| pressed(*node)).collect();
        let (mut field, mut residual) = (vec![0.0; wanted.len()], vec![0.0; wanted.len()]);
        assert!(Assembly::residual(&energy, &wanted, &mut residual).is_err());
        let describe = |cell: usize| mesh.describe_cell(cell);
        approach(&mut newton, &energy, &mut field, &wanted, &describe).unwrap();
        assert!(Assembly::residual(&energy, &field, &mut residual).is_ok());
        let pairs = field
            .iter()
            .zip(&wanted)
            .zip(&held)
            .filter(|(_, held)| **held);
        for ((u, wanted), _) in pairs {
            assert!((u - wanted).abs() < 1e-12);
        }
    }
}
