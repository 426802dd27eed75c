//! What a picture is drawn with: lines, areas, discs and words, at places in points of the design.

use tiny_skia::{Path, PathBuilder};

use super::letters::{Letters, curves};

/// A result, or why a picture could not be drawn in the words of a library.
pub(super) type DrawResult<T> = Result<T, Box<dyn std::error::Error>>;

/// Width and height in points of the design.
pub(super) type Size = (u32, u32);

/// Red, green and blue.
pub(super) type Colour = [u8; 3];

/// A line's colour, its width in points and its opacity, up to 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    pub colour: Colour,
    pub width: f32,
    pub opacity: u8,
    /// The lengths of its dashes and of the gaps between them in points.
    pub dashes: Option<[f32; 2]>,
}

impl Pen {
    /// A pen for a solid line.
    pub fn new(colour: Colour, width: f32) -> Self {
        Self {
            colour,
            width,
            opacity: 255,
            dashes: None,
        }
    }

    /// This pen with dashes.
    pub fn dashed(self, dashes: [f32; 2]) -> Self {
        let dashes = Some(dashes);
        Self { dashes, ..self }
    }

    /// This pen with another opacity.
    pub fn with_opacity(self, opacity: u8) -> Self {
        Self { opacity, ..self }
    }
}

/// One thing that is drawn.
#[derive(Clone, Debug)]
pub(super) enum Mark {
    /// Lines of one pen, which do not darken each other where they cross.
    Lines(Path, Pen),
    /// An area of a colour.
    Area(Path, Colour),
    /// Words.
    Words(Words),
}

impl Mark {
    /// Lines through places; `None` where nothing is to be seen of them.
    pub fn lines<'a>(lines: impl IntoIterator<Item = &'a [[f64; 2]]>, pen: Pen) -> Option<Self> {
        let mut path = PathBuilder::new();
        for line in lines {
            follow(&mut path, line);
        }
        path.finish().map(|path| Self::Lines(path, pen))
    }

    /// One line through places.
    pub fn line(line: &[[f64; 2]], pen: Pen) -> Option<Self> {
        Self::lines([line], pen)
    }

    /// The area within a closed line.
    pub fn area(corners: &[[f64; 2]], colour: Colour) -> Option<Self> {
        let mut path = PathBuilder::new();
        follow(&mut path, corners);
        path.close();
        path.finish().map(|path| Self::Area(path, colour))
    }

    /// The area of a rectangle.
    pub fn rectangle(inside: Rectangle, colour: Colour) -> Option<Self> {
        Self::area(&inside.corners(), colour)
    }

    /// Circles around places: discs, or rings of a pen.
    pub fn circles(centres: &[[f64; 2]], radius: f64, pen: Pen, are_filled: bool) -> Option<Self> {
        let mut path = PathBuilder::new();
        for [x, y] in centres {
            path.push_circle(*x as f32, *y as f32, radius as f32);
        }
        let path = path.finish()?;
        Some(if are_filled {
            Self::Area(path, pen.colour)
        } else {
            Self::Lines(path, pen)
        })
    }
}

fn follow(path: &mut PathBuilder, line: &[[f64; 2]]) {
    for (index, [x, y]) in line.iter().enumerate() {
        match index {
            0 => path.move_to(*x as f32, *y as f32),
            _ => path.line_to(*x as f32, *y as f32),
        }
    }
}

/// Which part of words is at their place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Centre,
    Right,
}

/// One line of words, its middle height at a place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Words {
    pub words: String,
    pub at: [f64; 2],
    pub align: Align,
    pub letters: Letters,
    pub colour: Colour,
    /// Whether they run upwards.
    pub is_turned: bool,
}

/// Capital letters reach so far above and below the middle, in sizes of the letters.
const HALF_A_CAPITAL: f64 = 0.365;

impl Words {
    /// The place on their base line that they are aligned to.
    pub fn base(&self) -> [f64; 2] {
        let down = HALF_A_CAPITAL * f64::from(self.letters.size);
        let [x, y] = self.at;
        if self.is_turned {
            [x + down, y]
        } else {
            [x, y + down]
        }
    }

    /// The end of their base line at which they begin.
    pub fn start(&self) -> [f64; 2] {
        let width = self.letters.width(&self.words);
        let before = match self.align {
            Align::Left => 0.0,
            Align::Centre => 0.5 * width,
            Align::Right => width,
        };
        let [x, y] = self.base();
        if self.is_turned {
            [x, y + before]
        } else {
            [x - before, y]
        }
    }

    /// Their outlines; `None` of words without any.
    pub fn curves(&self) -> Option<Path> {
        curves(&self.words, self.letters, self.start(), self.is_turned)
    }

    /// What they cover, with their accents and descenders.
    #[cfg(test)]
    pub fn bounds(&self) -> Rectangle {
        let width = self.letters.width(&self.words);
        let size = f64::from(self.letters.size);
        let (up, down) = (0.76 * size, 0.24 * size);
        let [x, y] = self.start();
        if self.is_turned {
            return Rectangle::new([x - up, y - width], [x + down, y]);
        }
        Rectangle::new([x, y - up], [x + width, y + down])
    }
}

/// A part of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub low: [f64; 2],
    pub high: [f64; 2],
}

impl Rectangle {
    pub fn new(low: [f64; 2], high: [f64; 2]) -> Self {
        Self { low, high }
    }

    pub fn size(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.high[axis] - self.low[axis])
    }

    pub fn corners(&self) -> [[f64; 2]; 4] {
        let ([left, top], [right, bottom]) = (self.low, self.high);
        [[left, top], [right, top], [right, bottom], [left, bottom]]
    }

    /// A rectangle that is so much larger on each side.
    pub fn grown(&self, by: f64) -> Self {
        let low = self.low.map(|end| end - by);
        Self::new(low, self.high.map(|end| end + by))
    }

    /// Whether a piece of a line has a point inside.
    pub fn meets(&self, [from, to]: [[f64; 2]; 2]) -> bool {
        // The part of the piece, from 0 to 1, that lies between the sides of each axis.
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for axis in [0, 1] {
            let along = to[axis] - from[axis];
            let sides = [self.low[axis], self.high[axis]].map(|side| side - from[axis]);
            if along == 0.0 {
                if sides[0] > 0.0 || sides[1] < 0.0 {
                    return false;
                }
                continue;
            }
            let [one, other] = sides.map(|side| side / along);
            first = first.max(one.min(other));
            last = last.min(one.max(other));
        }
        first <= last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_of_a_line_meets_a_rectangle_that_it_crosses_or_ends_in() {
        let inside = Rectangle::new([0.0, 0.0], [4.0, 2.0]);
        assert!(inside.meets([[-1.0, -1.0], [5.0, 3.0]]));
        assert!(inside.meets([[1.0, 1.0], [1.0, 1.0]]));
        assert!(inside.meets([[2.0, -9.0], [2.0, 9.0]]));
        assert!(!inside.meets([[-1.0, 1.9], [1.0, 3.0]]));
        assert!(!inside.meets([[5.0, -9.0], [5.0, 9.0]]));
        assert!(!inside.meets([[5.0, 1.0], [9.0, 1.0]]));
    }
}
