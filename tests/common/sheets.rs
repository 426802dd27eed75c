//! Shapes, supports and loads of the tests that solve sheets themselves.

use std::f64::consts::FRAC_PI_2;

use gelbench::mesh::Shape;
use gelbench::problem::Support;

pub const STRIP_WITH_HOLE: Shape = Shape::StripWithHole {
    size: [100.0, 40.0],
    radius: 8.0,
};

pub const DOG_BONE: Shape = Shape::DogBone {
    size: [115.0, 25.0],
    narrow: [33.0, 6.0],
    shoulder: 20.0,
};

pub const RING: Shape = Shape::RingSector {
    radii: [10.0, 20.0],
    angle: FRAC_PI_2,
};

/// With names that own themselves.
pub fn named<T>(entries: impl IntoIterator<Item = (&'static str, T)>) -> Vec<(String, T)> {
    let entries = entries.into_iter();
    entries
        .map(|(name, value)| (name.to_owned(), value))
        .collect()
}

/// Held at a displacement.
pub fn held(x: f64, y: f64) -> Support {
    Support::Displacement([Some(x), Some(y)])
}
