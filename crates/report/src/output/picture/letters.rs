//! The letters of all pictures, of an embedded font: they look the same on every machine, whatever fonts it has.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve, Point};
use tiny_skia::{Path, PathBuilder};

/// The size and weight of letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Letters {
    pub size: u32,
    pub is_bold: bool,
}

impl Letters {
    /// Regular letters.
    pub fn regular(size: u32) -> Self {
        let is_bold = false;
        Self { size, is_bold }
    }

    /// Bold letters.
    pub fn bold(size: u32) -> Self {
        let is_bold = true;
        Self { size, is_bold }
    }

    /// How wide words are in points.
    pub fn width(self, words: &str) -> f64 {
        let face = Face::of(self);
        let advances = words.chars().map(|letter| face.font.glyph_id(letter));
        let thousandths: f32 = advances.map(|letter| face.advance(letter)).sum();
        f64::from(thousandths) / 1000.0 * f64::from(self.size)
    }

    /// From one line of words to the next.
    pub fn line_height(self) -> f64 {
        1.3 * f64::from(self.size)
    }

    /// Words in lines of some width; a word that is too long has a line of its own.
    pub fn lines(self, words: &str, width: f64) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in words.split(' ') {
            let longer = lines.last().map(|line| format!("{line} {word}"));
            match longer.filter(|line| self.width(line) <= width) {
                Some(longer) => *lines.last_mut().expect("a line was made longer") = longer,
                None => lines.push(word.to_owned()),
            }
        }
        lines
    }
}

/// A font: its name, and its file.
pub(super) struct Face {
    pub name: &'static str,
    pub file: &'static [u8],
    pub font: FontRef<'static>,
}

/// The regular and the bold letters.
static FACES: LazyLock<[Face; 2]> = LazyLock::new(|| {
    let face = |name, file| Face {
        name,
        file,
        font: FontRef::try_from_slice(file).expect("the embedded font is a font"),
    };
    [
        face(
            "DejaVuSans",
            include_bytes!("../fonts/dejavu-sans-regular.ttf"),
        ),
        face(
            "DejaVuSans-Bold",
            include_bytes!("../fonts/dejavu-sans-bold.ttf"),
        ),
    ]
});

impl Face {
    pub fn of(letters: Letters) -> &'static Self {
        &FACES[usize::from(letters.is_bold)]
    }

    pub fn units_per_em(&self) -> f32 {
        self.font.units_per_em().unwrap_or(2048.0)
    }

    /// The width of a letter in thousandths of its size.
    pub fn advance(&self, letter: GlyphId) -> f32 {
        1000.0 * self.font.h_advance_unscaled(letter) / self.units_per_em()
    }
}

/// Words as curves from the beginning of their base line on, which may run upwards; `None` of words without any.
pub(super) fn curves(
    words: &str,
    letters: Letters,
    start: [f64; 2],
    is_turned: bool,
) -> Option<Path> {
    let face = Face::of(letters);
    let scale = letters.size as f32 / face.units_per_em();
    let [left, base] = start.map(|end| end as f32);
    let mut path = PathBuilder::new();
    let mut along = 0.0;
    for letter in words.chars().map(|letter| face.font.glyph_id(letter)) {
        let at = |point: Point| {
            let [x, y] = [scale * (point.x + along), scale * point.y];
            if is_turned {
                (left - y, base - x)
            } else {
                (left + x, base - y)
            }
        };
        let outline = face.font.outline(letter);
        let mut last = None;
        for curve in outline.iter().flat_map(|outline| &outline.curves) {
            last = Some(draw(&mut path, curve, last, &at));
        }
        if last.is_some() {
            path.close();
        }
        along += face.font.h_advance_unscaled(letter);
    }
    path.finish()
}

/// Draws a curve that goes on from the last point or begins a new outline; its end.
fn draw(
    path: &mut PathBuilder,
    curve: &OutlineCurve,
    last: Option<Point>,
    at: &dyn Fn(Point) -> (f32, f32),
) -> Point {
    let (from, to) = match curve {
        OutlineCurve::Line(from, to)
        | OutlineCurve::Quad(from, _, to)
        | OutlineCurve::Cubic(from, _, _, to) => (*from, *to),
    };
    if last != Some(from) {
        if last.is_some() {
            path.close();
        }
        let (x, y) = at(from);
        path.move_to(x, y);
    }
    let (x, y) = at(to);
    match curve {
        OutlineCurve::Line(..) => path.line_to(x, y),
        OutlineCurve::Quad(_, by, _) => {
            let (a, b) = at(*by);
            path.quad_to(a, b, x, y);
        }
        OutlineCurve::Cubic(_, one, two, _) => {
            let ((a, b), (c, d)) = (at(*one), at(*two));
            path.cubic_to(a, b, c, d, x, y);
        }
    }
    to
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_as_wide_as_they_are_measured_from_their_start_on() {
        let letters = Letters::regular(20);
        let width = letters.width("HIH") as f32;
        let drawn = |is_turned| {
            let path = curves("HIH", letters, [100.0, 50.0], is_turned);
            path.unwrap().bounds()
        };
        let [flat, turned] = [false, true].map(drawn);
        assert!(flat.left() > 100.0 && flat.right() < 100.0 + width);
        assert!(flat.width() > 0.8 * width && flat.bottom() <= 50.0);
        assert!(turned.bottom() < 50.0 && turned.top() > 50.0 - width);
        assert!(turned.height() > 0.8 * width && turned.right() <= 100.0);
        // Of a space there is nothing to be seen.
        assert!(curves(" ", letters, [0.0; 2], false).is_none());
    }

    #[test]
    fn words_are_broken_where_they_have_no_room() {
        let bold = Letters::bold(17);
        assert_eq!(bold.lines("Von Mises stress", 900.0), ["Von Mises stress"]);
        assert_eq!(
            bold.lines("Von Mises stress", 110.0),
            ["Von Mises", "stress"]
        );
    }
}
