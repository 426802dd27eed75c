//! Fields on deformed plates, several side by side on one colour scale.

use plotters::style::RGBColor;
use plotters::style::text_anchor::HPos;

use super::canvas::{Area, render};
use super::colours::Range;
use super::design::DrawResult;
use super::layout::{AXIS_HEIGHT, Heading, LABEL_HEIGHT, LEFT, Layout, Pen};
use super::look::{Look, short, text_width};
use super::numbers::{Numbers, ticks};
use super::paint::{Painter, Thin};
use crate::results::{FieldFigure, Panel, PictureFormat, Scale, Values};

/// The outline of the deformed sheet.
fn outline_pen(look: Look) -> Thin {
    Thin {
        colour: look.ink(),
        width: 0.8,
        cover: 255,
    }
}

/// The outline at rest.
fn rest_pen(look: Look) -> Thin {
    Thin {
        colour: look.rest(),
        width: 0.7,
        cover: 255,
    }
}

/// Lines of equal values.
const CONTOUR: Thin = Thin {
    colour: RGBColor(0, 0, 0),
    width: 0.5,
    cover: 110,
};

/// How far the arrow at an end of the colour bar reaches.
const ARROW: f64 = 14.0;

const AT_REST: &str = "thin lines: at rest";

/// The height of these words below the axis.
const KEY_HEIGHT: f64 = 14.0;

/// The least distance of numbers beside the colour bar.
const APART: f64 = 15.0;

/// Fields on so many triangles at most have contour lines.
const MOST_CONTOURED: usize = 400_000;

impl FieldFigure {
    /// The figure as a file.
    pub(super) fn drawn(&self, look: Look, format: PictureFormat) -> DrawResult<Vec<u8>> {
        let (layout, range) = (self.layout(look), self.range());
        let paint = |painter: &mut Painter| self.paint(painter, &layout, &range);
        let draw = |area: &Area<'_>| self.draw(area, &layout, &range);
        render(self.size(&layout), look, format, paint, draw)
    }

    /// Width and height in points.
    pub(super) fn size(&self, layout: &Layout) -> (u32, u32) {
        let below = if self.says_below(layout.look) {
            KEY_HEIGHT
        } else {
            0.0
        };
        let bottom = layout.panel_top(self.panels.len()) + AXIS_HEIGHT + below;
        (layout.width() as u32, bottom as u32)
    }

    /// Whether what thin lines are stands below the axis, as there is no room beside the names of narrow panels.
    fn says_below(&self, look: Look) -> bool {
        look.is_narrow() && self.has_rest()
    }

    fn has_rest(&self) -> bool {
        let first = self.panels.first();
        first.is_some_and(|panel| !panel.surface.rest.is_empty())
    }

    fn heading(&self, look: Look) -> Heading {
        Heading::new(look, &self.title, &self.quantity)
    }

    pub(super) fn layout(&self, look: Look) -> Layout {
        let surfaces = self.panels.iter().map(|panel| &panel.surface);
        let places = surfaces.flat_map(|surface| {
            let rest = surface.rest.iter().flatten();
            surface.points.iter().chain(rest).copied()
        });
        let words = self.panels.iter().map(|panel| text_width(&panel.label, 14));
        let words = words.fold(0.0, f64::max) + text_width(AT_REST, 12);
        Layout::of(look, &self.heading(look), words, places)
    }

    pub(super) fn range(&self) -> Range {
        Range::of(self.panels.iter(), self.scale)
    }

    /// Draws what is written around the plates, with a layout and a range of colours, which may be those of several figures.
    pub(super) fn draw(&self, area: &Area<'_>, layout: &Layout, range: &Range) -> DrawResult<()> {
        let look = layout.look;
        let pen = Pen { area, look };
        self.heading(look).draw(&pen, layout)?;
        let room = layout.bar()[0] - LEFT - 4.0;
        for (index, panel) in self.panels.iter().enumerate() {
            let place = [LEFT, layout.panel_top(index) + LABEL_HEIGHT / 2.0];
            let label = if look.is_printed() {
                short(&panel.label, 14, room)
            } else {
                &panel.label
            };
            pen.write(label, place, look.text(14), HPos::Left)?;
            if index == 0 && self.has_rest() && !look.is_narrow() {
                let label = [layout.right(), place[1]];
                pen.write(AT_REST, label, look.text(12), HPos::Right)?;
            }
            layout.draw_width_axis(&pen, index)?;
        }
        let last = self.panels.len().checked_sub(1).ok_or("it has no panels")?;
        layout.draw_length_axis(&pen, last)?;
        if self.says_below(look) {
            let y = layout.panel_top(last + 1) + AXIS_HEIGHT;
            pen.write(AT_REST, [LEFT, y], look.text(12), HPos::Left)?;
        }
        self.draw_bar(&pen, layout, range)
    }

    /// The ends of the colour bar, without its arrows.
    fn bar(&self, layout: &Layout, range: &Range) -> [f64; 2] {
        let bottom = layout.panel_top(self.panels.len());
        let arrow = |beyond: Option<f64>| if beyond.is_some() { ARROW } else { 0.0 };
        [
            layout.top + LABEL_HEIGHT + arrow(range.above),
            bottom - arrow(range.below),
        ]
    }

