//! What is stored in a specimen whose material softens, and what was dissipated.

use super::problem::Specimen;
use super::results::models::Models;
use crate::results::{Block, work_blocks};

/// A table of all models at all load factors; nothing where the material has no memory.
pub fn blocks(specimen: &Specimen, models: &Models) -> Vec<Block> {
    if !specimen.problem.laws().soften() {
        return Vec::new();
    }
    let all = models.all();
    let names = all.map(|(kind, _)| kind.style().name);
    let row = |(step, factor): (usize, &f64)| {
        let works = all.iter();
        let works = works.map(|(_, solution)| solution.works.get(step).copied().flatten());
        (specimen.along.value(*factor), works.collect())
    };
    let rows = specimen.factors.iter().enumerate().map(row);
    let mut blocks = work_blocks(specimen.along.head(), &names, rows).to_vec();
    blocks.push(
        Block::Paragraph(
            "The material softens at every point according to the largest load there so far (Mullins effect). The loads follow one another as the \
             study lists them, and the largest load is updated at these only. Dissipated work is not recovered."
                .to_owned(),
        ),
    );
    blocks
}
