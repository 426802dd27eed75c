//! Line charts one below the other. Everything is placed by the measured size of its texts.

use plotters::coord::CoordTranslate;
use plotters::element::{Circle, PathElement, Polygon, Rectangle as RectangleElement};
use plotters::prelude::Cartesian2d;
use plotters::style::{Color, ShapeStyle};

use super::backend::{Coordinates, chart, opaque, point, units};
use super::canvas::{EDGE, GAP, Sheet, Title, render};
use super::legend::Legend;
use super::look::Look;
use super::marks::{Align, DrawResult, Mark, Pen, Rectangle, Size};
use super::numbers::Ticks;
use super::thin;
use crate::results::{Axis, Line, LineChart, PictureFormat, Stroke};

/// The width of a picture for a screen in points.
const WIDTH: u32 = 860;

/// From an axis to the middle of its numbers below it, and to the end of those on its left.
const BELOW: f64 = 15.0;
const BESIDE: f64 = 8.0;

/// Between a label and the numbers of a vertical axis.
const APART: f64 = 4.0;

/// Charts one below the other as one picture, with their heights in points.
pub(super) fn stacked(
    charts: &[(LineChart, u32)],
    look: Look,
    format: PictureFormat,
) -> DrawResult<Vec<u8>> {
    let plan = Plan::of(charts, look);
    render(plan.size, look, format, |_| (), plan.marks(look)?)
}

/// Where everything is in a picture of charts.
pub(super) struct Plan<'a> {
    pub size: Size,
    pub frames: Vec<Frame<'a>>,
}

/// Where a chart is.
pub(super) struct Frame<'a> {
    chart: &'a LineChart,
    title: Title,
    pub area: Rectangle,
    pub x: Scaled,
    pub y: Scaled,
    /// Whether the chart below has the same axis, and alone its numbers.
    is_above_its_like: bool,
    /// `None` where the chart above has the same.
    pub legend: Option<Legend<'a>>,
}

/// An axis with its limits.
pub(super) struct Scaled {
    limits: [f64; 2],
    pub ticks: Ticks,
    label: Vec<String>,
}

impl Scaled {
    fn new(axis: &Axis, limits: [f64; 2], ticks: Ticks, length: f64, look: Look) -> Self {
        let label = ticks.numbers.labelled(&axis.label);
        Self {
            limits,
            ticks,
            label: look.name().lines(&label, length),
        }
    }

    /// A horizontal axis with as many ticks as have room beside one another.
    fn horizontal(axis: &Axis, limits: [f64; 2], length: f64, look: Look) -> Self {
        let ticks = Ticks::fitting(limits, axis.scale, length, look.number());
        Self::new(axis, limits, ticks, length, look)
    }

    fn share(&self, position: f64) -> f64 {
        (position - self.limits[0]) / (self.limits[1] - self.limits[0])
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.limits[0]..self.limits[1]
    }
}

impl<'a> Plan<'a> {
    pub fn of(charts: &'a [(LineChart, u32)], look: Look) -> Self {
        let width = look.points(WIDTH);
        let ranges = shared_ranges(charts);
        let heights = charts.iter().map(|(_, height)| area_height(*height, look));
        let heights: Vec<f64> = heights.collect();
        let verticals: Vec<Scaled> = charts
            .iter()
            .zip(&heights)
            .map(|((chart, _), height)| {
                let limits = chart.y.scale.limits(chart.positions(1));
                let most = ((height / 26.0) as usize).clamp(4, 8);
                let ticks = Ticks::within(limits, chart.y.scale, most);
                Scaled::new(&chart.y, limits, ticks, *height, look)
            })
            .collect();
        let widths = verticals.iter().map(|axis| axis_width(axis, look));
        let left = widths.fold(0.0, f64::max);
        let mut frames: Vec<Frame> = Vec::new();
        let mut top = EDGE;
        let parts = charts.iter().zip(verticals).zip(heights).zip(ranges);
        for ((((chart, _), y), height), range) in parts {
            let room = [left, top, f64::from(width) - EDGE, height];
            let below = charts.get(frames.len() + 1);
            let mut frame = Frame::new(chart, look, room, range, y);
            frame.is_above_its_like = below.is_some_and(|(below, _)| below.x == chart.x);
            let is_repeated = frames
                .last()
                .is_some_and(|above| same_names(above.chart, chart));
            top = frame.finish(look, is_repeated, left, f64::from(width) - EDGE);
            frames.push(frame);
            if !frames[frames.len() - 1].is_above_its_like {
                top = place_below(&mut frames, top);
            }
        }
        Self {
            size: (width, (top - GAP + EDGE) as u32),
            frames,
        }
    }

    pub fn marks(&self, look: Look) -> DrawResult<Vec<Mark>> {
        let mut sheet = Sheet::new(look);
        for frame in &self.frames {
            frame.draw(&mut sheet)?;
        }
        Ok(sheet.marks)
    }
}

