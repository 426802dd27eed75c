//! Pictures of a corrected frame.

use crate::estimation::FieldEstimate;
use crate::markers::Frame;
use crate::mesh::Mesh;
use crate::results::{
    Deformed, Drawing, FieldFigure, Figure, Panel, SheetField, mesh_outlines, sheet_figures,
};
use crate::studies::markers::MarkerStudy;

use super::quantities::{misfits, nominal_stress, residuals};

/// The pictures of one frame, with these fields of the sheet besides.
pub fn figures(
    field: &MarkerStudy,
    frame: &Frame,
    estimate: &FieldEstimate,
    sheet: &[SheetField],
) -> Vec<Figure> {
    let pictures = Pictures {
        mesh: &field.mesh,
        at: format!("frame {}", frame.number),
        estimate,
    };
    let stress = |cell: usize| largest(nominal_stress(&estimate.cells[cell]));
    let stress = pictures.in_cells("Nominal stress", "largest component [MPa]", &stress);
    let thickness = |cell: usize| estimate.cells[cell].thickness;
    let thickness = pictures.in_cells("Thickness", "thickness [mm]", &thickness);
    let fields = vec![&estimate.displacement[..]];
    let deformed = [Deformed::elastic(&*pictures.at, &field.mesh, fields)];
    let law = field.law(estimate);
    let file = |name: &str| format!("{name}.png");
    let states = sheet_figures(sheet, &*law, &deformed, &pictures.at, &file);
    let multipliers = &estimate.multipliers;
    let multipliers = pictures.at_nodes("Multipliers of equilibrium", "|ζ| [mm²/N]", multipliers);
    let mut all = vec![
        pictures.along(0),
        pictures.along(1),
        Figure::new(
            "stress.png",
            "Largest component of the nominal stress in every cell, averaged at the nodes.",
            stress,
        ),
        Figure::new(
            "thickness.png",
            "Thickness of the deformed sheet.",
            thickness,
        ),
        Figure::new(
            "multipliers.png",
            "The multipliers of equilibrium: where the data pull the field away from the physics.",
            multipliers,
        ),
    ];
    all.splice(2..2, states);
    match field.coarse {
        None => all.extend(pictures.uncertainty(frame)),
        Some(_) => all.push(pictures.correction(frame)),
    }
    let mesh: Drawing = mesh_outlines("The mesh", &field.mesh);
    all.push(Figure::new("mesh.png", "The mesh at rest.", mesh));
    all
}

struct Pictures<'a> {
    mesh: &'a Mesh,
    at: String,
    estimate: &'a FieldEstimate,
}

