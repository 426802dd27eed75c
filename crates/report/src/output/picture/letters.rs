//! The letters of all pictures, of an embedded font: they look the same on every machine, whatever fonts it has.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve, Point};
use tiny_skia::{Path, PathBuilder};

use super::marks::{Letters, Words};

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

/// How wide words are in points.
pub(super) fn width(words: &str, letters: Letters) -> f64 {
    let face = Face::of(letters);
    let advances = words.chars().map(|letter| face.font.glyph_id(letter));
    let thousandths: f32 = advances.map(|letter| face.advance(letter)).sum();
    f64::from(thousandths) / 1000.0 * f64::from(letters.size)
}

/// Words as curves; `None` of words without any.
pub(super) fn curves(words: &Words) -> Option<Path> {
    let face = Face::of(words.letters);
    let scale = words.letters.size as f32 / face.units_per_em();
    let [left, base] = words.start().map(|end| end as f32);
    let mut path = PathBuilder::new();
    let mut along = 0.0;
    for letter in words.words.chars().map(|letter| face.font.glyph_id(letter)) {
        let at = |point: Point| {
            let [x, y] = [scale * (point.x + along), scale * point.y];
            if words.is_turned {
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
    use super::super::marks::Align;
    use super::*;

    #[test]
    fn letters_are_as_wide_as_they_are_measured_and_around_their_place() {
        let mut words = Words {
            words: "HIH".into(),
            at: [100.0, 50.0],
            align: Align::Centre,
            letters: Letters::regular(20),
            colour: [0; 3],
            is_turned: false,
        };
        for is_turned in [false, true] {
            words.is_turned = is_turned;
            let (drawn, told) = (curves(&words).unwrap().bounds(), words.bounds());
            let middle = [drawn.left() + drawn.right(), drawn.top() + drawn.bottom()];
            assert!((0.5 * middle[0] - 100.0).abs() < 0.5, "{drawn:?}");
            assert!((0.5 * middle[1] - 50.0).abs() < 0.5, "{drawn:?}");
            assert!(f64::from(drawn.left()) > told.low[0]);
            assert!(f64::from(drawn.bottom()) < told.high[1]);
        }
        let width = |words: &str| width(words, Letters::regular(20));
        assert!((width("mm") - 2.0 * width("m")).abs() < 1e-3);
    }

    #[test]
    fn spaces_have_no_curves() {
        let words = Words {
            words: " ".into(),
            at: [0.0; 2],
            align: Align::Left,
            letters: Letters::bold(20),
            colour: [0; 3],
            is_turned: false,
        };
        assert!(curves(&words).is_none());
    }
}
