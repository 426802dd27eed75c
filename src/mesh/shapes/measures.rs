//! Whether the measures of a shape fit together.

use std::f64::consts::TAU;

use super::Shape;

impl Shape {
    /// What is wrong with the measures.
    ///
    /// # Errors
    /// Says which measure does not fit, and what would.
    pub fn check(self) -> Result<(), Misfit> {
        let below =
            |measure: f64, (name, factor): (&'static str, f64), most: f64, reason: &'static str| {
                let limit = factor * most;
                match factor * measure < limit {
                    true => Ok(()),
                    false => Err(Misfit {
                        measure: name,
                        reason,
                        limit,
                    }),
                }
            };
        match self {
            Self::Strip { .. } => Ok(()),
            Self::StripWithHole { size, radius } => below(
                radius,
                ("hole_diameter", 2.0),
                0.45 * size[0].min(size[1]),
                "the hole's diameter must be below nine tenths of the length and of the width",
            ),
            Self::NotchedStrip {
                size,
                depth,
                half_length,
            } => {
                const DEPTH: (&str, f64) = ("notch_depth", 1.0);
                let length = ("notch_length", 2.0);
                below(
                    depth,
                    DEPTH,
                    0.45 * size[1],
                    "the notches must leave a tenth of the width",
                )?;
                below(
                    half_length,
                    length,
                    0.45 * size[0],
                    "the notches must be shorter than nine tenths of the strip",
                )?;
                below(
                    depth,
                    DEPTH,
                    0.95 * half_length,
                    "a notch must be shallower than half its length",
                )
            }
            Self::DogBone {
                size,
                narrow,
                shoulder,
            } => {
                let ends = "the narrow part and its shoulders must be shorter than the specimen";
                below(
                    narrow[1],
                    ("narrow_width", 1.0),
                    size[1],
                    "the narrow part must be narrower than the ends",
                )?;
                below(
                    narrow[0],
                    ("narrow_length", 1.0),
                    size[0] - 2.0 * shoulder,
                    ends,
                )?;
                match (size[1] - narrow[1]) / 2.0 < shoulder {
                    true => Ok(()),
                    false => Err(Misfit {
                        measure: "shoulder_length",
                        reason: "a shoulder must be longer than it is high",
                        limit: -(size[1] - narrow[1]) / 2.0,
                    }),
                }
            }
            Self::RingSector { radii, angle } => {
                let radius = ("inner_radius", 1.0);
                below(
                    radii[0],
                    radius,
                    radii[1],
                    "the inner radius must be smaller than the outer one",
                )?;
                below(
                    angle,
                    ("angle", 360.0 / TAU),
                    TAU,
                    "the sector must be less than a whole ring",
                )
            }
        }
    }
}

/// A measure of a shape that does not fit the others.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{reason}")]
pub struct Misfit {
    /// Its name.
    pub measure: &'static str,
    /// What is wrong.
    pub reason: &'static str,
    /// What it must be below, in mm or degrees; above its absolute value where it is negative.
    pub limit: f64,
}

impl Misfit {
    /// What to change.
    pub fn remedy(&self) -> String {
        let unit = if self.measure == "angle" { "deg" } else { "mm" };
        // Three decimals on the safe side.
        let limit = match self.limit < 0.0 {
            true => (1e3 * -self.limit).ceil() / 1e3,
            false => (1e3 * self.limit).floor() / 1e3,
        };
        let relation = match (self.limit < 0.0, limit > 0.0) {
            (true, _) => "more",
            (false, true) => "less",
            (false, false) => return "change the other measures: none fits to these".to_owned(),
        };
        format!("take {relation} than \"{limit} {unit}\", or change the other measures")
    }
}
