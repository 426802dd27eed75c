//! Line charts as data, without the way of drawing them.

use serde::{Deserialize, Serialize};

/// Colours that most people can distinguish (Okabe and Ito).
pub const PALETTE: [[u8; 3]; 6] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
];

/// The scale of an axis or a colour bar.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Scale {
    /// A linear scale.
    Linear,
    /// A linear scale, with zero only where the values reach it: an axis of stretches.
    Interval,
    /// A logarithmic scale.
    Logarithmic,
}

/// One axis.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Axis {
    /// The quantity, with its unit.
    pub label: String,
    /// The scale.
    pub scale: Scale,
}

impl Axis {
    /// An axis with a label.
    pub fn new(label: &str, scale: Scale) -> Self {
        Self {
            label: label.to_owned(),
            scale,
        }
    }

    /// An axis of stretches.
    pub fn stretch() -> Self {
        Self::new("stretch λ [–]", Scale::Interval)
    }

    /// A logarithmic axis.
    pub fn logarithmic(label: &str) -> Self {
        Self::new(label, Scale::Logarithmic)
    }
}

/// A linear axis.
impl From<&str> for Axis {
    fn from(label: &str) -> Self {
        Self::new(label, Scale::Linear)
    }
}

/// The style of a line.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Stroke {
    /// Computed points as markers. The thin straight dashes between them only lead the eye: nothing was computed there.
    Marked,
    /// The same with rings, inside of which the markers of another line can be seen.
    Ringed,
    /// A line.
    Solid,
    /// A thin line, for curves that overlap themselves.
    Thin,
    /// A dashed line.
    Dashed,
    /// Markers alone.
    Points,
    /// A pale area; its points are the outline.
    Filled,
}

/// Computed points of a path that begins at rest, where nothing acts and nothing has moved, with that point among them: between
/// points of both signs, else first.
pub fn from_rest(points: impl IntoIterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = points.into_iter().collect();
    let rest = if points.is_sorted_by_key(|[x, _]| *x) {
        points.partition_point(|[x, _]| *x < 0.0)
    } else {
        0
    };
    if points.get(rest).is_none_or(|[x, _]| *x != 0.0) {
        points.insert(rest, [0.0; 2]);
    }
    points
}

/// One line of a chart.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Line {
    /// Its name in the legend; a line with an empty name is not in the legend.
    pub label: String,
    /// Its points.
    pub points: Vec<[f64; 2]>,
    /// Its colour as red, green, blue.
    pub colour: [u8; 3],
    /// The style of the line.
    pub stroke: Stroke,
}

impl Line {
    /// A line through points.
    pub fn new(
        label: impl Into<String>,
        points: impl IntoIterator<Item = [f64; 2]>,
        colour: [u8; 3],
        stroke: Stroke,
    ) -> Self {
        Self {
            label: label.into(),
            points: points.into_iter().collect(),
            colour,
            stroke,
        }
    }

    /// Whether dashes join its points, between which nothing was computed.
    pub fn is_dashed_between_points(&self) -> bool {
        matches!(self.stroke, Stroke::Marked | Stroke::Ringed)
    }

    /// A curve that is solid within a range of x and dashed outside of it.
    pub fn within(
        label: &str,
        points: &[[f64; 2]],
        colour: [u8; 3],
        [low, high]: [f64; 2],
    ) -> Vec<Self> {
        let below = points.iter().take_while(|point| point[0] < low).count();
        let inside = points.iter().filter(|point| point[0] <= high).count();
        let above = inside.max(below);
        // The dashed parts begin where the solid one ends.
        let parts = [
            (&points[..(below + 1).min(points.len())], "", Stroke::Dashed),
            (&points[below..above], label, Stroke::Solid),
            (&points[above.saturating_sub(1)..], "", Stroke::Dashed),
        ];
        let drawn = parts
            .into_iter()
            .filter(|(points, _, stroke)| points.len() > 1 || *stroke == Stroke::Solid);
        drawn
            .map(|(points, label, stroke)| Self::new(label, points.iter().copied(), colour, stroke))
            .collect()
    }
}

/// A line chart.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct LineChart {
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// The lines; later ones lie above.
    pub lines: Vec<Line>,
    /// A band along x that is shaded, with its name.
    pub band: Option<([f64; 2], String)>,
    /// Remarks in the legend, beside the names of the lines.
    pub notes: Vec<String>,
}

impl LineChart {
    /// A chart without a band.
    pub fn new(
        title: impl Into<String>,
        x: impl Into<Axis>,
        y: impl Into<Axis>,
        lines: Vec<Line>,
    ) -> Self {
        Self {
            title: title.into(),
            x: x.into(),
            y: y.into(),
            lines,
            band: None,
            notes: Vec::new(),
        }
    }

    /// The note of a legend on the dashes between markers; `None` where there are none.
    pub fn dashes(&self) -> Option<&'static str> {
        let joins = |line: &Line| line.is_dashed_between_points() && line.points.len() > 1;
        let any = self.lines.iter().any(joins);
        any.then_some("dashes: nothing computed")
    }
}

/// A chart of stresses in MPa, in the unit in which the largest of them, in MPa too, is neither long nor tiny.
pub(super) fn stress_chart(
    title: impl Into<String>,
    x: Axis,
    stress: &str,
    largest: f64,
    mut lines: Vec<Line>,
) -> LineChart {
    const UNITS: [(&str, f64); 3] = [("MPa", 1.0), ("kPa", 1e3), ("Pa", 1e6)];
    let large = UNITS.into_iter().find(|(_, per)| per * largest >= 0.1);
    let (unit, per_mpa) = large.unwrap_or(UNITS[2]);
    for point in lines.iter_mut().flat_map(|line| &mut line.points) {
        point[1] *= per_mpa;
    }
    LineChart::new(title, x, &*format!("{stress} [{unit}]"), lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_from_rest_has_its_rest_once_between_points_of_both_signs_or_first() {
        assert_eq!(from_rest([[0.5, 2.0]]), [[0.0, 0.0], [0.5, 2.0]]);
        assert_eq!(from_rest([]), [[0.0, 0.0]]);
        let both = [[-0.2, -1.0], [0.1, 0.4]];
        assert_eq!(from_rest(both), [both[0], [0.0; 2], both[1]]);
        let kept = [[-0.2, -1.0], [0.0, 0.0], [0.1, 0.4]];
        assert_eq!(from_rest(kept), kept);
        // Loading and unloading: in the order of the path.
        let back = [[0.5, 2.0], [1.0, 5.0], [0.5, 1.0]];
        assert_eq!(from_rest(back)[..2], [[0.0; 2], back[0]]);
        let pressed = [[-0.1, -1.0], [-0.3, -4.0]];
        assert_eq!(from_rest(pressed)[..2], [[0.0; 2], pressed[0]]);
    }
}
