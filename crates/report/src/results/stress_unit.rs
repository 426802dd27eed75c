//! Units of stress for pictures.

use super::Line;

/// A unit of stress in which numbers are neither long nor tiny.
#[derive(Clone, Copy)]
pub struct Unit {
    /// Its name.
    pub name: &'static str,
    /// How many of it one MPa is.
    pub per_mpa: f64,
}

impl Unit {
    /// Turns the values of lines from MPa into the unit.
    pub fn scale(self, lines: &mut [Line]) {
        for point in lines.iter_mut().flat_map(|line| &mut line.points) {
            point[1] *= self.per_mpa;
        }
    }
}

/// The unit for stresses up to so many MPa.
pub fn readable(largest_mpa: f64) -> Unit {
    let units =
        [("MPa", 1.0), ("kPa", 1e3), ("Pa", 1e6)].map(|(name, per_mpa)| Unit { name, per_mpa });
    let large = units
        .into_iter()
        .find(|unit| unit.per_mpa * largest_mpa >= 0.1);
    large.unwrap_or(units[2])
}
