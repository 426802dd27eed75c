//! `gelbench keys`, `gelbench schema` and the studies of `gelbench new`: what the readers themselves ask for.

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::ValueEnum;

use super::terminal::{Outcome, print, print_data};
use crate::kinds;
use gelbench_base::document::{Bound, FoundKey, Key, Presence, Takes, comments, explore};
use gelbench_base::error::Error;
use gelbench_base::units::Dimension;
use gelbench_mechanics::material::Card;
use gelbench_report::output;
use gelbench_report::results::limit;
use gelbench_studies::studies::{Kind, markers, plate};

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FileKind {
    /// A study of a clamped plate
    Plate,
    /// A study of a specimen of any shape
    Specimen,
    /// A study of a plate in motion
    Motion,
    /// A study of a specimen of any shape in motion
    MovingSpecimen,
    /// What is known about measured markers besides their displacements
    Markers,
    /// A material card
    Card,
}

impl FileKind {
    /// All, in the order of the reference.
    pub const ALL: [Self; 6] = [
        Self::Plate,
        Self::Specimen,
        Self::Motion,
        Self::MovingSpecimen,
        Self::Markers,
        Self::Card,
    ];

    fn case(self) -> Option<&'static Kind> {
        kinds::named(match self {
            Self::MovingSpecimen => Self::Motion.name(),
            other => other.name(),
        })
    }

    /// The file that comes along, with remarks.
    pub fn template(self) -> &'static str {
        match (self, self.case()) {
            (
                Self::MovingSpecimen,
                Some(Kind {
                    of_shape: Some((_, study)),
                    ..
                }),
            ) => study,
            (_, Some(case)) => case.study,
            (Self::Markers, _) => markers::TEMPLATE,
            (Self::Card, _) => include_str!("new_card.toml"),
            _ => plate::DEFAULT,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plate => "plate",
            Self::Specimen => "specimen",
            Self::Motion => "motion",
            Self::MovingSpecimen => "moving-specimen",
            Self::Markers => "markers",
            Self::Card => "card",
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Plate => "Plates: `kind = \"plate\"`, or no kind",
            Self::Specimen => "Specimens: `kind = \"specimen\"`",
            Self::Motion => "Motions of plates: `kind = \"motion\"` with `[plate]`",
            Self::MovingSpecimen => "Motions of specimens: `kind = \"motion\"` with `[specimen]`",
            Self::Markers => "Measured markers: the file of `correct --study`",
            Self::Card => "Material cards",
        }
    }

    /// Every key that its reader asks for.
    pub fn keys(self) -> Vec<FoundKey> {
        let read = |text: &str| -> Vec<Key> {
            match (self, self.case()) {
                (Self::MovingSpecimen, Some(case)) if !text.contains("[specimen]") => {
                    kinds::keys(case, &format!("{text}[specimen]\n"))
                }
                (_, Some(case)) => kinds::keys(case, text),
                (Self::Markers, _) => markers::keys(text),
                (Self::Card, _) => Card::keys(text),
                _ => plate::keys(text),
            }
        };
        explore(&read)
    }
}

/// Writes the file that comes along under a new name.
pub fn write(name: PathBuf, kind: FileKind) -> Outcome {
    let name: PathBuf = name.components().collect();
    let path = match name.extension() {
        Some(extension) if extension == "toml" => name,
        _ => PathBuf::from(format!("{}.toml", name.display())),
    };
    if path.exists() {
        let cause = "it exists already; choose another name or remove it first";
        return Err(Error::write(path, cause));
    }
    output::save(&path, kind.template().as_bytes())?;
    // As a shell takes it.
    let shown = match path.display().to_string() {
        plain if !plain.contains(char::is_whitespace) => plain,
        spaced => format!("\"{spaced}\""),
    };
    let next = match kind {
        FileKind::Markers => format!(
            "use it with: gelbench correct FIELD --material CARD --thickness LENGTH --study {shown}"
        ),
        FileKind::Card => format!("look at it with: gelbench materials show {shown}"),
        _ => format!("compute it with: gelbench run {shown}"),
    };
    print(&format!("{shown} written; {next}\n"))?;
    Ok(0)
}

