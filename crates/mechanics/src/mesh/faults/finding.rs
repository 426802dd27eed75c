//! The findings of one kind of fault, and the exemptions.

use crate::error::Diagnostic;

/// Apparent faults that may be intended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exemptions {
    /// Slits: neighbouring cells with nodes of their own at the same positions.
    pub seams: bool,
    /// Parts that are not attached to each other.
    pub parts: bool,
    /// Cells or parts that are joined in a single node.
    pub hinges: bool,
    /// Straight edges that turn like those of a curve.
    pub polygons: bool,
}

/// A name that is not among [`Exemptions::NAMES`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is not known here")]
pub struct UnknownName(String);

impl Exemptions {
    /// The names that studies and options use.
    pub const NAMES: [&'static str; 4] = ["seams", "parts", "hinges", "polygons"];

    /// The exemptions with some names.
    ///
    /// # Errors
    /// The first [`UnknownName`].
    pub fn of_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, UnknownName> {
        let mut allowed = Self::default();
        for name in names {
            match name {
                "seams" => allowed.seams = true,
                "parts" => allowed.parts = true,
                "hinges" => allowed.hinges = true,
                "polygons" => allowed.polygons = true,
                other => return Err(UnknownName(other.to_owned())),
            }
        }
        Ok(allowed)
    }
}

/// The number of faults of a kind, and the positions of the first ones.
#[derive(Default)]
pub struct Finding {
    pub count: usize,
    positions: Vec<[f64; 2]>,
}

impl Finding {
    pub const SHOWN: usize = 3;

    pub fn add(&mut self, position: [f64; 2]) {
        self.count += 1;
        if self.positions.len() < Self::SHOWN {
            self.positions.push(position);
        }
    }

    pub fn of(positions: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut finding = Self::default();
        positions
            .into_iter()
            .for_each(|position| finding.add(position));
        finding
    }

    /// `3 cells have no area, near (1, 2), (2, 2) and (3, 2) mm`, as an error; `None` where nothing was found.
    pub fn error(&self, [one, many]: [&str; 2], remedy: &str) -> Option<Diagnostic> {
        let what = match self.count {
            0 => return None,
            1 => format!("one {one}"),
            count => format!("{count} {many}"),
        };
        let message = format!("{what}, near {}", self.near());
        Some(Diagnostic::error("", message).hint(remedy))
    }

    pub fn near(&self) -> String {
        let positions: Vec<String> = self
            .positions
            .iter()
            .map(|position| at(*position))
            .collect();
        let others = match self.count - self.positions.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("{} mm{others}", positions.join(", "))
    }
}

/// A position with five digits.
pub fn at([x, y]: [f64; 2]) -> String {
    format!("({}, {})", digits(x), digits(y))
}

fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return "0".into();
    }
    let position = 4 - value.abs().log10().floor() as i32;
    let text = format!("{value:.*}", position.clamp(0, 12) as usize);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
