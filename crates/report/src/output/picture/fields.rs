//! Fields on deformed plates, one below the other on one colour scale.

use super::bar::Bar;
use super::canvas::{EDGE, GAP, Sheet, render};
use super::layout::{LABEL_HEIGHT, Layout};
use super::look::Look;
use super::marks::{Align, DrawResult, Mark, Pen, Size};
use super::paint::Painter;
use crate::results::{FieldFigure, Panel, PictureFormat, Values};

/// The width of the outlines of the sheet, deformed and at rest, and of lines of equal values.
const OUTLINE: f32 = 0.8;
const AT_REST: f32 = 0.7;
const CONTOUR: f32 = 0.5;

/// The opacity of lines of equal values, up to 255.
const CONTOUR_OPACITY: u8 = 110;

/// The remark on the outlines at rest.
const REST: &str = "thin lines: at rest";

/// Fields on so many triangles at most have contour lines.
const MOST_CONTOURED: usize = 400_000;

/// Where everything is in a picture of fields.
pub(super) struct Plan {
    layout: Layout,
    bar: Bar,
    /// The position of the remark on the outlines at rest.
    rest: Option<([f64; 2], Align)>,
}

impl Plan {
    /// Width and height in points.
    pub fn size(&self) -> Size {
        (self.layout.width as u32, self.bar.bottom as u32)
    }
}

impl FieldFigure {
    /// The figure as a file.
    pub(super) fn drawn(&self, look: Look, format: PictureFormat) -> DrawResult<Vec<u8>> {
        let plan = self.plan(look, self.panels.len())?;
        let paint = |painter: &mut Painter| self.paint(painter, &plan);
        render(plan.size(), look, format, paint, self.marks(&plan))
    }

    /// The plan of so many panels below one another, with the colours of all that there are.
    pub(super) fn plan(&self, look: Look, panels: usize) -> DrawResult<Plan> {
        if panels == 0 || self.panels.is_empty() {
            return Err("it has no panels".into());
        }
        let surfaces = self.panels.iter().map(|panel| &panel.surface);
        let positions = surfaces.flat_map(|surface| {
            let rest = surface.rest.iter().flatten();
            surface.points.iter().chain(rest).copied()
        });
        let name = |panel: &Panel| look.name().width(&panel.label);
        let names = self.panels.iter().map(name).fold(0.0, f64::max);
        let rest = look.number().width(REST);
        let least = names + 2.0 * GAP + rest;
        let layout = Layout::of(look, &self.title, least, positions);
        let has_rest = !self.panels[0].surface.rest.is_empty();
        let right = layout.width - EDGE;
        let mut bottom = layout.bottom(panels);
        let above = [layout.right(), layout.top + 0.5 * LABEL_HEIGHT];
        let rest = if layout.left + least <= layout.right() {
            (above, Align::Right)
        } else {
            let below = [layout.left, bottom + 0.5 * look.number().line_height()];
            bottom += look.number().line_height() * f64::from(u8::from(has_rest));
            (below, Align::Left)
        };
        let room = [layout.left, bottom + GAP, layout.right(), right];
        let bar = Bar::of(
            look,
            &self.panels,
            &self.quantity,
            (self.scale, self.range),
            room,
        );
        Ok(Plan {
            layout,
            bar,
            rest: has_rest.then_some(rest),
        })
    }

    /// What is written around the plates, by a plan which may be that of several figures.
    pub(super) fn marks(&self, plan: &Plan) -> Vec<Mark> {
        let layout = &plan.layout;
        let look = layout.look;
        let mut sheet = Sheet::new(look);
        layout.draw(&mut sheet, &self.title, self.panels.len());
        for (index, panel) in self.panels.iter().enumerate() {
            let position = [layout.left, layout.panel_top(index) + 0.5 * LABEL_HEIGHT];
            let room = layout.width - EDGE - layout.left;
            let label = short(&panel.label, room, look);
            sheet.write(label, position, Align::Left, look.name());
        }
        if let Some((at, align)) = plan.rest {
            sheet.write(REST, at, align, look.number());
        }
        plan.bar.draw(&mut sheet);
        sheet.marks
    }