/// Prints the reference of one kind of files, or of all.
pub fn print_keys(kind: Option<FileKind>) -> Outcome {
    print_data(&match kind {
        Some(kind) => reference(&[kind]),
        None => reference(&FileKind::ALL),
    })?;
    Ok(0)
}

/// The reference of some kinds of files as Markdown.
pub fn reference(kinds: &[FileKind]) -> String {
    let mut text = String::from(
        "Every key of studies, of files with known conditions for markers, and of material cards. This page is the output of \
         `gelbench keys`, generated by the program's own readers.\n\n| quantity | units |\n|---|---|\n",
    );
    for dimension in Dimension::ALL {
        let units: Vec<_> = dimension.units().map(|unit| format!("`{unit}`")).collect();
        let bare = match dimension {
            Dimension::Ratio => ", or a bare number",
            _ => "",
        };
        text += &format!("| {} | {}{bare} |\n", dimension.name(), units.join(", "));
    }
    for kind in kinds {
        text += &format!("\n# {}\n", kind.title());
        text += &of_kind(*kind);
    }
    text
}

fn of_kind(kind: FileKind) -> String {
    let (keys, remarks) = (kind.keys(), comments(kind.template()));
    let mut tables: Vec<(&str, Vec<&FoundKey>)> = Vec::new();
    for found in &keys {
        let table = found
            .key
            .path
            .rsplit_once('.')
            .map_or("", |(table, _)| table);
        match tables.iter_mut().find(|(known, _)| *known == table) {
            Some((_, rows)) => rows.push(found),
            None => tables.push((table, vec![found])),
        }
    }
    let mut text = String::new();
    for (table, rows) in tables {
        let rows: Vec<_> = rows.into_iter().filter(|row| !is_table(&row.key)).collect();
        if rows.is_empty() {
            continue;
        }
        text += &match table.strip_suffix("[]") {
            _ if table.is_empty() => "\n## At the top\n\n".to_owned(),
            Some(list) => format!("\n## `[[{}]]`\n\n", list.replace("[]", "")),
            None => format!("\n## `[{}]`\n\n", table.replace("[]", "")),
        };
        if let Some(remark) = remarks.get(table) {
            text += &format!("{}\n\n", sentence(remark));
        }
        text += "| key | takes | default | |\n|---|---|---|---|\n";
        text.extend(rows.into_iter().map(|row| line(row, &remarks)));
    }
    text
}

fn is_table(key: &Key) -> bool {
    matches!(key.takes.first(), Some(Takes::Section | Takes::Sections))
}

fn sentence(remark: &str) -> String {
    let mut letters = remark.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    let end = if remark.ends_with('.') { "" } else { "." };
    format!("{}{}{end}", first.unwrap_or_default(), letters.as_str())
}

fn line(found: &FoundKey, remarks: &BTreeMap<String, String>) -> String {
    let FoundKey { key, only_with } = found;
    let name = key.path.rsplit('.').next().unwrap_or_default();
    let takes: Vec<String> = key.takes.iter().map(takes).collect();
    let example = key.example.clone();
    let example = example.unwrap_or_else(|| key.takes.first().map_or(String::new(), example_of));
    let default = match key.presence {
        Presence::Default => format!("`{example}`"),
        Presence::Required => format!("must be stated, such as `{example}`"),
        Presence::Optional => format!("none; such as `{example}`"),
    };
    let only = only_with.as_ref().map(|(choice, names)| {
        let choice = choice.rsplit('.').next().unwrap_or_default();
        let names: Vec<_> = names.iter().map(|name| format!("`\"{name}\"`")).collect();
        format!("with `{choice}` {}", names.join(", "))
    });
    let remark = remarks.get(&key.path).cloned();
    let about: Vec<String> = only.into_iter().chain(remark).collect();
    let about = about.join(": ").replace('|', "\\|");
    format!(
        "| `{name}` | {} | {default} | {about} |\n",
        takes.join(", or ")
    )
}

