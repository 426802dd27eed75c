//! What the correction of measured displacements writes.
//!
//! ```text
//! report.html, report.md, report.json
//! displacement.png …                    pictures of the last frame
//! vtk/corrected.pvd, corrected_001.vtu  field, stress, thickness, reactions, multipliers, standard errors
//! vtk/markers.pvd, markers_001.vtu      markers with their residuals and outliers
//! nodes_001.csv, cells_001.csv, markers_001.csv, forces.csv
//! ```
//!
//! Files of a frame carry its number.

use crate::corrector::estimation::{FieldEstimate, StressEstimate};
use crate::error::Error;
use crate::markers::Frame;
use crate::output::{ResultFolder, write_document, write_grids};
use crate::results::{Array, Grid, GridSeries, Sheet};
use crate::studies::markers::MarkerStudy;

pub use super::report::summary;
use super::{figures, json, report, tables};

/// Writes all files of a correction.
///
/// # Errors
/// [`Error::Write`] with the file that could not be written.
pub fn write(
    field: &MarkerStudy,
    estimates: &[FieldEstimate],
    folder: &mut ResultFolder,
) -> Result<(), Error> {
    let frames = || field.series.frames.iter().zip(estimates);
    for series in [
        series("corrected", field, estimates, corrected),
        series("markers", field, estimates, markers),
    ] {
        write_grids(folder, &series)?;
    }
    let mut put = |name: String, text: String| folder.add(&name, text.as_bytes());
    for (frame, estimate) in frames() {
        let number = frame.number;
        put(
            format!("nodes_{number:03}.csv"),
            tables::nodes(field, estimate),
        )?;
        put(
            format!("cells_{number:03}.csv"),
            tables::cells(field, estimate),
        )?;
        put(
            format!("markers_{number:03}.csv"),
            tables::markers(frame, estimate),
        )?;
    }
    put("forces.csv".into(), tables::forces(field, estimates))?;
    let json = json::json(field, estimates);
    put("report.json".into(), format!("{json:#}\n"))?;
    let figures = frames()
        .next_back()
        .map(|(frame, estimate)| figures::figures(field, frame, estimate));
    let figures = figures.unwrap_or_default();
    let blocks = report::report(field, estimates, &figures);
    write_document(folder, "report", &blocks, &figures)
}

type OfFrame = fn(&MarkerStudy, &Frame, &FieldEstimate) -> Grid;

fn series(
    name: &str,
    field: &MarkerStudy,
    estimates: &[FieldEstimate],
    grid: OfFrame,
) -> GridSeries {
    let frames = field.series.frames.iter().zip(estimates);
    let frames = frames.map(|(frame, estimate)| {
        let time = frame.time.unwrap_or(frame.number as f64);
        (frame.number, time, grid(field, frame, estimate))
    });
    GridSeries::numbered(name, 3, frames)
}

/// The heading of a report.
pub(super) fn title(field: &MarkerStudy) -> String {
    match field.conditions.title.as_str() {
        "" => "Corrected displacement field".to_owned(),
        title => title.to_owned(),
    }
}

fn corrected(field: &MarkerStudy, _frame: &Frame, estimate: &FieldEstimate) -> Grid {
    let law = field.law(estimate);
    let sheet = Sheet {
        law: &*law,
        thickness: field.thickness,
    };
    let nodal = |name, values: &Vec<f64>| Array::vectors(name, values.iter().copied());
    let mut grid = Grid::sheet(sheet, &field.mesh, &estimate.displacement).with([
        nodal("reaction_N", &estimate.reactions),
        nodal(
            "multiplier_zeta_equilibrium_mm2_per_N",
            &estimate.multipliers,
        ),
    ]);
    if estimate.interior_forces.len() == estimate.displacement.len() {
        grid = grid.with([nodal("interior_force_N", &estimate.interior_forces)]);
    }
    if field.coarse.is_some() {
        return grid;
    }
    let cells = estimate.cells.iter();
    let stress = cells.clone().flat_map(|cell| nominal(cell.stress_error));
    let thickness = cells.map(|cell| cell.thickness_error);
    grid.with([nodal(
        "displacement_standard_error_mm",
        &estimate.displacement_error,
    )])
    .with_in_cells([
        Array::tensors("nominal_stress_standard_error_MPa", stress),
        Array::scalars("thickness_standard_error_mm", thickness),
    ])
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

fn markers(_field: &MarkerStudy, frame: &Frame, estimate: &FieldEstimate) -> Grid {
    let all = &frame.markers;
    let places: Vec<[f64; 2]> = all.iter().map(|marker| marker.place).collect();
    let measured: Vec<f64> = all.iter().flat_map(|marker| marker.displacement).collect();
    let numbers = all.iter().map(|marker| marker.number as f64);
    let of = |name, value: fn(Left) -> f64| Array::scalars(name, left(estimate).map(value));
    let residuals = left(estimate).flat_map(|left| left.residual);
    Grid::scattered(&places, &measured).with([
        Array::vectors("residual_mm", residuals),
        of("standardised_residual_1", |left| left.standardised),
        of("trust_1", |left| left.trust),
        of("outlier_1", |left| left.outlier),
        Array::scalars("number_1", numbers),
    ])
}
