//! What is stored in a specimen whose material softens, and what was dissipated.

use super::problem::Specimen;
use super::results::models::Models;
use crate::results::Block;

/// A table of all models at all load factors; nothing where the material has no memory.
pub fn blocks(specimen: &Specimen, models: &Models) -> Vec<Block> {
    if specimen.problem.law.softening().is_none() {
        return Vec::new();
    }
    let named = models.named();
    let mut head = vec!["load factor [–]".to_owned()];
    for what in ["stored", "dissipated"] {
        head.extend(
            named
                .iter()
                .map(|model| format!("{what}, {} [mJ]", model.name)),
        );
    }
    let row = |(step, factor): (usize, &f64)| {
        let works = named
            .iter()
            .map(|model| model.solution.works.get(step).copied().flatten());
        let text = |value: Option<f64>| value.map_or("–".into(), |value| format!("{value:.4}"));
        let mut cells = vec![factor.to_string()];
        cells.extend(works.clone().map(|work| text(work.map(|work| work.stored))));
        cells.extend(works.map(|work| text(work.map(|work| work.dissipated))));
        cells
    };
    let rows = specimen.factors.iter().enumerate().map(row);
    vec![
        Block::heading("Stored and dissipated energy"),
        Block::Table(head, rows.collect()),
        Block::Paragraph(
            "The material softens by its largest load, at every point for itself: the load factors follow one another as the study \
             lists them, and what a point remembers changes at these load factors alone. What is dissipated does not come back."
                .to_owned(),
        ),
    ]
}
