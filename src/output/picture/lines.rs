//! Line charts.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{DrawResult, FINE, INK, PALE, bold, power_of_ten, render, stroke, text, units};
use super::numbers::common_exponent;
use super::thin;
use crate::results::{Line, LineChart, Scale, Stroke};

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

const WIDTH: u32 = 860;
const LEGEND_WIDTH: u32 = 250;

/// Charts one below the other as one PNG, with their heights in points.
pub fn stacked(charts: &[(LineChart, u32)]) -> DrawResult<Vec<u8>> {
    let height = charts.iter().map(|(_, height)| height).sum();
    let draw = |area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>| {
        let mut rest = area.clone();
        for (chart, height) in charts {
            let (own, below) = rest.split_vertically(FINE * height);
            chart.draw(&own)?;
            rest = below;
        }
        Ok(())
    };
    render((WIDTH, height), |_| (), draw)
}

/// The power of ten that the numbers of an axis have in common: of none but very large and very small ones.
fn power(scale: Scale, [low, high]: [f64; 2]) -> i32 {
    let largest = low.abs().max(high.abs());
    match scale {
        Scale::Linear | Scale::Interval if !(1e-3..1e6).contains(&largest) => {
            common_exponent(largest)
        }
        Scale::Linear | Scale::Interval | Scale::Logarithmic => 0,
    }
}

/// The powers of ten at the ends of the axes.
fn draw_powers(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    powers: [i32; 2],
) -> DrawResult<()> {
    let (_, height) = area.dim_in_pixel();
    let right = units((WIDTH - LEGEND_WIDTH) as i32 - 14);
    let places = [(right, height as i32 - units(22)), (units(84), units(40))];
    let style = text(13).pos(Pos::new(HPos::Right, VPos::Center));
    for (power, place) in powers.into_iter().zip(places) {
        if power != 0 {
            let words = format!("×{}", power_of_ten(f64::from(power)));
            area.draw(&Text::new(words, place, style.clone()))?;
        }
    }
    Ok(())
}

impl LineChart {
    fn draw(&self, area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>) -> DrawResult<()> {
        let (chart_area, legend) = area.split_horizontally(FINE * (WIDTH - LEGEND_WIDTH));
        let positions = |axis: usize| {
            let scale = [self.x.scale, self.y.scale][axis];
            let points = self.lines.iter().flat_map(|line| &line.points);
            points.filter_map(move |point| scale.position(point[axis]))
        };
        let (left, right) = self.x.scale.limits(positions(0));
        let (bottom, top) = self.y.scale.limits(positions(1));
        let title = bold(17).pos(Pos::new(HPos::Left, VPos::Center));
        let place = (units(88), units(24));
        area.draw(&Text::new(self.title.clone(), place, title))?;
        let mut chart = ChartBuilder::on(&chart_area)
            .margin(units(14))
            .margin_top(units(46))
            .x_label_area_size(units(48))
            .y_label_area_size(units(74))
            .build_cartesian_2d(left..right, bottom..top)?;
        if let Some(([from, to], _)) = &self.band {
            let corners = [(from.max(left), bottom), (to.min(right), top)];
            chart.draw_series([Rectangle::new(corners, RGBColor(236, 242, 248).filled())])?;
        }
        let decades = |low: f64, high: f64| (high - low) as usize + 1;
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .axis_desc_style(text(14))
            .label_style(text(13))
            .axis_style(stroke(INK, 1))
            .bold_line_style(stroke(PALE, 1))
            .set_all_tick_mark_size(units(4))
            .light_line_style(TRANSPARENT)
            .x_labels(8)
            .y_labels(match self.y.scale {
                Scale::Linear | Scale::Interval => 7,
                Scale::Logarithmic => decades(bottom, top).min(12),
            });
        let powers = [
            power(self.x.scale, [left, right]),
            power(self.y.scale, [bottom, top]),
        ];
        let units_of = powers.map(|power| 10f64.powi(power));
        mesh.x_label_formatter(&|x| self.x.scale.label(*x / units_of[0]))
            .y_label_formatter(&|y| self.y.scale.label(*y / units_of[1]))
            .draw()?;
        draw_powers(area, powers)?;
        for line in &self.lines {
            self.draw_line(&mut chart, line)?;
        }
        self.draw_legend(&legend)
    }

