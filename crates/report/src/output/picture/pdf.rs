//! Pictures as PDF files of one page. Letters are curves, so that no font is needed.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref};
use plotters::style::RGBColor;
use resvg::tiny_skia::{Path, PathSegment, Transform};
use resvg::usvg::{self, Group, Node, Paint};

use super::design::{DrawResult, FINE};
use super::encode::{colours, whole};
use super::look::MILLIMETRES;
use super::paint::Lines;
use super::vectors::Vectors;

/// Points of a printer for each point of the design.
const SCALE: f32 = (MILLIMETRES * 72.0 / 25.4) as f32;

impl Vectors {
    /// The picture as PDF.
    pub fn pdf(&self) -> DrawResult<Vec<u8>> {
        let mut ids = (1..).map(Ref::new);
        let mut id = || ids.next().expect("numbers do not end");
        let [catalog, pages, page, drawing, image] = [(); 5].map(|()| id());
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        let mut covers = Covers::default();
        let tree = usvg::Tree::from_str(&self.drawn, &usvg::Options::default())?;
        let content = self.content(&tree, &mut covers);
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let states: Vec<(String, Ref, f32)> = covers
            .0
            .iter()
            .enumerate()
            .map(|(index, cover)| (Covers::name(index), id(), f32::from(*cover) / 255.0))
            .collect();
        let mut sheet = pdf.page(page);
        sheet.media_box(Rect::new(0.0, 0.0, SCALE * width, SCALE * height));
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
        resources.finish();
        sheet.finish();
        for (_, state, cover) in &states {
            pdf.ext_graphics(*state)
                .stroking_alpha(*cover)
                .non_stroking_alpha(*cover);
        }
        pdf.stream(drawing, &compressed(&content)?)
            .filter(Filter::FlateDecode);
        if let Some(shaded) = &self.image {
            let bytes = compressed(&colours(shaded, whole(shaded)))?;
            let mut object = pdf.image_xobject(image, &bytes);
            object.filter(Filter::FlateDecode);
            object.bits_per_component(8);
            object
                .width(shaded.width() as i32)
                .height(shaded.height() as i32);
            object.color_space().device_rgb();
        }
        Ok(pdf.finish())
    }

    fn content(&self, tree: &usvg::Tree, covers: &mut Covers) -> Vec<u8> {
        let (width, height) = (self.size.0 as f32, self.size.1 as f32);
        let mut content = Content::new();
        // From here on in points of the design, downwards.
        content.transform([SCALE, 0.0, 0.0, -SCALE, 0.0, SCALE * height]);
        fill_with(&mut content, self.paper);
        content.rect(0.0, 0.0, width, height).fill_nonzero();
        if self.image.is_some() {
            content.save_state();
            content.transform([width, 0.0, 0.0, -height, 0.0, height]);
            content.x_object(Name(b"image"));
            content.restore_state();
        }
        for lines in &self.lines {
            draw_lines(&mut content, lines, covers);
        }
        let unit = 1.0 / FINE as f32;
        draw_group(
            &mut content,
            tree.root(),
            Transform::from_scale(unit, unit),
            covers,
        );
        content.finish().to_vec()
    }
}

/// How much of what is below is covered, up to 255: each has a state of its own.
#[derive(Default)]
struct Covers(Vec<u8>);

impl Covers {
    fn name(index: usize) -> String {
        format!("cover{index}")
    }

    fn set(&mut self, content: &mut Content, cover: f32) {
        let cover = (255.0 * cover).round() as u8;
        let known = self.0.iter().position(|known| *known == cover);
        let index = known.unwrap_or_else(|| {
            self.0.push(cover);
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

fn shares(RGBColor(red, green, blue): RGBColor) -> [f32; 3] {
    [red, green, blue].map(|part| f32::from(part) / 255.0)
}

fn fill_with(content: &mut Content, colour: RGBColor) {
    let [red, green, blue] = shares(colour);
    content.set_fill_rgb(red, green, blue);
}

fn draw_lines(content: &mut Content, lines: &Lines, covers: &mut Covers) {
    content.save_state();
    covers.set(content, f32::from(lines.pen.cover) / 255.0);
    let [red, green, blue] = shares(lines.pen.colour);
    content.set_stroke_rgb(red, green, blue);
    content.set_line_width(lines.pen.width);
    content
        .set_line_cap(LineCapStyle::RoundCap)
        .set_line_join(LineJoinStyle::RoundJoin);
    for line in &lines.lines {
        for (index, [x, y]) in line.iter().enumerate() {
            match index {
                0 => content.move_to(*x as f32, *y as f32),
                _ => content.line_to(*x as f32, *y as f32),
            };
        }
    }
    content.stroke();
    content.restore_state();
}

fn draw_group(content: &mut Content, group: &Group, unit: Transform, covers: &mut Covers) {
    for node in group.children() {
        match node {
            Node::Group(inner) => draw_group(content, inner, unit, covers),
            Node::Path(path) if path.is_visible() => {
                draw_path(content, path, unit.pre_concat(path.abs_transform()), covers);
            }
            Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
        }
    }
}

fn colour_of(paint: &Paint) -> Option<RGBColor> {
    match paint {
        Paint::Color(colour) => Some(RGBColor(colour.red, colour.green, colour.blue)),
        // Drawings have neither gradients nor patterns.
        _ => None,
    }
}

fn draw_path(content: &mut Content, path: &usvg::Path, place: Transform, covers: &mut Covers) {
    content.save_state();
    content.transform([place.sx, place.ky, place.kx, place.sy, place.tx, place.ty]);
    if let Some((fill, colour)) = path
        .fill()
        .and_then(|fill| Some((fill, colour_of(fill.paint())?)))
    {
        covers.set(content, fill.opacity().get());
        fill_with(content, colour);
        follow(content, path.data());
        match fill.rule() {
            usvg::FillRule::NonZero => content.fill_nonzero(),
            usvg::FillRule::EvenOdd => content.fill_even_odd(),
        };
    }
    let stroke = path.stroke();
    if let Some((stroke, colour)) = stroke.and_then(|own| Some((own, colour_of(own.paint())?))) {
        covers.set(content, stroke.opacity().get());
        let [red, green, blue] = shares(colour);
        content.set_stroke_rgb(red, green, blue);
        content.set_line_width(stroke.width().get());
        follow(content, path.data());
        content.stroke();
    }
    content.restore_state();
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
