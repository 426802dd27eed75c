//! What is wrong with a mesh: cells that are no cells, cells that lie on each other, and cells that touch without being
//! joined.
//!
//! | fault | what the finite elements would make of it |
//! |---|---|
//! | cell without area, or turned inside out in part | no deformation gradient |
//! | cell given twice, cells that overlap | twice the stiffness there |
//! | seam: cells along the same line with nodes of their own | a slit that opens |
//! | hanging node: on a cell's side without being its node | a slit that opens between the side's ends |
//! | hinge: cells joined in a single node | a mechanism, or a stress without bound |
//! | parts that are not attached | each moves on its own |
//! | cell with very small or large angles (a warning) | large errors, bad condition |
//!
//! A side's node is at a place, or on a side, when it is nearer than a thousandth of the shortest edge there. The time goes
//! like n log n with the number of cells.

use std::collections::HashSet;

use super::Mesh;
use crate::error::Diagnostic;

mod cells;
mod parts;
mod sides;
mod touching;

use sides::Sides;

/// What looks like a fault but may be meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Allowed {
    /// Slits: neighbouring cells with nodes of their own at the same places.
    pub seams: bool,
    /// Parts that are not attached to each other.
    pub parts: bool,
    /// Cells or parts that are joined in a single node.
    pub hinges: bool,
    /// Straight edges that turn as those of a curve.
    pub polygons: bool,
}

impl Allowed {
    /// The names that studies and options use.
    pub const NAMES: [&'static str; 4] = ["seams", "parts", "hinges", "polygons"];

    /// Those of some names; the first name that is not known otherwise.
    ///
    /// # Errors
    /// The unknown name.
    pub fn of_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, String> {
        let mut allowed = Self::default();
        for name in names {
            match name {
                "seams" => allowed.seams = true,
                "parts" => allowed.parts = true,
                "hinges" => allowed.hinges = true,
                "polygons" => allowed.polygons = true,
                other => return Err(other.to_owned()),
            }
        }
        Ok(allowed)
    }
}

impl Mesh {
    /// Cells without area and cells that are turned inside out somewhere, as errors.
    pub fn cells_without_sense(&self) -> Vec<Diagnostic> {
        cells::without_sense(self)
    }

    /// All faults, each kind once with its number and first places in mm: errors first, then warnings.
    pub fn faults(&self, allowed: Allowed) -> Vec<Diagnostic> {
        let mut found = self.cells_without_sense();
        let twice = cells::given_twice(self);
        found.extend(cells::twice_told(self, &twice));
        let again: HashSet<usize> = twice.iter().map(|[_, again]| *again).collect();
        let sides = Sides::new(self, &again);
        found.extend(sides.faults());
        found.extend(touching::faults(&sides, allowed));
        // What these three find may be the same fault seen from another side.
        let beyond = match found.is_empty() {
            true => vec![
                parts::hinges(&sides, allowed),
                touching::overlaps(self),
                cells::badly_shaped(self),
            ],
            false => Vec::new(),
        };
        found.extend(parts::parts(&sides, allowed));
        found.extend(beyond.into_iter().flatten());
        found
    }
}

/// How many things of a kind were found, and the places of the first ones.
#[derive(Default)]
struct Found {
    count: usize,
    places: Vec<[f64; 2]>,
}

impl Found {
    const SHOWN: usize = 3;

    fn add(&mut self, place: [f64; 2]) {
        self.count += 1;
        if self.places.len() < Self::SHOWN {
            self.places.push(place);
        }
    }

    fn of(places: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut found = Self::default();
        places.into_iter().for_each(|place| found.add(place));
        found
    }

    /// `3 cells have no area, near (1, 2), (2, 2) and (3, 2) mm`, as an error; `None` where nothing was found.
    fn error(&self, [one, many]: [&str; 2], remedy: &str) -> Option<Diagnostic> {
        let what = match self.count {
            0 => return None,
            1 => format!("one {one}"),
            count => format!("{count} {many}"),
        };
        let message = format!("{what}, near {}", self.near());
        Some(Diagnostic::error("", message).hint(remedy))
    }

    fn near(&self) -> String {
        let places: Vec<String> = self.places.iter().map(|place| at(*place)).collect();
        let beyond = match self.count - self.places.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("{} mm{beyond}", places.join(", "))
    }
}

/// A place with five digits.
fn at([x, y]: [f64; 2]) -> String {
    format!("({}, {})", digits(x), digits(y))
}

fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".into();
    }
    let place = 4 - value.abs().log10().floor() as i32;
    let text = format!("{value:.*}", place.clamp(0, 12) as usize);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests;
