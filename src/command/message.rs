//! The texts that the command prints.

use miette::{
    GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report,
};
use textwrap::{WordSeparator, WordSplitter};

use super::fit_message;

use gelbench_base::error::{Diagnostic, Severity};
use gelbench_mechanics::material::Card;
use gelbench_mechanics::material::curve::{Mode, far_end};
use gelbench_mechanics::material::stability::{SEARCHED, stable_range};

/// Columns of a finding where no terminal says how many it has.
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
        // Paths and options stay whole.
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
    let range = match card.range_is_stated {
        true => format!("λ {low} … {high}"),
        false => String::new(),
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
    let along = if card.law.is_isotropic() {
        ""
    } else {
        " along the first axis"
    };
    format!("E₀ = {young:.6} MPa{along}, μ₀ = {shear:.6} MPa")
}

/// Density, resistance to a change of volume, viscosity and relaxation, as far as the card says them.
fn in_time(card: &Card) -> String {
    let mut text = String::new();
    if let Some(density) = card.density {
        text += &format!("  density    {:.6} kg/m³\n", 1e12 * density);
    }
    if let Some(modulus) = card.bulk_modulus() {
        let energy = match card.volume {
            Some(volume) => format!("{} energy", volume.energy.name()),
            None => "of the law itself".to_owned(),
        };
        text += &format!("  volume     bulk modulus κ = {modulus:.6} MPa, {energy}\n");
        if let Some([stretch, change]) = card.tension_by_volume() {
            let percent = 100.0 * change;
            text += &format!(
                "             uniaxial stress changes by at most {percent:+.2} %, at λ = {stretch:.2}, compared with constant volume\n"
            );
        }
    }
    let viscosity = &card.viscosity;
    if viscosity.shear_viscosity > 0.0 {
        let shear = 1e6 * viscosity.shear_viscosity;
        text += &format!("  viscosity  η = {shear:.6} Pa·s in parallel with the law\n");
    }
    for term in &viscosity.relaxation {
        let (share, time) = (100.0 * term.share, term.time);
        text += &format!("  relaxation {share:.4} % of the instantaneous stress in τ = {time} s\n");
    }
    for (what, range, unit) in [
        ("times", viscosity.covered.times, "s"),
        ("rates", viscosity.covered.rates, "1/s"),
    ] {
        if let Some([low, high]) = range {
            text += &format!("  relaxation measured at {what} of {low:.4} to {high:.4} {unit}\n");
        }
    }
    if !viscosity.relaxation.is_empty() {
        let at_once = viscosity.relaxation_function(0.0);
        text += &format!(
            "  relaxation the law is the long-term one; instantaneous stress is {at_once:.6} times as large\n"
        );
    }
    text
}

/// What unloading from some stretches dissipates, of a material that softens.
fn softening(card: &Card) -> String {
    let Some(softening) = card.law.softening() else {
        return String::new();
    };
    let far = far_end(card.stretch_range) - 1.0;
    let from = |share: f64| {
        let state = card.law.tension([1.0, 0.0], share * far);
        let most = state.energy;
        let [least, _] = softening.factor(0.0, most);
        format!(
            "  softening  unloading from λ = {:.3} in uniaxial tension: {:.4} of {:.4} kJ/m³ are dissipated, η falls to {least:.4}\n",
            1.0 + share * far,
            1e3 * softening.dissipated(most),
            1e3 * most,
        )
    };
    [0.5, 1.0].map(from).concat()
}

/// Everything about a card.
pub fn card(card: &Card) -> String {
    let mut text = format!(
        "{}\n\n  law        {}: {}\n",
        card.title,
        card.law_name,
        card.energy()
    );
    for parameter in &card.parameters {
        let (key, value, unit) = (parameter.key, parameter.value, parameter.unit());
        text += &format!("  parameter  {key} = {value} {unit}\n");
    }
    for (key, name) in &card.choices {
        text += &format!("  parameter  {key} = {name}\n");
    }
    for (name, statement) in card.law.statements() {
        text += &format!("  {name}: {statement}\n");
    }
    text += &format!("  moduli     {}\n", moduli(card));
    text += &in_time(card);
    text += &softening(card);
    text += &format!(
        "  measures   {} stress, {} strain, offset {}\n",
        card.stress_measure.name(),
        card.strain_measure.name(),
        card.offset.name()
    );
    text += &format!("  range      {}\n", card.describe_range());
    let [first, last] = SEARCHED;
    for (name, mode) in Mode::ALL {
        let [low, high] = stable_range(&*card.law, mode);
        text += &format!(
            "  stable     λ = {low:.3} … {high:.3} in {name} tests (Drucker, looked for from {first} to {last})\n"
        );
    }
    text += &fit_message::curves(&*card.law, card.stretch_range, &|_| "");
    text += &format!(
        "  specimen   {}\n  source     {}\n",
        card.specimen, card.citation
    );
    for (label, value) in [("doi", &card.doi), ("note", &card.note)] {
        if !value.is_empty() {
            text += &format!("  {label:<10} {value}\n");
        }
    }
    text
}
