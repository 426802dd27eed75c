//! Warnings of states that wrinkle, whose material is beyond the range of its law or its card, or not stable.

use nalgebra::Vector4;

use super::wrinkling::{self, Wrinkling};
use super::{Sheet, Stretches, small_strain};
use crate::material::Card;
use crate::material::sheet::Kinematics;
use crate::material::stability::is_stable;
use crate::mesh::Mesh;

/// A displacement field of a sheet.
#[derive(Clone)]
pub struct StrainedSheet<'a> {
    /// The load, or the time, in words.
    pub load: String,
    /// What its stresses follow from.
    pub sheet: Sheet<'a>,
    /// Displacements in mm.
    pub displacement: &'a [f64],
}

/// The warnings about the states of a model on a mesh: compression, strains that are too large for the law, the worst stretches beyond the
/// range of the card, and the first state whose material is not stable.
pub fn warnings(card: &Card, model: &str, mesh: &Mesh, states: &[StrainedSheet]) -> Vec<String> {
    let fields = || {
        states
            .iter()
            .map(|state| (state.load.clone(), state.displacement))
    };
    let compression = wrinkling::warning(states.iter().map(|state| {
        let wrinkling = Wrinkling::new(state.sheet, mesh, state.displacement);
        (state.load.clone(), wrinkling)
    }));
    let law = states.first().map(|state| state.sheet.law);
    let strains = law.and_then(|law| small_strain::warning(law, mesh, fields()));
    let stretches = fields().map(|(load, u)| (load, Stretches::new(card, mesh, u)));
    let worst = stretches.max_by(|(_, a), (_, b)| a.share.total_cmp(&b.share));
    let beyond = worst.and_then(|(load, own)| own.reason(card, &format!(" at {load}")));
    let unstable = fields().find_map(|(load, u)| {
        let cell = unstable_cell(card, mesh, u)?;
        Some(format!(
            "the material of the card `{}` is not stable (Drucker) in {} of the {model} at {load}.",
            card.name,
            mesh.describe_cell(cell)
        ))
    });
    let beyond = beyond.map(|reason| format!("{reason}."));
    let all = compression.into_iter().chain(strains);
    all.chain(beyond).chain(unstable).collect()
}

/// A cell in whose middle the material is not stable, if there is one.
fn unstable_cell(card: &Card, mesh: &Mesh, displacement: &[f64]) -> Option<usize> {
    (0..mesh.cell_count()).find(|cell| {
        let gradient = mesh.gradient_at(displacement, *cell, mesh.shape(*cell).centre());
        let kinematics = Kinematics::new(&Vector4::from(gradient));
        !kinematics.is_ok_and(|kinematics| is_stable(&*card.law, &kinematics))
    })
}
