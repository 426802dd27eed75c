//! Fields on deformed plates, several side by side on one colour scale.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{DrawResult, FINE, INK, Painter, bold, render, stroke, text, tick};
use crate::results::{Colours, FieldCell, FieldFigure, Scale};

const WIDTH: f64 = 960.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 146.0;
const TITLE_HEIGHT: f64 = 46.0;
const LABEL_HEIGHT: f64 = 26.0;
const AXIS_HEIGHT: f64 = 46.0;

/// A plate that is wider than long is drawn no higher than this.
const HIGHEST_PLATE: f64 = 420.0;

/// More cells than this are painted instead of drawn.
const MOST_DRAWN: usize = 20_000;

/// Positions of the lowest and the highest colour on the colour bar.
pub(super) type Range = (f64, f64);

/// Where the panels lie, in points.
pub(super) struct Layout {
    low: [f64; 2],
    high: [f64; 2],
    points_per_mm: f64,
}

impl Layout {
    /// The layout that shows all places.
    fn of(places: impl Iterator<Item = [f64; 2]>) -> Self {
        let start = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (low, high) = places.fold(start, |(low, high), place| {
            let both = |pick: fn(f64, f64) -> f64, limit: [f64; 2]| {
                [pick(limit[0], place[0]), pick(limit[1], place[1])]
            };
            (both(f64::min, low), both(f64::max, high))
        });
        Self {
            low,
            high,
            points_per_mm: ((WIDTH - LEFT - RIGHT) / (high[0] - low[0]))
                .min(HIGHEST_PLATE / (high[1] - low[1])),
        }
    }

    fn panel_height(&self) -> f64 {
        LABEL_HEIGHT + (self.high[1] - self.low[1]) * self.points_per_mm
    }

    fn panel_top(&self, index: usize) -> f64 {
        TITLE_HEIGHT + self.panel_height() * index as f64
    }

    /// A place on the plate of a panel.
    fn place(&self, panel: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let top = self.panel_top(panel) + LABEL_HEIGHT;
        [
            LEFT + (x - self.low[0]) * self.points_per_mm,
            top + (self.high[1] - y) * self.points_per_mm,
        ]
    }
}

/// The outlines of cells, each a closed line, in true proportions as a PNG.
pub fn outlines(title: &str, cells: &[Vec<[f64; 2]>]) -> DrawResult<Vec<u8>> {
    let layout = Layout::of(cells.iter().flatten().copied());
    let bottom = layout.panel_top(1);
    let places = cells.iter().map(|cell| {
        let places = cell.iter().map(|place| layout.place(0, *place));
        places.collect::<Vec<_>>()
    });
    let (drawn, painted) = match cells.len() > MOST_DRAWN {
        false => (Some(places), None),
        true => (None, Some(places)),
    };
    let draw = |area: &DrawingArea<SVGBackend<'_>, Shift>| {
        let pen = Pen(area);
        pen.write(title, [LEFT, 24.0], bold(17), HPos::Left)?;
        for places in drawn.into_iter().flatten() {
            pen.line(&places)?;
        }
        draw_width_axis(&pen, &layout, 0)?;
        draw_length_axis(&pen, &layout, 0)
    };
    let paint = |painter: &mut Painter| {
        let lines = painted.into_iter().flatten();
        lines.for_each(|places| painter.line(&places));
    };
    render((WIDTH as u32, (bottom + AXIS_HEIGHT) as u32), draw, paint)
}

impl FieldFigure {
    /// The figure as a PNG.
    pub fn png(&self) -> DrawResult<Vec<u8>> {
        let (layout, range) = (self.layout(), self.range());
        let draw = |area: &DrawingArea<SVGBackend<'_>, Shift>| self.draw(area, &layout, range);
        let paint = |painter: &mut Painter| self.paint(painter, &layout, range);
        render(self.size(&layout), draw, paint)
    }

    /// Width and height in points.
    pub(super) fn size(&self, layout: &Layout) -> (u32, u32) {
        let bottom = layout.panel_top(self.panels.len());
        (WIDTH as u32, (bottom + AXIS_HEIGHT) as u32)
    }

