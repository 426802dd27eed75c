//! The pictures that a study asks for.

use super::ModelKind;
use super::sections::read_models;
use crate::document::{Bound, Section};
use crate::results::{Palette, PictureFormat, PictureStyle, PictureWidth, SheetField, ShownFields};
use crate::statistics::farthest;
use crate::units::Dimension;

/// The pictures that a study wants.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// The quantities that are shown.
    pub fields: ShownFields,
    /// The models that are shown.
    pub models: Vec<ModelKind>,
    /// Where on the path.
    pub shown: Shown,
    /// How they are drawn.
    pub style: PictureStyle,
}

/// Where on a path fields are shown.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// At the last point that most models have reached.
    Last,
    /// Everywhere.
    All,
    /// At these points.
    At(Vec<f64>),
}

impl Default for Pictures {
    fn default() -> Self {
        Self {
            fields: ShownFields {
                fields: vec![SheetField::VonMises, SheetField::LargestPrincipalStress],
                range: None,
                title: None,
            },
            models: ModelKind::ALL.into(),
            shown: Shown::Last,
            style: PictureStyle::default(),
        }
    }
}

/// How close to a point of a path a point must be that the study asks for, to be taken for it.
fn tolerance(path: &[f64]) -> f64 {
    const SHARE: f64 = 1e-6;
    SHARE * farthest(path.iter().copied()).abs()
}

impl Pictures {
    /// Reads `[pictures]`. The points along the path, of one dimension, are under `key`; `path` has those that exist, or none where all do.
    pub fn read(section: &Section, key: &'static str, dimension: Dimension, path: &[f64]) -> Self {
        let fields = read_fields(section);
        let models = read_models(section);
        let shown = read_shown(section, key, dimension, path);
        let formats = section.choices("formats", &PictureFormat::NAMES);
        if formats.as_ref().is_some_and(Vec::is_empty) {
            section.fault("formats", "needs at least one format", "such as [\"png\"]");
        }
        let style = PictureStyle {
            formats: formats.unwrap_or_default(),
            width: section
                .choice("width", &PictureWidth::NAMES)
                .unwrap_or(PictureWidth::Screen),
            palette: section
                .choice("palette", &Palette::NAMES)
                .unwrap_or(Palette::Default),
            font_size: section.number("font_size", Bound::Within(5.0, 12.0)),
        };
        section.unknown_keys();
        Self {
            fields,
            models,
            shown,
            style,
        }
    }
}

/// The fields, the range of their colours and their heading, where these are stated.
fn read_fields(section: &Section) -> ShownFields {
    let fields = section.choices("fields", &SheetField::NAMES);
    let fields = fields.unwrap_or_default();
    let dimension = fields
        .first()
        .map_or(Dimension::Stress, |field| field.dimension());
    let (word, range) = section.quantities_or(&["automatic"], "range", dimension);
    let range = match range[..] {
        _ if word.is_some() => None,
        [low, high] if low < high => Some([low, high]),
        _ => {
            let hint = "write the lower and the upper end, such as [\"0 MPa\", \"1 MPa\"]";
            section.fault("range", "must be two ascending values", hint);
            None
        }
    };
    if range.is_some() && fields.len() > 1 {
        let hint = "choose one field, such as fields = [\"cauchy-xx\"]";
        section.fault("range", "is the range of one field", hint);
    }
    let title = section.heading("title");
    ShownFields {
        fields,
        range,
        title: (title != "automatic").then_some(title),
    }
}

fn read_shown(section: &Section, key: &'static str, dimension: Dimension, path: &[f64]) -> Shown {
    let words = [("last", Shown::Last), ("all", Shown::All)];
    let (word, wanted) = section.quantities_or(&["last", "all"], key, dimension);
    if let Some((_, shown)) = words.into_iter().find(|(name, _)| Some(*name) == word) {
        return shown;
    }
    let tolerance = tolerance(path);
    let on_path = |wanted: &f64| path.iter().any(|at| (at - wanted).abs() <= tolerance);
    let unknown = wanted.iter().find(|at| at.is_finite() && !on_path(at));
    if let Some(unknown) = unknown.filter(|_| !path.is_empty()) {
        let known: Vec<_> = path
            .iter()
            .take(MOST_NAMED)
            .map(ToString::to_string)
            .collect();
        let more = if path.len() > MOST_NAMED { ", …" } else { "" };
        let hint = format!("the study has {}{more}", known.join(", "));
        section.fault(
            key,
            &format!("{unknown} is not on the path of the study"),
            &hint,
        );
    }
    Shown::At(wanted)
}

/// How many points of a path are named where a study asks for another one.
const MOST_NAMED: usize = 12;

impl Shown {
    /// The steps of a path that are shown, where `last` is the one of which most can be shown.
    pub fn steps(&self, path: &[f64], last: Option<usize>) -> Vec<usize> {
        let tolerance = tolerance(path);
        let is_wanted =
            |at: f64, wanted: &[f64]| wanted.iter().any(|one| (at - one).abs() <= tolerance);
        match self {
            Self::Last => last.into_iter().collect(),
            Self::All => (0..path.len()).collect(),
            Self::At(wanted) => (0..path.len())
                .filter(|step| is_wanted(path[*step], wanted))
                .collect(),
        }
    }

    /// The instants that are shown: those next to what is asked for.
    pub fn instants(&self, times: &[f64]) -> Vec<usize> {
        let next_to = |wanted: &f64| {
            let distance = |instant: &usize| (times[*instant] - wanted).abs();
            (0..times.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        match self {
            Self::At(wanted) => {
                let mut indices: Vec<usize> = wanted.iter().filter_map(next_to).collect();
                indices.sort_unstable();
                indices.dedup();
                indices
            }
            other => other.steps(times, times.len().checked_sub(1)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_those_of_the_path() {
        let path = [0.15, 0.3, 0.1 + 0.4];
        assert_eq!(Shown::Last.steps(&path, Some(1)), [1]);
        assert_eq!(Shown::Last.steps(&path, None), [0; 0]);
        assert_eq!(Shown::All.steps(&path, Some(1)), [0, 1, 2]);
        assert_eq!(Shown::At(vec![0.5, 0.15]).steps(&path, Some(1)), [0, 2]);
        assert_eq!(Shown::At(vec![9.0, 0.2, 0.16]).instants(&path), [0, 2]);
        assert_eq!(Shown::Last.instants(&path), [2]);
    }
}
