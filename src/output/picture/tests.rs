use super::*;
use crate::results::{Animation, FieldFigure, Panel};

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