/// What a key takes, in words.
fn takes(takes: &Takes) -> String {
    let whole = |[low, high]: &[usize; 2]| {
        if *high > 1 << 40 {
            format!("from {low}")
        } else {
            format!("from {low} to {high}")
        }
    };
    match takes {
        Takes::Text => "text".to_owned(),
        Takes::Texts => "list of texts".to_owned(),
        Takes::Flag => "`true` or `false`".to_owned(),
        Takes::Choice(names) => {
            let names: Vec<_> = names.iter().map(|name| format!("`\"{name}\"`")).collect();
            names.join(", ")
        }
        Takes::Choices(names) => {
            let names: Vec<_> = names.iter().map(|name| format!("`\"{name}\"`")).collect();
            format!("list of {}", names.join(", "))
        }
        Takes::Count(limits) => format!("whole number {}", whole(limits)),
        Takes::Counts(limits, word) => {
            let word = word.as_ref().map(|word| format!(", or `\"{word}\"`"));
            format!(
                "two whole numbers {}{}",
                whole(limits),
                word.unwrap_or_default()
            )
        }
        Takes::Number(bound) => format!("number{}", range(*bound, "")),
        Takes::Quantity(dimension, bound) => {
            format!(
                "{}{}",
                dimension.name(),
                range(*bound, dimension.internal_unit())
            )
        }
        Takes::Quantities(dimension, bound) => {
            let range = range(*bound, dimension.internal_unit());
            format!("list, each a {}{range}", dimension.name())
        }
        Takes::Unit(dimension) => format!("unit of {}", dimension.name()),
        Takes::LinearLength => {
            "length, or a linear function of the position: `\"2 mm + 0.1 * X\"`".to_owned()
        }
        Takes::Section => "table".to_owned(),
        Takes::Sections => "list of tables".to_owned(),
    }
}

fn range(bound: Bound, unit: &str) -> String {
    match bound {
        Bound::Any => String::new(),
        Bound::Positive => " > 0".to_owned(),
        Bound::NonNegative => " ≥ 0".to_owned(),
        Bound::Within(low, high) => {
            let range = format!(", {} to {} {unit}", limit(low), limit(high));
            range.trim_end().to_owned()
        }
        Bound::Range(_, _, words) => format!(", {words}"),
    }
}

/// A value that suits, where no file that comes along has one.
fn example_of(takes: &Takes) -> String {
    match takes {
        Takes::Text => "\"…\"".to_owned(),
        Takes::Texts => "[\"…\"]".to_owned(),
        Takes::Flag => "true".to_owned(),
        Takes::Choice(names) => names
            .first()
            .map_or(String::new(), |name| format!("\"{name}\"")),
        Takes::Choices(names) => {
            let first = names.first();
            first.map_or("[]".to_owned(), |name| format!("[\"{name}\"]"))
        }
        Takes::Count([low, _]) => low.to_string(),
        Takes::Counts([low, _], _) => format!("[{low}, {low}]"),
        Takes::Number(bound) if bound.ends()[0] > 1.0 => "2.0".to_owned(),
        Takes::Number(_) => "1.0".to_owned(),
        Takes::Quantity(dimension, _) => quoted_example(*dimension),
        Takes::Quantities(dimension, _) => format!("[{}]", quoted_example(*dimension)),
        Takes::Unit(dimension) => format!("\"{}\"", dimension.units().next().unwrap_or_default()),
        Takes::LinearLength => "\"2 mm\"".to_owned(),
        Takes::Section | Takes::Sections => String::new(),
    }
}

fn quoted_example(dimension: Dimension) -> String {
    let example = dimension.example();
    example.rsplit(" or ").next().unwrap_or(example).to_owned()
}
