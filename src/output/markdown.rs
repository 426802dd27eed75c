//! A report as Markdown.

use super::figures::Figure;
use super::report::Block;

/// Markdown with pictures beside it.
pub fn markdown(blocks: &[Block], figures: &[Figure]) -> String {
    let mut text = String::new();
    for block in blocks {
        text += &match block {
            Block::Heading(level, heading) => {
                format!("{} {heading}\n", "#".repeat(usize::from(*level)))
            }
            Block::Paragraph(paragraph) => format!("{paragraph}\n"),
            Block::Table(head, rows) => table(head, rows),
            Block::Figure(index, caption) => {
                format!("![{caption}]({})\n\n*{caption}*\n", figures[*index].name)
            }
            Block::Code(code) => format!("```toml\n{}\n```\n", code.trim_end()),
        };
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

fn table(head: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<_> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule = format!("|{}\n", " --- |".repeat(head.len()));
    let body: String = rows.iter().map(|row| line(row)).collect();
    line(head) + &rule + &body
}
