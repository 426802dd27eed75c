//! Fields on meshes: the nodes are the markers.

use std::path::Path;

use super::rows::{FileRows, ReadSettings, Row};
use super::understood::Understood;
use crate::error::Error;
use crate::mesh::import_series;

/// Reads a field on a mesh, with all its steps as frames.
pub fn read(path: &Path, reading: &ReadSettings) -> Result<FileRows, Error> {
    let unit = reading.unit.unwrap_or(1.0);
    let series = import_series(path, unit, reading.array.as_deref()).map_err(|reason| {
        let hint = "give a field as .csv (x, y, ux, uy), .vtu, .vtk (up to version 4), .pvd, Gmsh's .msh with \
                    $NodeData, or CalculiX' .frd (ASCII)";
        Error::input(format!("{} {reason}", path.display()), hint)
    })?;
    let several = series.steps.len() > 1;
    let steps = series.steps.iter().zip(1..);
    let rows = steps.flat_map(|(step, number)| {
        let nodes = series.mesh.nodes.iter().zip(0..);
        let pairs = nodes.zip(step.displacement.chunks_exact(2));
        pairs.map(move |((position, node), u)| Row {
            frame: several.then_some(number),
            time: step.time,
            name: Some(node),
            position: *position,
            displacement: [u[0], u[1]],
            ..Row::default()
        })
    });
    Ok(FileRows {
        rows: rows.collect(),
        mesh: Some(series.mesh),
        understood: Understood::of("field on a mesh"),
        ..FileRows::default()
    })
}
