//! Pictures of a corrected frame.

use crate::corrector::measured::FieldEstimate;
use crate::measured_field::MeasuredField;
use crate::measurement::Frame;
use crate::mesh::Mesh;
use crate::output::figures::{Figure, cells, deformed};
use crate::output::picture::Scale;
use crate::output::picture::fields::{Colours, FieldCell, FieldFigure, Panel};

use super::{left, nominal_stress};

/// The pictures of one frame.
pub fn figures(field: &MeasuredField, frame: &Frame, estimate: &FieldEstimate) -> Vec<Figure> {
    let (mesh, u) = (&field.mesh, &estimate.displacement);
    let at = format!("frame {}", frame.number);
    let nodal = |label: &str, value: &dyn Fn(usize) -> f64| panel(label, cells(mesh, u, value));
    let in_cells =
        |label: &str, value: &dyn Fn(usize) -> f64| panel(label, deformed(mesh, u, value));
    let length = |values: &[f64], node: usize| values[2 * node].hypot(values[2 * node + 1]);
    let stress = |cell: usize| largest(nominal_stress(&estimate.cells[cell]));
    let stress_error = |cell: usize| largest(estimate.cells[cell].stress_error);
    vec![
        figure(
            "displacement.png",
            &format!(
                "The corrected displacement of {at}, and its standard error from the noise of the markers."
            ),
            FieldFigure {
                title: format!("Corrected displacement, {at}"),
                quantity: "displacement [mm]".into(),
                scale: Scale::Linear,
                colours: Colours::Diverging,
                panels: vec![
                    nodal("along x", &|node| u[2 * node]),
                    nodal("along y", &|node| u[2 * node + 1]),
                ],
            },
        ),
        figure(
            "displacement_error.png",
            "Standard error of the corrected displacement.",
            sequential(
                "Standard error of the displacement",
                "standard error [mm]",
                nodal(&at, &|node| length(&estimate.displacement_error, node)),
            ),
        ),
        figure(
            "stress.png",
            "Largest component of the nominal stress in every cell.",
            sequential(
                "Nominal stress",
                "largest component [MPa]",
                in_cells(&at, &stress),
            ),
        ),
        figure(
            "stress_error.png",
            "Its standard error from the noise of the markers.",
            sequential(
                "Standard error of the nominal stress",
                "largest component [MPa]",
                in_cells(&at, &stress_error),
            ),
        ),
        figure(
            "residuals.png",
            "What is left of every marker in units of its standard deviation, up to 5: sound markers are seldom above 3.7.",
            sequential(
                "Standardised residuals of the markers",
                "standardised residual [–]",
                panel(&at, marker_squares(frame, estimate)),
            ),
        ),
        figure(
            "multipliers.png",
            "The multipliers of equilibrium: where the data pull the field away from the physics.",
            sequential(
                "Multipliers of equilibrium",
                "|ζ| [mm²/N]",
                nodal(&at, &|node| length(&estimate.multipliers, node)),
            ),
        ),
        figure(
            "thickness.png",
            "Thickness of the deformed sheet.",
            sequential(
                "Thickness",
                "thickness [mm]",
                in_cells(&at, &|cell| estimate.cells[cell].thickness),
            ),
        ),
        figure("mesh.png", "The mesh at rest.", mesh_at_rest(mesh)),
    ]
}

fn figure(name: &str, caption: &str, drawn: impl Into<Drawn>) -> Figure {
    Figure {
        name: name.to_owned(),
        caption: caption.to_owned(),
        png: drawn.into().0,
    }
}

/// A picture.
struct Drawn(Vec<u8>);

impl From<FieldFigure> for Drawn {
    fn from(figure: FieldFigure) -> Self {
        Self(figure.png())
    }
}

fn mesh_at_rest(mesh: &Mesh) -> Drawn {
    Drawn(crate::output::mesh_picture("The mesh", mesh))
}

fn panel(label: &str, cells: Vec<FieldCell>) -> Panel {
    Panel {
        label: label.to_owned(),
        cells,
    }
}

fn sequential(title: &str, quantity: &str, panel: Panel) -> FieldFigure {
    FieldFigure {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        scale: Scale::Linear,
        colours: Colours::Sequential,
        panels: vec![panel],
    }
}

fn largest(components: [f64; 4]) -> f64 {
    components.iter().fold(0.0, |most, c| most.max(c.abs()))
}

/// The residual that has the lightest colour.
const LARGEST_RESIDUAL: f64 = 5.0;

/// A square for every marker where it was measured.
fn marker_squares(frame: &Frame, estimate: &FieldEstimate) -> Vec<FieldCell> {
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
        (corners, value.min(LARGEST_RESIDUAL))
    };
    let moved = frame
        .markers
        .iter()
        .map(|marker| [0, 1].map(|axis| marker.place[axis] + marker.displacement[axis]));
    let known = moved.zip(left(estimate).map(|left| left.standardised));
    known
        .filter(|(_, value)| value.is_finite())
        .map(square)
        .collect()
}