/// The height of the area of a chart that is to be so high on a screen.
fn area_height(height: u32, look: Look) -> f64 {
    let area = f64::from(height) - 110.0;
    if look.is_narrow() {
        (0.62 * area).max(100.0)
    } else {
        area
    }
}

/// What numbers and label of a vertical axis take.
fn axis_width(axis: &Scaled, look: Look) -> f64 {
    let ticks = axis.ticks.at.iter();
    let widths = ticks.map(|(_, number)| look.number().width(number));
    let label = look.name().line_height() * axis.label.len() as f64;
    EDGE + label + APART + widths.fold(0.0, f64::max) + BESIDE
}

/// Of every chart the limits of its horizontal axis, which it shares with those above and below that have the same.
fn shared_ranges(charts: &[(LineChart, u32)]) -> Vec<[f64; 2]> {
    let alike = charts.chunk_by(|(above, _), (below, _)| above.x == below.x);
    let ranges = alike.flat_map(|alike| {
        let positions = alike.iter().flat_map(|(chart, _)| chart.positions(0));
        let limits = alike[0].0.x.scale.limits(positions);
        alike.iter().map(move |_| limits)
    });
    ranges.collect()
}

/// Places the names below the last of the charts with a common axis; the upper end of the room below them.
fn place_below(frames: &mut [Frame], top: f64) -> f64 {
    let above = frames.iter().rev().skip(1);
    let alike = above.take_while(|frame| frame.is_above_its_like).count();
    let last = frames.len() - 1;
    let mut bottom = top - GAP;
    for frame in &mut frames[last - alike..last] {
        if let Some(legend) = &mut frame.legend {
            legend.move_to(bottom);
            bottom += legend.below;
        }
    }
    bottom + GAP
}

/// Whether two charts have the same names in their legends.
fn same_names(one: &LineChart, other: &LineChart) -> bool {
    let names = |chart: &LineChart| -> Vec<_> {
        let named = chart.lines.iter().filter(|line| !line.label.is_empty());
        named
            .map(|line| (line.label.clone(), line.colour))
            .collect()
    };
    names(one) == names(other) && one.band == other.band && other.notes.is_empty()
}

impl<'a> Frame<'a> {
    fn new(
        chart: &'a LineChart,
        look: Look,
        [left, top, right, height]: [f64; 4],
        limits: [f64; 2],
        y: Scaled,
    ) -> Self {
        let title = Title::new(&chart.title, look, [left, top], right - left);
        let top = top + title.height();
        let mut x = Scaled::horizontal(&chart.x, limits, right - left, look);
        // The last number may reach beyond the end of its axis.
        let mut end = right;
        if let Some((at, label)) = x.ticks.at.last() {
            let overhang = 0.5 * look.number().width(label) - (1.0 - x.share(*at)) * (right - left);
            end -= overhang.max(0.0);
            x = Scaled::horizontal(&chart.x, limits, end - left, look);
        }
        Self {
            chart,
            title,
            area: Rectangle::new([left, top], [end, top + height]),
            x,
            y,
            is_above_its_like: false,
            legend: None,
        }
    }

    /// Places the names of lines; the upper end of the room below the chart.
    fn finish(&mut self, look: Look, is_repeated: bool, left: f64, right: f64) -> f64 {
        let below = if self.is_above_its_like {
            GAP
        } else {
            BELOW + look.name().line_height() * self.x.label.len() as f64 + GAP
        };
        let bottom = self.area.high[1] + below;
        if is_repeated {
            return bottom + GAP;
        }
        let drawn: Vec<(bool, Vec<[f64; 2]>)> = self
            .chart
            .lines
            .iter()
            .map(|line| (line.stroke != Stroke::Points, self.pixels(line)))
            .collect();
        let is_free = |part: &Rectangle| {
            let part = part.grown(6.0);
            drawn.iter().all(|(is_joined, pixels)| {
                let pairs = pixels.windows(2).filter(|_| *is_joined);
                let pieces = pairs.map(|piece| [piece[0], piece[1]]);
                let points = pixels.iter().map(|pixel| [*pixel; 2]);
                !pieces.chain(points).any(|piece| part.meets(piece))
            })
        };
        let legend = Legend::of(self.chart, look, self.area, &is_free, [left, right, bottom]);
        // Names of charts with a common axis are placed below all of them.
        let below = if self.is_above_its_like {
            0.0
        } else {
            legend.below
        };
        self.legend = Some(legend);
        bottom + below + GAP
    }

    fn coordinates(&self) -> Coordinates {
        let ([left, top], [right, bottom]) = (self.area.low.map(units), self.area.high.map(units));
        Cartesian2d::new(self.x.range(), self.y.range(), (left..right, bottom..top))
    }

