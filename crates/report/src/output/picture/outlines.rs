//! Meshes by the outlines of their cells, and their named groups.

use plotters::style::RGBColor;
use plotters::style::text_anchor::HPos;

use super::canvas::{Area, render};
use super::design::DrawResult;
use super::layout::{AXIS_HEIGHT, Heading, LEFT, Layout, Pen};
use super::look::Look;
use super::paint::{Painter, Thin};
use crate::results::{MeshFigure, NamedLines, PALETTE, PictureFormat};

const ROW_HEIGHT: f64 = 22.0;

/// What is left free to the right of the names.
const EDGE: f64 = 100.0;

/// Most points that a name takes for each of its characters.
const CHARACTER: f64 = 9.0;

impl MeshFigure {
    /// The figure as a file, in true proportions.
    pub(super) fn drawn(&self, look: Look, format: PictureFormat) -> DrawResult<Vec<u8>> {
        let heading = Heading::new(look, &self.title, "");
        let layout = Layout::of(look, &heading, 0.0, self.cells.iter().flatten().copied());
        let bottom = layout.panel_top(1) + AXIS_HEIGHT;
        let (names, rows) = legend(&self.groups, layout.width());
        let paint = |painter: &mut Painter| self.paint(painter, &layout);
        let draw = |area: &Area<'_>| {
            let pen = Pen { area, look };
            heading.draw(&pen, &layout)?;
            layout.draw_width_axis(&pen, 0)?;
            layout.draw_length_axis(&pen, 0)?;
            for ((group, [x, row]), index) in self.groups.iter().zip(&names).zip(0..) {
                let y = bottom + ROW_HEIGHT * (row + 0.5);
                Mark::of(look, group, index).sample(&pen, [*x, y])?;
                pen.write(&group.name, [x + 28.0, y], look.text(13), HPos::Left)?;
            }
            Ok(())
        };
        let height = bottom + ROW_HEIGHT * rows;
        let size = (layout.width() as u32, height as u32);
        render(size, look, format, paint, draw)
    }

    fn paint(&self, painter: &mut Painter, layout: &Layout) {
        let placed = |lines: &[Vec<[f64; 2]>]| -> Vec<Vec<[f64; 2]>> {
            let lines = lines.iter();
            lines
                .map(|line| line.iter().map(|at| layout.place(0, *at)).collect())
                .collect()
        };
        let few = self.cells.len() < 5_000;
        let cells = placed(&self.cells);
        let groups = || self.groups.iter().zip(0..);
        for (group, index) in groups().filter(|(group, _)| !group.cells.is_empty()) {
            let table = [Mark::of(layout.look, group, index).colour];
            for triangle in group.cells.iter().flat_map(|cell| triangles(&cells[*cell])) {
                painter.shade(triangle, [0.0; 3], &|_| 0.0, &table);
            }
        }
        let width = if few { 0.6 } else { 0.3 };
        let outlines = cells.iter().map(|line| &line[..]);
        painter.lines_above(outlines, pen(layout.look.ink(), width));
        for (group, index) in groups().filter(|(group, _)| group.cells.is_empty()) {
            let mark = Mark::of(layout.look, group, index);
            let lines = placed(&group.lines);
            let width = if mark.is_dots { 6.0 } else { 3.0 };
            let mut draw = |colour, width| {
                painter.lines_above(lines.iter().map(|line| &line[..]), pen(colour, width));
            };
            draw(mark.colour, width);
            if let Some(core) = mark.core {
                draw(core, width / 2.5);
            }
        }
    }
}

fn pen(colour: RGBColor, width: f32) -> Thin {
    Thin {
        colour,
        width,
        cover: 255,
    }
}

/// A closed line as triangles around its middle.
fn triangles(outline: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 3]> {
    let count = outline.len().saturating_sub(1).max(1) as f64;
    let middle = [0, 1].map(|axis| {
        let places = outline.iter().skip(1);
        places.map(|place| place[axis]).sum::<f64>() / count
    });
    outline
        .windows(2)
        .map(move |side| [middle, side[0], side[1]])
}

/// How a group is drawn: a region as an area, sides as lines, nodes as dots. Beyond the last colour, areas are darker and lines hollow.
struct Mark {
    colour: RGBColor,
    core: Option<RGBColor>,
    is_area: bool,
    is_dots: bool,
}

impl Mark {
    fn of(look: Look, group: &NamedLines, index: usize) -> Self {
        let colour = PALETTE[index % PALETTE.len()];
        let again = index >= PALETTE.len();
        let is_area = !group.cells.is_empty();
        let mut ends = group.lines.iter().map(|line| line.first() == line.last());
        Self {
            colour: match (is_area, again) {
                (true, false) => look.area(colour),
                (true, true) => look.darker_area(colour),
                (false, _) => look.line(colour),
            },
            core: (again && !is_area).then(|| look.paper()),
            is_area,
            is_dots: !is_area && ends.all(|is_point| is_point),
        }
    }

    /// A sample beside a name.
    fn sample(&self, pen: &Pen, [x, y]: [f64; 2]) -> DrawResult<()> {
        let fill = |[left, right]: [f64; 2], half: f64, colour| {
            let corners = [[left, -half], [right, -half], [right, half], [left, half]];
            pen.fill(&corners.map(|[dx, dy]| [x + dx, y + dy]), colour)
        };
        let (ends, half) = match (self.is_area, self.is_dots) {
            (true, _) => ([0.0, 20.0], 7.0),
            (_, true) => ([7.0, 13.0], 3.0),
            _ => ([0.0, 20.0], 2.5),
        };
        fill(ends, half, self.colour)?;
        self.core
            .map_or(Ok(()), |core| fill(ends, half / 2.5, core))
    }
}

/// Where each name stands, by its left end and its row, and how many rows there are.
fn legend(groups: &[NamedLines], whole: f64) -> (Vec<[f64; 2]>, f64) {
    let (mut x, mut row) = (LEFT, 0.0);
    let mut places = Vec::new();
    for group in groups {
        let width = 52.0 + CHARACTER * group.name.chars().count() as f64;
        if x > LEFT && x + width > whole - EDGE {
            (x, row) = (LEFT, row + 1.0);
        }
        places.push([x, row]);
        x += width;
    }
    let rows = if groups.is_empty() { 0.0 } else { row + 1.5 };
    (places, rows)
}
