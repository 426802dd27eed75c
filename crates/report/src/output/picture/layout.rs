//! Where plates lie in a picture, and the axes around them.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::Area;
use super::design::{DrawResult, FINE};
use super::look::{Look, lines, text_width};
use super::numbers::{Numbers, round_positions};
use crate::mesh::geometry::bounding_box;

/// The width of a picture for a screen in points.
const WIDTH: u32 = 960;
pub(super) const LABEL_HEIGHT: f64 = 26.0;
pub(super) const AXIS_HEIGHT: f64 = 46.0;

/// A plate that is wider than long is drawn no higher than this.
const HIGHEST_PLATE: f64 = 420.0;

/// What stands at the head of a picture: its title, and beside or below it what the colours show.
pub(super) struct Heading {
    lines: Vec<String>,
    size: u32,
    quantity: String,
    is_beside: bool,
}

impl Heading {
    pub fn new(look: Look, title: &str, quantity: &str) -> Self {
        let width = f64::from(look.points(WIDTH)) - LEFT - EDGE;
        let size = if look.is_narrow() { 13 } else { 17 };
        if !look.is_printed() {
            return Self {
                lines: vec![title.to_owned()],
                size,
                quantity: quantity.to_owned(),
                is_beside: true,
            };
        }
        let whole = format!("{title}    {quantity}");
        Self {
            lines: lines(title, size, width),
            size,
            quantity: quantity.to_owned(),
            is_beside: lines(&whole, size, width).len() == 1,
        }
    }

    /// Its height in points.
    pub fn height(&self) -> f64 {
        let below = if self.is_beside || self.quantity.is_empty() {
            0
        } else {
            1
        };
        TITLE_HEIGHT + LINE_HEIGHT * (self.lines.len() - 1 + below) as f64
    }

    /// The least width of a picture in which its words have room.
    fn least_width(&self) -> f64 {
        const APART: f64 = 24.0;
        let title = self.lines.iter().map(|line| text_width(line, self.size));
        let beside = if self.is_beside && !self.quantity.is_empty() {
            APART + text_width(&self.quantity, 13)
        } else {
            0.0
        };
        LEFT + title.fold(0.0, f64::max) + beside + EDGE
    }

    pub fn draw(&self, pen: &Pen, layout: &Layout) -> DrawResult<()> {
        let mut y = 24.0;
        for line in &self.lines {
            pen.write(line, [LEFT, y], pen.look.bold(self.size), HPos::Left)?;
            y += LINE_HEIGHT;
        }
        if self.is_beside {
            y -= LINE_HEIGHT;
        }
        let right = layout.width() - EDGE;
        pen.write(&self.quantity, [right, y], pen.look.text(13), HPos::Right)
    }
}

pub(super) const LEFT: f64 = 56.0;
const EDGE: f64 = 16.0;
const TITLE_HEIGHT: f64 = 46.0;
const LINE_HEIGHT: f64 = 18.0;

/// Where the panels lie, in points.
pub(super) struct Layout {
    pub look: Look,
    /// The upper end of the first panel.
    pub top: f64,
    low: [f64; 2],
    high: [f64; 2],
    points_per_mm: f64,
    /// What panels and the words above them take along x.
    panels: f64,
    width: f64,
}

impl Layout {
    /// The layout that shows all places below a heading, with so much room at least for the words above a panel. A picture
    /// for a screen is no wider than it needs.
    pub fn of(
        look: Look,
        heading: &Heading,
        words: f64,
        places: impl Iterator<Item = [f64; 2]>,
    ) -> Self {
        let [low, high] = bounding_box(places);
        let whole = f64::from(look.points(WIDTH));
        let most = whole - LEFT - beside(look);
        let points_per_mm = (most / (high[0] - low[0])).min(HIGHEST_PLATE / (high[1] - low[1]));
        let panels = (points_per_mm * (high[0] - low[0])).max(words.min(most));
        let least = (LEFT + panels + beside(look)).max(heading.least_width());
        Self {
            look,
            top: heading.height(),
            low,
            high,
            points_per_mm,
            panels,
            width: if look.is_printed() {
                whole
            } else {
                least.min(whole)
            },
        }
    }

    /// The whole picture's width.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Left and right of the colour bar.
    pub fn bar(&self) -> [f64; 2] {
        let [gap, width] = if self.look.is_narrow() {
            [18.0, 14.0]
        } else {
            [38.0, 18.0]
        };
        let left = self.right() + gap;
        [left, left + width]
    }

    fn size(&self, axis: usize) -> f64 {
        (self.high[axis] - self.low[axis]) * self.points_per_mm
    }

    pub fn panel_top(&self, index: usize) -> f64 {
        self.top + (LABEL_HEIGHT + self.size(1)) * index as f64
    }

    /// The right end of all panels and of the words above them.
    pub fn right(&self) -> f64 {
        LEFT + self.panels
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
            pen.write(&number, [x - 14.0, row], self.look.text(12), HPos::Right)?;
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
            pen.write(
                &number,
                [column, y + 14.0],
                self.look.text(12),
                HPos::Center,
            )?;
        }
        pen.write(
            "x, y [mm]",
            [right + 14.0, y + 14.0],
            self.look.text(12),
            HPos::Left,
        )
    }
}

/// What the colour bar takes to the right of the panels.
fn beside(look: Look) -> f64 {
    if look.is_narrow() { 100.0 } else { 146.0 }
}

/// Draws at places in points.
pub(super) struct Pen<'a, 'b> {
    pub area: &'a Area<'b>,
    pub look: Look,
}

impl Pen<'_, '_> {
    fn at([x, y]: [f64; 2]) -> (i32, i32) {
        [x, y]
            .map(|points| (points * f64::from(FINE)).round() as i32)
            .into()
    }

    pub fn write(
        &self,
        words: &str,
        place: [f64; 2],
        style: TextStyle,
        align: HPos,
    ) -> DrawResult<()> {
        let style = style.pos(Pos::new(align, VPos::Center));
        self.area
            .draw(&Text::new(words.to_owned(), Self::at(place), style))?;
        Ok(())
    }

    pub fn line(&self, places: &[[f64; 2]]) -> DrawResult<()> {
        let places: Vec<_> = places.iter().copied().map(Self::at).collect();
        self.area
            .draw(&PathElement::new(places, self.look.axis()))?;
        Ok(())
    }

    pub fn fill(&self, places: &[[f64; 2]], colour: RGBColor) -> DrawResult<()> {
        let places: Vec<_> = places.iter().copied().map(Self::at).collect();
        self.area.draw(&Polygon::new(places, colour.filled()))?;
        Ok(())
    }
}
