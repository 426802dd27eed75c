//! Rigid motions in the plane.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::units::Linear;

/// A rigid motion of a grip in its plane.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct RigidMotion {
    /// Displacement of the grip's middle in mm.
    pub displacement: [f64; 2],
    /// Turn about its middle in rad, from X to Y.
    pub angle: f64,
}

impl RigidMotion {
    /// The motion that brings points nearest to others in weighted least squares, and the middle of the points, about
    /// which it turns; each pair has a weight, an initial and a final position.
    pub fn nearest(pairs: &[(f64, [f64; 2], [f64; 2])]) -> ([f64; 2], Self) {
        let total: f64 = pairs.iter().map(|(weight, ..)| weight).sum();
        let (mut rest, mut end) = ([0.0; 2], [0.0; 2]);
        for (weight, from, to) in pairs {
            for axis in 0..2 {
                rest[axis] += weight / total * from[axis];
                end[axis] += weight / total * to[axis];
            }
        }
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (weight, from, to) in pairs {
            let [a, b] = [from[0] - rest[0], from[1] - rest[1]];
            let [c, d] = [to[0] - end[0], to[1] - end[1]];
            cosine += weight * (a * c + b * d);
            sine += weight * (a * d - b * c);
        }
        let motion = Self {
            displacement: [0, 1].map(|axis| end[axis] - rest[axis]),
            angle: sine.atan2(cosine),
        };
        (rest, motion)
    }

    /// The displacement of a point at rest in mm from the grip's middle.
    pub fn at(self, [along, across]: [f64; 2]) -> [f64; 2] {
        let sine = self.angle.sin();
        // 1 − cos without cancellation.
        let lost = 2.0 * (0.5 * self.angle).sin().powi(2);
        let [x, y] = self.displacement;
        [
            x - across * sine - lost * along,
            y + along * sine - lost * across,
        ]
    }

    /// The displacements of the points on a line across whose middle has Y₀ = `axis`, linear in Y:
    ///
    /// ```text
    /// ux = dx − sin α (Y − Y₀),   uy = dy + (cos α − 1)(Y − Y₀)                          [mm]
    /// ```
    pub fn lines(self, axis: f64) -> [Linear; 2] {
        let (sine, cosine) = self.angle.sin_cos();
        let [x, y] = self.displacement;
        [(x, -sine), (y, cosine - 1.0)].map(|(middle, slope)| Linear {
            at_origin: middle - slope * axis,
            slope: [0.0, slope],
        })
    }

    /// The rigid motion that such displacements are about Y = 0; `None` where they are none.
    pub fn of_lines([x, y]: [Linear; 2]) -> Option<Self> {
        let angle = (-x.slope[1]).atan2(1.0 + y.slope[1]);
        let rigid = x.slope[1].hypot(1.0 + y.slope[1]) - 1.0;
        let straight = x.slope[0] == 0.0 && y.slope[0] == 0.0;
        (straight && rigid.abs() < 1e-9).then_some(Self {
            displacement: [x.at_origin, y.at_origin],
            angle,
        })
    }
}

impl fmt::Display for RigidMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y], angle) = (self.displacement, self.angle.to_degrees());
        write!(f, "({x:.3}, {y:.3}) mm turned by {angle:.2}°")
    }
}
