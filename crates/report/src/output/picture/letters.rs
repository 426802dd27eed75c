//! Letters as curves: drawings hold no text, and need no font where they are shown.

use std::fmt::Write;
use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, OutlineCurve, Point};
#[cfg(not(target_arch = "wasm32"))]
use plotters::style::FontStyle;
use quick_xml::escape::unescape;

use super::design::DrawResult;
#[cfg(not(target_arch = "wasm32"))]
use super::design::FAMILY;

const REGULAR: &[u8] = include_bytes!("../fonts/dejavu-sans-regular.ttf");
const BOLD: &[u8] = include_bytes!("../fonts/dejavu-sans-bold.ttf");

/// The regular and the bold letters; plotters, which asks how large they are, gets them too, but in a browser, where it asks that.
static FONTS: LazyLock<[FontRef<'static>; 2]> = LazyLock::new(|| {
    #[cfg(not(target_arch = "wasm32"))]
    for (style, bytes) in [(FontStyle::Normal, REGULAR), (FontStyle::Bold, BOLD)] {
        plotters::style::register_font(FAMILY, style, bytes)
            .ok()
            .expect("the embedded font is a font");
    }
    [REGULAR, BOLD]
        .map(|bytes| FontRef::try_from_slice(bytes).expect("the embedded font is a font"))
});

/// Makes the fonts known to plotters.
pub(super) fn register() {
    LazyLock::force(&FONTS);
}

/// What plotters has drawn, with its texts as paths.
pub(super) fn as_curves(svg: &str) -> DrawResult<String> {
    let mut whole = String::with_capacity(4 * svg.len());
    let mut parts = svg.split("<text ");
    whole += parts.next().unwrap_or_default();
    for part in parts {
        let (head, rest) = part.split_once('>').ok_or("a text without an end")?;
        let (words, rest) = rest.split_once("</text>").ok_or("a text without an end")?;
        path(&mut whole, head, unescape(words)?.trim_matches('\n'))?;
        whole += rest;
    }
    Ok(whole)
}

/// The value of an attribute in the head of an element.
fn attribute<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let mut parts = head.split('"');
    let is_named = |part: &&str| part.trim() == format!("{name}=");
    loop {
        let found = parts.next()?;
        let value = parts.next()?;
        if is_named(&found) {
            return Some(value);
        }
    }
}

/// Writes the words of a text of plotters as a path.
fn path(svg: &mut String, head: &str, words: &str) -> DrawResult<()> {
    let of = |name: &str| attribute(head, name).ok_or("a text without its place");
    let [x, y, size] = [of("x")?, of("y")?, of("font-size")?].map(str::parse::<f32>);
    let [x, y, size] = [x?, y?, size?];
    let [regular, bold] = &*FONTS;
    let font = match attribute(head, "font-weight") {
        Some("bold") => bold,
        _ => regular,
    };
    let scale = size / font.units_per_em().unwrap_or(2048.0);
    let (curves, width) = curves(font, words);
    let left = x - scale
        * width
        * match of("text-anchor")? {
            "end" => 1.0,
            "middle" => 0.5,
            _ => 0.0,
        };
    // As plotters says it: below the upper end, around the middle, above the lower end; half an ex is a quarter of the size.
    let base = y + size
        * match of("dy")? {
            "0.76em" => 0.76,
            "0.5ex" => 0.25,
            _ => -0.25,
        };
    let at = |point: Point| (left + scale * point.x, base - scale * point.y);
    write!(
        svg,
        "<path opacity=\"{}\" fill=\"{}\"",
        of("opacity")?,
        of("fill")?
    )?;
    if let Some(turned) = attribute(head, "transform") {
        write!(svg, " transform=\"{turned}\"")?;
    }
    *svg += " d=\"";
    let mut last = None;
    for curve in curves {
        let (from, to) = match &curve {
            OutlineCurve::Line(from, to) => (*from, *to),
            OutlineCurve::Quad(from, _, to) => (*from, *to),
            OutlineCurve::Cubic(from, _, _, to) => (*from, *to),
        };
        if last != Some(from) {
            let close = if last.is_some() { "Z" } else { "" };
            let (x, y) = at(from);
            write!(svg, "{close}M{x:.2} {y:.2}")?;
        }
        let (x, y) = at(to);
        match &curve {
            OutlineCurve::Line(..) => write!(svg, "L{x:.2} {y:.2}")?,
            OutlineCurve::Quad(_, by, _) => {
                let (a, b) = at(*by);
                write!(svg, "Q{a:.2} {b:.2} {x:.2} {y:.2}")?;
            }
            OutlineCurve::Cubic(_, one, two, _) => {
                let ((a, b), (c, d)) = (at(*one), at(*two));
                write!(svg, "C{a:.2} {b:.2} {c:.2} {d:.2} {x:.2} {y:.2}")?;
            }
        }
        last = Some(to);
    }
    *svg += if last.is_some() { "Z\"/>" } else { "\"/>" };
    Ok(())
}

