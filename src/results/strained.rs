//! Warnings of states whose material is beyond the range of its card, or not stable.

use nalgebra::Vector4;

use super::Stretches;
use crate::material::Card;
use crate::material::sheet::Kinematics;
use crate::material::stability::is_stable;
use crate::mesh::Mesh;

/// The warnings about the states of a model on a mesh, each at a named load: the worst stretches beyond the range of the card, and the first
/// state whose material is not stable.
pub fn warnings<'a>(
    card: &Card,
    model: &str,
    mesh: &Mesh,
    states: impl Iterator<Item = (String, &'a [f64])> + Clone,
) -> Vec<String> {
    let mut states_again = states.clone();
    let stretches = states.map(|(load, u)| (load, Stretches::new(card, mesh, u)));
    let worst = stretches.max_by(|(_, a), (_, b)| a.share.total_cmp(&b.share));
    let beyond = worst.and_then(|(load, own)| own.reason(card, &format!(" at {load}")));
    let unstable = states_again.find_map(|(load, u)| {
        let cell = unstable_cell(card, mesh, u)?;
        Some(format!(
            "the material of the card `{}` is not stable (Drucker) in {} of the {model} at {load}.",
            card.name,
            mesh.describe_cell(cell)
        ))
    });
    let beyond = beyond.map(|reason| format!("{reason}."));
    beyond.into_iter().chain(unstable).collect()
}

/// A cell in whose middle the material is not stable, if there is one.
fn unstable_cell(card: &Card, mesh: &Mesh, displacement: &[f64]) -> Option<usize> {
    (0..mesh.cell_count()).find(|cell| {
        let gradient = mesh.gradient_at(displacement, *cell, mesh.shape(*cell).centre());
        let kinematics = Kinematics::new(&Vector4::from(gradient));
        !kinematics.is_ok_and(|kinematics| is_stable(&*card.law, &kinematics))
    })
}
