//! The materials of a sheet whose displacements were measured.

use std::sync::Arc;

use super::MarkerStudy;
use super::finding::none_of;
use crate::error::{Diagnostic, Error};
use crate::estimation::{FieldEstimate, Specimen};
use crate::material::{Card, HyperelasticLaw, PlaneState};
use crate::mesh::Mesh;
use crate::problem::LawAndRegions;
use crate::results::locking;
use crate::studies::card::card_in_plane;
use crate::studies::regions::{SheetCards, divided, fault_of};

/// The card in the plane state that is stated, else in its own.
///
/// # Errors
/// [`Error::Input`] where it has no stress in it.
pub fn in_plane(card: Card, stated: Option<PlaneState>) -> Result<Card, Error> {
    let plane = stated.unwrap_or(card.law.plane_state());
    card_in_plane(card, plane).map_err(|fault| Error::Input(vec![fault]))
}

/// The warnings about cards on a mesh, each once.
pub(super) fn of_materials(cards: SheetCards, mesh: &Mesh) -> Vec<Diagnostic> {
    let mut all: Vec<Diagnostic> = Vec::new();
    for card in cards.all() {
        let left_out = card.viscosity.left_out();
        let left_out = left_out.map(|left_out| {
            Diagnostic::warning("", left_out)
                .hint("use a card fitted to tests at the rate of this experiment")
        });
        let warnings = card.warnings().into_iter();
        let warnings = warnings.chain(too_stiff(&*card.law, mesh)).chain(left_out);
        for warning in warnings {
            if !all.contains(&warning) {
                all.push(warning);
            }
        }
    }
    all
}

/// Whether a mesh has the regions that have cards of their own.
///
/// # Errors
/// [`Error::Input`] with every one that it has not.
pub(super) fn check_regions(regions: &[(String, Card)], mesh: &Mesh) -> Result<(), Error> {
    let names: Vec<&str> = regions.iter().map(|(name, _)| &**name).collect();
    let faults = names.iter().enumerate().filter_map(|(index, name)| {
        let (message, hint) = fault_of(name, &names[..index], mesh)?;
        Some(Diagnostic::error("", message).hint(hint))
    });
    none_of(faults.collect())
}

/// The warning about parts of a mesh of which none has a card of its own.
pub(super) fn of_divided(regions: &[(String, Card)], mesh: &Mesh) -> Option<Diagnostic> {
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

impl MarkerStudy {
    /// The cards of the cells.
    pub fn cards(&self) -> SheetCards<'_> {
        SheetCards {
            card: &self.card,
            regions: &self.regions,
        }
    }

    /// The law that an estimate has found, else that of the card.
    fn law(&self, estimate: &FieldEstimate) -> Arc<dyn HyperelasticLaw> {
        match &self.regressed {
            Some(regressed) if !estimate.parameters.is_empty() => {
                let values = estimate.parameters.iter().map(|(.., found)| found.value);
                regressed.at(&values.collect::<Vec<_>>())
            }
            _ => Arc::clone(&self.card.law),
        }
    }

    /// The laws of the sheet, with that which an estimate has found.
    pub fn laws(&self, estimate: &FieldEstimate) -> LawAndRegions {
        let (_, regions) = self.cards().laws();
        (self.law(estimate), regions)
    }

    /// The sheet as it is estimated.
    pub(super) fn specimen(&self) -> Specimen<'_> {
        Specimen {
            mesh: &self.mesh,
            laws: self.cards().in_cells(&self.mesh),
            thickness: self.thickness,
        }
    }
}
