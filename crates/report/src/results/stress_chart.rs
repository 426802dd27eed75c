//! Charts of stresses in a unit that suits them.

use super::{Axis, Line, LineChart};

/// A chart of stresses in MPa, in the unit in which the largest of them, in MPa too, is neither long nor tiny.
pub fn stress_chart(
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
