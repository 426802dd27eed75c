//! What is stored in a sheet that softens, and what was dissipated.

use super::{Block, or_dash};
use crate::problem::Work;
use crate::units::decimals;

/// A table of the work on the material in some models at all steps, with a heading; a dash where a model has none.
pub fn work_blocks(
    along: &str,
    models: &[&str],
    rows: impl IntoIterator<Item = (String, Vec<Option<Work>>)>,
) -> [Block; 2] {
    let columns = |what: &'static str| {
        let models = models.iter();
        models.map(move |model| format!("{what}, {model} [mJ]"))
    };
    let first = [along.to_owned()].into_iter();
    let head = first.chain(columns("stored")).chain(columns("dissipated"));
    let figure = |value: Option<f64>| or_dash(value, |value| decimals(value, 4));
    let row = |(at, works): (String, Vec<Option<Work>>)| {
        let stored = works.iter().map(|work| work.map(|work| work.stored));
        let dissipated = works.iter().map(|work| work.map(|work| work.dissipated));
        let figures = stored.chain(dissipated).map(figure);
        [at].into_iter().chain(figures).collect()
    };
    [
        Block::heading("Stored and dissipated energy"),
        Block::Table(head.collect(), rows.into_iter().map(row).collect()),
    ]
}
