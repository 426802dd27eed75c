mod layout;
pub mod vision;

use super::*;
use crate::mesh::{CellShape, Mesh};
use crate::results::{Animation, FieldFigure, Panel, PictureWidth};

fn squares(count: usize) -> Vec<([[f64; 2]; 4], f64)> {
    let square = |i: usize| {
        let (x, y) = ((i % 1000) as f64, (i / 1000) as f64);
        let corners = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        (corners, x + y)
    };
    (0..count).map(square).collect()
}

fn field(title: &str, cells: Vec<([[f64; 2]; 4], f64)>) -> Drawing {
    FieldFigure::new(title, "x [mm]", [Panel::quadrilaterals("a\u{1}b", &cells)]).into()
}

#[test]
fn characters_that_xml_cannot_hold_are_left_out_of_pictures() {
    png(&field("\u{1b}[31m\u{0}\u{ffff}", squares(4))).unwrap();
}

#[test]
fn a_picture_that_cannot_be_drawn_is_a_fault_and_no_panic() {
    let still = Animation {
        title: "still".into(),
        quantity: "x [mm]".into(),
        frames: Vec::new(),
        milliseconds: 40,
    };
    let fault = png(&Drawing::Animation(still)).unwrap_err();
    assert_eq!(fault.to_string(), "it has no frames");
    // Without a panel, the axis below the last one has no place.
    assert!(png(&FieldFigure::new("none", "x [mm]", []).into()).is_err());
}

fn styled(format: PictureFormat, width: PictureWidth) -> Vec<u8> {
    let nodes = Mesh::plate([30.0, 10.0], [6, 2], CellShape::Quad4);
    let at_rest = vec![0.0; 2 * nodes.nodes.len()];
    let panel = Panel::at_nodes("corrected", &nodes, &at_rest, &|node| nodes.nodes[node][0]);
    let figure = FieldFigure::new(
        "Largest principal stress at 50 % stretch",
        "x [mm]",
        [panel],
    );
    let style = PictureStyle {
        formats: vec![format],
        width,
        ..PictureStyle::default()
    };
    picture(&figure.into(), format, &style).unwrap()
}

#[test]
fn pictures_for_a_column_are_as_wide_as_it_in_every_format() {
    for (width, millimetres) in [
        (PictureWidth::OneColumn, 85.0),
        (PictureWidth::TwoColumns, 180.2),
    ] {
        let svg = String::from_utf8(styled(PictureFormat::Svg, width)).unwrap();
        assert!(
            svg.contains(&format!(" width=\"{millimetres:.2}mm\"")),
            "{}",
            &svg[..200]
        );
        let pdf = styled(PictureFormat::Pdf, width);
        let points = format!("/MediaBox [0 0 {:.2}", millimetres * 72.0 / 25.4);
        let text = String::from_utf8_lossy(&pdf).into_owned();
        assert!(
            text.contains(&points[..points.len() - 1]),
            "{points}: {}",
            &text[..400]
        );
        let png = styled(PictureFormat::Png, width);
        let reader = png::Decoder::new(std::io::Cursor::new(&png))
            .read_info()
            .unwrap();
        let pixels = reader.info().pixel_dims.unwrap().xppu;
        let wide = 1000.0 * f64::from(reader.info().width) / f64::from(pixels);
        assert!((wide - millimetres).abs() < 0.1, "{wide}");
    }
}

#[test]
fn vector_pictures_hold_words_as_words_lines_as_lines_and_the_shades_as_one_image() {
    let svg = String::from_utf8(styled(PictureFormat::Svg, PictureWidth::OneColumn)).unwrap();
    assert!(svg.contains(">x [mm]</text>") && svg.contains("@font-face"));
    assert_eq!(svg.matches("<image ").count(), 1);
    let contours = "stroke-width=\"0.5\" stroke-opacity=\"0.431\"";
    assert_eq!(svg.matches(contours).count(), 1, "contour lines");
    let mut reader = quick_xml::Reader::from_str(&svg);
    while reader.read_event().unwrap() != quick_xml::events::Event::Eof {}
    let pdf = styled(PictureFormat::Pdf, PictureWidth::OneColumn);
    let text = String::from_utf8_lossy(&pdf);
    assert_eq!(text.matches("/Subtype /Image").count(), 1);
    assert!(
        text.contains("/ToUnicode") && text.contains("/Count 1"),
        "one page with a font that can be searched"
    );
    for format in [PictureFormat::Svg, PictureFormat::Pdf] {
        let again = [(); 2].map(|()| styled(format, PictureWidth::Screen));
        assert_eq!(again[0], again[1], "{format:?}");
    }
}
