//! Fields on deformed plates, several beside each other on one colour scale.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{DrawResult, INK, PALE, Scale, bold, render, text};

/// A cell: its corners in mm and its value.
pub type FieldCell = ([[f64; 2]; 4], f64);

/// One plate.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Its name.
    pub label: String,
    /// Its cells.
    pub cells: Vec<FieldCell>,
}

/// Which colours a field is drawn in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Dark to light: magnitudes.
    Sequential,
    /// Blue over white to red: values of both signs; the range is made symmetric.
    Diverging,
}

/// Plates above each other, in true proportions, on one colour scale.
#[derive(Clone, Debug)]
pub struct FieldFigure {
    /// Heading.
    pub title: String,
    /// What the colours show, with its unit.
    pub quantity: String,
    /// How the values lie on the colour bar.
    pub scale: Scale,
    /// The colours.
    pub colours: Colours,
    /// The plates.
    pub panels: Vec<Panel>,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

const WIDTH: u32 = 960;
const MARGIN: f64 = 56.0;
const BAR_WIDTH: u32 = 130;
const TITLE_HEIGHT: u32 = 46;
const AXIS_HEIGHT: f64 = 46.0;
const LABEL_HEIGHT: f64 = 26.0;

impl FieldFigure {
    /// The figure as a PNG.
    pub fn png(&self) -> Vec<u8> {
        let [low, high] = self.extent();
        let plot_width = f64::from(WIDTH - BAR_WIDTH) - MARGIN - 14.0;
        let pixels_per_mm = plot_width / (high[0] - low[0]);
        let plot_height = (high[1] - low[1]) * pixels_per_mm;
        let panel_height = plot_height + LABEL_HEIGHT;
        let panels_height = panel_height * self.panels.len() as f64;
        let height = TITLE_HEIGHT + (panels_height + AXIS_HEIGHT) as u32;
        let range = self.range();
        render((WIDTH, height), |area| {
            let centre = Pos::new(HPos::Left, VPos::Center);
            area.draw(&Text::new(
                self.title.clone(),
                (MARGIN as i32, 24),
                bold(17).pos(centre),
            ))?;
            for (index, panel) in self.panels.iter().enumerate() {
                let top = f64::from(TITLE_HEIGHT) + panel_height * index as f64;
                let place = |[x, y]: [f64; 2]| {
                    let x = MARGIN + (x - low[0]) * pixels_per_mm;
                    let y = top + LABEL_HEIGHT + (high[1] - y) * pixels_per_mm;
                    (x.round() as i32, y.round() as i32)
                };
                let label = (MARGIN as i32, (top + LABEL_HEIGHT / 2.0) as i32);
                area.draw(&Text::new(panel.label.clone(), label, text(14).pos(centre)))?;
                self.draw_cells(area, panel, range, &place)?;
                draw_width_axis(area, low, high, &place)?;
                if index + 1 == self.panels.len() {
                    draw_length_axis(area, low, high, &place)?;
                }
            }
            let bar = [
                TITLE_HEIGHT as i32 + LABEL_HEIGHT as i32,
                (f64::from(TITLE_HEIGHT) + panels_height) as i32,
            ];
            self.draw_bar(area, range, bar)
        })
    }

    /// Smallest and largest coordinates of all plates.
    fn extent(&self) -> [[f64; 2]; 2] {
        let corners = self
            .panels
            .iter()
            .flat_map(|panel| &panel.cells)
            .flat_map(|cell| cell.0);
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        corners.fold(start, |[low, high], [x, y]| {
            [
                [low[0].min(x), low[1].min(y)],
                [high[0].max(x), high[1].max(y)],
            ]
        })
    }

    /// Positions of the smallest and the largest value on the colour bar.
    fn range(&self) -> (f64, f64) {
        let values = self.panels.iter().flat_map(|panel| &panel.cells);
        let positions = values.filter_map(|cell| self.scale.position(cell.1));
        match self.colours {
            Colours::Diverging => {
                let largest = positions.fold(0.0, |most: f64, value| most.max(value.abs()));
                let largest = if largest > 0.0 { largest } else { 1.0 };
                (-largest, largest)
            }
            Colours::Sequential => {
                let highest = self.scale.limits(positions.clone()).1;
                let lowest = positions.fold(highest, f64::min);
                let shown = match self.scale {
                    // Four decades tell all; below them lie single nodes that happen to be exact.
                    Scale::Logarithmic => lowest.floor().max(highest - 5.0),
                    Scale::Linear => lowest,
                };
                (shown, highest)
            }
        }
    }

