//! Meshes by the outlines of their cells, and their named groups.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::canvas::{DrawResult, INK, render, text};
use super::layout::{AXIS_HEIGHT, LEFT, Layout, Pen, RIGHT, WIDTH};
use super::paint::{Painter, Thin};
use crate::results::{MeshFigure, NamedLines, PALETTE};

const ROW_HEIGHT: f64 = 22.0;

/// Most points that a name takes for each of its characters.
const CHARACTER: f64 = 9.0;

impl MeshFigure {
    /// The figure as a PNG, in true proportions.
    pub fn png(&self) -> DrawResult<Vec<u8>> {
        let layout = Layout::of(self.cells.iter().flatten().copied());
        let bottom = layout.panel_top(1) + AXIS_HEIGHT;
        let (names, rows) = legend(&self.groups);
        let paint = |painter: &mut Painter| self.paint(painter, &layout);
        let draw = |area: &DrawingArea<SVGBackend<'_>, Shift>| {
            let pen = Pen(area);
            pen.title(&self.title)?;
            layout.draw_width_axis(&pen, 0)?;
            layout.draw_length_axis(&pen, 0)?;
            for ((group, [x, row]), index) in self.groups.iter().zip(&names).zip(0..) {
                let y = bottom + ROW_HEIGHT * (row + 0.5);
                let swatch = [[0.0, -3.0], [20.0, -3.0], [20.0, 3.0], [0.0, 3.0]];
                pen.fill(&swatch.map(|[dx, dy]| [x + dx, y + dy]), colour(index))?;
                pen.write(&group.name, [x + 28.0, y], text(13), HPos::Left)?;
            }
            Ok(())
        };
        let height = bottom + ROW_HEIGHT * rows;
        render((WIDTH as u32, height as u32), paint, draw)
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
        painter.lines(cells, pen(INK, if few { 0.6 } else { 0.3 }));
        for (group, index) in self.groups.iter().zip(0..) {
            let lines = placed(&group.lines);
            painter.lines(lines.iter().map(|line| &line[..]), pen(colour(index), 3.0));
        }
    }
}

fn colour(index: usize) -> RGBColor {
    let [red, green, blue] = PALETTE[index % PALETTE.len()];
    RGBColor(red, green, blue)
}

/// Where each name stands, by its left end and its row, and how many rows there are.
fn legend(groups: &[NamedLines]) -> (Vec<[f64; 2]>, f64) {
    let (mut x, mut row) = (LEFT, 0.0);
    let mut places = Vec::new();
    for group in groups {
        let width = 52.0 + CHARACTER * group.name.chars().count() as f64;
        if x > LEFT && x + width > WIDTH - RIGHT {
            (x, row) = (LEFT, row + 1.0);
        }
        places.push([x, row]);
        x += width;
    }
    let rows = if groups.is_empty() { 0.0 } else { row + 1.5 };
    (places, rows)
}