/// The outlines of letters beside one another and their whole width, in units of the font.
fn curves(font: &FontRef, words: &str) -> (Vec<OutlineCurve>, f32) {
    let (mut all, mut x, mut before) = (Vec::new(), 0.0, None);
    for letter in words.chars() {
        let id = font.glyph_id(letter);
        x += before.map_or(0.0, |before| font.kern_unscaled(before, id));
        let moved = |point: Point| Point {
            x: point.x + x,
            ..point
        };
        let outline = font
            .outline(id)
            .map_or(Vec::new(), |outline| outline.curves);
        all.extend(outline.into_iter().map(|curve| match curve {
            OutlineCurve::Line(a, b) => OutlineCurve::Line(moved(a), moved(b)),
            OutlineCurve::Quad(a, b, c) => OutlineCurve::Quad(moved(a), moved(b), moved(c)),
            OutlineCurve::Cubic(a, b, c, d) => {
                OutlineCurve::Cubic(moved(a), moved(b), moved(c), moved(d))
            }
        }));
        x += font.h_advance_unscaled(id);
        before = Some(id);
    }
    (all, x)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "<svg><text x=\"100\" y=\"50\" dy=\"0.5ex\" text-anchor=\"middle\" font-family=\"sans-serif\" \
        font-size=\"20\" opacity=\"1\" fill=\"#000000\" transform=\"rotate(270, 100, 50)\">\n";

    #[test]
    fn texts_become_paths_at_their_places() {
        let drawn = as_curves(&format!("{HEAD}I &lt; ²\n</text><rect/></svg>")).unwrap();
        assert!(
            !drawn.contains("<text") && drawn.ends_with("<rect/></svg>"),
            "{drawn}"
        );
        assert!(drawn.contains("transform=\"rotate(270, 100, 50)\""));
        let path = drawn.split(" d=\"").nth(1).unwrap();
        let numbers = path.split(|c: char| !(c.is_ascii_digit() || c == '.'));
        let numbers: Vec<f32> = numbers.filter_map(|number| number.parse().ok()).collect();
        let across: Vec<f32> = numbers.iter().step_by(2).copied().collect();
        let [low, high] =
            [f32::min, f32::max].map(|pick| across.iter().copied().reduce(pick).unwrap());
        assert!((0.5 * (low + high) - 100.0).abs() < 1.5, "{low} {high}");
        assert!(
            numbers
                .iter()
                .skip(1)
                .step_by(2)
                .all(|y| (35.0..57.0).contains(y))
        );
    }

    #[test]
    fn two_letters_are_as_wide_as_one_and_the_other() {
        let width = |words: &str| curves(&FONTS[0], words).1;
        assert!((width("mm") - 2.0 * width("m")).abs() < 1e-3);
        assert_eq!(curves(&FONTS[0], " ").0.len(), 0);
    }
}
