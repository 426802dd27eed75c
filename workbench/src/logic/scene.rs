//! What is on the table: a sheet, its material, and where its right grip is.

use serde::{Deserialize, Serialize};

pub use gelbench::corrector::plate::KnownConditions as Known;
use gelbench::material::registry::CARDS;
pub use gelbench_mechanics::problem::RigidMotion as Grip;
use gelbench_report::results::PALETTE;

/// A sheet between two grips, and how it is shown.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Scene {
    /// What is held between the grips.
    pub outline: Outline,
    /// Length between the grips and width in mm.
    pub size: [f64; 2],
    /// Thickness in mm.
    pub thickness: f64,
    /// Cells of the lattice along the length and across it; shapes other than the plate take the second number.
    pub cells: [usize; 2],
    /// The material.
    pub card: CardFile,
    /// Where the right grip is.
    pub grip: Grip,
    /// What is shown of it.
    pub look: Look,
}

/// A material card: its name and its text.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct CardFile {
    /// The name of a shipped card, or that of a file.
    pub name: String,
    /// The card itself.
    pub text: String,
}

/// The outline of a sheet, with the measures in mm that it has besides length and width.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub enum Outline {
    /// A rectangle.
    Plate,
    /// A rectangle with a round hole in its middle.
    Hole {
        /// Its diameter.
        diameter: f64,
    },
    /// A rectangle with two notches at mid length.
    Notches {
        /// Depth of one.
        depth: f64,
        /// Its length on the edge.
        length: f64,
    },
    /// A dumb-bell.
    DogBone {
        /// Length of the narrow part.
        narrow_length: f64,
        /// Its width.
        narrow_width: f64,
        /// Length of a shoulder.
        shoulder: f64,
    },
}

/// The three models.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Model {
    /// The lattice of springs.
    Springs,
    /// The displacements of the springs, corrected on the same nodes.
    Corrected,
    /// The finite elements that both are compared with.
    Elements,
}

/// What colours a sheet.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Colour {
    /// The size of the displacement in mm.
    Displacement,
    /// The larger principal stretch in the plane.
    Stretch,
    /// Von Mises' equivalent stress in MPa.
    Stress,
    /// The distance to the finite elements in mm.
    Distance,
}

/// How models are laid out.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Layout {
    /// Side by side.
    Beside,
    /// One on top of the other.
    Over,
}

/// What is shown.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Look {
    /// Springs, corrected, finite elements.
    pub models: [bool; 3],
    /// How they are laid out.
    pub layout: Layout,
    /// What colours them.
    pub colour: Colour,
    /// Whether the multipliers are drawn on the springs.
    pub multipliers: bool,
    /// Whether cells are drawn.
    pub cells: bool,
    /// What the corrector knows of the boundary of a plate.
    #[serde(default)]
    pub known: Known,
}

impl Model {
    /// All of them, from the crudest to the reference.
    pub const ALL: [Self; 3] = [Self::Springs, Self::Corrected, Self::Elements];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Springs => "springs",
            Self::Corrected => "corrected springs",
            Self::Elements => "finite elements",
        }
    }

    /// The colour of its lines.
    pub fn colour(self) -> [u8; 3] {
        PALETTE[match self {
            Self::Springs => 1,
            Self::Corrected => 0,
            Self::Elements => 2,
        }]
    }
}

impl Colour {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Displacement,
        Self::Stretch,
        Self::Stress,
        Self::Distance,
    ];

    /// What it shows, with its unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement [mm]",
            Self::Stretch => "larger principal stretch [–]",
            Self::Stress => "von Mises stress [MPa]",
            Self::Distance => "distance to the finite elements [mm]",
        }
    }
}

impl Outline {
    /// One of each kind, with measures that suit a sheet of some size.
    pub fn all([length, width]: [f64; 2]) -> [(&'static str, Self); 4] {
        [
            ("plate", Self::Plate),
            (
                "strip with a hole",
                Self::Hole {
                    diameter: 0.4 * width.min(length),
                },
            ),
            (
                "notched strip",
                Self::Notches {
                    depth: 0.15 * width.min(length),
                    length: 0.4 * width.min(length),
                },
            ),
            (
                "dumb-bell",
                Self::DogBone {
                    narrow_length: 0.35 * length,
                    narrow_width: 0.4 * width,
                    shoulder: 0.15 * length,
                },
            ),
        ]
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        let number = match self {
            Self::Plate => 0,
            Self::Hole { .. } => 1,
            Self::Notches { .. } => 2,
            Self::DogBone { .. } => 3,
        };
        Self::all([1.0, 1.0])[number].0
    }
}

impl CardFile {
    /// A card that gelbench brings along.
    pub fn shipped(name: &str) -> Option<Self> {
        let (name, text) = CARDS.iter().find(|(known, _)| *known == name)?;
        Some(Self {
            name: (*name).to_owned(),
            text: (*text).to_owned(),
        })
    }

    /// Whether it is a card of gelbench, unchanged.
    pub fn is_shipped(&self) -> bool {
        Self::shipped(&self.name).is_some_and(|card| card.text == self.text)
    }

    /// The name under which it is saved: that of a shipped card, or a file's.
    pub fn reference(&self) -> String {
        if self.is_shipped() {
            self.name.clone()
        } else {
            format!("{}.toml", self.name.trim_end_matches(".toml"))
        }
    }
}

impl Scene {
    /// The stretch of the right grip: its displacement along X over the length.
    pub fn stretch(&self) -> f64 {
        self.grip.displacement[0] / self.size[0]
    }

    /// The height of the sheet's axis: plates begin at Y = 0, the other shapes lie about it.
    pub fn axis(&self) -> f64 {
        match self.outline {
            Outline::Plate => 0.5 * self.size[1],
            _ => 0.0,
        }
    }

    /// Whether two scenes have the same sheet, with any grip and look.
    pub fn same_sheet(&self, other: &Self) -> bool {
        self.outline == other.outline
            && self.size == other.size
            && self.thickness == other.thickness
            && self.cells == other.cells
            && self.card == other.card
    }
}

impl Default for Scene {
    /// The README's plate at 30 % stretch.
    fn default() -> Self {
        Self {
            outline: Outline::Plate,
            size: [150.0, 50.0],
            thickness: 2.0,
            cells: [60, 20],
            card: CardFile::shipped("pva-10").expect("a shipped card"),
            grip: Grip {
                displacement: [45.0, 0.0],
                angle: 0.0,
            },
            look: Look {
                models: [true; 3],
                layout: Layout::Beside,
                colour: Colour::Stress,
                multipliers: false,
                cells: false,
                known: Known::ALL,
            },
        }
    }
}
