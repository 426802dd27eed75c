//! The cards of a specimen: one, or one of each region of its mesh.

use std::path::Path;

use super::super::problem::Outline;
use crate::document::Section;
use crate::material::{Card, PlaneState};
use crate::mesh::Mesh;
use crate::studies::card::read_card;
use crate::studies::regions::{fault_of, quoted, regions_of};

/// The key of the region that a card is for.
const ON: &str = "on";

/// The cards of a study, with their sections.
pub struct Materials<'a> {
    entries: Vec<Entry<'a>>,
}

/// A card, and the region that it is for; `None` for all remaining cells.
struct Entry<'a> {
    section: Section<'a>,
    on: Option<String>,
    card: Option<Card>,
}

/// The card of all cells that belong to no region, and the cards of the regions by their names.
pub type Cards = (Card, Vec<(String, Card)>);

impl<'a> Materials<'a> {
    /// Reads `[material]`, or each `[[material]]`.
    pub fn read(root: &Section<'a>, folder: &Path) -> Self {
        let sections = root.section_or_sections("material");
        let several = root.is_list("material");
        if several && sections.is_empty() {
            root.fault("material", "needs a card at least", "write [material]");
        }
        let entries = sections.into_iter().map(|section| {
            let section = section.requiring(&["card"]);
            let card = read_card(&section, folder);
            let on = (several && section.has(ON)).then(|| section.text(ON));
            section.unknown_keys_with(|key| {
                let hint =
                    "a single [material] is that of all cells; write [[material]] for each region";
                (key == ON).then(|| hint.to_owned())
            });
            Entry { section, on, card }
        });
        Self {
            entries: entries.collect(),
        }
    }

    /// One card of all cells.
    pub fn of(card: Card, root: &Section<'a>) -> Self {
        let section = root.section("material");
        let entry = Entry {
            section,
            on: None,
            card: Some(card),
        };
        Self {
            entries: vec![entry],
        }
    }

    /// The state of the first card.
    pub fn plane_state(&self) -> Option<PlaneState> {
        let mut cards = self.entries.iter().filter_map(|entry| entry.card.as_ref());
        cards.next().map(|card| card.law.plane_state())
    }

    /// Whether a card softens.
    pub fn soften(&self) -> bool {
        let mut cards = self.entries.iter().filter_map(|entry| entry.card.as_ref());
        cards.any(|card| card.law.softening().is_some())
    }

    /// The cards on a mesh of the outline; `None` where they have faults, which are recorded.
    pub fn on(self, root: &Section, outline: &Outline, mesh: &Mesh) -> Option<Cards> {
        let known = regions_of(mesh);
        let mut is_sound = self.entries.iter().all(|entry| entry.card.is_some());
        for (number, entry) in self.entries.iter().enumerate() {
            if let Some((message, hint)) = entry.fault(&self.entries[..number], outline, mesh) {
                entry.section.fault(ON, &message, &hint);
                is_sound = false;
            }
        }
        if is_sound && let Some((message, hint)) = self.uncovered(mesh, &known) {
            root.fault("material", &message, &hint);
            is_sound = false;
        }
        is_sound.then(|| self.cards())?
    }

    /// Whether each cell belongs to a region with a card.
    fn covered(&self, mesh: &Mesh) -> Vec<bool> {
        let mut is_covered = vec![false; mesh.cell_count()];
        let regions = self.entries.iter().filter_map(|entry| entry.on.as_ref());
        for cell in regions.flat_map(|region| &mesh.groups()[region].cells) {
            is_covered[*cell] = true;
        }
        is_covered
    }

    /// The cells without a card.
    fn uncovered(&self, mesh: &Mesh, known: &[&str]) -> Option<(String, String)> {
        let is_covered = self.covered(mesh);
        if let Some(rest) = self.entries.iter().find(|entry| entry.on.is_none()) {
            if is_covered.iter().all(|is| *is) {
                let message =
                    "no cell remains for this card: every cell belongs to a region with a card";
                rest.section.warning("card", message, "leave it out");
            }
            return None;
        }
        let count = is_covered.iter().filter(|is| !**is).count();
        let has_some = |name: &&str| {
            let mut cells = mesh.groups()[*name].cells.iter();
            cells.any(|cell| !is_covered[*cell])
        };
        let names: Vec<&str> = known.iter().copied().filter(has_some).collect();
        let of = quoted(&names).map_or_else(
            || "which have no name".to_owned(),
            |names| format!("those of {names}"),
        );
        let message = format!("{count} of {} cells have no card: {of}", mesh.cell_count());
        let hint =
            "add a [[material]] for them, or one without `on`, which is for all remaining cells";
        (count > 0).then(|| (message, hint.to_owned()))
    }

    fn cards(self) -> Option<Cards> {
        let (mut rest, mut regions) = (None, Vec::new());
        for Entry { on, card, .. } in self.entries {
            match on {
                Some(region) => regions.push((region, card?)),
                None => rest = card,
            }
        }
        let first = regions.first().map(|(_, card)| card.clone());
        let card = rest.or(first)?;
        Some((card, regions))
    }
}

impl Entry<'_> {
    /// What is wrong with the region of an entry that follows others, and the remedy.
    fn fault(&self, before: &[Self], outline: &Outline, mesh: &Mesh) -> Option<(String, String)> {
        let fault = |message: String, hint: &str| Some((message, hint.to_owned()));
        let first = before.first();
        if let Some((one, other)) = first.and_then(|first| first.other_state(self)) {
            let message = format!("this card is in {one}, and the first one in {other}");
            let hint = "a sheet has one state: write the same `sheet` for all cards";
            return fault(message, hint);
        }
        let Some(region) = &self.on else {
            let is_second = before.iter().any(|material| material.on.is_none());
            let message = "is missing: another card is for all remaining cells already";
            let hint = "name the region that this card is for, such as on = \"inclusion\"";
            return is_second.then(|| (message.to_owned(), hint.to_owned()));
        };
        if !matches!(outline, Outline::File { .. }) {
            let message = "the cells of a built-in shape have no names".to_owned();
            let hint =
                "take shape = \"mesh\" with a file whose cells have names, or write one [material]";
            return fault(message, hint);
        }
        let before = before.iter().filter_map(|material| material.on.as_deref());
        fault_of(region, &before.collect::<Vec<_>>(), mesh)
    }

    /// The plane states of another card and of this one, where they differ.
    fn other_state(&self, other: &Self) -> Option<(&'static str, &'static str)> {
        let state = |material: &Self| Some(material.card.as_ref()?.law.plane_state());
        let (plane, other) = (state(self)?, state(other)?);
        (plane != other).then(|| (other.name(), plane.name()))
    }
}
