//! Pictures of a corrected frame.

use crate::corrector::estimation::FieldEstimate;
use crate::markers::Frame;
use crate::mesh::Mesh;
use crate::output::picture::Scale;
use crate::output::picture::fields::{Colours, FieldCell, FieldFigure, Panel};
use crate::output::{cells, deformed, mesh_picture};
use crate::results::Figure;
use crate::studies::markers::MeasuredField;

use super::written::{left, nominal_stress};

/// The pictures of one frame.
pub fn figures(field: &MeasuredField, frame: &Frame, estimate: &FieldEstimate) -> Vec<Figure> {
    let pictures = Pictures {
        mesh: &field.mesh,
        at: format!("frame {}", frame.number),
        estimate,
    };
    let mut all = vec![
        pictures.along("displacement_x.png", 0),
        pictures.along("displacement_y.png", 1),
        pictures.in_cells(
            ("stress.png", "Largest component of the nominal stress in every cell."),
            ("Nominal stress", "largest component [MPa]"),
            &|cell| largest(nominal_stress(&estimate.cells[cell])),
        ),
        pictures.in_cells(
            ("thickness.png", "Thickness of the deformed sheet."),
            ("Thickness", "thickness [mm]"),
            &|cell| estimate.cells[cell].thickness,
        ),
        pictures.at_nodes(
            ("multipliers.png", "The multipliers of equilibrium: where the data pull the field away from the physics."),
            ("Multipliers of equilibrium", "|ζ| [mm²/N]"),
            &estimate.multipliers,
        ),
    ];
    match field.coarse {
        None => all.extend(pictures.uncertainty(frame)),
        Some(_) => all.push(pictures.correction(frame)),
    }
    all.push(Figure {
        name: "mesh.png".into(),
        caption: "The mesh at rest.".into(),
        png: mesh_picture("The mesh", &field.mesh),
    });
    all
}

struct Pictures<'a> {
    mesh: &'a Mesh,
    at: String,
    estimate: &'a FieldEstimate,
}

/// File name and caption.
type Named<'a> = (&'a str, &'a str);

/// Heading and quantity.
type Headed<'a> = (&'a str, &'a str);

impl Pictures<'_> {
    fn figure(
        &self,
        (name, caption): Named,
        (title, quantity): Headed,
        cells: Vec<FieldCell>,
        colours: Colours,
    ) -> Figure {
        let figure = FieldFigure {
            title: title.to_owned(),
            quantity: quantity.to_owned(),
            scale: Scale::Linear,
            colours,
            panels: vec![Panel {
                label: self.at.clone(),
                cells,
            }],
        };
        Figure {
            name: name.to_owned(),
            caption: caption.to_owned(),
            png: figure.png(),
        }
    }

    fn along(&self, name: &str, axis: usize) -> Figure {
        let u = &self.estimate.displacement;
        let caption = format!("The corrected displacement along {}.", ["x", "y"][axis]);
        let quantity = format!("u{} [mm]", ["x", "y"][axis]);
        let cells = cells(self.mesh, u, &|node| u[2 * node + axis]);
        let headed = ("Corrected displacement", quantity.as_str());
        self.figure((name, &caption), headed, cells, Colours::Diverging)
    }

    fn in_cells(&self, named: Named, headed: Headed, value: &dyn Fn(usize) -> f64) -> Figure {
        let cells = deformed(self.mesh, &self.estimate.displacement, value);
        self.figure(named, headed, cells, Colours::Sequential)
    }

    /// The lengths of vectors at the nodes.
    fn at_nodes(&self, named: Named, headed: Headed, vectors: &[f64]) -> Figure {
        let length = |node: usize| vectors[2 * node].hypot(vectors[2 * node + 1]);
        let cells = cells(self.mesh, &self.estimate.displacement, &length);
        self.figure(named, headed, cells, Colours::Sequential)
    }

    fn uncertainty(&self, frame: &Frame) -> [Figure; 3] {
        let estimate = self.estimate;
        let residuals = left(estimate).map(|left| left.standardised.min(LARGEST_RESIDUAL));
        let squares = marker_squares(frame, residuals);
        [
            self.at_nodes(
                ("displacement_error.png", "Standard error of the displacement from the noise of the markers."),
                ("Standard error of the displacement", "standard error [mm]"),
                &estimate.displacement_error,
            ),
            self.in_cells(
                ("stress_error.png", "Standard error of the nominal stress from the noise of the markers."),
                ("Standard error of the nominal stress", "largest component [MPa]"),
                &|cell| largest(estimate.cells[cell].stress_error),
            ),
            self.figure(
                (
                    "residuals.png",
                    "What is left of every marker in units of its standard deviation, shown up to 5; normal noise leaves more \
                     than 3.7 in one of a thousand.",
                ),
                ("Standardised residuals of the markers", "standardised residual [–]"),
                squares,
                Colours::Sequential,
            ),
        ]
    }

    fn correction(&self, frame: &Frame) -> Figure {
        let lengths = left(self.estimate).map(|left| left.residual[0].hypot(left.residual[1]));
        self.figure(
            (
                "correction.png",
                "How far the correction has moved the nodes of the given field.",
            ),
            ("Distance to the given field", "distance [mm]"),
            marker_squares(frame, lengths),
            Colours::Sequential,
        )
    }
}

fn largest(components: [f64; 4]) -> f64 {
    components.iter().fold(0.0, |most, c| most.max(c.abs()))
}

/// The residual that has the lightest colour.
const LARGEST_RESIDUAL: f64 = 5.0;

/// A square for every marker with a value where it was measured.
fn marker_squares(frame: &Frame, values: impl Iterator<Item = f64>) -> Vec<FieldCell> {
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
