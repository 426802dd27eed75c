//! What can be stated about a field besides its edges: the option of the command, and the label of the view.

use gelbench::error::Diagnostic;

use super::FieldQuestion;
use crate::logic::engine::Fault;

/// Something that can be stated about a field.
#[derive(Debug)]
pub struct Setting {
    /// The option of `gelbench correct`.
    pub option: &'static str,
    /// What the view calls it.
    pub label: &'static str,
    /// How it may be written.
    pub example: &'static str,
}

const fn setting(option: &'static str, label: &'static str, example: &'static str) -> Setting {
    Setting {
        option,
        label,
        example,
    }
}

/// The material.
pub const MATERIAL: Setting = setting("--material", "material", "pva-10");
/// Which way y points in the files.
pub const Y_AXIS: Setting = setting("--y-axis", "y axis of the file", "down");
/// What is written as text, in the order of [`FieldQuestion::texts`].
pub const TEXTS: [Setting; 5] = [
    setting("--thickness", "thickness at rest", "2 mm"),
    setting("--unit", "unit or pixel", "mm, or 0.05 mm"),
    setting("--columns", "columns", "x=x_px,y=y_px,ux=u,uy=v"),
    setting("--edge-gap", "gap to the edge", "1 mm"),
    setting("--cell-size", "size of cells", "by the markers"),
];

impl FieldQuestion {
    /// What is stated about the field as text, in the order of [`TEXTS`].
    pub fn texts(&mut self) -> [&mut String; 5] {
        [
            &mut self.thickness,
            &mut self.unit,
            &mut self.columns,
            &mut self.edge_gap,
            &mut self.cell_size,
        ]
    }
}

/// The library's words with the view's names in place of options; of options that the view has not, whose they are.
pub fn worded(text: &str) -> String {
    let mut words = String::with_capacity(text.len());
    let mut others: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(begin) = rest.find("--") {
        let (before, from) = rest.split_at(begin);
        let named = |letter: char| letter.is_ascii_lowercase() || letter == '-';
        let end = from.find(|letter| !named(letter)).unwrap_or(from.len());
        let (option, after) = from.split_at(end);
        words += before;
        match label(option) {
            Some(label) => words.extend(["“", label, "”"]),
            None => words += option,
        }
        if label(option).is_none() && option.len() > 2 && !others.contains(&option) {
            others.push(option);
        }
        rest = after;
    }
    words += rest;
    if !others.is_empty() {
        words += &format!("; the command `gelbench correct` has {}", others.join(", "));
    }
    words
}

fn label(option: &str) -> Option<&'static str> {
    let mut all = [&MATERIAL, &Y_AXIS].into_iter().chain(&TEXTS);
    all.find(|setting| setting.option == option)
        .map(|setting| setting.label)
}

/// A finding in the view's words.
pub fn warning_text(finding: &Diagnostic) -> String {
    Diagnostic {
        message: worded(&finding.message),
        hint: finding.hint.as_deref().map(worded),
        ..finding.clone()
    }
    .to_string()
}

/// A fault in the view's words.
pub fn fault(fault: Fault) -> Fault {
    Fault {
        message: worded(&fault.message),
        advice: worded(&fault.advice),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_called_what_the_view_calls_them() {
        for (text, expected) in [
            (
                "nothing of that kind -- at all",
                "nothing of that kind -- at all",
            ),
            (
                "choose a smaller --cell-size",
                "choose a smaller “size of cells”",
            ),
            (
                "(--unit, or --unit \"2 mm\")",
                "(“unit or pixel”, or “unit or pixel” \"2 mm\")",
            ),
            (
                "with --edge-gap LENGTH, --outline or --mesh, not --mesh-unit, nor --mesh",
                "with “gap to the edge” LENGTH, --outline or --mesh, not --mesh-unit, nor --mesh; \
                 the command `gelbench correct` has --outline, --mesh, --mesh-unit",
            ),
            ("", ""),
        ] {
            assert_eq!(worded(text), expected);
        }
    }
}
