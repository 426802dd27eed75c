//! The materials of a sheet whose displacements were measured.

use super::conditions::Conditions;
use crate::error::{Diagnostic, Error};
use crate::material::softened_law::check_memory;
use crate::material::{Card, HyperelasticLaw, PlaneState};
use crate::mesh::Mesh;
use crate::results::locking;
use crate::studies::card::card_in_plane;
use crate::studies::regions::{SheetCards, divided, fault_of};

/// The card in the plane state that is stated, else in its own.
///
/// # Errors
/// [`Error::Input`] where it has no stress in it.
pub fn in_plane(card: Card, stated: Option<PlaneState>) -> Result<Card, Error> {
    let plane = stated.unwrap_or(card.law.plane_state());
    Ok(card_in_plane(card, plane)?)
}

/// The card, and those of regions that are taken from the conditions, in the plane state that is stated.
///
/// # Errors
/// As [`in_plane`]; [`Error::Input`] where a material has a memory.
pub(super) fn in_common_plane(
    card: Card,
    conditions: &mut Conditions,
) -> Result<(Card, Vec<(String, Card)>), Error> {
    let regions = std::mem::take(&mut conditions.regions).into_iter();
    let card_of = |card: Card| {
        check_memory(&*card.law, "a correction of measured fields")?;
        in_plane(card, conditions.sheet)
    };
    let card = card_of(card)?;
    let regions = regions.map(|(region, card)| Ok((region, card_of(card)?)));
    Ok((card, regions.collect::<Result<_, Error>>()?))
}

/// The warnings about cards on a mesh, each once.
pub(super) fn card_warnings(
    card: &Card,
    regions: &[(String, Card)],
    mesh: &Mesh,
) -> Vec<Diagnostic> {
    let cards = SheetCards { card, regions };
    let mut all: Vec<Diagnostic> = Vec::new();
    for card in cards.all() {
        let left_out = card.viscosity.left_out().map(|left_out| {
            Diagnostic::warning("", left_out)
                .hint("use a card fitted to tests at the rate of this experiment")
        });
        let of_card = card.warnings().into_iter();
        for warning in of_card.chain(too_stiff(&*card.law, mesh)).chain(left_out) {
            if !all.contains(&warning) {
                all.push(warning);
            }
        }
    }
    all
}

/// Checks that a mesh has all regions to which cards are given.
///
/// # Errors
/// [`Error::Input`] with every region that it lacks.
pub(super) fn check_regions(regions: &[(String, Card)], mesh: &Mesh) -> Result<(), Error> {
    let names: Vec<&str> = regions.iter().map(|(name, _)| &**name).collect();
    let faults = names.iter().enumerate().filter_map(|(index, name)| {
        let (message, hint) = fault_of(name, &names[..index], mesh)?;
        Some(Diagnostic::error("", message).hint(hint))
    });
    Error::refuse(faults.collect())
}

/// The warning that a mesh is divided into parts and one card is given for all.
pub(super) fn one_card_warning(regions: &[(String, Card)], mesh: &Mesh) -> Option<Diagnostic> {
    let parts = divided(mesh).filter(|_| regions.is_empty())?;
    let message =
        format!("the cells of the mesh are divided into {parts}: all of them get the one card");
    let hint = "give a part that has another material its own card: --region NAME=CARD, or [[material]] in the file of --study";
    Some(Diagnostic::warning("", message).hint(hint))
}

/// The warning about a mesh whose cells lock.
fn too_stiff(law: &dyn HyperelasticLaw, mesh: &Mesh) -> Option<Diagnostic> {
    let reason = locking::reason(law).filter(|_| locking::locks(mesh))?;
    let message = format!("{reason}: stresses are too large");
    let hint = "use quadratic cells, such as `--cells triangle6`";
    Some(Diagnostic::warning("", message).hint(hint))
}
