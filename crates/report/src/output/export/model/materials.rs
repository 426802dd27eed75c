//! The materials of a model, each with the cells that it fills.

use super::Export;
use crate::error::Diagnostic;
use crate::material::{Card, Code, CodeLaw};
use crate::output::export::text::{FIBRES, MATERIAL, Names, SPECIMEN};

/// A material and the cells that it fills.
pub struct PartMaterial<'a> {
    pub card: &'a Card,
    pub law: CodeLaw,
    /// Its name.
    pub name: String,
    /// The name of the axes of its fibres.
    pub axes: String,
    /// The name of the set of its cells.
    pub set: String,
    /// Its cells, ascending.
    pub cells: Vec<usize>,
}

impl<'a> PartMaterial<'a> {
    /// The materials that have cells: one of all of them, or one of each region.
    pub fn all(given: &Export<'a>, code: Code, names: &mut Names) -> Result<Vec<Self>, Diagnostic> {
        let regions = given.regions.iter().map(|(name, card)| (&**name, card));
        let laws = given.problem.laws().in_cells(given.mesh);
        let mut all: Vec<Self> = Vec::new();
        for ((region, card), number) in std::iter::once(("rest", given.card))
            .chain(regions)
            .zip(0..)
        {
            let range = 0..given.mesh.cell_count();
            let cells: Vec<usize> = range.filter(|cell| laws.number(*cell) == number).collect();
            if cells.is_empty() {
                continue;
            }
            let (mut name, mut axes) = (MATERIAL.to_owned(), FIBRES.to_owned());
            if !all.is_empty() {
                name = format!("MATERIAL_{}", all.len() + 1);
                axes = format!("{FIBRES}_{}", all.len() + 1);
            }
            let set = if given.regions.is_empty() {
                SPECIMEN.to_owned()
            } else {
                names.give(&format!("{region}_cells"))
            };
            all.push(Self {
                law: given.law(code, card)?,
                card,
                name,
                axes,
                set,
                cells,
            });
        }
        Ok(all)
    }
}
