//! The sheet of a study of markers: its cards, and its laws with the parameters that an estimate has found.

use std::sync::Arc;

use super::MarkerStudy;
use crate::estimation::{FieldEstimate, Specimen};
use crate::material::HyperelasticLaw;
use crate::problem::LawAndRegions;
use crate::studies::regions::SheetCards;

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
                let values = estimate
                    .parameters
                    .iter()
                    .map(|(.., parameter)| parameter.value);
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
