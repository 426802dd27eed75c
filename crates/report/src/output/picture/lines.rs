//! Line charts.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{Area, power_of_ten, render, stroke};
use super::design::{DrawResult, FINE, units};
use super::look::{Look, lines};
use super::numbers::common_exponent;
use super::thin;
use crate::results::{Line, LineChart, PictureFormat, Scale, Stroke};

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// The width of a picture for a screen, and what names of lines take of it, in points.
const WIDTH: u32 = 860;
const LEGEND_WIDTH: u32 = 250;
const ROW_HEIGHT: i32 = 24;
const LINE_HEIGHT: i32 = 18;

/// Charts one below the other as one picture, with their heights in points.
pub fn stacked(
    charts: &[(LineChart, u32)],
    look: Look,
    format: PictureFormat,
) -> DrawResult<Vec<u8>> {
    let frames: Vec<Frame> = charts
        .iter()
        .map(|(chart, height)| Frame::new(chart, *height, look))
        .collect();
    let height = frames.iter().map(|frame| frame.height).sum();
    let draw = |area: &Area<'_>| {
        let mut rest = area.clone();
        for ((chart, _), frame) in charts.iter().zip(&frames) {
            let (own, below) = rest.split_vertically(FINE * frame.height);
            chart.draw(&own, frame)?;
            rest = below;
        }
        Ok(())
    };
    render((look.points(WIDTH), height), look, format, |_| (), draw)
}

/// How a chart is arranged, in points.
struct Frame {
    look: Look,
    /// The whole height.
    height: u32,
    /// The chart's own width and height, with its axes and its title.
    chart: (u32, u32),
    title: Vec<String>,
}

impl Frame {
    /// Names of lines stand beside the chart, or below it where there is no room beside it.
    fn new(chart: &LineChart, height: u32, look: Look) -> Self {
        let width = look.points(WIDTH);
        let room = f64::from(width) - 88.0 - 14.0;
        let title = if look.is_printed() {
            lines(&chart.title, Self::title_size(look), room)
        } else {
            vec![chart.title.clone()]
        };
        if !look.is_narrow() {
            return Self {
                look,
                height,
                chart: (width - LEGEND_WIDTH, height),
                title,
            };
        }
        let named = chart.lines.iter().filter(|line| !line.label.is_empty());
        let rows = named.count()
            + usize::from(chart.dashes().is_some())
            + usize::from(chart.band.is_some());
        let more = LINE_HEIGHT as u32 * (title.len() as u32 - 1);
        let own = 7 * height / 10 + more;
        Self {
            look,
            height: own + ROW_HEIGHT as u32 * rows as u32 + 6,
            chart: (width, own),
            title,
        }
    }

    fn title_size(look: Look) -> u32 {
        if look.is_narrow() { 13 } else { 17 }
    }

    /// Chart and names.
    fn split<'a>(&self, area: &Area<'a>) -> (Area<'a>, Area<'a>) {
        if self.look.is_narrow() {
            area.split_vertically(FINE * self.chart.1)
        } else {
            area.split_horizontally(FINE * self.chart.0)
        }
    }

    /// The left and the upper end of the names.
    fn names(&self) -> [i32; 2] {
        if self.look.is_narrow() {
            [88, 10]
        } else {
            [4, 62]
        }
    }

    fn draw_title(&self, area: &Area<'_>) -> DrawResult<()> {
        let style = self.look.bold(Self::title_size(self.look));
        let style = style.pos(Pos::new(HPos::Left, VPos::Center));
        let mut y = 24;
        for line in &self.title {
            let place = (units(88), units(y));
            area.draw(&Text::new(line.clone(), place, style.clone()))?;
            y += LINE_HEIGHT;
        }
        Ok(())
    }

    /// The powers of ten at the ends of the axes.
    fn draw_powers(&self, area: &Area<'_>, powers: [i32; 2]) -> DrawResult<()> {
        let (_, height) = area.dim_in_pixel();
        let right = units(self.chart.0 as i32 - 14);
        let places = [(right, height as i32 - units(22)), (units(84), units(40))];
        let style = self.look.text(13).pos(Pos::new(HPos::Right, VPos::Center));
        for (power, place) in powers.into_iter().zip(places) {
            if power != 0 {
                let words = format!("×{}", power_of_ten(f64::from(power)));
                area.draw(&Text::new(words, place, style.clone()))?;
            }
        }
        Ok(())
    }
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

impl LineChart {
    fn draw(&self, area: &Area<'_>, frame: &Frame) -> DrawResult<()> {
        let look = frame.look;
        let (chart_area, legend) = frame.split(area);
        let positions = |axis: usize| {
            let scale = [self.x.scale, self.y.scale][axis];
            let points = self.lines.iter().flat_map(|line| &line.points);
            points.filter_map(move |point| scale.position(point[axis]))
        };
        let (left, right) = self.x.scale.limits(positions(0));
        let (bottom, top) = self.y.scale.limits(positions(1));
        frame.draw_title(area)?;
        let more_lines = LINE_HEIGHT * (frame.title.len() as i32 - 1);
        let mut chart = ChartBuilder::on(&chart_area)
            .margin(units(14))
            .margin_top(units(46 + more_lines))
            .x_label_area_size(units(48))
            .y_label_area_size(units(74))
            .build_cartesian_2d(left..right, bottom..top)?;
        if let Some((range, _)) = &self.band {
            let [from, to] = range.map(|end| self.x.scale.position(end).unwrap_or(end));
            let corners = [(from.max(left), bottom), (to.min(right), top)];
            chart.draw_series([Rectangle::new(corners, look.band().filled())])?;
        }
        let decades = |low: f64, high: f64| (high - low) as usize + 1;
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .axis_desc_style(look.text(14))
            .label_style(look.text(13))
            .axis_style(look.axis())
            .bold_line_style(stroke(look.pale(), 1))
            .set_all_tick_mark_size(units(4))
            .light_line_style(TRANSPARENT)
            .x_labels(if look.is_narrow() { 5 } else { 8 })
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
        frame.draw_powers(&chart_area, powers)?;
        for line in &self.lines {
            self.draw_line(&mut chart, line, look)?;
        }
        self.draw_legend(&legend, frame)
    }