impl Pictures<'_> {
    fn along(&self, axis: usize) -> Figure {
        let u = &self.estimate.displacement;
        let name = ["x", "y"][axis];
        let panel = Panel::at_nodes(&self.at, self.mesh, u, &|node| u[2 * node + axis]);
        let quantity = format!("u{name} [mm]");
        let figure = FieldFigure::new("Corrected displacement", quantity, [panel]);
        let caption = format!("The corrected displacement along {name}.");
        Figure::new(format!("displacement_{name}.png"), caption, figure)
    }

    /// A value of each cell, at the nodes the mean of the cells around.
    fn in_cells(&self, title: &str, quantity: &str, value: &dyn Fn(usize) -> f64) -> FieldFigure {
        let at_nodes = means_at_nodes(self.mesh, value);
        let displacement = &self.estimate.displacement;
        let panel = Panel::at_nodes(&self.at, self.mesh, displacement, &|node| at_nodes[node]);
        FieldFigure::new(title, quantity, [panel])
    }

    /// The lengths of vectors at the nodes.
    fn at_nodes(&self, title: &str, quantity: &str, vectors: &[f64]) -> FieldFigure {
        let length = |node: usize| vectors[2 * node].hypot(vectors[2 * node + 1]);
        let panel = Panel::at_nodes(&self.at, self.mesh, &self.estimate.displacement, &length);
        FieldFigure::new(title, quantity, [panel])
    }

    /// A value of each marker where it was measured.
    fn at_markers(&self, title: &str, quantity: &str, cells: Vec<Square>) -> FieldFigure {
        FieldFigure::new(title, quantity, [Panel::quadrilaterals(&self.at, &cells)])
    }

    fn uncertainty(&self, frame: &Frame) -> [Figure; 4] {
        let estimate = self.estimate;
        let displacement = self.at_nodes(
            "Standard error of the displacement",
            "standard error [mm]",
            &estimate.displacement_error,
        );
        let stress = self.in_cells(
            "Standard error of the nominal stress",
            "largest component [MPa]",
            &|cell| largest(estimate.cells[cell].stress_error),
        );
        let residuals = residuals(estimate).map(|left| left.standardised);
        let residuals = self.at_markers(
            "Standardised residuals of the markers",
            "standardised residual [–]",
            marker_squares(frame, residuals),
        );
        let misfits = misfits(frame, estimate);
        let lengths = misfits.into_iter().map(|[x, y]| x.hypot(y));
        let misfit = self.at_markers(
            "Mean residual of neighbouring markers",
            "misfit [mm]",
            marker_squares(frame, lengths),
        );
        let caption = |of: &str| {
            if estimate.has_intervals() {
                format!("Standard error of the {of} from the noise of the markers.")
            } else {
                format!(
                    "Spread of the {of} if all residuals were noise: the data are not explained, so this is no measure of the error."
                )
            }
        };
        [
            Figure::new(
                "displacement_error.png",
                caption("displacement"),
                displacement,
            ),
            Figure::new("stress_error.png", caption("nominal stress"), stress),
            Figure::new(
                "residuals.png",
                "Residual of every marker in units of its standard deviation; normal noise exceeds 3.7 at one marker in a thousand.",
                residuals,
            ),
            Figure::new(
                "misfit.png",
                "Mean residual of every marker and its eight neighbours: noise alone gives a third of its size; more shows where \
                 law, thickness and conditions are wrong.",
                misfit,
            ),
        ]
    }

    fn correction(&self, frame: &Frame) -> Figure {
        let lengths = residuals(self.estimate).map(|left| left.residual[0].hypot(left.residual[1]));
        Figure::new(
            "correction.png",
            "How far the correction has moved the nodes of the given field.",
            self.at_markers(
                "Distance to the given field",
                "distance [mm]",
                marker_squares(frame, lengths),
            ),
        )
    }
}

/// The mean of the values of the cells around each node.
fn means_at_nodes(mesh: &Mesh, value: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let mut sums = vec![[0.0; 2]; mesh.nodes.len()];
    for cell in 0..mesh.cell_count() {
        let value = value(cell);
        for node in mesh.cell(cell) {
            sums[*node][0] += value;
            sums[*node][1] += 1.0;
        }
    }
    sums.iter().map(|[sum, cells]| sum / cells).collect()
}

fn largest(components: [f64; 4]) -> f64 {
    components.iter().fold(0.0, |most, c| most.max(c.abs()))
}

/// The corners of a square and its value.
type Square = ([[f64; 2]; 4], f64);

/// A square for every marker with a value where it was measured.
fn marker_squares(frame: &Frame, values: impl Iterator<Item = f64>) -> Vec<Square> {
    let places = || frame.markers.iter().map(|marker| marker.place);
    let limit =
        |axis: usize, pick: fn(f64, f64) -> f64| places().map(|place| place[axis]).reduce(pick);
    let extent = [0, 1].map(|axis| {
        limit(axis, f64::max).unwrap_or_default() - limit(axis, f64::min).unwrap_or_default()
    });
    let half = 0.35 * (extent[0] * extent[1] / frame.markers.len() as f64).sqrt();
    let square = |([x, y], value): ([f64; 2], f64)| {
        let corner = |dx: f64, dy: f64| [x + half * dx, y + half * dy];
        let corners = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        (corners, value)
    };
    let moved = frame
        .markers
        .iter()
        .map(|marker| [0, 1].map(|axis| marker.place[axis] + marker.displacement[axis]));
    let known = moved.zip(values).filter(|(_, value)| value.is_finite());
    known.map(square).collect()
}