    /// Where a point is whose positions on the axes are given.
    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        point(self.coordinates().translate(&(x, y)))
    }

    /// Where the points of a line are.
    fn pixels(&self, line: &Line) -> Vec<[f64; 2]> {
        let points = self.positions(line);
        points.iter().map(|(x, y)| self.pixel([*x, *y])).collect()
    }

    /// The positions of a line's points, of many only those that can be distinguished.
    fn positions(&self, line: &Line) -> Vec<(f64, f64)> {
        let position = |[x, y]: &[f64; 2]| {
            let [x, y] = [
                self.chart.x.scale.position(*x)?,
                self.chart.y.scale.position(*y)?,
            ];
            Some((x, y))
        };
        let points: Vec<_> = line.points.iter().filter_map(position).collect();
        if line.is_dashed_between_points() || line.stroke == Stroke::Points {
            thin::scattered(points)
        } else {
            thin::connected(points)
        }
    }

    fn draw(&self, sheet: &mut Sheet) -> DrawResult<()> {
        self.title.draw(sheet);
        self.draw_grid(sheet)?;
        let ([left, top], [right, bottom]) = (self.area.low, self.area.high);
        sheet.axis(&[[left, top], [left, bottom], [right, bottom]]);
        self.draw_axes(sheet);
        for line in &self.chart.lines {
            self.draw_line(sheet, line)?;
        }
        if let Some(legend) = &self.legend {
            legend.draw(sheet);
        }
        Ok(())
    }

    fn draw_grid(&self, sheet: &mut Sheet) -> DrawResult<()> {
        let (band, pale) = (sheet.look.band(), Pen::new(sheet.look.pale(), 1.0).style());
        let ([left, right], [bottom, top]) = (self.x.limits, self.y.limits);
        let chart = chart(sheet, None, self.coordinates());
        if let Some((range, _)) = &self.chart.band {
            let ends = range.map(|end| self.chart.x.scale.position(end).unwrap_or(end));
            let [from, to] = ends.map(|end| end.clamp(left, right));
            let filled = opaque(band).filled();
            chart.draw(&RectangleElement::new([(from, bottom), (to, top)], filled))?;
        }
        for (at, _) in &self.x.ticks.at {
            chart.draw(&PathElement::new([(*at, bottom), (*at, top)], pale))?;
        }
        for (at, _) in &self.y.ticks.at {
            chart.draw(&PathElement::new([(left, *at), (right, *at)], pale))?;
        }
        Ok(())
    }

    fn draw_axes(&self, sheet: &mut Sheet) {
        let look = sheet.look;
        let ([left, top], [right, bottom]) = (self.area.low, self.area.high);
        for (at, label) in &self.x.ticks.at {
            let [x, _] = self.pixel([*at, 0.0]);
            sheet.axis(&[[x, bottom], [x, bottom + 4.0]]);
            if !self.is_above_its_like {
                sheet.write(label, [x, bottom + BELOW], Align::Centre, look.number());
            }
        }
        if !self.is_above_its_like {
            let below = BELOW + GAP + 0.5 * look.name().line_height() + 2.0;
            let at = [0.5 * (left + right), bottom + below];
            sheet.write_lines(&self.x.label, at, Align::Centre, look.name());
        }
        for (at, label) in &self.y.ticks.at {
            let [_, y] = self.pixel([0.0, *at]);
            sheet.axis(&[[left - 4.0, y], [left, y]]);
            sheet.write(label, [left - BESIDE, y], Align::Right, look.number());
        }
        // In line with those of the charts above and below.
        let lines = self.y.label.len() as f64;
        let last = EDGE + (lines - 0.5) * look.name().line_height();
        let at = [last, 0.5 * (top + bottom)];
        sheet.write_upwards(&self.y.label, at, look.name());
    }

    fn draw_line(&self, sheet: &mut Sheet, line: &Line) -> DrawResult<()> {
        let look = sheet.look;
        let points = self.positions(line);
        let radius = match (points.len(), look.is_narrow()) {
            // A curve below can be seen between them.
            (201.., _) => 1.5,
            (61.., _) => 2.0,
            (_, true) => 3.0,
            (_, false) => 4.0,
        };
        let pen = line.pen(look);
        let dashes = pen.and_then(|pen| pen.dashes);
        let chart = chart(sheet, dashes, self.coordinates());
        if line.stroke == Stroke::Filled {
            let area = opaque(look.area(line.colour)).filled();
            chart.draw(&Polygon::new(points, area))?;
            return Ok(());
        }
        if let Some(pen) = pen {
            chart.draw(&PathElement::new(points.clone(), pen.style()))?;
        }
        if let Some((radius, pen, filled)) = line.marker(radius, look) {
            let style = ShapeStyle {
                filled,
                ..pen.style()
            };
            for point in points {
                chart.draw(&Circle::new(point, units(radius), style))?;
            }
        }
        Ok(())
    }
}

impl LineChart {
    fn positions(&self, axis: usize) -> impl Iterator<Item = f64> {
        let scale = [self.x.scale, self.y.scale][axis];
        let points = self.lines.iter().flat_map(|line| &line.points);
        points.filter_map(move |point| scale.position(point[axis]))
    }
}
