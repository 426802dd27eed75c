//! How the lines of charts are drawn.

use super::legend::JOINS;
use super::look::Look;
use super::marks::Pen;
use crate::results::{Line, Stroke};

impl Line {
    /// What its points are joined with; `None` where they are not.
    pub(super) fn pen(&self, look: Look) -> Option<Pen> {
        let pen = |width| Pen::new(look.line(self.colour), width);
        match self.stroke {
            Stroke::Marked | Stroke::Ringed => Some(pen(1.0).dashed(JOINS)),
            Stroke::Dashed => Some(pen(2.0).dashed([7.0, 5.0])),
            Stroke::Solid => Some(pen(2.0)),
            Stroke::Thin => Some(pen(1.0)),
            Stroke::Points | Stroke::Filled => None,
        }
    }

    /// Radius of its markers, their pen, and whether they are filled; `None` where it has none.
    pub(super) fn marker(&self, radius: f64, look: Look) -> Option<(f64, Pen, bool)> {
        let pen = |width| Pen::new(look.line(self.colour), width);
        match self.stroke {
            Stroke::Marked | Stroke::Points => Some((radius, pen(0.0), true)),
            Stroke::Ringed => Some((radius + 2.0, pen(2.0), false)),
            Stroke::Solid | Stroke::Thin | Stroke::Dashed | Stroke::Filled => None,
        }
    }
}
