//! Whether the measures of a shape fit together.

use std::f64::consts::TAU;

use super::rakes::LEAST_GAP;
use super::{MOST_RATIO, Rakes, Shape};

/// What a measure must be below, in mm or degrees, and why.
type Demand = (&'static str, f64, f64, &'static str);

impl Shape {
    /// What is wrong with the measures.
    ///
    /// # Errors
    /// Says which measure does not fit, and what would.
    pub fn check(self) -> Result<(), Misfit> {
        let mut demands = self.demands().into_iter();
        if let Some((measure, _, limit, reason)) =
            demands.find(|(_, value, limit, _)| *value >= *limit)
        {
            return Err(Misfit {
                measure,
                reason,
                limit,
            });
        }
        let [least, most] = self.extremes();
        if most <= MOST_RATIO * least {
            Ok(())
        } else {
            Err(Misfit {
                measure: "shape",
                reason: "its dimensions differ by a factor of more than 100,000",
                limit: 0.0,
            })
        }
    }

    /// What its measures must be below; negative where they must be above.
    fn demands(self) -> Vec<Demand> {
        match self {
            Self::Strip { .. } => Vec::new(),
            Self::StripWithHole { size, radius } => {
                let reason =
                    "the hole's diameter must be below nine tenths of the length and of the width";
                let limit = 0.9 * size[0].min(size[1]);
                vec![("hole_diameter", 2.0 * radius, limit, reason)]
            }
            Self::NotchedStrip {
                size,
                depth,
                half_length,
            } => notches(size, depth, half_length),
            Self::DogBone {
                size,
                narrow,
                shoulder,
            } => dog_bone(size, narrow, shoulder),
            Self::RingSector { radii, angle } => {
                let smaller = "the inner radius must be smaller than the outer one";
                let part = "the sector must be less than a whole ring";
                vec![
                    ("inner_radius", radii[0], radii[1], smaller),
                    ("angle", angle * 360.0 / TAU, 360.0, part),
                ]
            }
            Self::SquareOnRakes(rakes) => on_rakes(rakes),
            Self::Cruciform {
                size,
                arm_width,
                fillet,
            } => {
                let least = size[0].min(size[1]);
                let short = "the arms with their fillets must be shorter than the specimen";
                let wide = "the arms must be narrower than the specimen";
                vec![
                    ("arm_width", arm_width, 0.9 * least, wide),
                    ("fillet", fillet, 0.5 * (0.95 * least - arm_width), short),
                ]
            }
        }
    }
}

fn on_rakes(rakes: Rakes) -> Vec<Demand> {
    let Rakes {
        size,
        tines,
        spacing,
        inset,
        radius,
    } = rakes;
    let outside = "the tines of a side must lie on the sheet";
    let too_far = "the tines must be nearer to their side than to the middle";
    let close = "rows of tines, also of neighbouring sides, and the edges beside them need 1.2 diameters between their centres";
    let least = size[0].min(size[1]);
    let most_spacing = (least - 2.0 * LEAST_GAP * radius) / (tines as f64 - 1.0).max(1.0);
    vec![
        ("tine_spacing", spacing, most_spacing, outside),
        ("tine_inset", inset, 0.4 * least, too_far),
        (
            "tine_diameter",
            2.0 * radius,
            rakes.least_gap() / LEAST_GAP,
            close,
        ),
    ]
}

fn notches(size: [f64; 2], depth: f64, half_length: f64) -> Vec<Demand> {
    const KEY: &str = "notch_depth";
    let rest = "the notches must leave a tenth of the width";
    let short = "the notches must be shorter than nine tenths of the strip";
    let shallow = "a notch must be shallower than 0.475 of its length";
    vec![
        (KEY, depth, 0.45 * size[1], rest),
        ("notch_length", 2.0 * half_length, 0.9 * size[0], short),
        (KEY, depth, 0.95 * half_length, shallow),
    ]
}

fn dog_bone(size: [f64; 2], narrow: [f64; 2], shoulder: f64) -> Vec<Demand> {
    let narrower = "the narrow part must be narrower than the ends";
    let short = "the narrow part and its shoulders must be shorter than the specimen";
    let long = "a shoulder must be longer than it is high";
    let high = (size[1] - narrow[1]) / 2.0;
    vec![
        ("narrow_width", narrow[1], size[1], narrower),
        ("narrow_length", narrow[0], size[0] - 2.0 * shoulder, short),
        ("shoulder_length", -shoulder, -high, long),
    ]
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
        // Three decimals on the safe side, more for small specimens.
        let decimals = (2.0 - self.limit.abs().log10().floor()).clamp(3.0, 12.0);
        let scale = 10_f64.powi(decimals as i32);
        let limit = if self.limit < 0.0 {
            (scale * -self.limit).ceil() / scale
        } else {
            (scale * self.limit).floor() / scale
        };
        let relation = match (self.limit < 0.0, limit > 0.0) {
            (true, _) => "more",
            (false, true) => "less",
            (false, false) => {
                return "change the other dimensions: no value is compatible with them".to_owned();
            }
        };
        format!("take {relation} than \"{limit} {unit}\", or change the other dimensions")
    }
}
