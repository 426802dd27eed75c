//! The report on how files were understood.

use crate::markers::Understood;
use crate::results::{Block, Table};

/// Columns, units, origin and axes of files, as far as there is something to say.
pub fn blocks(understood: &Understood) -> Vec<Block> {
    if understood.columns.is_empty() && !understood.turned_up {
        return Vec::new();
    }
    let encoding = understood.encoding.map(|name| format!("Text in {name}. "));
    let table = understood.part.as_ref();
    let part = table.map(|name| format!("The table `{name}` of the file. "));
    let mut words = encoding.or(part).unwrap_or_default();
    words += understood.axes();
    if let Some(positions) = understood.positions() {
        words += &format!(" {positions}");
    }
    let mut blocks = vec![
        Block::heading("How the file was read"),
        Block::paragraph(words),
    ];
    if !understood.columns.is_empty() {
        let table = Table::of(&understood.columns)
            .column("quantity", |taken| taken.holds.to_owned())
            .column("column", |taken| taken.head.clone())
            .column("unit [mm]", |taken| {
                taken.unit.map_or(String::new(), |unit| unit.to_string())
            })
            .column("source of the unit", |taken| taken.unit_source.to_owned());
        blocks.push(table.block());
    }
    let sketch = understood.sketch();
    blocks.extend(sketch.map(|sketch| Block::Code("text", sketch.to_owned())));
    blocks
}

/// The layout, for the terminal.
pub fn short(understood: &Understood) -> String {
    let turned = if understood.turned_up {
        ", y turned up"
    } else {
        ""
    };
    let table = understood.part.as_ref();
    let part = table.map_or(String::new(), |name| format!(" of `{name}`"));
    format!("{}{part}{turned}", understood.layout)
}