    fn draw_line(&self, chart: &mut Chart, line: &Line) -> DrawResult<()> {
        let position =
            |[x, y]: &[f64; 2]| Some((self.x.scale.position(*x)?, self.y.scale.position(*y)?));
        let points: Vec<_> = line.points.iter().filter_map(position).collect();
        let points = match line.stroke {
            Stroke::Points | Stroke::Marked => thin::scattered(points),
            Stroke::Solid | Stroke::Thin | Stroke::Dashed | Stroke::Filled => {
                thin::connected(points)
            }
        };
        let colour = line.rgb();
        let pen = line.pen();
        if matches!(line.stroke, Stroke::Marked | Stroke::Points) {
            let radius = units(if points.len() > 60 { 2 } else { 4 });
            let marker = |point: &(f64, f64)| Circle::new(*point, radius, colour.filled());
            chart.draw_series(points.iter().map(marker))?;
        }
        match line.stroke {
            Stroke::Dashed => {
                let dashes = DashedLineSeries::new(points, 7 * FINE, 5 * FINE, pen);
                chart.draw_series(dashes)?;
            }
            Stroke::Points => {}
            Stroke::Filled => {
                chart.draw_series([Polygon::new(points, line.pale().filled())])?;
            }
            Stroke::Solid | Stroke::Thin | Stroke::Marked => {
                chart.draw_series(LineSeries::new(points, pen))?;
            }
        }
        Ok(())
    }

    fn draw_legend(
        &self,
        area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    ) -> DrawResult<()> {
        let style = text(13).pos(Pos::new(HPos::Left, VPos::Center));
        let (left, right) = (units(4), units(34));
        let mut y = units(62);
        for line in self.lines.iter().filter(|line| !line.label.is_empty()) {
            let colour = line.rgb();
            let pen = line.pen();
            let sample = [(left, y), (right, y)];
            match line.stroke {
                Stroke::Dashed => {
                    for x in [4, 16, 28].map(units) {
                        area.draw(&PathElement::new(vec![(x, y), (x + units(6), y)], pen))?;
                    }
                }
                Stroke::Points => {}
                Stroke::Filled => {
                    let corners = [(left, y - units(7)), (right, y + units(7))];
                    area.draw(&Rectangle::new(corners, line.pale().filled()))?;
                }
                Stroke::Solid | Stroke::Thin | Stroke::Marked => {
                    area.draw(&PathElement::new(sample, pen))?
                }
            }
            if matches!(line.stroke, Stroke::Marked | Stroke::Points) {
                area.draw(&Circle::new((units(19), y), units(4), colour.filled()))?;
            }
            area.draw(&Text::new(
                line.label.clone(),
                (units(42), y),
                style.clone(),
            ))?;
            y += units(24);
        }
        if let Some((_, name)) = &self.band {
            let box_corners = [(left, y - units(7)), (right, y + units(7))];
            area.draw(&Rectangle::new(
                box_corners,
                RGBColor(220, 230, 241).filled(),
            ))?;
            area.draw(&Text::new(name.clone(), (units(42), y), style))?;
        }
        Ok(())
    }
}

impl Line {
    fn rgb(&self) -> RGBColor {
        let [red, green, blue] = self.colour;
        RGBColor(red, green, blue)
    }

    fn pen(&self) -> ShapeStyle {
        let width = if self.stroke == Stroke::Thin { 1 } else { 2 };
        stroke(self.rgb(), width)
    }

    /// The colour on white, as an area has it.
    fn pale(&self) -> RGBColor {
        let [red, green, blue] = self.colour.map(|part| 255 - (255 - part) / 4);
        RGBColor(red, green, blue)
    }
}
