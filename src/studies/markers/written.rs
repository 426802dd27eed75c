//! What a correction of measured displacements writes.
//!
//! ```text
//! report.html, report.md, report.json
//! displacement.png …                    pictures of the last frame
//! vtk/corrected.pvd, corrected_001.vtu  field, stress, thickness, reactions, multipliers, standard errors
//! vtk/markers.pvd, markers_001.vtu      markers with what is left of them and outliers
//! nodes_001.csv, cells_001.csv, markers_001.csv, forces.csv
//! ```
//!
//! Files of frames have the frame's number.

use crate::corrector::estimation::{FieldEstimate, StressEstimate};
use crate::error::Error;
use crate::markers::Frame;
use crate::output::vtk::{self, Array};
use crate::output::{ResultFolder, write_document, write_pictures};
use crate::studies::markers::MeasuredField;

pub use super::report::summary;
use super::{figures, json, report, tables};

/// Writes all files of a correction.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(
    field: &MeasuredField,
    estimates: &[FieldEstimate],
    folder: &mut ResultFolder,
) -> Result<(), Error> {
    let frames = || field.measurement.frames.iter().zip(estimates);
    let mut put = |name: String, bytes: &[u8]| folder.add(&name, bytes);
    for (frame, estimate) in frames() {
        let number = format!("{:03}", frame.number);
        put(
            format!("vtk/corrected_{number}.vtu"),
            &corrected(field, frame, estimate),
        )?;
        put(
            format!("vtk/markers_{number}.vtu"),
            &markers(field, frame, estimate),
        )?;
        put(
            format!("nodes_{number}.csv"),
            tables::nodes(field, estimate).as_bytes(),
        )?;
        put(
            format!("cells_{number}.csv"),
            tables::cells(field, estimate).as_bytes(),
        )?;
        put(
            format!("markers_{number}.csv"),
            tables::markers(frame, estimate).as_bytes(),
        )?;
    }
    for name in ["corrected", "markers"] {
        let file = |frame: &Frame| {
            let time = frame.time.unwrap_or(frame.number as f64);
            (time, format!("{name}_{:03}.vtu", frame.number))
        };
        let files: Vec<_> = field.measurement.frames.iter().map(file).collect();
        put(format!("vtk/{name}.pvd"), &vtk::collection(&files))?;
    }
    put(
        "forces.csv".into(),
        tables::forces(field, estimates).as_bytes(),
    )?;
    let json = json::json(field, estimates);
    put("report.json".into(), format!("{json:#}\n").as_bytes())?;
    let figures = frames()
        .next_back()
        .map(|(frame, estimate)| figures::figures(field, frame, estimate));
    let figures = figures.unwrap_or_default();
    write_pictures(folder, &figures)?;
    let blocks = report::report(field, estimates, &figures);
    write_document(folder, "report", &blocks, &figures)
}

/// The heading of a report.
pub(super) fn title(field: &MeasuredField) -> String {
    match field.conditions.title.as_str() {
        "" => "Corrected displacement field".to_owned(),
        title => title.to_owned(),
    }
}

fn corrected(field: &MeasuredField, frame: &Frame, estimate: &FieldEstimate) -> Vec<u8> {
    let law = field.law(estimate);
    let sheet = vtk::Sheet {
        law: &*law,
        thickness: field.thickness,
    };
    let array = |name, components, values| Array {
        name,
        values,
        components,
    };
    let nodal = |name, values: &Vec<f64>| array(name, 2, values.clone());
    let mut at_nodes = vec![
        nodal("reaction_N", &estimate.reactions),
        nodal(
            "multiplier_zeta_equilibrium_mm2_per_N",
            &estimate.multipliers,
        ),
    ];
    if estimate.interior_forces.len() == estimate.displacement.len() {
        at_nodes.push(nodal("interior_force_N", &estimate.interior_forces));
    }
    let mut in_cells = Vec::new();
    if field.coarse.is_none() {
        at_nodes.push(nodal(
            "displacement_standard_error_mm",
            &estimate.displacement_error,
        ));
        let errors = estimate
            .cells
            .iter()
            .flat_map(|cell| nominal(cell.stress_error));
        let thickness = estimate.cells.iter().map(|cell| cell.thickness_error);
        in_cells = vec![
            array("nominal_stress_standard_error_MPa", 4, errors.collect()),
            array("thickness_standard_error_mm", 1, thickness.collect()),
        ];
    }
    let title = format!("{}, frame {}", title(field), frame.number);
    vtk::arrays_file(
        &title,
        &sheet,
        &field.mesh,
        &estimate.displacement,
        at_nodes,
        in_cells,
    )
}

/// The components xx, xy, yx, yy of the nominal stress from those of the first Piola–Kirchhoff stress, its transpose.
pub(super) fn nominal([p11, p12, p21, p22]: [f64; 4]) -> [f64; 4] {
    [p11, p21, p12, p22]
}

pub(super) fn nominal_stress(cell: &StressEstimate) -> [f64; 4] {
    nominal(cell.first_piola_kirchhoff_stress)
}

/// What is left of a marker, and no numbers where it has no place on the mesh.
pub(super) struct Left {
    pub residual: [f64; 2],
    pub standardised: f64,
    pub trust: f64,
    pub outlier: f64,
}

pub(super) fn left(estimate: &FieldEstimate) -> impl Iterator<Item = Left> {
    estimate.markers.iter().map(|marker| match marker {
        Some(marker) => Left {
            residual: marker.residual,
            standardised: marker.standardised_residual,
            trust: marker.trust,
            outlier: f64::from(u8::from(marker.outlier)),
        },
        None => Left {
            residual: [f64::NAN; 2],
            standardised: f64::NAN,
            trust: f64::NAN,
            outlier: f64::NAN,
        },
    })
}

fn markers(field: &MeasuredField, frame: &Frame, estimate: &FieldEstimate) -> Vec<u8> {
    let array = |name, components, values| Array {
        name,
        values,
        components,
    };
    let all = &frame.markers;
    let places: Vec<[f64; 2]> = all.iter().map(|marker| marker.place).collect();
    let measured = all.iter().flat_map(|marker| marker.displacement);
    let numbers = all.iter().map(|marker| marker.number as f64);
    let title = format!("{}, markers of frame {}", title(field), frame.number);
    let of = |value: fn(Left) -> f64| left(estimate).map(value).collect();
    vtk::markers_file(
        &title,
        &places,
        vec![
            array("displacement_mm", 2, measured.collect()),
            array(
                "residual_mm",
                2,
                left(estimate).flat_map(|left| left.residual).collect(),
            ),
            array("standardised_residual_1", 1, of(|left| left.standardised)),
            array("trust_1", 1, of(|left| left.trust)),
            array("outlier_1", 1, of(|left| left.outlier)),
            array("number_1", 1, numbers.collect()),
        ],
    )
}
