//! How files were understood: layout, encoding, columns, units, origin and axes.

use super::subset::Subset;

/// How the first of the files was understood; the others are like it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Understood {
    /// The layout of the file.
    pub layout: &'static str,
    /// The encoding of its text.
    pub encoding: Option<&'static str>,
    /// The sheet or the array that was read, where the file has several tables.
    pub part: Option<String>,
    /// What was taken from which column.
    pub columns: Vec<ColumnTaken>,
    /// Whether the file's y axis points down, as in an image, and was turned up.
    pub turned_up: bool,
    /// Whether the file's positions are those in the frame, from which the displacement was subtracted.
    pub taken_to_rest: bool,
    /// Subset and step of image correlation, where they are stated.
    pub subset: Option<Subset>,
    /// The length of a pixel in mm, where positions are in pixels.
    pub pixel: Option<f64>,
}

/// A column and what was taken from it.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnTaken {
    /// What it holds.
    pub holds: &'static str,
    /// Its name and unit as they are written.
    pub head: String,
    /// The length of its unit in mm, of columns of lengths.
    pub unit: Option<f64>,
    /// Where the unit is known from.
    pub unit_source: &'static str,
}

impl Understood {
    /// Of a layout without columns.
    pub fn of(layout: &'static str) -> Self {
        Self {
            layout,
            ..Self::default()
        }
    }

    /// A description of origin and axes.
    pub fn axes(&self) -> &'static str {
        if self.turned_up {
            "In the file y points down, as in an image; here y and uy are turned up: the origin is that of the file, such as the \
             upper left corner of the image, and points below it have negative y."
        } else {
            "Origin and axes are those of the file, with y assumed to point up."
        }
    }

    /// How positions at rest were computed, if they are not the file's.
    pub fn positions(&self) -> Option<&'static str> {
        self.taken_to_rest.then_some(
            "The positions in the file are those in the frame; the displacement was subtracted to obtain positions at rest.",
        )
    }

    /// A sketch of the axes of the file and of those used here, where they differ.
    pub fn sketch(&self) -> Option<&'static str> {
        self.turned_up.then_some(
            "in the file          here\n\
             O----> x             y\n\
             |                    ^\n\
             |                    |\n\
             v                    |\n\
             y                    O----> x",
        )
    }
}
