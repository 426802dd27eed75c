use super::*;
use crate::results::{Animation, Colours, FieldFigure, Panel};

fn squares(count: usize) -> Vec<([[f64; 2]; 4], f64)> {
    let square = |i: usize| {
        let (x, y) = ((i % 1000) as f64, (i / 1000) as f64);
        let corners = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
        (corners, x + y)
    };
    (0..count).map(square).collect()
}

fn field(title: &str, cells: Vec<([[f64; 2]; 4], f64)>) -> Drawing {
    let label = "a\u{1}b".to_owned();
    FieldFigure::new(title, "x [mm]", [Panel { label, cells }]).into()
}

/// The share of pixels that are neither white nor ink.
fn coloured(png: &[u8]) -> f64 {
    let image = resvg::tiny_skia::Pixmap::decode_png(png).unwrap();
    let pixels = image.pixels();
    let is_coloured = |p: &&resvg::tiny_skia::PremultipliedColorU8| p.red().abs_diff(p.blue()) > 20;
    pixels.iter().filter(is_coloured).count() as f64 / pixels.len() as f64
}

#[test]
fn characters_that_xml_cannot_hold_are_left_out_of_pictures() {
    png(&field("\u{1b}[31m\u{0}\u{ffff}", squares(4))).unwrap();
}

#[test]
fn a_field_of_many_cells_is_painted_as_one_of_few_is_drawn() {
    let few = png(&field("few", squares(20_000))).unwrap();
    let many = png(&field("many", squares(21_000))).unwrap();
    let (few, many) = (coloured(&few), coloured(&many));
    assert!(few > 0.05 && (few - many).abs() < 0.02, "{few} {many}");
}

#[test]
fn a_picture_that_cannot_be_drawn_is_a_fault_and_no_panic() {
    let still = Animation {
        title: "still".into(),
        quantity: "x [mm]".into(),
        colours: Colours::Sequential,
        frames: Vec::new(),
        milliseconds: 40,
    };
    let fault = png(&Drawing::Animation(still)).unwrap_err();
    assert_eq!(fault.to_string(), "it has no frames");
    // Without a panel, the axis below the last one has no place.
    assert!(png(&FieldFigure::new("none", "x [mm]", []).into()).is_err());
}
