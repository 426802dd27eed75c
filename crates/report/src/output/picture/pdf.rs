//! Pictures as PDF files of one page, with the fonts of their words.

use std::collections::BTreeMap;
use std::io::Write;

use ab_glyph::{Font, GlyphId};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{
    CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap,
};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};
use tiny_skia::{Path, PathSegment, Pixmap};

use super::encode::{colours, full};
use super::letters::{Face, Letters};
use super::marks::{Colour, DrawResult, Mark, Pen, Words};
use super::vectors::Vectors;

/// The names of the regular and the bold font within a page.
const FONTS: [(Name<'static>, bool); 2] = [(Name(b"regular"), false), (Name(b"bold"), true)];

impl Vectors {
    /// Points of a printer for each point of the design.
    fn printed_points(&self) -> f32 {
        (self.millimetres * 72.0 / 25.4) as f32
    }

    /// The picture as PDF.
    pub fn pdf(&self) -> DrawResult<Vec<u8>> {
        let mut ids = (1..).map(Ref::new);
        let mut id = || ids.next().expect("numbers do not end");
        let [catalog, pages, page, drawing, image] = [(); 5].map(|()| id());
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        let mut opacities = Opacities::default();
        let content = self.content(&mut opacities);
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let states: Vec<(String, Ref, f32)> = opacities
            .0
            .iter()
            .enumerate()
            .map(|(index, opacity)| (Opacities::name(index), id(), f32::from(*opacity) / 255.0))
            .collect();
        let fonts = FONTS.map(|(name, is_bold)| (name, self.used(is_bold), [(); 5].map(|()| id())));
        let mut sheet = pdf.page(page);
        let scale = self.printed_points();
        sheet.media_box(Rect::new(0.0, 0.0, scale * width, scale * height));
        sheet.parent(pages).contents(drawing);
        let mut resources = sheet.resources();
        if self.image.is_some() {
            resources.x_objects().pair(Name(b"image"), image);
        }
        let mut named = resources.ext_g_states();
        for (name, state, _) in &states {
            named.pair(Name(name.as_bytes()), state);
        }
        named.finish();
        let used = fonts.iter().filter(|(_, used, _)| !used.is_empty());
        let mut named = resources.fonts();
        for (name, _, [font, ..]) in used.clone() {
            named.pair(*name, font);
        }
        named.finish();
        resources.finish();
        sheet.finish();
        for (_, state, opacity) in &states {
            pdf.ext_graphics(*state)
                .stroking_alpha(*opacity)
                .non_stroking_alpha(*opacity);
        }
        for (name, used, parts) in used {
            write_font(&mut pdf, *name, used, *parts)?;
        }
        pdf.stream(drawing, &compressed(&content)?)
            .filter(Filter::FlateDecode);
        if let Some(shaded) = &self.image {
            write_image(&mut pdf, image, shaded)?;
        }
        Ok(pdf.finish())
    }

    /// The letters that the picture has of a font.
    fn used(&self, is_bold: bool) -> BTreeMap<GlyphId, char> {
        let words = self
            .words()
            .filter(|words| words.letters.is_bold == is_bold);
        let letters = words.flat_map(|words| {
            let font = &Face::of(words.letters).font;
            words
                .words
                .chars()
                .map(|letter| (font.glyph_id(letter), letter))
        });
        letters.collect()
    }

    fn content(&self, opacities: &mut Opacities) -> Vec<u8> {
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        let mut content = Content::new();
        // From here on in points of the design, downwards.
        let scale = self.printed_points();
        content.transform([scale, 0.0, 0.0, -scale, 0.0, scale * height]);
        fill_with(&mut content, self.paper);
        content.rect(0.0, 0.0, width, height).fill_nonzero();
        if self.image.is_some() {
            content.save_state();
            content.transform([width, 0.0, 0.0, -height, 0.0, height]);
            content.x_object(Name(b"image"));
            content.restore_state();
        }
        for mark in &self.marks {
            content.save_state();
            match mark {
                Mark::Lines(path, pen) => draw_lines(&mut content, path, *pen, opacities),
                Mark::Area(path, colour) => {
                    opacities.set(&mut content, 255);
                    fill_with(&mut content, *colour);
                    follow(&mut content, path);
                    content.fill_nonzero();
                }
                Mark::Words(words) => write_words(&mut content, words, opacities),
            }
            content.restore_state();
        }
        content.finish().to_vec()
    }
}

/// The opacities in use, up to 255: each needs a graphics state.
#[derive(Default)]
struct Opacities(Vec<u8>);

impl Opacities {
    fn name(index: usize) -> String {
        format!("cover{index}")
    }

    fn set(&mut self, content: &mut Content, opacity: u8) {
        let known = self.0.iter().position(|known| *known == opacity);
        let index = known.unwrap_or_else(|| {
            self.0.push(opacity);
            self.0.len() - 1
        });
        content.set_parameters(Name(Self::name(index).as_bytes()));
    }
}

fn compressed(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes)?;
    encoder.finish()
}

fn shares(colour: Colour) -> [f32; 3] {
    colour.map(|part| f32::from(part) / 255.0)
}

fn fill_with(content: &mut Content, colour: Colour) {
    let [red, green, blue] = shares(colour);
    content.set_fill_rgb(red, green, blue);
}

fn draw_lines(content: &mut Content, path: &Path, pen: Pen, opacities: &mut Opacities) {
    opacities.set(content, pen.opacity);
    let [red, green, blue] = shares(pen.colour);
    content.set_stroke_rgb(red, green, blue);
    content.set_line_width(pen.width);
    content.set_line_join(LineJoinStyle::RoundJoin);
    match pen.dashes {
        Some(dashes) => content.set_dash_pattern(dashes, 0.0),
        None => content.set_line_cap(LineCapStyle::RoundCap),
    };
    follow(content, path);
    content.stroke();
}

fn follow(content: &mut Content, path: &Path) {
    let mut last = (0.0, 0.0);
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => {
                content.move_to(to.x, to.y);
                last = (to.x, to.y);
            }
            PathSegment::LineTo(to) => {
                content.line_to(to.x, to.y);
                last = (to.x, to.y);
            }
            PathSegment::QuadTo(by, to) => {
                // The cubic curve that is the same.
                let between = |end: f32, by: f32| end + 2.0 / 3.0 * (by - end);
                let [ax, ay] = [between(last.0, by.x), between(last.1, by.y)];
                let [bx, by] = [between(to.x, by.x), between(to.y, by.y)];
                content.cubic_to(ax, ay, bx, by, to.x, to.y);
                last = (to.x, to.y);
            }
            PathSegment::CubicTo(a, b, to) => {
                content.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y);
                last = (to.x, to.y);
            }
            PathSegment::Close => {
                content.close_path();
            }
        }
    }
}