    /// Paints the colour bar and the plates.
    pub(super) fn paint(&self, painter: &mut Painter, plan: &Plan) {
        let Plan { layout, bar, .. } = plan;
        let look = layout.look;
        let range = &bar.range;
        let table = look.bar(range.is_signed);
        bar.paint(painter, &table);
        // At zero a field of both signs is white, and noise would draw lines there.
        let ticks = bar.ticks.at.iter();
        let levels: Vec<f64> = ticks
            .filter(|(at, _)| !(range.is_signed && at.abs() < 1e-12))
            .map(|(at, _)| self.scale.value(*at))
            .collect();
        let share = |value: f64| {
            if value.is_nan() {
                f64::NAN
            } else {
                range.share(self.scale.position(value).unwrap_or(range.low))
            }
        };
        let contour = Pen::new([0; 3], CONTOUR).with_opacity(CONTOUR_OPACITY);
        for (index, panel) in self.panels.iter().enumerate() {
            let rest = layout.placed(index, &panel.surface.rest);
            let pen = Pen::new(look.rest(), AT_REST);
            if let Some(rest) = Mark::lines(rest.iter().map(|line| &line[..]), pen) {
                painter.draw(&rest);
            }
            let mut contours = Vec::new();
            let triangles = panel.surface.triangles.iter();
            for (triangle, values) in triangles.zip(panel.corners()) {
                let corners = triangle
                    .map(|point| layout.position(index, panel.surface.points[point as usize]));
                painter.shade(corners, values, &share, &table);
                if has_contours(panel) {
                    let levels = levels.iter();
                    contours.extend(levels.filter_map(|at| crossing(corners, values, *at)));
                }
            }
            painter.lines_above(contours.iter().map(|line| &line[..]), contour);
            let outline = layout.placed(index, &panel.surface.outline);
            let pen = Pen::new(look.ink(), OUTLINE);
            painter.lines_above(outline.iter().map(|line| &line[..]), pen);
        }
    }
}

/// A label without the brackets at its end, where the complete label has no room.
fn short(words: &str, width: f64, look: Look) -> &str {
    match words.split_once(" (") {
        Some((begin, _)) if look.name().width(words) > width => begin,
        _ => words,
    }
}

fn has_contours(panel: &Panel) -> bool {
    let is_smooth = matches!(panel.values, Values::AtPoints(_));
    is_smooth && panel.surface.triangles.len() <= MOST_CONTOURED
}

/// The line within a triangle on which a linear field has a value.
fn crossing(corners: [[f64; 2]; 3], values: [f64; 3], level: f64) -> Option<[[f64; 2]; 2]> {
    let on_edge = |[from, to]: [usize; 2]| {
        let crosses = (values[from] < level) != (values[to] < level);
        let along = (level - values[from]) / (values[to] - values[from]);
        let [a, b] = [from, to].map(|corner| corners[corner]);
        (crosses && along.is_finite())
            .then(|| [0, 1].map(|axis| a[axis] + along * (b[axis] - a[axis])))
    };
    let mut positions = [[0, 1], [1, 2], [2, 0]].into_iter().filter_map(on_edge);
    Some([positions.next()?, positions.next()?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contour_line_runs_where_a_linear_field_has_its_value() {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let line = crossing(corners, [0.0, 4.0, 0.0], 1.0).unwrap();
        assert_eq!(line, [[1.0, 0.0], [1.0, 3.0]]);
        assert_eq!(crossing(corners, [0.0, 4.0, 0.0], 5.0), None);
        assert_eq!(crossing(corners, [f64::NAN, 4.0, 0.0], 1.0), None);
    }
}
