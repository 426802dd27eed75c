//! The positions of plates in a picture, and the axes around them.

use super::canvas::{EDGE, GAP, Sheet, Title};
use super::look::Look;
use super::marks::Align;
use super::numbers::Ticks;
use crate::mesh::geometry::bounding_box;
use crate::results::Scale;

/// The width of a picture for a screen in points.
const WIDTH: u32 = 960;

/// The height of the words above a panel, and of a panel without any.
pub(super) const LABEL_HEIGHT: f64 = 24.0;
const NO_LABEL_HEIGHT: f64 = 6.0;

/// A plate that is wider than long is drawn no higher than this.
const HIGHEST_PLATE: f64 = 420.0;

/// From a panel to its axes, the length of a tick, and from an axis to the middle of its numbers.
const AWAY: f64 = 6.0;
const TICK: f64 = 5.0;
const BELOW: f64 = 15.0;

/// The positions of the panels, in points.
pub(super) struct Layout {
    pub look: Look,
    /// The upper end of the first panel.
    pub top: f64,
    /// The left end of the panels.
    pub left: f64,
    low: [f64; 2],
    high: [f64; 2],
    points_per_mm: f64,
    above: f64,
    x: Ticks,
    y: Ticks,
    /// The width of the picture.
    pub width: f64,
}

impl Layout {
    /// The layout that shows all places below a title, with so much room at least from the left end of the panels on. A picture
    /// for a screen is no wider than it needs.
    pub fn of(
        look: Look,
        title: &str,
        least: f64,
        positions: impl Iterator<Item = [f64; 2]>,
    ) -> Self {
        const ABOUT: f64 = 60.0;
        let [low, high] = bounding_box(positions);
        let full_width = f64::from(look.points(WIDTH));
        let scaled = |left: f64| {
            let most = full_width - left - EDGE;
            (most / (high[0] - low[0])).min(HIGHEST_PLATE / (high[1] - low[1]))
        };
        let height = scaled(ABOUT) * (high[1] - low[1]);
        let y = vertical([low[1], high[1]], height);
        let numbers = y.at.iter().map(|(_, label)| look.number().width(label));
        let left = EDGE + look.name().line_height() + numbers.fold(0.0, f64::max) + NUMBERS;
        // The last number may reach beyond the panel.
        let points_per_mm = scaled(left + GAP);
        let panels = points_per_mm * (high[0] - low[0]);
        let x = Ticks::fitting([low[0], high[0]], Scale::Linear, panels, look.number());
        let title = Title::new(title, look, [left, EDGE], full_width - left - EDGE);
        let needed = panels.max(least).max(title.width());
        Self {
            look,
            top: EDGE + title.height(),
            left,
            low,
            high,
            points_per_mm,
            above: LABEL_HEIGHT,
            x,
            y,
            width: if look.is_printed() {
                full_width
            } else {
                (left + needed + GAP + EDGE).min(full_width)
            },
        }
    }

    /// The layout of panels without labels above them.
    pub fn without_labels(self) -> Self {
        let above = NO_LABEL_HEIGHT;
        Self { above, ..self }
    }

    fn size(&self, axis: usize) -> f64 {
        (self.high[axis] - self.low[axis]) * self.points_per_mm
    }

    pub fn panel_top(&self, index: usize) -> f64 {
        self.top + (self.above + self.size(1)) * index as f64
    }

    /// The lower end of the axis below so many panels.
    pub fn bottom(&self, panels: usize) -> f64 {
        self.panel_top(panels) + AWAY + BELOW + GAP + self.look.name().line_height()
    }

    /// The right end of the panels.
    pub fn right(&self) -> f64 {
        self.left + self.size(0)
    }

    /// A place on the plate of a panel.
    pub fn position(&self, panel: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let top = self.panel_top(panel) + self.above;
        [
            self.left + (x - self.low[0]) * self.points_per_mm,
            top + (self.high[1] - y) * self.points_per_mm,
        ]
    }

    /// Lines on the plate of a panel.
    pub fn placed(&self, panel: usize, lines: &[Vec<[f64; 2]>]) -> Vec<Vec<[f64; 2]>> {
        let position = |at: &[f64; 2]| self.position(panel, *at);
        let lines = lines.iter();
        lines
            .map(|line| line.iter().map(position).collect())
            .collect()
    }

    /// A title, and the axes of so many panels.
    pub fn draw(&self, sheet: &mut Sheet, title: &str, panels: usize) {
        let room = self.width - self.left - EDGE;
        Title::new(title, self.look, [self.left, EDGE], room).draw(sheet);
        for panel in 0..panels {
            self.draw_width_axis(sheet, panel);
        }
        let middle = 0.5 * (self.panel_top(0) + self.above + self.panel_top(panels));
        let name = self.y.numbers.labelled("y [mm]");
        let at = [EDGE + 0.5 * self.look.name().line_height(), middle];
        sheet.write_upwards(&[name], at, self.look.name());
        self.draw_length_axis(sheet, panels - 1);
    }

    /// The axis to the left of a panel.
    fn draw_width_axis(&self, sheet: &mut Sheet, panel: usize) {
        let x = self.left - AWAY;
        let at = |y: f64| self.position(panel, [self.low[0], y])[1];
        sheet.axis(&[[x, at(self.low[1])], [x, at(self.high[1])]]);
        for (y, number) in &self.y.at {
            let row = at(*y);
            sheet.axis(&[[x - TICK, row], [x, row]]);
            let end = [x - TICK - 3.0, row];
            sheet.write(number, end, Align::Right, self.look.number());
        }
    }

    /// The axis below a panel.
    fn draw_length_axis(&self, sheet: &mut Sheet, panel: usize) {
        let [left, bottom] = self.position(panel, self.low);
        let y = bottom + AWAY;
        sheet.axis(&[[left, y], [self.right(), y]]);
        for (x, number) in &self.x.at {
            let [column, _] = self.position(panel, [*x, self.low[1]]);
            sheet.axis(&[[column, y], [column, y + TICK]]);
            sheet.write(
                number,
                [column, y + BELOW],
                Align::Centre,
                self.look.number(),
            );
        }
        let name = self.x.numbers.labelled("x [mm]");
        let below = y + BELOW + GAP + 0.5 * self.look.name().line_height();
        let middle = 0.5 * (left + self.right());
        sheet.write(&name, [middle, below], Align::Centre, self.look.name());
    }
}

/// What ticks take between numbers and a panel, and the gap between numbers and a label.
const NUMBERS: f64 = AWAY + TICK + 9.0;

/// The ticks of an axis of a height, of a low one the ends alone.
fn vertical(range: [f64; 2], height: f64) -> Ticks {
    const APART: f64 = 18.0;
    let most = (height / APART) as usize;
    let ticks = Ticks::within(range, Scale::Linear, most.clamp(3, 6));
    if ticks.at.len() > most.max(2) {
        return ticks.ends();
    }
    ticks
}
