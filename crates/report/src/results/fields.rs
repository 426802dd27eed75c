//! Fields on deformed meshes as data, and the meshes themselves.

use serde::{Deserialize, Serialize};

use super::{Scale, Surface};
use crate::finite_element::error_estimate::EnergyError;
use crate::mesh::Mesh;

/// The values of a field on a surface.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum Values {
    /// At its points: the field is interpolated between them.
    AtPoints(Vec<f64>),
    /// In its cells: each has one colour.
    InCells(Vec<f64>),
}

/// One plate.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Panel {
    /// Its name.
    pub label: String,
    /// Its deformed surface.
    pub surface: Surface,
    /// The field on it; NaN is shown in grey.
    pub values: Values,
}

impl Panel {
    /// A field with a value at each node of a deformed mesh.
    pub fn at_nodes(
        label: impl Into<String>,
        mesh: &Mesh,
        displacement: &[f64],
        value: &dyn Fn(usize) -> f64,
    ) -> Self {
        Self {
            label: label.into(),
            surface: Surface::new(mesh, displacement),
            values: Values::AtPoints(Surface::field(mesh, value)),
        }
    }

    /// Quadrilaterals with their values.
    pub fn quadrilaterals(label: impl Into<String>, cells: &[([[f64; 2]; 4], f64)]) -> Self {
        let corners: Vec<_> = cells.iter().map(|cell| cell.0).collect();
        Self {
            label: label.into(),
            surface: Surface::quadrilaterals(&corners),
            values: Values::InCells(cells.iter().map(|cell| cell.1).collect()),
        }
    }

    /// The distance of a displacement field from another one at the same nodes.
    pub fn distance(label: &str, mesh: &Mesh, u: &[f64], v: &[f64]) -> Self {
        let along = |node: usize, axis: usize| u[2 * node + axis] - v[2 * node + axis];
        Self::at_nodes(label, mesh, u, &|node| along(node, 0).hypot(along(node, 1)))
    }

    /// The values at the corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [f64; 3]> {
        let triangles = self.surface.triangles.iter().zip(&self.surface.cells);
        triangles.map(|(triangle, cell)| match &self.values {
            Values::AtPoints(values) => triangle.map(|point| values[point as usize]),
            Values::InCells(values) => [values[*cell as usize]; 3],
        })
    }
}

/// Plates above each other, in true proportions, on one colour scale: dark to light, or blue over white at zero to red
/// where the values have both signs.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct FieldFigure {
    /// Heading.
    pub title: String,
    /// The quantity that the colours show, with its unit.
    pub quantity: String,
    /// The scale of the colour bar.
    pub scale: Scale,
    /// Lower and upper end of the colour bar; else those of all values but for single extremes.
    pub range: Option<[f64; 2]>,
    /// The plates.
    pub panels: Vec<Panel>,
}

impl FieldFigure {
    /// A figure on a linear scale.
    pub fn new(
        title: impl Into<String>,
        quantity: impl Into<String>,
        panels: impl IntoIterator<Item = Panel>,
    ) -> Self {
        Self {
            title: title.into(),
            quantity: quantity.into(),
            scale: Scale::Linear,
            range: None,
            panels: panels.into_iter().collect(),
        }
    }

    /// The estimated error of every finite element.
    pub fn estimated_error(
        at: &str,
        mesh: &Mesh,
        displacement: &[f64],
        energy: &EnergyError,
    ) -> Self {
        let cells = Panel {
            label: mesh.describe(),
            surface: Surface::new(mesh, displacement),
            values: Values::InCells(energy.cell_percents()),
        };
        Self::new(
            format!("Estimated error at {at}"),
            "error of a cell [%]",
            [cells],
        )
        .logarithmic()
    }

    /// The same on a logarithmic scale.
    #[must_use]
    pub fn logarithmic(self) -> Self {
        let scale = Scale::Logarithmic;
        Self { scale, ..self }
    }
}

/// One picture of an animation.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Frame {
    /// Time in s, shown in the title.
    pub time: f64,
    /// The plates; their number is the same in every frame.
    pub panels: Vec<Panel>,
}

/// Plates that move, all frames in true proportions, at one position and on one colour scale.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Animation {
    /// Heading.
    pub title: String,
    /// The quantity that the colours show, with its unit.
    pub quantity: String,
    /// The pictures in order.
    pub frames: Vec<Frame>,
    /// The time for which each is shown, in ms.
    pub milliseconds: u16,
}