    fn paint_bar(&self, painter: &mut Painter, layout: &Layout, range: &Range) {
        let ([left, right], [top, bottom]) = (layout.bar(), self.bar(layout, range));
        let middle = 0.5 * (left + right);
        let table = layout.look.bar(range.is_signed);
        let mut shade = |corners, shares| painter.shade(corners, shares, &|share| share, &table);
        let [a, b, c, d] = [[left, bottom], [right, bottom], [right, top], [left, top]];
        shade([a, b, c], [0.0, 0.0, 1.0]);
        shade([a, c, d], [0.0, 1.0, 1.0]);
        if range.below.is_some() {
            shade([a, b, [middle, bottom + ARROW]], [0.0; 3]);
        }
        if range.above.is_some() {
            shade([d, c, [middle, top - ARROW]], [1.0; 3]);
        }
    }

    /// Paints the colour bar and the plates.
    pub(super) fn paint(&self, painter: &mut Painter, layout: &Layout, range: &Range) {
        self.paint_bar(painter, layout, range);
        let table = layout.look.bar(range.is_signed);
        let (ticks, _) = ticks([range.low, range.high], self.scale);
        // At zero a field of both signs is white, and noise would draw lines there.
        let levels = ticks
            .iter()
            .filter(|(at, _)| !(range.is_signed && at.abs() < 1e-12));
        let levels: Vec<f64> = levels.map(|(at, _)| self.scale.value(*at)).collect();
        let share = |value: f64| {
            if value.is_nan() {
                f64::NAN
            } else {
                range.share(self.scale.position(value).unwrap_or(range.low))
            }
        };
        for (index, panel) in self.panels.iter().enumerate() {
            let place = |place: [f64; 2]| layout.place(index, place);
            let rest = placed(&panel.surface.rest, &place);
            painter.lines(rest.iter().map(|line| &line[..]), rest_pen(layout.look));
            let mut contours = Vec::new();
            let triangles = panel.surface.triangles.iter();
            for (triangle, values) in triangles.zip(panel.corners()) {
                let corners = triangle.map(|point| place(panel.surface.points[point as usize]));
                painter.shade(corners, values, &share, &table);
                if has_contours(panel) {
                    contours.extend(
                        levels
                            .iter()
                            .filter_map(|at| crossing(corners, values, *at)),
                    );
                }
            }
            painter.lines_above(contours.iter().map(|line| &line[..]), CONTOUR);
            let outline = placed(&panel.surface.outline, &place);
            let pen = outline_pen(layout.look);
            painter.lines_above(outline.iter().map(|line| &line[..]), pen);
        }
    }

    /// What is written beside the colour bar, and its frame; an arrow at an end says that values lie beyond it.
    fn draw_bar(&self, pen: &Pen, layout: &Layout, range: &Range) -> DrawResult<()> {
        let [left, right] = layout.bar();
        let [top, bottom] = self.bar(layout, range);
        let height = |share: f64| bottom + share * (top - bottom);
        let (ticks, numbers) = ticks([range.low, range.high], self.scale);
        let mut last = f64::INFINITY;
        for (position, label) in ticks {
            let y = height(range.share(position));
            pen.line(&[[right, y], [right + 4.0, y]])?;
            if last - y < APART {
                continue;
            }
            last = y;
            pen.write(&label, [right + 8.0, y], pen.look.text(13), HPos::Left)?;
        }
        let mut frame = vec![[left, top], [left, bottom]];
        if let Some(least) = range.below {
            let tip = [0.5 * (left + right), bottom + ARROW];
            frame.push(tip);
            self.draw_extreme(pen, numbers, "min", least, [right + 8.0, bottom + ARROW])?;
        }
        frame.extend([[right, bottom], [right, top]]);
        if let Some(most) = range.above {
            let tip = [0.5 * (left + right), top - ARROW];
            frame.push(tip);
            self.draw_extreme(pen, numbers, "max", most, [right + 8.0, top - ARROW])?;
        }
        frame.push([left, top]);
        pen.line(&frame)?;
        match numbers.power() {
            Some(power) => pen.write(
                &power,
                [left, layout.top + 0.5 * LABEL_HEIGHT],
                pen.look.text(13),
                HPos::Left,
            ),
            None => Ok(()),
        }
    }

    /// What lies beyond an end of the bar.
    fn draw_extreme(
        &self,
        pen: &Pen,
        numbers: Numbers,
        which: &str,
        value: f64,
        place: [f64; 2],
    ) -> DrawResult<()> {
        let value = match self.scale {
            Scale::Logarithmic => Numbers::default().between(value),
            Scale::Linear | Scale::Interval => numbers.between(value),
        };
        pen.write(
            &format!("{which} {value}"),
            place,
            pen.look.text(12),
            HPos::Left,
        )
    }
}

fn has_contours(panel: &Panel) -> bool {
    let is_smooth = matches!(panel.values, Values::AtPoints(_));
    is_smooth && panel.surface.triangles.len() <= MOST_CONTOURED
}

fn placed(lines: &[Vec<[f64; 2]>], place: &dyn Fn([f64; 2]) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let places = |line: &Vec<[f64; 2]>| line.iter().map(|at| place(*at)).collect();
    lines.iter().map(places).collect()
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
    let mut places = [[0, 1], [1, 2], [2, 0]].into_iter().filter_map(on_edge);
    Some([places.next()?, places.next()?])
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
