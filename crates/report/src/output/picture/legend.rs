//! How the lines of charts are drawn, and their names: inside of the area where no line is, else below it.

use super::canvas::Sheet;
use super::look::Look;
use super::marks::{Align, Mark, Pen, Rectangle};
use crate::results::{Line, LineChart, Stroke};

/// The sample to the left of a name.
enum Sample<'a> {
    Line(&'a Line),
    /// The dashes between computed points.
    Joins,
    Band,
    Nothing,
}

impl Sample<'_> {
    /// From its left end to the name.
    fn width(&self) -> f64 {
        match self {
            Self::Nothing => 0.0,
            Self::Line(_) | Self::Joins | Self::Band => 32.0,
        }
    }
}

struct Entry<'a> {
    sample: Sample<'a>,
    words: Vec<String>,
    width: f64,
}

/// Around the names inside of an area, and between names in a row.
const MARGIN: f64 = 8.0;
const APART: f64 = 18.0;

/// Above names below an area.
const ABOVE: f64 = 4.0;

/// All names of a chart, with their positions.
pub(super) struct Legend<'a> {
    look: Look,
    entries: Vec<(Entry<'a>, [f64; 2])>,
    /// What they cover inside of the area.
    pub inside: Option<Rectangle>,
    /// The height of the names below the area.
    pub below: f64,
    /// The upper end of that.
    top: f64,
}

impl<'a> Legend<'a> {
    /// The legend of a chart with an area, where `is_free` is whether no line crosses a part of it. `left` and `right` are the
    /// ends of the room below the area, of which `bottom` is the upper end.
    pub fn of(
        chart: &'a LineChart,
        look: Look,
        area: Rectangle,
        is_free: &dyn Fn(&Rectangle) -> bool,
        [left, right, bottom]: [f64; 3],
    ) -> Self {
        let entries = entries(chart, look, right - left);
        let line = look.name().line_height();
        let height = |entry: &Entry| line * entry.words.len() as f64;
        let wide = entries.iter().map(|entry| entry.width).fold(0.0, f64::max);
        let high: f64 = entries.iter().map(height).sum();
        let size = [wide, high].map(|length| length + 2.0 * MARGIN);
        let inside = room(area, size, is_free).filter(|_| !entries.is_empty());
        let (mut at, mut placed) = ([left, bottom + 0.5 * line + ABOVE], Vec::new());
        if let Some(inside) = inside {
            at = inside.low.map(|end| end + MARGIN);
            at[1] += 0.5 * line;
        }
        let mut lowest: f64 = 0.0;
        for entry in entries {
            if inside.is_none() && at[0] > left && at[0] + entry.width > right {
                at = [left, at[1] + line];
            }
            lowest = lowest.max(at[1] + height(&entry) - 0.5 * line - bottom);
            let next = if inside.is_some() {
                [at[0], at[1] + height(&entry)]
            } else {
                let rows = line * (entry.words.len() - 1) as f64;
                [at[0] + entry.width + APART, at[1] + rows]
            };
            placed.push((entry, at));
            at = next;
        }
        Self {
            look,
            entries: placed,
            inside,
            below: if inside.is_some() { 0.0 } else { lowest },
            top: bottom,
        }
    }

    /// Moves the names below the area to another upper end.
    pub fn move_to(&mut self, top: f64) {
        if self.inside.is_none() {
            for (_, at) in &mut self.entries {
                at[1] += top - self.top;
            }
            self.top = top;
        }
    }

