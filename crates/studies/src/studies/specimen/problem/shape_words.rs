//! Descriptions of shapes.

use crate::mesh::{Rakes, Shape};
use crate::units::number;

/// A description of a shape with its measures.
pub fn describe(shape: Shape) -> String {
    match shape {
        Shape::Strip {
            size: [length, width],
        } => format!("a strip of {length} × {width} mm"),
        Shape::StripWithHole {
            size: [length, width],
            radius,
        } => format!(
            "a strip of {length} × {width} mm with a hole of {} mm diameter in its middle",
            2.0 * radius
        ),
        Shape::NotchedStrip {
            size: [length, width],
            depth,
            half_length,
        } => format!(
            "a strip of {length} × {width} mm with two notches of {depth} mm depth and {} mm length",
            2.0 * half_length
        ),
        Shape::DogBone {
            size: [length, width],
            narrow,
            shoulder,
        } => format!(
            "a dumb-bell of {length} × {width} mm with a narrow part of {} × {} mm and shoulders of {shoulder} mm length",
            narrow[0], narrow[1]
        ),
        Shape::SquareOnRakes(Rakes {
            size: [length, width],
            tines,
            spacing,
            inset,
            radius,
        }) => format!(
            "a sheet of {length} × {width} mm on rakes of {tines} tines of {} mm diameter at each side, {spacing} mm apart and {inset} mm from the edge",
            2.0 * radius
        ),
        Shape::Cruciform {
            size: [length, width],
            arm_width,
            fillet,
        } => format!(
            "a cruciform of {length} × {width} mm with arms of {arm_width} mm width and fillets of {fillet} mm radius"
        ),
        Shape::RingSector {
            radii: [inner, outer],
            angle,
        } => format!(
            "a sector of {}° of a ring with radii of {inner} and {outer} mm",
            number(angle.to_degrees())
        ),
    }
}
