//! A report as one HTML page with its pictures inside.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::explorer::{self, Explorer};
use super::picture::Drawn;
use crate::results::Block;

const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; }
.wide { overflow-x: auto; } .wide + .wide { margin-top: 1rem; }
table { border-collapse: collapse; font-size: .86rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .6rem; text-align: left; vertical-align: top; border-bottom: 1px solid #e2e2e2; }
th { border-bottom: 2px solid #999; font-weight: 600; vertical-align: bottom; }
td { white-space: nowrap; } td.long { white-space: normal; } td.number { text-align: right; }
td.pass { color: #176b2c; font-weight: 600; } td.fail, p.fail { color: #b00020; font-weight: 600; }
td.pass, td.fail, td.open, table:has(td.pass, td.fail, td.open) th:last-child { position: sticky; right: 0; background: #fff; box-shadow: -.5rem 0 .5rem #fff; white-space: normal; }
@media (max-width: 40rem) { td { white-space: normal; } td.number { white-space: nowrap; } th, td { padding: .2rem .35rem; } }
figure { margin: 1.5rem 0; } img { max-width: 100%; border: 1px solid #eee; } figcaption { color: #555; font-size: .9rem; }
code { font-size: .92em; } pre { background: #f6f6f6; padding: .8rem; overflow-x: auto; font-size: .82rem; }
";

/// A self-contained page.
pub fn html(
    title: &str,
    blocks: &[Block],
    pictures: &[&Drawn],
    explorer: Option<&Explorer>,
) -> String {
    let is_figure = |block: &Block| matches!(block, Block::Figure(..));
    let figure = blocks.iter().position(is_figure).unwrap_or(blocks.len());
    let is_headed = matches!(blocks[..figure].last(), Some(Block::Heading(..)));
    let first = figure - usize::from(is_headed);
    let (above, below) = blocks.split_at(first);
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) @if explorer.is_some() { (PreEscaped(explorer::STYLE)) } }
            }
            body {
                @for block in above { (render(block, pictures)) }
                @if let Some(explorer) = explorer { (explore(explorer)) }
                @for block in below { (render(block, pictures)) }
            }
        }
    };
    let mut page = page.into_string();
    // Controls, which names of files and titles may hold, have no place in a page.
    page.retain(|character| matches!(character, '\n' | '\t') || !character.is_control());
    page
}

/// What the program in the page fills; it is hidden where no program runs.
fn explore(explorer: &Explorer) -> Markup {
    html! {
        section id="explorer" hidden {
            h2 { "Explore" }
            div.choices {
                label { "model" select id="explorer-model" {} }
                label { "field" select id="explorer-name" {} }
                label { input id="explorer-step" type="range" min="0" step="1"; span id="explorer-at" {} }
            }
            canvas id="explorer-field" {}
            div.bar { span id="explorer-low" {} canvas id="explorer-bar" {} span id="explorer-high" {} }
            p id="explorer-reached" {}
            div id="explorer-along" {
                div.choices { label { "along the path" select id="explorer-quantity" {} } }
                canvas id="explorer-curve" {}
            }
            div.said {
                div.wide { table id="explorer-values" {} }
                div.wide { table id="explorer-forces" {} }
            }
            p {
                "The colour scale of a step covers all models, without the extreme hundredth of the area at each end. Point at the sheet to read the \
                 values of all models at the same place; drag over the curve to change the step; nothing was computed along \
                 its dashes. " (explorer.note)
            }
        }
        script id="explorer-data" type="application/json" { (PreEscaped(&explorer.data)) }
        script { (PreEscaped(explorer::PROGRAM)) }
    }
}

fn render(block: &Block, pictures: &[&Drawn]) -> Markup {
    match block {
        Block::Heading(1, text) => html! { h1 { (text) } },
        Block::Heading(2, text) => html! { h2 { (text) } },
        Block::Heading(_, text) => html! { h3 { (text) } },
        Block::Paragraph(text) => html! { p { (inline(text)) } },
        Block::Code(_, code) => html! { pre { (code) } },
        Block::Figure(index, caption) => html! {
            figure {
                @match pictures[*index] {
                    Ok(picture) => {
                        img src={ "data:image/png;base64," (STANDARD.encode(picture)) } alt=(caption);
                    }
                    Err(fault) => p.fail { (fault) },
                }
                figcaption { (inline(caption)) }
            }
        },
        Block::Table(head, rows) => html! {
            div.wide {
                table {
                    @if head.iter().any(|cell| !cell.is_empty()) {
                        thead { tr { @for cell in head { th { (cell) } } } }
                    }
                    tbody { @for row in rows { tr { @for cell in row { td class=(class(cell)) { (inline(cell)) } } } } }
                }
            }
        },
    }
}

/// A text whose parts between backticks are code.
fn inline(words: &str) -> Markup {
    let parts: Vec<&str> = words.split('`').collect();
    // A backtick without another one is itself.
    if parts.len().is_multiple_of(2) {
        return html! { (words) };
    }
    html! {
        @for (position, part) in parts.iter().enumerate() {
            @if position % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

fn class(cell: &str) -> &'static str {
    let verdict = |word: &str| {
        let rest = cell.strip_prefix(word);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', ',', ':', ';']))
    };
    match cell {
        // Words after the verdict do not change it.
        _ if verdict("pass") => "pass",
        _ if verdict("FAIL") => "fail",
        _ if verdict("cannot be judged") => "open",
        number if number == "–" || number.parse::<f64>().is_ok() => "number",
        long if long.chars().count() > 28 => "long",
        _ => "",
    }
}