fn write_words(content: &mut Content, words: &Words, opacities: &mut Opacities) {
    let [(regular, _), (bold, _)] = FONTS;
    let font = &Face::of(words.letters).font;
    let bytes = words
        .words
        .chars()
        .flat_map(|letter| font.glyph_id(letter).0.to_be_bytes());
    let glyphs: Vec<u8> = bytes.collect();
    let [x, y] = words.start().map(|end| end as f32);
    opacities.set(content, 255);
    fill_with(content, words.colour);
    content.begin_text();
    content.set_font(
        if words.letters.is_bold { bold } else { regular },
        words.letters.size as f32,
    );
    // The page runs downwards: letters are turned over.
    content.set_text_matrix(if words.is_turned {
        [0.0, -1.0, -1.0, 0.0, x, y]
    } else {
        [1.0, 0.0, 0.0, -1.0, x, y]
    });
    content.show(Str(&glyphs));
    content.end_text();
}

/// What is shaded, as an image.
fn write_image(pdf: &mut Pdf, id: Ref, shaded: &Pixmap) -> std::io::Result<()> {
    let bytes = compressed(&colours(shaded, full(shaded)))?;
    let mut object = pdf.image_xobject(id, &bytes);
    object.filter(Filter::FlateDecode);
    object.bits_per_component(8);
    object
        .width(shaded.width() as i32)
        .height(shaded.height() as i32);
    object.color_space().device_rgb();
    Ok(())
}

/// A font whose letters are named by their numbers in its file, with their meaning for programs that copy or search.
fn write_font(
    pdf: &mut Pdf,
    name: Name,
    used: &BTreeMap<GlyphId, char>,
    [font, descendant, descriptor, file, meaning]: [Ref; 5],
) -> std::io::Result<()> {
    const SYSTEM: SystemInfo = SystemInfo {
        registry: Str(b"Adobe"),
        ordering: Str(b"Identity"),
        supplement: 0,
    };
    let face = Face::of(if name == FONTS[1].0 {
        Letters::bold(1)
    } else {
        Letters::regular(1)
    });
    let base = Name(face.name.as_bytes());
    pdf.type0_font(font)
        .base_font(base)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(descendant)
        .to_unicode(meaning);
    let mut cid = pdf.cid_font(descendant);
    cid.subtype(CidFontType::Type2)
        .base_font(base)
        .system_info(SYSTEM)
        .font_descriptor(descriptor)
        .cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = cid.widths();
    for glyph in used.keys() {
        widths.consecutive(glyph.0, [face.advance(*glyph)]);
    }
    widths.finish();
    cid.finish();
    let per_mille = 1000.0 / face.units_per_em();
    let [up, down] = [face.font.ascent_unscaled(), face.font.descent_unscaled()];
    pdf.font_descriptor(descriptor)
        .name(base)
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(-1021.0, -463.0, 1793.0, 1232.0))
        .italic_angle(0.0)
        .ascent(up * per_mille)
        .descent(down * per_mille)
        .cap_height(729.0)
        .stem_v(80.0)
        .font_file2(file);
    let mut map = UnicodeCmap::new(Name(b"letters"), SYSTEM);
    for (glyph, letter) in used {
        map.pair(glyph.0, *letter);
    }
    pdf.cmap(meaning, &map.finish());
    pdf.stream(file, &compressed(face.file)?)
        .filter(Filter::FlateDecode)
        .pair(Name(b"Length1"), face.file.len() as i32);
    Ok(())
}