    pub fn draw(&self, sheet: &mut Sheet) {
        let look = self.look;
        if let Some(inside) = self.inside {
            sheet.put(Mark::rectangle(inside, look.paper()));
        }
        for (entry, [x, y]) in &self.entries {
            let indent = entry.sample.width();
            let area = Rectangle::new([*x, y - 5.0], [x + 24.0, y + 5.0]);
            let sample = [[*x, *y], [x + 24.0, *y]];
            match entry.sample {
                Sample::Line(line) => {
                    if line.stroke == Stroke::Filled {
                        sheet.put(Mark::rectangle(area, look.area(line.colour)));
                    } else if let Some(pen) =
                        line.pen(look).filter(|_| !line.is_dashed_between_points())
                    {
                        sheet.put(Mark::line(&sample, pen));
                    }
                    if let Some((radius, pen, is_filled)) = line.marker(4.0, look) {
                        sheet.put(Mark::circles(&[[x + 12.0, *y]], radius, pen, is_filled));
                    }
                }
                Sample::Joins => {
                    let pen = Pen::new(look.ink(), 1.0).dashed(JOINS);
                    sheet.put(Mark::line(&sample, pen));
                }
                Sample::Band => sheet.put(Mark::rectangle(area, look.band())),
                Sample::Nothing => {}
            }
            sheet.write_lines(&entry.words, [x + indent, *y], Align::Left, look.name());
        }
    }
}

/// The dashes between computed points.
const JOINS: [f32; 2] = [3.0, 4.0];

impl Line {
    /// What its points are joined with; `None` where they are not.
    pub(super) fn pen(&self, look: Look) -> Option<Pen> {
        let pen = |width| Pen::new(look.line(self.colour), width);
        match self.stroke {
            Stroke::Marked | Stroke::Ringed => Some(pen(1.0).dashed(JOINS)),
            Stroke::Dashed => Some(pen(2.0).dashed([7.0, 5.0])),
            Stroke::Solid => Some(pen(2.0)),
            Stroke::Thin => Some(pen(1.0)),
            Stroke::Points | Stroke::Filled => None,
        }
    }

    /// Radius of its markers, their pen, and whether they are filled; `None` where it has none.
    pub(super) fn marker(&self, radius: f64, look: Look) -> Option<(f64, Pen, bool)> {
        let pen = |width| Pen::new(look.line(self.colour), width);
        match self.stroke {
            Stroke::Marked | Stroke::Points => Some((radius, pen(0.0), true)),
            Stroke::Ringed => Some((radius + 2.0, pen(2.0), false)),
            Stroke::Solid | Stroke::Thin | Stroke::Dashed | Stroke::Filled => None,
        }
    }
}

/// Names and remarks with no more than a width of room.
fn entries(chart: &LineChart, look: Look, width: f64) -> Vec<Entry<'_>> {
    let labelled = chart.lines.iter().filter(|line| !line.label.is_empty());
    let named = labelled.map(|line| (Sample::Line(line), &*line.label));
    let joins = chart.dashes().map(|words| (Sample::Joins, words));
    let band = chart.band.as_ref().map(|(_, name)| (Sample::Band, &**name));
    let notes = chart.notes.iter().map(|note| (Sample::Nothing, &**note));
    let all = named.chain(joins).chain(band).chain(notes);
    let entries = all.map(|(sample, words)| {
        let indent = sample.width();
        let words = look.name().lines(words, width - indent);
        let widths = words.iter().map(|line| look.name().width(line));
        let width = indent + widths.fold(0.0, f64::max);
        Entry {
            sample,
            words,
            width,
        }
    });
    entries.collect()
}

/// A free part of an area of a size: in a corner if there is one.
fn room(
    area: Rectangle,
    size: [f64; 2],
    is_free: &dyn Fn(&Rectangle) -> bool,
) -> Option<Rectangle> {
    let spare = [0, 1].map(|axis| area.size()[axis] - size[axis] - 4.0);
    if spare.iter().any(|length| *length < 0.0) {
        return None;
    }
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let fifths = 0..25;
    let others = fifths.map(|position| [position % 5, position / 5].map(|n| f64::from(n) / 4.0));
    let positions = corners.into_iter().chain(others);
    let parts = positions.map(|share| {
        let low = [0, 1].map(|axis| area.low[axis] + 2.0 + share[axis] * spare[axis]);
        Rectangle::new(low, [low[0] + size[0], low[1] + size[1]])
    });
    parts.into_iter().find(|part| is_free(part))
}