    /// Draws the figure with a layout and a range of colours, which may be those of several figures.
    pub(super) fn draw(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
        layout: &Layout,
        range: Range,
    ) -> DrawResult<()> {
        let pen = Pen(area);
        pen.write(&self.title, [LEFT, 24.0], bold(17), HPos::Left)?;
        pen.write(&self.quantity, [WIDTH - 16.0, 24.0], text(13), HPos::Right)?;
        for (index, panel) in self.panels.iter().enumerate() {
            let label = [LEFT, layout.panel_top(index) + LABEL_HEIGHT / 2.0];
            pen.write(&panel.label, label, text(14), HPos::Left)?;
            if !self.is_painted() {
                for cell in &panel.cells {
                    let (corners, colour) = self.shown(cell, index, layout, range);
                    pen.fill(&corners, colour)?;
                }
            }
            draw_width_axis(&pen, layout, index)?;
        }
        let last = self.panels.len().checked_sub(1).ok_or("it has no panels")?;
        draw_length_axis(&pen, layout, last)?;
        let bottom = layout.panel_top(self.panels.len());
        self.draw_bar(&pen, range, [TITLE_HEIGHT + LABEL_HEIGHT, bottom])
    }

    /// Paints the cells of a figure that has too many of them to be drawn.
    pub(super) fn paint(&self, painter: &mut Painter, layout: &Layout, range: Range) {
        for (index, panel) in self.panels.iter().enumerate().filter(|_| self.is_painted()) {
            for cell in &panel.cells {
                let (corners, colour) = self.shown(cell, index, layout, range);
                painter.fill(&corners, colour);
            }
        }
    }

    fn is_painted(&self) -> bool {
        let cells = self.panels.iter().map(|panel| panel.cells.len());
        cells.sum::<usize>() > MOST_DRAWN
    }

    /// Where a cell of a panel is shown, and its colour.
    fn shown(
        &self,
        (corners, value): &FieldCell,
        panel: usize,
        layout: &Layout,
        range: Range,
    ) -> ([[f64; 2]; 4], RGBColor) {
        let position = self.scale.position(*value).unwrap_or(range.0);
        let corners = corners.map(|corner| layout.place(panel, corner));
        (corners, self.colour(share(position, range)))
    }

    pub(super) fn layout(&self) -> Layout {
        let cells = self.panels.iter().flat_map(|panel| &panel.cells);
        Layout::of(cells.flat_map(|cell| cell.0))
    }

    pub(super) fn range(&self) -> Range {
        let cells = self.panels.iter().flat_map(|panel| &panel.cells);
        let positions = cells.filter_map(|cell| self.scale.position(cell.1));
        let (mut low, mut high) = positions
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                (low.min(p), high.max(p))
            });
        if self.colours == Colours::Diverging {
            high = high.abs().max(low.abs());
            low = -high;
        }
        if self.scale == Scale::Logarithmic {
            // Below four decades lie single nodes that happen to be exact.
            low = low.max(high - 4.0);
        }
        match high > low {
            true => (low, high),
            // All values are the same, or there are none.
            false if high.is_finite() => (high - 0.5, high + 0.5),
            false => (-1.0, 0.0),
        }
    }

    fn colour(&self, share: f64) -> RGBColor {
        let share = share.clamp(0.0, 1.0) as f32;
        match self.colours {
            Colours::Sequential => ViridisRGB.get_color(share),
            Colours::Diverging => {
                let blue_to_red = [
                    RGBColor(33, 102, 172),
                    RGBColor(146, 197, 222),
                    RGBColor(247, 247, 247),
                    RGBColor(244, 165, 130),
                    RGBColor(178, 24, 43),
                ];
                DerivedColorMap::new(&blue_to_red).get_color(share)
            }
        }
    }

    fn draw_bar(&self, pen: &Pen, range: Range, [top, bottom]: [f64; 2]) -> DrawResult<()> {
        const BANDS: i32 = 256;
        let left = WIDTH - RIGHT + 38.0;
        let right = left + 18.0;
        let height = |share: f64| bottom + share * (top - bottom);
        for band in 0..BANDS {
            let [from, to] =
                [band, band + 1].map(|edge| height(f64::from(edge) / f64::from(BANDS)));
            let colour = self.colour((f64::from(band) + 0.5) / f64::from(BANDS));
            pen.fill(
                &[[left, from], [right, from], [right, to], [left, to]],
                colour,
            )?;
        }
        let frame = [
            [left, top],
            [right, top],
            [right, bottom],
            [left, bottom],
            [left, top],
        ];
        pen.line(&frame)?;
        for position in ticks(range, self.scale) {
            let y = height(share(position, range));
            pen.line(&[[right, y], [right + 4.0, y]])?;
            pen.write(
                &self.scale.label(position),
                [right + 8.0, y],
                text(13),
                HPos::Left,
            )?;
        }
        Ok(())
    }
}

