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
                let swatch = [[0.0, -3.0], [20.0, -3.0], [20.0, 3.0], [0.0, 3.0]];
                pen.fill(
                    &swatch.map(|[dx, dy]| [x + dx, y + dy]),
                    colour(look, index),
                )?;
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
        let pen = |colour, width| Thin {
            colour,
            width,
            cover: 255,
        };
        let cells = placed(&self.cells);
        let cells = cells.iter().map(|line| &line[..]);
        painter.lines_above(cells, pen(layout.look.ink(), if few { 0.6 } else { 0.3 }));
        for (group, index) in self.groups.iter().zip(0..) {
            let lines = placed(&group.lines);
            let pen = pen(colour(layout.look, index), 3.0);
            painter.lines_above(lines.iter().map(|line| &line[..]), pen);
        }
    }
}

fn colour(look: Look, index: usize) -> RGBColor {
    look.line(PALETTE[index % PALETTE.len()])
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