    fn draw_line(&self, chart: &mut Chart, line: &Line, look: Look) -> DrawResult<()> {
        let position =
            |[x, y]: &[f64; 2]| Some((self.x.scale.position(*x)?, self.y.scale.position(*y)?));
        let points: Vec<_> = line.points.iter().filter_map(position).collect();
        let points = match line.stroke {
            Stroke::Points | Stroke::Marked | Stroke::Ringed => thin::scattered(points),
            Stroke::Solid | Stroke::Thin | Stroke::Dashed | Stroke::Filled => {
                thin::connected(points)
            }
        };
        let pen = line.pen(look);
        let size = if points.len() > 60 { 2 } else { 4 };
        if let Some((radius, style)) = line.marker(size, look) {
            let marker = |point: &(f64, f64)| Circle::new(*point, radius, style);
            chart.draw_series(points.iter().map(marker))?;
        }
        match line.stroke {
            Stroke::Dashed => {
                let dashes = DashedLineSeries::new(points, 7 * FINE, 5 * FINE, pen);
                chart.draw_series(dashes)?;
            }
            Stroke::Points => {}
            Stroke::Filled => {
                chart.draw_series([Polygon::new(points, look.area(line.colour).filled())])?;
            }
            Stroke::Marked | Stroke::Ringed => {
                let dashes = DashedLineSeries::new(points, 3 * FINE, 4 * FINE, pen);
                chart.draw_series(dashes)?;
            }
            Stroke::Solid | Stroke::Thin => {
                chart.draw_series(LineSeries::new(points, pen))?;
            }
        }
        Ok(())
    }

    fn draw_legend(&self, area: &Area<'_>, frame: &Frame) -> DrawResult<()> {
        let look = frame.look;
        let style = look.text(13).pos(Pos::new(HPos::Left, VPos::Center));
        let [left, top] = frame.names();
        let (left, mut y) = (units(left), units(top));
        let right = left + units(30);
        for line in self.lines.iter().filter(|line| !line.label.is_empty()) {
            let pen = line.pen(look);
            let sample = [(left, y), (right, y)];
            match line.stroke {
                Stroke::Dashed => {
                    for x in [0, 12, 24].map(|x| left + units(x)) {
                        area.draw(&PathElement::new(vec![(x, y), (x + units(6), y)], pen))?;
                    }
                }
                Stroke::Points | Stroke::Marked | Stroke::Ringed => {}
                Stroke::Filled => {
                    let corners = [(left, y - units(7)), (right, y + units(7))];
                    area.draw(&Rectangle::new(corners, look.area(line.colour).filled()))?;
                }
                Stroke::Solid | Stroke::Thin => area.draw(&PathElement::new(sample, pen))?,
            }
            if let Some((radius, style)) = line.marker(4, look) {
                area.draw(&Circle::new((left + units(15), y), radius, style))?;
            }
            area.draw(&Text::new(
                line.label.clone(),
                (left + units(38), y),
                style.clone(),
            ))?;
            y += units(ROW_HEIGHT);
        }
        if let Some(words) = self.dashes() {
            for x in [0, 7, 14, 21].map(|x| left + units(x)) {
                let dash = vec![(x, y), (x + units(3), y)];
                area.draw(&PathElement::new(dash, look.axis()))?;
            }
            area.draw(&Text::new(words, (left + units(38), y), style.clone()))?;
            y += units(ROW_HEIGHT);
        }
        if let Some((_, name)) = &self.band {
            let box_corners = [(left, y - units(7)), (right, y + units(7))];
            area.draw(&Rectangle::new(box_corners, look.band().filled()))?;
            area.draw(&Text::new(name.clone(), (left + units(38), y), style))?;
        }
        Ok(())
    }
}

impl Line {
    fn pen(&self, look: Look) -> ShapeStyle {
        let is_thin = self.stroke == Stroke::Thin || self.is_dashed_between_points();
        stroke(look.line(self.colour), if is_thin { 1 } else { 2 })
    }

    /// Radius and style of its markers of a size; `None` where it has none.
    fn marker(&self, size: i32, look: Look) -> Option<(i32, ShapeStyle)> {
        let colour = look.line(self.colour);
        match self.stroke {
            Stroke::Marked | Stroke::Points => Some((units(size), colour.filled())),
            Stroke::Ringed => Some((units(size + 2), stroke(colour, 2))),
            Stroke::Solid | Stroke::Thin | Stroke::Dashed | Stroke::Filled => None,
        }
    }
}
