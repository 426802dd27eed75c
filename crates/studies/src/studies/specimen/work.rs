//! The stored and dissipated energy of a specimen whose material softens.

use super::problem::Specimen;
use super::results::models::Models;
use crate::problem::Work;
use crate::results::{Block, Table, or_dash};
use crate::units::decimals;

/// A part of the work on the material with its name.
type Part = (&'static str, fn(Work) -> f64);

const PARTS: [Part; 2] = [
    ("stored", |work| work.stored),
    ("dissipated", |work| work.dissipated),
];

/// A table of all models at all load factors; nothing where the material has no memory.
pub fn blocks(specimen: &Specimen, models: &Models) -> Vec<Block> {
    if !specimen.problem.laws().soften() {
        return Vec::new();
    }
    let along = specimen.along;
    let mut table = Table::of(specimen.factors.iter().enumerate())
        .column(along.head(), |(_, factor)| along.value(**factor));
    for (what, part) in PARTS {
        for (kind, solution) in models.all() {
            let head = format!("{what}, {} [mJ]", kind.style().name);
            table = table.column(head, |(step, _)| {
                let work = solution.works.get(*step).copied().flatten();
                or_dash(work.map(part), |value| decimals(value, 4))
            });
        }
    }
    vec![
        Block::heading("Stored and dissipated energy"),
        table.block(),
        Block::paragraph(
            "The material softens at every point according to the largest load there so far (Mullins effect). The loads follow one another as the \
             study lists them, and the largest load is updated at these only. Dissipated work is not recovered.",
        ),
    ]
}
