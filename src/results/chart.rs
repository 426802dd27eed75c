//! Line charts as data, without the way of drawing them.

use serde::{Deserialize, Serialize};

use crate::material::scalar_function::ScalarFunction;

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

    /// A linear axis.
    pub fn linear(label: &str) -> Self {
        Self::new(label, Scale::Linear)
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

/// The style of a line.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Stroke {
    /// A line with a marker at each point.
    Marked,
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

/// Computed points and, between them, cubics that keep their shape (those of [`ScalarFunction::table`]).
fn curve_through(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    const PARTS: i32 = 16;
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let Ok(cubics) = ScalarFunction::table(points.clone()) else {
        return points;
    };
    let between = points.windows(2).flat_map(|pair| {
        let ([from, _], [to, _]) = (pair[0], pair[1]);
        let place = move |part| from + (to - from) * f64::from(part) / f64::from(PARTS);
        let amid = (1..PARTS).map(place).map(|x| [x, cubics.at(x)[0]]);
        [pair[0]].into_iter().chain(amid)
    });
    between.chain(points.last().copied()).collect()
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

    /// Computed points, or the curve through them: cubics that keep their shape.
    pub fn curve(label: &str, points: Vec<[f64; 2]>, colour: [u8; 3], stroke: Stroke) -> Self {
        let points = match stroke {
            Stroke::Points => points,
            _ => curve_through(points),
        };
        Self::new(label, points, colour, stroke)
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
}

impl LineChart {
    /// A chart without a band.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, lines: Vec<Line>) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            lines,
            band: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_through_its_points_and_nowhere_beyond_them() {
        let points = vec![[0.0, 0.0], [1.0, 1.0], [1.5, 5.0], [4.0, 5.5]];
        let curve = curve_through(points.clone());
        assert!(points.iter().all(|point| curve.contains(point)));
        assert!(curve.len() > 40 && curve.windows(2).all(|pair| pair[1][1] >= pair[0][1]));
        // A path to negative load factors.
        let mirrored = points.iter().map(|[x, y]| [-x, -y]).collect();
        let other: Vec<_> = curve_through(mirrored).into_iter().rev().collect();
        let differences = curve.iter().zip(&other);
        for ([x, y], [a, b]) in differences {
            assert!((x + a).abs() < 1e-12 && (y + b).abs() < 1e-12);
        }
        assert_eq!(curve_through(vec![[0.0, 0.0]]), [[0.0, 0.0]]);
        assert_eq!(curve_through(Vec::new()), [[0.0; 2]; 0]);
    }
}
