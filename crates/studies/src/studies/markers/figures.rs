//! Pictures of a corrected frame.

use crate::estimation::FieldEstimate;
use crate::markers::Frame;
use crate::mesh::Mesh;
use crate::mesh::geometry::sides;
use crate::results::{
    Deformed, Drawing, FieldFigure, Figure, Panel, ShownFields, mesh_outlines, sheet_figures,
};
use crate::statistics::farthest;
use crate::studies::markers::MarkerStudy;

use super::quantities::{misfits, nominal_stress, residuals};

/// The pictures of one frame, with these fields of the sheet besides.
pub fn figures(
    study: &MarkerStudy,
    frame: &Frame,
    estimate: &FieldEstimate,
    sheet: &ShownFields,
) -> Vec<Figure> {
    let pictures = Pictures {
        mesh: &study.mesh,
        label: format!("frame {}", frame.number),
        estimate,
    };
    let cells = &estimate.cells;
    let fields = vec![&estimate.displacement[..]];
    let deformed = [Deformed::elastic(&*pictures.label, &study.mesh, fields)];
    let file = |name: &str| format!("{name}.png");
    let laws = study.laws(estimate);
    let (laws, at) = ((&laws).into(), &*pictures.label);
    let mut all = sheet_figures(&sheet.with_displacements(), laws, &deformed, at, &file);
    all.extend([
        Figure::new(
            "stress.png",
            "Largest component of the nominal stress in every cell, averaged at the nodes.",
            pictures.in_cells("Nominal stress", "largest component [MPa]", &|cell| {
                farthest(nominal_stress(&cells[cell])).abs()
            }),
        ),
        Figure::new(
            "thickness.png",
            "Thickness of the deformed sheet.",
            pictures.in_cells("Thickness", "thickness [mm]", &|cell| cells[cell].thickness),
        ),
        Figure::new(
            "multipliers.png",
            "The multipliers of equilibrium: where the data pull the field away from the physics.",
            pictures.lengths(
                "Multipliers of equilibrium",
                "|ζ| [mm²/N]",
                &estimate.multipliers,
            ),
        ),
    ]);
    match study.coarse {
        None => all.extend(pictures.uncertainty(frame)),
        Some(_) => all.push(pictures.correction(frame)),
    }
    let mesh: Drawing = mesh_outlines("The mesh", &study.mesh);
    all.push(Figure::new("mesh.png", "The mesh at rest.", mesh));
    all
}

struct Pictures<'a> {
    mesh: &'a Mesh,
    label: String,
    estimate: &'a FieldEstimate,
}

impl Pictures<'_> {
    /// A value of each node.
    fn at_nodes(&self, title: &str, quantity: &str, value: &dyn Fn(usize) -> f64) -> FieldFigure {
        let displacement = &self.estimate.displacement;
        let panel = Panel::at_nodes(&self.label, self.mesh, displacement, value);
        FieldFigure::new(title, quantity, [panel])
    }

    /// A value of each cell, at the nodes the mean of the cells around.
    fn in_cells(&self, title: &str, quantity: &str, value: &dyn Fn(usize) -> f64) -> FieldFigure {
        let mut sums = vec![[0.0; 2]; self.mesh.nodes.len()];
        for cell in 0..self.mesh.cell_count() {
            let value = value(cell);
            for node in self.mesh.cell(cell) {
                sums[*node][0] += value;
                sums[*node][1] += 1.0;
            }
        }
        self.at_nodes(title, quantity, &|node| sums[node][0] / sums[node][1])
    }

    /// The lengths of vectors at the nodes.
    fn lengths(&self, title: &str, quantity: &str, vectors: &[f64]) -> FieldFigure {
        self.at_nodes(title, quantity, &|node| {
            vectors[2 * node].hypot(vectors[2 * node + 1])
        })
    }

    /// A square for every marker with a value, at its position in the frame.
    fn at_markers(
        &self,
        title: &str,
        quantity: &str,
        frame: &Frame,
        values: impl Iterator<Item = f64>,
    ) -> FieldFigure {
        let [length, width] = sides(frame.markers.iter().map(|marker| marker.position));
        let half = 0.35 * (length * width / frame.markers.len() as f64).sqrt();
        let squares = frame.markers.iter().zip(values).map(|(marker, value)| {
            let [x, y] = [0, 1].map(|axis| marker.position[axis] + marker.displacement[axis]);
            let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
            (corners.map(|[dx, dy]| [x + dx, y + dy]), value)
        });
        let squares: Vec<_> = squares.filter(|(_, value)| value.is_finite()).collect();
        FieldFigure::new(
            title,
            quantity,
            [Panel::quadrilaterals(&self.label, &squares)],
        )
    }

    fn uncertainty(&self, frame: &Frame) -> [Figure; 4] {
        let estimate = self.estimate;
        let caption = |of: &str| {
            if estimate.has_intervals() {
                format!("Standard error of the {of} from the noise of the markers.")
            } else {
                format!(
                    "Spread of the {of} if all residuals were noise: the data are not explained, so this is no measure of the error."
                )
            }
        };
        let misfits = misfits(frame, estimate).into_iter();
        [
            Figure::new(
                "displacement_error.png",
                caption("displacement"),
                self.lengths(
                    "Standard error of the displacement",
                    "standard error [mm]",
                    &estimate.displacement_error,
                ),
            ),
            Figure::new(
                "stress_error.png",
                caption("nominal stress"),
                self.in_cells(
                    "Standard error of the nominal stress",
                    "largest component [MPa]",
                    &|cell| farthest(estimate.cells[cell].stress_error).abs(),
                ),
            ),
            Figure::new(
                "residuals.png",
                "Residual of every marker in units of its standard deviation; normal noise exceeds 3.7 at one marker in a thousand.",
                self.at_markers(
                    "Standardised residuals of the markers",
                    "standardised residual [–]",
                    frame,
                    residuals(estimate).map(|[_, _, standardised, ..]| standardised),
                ),
            ),
            Figure::new(
                "misfit.png",
                "Mean residual of every marker and its eight neighbours: noise alone gives a third of its size; more shows where \
                 law, thickness and conditions are wrong.",
                self.at_markers(
                    "Mean residual of neighbouring markers",
                    "misfit [mm]",
                    frame,
                    misfits.map(|[x, y]| x.hypot(y)),
                ),
            ),
        ]
    }

    fn correction(&self, frame: &Frame) -> Figure {
        let lengths = residuals(self.estimate).map(|[x, y, ..]| x.hypot(y));
        Figure::new(
            "correction.png",
            "How far the correction has moved the nodes of the given field.",
            self.at_markers(
                "Distance to the given field",
                "distance [mm]",
                frame,
                lengths,
            ),
        )
    }
}
