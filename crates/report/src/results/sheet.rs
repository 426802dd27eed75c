//! The data that determine the stresses of a sheet.

use super::viscous_stress::ViscousStress;
use crate::problem::SheetLaws;

/// The data that determine the stresses of a sheet.
#[derive(Clone, Copy)]
pub struct Sheet<'a> {
    /// The materials.
    pub laws: SheetLaws<'a>,
    /// Thickness in mm.
    pub thickness: f64,
    /// The earlier displacement fields, which a law with a memory remembers.
    pub past: &'a [&'a [f64]],
    /// The viscous part of the stresses; `None` where the material has none.
    pub viscous: Option<&'a ViscousStress>,
}

impl<'a> Sheet<'a> {
    /// Of an elastic material that remembers nothing yet.
    pub fn elastic(laws: SheetLaws<'a>, thickness: f64) -> Self {
        Self {
            laws,
            thickness,
            past: &[],
            viscous: None,
        }
    }

    /// The same after some displacement fields.
    #[must_use]
    pub fn after(self, past: &'a [&'a [f64]]) -> Self {
        Self { past, ..self }
    }

    /// The earlier fields and the present one.
    pub(super) fn fields(self, displacement: &'a [f64]) -> Vec<&'a [f64]> {
        let past = self.past.iter().copied();
        past.chain([displacement]).collect()
    }
}
