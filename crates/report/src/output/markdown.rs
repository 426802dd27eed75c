//! A report as Markdown.

use crate::results::{Block, Figure};

/// Markdown with pictures beside it.
pub fn markdown(blocks: &[Block], figures: &[Figure]) -> String {
    markdown_of_files(blocks, &|index| Ok(figures[index].name.clone()))
}

/// Markdown in which `file` gives the file of a picture, or the reason why there is none.
pub(super) fn markdown_of_files(
    blocks: &[Block],
    file: &dyn Fn(usize) -> Result<String, String>,
) -> String {
    let mut text = String::new();
    for block in blocks {
        text += &match block {
            Block::Heading(level, heading) => {
                format!("{} {}\n", "#".repeat(usize::from(*level)), escaped(heading))
            }
            Block::Paragraph(paragraph) => format!("{}\n", escaped(paragraph)),
            Block::Table(head, rows) => table(head, rows),
            Block::Figure(index, caption) => match file(*index) {
                // No program shows a PDF among words.
                Ok(name) if name.ends_with(".pdf") => format!("[{caption}]({name})\n"),
                Ok(name) => format!("![{caption}]({name})\n\n*{caption}*\n"),
                Err(fault) => format!("{}\n\n*{caption}*\n", escaped(&fault)),
            },
            Block::Code(language, code) => fenced(language, code),
        };
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// Text that Markdown would read as something else.
fn escaped(text: &str) -> String {
    text.replace('<', "\\<")
        .replace('|', "\\|")
        .replace('*', "\\*")
}

/// A fence longer than any in the text.
fn fenced(language: &str, code: &str) -> String {
    let longest = code.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest.max(2) + 1);
    format!("{fence}{language}\n{}\n{fence}\n", code.trim_end())
}

fn table(head: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<_> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    debug_assert!(rows.iter().all(|row| row.len() == head.len()), "{head:?}");
    let rule = format!("|{}\n", " --- |".repeat(head.len()));
    let body: String = rows.iter().map(|row| line(row)).collect();
    line(head) + &rule + &body
}