    fn colour(&self, share: f64) -> RGBColor {
        let share = share.clamp(0.0, 1.0) as f32;
        match self.colours {
            Colours::Sequential => ViridisRGB.get_color(share),
            Colours::Diverging => {
                let colours = [
                    RGBColor(33, 102, 172),
                    RGBColor(146, 197, 222),
                    RGBColor(247, 247, 247),
                    RGBColor(244, 165, 130),
                    RGBColor(178, 24, 43),
                ];
                DerivedColorMap::new(&colours).get_color(share)
            }
        }
    }

    fn draw_cells(
        &self,
        area: &Area<'_>,
        panel: &Panel,
        (low, high): (f64, f64),
        place: &dyn Fn([f64; 2]) -> (i32, i32),
    ) -> DrawResult<()> {
        for (corners, value) in &panel.cells {
            let position = self.scale.position(*value).unwrap_or(low);
            let colour = self.colour((position - low) / (high - low));
            area.draw(&Polygon::new(corners.map(place).to_vec(), colour.filled()))?;
        }
        Ok(())
    }

    fn draw_bar(
        &self,
        area: &Area<'_>,
        (low, high): (f64, f64),
        [top, bottom]: [i32; 2],
    ) -> DrawResult<()> {
        let left = (WIDTH - BAR_WIDTH) as i32 + 22;
        let right = left + 18;
        for y in top..bottom {
            let share = f64::from(bottom - 1 - y) / f64::from(bottom - 1 - top);
            area.draw(&Rectangle::new(
                [(left, y), (right, y + 1)],
                self.colour(share).filled(),
            ))?;
        }
        area.draw(&Rectangle::new(
            [(left, top), (right, bottom)],
            INK.stroke_width(1),
        ))?;
        let style = text(13).pos(Pos::new(HPos::Left, VPos::Center));
        for position in ticks(low, high, self.scale) {
            let share = (position - low) / (high - low);
            let y = bottom - (share * f64::from(bottom - top)).round() as i32;
            area.draw(&PathElement::new(vec![(right, y), (right + 4, y)], INK))?;
            area.draw(&Text::new(
                self.scale.label(position),
                (right + 8, y),
                style.clone(),
            ))?;
        }
        let name = text(13).pos(Pos::new(HPos::Right, VPos::Center));
        area.draw(&Text::new(
            self.quantity.clone(),
            (WIDTH as i32 - 16, 24),
            name,
        ))?;
        Ok(())
    }
}

/// Round positions between `low` and `high`.
fn ticks(low: f64, high: f64, scale: Scale) -> Vec<f64> {
    let step = match scale {
        Scale::Logarithmic => 1.0,
        Scale::Linear => {
            let raw = (high - low) / 6.0;
            let decade = 10f64.powf(raw.log10().floor());
            let nice = [1.0, 2.0, 2.5, 5.0, 10.0]
                .into_iter()
                .map(|factor| factor * decade);
            nice.into_iter().find(|step| *step >= raw).unwrap_or(raw)
        }
    };
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

fn draw_width_axis(
    area: &Area<'_>,
    low: [f64; 2],
    high: [f64; 2],
    place: &dyn Fn([f64; 2]) -> (i32, i32),
) -> DrawResult<()> {
    let style = text(12).pos(Pos::new(HPos::Right, VPos::Center));
    let (x, _) = place(low);
    for y in [low[1], (low[1] + high[1]) / 2.0, high[1]] {
        let (_, row) = place([low[0], y]);
        area.draw(&PathElement::new(vec![(x - 8, row), (x - 3, row)], INK))?;
        area.draw(&Text::new(
            super::tick((10.0 * y).round() / 10.0),
            (x - 11, row),
            style.clone(),
        ))?;
    }
    Ok(())
}

fn draw_length_axis(
    area: &Area<'_>,
    low: [f64; 2],
    high: [f64; 2],
    place: &dyn Fn([f64; 2]) -> (i32, i32),
) -> DrawResult<()> {
    let style = text(12).pos(Pos::new(HPos::Center, VPos::Top));
    let (_, bottom) = place(low);
    area.draw(&PathElement::new(
        vec![(place(low).0, bottom + 4), (place(high).0, bottom + 4)],
        PALE,
    ))?;
    for x in ticks(low[0], high[0], Scale::Linear) {
        let (column, _) = place([x, low[1]]);
        area.draw(&PathElement::new(
            vec![(column, bottom + 4), (column, bottom + 9)],
            INK,
        ))?;
        area.draw(&Text::new(
            super::tick(x),
            (column, bottom + 12),
            style.clone(),
        ))?;
    }
    let name = text(12).pos(Pos::new(HPos::Right, VPos::Top));
    area.draw(&Text::new(
        "x, y in mm".to_owned(),
        (place(high).0, bottom + 28),
        name,
    ))?;
    Ok(())
}
