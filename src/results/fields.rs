//! Fields on deformed meshes as data, and the meshes themselves.

use super::Scale;
use crate::finite_element::error_estimate::EnergyError;
use crate::mesh::Mesh;

/// A cell: its corners in mm and its value.
pub type FieldCell = ([[f64; 2]; 4], f64);

/// One plate.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Its name.
    pub label: String,
    /// Its cells.
    pub cells: Vec<FieldCell>,
}

impl Panel {
    /// A field with a value at each node of a deformed mesh.
    pub fn at_nodes(
        label: impl Into<String>,
        mesh: &Mesh,
        displacement: &[f64],
        value: &dyn Fn(usize) -> f64,
    ) -> Self {
        let label = label.into();
        let cells = cells(mesh, displacement, value);
        Self { label, cells }
    }

    /// A field with a value in each cell of a deformed mesh.
    pub fn in_cells(
        label: impl Into<String>,
        mesh: &Mesh,
        displacement: &[f64],
        value: &dyn Fn(usize) -> f64,
    ) -> Self {
        let label = label.into();
        let cells = deformed(mesh, displacement, value);
        Self { label, cells }
    }

    /// The distance of a displacement field from another one at the same nodes.
    pub fn distance(label: &str, mesh: &Mesh, u: &[f64], v: &[f64]) -> Self {
        let along = |node: usize, axis: usize| u[2 * node + axis] - v[2 * node + axis];
        Self::at_nodes(label, mesh, u, &|node| along(node, 0).hypot(along(node, 1)))
    }
}

/// Which colours a field is drawn in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Dark to light: magnitudes.
    Sequential,
    /// Blue over white to red: values of both signs; the range is made symmetric.
    Diverging,
}

/// Plates above each other, in true proportions, on one colour scale.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldFigure {
    /// Heading.
    pub title: String,
    /// What the colours show, with its unit.
    pub quantity: String,
    /// How the values lie on the colour bar.
    pub scale: Scale,
    /// The colours.
    pub colours: Colours,
    /// The plates.
    pub panels: Vec<Panel>,
}

impl FieldFigure {
    /// Magnitudes on an even scale.
    pub fn new(
        title: impl Into<String>,
        quantity: impl Into<String>,
        panels: impl IntoIterator<Item = Panel>,
    ) -> Self {
        Self {
            title: title.into(),
            quantity: quantity.into(),
            scale: Scale::Linear,
            colours: Colours::Sequential,
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
        let percents = energy.cell_percents();
        let cells = Panel::in_cells(mesh.describe(), mesh, displacement, &|cell| percents[cell]);
        Self::new(
            format!("Estimated error at {at}"),
            "error of a cell [%]",
            [cells],
        )
        .logarithmic()
    }

    /// On a logarithmic scale.
    #[must_use]
    pub fn logarithmic(self) -> Self {
        let scale = Scale::Logarithmic;
        Self { scale, ..self }
    }

    /// In colours for values of both signs.
    #[must_use]
    pub fn diverging(self) -> Self {
        let colours = Colours::Diverging;
        Self { colours, ..self }
    }
}

/// One picture of an animation.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Time in s, shown in the title.
    pub time: f64,
    /// The plates; as many in every frame.
    pub panels: Vec<Panel>,
}

/// Plates that move, all frames in true proportions, at one place and on one colour scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Heading.
    pub title: String,
    /// What the colours show, with its unit.
    pub quantity: String,
    /// The colours.
    pub colours: Colours,
    /// The pictures in order.
    pub frames: Vec<Frame>,
    /// How long each is shown, in ms.
    pub milliseconds: u16,
}

/// Deformed cells with the mean of their corners' values.
fn cells(mesh: &Mesh, displacement: &[f64], value: &dyn Fn(usize) -> f64) -> Vec<FieldCell> {
    let mean = |cell: usize| {
        let corners = &mesh.cell(cell)[..mesh.shape(cell).corners()];
        let sum: f64 = corners.iter().map(|node| value(*node)).sum();
        sum / corners.len() as f64
    };
    deformed(mesh, displacement, &mean)
}

/// Deformed cells with their values.
fn deformed(mesh: &Mesh, displacement: &[f64], value: &dyn Fn(usize) -> f64) -> Vec<FieldCell> {
    let place =
        |node: usize| [0, 1].map(|axis| mesh.nodes[node][axis] + displacement[2 * node + axis]);
    let cell = |cell: usize| {
        // A triangle is a quadrilateral whose last two corners are one.
        let last = mesh.shape(cell).corners() - 1;
        let corners: [usize; 4] = std::array::from_fn(|corner| mesh.cell(cell)[corner.min(last)]);
        (corners.map(place), value(cell))
    };
    (0..mesh.cell_count()).map(cell).collect()
}
