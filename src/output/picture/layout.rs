//! Where plates lie in a picture, and the axes around them.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{DrawResult, FINE, INK, bold, stroke, text};
use super::numbers::{Numbers, round_positions};
use crate::mesh::geometry::bounding_box;

pub(super) const WIDTH: f64 = 960.0;
pub(super) const LEFT: f64 = 56.0;
pub(super) const RIGHT: f64 = 146.0;
pub(super) const TITLE_HEIGHT: f64 = 46.0;
pub(super) const LABEL_HEIGHT: f64 = 26.0;
pub(super) const AXIS_HEIGHT: f64 = 46.0;

/// A plate that is wider than long is drawn no higher than this.
const HIGHEST_PLATE: f64 = 420.0;

/// Where the panels lie, in points.
pub(super) struct Layout {
    low: [f64; 2],
    high: [f64; 2],
    points_per_mm: f64,
}

impl Layout {
    /// The layout that shows all places.
    pub fn of(places: impl Iterator<Item = [f64; 2]>) -> Self {
        let [low, high] = bounding_box(places);
        Self {
            low,
            high,
            points_per_mm: ((WIDTH - LEFT - RIGHT) / (high[0] - low[0]))
                .min(HIGHEST_PLATE / (high[1] - low[1])),
        }
    }

    fn size(&self, axis: usize) -> f64 {
        (self.high[axis] - self.low[axis]) * self.points_per_mm
    }

    pub fn panel_top(&self, index: usize) -> f64 {
        TITLE_HEIGHT + (LABEL_HEIGHT + self.size(1)) * index as f64
    }

    /// The right end of all panels.
    pub fn right(&self) -> f64 {
        LEFT + self.size(0)
    }

    /// A place on the plate of a panel.
    pub fn place(&self, panel: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let top = self.panel_top(panel) + LABEL_HEIGHT;
        [
            LEFT + (x - self.low[0]) * self.points_per_mm,
            top + (self.high[1] - y) * self.points_per_mm,
        ]
    }

    /// Round numbers along an axis, at least so many points apart.
    fn ticks(&self, axis: usize, apart: f64) -> Vec<(f64, String)> {
        let about = (self.size(axis) / apart).clamp(1.0, 8.0);
        let positions = round_positions([self.low[axis], self.high[axis]], about);
        let numbers = Numbers::plain(&positions);
        let labelled = positions.into_iter().map(|at| (at, numbers.label(at)));
        labelled.collect()
    }

    /// The axis to the left of a panel.
    pub fn draw_width_axis(&self, pen: &Pen, panel: usize) -> DrawResult<()> {
        let [low, high] = [self.low[1], self.high[1]].map(|y| self.place(panel, [self.low[0], y]));
        pen.line(&[[low[0] - 6.0, low[1]], [high[0] - 6.0, high[1]]])?;
        for (y, number) in self.ticks(1, 36.0) {
            let [x, row] = self.place(panel, [self.low[0], y]);
            pen.line(&[[x - 11.0, row], [x - 6.0, row]])?;
            pen.write(&number, [x - 14.0, row], text(12), HPos::Right)?;
        }
        Ok(())
    }

    /// The axis below a panel.
    pub fn draw_length_axis(&self, pen: &Pen, panel: usize) -> DrawResult<()> {
        let [left, bottom] = self.place(panel, self.low);
        let [right, _] = self.place(panel, self.high);
        let y = bottom + 6.0;
        pen.line(&[[left, y], [right, y]])?;
        for (x, number) in self.ticks(0, 76.0) {
            let [column, _] = self.place(panel, [x, self.low[1]]);
            pen.line(&[[column, y], [column, y + 5.0]])?;
            pen.write(&number, [column, y + 14.0], text(12), HPos::Center)?;
        }
        pen.write("x, y [mm]", [right + 14.0, y + 14.0], text(12), HPos::Left)
    }
}

/// Draws at places in points.
pub(super) struct Pen<'a, 'b>(pub &'a DrawingArea<SVGBackend<'b>, Shift>);

impl Pen<'_, '_> {
    fn at([x, y]: [f64; 2]) -> (i32, i32) {
        [x, y]
            .map(|points| (points * f64::from(FINE)).round() as i32)
            .into()
    }

    pub fn title(&self, title: &str) -> DrawResult<()> {
        self.write(title, [LEFT, 24.0], bold(17), HPos::Left)
    }

    pub fn write(
        &self,
        words: &str,
        place: [f64; 2],
        style: TextStyle,
        align: HPos,
    ) -> DrawResult<()> {
        let style = style.pos(Pos::new(align, VPos::Center));
        self.0
            .draw(&Text::new(words.to_owned(), Self::at(place), style))?;
        Ok(())
    }

    pub fn line(&self, places: &[[f64; 2]]) -> DrawResult<()> {
        let places: Vec<_> = places.iter().copied().map(Self::at).collect();
        self.0.draw(&PathElement::new(places, stroke(INK, 1)))?;
        Ok(())
    }

    pub fn fill(&self, places: &[[f64; 2]], colour: RGBColor) -> DrawResult<()> {
        let places: Vec<_> = places.iter().copied().map(Self::at).collect();
        self.0.draw(&Polygon::new(places, colour.filled()))?;
        Ok(())
    }
}
