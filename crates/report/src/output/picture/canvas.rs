//! A picture of marks above shaded areas, as a file of any format.

use super::encode::encode;
use super::letters::Letters;
use super::look::Look;
use super::marks::{Align, DrawResult, Mark, Size, Words};
use super::paint::Painter;
use super::vectors::Vectors;
use crate::results::PictureFormat;

/// Paints shaded areas into a picture of `size` points, draws marks above them, and returns a file of the format.
pub(super) fn render(
    size: Size,
    look: Look,
    format: PictureFormat,
    paint: impl FnOnce(&mut Painter),
    marks: Vec<Mark>,
) -> DrawResult<Vec<u8>> {
    let mut painter = Painter::new(size, look.paper(), look.pixels())?;
    if format == PictureFormat::Png {
        paint(&mut painter);
        marks.iter().for_each(|mark| painter.draw(mark));
        return Ok(encode(&painter.image, Some(look))?);
    }
    let before = painter.image.clone();
    painter.above = Some(Vec::new());
    paint(&mut painter);
    let mut all = painter.above.unwrap_or_default();
    all.extend(marks);
    let vectors = Vectors {
        size,
        paper: look.paper(),
        millimetres: look.millimetres(),
        image: (painter.image != before).then_some(painter.image),
        marks: all,
    };
    match format {
        PictureFormat::Svg => vectors.svg(),
        PictureFormat::Pdf | PictureFormat::Png => vectors.pdf(),
    }
}

/// Between the edge of a picture and what is in it, and between parts of it.
pub(super) const EDGE: f64 = 12.0;
pub(super) const GAP: f64 = 8.0;

/// What is drawn so far, from below.
pub(super) struct Sheet {
    pub look: Look,
    pub marks: Vec<Mark>,
}

impl Sheet {
    pub fn new(look: Look) -> Self {
        let marks = Vec::new();
        Self { look, marks }
    }

    /// Draws a mark, unless there is nothing to be seen of it.
    pub fn put(&mut self, mark: Option<Mark>) {
        self.marks.extend(mark);
    }

    /// Draws an axis or one of its ticks.
    pub fn axis(&mut self, positions: &[[f64; 2]]) {
        self.put(Mark::line(positions, self.look.axis()));
    }

    /// Writes words around the middle height of a place.
    pub fn write(&mut self, words: &str, at: [f64; 2], align: Align, letters: Letters) {
        self.marks.push(Mark::Words(Words {
            words: words
                .chars()
                .filter(|letter| !letter.is_control())
                .collect(),
            at,
            align,
            letters,
            colour: self.look.ink(),
            is_turned: false,
        }));
    }

    /// Writes lines of words one below the other; the middle height of a further line.
    pub fn write_lines(
        &mut self,
        lines: &[String],
        [x, mut y]: [f64; 2],
        align: Align,
        letters: Letters,
    ) -> f64 {
        for line in lines {
            self.write(line, [x, y], align, letters);
            y += letters.line_height();
        }
        y
    }

    /// Writes lines of words upwards, beside one another around a height, the last of them at a place.
    pub fn write_upwards(&mut self, lines: &[String], [x, y]: [f64; 2], letters: Letters) {
        for (line, back) in lines.iter().rev().zip(0..) {
            let at = [x - f64::from(back) * letters.line_height(), y];
            self.write(line, at, Align::Centre, letters);
            if let Some(Mark::Words(words)) = self.marks.last_mut() {
                words.is_turned = true;
            }
        }
    }
}

/// What stands above a part of a picture.
pub(super) struct Title {
    lines: Vec<String>,
    letters: Letters,
    at: [f64; 2],
}

impl Title {
    /// A title from a left end: in smaller letters, then in several lines where there is no room.
    pub fn new(words: &str, look: Look, [left, top]: [f64; 2], width: f64) -> Self {
        const SMALLEST: u32 = 12;
        let mut letters = look.title();
        while letters.width(words) > width && letters.size > SMALLEST {
            letters.size -= 1;
        }
        let lines = if words.is_empty() {
            Vec::new()
        } else {
            letters.lines(words, width)
        };
        let at = [left, top + 0.5 * letters.line_height()];
        Self { lines, letters, at }
    }

    /// Its height with the gap below it; without words the gap alone.
    pub fn height(&self) -> f64 {
        self.letters.line_height() * self.lines.len() as f64 + GAP
    }

    /// The width of its longest line.
    pub fn width(&self) -> f64 {
        let widths = self.lines.iter().map(|line| self.letters.width(line));
        widths.fold(0.0, f64::max)
    }

    pub fn draw(&self, sheet: &mut Sheet) {
        sheet.write_lines(&self.lines, self.at, Align::Left, self.letters);
    }
}