fn share(position: f64, (low, high): Range) -> f64 {
    (position - low) / (high - low)
}

/// Round positions within a range.
fn ticks((low, high): Range, scale: Scale) -> Vec<f64> {
    let raw = (high - low) / 6.0;
    let decade = 10f64.powf(raw.log10().floor());
    let nice = [1.0, 2.0, 2.5, 5.0, 10.0].map(|factor| factor * decade);
    let step = match scale {
        Scale::Logarithmic => 1.0,
        Scale::Linear | Scale::Interval => {
            nice.into_iter().find(|step| *step >= raw).unwrap_or(raw)
        }
    };
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

fn draw_width_axis(pen: &Pen, layout: &Layout, panel: usize) -> DrawResult<()> {
    let [low, high] = [layout.low[1], layout.high[1]];
    for y in [low, (low + high) / 2.0, high] {
        let [x, row] = layout.place(panel, [layout.low[0], y]);
        pen.line(&[[x - 8.0, row], [x - 3.0, row]])?;
        let number = tick((10.0 * y).round() / 10.0);
        pen.write(&number, [x - 11.0, row], text(12), HPos::Right)?;
    }
    Ok(())
}

fn draw_length_axis(pen: &Pen, layout: &Layout, panel: usize) -> DrawResult<()> {
    let [left, bottom] = layout.place(panel, layout.low);
    let [right, _] = layout.place(panel, layout.high);
    let y = bottom + 6.0;
    pen.line(&[[left, y], [right, y]])?;
    for x in ticks((layout.low[0], layout.high[0]), Scale::Linear) {
        let [column, _] = layout.place(panel, [x, layout.low[1]]);
        pen.line(&[[column, y], [column, y + 5.0]])?;
        pen.write(&tick(x), [column, y + 14.0], text(12), HPos::Center)?;
    }
    pen.write("x, y [mm]", [right + 14.0, y + 14.0], text(12), HPos::Left)
}

/// Draws at places in points.
struct Pen<'a, 'b>(&'a DrawingArea<SVGBackend<'b>, Shift>);

impl Pen<'_, '_> {
    fn at([x, y]: [f64; 2]) -> (i32, i32) {
        [x, y]
            .map(|points| (points * f64::from(FINE)).round() as i32)
            .into()
    }

    fn write(&self, words: &str, place: [f64; 2], style: TextStyle, align: HPos) -> DrawResult<()> {
        let style = style.pos(Pos::new(align, VPos::Center));
        self.0
            .draw(&Text::new(words.to_owned(), Self::at(place), style))?;
        Ok(())
    }

    fn line(&self, places: &[[f64; 2]]) -> DrawResult<()> {
        let places: Vec<_> = places.iter().copied().map(Self::at).collect();
        self.0.draw(&PathElement::new(places, stroke(INK, 1)))?;
        Ok(())
    }

    fn fill(&self, places: &[[f64; 2]], colour: RGBColor) -> DrawResult<()> {
        let places: Vec<_> = places.iter().copied().map(Self::at).collect();
        self.0.draw(&Polygon::new(places, colour.filled()))?;
        Ok(())
    }
}
