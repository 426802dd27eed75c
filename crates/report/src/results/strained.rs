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

/// The warnings about the states of a model on a mesh: compression, and those of each card, in the order of the sheet's laws.
pub fn warnings(
    cards: &[&Card],
    model: &str,
    mesh: &Mesh,
    states: &[StrainedSheet],
) -> Vec<String> {
    let compression = wrinkling::warning(states.iter().map(|state| {
        let wrinkling = Wrinkling::new(state.sheet, mesh, state.displacement);
        (state.load.clone(), wrinkling)
    }));
    let mut all: Vec<String> = compression.into_iter().collect();
    let Some(laws) = states.first().map(|state| state.sheet.laws.in_cells(mesh)) else {
        return all;
    };
    for (card, number) in cards.iter().zip(0..) {
        let cells = (0..mesh.cell_count()).filter(|cell| laws.number(*cell) == number);
        let cells: Vec<usize> = cells.collect();
        if !cells.is_empty() {
            all.extend(of_card(card, model, (mesh, &cells), states));
        }
    }
    all
}

/// The warnings about the states of a card's cells: strains that are too large for the law, the worst stretches beyond the range of the card,
/// and the first state whose material is not stable.
fn of_card(
    card: &Card,
    model: &str,
    (mesh, cells): (&Mesh, &[usize]),
    states: &[StrainedSheet],
) -> impl Iterator<Item = String> {
    let fields = || {
        states
            .iter()
            .map(|state| (state.load.clone(), state.displacement))
    };
    let strains = small_strain::warning(&*card.law, (mesh, cells), fields());
    let stretches = fields().map(|(load, u)| (load, Stretches::of_cells(card, (mesh, cells), u)));
    let worst = stretches.max_by(|(_, a), (_, b)| a.share.total_cmp(&b.share));
    let beyond = worst.and_then(|(load, own)| own.reason(card, &format!(" at {load}")));
    let unstable = fields().find_map(|(load, u)| {
        let cell = unstable_cell(card, (mesh, cells), u)?;
        Some(format!(
            "the material of the card `{}` is not stable (Drucker) in {} of the {model} at {load}.",
            card.name,
            mesh.describe_cell(cell)
        ))
    });
    let beyond = beyond.map(|reason| format!("{reason}."));
    strains.into_iter().chain(beyond).chain(unstable)
}

/// A cell in whose middle the material is not stable, if there is one.
fn unstable_cell(
    card: &Card,
    (mesh, cells): (&Mesh, &[usize]),
    displacement: &[f64],
) -> Option<usize> {
    cells.iter().copied().find(|cell| {
        let gradient = mesh.gradient_at(displacement, *cell, mesh.shape(*cell).centre());
        let kinematics = Kinematics::new(&Vector4::from(gradient));
        !kinematics.is_ok_and(|kinematics| is_stable(&*card.law, &kinematics))
    })
}
