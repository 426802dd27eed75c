//! Names and colours of the models in reports, files and pictures.

use super::{Line, PALETTE, Stroke};

/// A model's name, its name in names of files and figures, and the colour of its lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelStyle {
    /// Its name.
    pub name: &'static str,
    /// Its name in names of files, arrays and figures.
    pub key: &'static str,
    /// The colour of its lines.
    pub colour: [u8; 3],
}

impl ModelStyle {
    /// The model within a sentence: `mass-spring model`.
    pub fn in_words(self) -> String {
        if self == FINITE_ELEMENTS {
            self.name.to_owned()
        } else {
            format!("{} model", self.name)
        }
    }

    /// A line of the model, with its name and colour.
    pub fn line(self, points: impl IntoIterator<Item = [f64; 2]>, stroke: Stroke) -> Line {
        Line::new(self.name, points, self.colour, stroke)
    }
}

/// The mass-spring model.
pub const MASS_SPRING: ModelStyle = ModelStyle {
    name: "mass-spring",
    key: "mass_spring",
    colour: PALETTE[1],
};

/// The corrected field of the springs.
pub const CORRECTED: ModelStyle = ModelStyle {
    name: "corrected",
    key: "corrected",
    colour: PALETTE[0],
};

/// The reference for both.
pub const FINITE_ELEMENTS: ModelStyle = ModelStyle {
    name: "finite elements",
    key: "finite_element",
    colour: [30, 30, 30],
};

/// All models, in the order of reports.
pub const MODELS: [ModelStyle; 3] = [MASS_SPRING, CORRECTED, FINITE_ELEMENTS];
