//! The regions of a mesh: its groups of cells, of which each may have a material of its own.

use std::sync::Arc;

use crate::error::suggestion;
use crate::material::Card;
use crate::mesh::Mesh;
use crate::problem::{CellLaws, LawAndRegions, SheetLaws};
use crate::results::Material;

/// The cards of a sheet: one of all cells, or several of named groups of its cells.
#[derive(Clone, Copy, Debug)]
pub struct SheetCards<'a> {
    /// The card of all cells that belong to no region.
    pub card: &'a Card,
    /// The cards of regions by their names.
    pub regions: &'a [(String, Card)],
}

/// The number of a region, its name and its card.
pub type NumberedRegion<'a> = (usize, &'a str, &'a Card);

impl<'a> SheetCards<'a> {
    /// Every card: that of the cells of no region first.
    pub fn all(self) -> impl Iterator<Item = &'a Card> {
        let regions = self.regions.iter().map(|(_, card)| card);
        std::iter::once(self.card).chain(regions)
    }

    /// The laws of the cards.
    pub fn laws(self) -> LawAndRegions {
        let regions = self.regions.iter();
        let regions = regions.map(|(name, card)| (name.clone(), Arc::clone(&card.law)));
        (Arc::clone(&self.card.law), regions.collect())
    }

    /// The laws of the cells of a mesh.
    pub fn in_cells(self, mesh: &Mesh) -> CellLaws {
        SheetLaws::from(&self.laws()).in_cells(mesh)
    }

    /// The regions that have cells, each with its number, its name and its card; empty where all cells have one card.
    pub fn numbered(self, mesh: &Mesh) -> Vec<NumberedRegion<'a>> {
        self.numbered_by(&self.in_cells(mesh), mesh)
    }

    fn numbered_by(self, laws: &CellLaws, mesh: &Mesh) -> Vec<NumberedRegion<'a>> {
        if self.regions.is_empty() {
            return Vec::new();
        }
        let has_rest = (0..mesh.cell_count()).any(|cell| laws.number(cell) == 0);
        let rest = has_rest.then_some((0, "the remaining cells", self.card));
        let regions = self.regions.iter().zip(1..);
        let regions = regions.map(|((name, card), number)| (number, &**name, card));
        rest.into_iter().chain(regions).collect()
    }

    /// The findings of a rule in the cells of each card; of several cards, with the names of their regions.
    pub fn in_turn(
        self,
        mesh: &Mesh,
        rule: impl Fn(&Card, &[usize]) -> Option<(String, String)>,
    ) -> Option<(String, String)> {
        let laws = self.in_cells(mesh);
        let regions = self.numbered_by(&laws, mesh);
        if regions.is_empty() {
            let cells: Vec<usize> = (0..mesh.cell_count()).collect();
            return rule(self.card, &cells);
        }
        let of_regions = regions.into_iter().filter_map(|(number, name, card)| {
            let cells =
                (0..mesh.cell_count()).filter(|cell| usize::from(laws.number(*cell)) == number);
            let (message, remedy) = rule(card, &cells.collect::<Vec<_>>())?;
            Some((format!("{name}: {message}"), remedy))
        });
        let (messages, remedies): (Vec<String>, Vec<String>) = of_regions.unzip();
        let remedy = remedies.into_iter().next()?;
        Some((messages.join("; "), remedy))
    }

    /// The material of the sheet, or those of its regions, for reports.
    pub fn material(self, mesh: &Mesh) -> Material {
        match &self.numbered(mesh)[..] {
            [] => Material::from(self.card),
            regions => Material::of_regions(regions),
        }
    }

    /// A description of the card, or of the cards with their regions.
    pub fn words(self, mesh: &Mesh, of_card: impl Fn(&Card) -> String) -> String {
        let regions = self.numbered(mesh).into_iter();
        let regions = regions.map(|(_, name, card)| format!("{}, on {name}", of_card(card)));
        match &regions.collect::<Vec<_>>()[..] {
            [] => of_card(self.card),
            several => format!("several materials ({})", several.join("; ")),
        }
    }
}

/// Names in backquotes, separated by commas; `None` where there are none.
pub fn quoted(names: &[&str]) -> Option<String> {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    (!quoted.is_empty()).then(|| quoted.join(", "))
}

/// The names of the regions of a mesh: groups of some of its cells.
pub fn regions_of(mesh: &Mesh) -> Vec<&str> {
    let groups = mesh.groups().iter();
    let regions = groups.filter(|(_, group)| !group.cells.is_empty());
    regions.map(|(name, _)| &**name).collect()
}

/// The names of the regions into which all cells of a mesh are divided, as for several materials; `None` where some cells belong to none.
pub fn divided(mesh: &Mesh) -> Option<String> {
    let parts = regions_of(mesh).into_iter();
    let parts = parts.filter(|name| mesh.groups()[*name].cells.len() < mesh.cell_count());
    let parts: Vec<&str> = parts.collect();
    let cells = parts.iter().map(|name| mesh.groups()[*name].cells.len());
    quoted(&parts).filter(|_| cells.sum::<usize>() == mesh.cell_count())
}

/// Regions with cards of their own at most: their numbers, and that of the remaining cells, are single bytes.
const MOST: usize = u8::MAX as usize - 1;

/// What is wrong with a region of a mesh that follows others which have a card, and the remedy.
pub fn fault_of(region: &str, before: &[&str], mesh: &Mesh) -> Option<(String, String)> {
    let fault = |message: String, hint: &str| Some((message, hint.to_owned()));
    let known = regions_of(mesh);
    if known.is_empty() {
        let message = format!(
            "the mesh has no region `{region}`: none of its cells have a name of their own"
        );
        return fault(
            message,
            "name its surfaces (Gmsh: Physical Surface; VTK: an array of the cells gmsh:physical, physical or CellEntityIds), or write one [material]",
        );
    }
    if !known.contains(&region) {
        let message = format!("the mesh has no region `{region}`");
        let near = suggestion(region, &known, "");
        let all = format!("its regions are {}", known.join(", "));
        let hint = if near.starts_with("did") {
            format!("{near} {all}")
        } else {
            all
        };
        return Some((message, hint));
    }
    if before.contains(&region) {
        let message = format!("the region `{region}` has a card already");
        return fault(message, "leave out one of the two");
    }
    if before.len() >= MOST {
        let message = format!("more than {MOST} regions have cards of their own");
        return fault(message, "name cells of one material as one region");
    }
    let cells = &mesh.groups()[region].cells;
    let shared = before.iter().filter_map(|other| {
        let group = mesh.groups().get(*other)?;
        let common = cells
            .iter()
            .filter(|cell| group.cells.binary_search(cell).is_ok());
        Some((other, common.count()))
    });
    let (other, count) = shared.into_iter().find(|(_, count)| *count > 0)?;
    let message = format!("the region `{region}` shares {count} cells with `{other}`");
    fault(
        message,
        "a cell has one card: name regions without common cells",
    )
}
