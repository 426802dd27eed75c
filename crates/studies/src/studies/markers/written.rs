//! The files of a correction of measured displacements.
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

use crate::estimation::FieldEstimate;
use crate::markers::Frame;
use crate::material::PlaneState;
use crate::results::{Array, Content, Grid, GridSeries, NamedGrid, Outcome, Results, Sheet};
use crate::statistics::larger;
use crate::studies::markers::MarkerStudy;
use crate::studies::pictures::Pictures;

use super::quantities::{misfits, nominal, residuals};
use super::{figures, headline, json, report, tables};

/// The `kind` of these results.
pub const KIND: &str = "markers";

/// The results of a correction except the [`FrameFiles`], with the `pictures` that are wanted, the study's `name` and `text`, empty where
/// there is none, and after `seconds`.
pub fn results(
    pictures: &Pictures,
    field: &MarkerStudy,
    estimates: &[FieldEstimate],
    name: String,
    text: String,
    seconds: f64,
) -> Results {
    let doubts = field.all_doubts(estimates);
    let last = field.frames_with(estimates).next_back();
    let figures = last.map(|(frame, last)| figures::figures(field, frame, last, &pictures.fields));
    let outcome = Outcome {
        problem: json::problem(field, estimates),
        material: Some(field.cards().material(&field.mesh)),
        along: "frame",
        steps: field
            .frames_with(estimates)
            .map(|(frame, estimate)| json::step(field, frame, estimate))
            .collect(),
        headline: headline::headline(field, estimates),
        blocks: report::blocks(field, estimates),
        figures: figures.unwrap_or_default(),
        style: pictures.style.clone(),
        explored: vec![explored(field, estimates)],
        files: vec![(
            "forces.csv".to_owned(),
            Content::Text(tables::forces(field, estimates)),
        )],
        balance: estimates
            .iter()
            .map(|estimate| estimate.imbalance)
            .reduce(larger),
        summary: report::summary(field, estimates, &doubts),
        findings: doubts,
        ..Outcome::default()
    };
    Results {
        name,
        title: title(field),
        kind: KIND,
        text,
        read_warnings: field.warnings.iter().map(ToString::to_string).collect(),
        outcome,
        seconds,
        ..Results::default()
    }
}

/// Grids and tables of one frame, which can be written as soon as it is corrected.
pub struct FrameFiles {
    /// The corrected field, and the markers.
    pub grids: [NamedGrid; 2],
    /// Tables by the names of their files.
    pub tables: [(String, String); 3],
}

impl FrameFiles {
    /// Of a frame and its corrected field.
    pub fn new(field: &MarkerStudy, frame: &Frame, estimate: &FieldEstimate) -> Self {
        let number = frame.number;
        let named = |series: &str, grid: Grid| NamedGrid {
            name: grid_name(series, frame),
            time: Some(time(frame)),
            grid,
        };
        let tables = [
            ("nodes", tables::nodes(field, estimate)),
            ("cells", tables::cells(field, estimate)),
            ("markers", tables::markers(frame, estimate)),
        ];
        Self {
            grids: [
                named(SERIES[0], corrected(field, estimate)),
                named(SERIES[1], markers(frame, estimate)),
            ],
            tables: tables.map(|(name, table)| (format!("{name}_{number:03}.csv"), table)),
        }
    }
}

/// The series of grids.
pub const SERIES: [&str; 2] = ["corrected", "markers"];

/// The times of the frames and the names of their grids in a series.
pub fn played(field: &MarkerStudy, series: &str) -> Vec<(f64, String)> {
    let frames = field.series.frames.iter();
    frames
        .map(|frame| (time(frame), grid_name(series, frame)))
        .collect()
}

fn grid_name(series: &str, frame: &Frame) -> String {
    format!("{series}_{:03}", frame.number)
}

fn time(frame: &Frame) -> f64 {
    frame.time.unwrap_or(frame.number as f64)
}

/// The heading of a report.
pub(super) fn title(field: &MarkerStudy) -> String {
    match field.conditions.title.as_str() {
        "" => "Corrected displacement field".to_owned(),
        title => title.to_owned(),
    }
}

fn explored(field: &MarkerStudy, estimates: &[FieldEstimate]) -> GridSeries {
    const MOST: usize = 20;
    let frames = field.frames_with(estimates);
    let last = frames.skip(estimates.len().saturating_sub(MOST));
    let grids = last.map(|(frame, estimate)| (frame.number as f64, corrected(field, estimate)));
    GridSeries::steps(SERIES[0], grids)
}

fn corrected(field: &MarkerStudy, estimate: &FieldEstimate) -> Grid {
    let laws = field.laws(estimate);
    let sheet = Sheet::elastic((&laws).into(), field.thickness);
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
    // Nothing acts across a sheet in plane stress; in plane strain that error is not estimated.
    let across = match field.card.law.plane_state() {
        PlaneState::Stress => 0.0,
        PlaneState::Strain => f64::NAN,
    };
    let stress = cells.clone().flat_map(|cell| {
        let [xx, xy, yx, yy] = nominal(cell.stress_error);
        [xx, xy, yx, yy, across]
    });
    let thickness = cells.map(|cell| cell.thickness_error);
    let [of_displacement, of_stress, of_thickness] = if estimate.has_intervals() {
        [
            "displacement_standard_error_mm",
            "nominal_stress_standard_error_MPa",
            "thickness_standard_error_mm",
        ]
    } else {
        [
            "displacement_spread_not_explained_mm",
            "nominal_stress_spread_not_explained_MPa",
            "thickness_spread_not_explained_mm",
        ]
    };
    grid.with([nodal(of_displacement, &estimate.displacement_error)])
        .with_in_cells([
            Array::tensors(of_stress, stress),
            Array::scalars(of_thickness, thickness),
        ])
}

fn markers(frame: &Frame, estimate: &FieldEstimate) -> Grid {
    let all = &frame.markers;
    let positions: Vec<[f64; 2]> = all.iter().map(|marker| marker.position).collect();
    let measured: Vec<f64> = all.iter().flat_map(|marker| marker.displacement).collect();
    let numbers = all.iter().map(|marker| marker.number as f64);
    let of = |name, position: usize| {
        Array::scalars(name, residuals(estimate).map(|residual| residual[position]))
    };
    let differences = residuals(estimate).flat_map(|[x, y, ..]| [x, y]);
    let misfit = misfits(frame, estimate).into_iter().flatten();
    Grid::scattered(&positions, &measured).with([
        Array::vectors("residual_mm", differences),
        Array::vectors("mean_residual_of_neighbours_mm", misfit),
        of("standardised_residual", 2),
        of("trust", 3),
        of("outlier", 4),
        Array::scalars("number", numbers),
    ])
}
