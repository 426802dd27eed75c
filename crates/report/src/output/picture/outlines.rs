//! Meshes by the outlines of their cells, and their named groups.

use super::canvas::{EDGE, GAP, Sheet, render};
use super::layout::Layout;
use super::look::Look;
use super::marks::{Align, Colour, DrawResult, Mark, Pen, Rectangle, Size};
use super::paint::Painter;
use crate::results::{MeshFigure, NamedLines, PALETTE, PictureFormat};

const ROW_HEIGHT: f64 = 20.0;

/// From the left end of a sample to its name, and from a name to the next sample.
const SAMPLE: f64 = 28.0;
const APART: f64 = 18.0;

impl MeshFigure {
    /// The figure as a file, in true proportions.
    pub(super) fn drawn(&self, look: Look, format: PictureFormat) -> DrawResult<Vec<u8>> {
        let layout = self.layout(look);
        let (size, marks) = self.marks(&layout);
        render(
            size,
            look,
            format,
            |painter| self.paint(painter, &layout),
            marks,
        )
    }

    pub(super) fn layout(&self, look: Look) -> Layout {
        let widths = self
            .groups
            .iter()
            .map(|group| look.name().width(&group.name));
        let widest = SAMPLE + widths.fold(0.0, f64::max);
        Layout::of(
            look,
            &self.title,
            widest,
            self.cells.iter().flatten().copied(),
        )
        .without_labels()
    }

    /// What is written around the mesh, and the size of the picture.
    pub(super) fn marks(&self, layout: &Layout) -> (Size, Vec<Mark>) {
        let look = layout.look;
        let mut sheet = Sheet::new(look);
        layout.draw(&mut sheet, &self.title, 1);
        let right = layout.width - EDGE;
        let [mut x, mut y] = [layout.left, layout.bottom(1) + GAP + 0.5 * ROW_HEIGHT];
        for (group, index) in self.groups.iter().zip(0..) {
            let width = SAMPLE + look.name().width(&group.name);
            if x > layout.left && x + width > right {
                (x, y) = (layout.left, y + ROW_HEIGHT);
            }
            GroupLook::of(look, group, index).sample(&mut sheet, [x, y]);
            sheet.write(&group.name, [x + SAMPLE, y], Align::Left, look.name());
            x += width + APART;
        }
        let rows = if self.groups.is_empty() {
            0.0
        } else {
            0.5 * ROW_HEIGHT
        };
        ((layout.width as u32, (y + rows + EDGE) as u32), sheet.marks)
    }

    fn paint(&self, painter: &mut Painter, layout: &Layout) {
        let few = self.cells.len() < 5_000;
        let cells = layout.placed(0, &self.cells);
        let groups = || self.groups.iter().zip(0..);
        for (group, index) in groups().filter(|(group, _)| !group.cells.is_empty()) {
            let table = [GroupLook::of(layout.look, group, index).colour];
            for triangle in group.cells.iter().flat_map(|cell| triangles(&cells[*cell])) {
                painter.shade(triangle, [0.0; 3], &|_| 0.0, &table);
            }
        }
        let width = if few { 0.6 } else { 0.3 };
        let outlines = cells.iter().map(|line| &line[..]);
        painter.lines_above(outlines, Pen::new(layout.look.ink(), width));
        for (group, index) in groups().filter(|(group, _)| group.cells.is_empty()) {
            let mark = GroupLook::of(layout.look, group, index);
            let lines = layout.placed(0, &group.lines);
            let width = if mark.is_dots { 6.0 } else { 3.0 };
            let mut draw = |colour, width| {
                painter.lines_above(lines.iter().map(|line| &line[..]), Pen::new(colour, width));
            };
            draw(mark.colour, width);
            if let Some(core) = mark.core {
                draw(core, width / 2.5);
            }
        }
    }
}

/// A closed line as triangles around its middle.
fn triangles(outline: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 3]> {
    let count = outline.len().saturating_sub(1).max(1) as f64;
    let middle = [0, 1].map(|axis| {
        let positions = outline.iter().skip(1);
        positions.map(|position| position[axis]).sum::<f64>() / count
    });
    outline
        .windows(2)
        .map(move |side| [middle, side[0], side[1]])
}

/// How a group is drawn: a region as an area, sides as lines, nodes as dots. Beyond the last colour, areas are darker and lines hollow.
struct GroupLook {
    colour: Colour,
    core: Option<Colour>,
    is_area: bool,
    is_dots: bool,
}

impl GroupLook {
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
    fn sample(&self, sheet: &mut Sheet, [x, y]: [f64; 2]) {
        let ([left, right], half) = match (self.is_area, self.is_dots) {
            (true, _) => ([0.0, 20.0], 7.0),
            (_, true) => ([7.0, 13.0], 3.0),
            _ => ([0.0, 20.0], 2.5),
        };
        let mut fill = |half: f64, colour| {
            let area = Rectangle::new([x + left, y - half], [x + right, y + half]);
            sheet.put(Mark::rectangle(area, colour));
        };
        fill(half, self.colour);
        if let Some(core) = self.core {
            fill(half / 2.5, core);
        }
    }
}
