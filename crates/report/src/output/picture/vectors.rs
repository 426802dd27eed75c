//! Pictures whose lines and words are not rasterized: SVG, and the content of PDF.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::escape::escape;
use tiny_skia::{Path, PathSegment, Pixmap};

use super::encode::encode;
use super::letters::{Face, Letters};
use super::marks::{Align, Colour, DrawResult, Mark, Size, Words};

/// The parts of a picture, from below.
pub(super) struct Vectors {
    /// Its size in points of the design.
    pub size: Size,
    pub paper: Colour,
    /// Millimetres of a point.
    pub millimetres: f64,
    /// What is shaded; `None` where nothing is.
    pub image: Option<Pixmap>,
    pub marks: Vec<Mark>,
}

impl Vectors {
    /// The words of the picture.
    pub fn words(&self) -> impl Iterator<Item = &Words> {
        self.marks.iter().filter_map(|mark| match mark {
            Mark::Words(words) => Some(words),
            Mark::Lines(..) | Mark::Area(..) => None,
        })
    }

    /// The picture as SVG, with its fonts.
    pub fn svg(&self) -> DrawResult<Vec<u8>> {
        let (width, height) = self.size;
        let [wide, high] = [width, height].map(|points| f64::from(points) * self.millimetres);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{wide:.2}mm\" \
             height=\"{high:.2}mm\" viewBox=\"0 0 {width} {height}\">\n{}\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
            self.fonts(),
            hexadecimal(self.paper)
        );
        if let Some(image) = &self.image {
            let png = STANDARD.encode(encode(image, None)?);
            writeln!(
                svg,
                "<image width=\"{width}\" height=\"{height}\" xlink:href=\"data:image/png;base64,{png}\"/>"
            )?;
        }
        for mark in &self.marks {
            svg += &element(mark)?;
        }
        svg += "</svg>\n";
        Ok(svg.into_bytes())
    }

    /// The fonts of its words; a program that takes none from a file has the letters of its own sans-serif font.
    fn fonts(&self) -> String {
        let mut style = "<style>\ntext { font-kerning: none; white-space: pre; }\n".to_owned();
        for letters in [Letters::regular(1), Letters::bold(1)] {
            let mut words = self.words();
            if !words.any(|words| words.letters.is_bold == letters.is_bold) {
                continue;
            }
            let file = STANDARD.encode(Face::of(letters).file);
            let weight = weight(letters);
            style += &format!(
                "@font-face {{ font-family: \"DejaVu Sans\"; font-weight: {weight}; src: url(data:font/ttf;base64,{file}); }}\n"
            );
        }
        style + "</style>\n"
    }
}

fn weight(letters: Letters) -> &'static str {
    if letters.is_bold { "bold" } else { "normal" }
}

fn hexadecimal([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn element(mark: &Mark) -> DrawResult<String> {
    Ok(match mark {
        Mark::Lines(path, pen) => {
            let caps = match pen.dashes {
                Some([dash, gap]) => format!("stroke-dasharray=\"{dash} {gap}\""),
                None => "stroke-linecap=\"round\"".to_owned(),
            };
            format!(
                "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{:.3}\" {caps} stroke-linejoin=\"round\" d=\"{}\"/>\n",
                hexadecimal(pen.colour),
                pen.width,
                f64::from(pen.opacity) / 255.0,
                data(path)?
            )
        }
        Mark::Area(path, colour) => {
            let colour = hexadecimal(*colour);
            format!("<path fill=\"{colour}\" d=\"{}\"/>\n", data(path)?)
        }
        Mark::Words(words) => {
            let [x, y] = words.base();
            let anchor = match words.align {
                Align::Left => "start",
                Align::Centre => "middle",
                Align::Right => "end",
            };
            let turned = if words.is_turned {
                format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"")
            } else {
                String::new()
            };
            format!(
                "<text x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"{}\" font-weight=\"{}\" \
                 fill=\"{}\"{turned}>{}</text>\n",
                words.letters.size,
                weight(words.letters),
                hexadecimal(words.colour),
                escape(&words.words)
            )
        }
    })
}

/// The outline of a path.
fn data(path: &Path) -> Result<String, std::fmt::Error> {
    let mut data = String::new();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => write!(data, "M{:.2} {:.2}", to.x, to.y),
            PathSegment::LineTo(to) => write!(data, "L{:.2} {:.2}", to.x, to.y),
            PathSegment::QuadTo(by, to) => {
                write!(data, "Q{:.2} {:.2} {:.2} {:.2}", by.x, by.y, to.x, to.y)
            }
            PathSegment::CubicTo(a, b, to) => {
                write!(data, "C{:.2} {:.2} {:.2} {:.2}", a.x, a.y, b.x, b.y)?;
                write!(data, " {:.2} {:.2}", to.x, to.y)
            }
            PathSegment::Close => write!(data, "Z"),
        }?;
    }
    Ok(data)
}
