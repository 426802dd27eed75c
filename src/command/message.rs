//! The texts that the command prints.

use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report,
};
use textwrap::{WordSeparator, WordSplitter};

use super::fit_message;

use gelbench_base::error::{Diagnostic, Severity};
use gelbench_mechanics::material::Card;
use gelbench_report::results::properties;

/// Columns of a finding where no terminal states how many it has.
const USUAL_COLUMNS: usize = 80;

/// A finding with the lines of the file that it is about.
pub fn diagnostic(finding: &Diagnostic, coloured: bool, columns: Option<usize>) -> String {
    let message = match finding.key.as_str() {
        "" => finding.message.clone(),
        key => format!("{key}: {}", finding.message),
    };
    let severity = match finding.severity {
        Severity::Warning => miette::Severity::Warning,
        Severity::Error => miette::Severity::Error,
    };
    let mut report = MietteDiagnostic::new(message).with_severity(severity);
    if let Some(hint) = &finding.hint {
        report = report.with_help(hint.clone());
    }
    let report = match &finding.position {
        None => Report::new(report),
        // The key is not in the file: there is no line to show.
        Some((source, span)) if span.is_empty() => {
            report.message = format!("{}: {}", source.name, report.message);
            Report::new(report)
        }
        Some((source, span)) => {
            let label = LabeledSpan::new(None, span.start, span.len());
            let source = NamedSource::new(&source.name, source.text.clone());
            Report::new(report.with_label(label)).with_source_code(source)
        }
    };
    let theme = if coloured {
        GraphicalTheme::unicode()
    } else {
        GraphicalTheme::unicode_nocolor()
    };
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(columns.unwrap_or(USUAL_COLUMNS))
        // Paths and options are not broken.
        .with_word_separator(WordSeparator::AsciiSpace)
        .with_word_splitter(WordSplitter::NoHyphenation)
        .with_break_words(false)
        .with_context_lines(1);
    match handler.render_report(&mut text, report.as_ref()) {
        Ok(()) => text,
        Err(_) => format!("{finding}\n"),
    }
}

/// One line of the list of cards.
pub fn card_line(card: &Card) -> String {
    let [low, high] = card.stretch_range;
    let range = if card.range_is_stated {
        format!("λ {low} … {high}")
    } else {
        String::new()
    };
    format!(
        "{:<18} {:<20} {range:<20} {}\n",
        card.name, card.law_name, card.title
    )
}

/// A card's name and small-strain moduli.
pub fn moduli_line(card: &Card) -> String {
    format!("{:<16} {}\n", card.name, moduli(card))
}

fn moduli(card: &Card) -> String {
    let (young, shear) = (card.youngs_modulus(), card.law.shear_modulus());
    format!("E₀ = {young:.6} MPa{}, μ₀ = {shear:.6} MPa", along(card))
}

/// The direction of a Young's modulus, where there are several.
pub fn along(card: &Card) -> &'static str {
    if card.law.is_isotropic() {
        ""
    } else {
        " along the first axis"
    }
}

/// Everything about a card.
pub fn card(card: &Card) -> String {
    let curves = fit_message::curves(&*card.law, card.stretch_range, &|_| "");
    format!("{}\n\n{}\n{curves}", card.title, properties(card).plain())
}
