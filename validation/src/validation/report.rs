//! The validation report: all checks in one table, the publication's claims, the cases.

use crate::results::{Block, Check, Figure, Results, Wanted, claims, limit};
use crate::units::number;

/// The report of one or several cases, and its pictures.
pub fn report(title: &str, cases: &[Results]) -> (Vec<Block>, Vec<Figure>) {
    let (mut blocks, mut figures) = (vec![Block::Heading(1, title.to_owned())], Vec::new());
    let checks = cases.iter().flat_map(|case| &case.outcome.checks);
    let (all, passed) = (
        checks.clone().count(),
        checks.filter(|check| check.passed()).count(),
    );
    blocks.push(Block::Paragraph(format!(
        "{passed} of {all} checks passed."
    )));
    blocks.extend(balance(cases).map(Block::Paragraph));
    let head = [
        "case",
        "quantity",
        "unit",
        "expected",
        "source",
        "computed",
        "error [%]",
        "uncertainty of the expected value [%]",
        "tolerance [%]",
        "result",
    ];
    let rows = cases.iter().flat_map(|case| {
        case.outcome
            .checks
            .iter()
            .map(|check| row(case.kind, check))
    });
    blocks.push(Block::Table(
        head.map(String::from).to_vec(),
        rows.collect(),
    ));
    blocks.extend(claims(cases.iter().flat_map(|case| &case.outcome.claims)));
    for case in cases {
        let outcome = &case.outcome;
        if outcome.blocks.is_empty() && outcome.figures.is_empty() {
            continue;
        }
        blocks.push(Block::Heading(2, case.title.clone()));
        blocks.extend(outcome.warning_paragraphs());
        // Pictures are numbered over all cases; those that have no place among the blocks follow them.
        let first = figures.len();
        let placed = outcome.blocks.iter().map(|block| match block {
            Block::Figure(index, caption) => Block::Figure(first + index, caption.clone()),
            other => other.clone(),
        });
        blocks.extend(placed);
        let mut case_blocks = outcome.blocks.iter();
        let are_placed = case_blocks.any(|block| matches!(block, Block::Figure(..)));
        let material = outcome.material.iter();
        blocks.extend(material.flat_map(|material| material.blocks.clone()));
        for figure in &outcome.figures {
            if !are_placed {
                blocks.push(Block::Figure(figures.len(), figure.caption.clone()));
            }
            figures.push(figure.clone());
        }
    }
    if let [case] = cases {
        blocks.extend(case.study());
    }
    (blocks, figures)
}

/// The worst balance of forces and moments over all cases.
fn balance(cases: &[Results]) -> Option<String> {
    let known = cases.iter();
    let known = known.filter_map(|case| Some((case.kind, case.outcome.balance?)));
    let (kind, worst) = known.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(format!(
        "Balance of forces and moments of supports and loads: the largest residual of all boundary value problems is \
         {worst:.1e} of the largest force or moment ({kind})."
    ))
}

fn row(case: &str, check: &Check) -> Vec<String> {
    let (expected, tolerance) = match check.wanted {
        Wanted::Equal(value, tolerance) => (limit(value), limit(tolerance)),
        Wanted::AtMost(most) => (format!("≤ {}", limit(most)), "–".into()),
        Wanted::AtLeast(least) => (format!("≥ {}", limit(least)), "–".into()),
    };
    vec![
        case.to_owned(),
        check.quantity.clone(),
        check.unit.to_owned(),
        expected,
        check.source.to_owned(),
        number(check.computed),
        check.error_percent().map_or("–".into(), number),
        check.own_error.map_or("–".into(), number),
        tolerance,
        check.result(),
    ]
}

/// How long the cases took: a document of its own, as the report says the same on every run.
pub fn times(cases: &[Results]) -> Vec<Block> {
    let mut rows = Vec::new();
    for case in cases {
        rows.push(vec![
            case.kind.to_owned(),
            "whole case".to_owned(),
            format!("{:.2}", case.seconds),
        ]);
        let parts = case.outcome.times.iter();
        rows.extend(parts.map(|(what, seconds)| {
            vec![case.kind.to_owned(), what.clone(), format!("{seconds:.3}")]
        }));
    }
    let head = ["case", "what", "time [s]"];
    vec![
        Block::Heading(1, "Times".into()),
        Block::Paragraph(
            "Times vary from run to run; the times within one case were measured side by side."
                .into(),
        ),
        Block::table(&head, rows),
    ]
}
