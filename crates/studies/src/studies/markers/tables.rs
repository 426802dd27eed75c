//! Tables of a corrected field, with units in the heads.

use std::fmt::Write;

use super::quantities::{nominal, nominal_stress, residuals};
use crate::document::write_records;
use crate::estimation::FieldEstimate;
use crate::markers::Frame;
use crate::problem::SheetLaws;
use crate::results::cell_states;
use crate::studies::markers::MarkerStudy;

/// Adds a row to a table; a value that is not finite leaves its field empty.
fn row(text: &mut String, first: &[usize], values: &[f64]) {
    let first = first.iter().map(ToString::to_string);
    let values = values.iter().map(|value| finite(*value));
    let fields: Vec<String> = first.chain(values).collect();
    let _ = writeln!(text, "{}", fields.join(","));
}

/// A number with ten digits; empty where it is not finite.
fn finite(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.9e}")
    } else {
        String::new()
    }
}

/// The name of a standard error; where the data are not explained it is no measure of the error, and the name says so.
fn error(estimate: &FieldEstimate) -> &'static str {
    if estimate.has_intervals() {
        "standard_error"
    } else {
        "spread_not_explained"
    }
}

pub fn nodes(field: &MarkerStudy, estimate: &FieldEstimate) -> String {
    let error = error(estimate);
    let mut text = format!(
        "node,X_mm,Y_mm,ux_mm,uy_mm,ux_{error}_mm,uy_{error}_mm,reaction_x_N,reaction_y_N,\
         multiplier_x_mm2_per_N,multiplier_y_mm2_per_N\n",
    );
    for (node, [x, y]) in field.mesh.nodes.iter().enumerate() {
        let pair = |values: &[f64]| [values[2 * node], values[2 * node + 1]];
        let parts = [
            [*x, *y],
            pair(&estimate.displacement),
            pair(&estimate.displacement_error),
            pair(&estimate.reactions),
            pair(&estimate.multipliers),
        ];
        row(&mut text, &[node], parts.as_flattened());
    }
    text
}

/// Stress, thickness and strain in the middle of the cells.
pub fn cells(field: &MarkerStudy, estimate: &FieldEstimate) -> String {
    let mut text = String::from("cell,X_mm,Y_mm");
    let error = error(estimate);
    for of in [String::new(), format!("_{error}")] {
        for component in ["xx", "xy", "yx", "yy"] {
            let _ = write!(text, ",nominal_stress_{component}{of}_MPa");
        }
    }
    let _ = write!(text, ",thickness_mm,thickness_{error}_mm");
    for (of, unit) in [("cauchy_stress", "_MPa"), ("green_lagrange_strain", "")] {
        for component in ["xx", "yy", "zz", "xy"] {
            let _ = write!(text, ",{of}_{component}{unit}");
        }
    }
    text.push('\n');
    let laws = SheetLaws::from(&field.laws(estimate)).in_cells(&field.mesh);
    let states = cell_states(&laws, &field.mesh, &[&estimate.displacement], &[]);
    for (index, (cell, state)) in estimate.cells.iter().zip(states).enumerate() {
        let mut values = field.mesh.centre(index).to_vec();
        values.extend(nominal_stress(cell));
        values.extend(nominal(cell.stress_error));
        values.extend([cell.thickness, cell.thickness_error]);
        values.extend(state.cauchy);
        values.extend(state.green_lagrange);
        row(&mut text, &[index], &values);
    }
    text
}

pub fn markers(frame: &Frame, estimate: &FieldEstimate) -> String {
    let mut text = String::from(
        "marker,X_mm,Y_mm,ux_mm,uy_mm,residual_x_mm,residual_y_mm,standardised_residual,trust,outlier\n",
    );
    for (marker, residual) in frame.markers.iter().zip(residuals(estimate)) {
        let measured = [marker.position, marker.displacement];
        let values = [measured.as_flattened(), &residual].concat();
        row(&mut text, &[marker.number], &values);
    }
    text
}

/// The forces on the edges in all frames.
pub fn forces(field: &MarkerStudy, estimates: &[FieldEstimate]) -> String {
    let of_axis = |axis: &str| {
        ["", "_standard_error", "_low", "_high"].map(|of| format!("force_{axis}{of}_N"))
    };
    let mut head = vec!["frame".to_owned(), "edge".to_owned()];
    head.extend(["x", "y"].iter().flat_map(|axis| of_axis(axis)));
    head.push("verdict".to_owned());
    let mut records = vec![head];
    for (frame, estimate) in field.frames_with(estimates) {
        let explained = |value: f64| {
            let shown = estimate.has_intervals();
            finite(if shown { value } else { f64::NAN })
        };
        for force in &estimate.forces {
            let mut record = vec![frame.number.to_string(), force.edge.clone()];
            for force in &force.force {
                record.push(format!("{:.9e}", force.value));
                let [low, high] = force.interval;
                record.extend([force.standard_error, low, high].map(explained));
            }
            record.push(estimate.verdict.answer.words().to_owned());
            records.push(record);
        }
    }
    write_records(records)
}
