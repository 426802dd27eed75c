//! The mesh of a specimen: a file's, the field's own, or one made inside an outline.

use std::path::Path;

use super::edge_position::{EdgePosition, GIVE_EDGE, is_beside_grid, no_mesh};
use super::request::{MeshSource, Request};
use crate::budget::{Excess, Need};
use crate::error::{Diagnostic, Error, Severity};
use crate::images::{ImageFile, Region};
use crate::markers::{MarkerFiles, MarkerSeries, read_lines};
use crate::mesh::geometry::least_width;
use crate::mesh::{CellShape, Exemptions, Mesh, Outline, import};
use crate::units::decimals;

/// The largest number of cells for dense markers, if no size is given and enough cells go across the specimen.
const ENOUGH_CELLS: f64 = 5_000.0;

/// The largest number of cells of any mesh that is made, if no size is given.
const MOST_CELLS: f64 = 20_000.0;

/// Measured memory for each unknown of an estimate in bytes, with its intervals and files. Meshes that are refined for their discretisation
/// error take more for each unknown, but are small.
const BYTES_OF_AN_UNKNOWN: f64 = 12_000.0;

/// The least number of cells across the specimen of a mesh that is made, if no size is given.
const LEAST_ACROSS: f64 = 16.0;

/// A mesh and what it was made from.
pub(super) struct SpecimenMesh {
    pub mesh: Mesh,
    /// Size of the cells in mm, where they were made.
    pub cell_size: Option<f64>,
    pub origin: String,
    pub warnings: Vec<Diagnostic>,
    pub doubts: Vec<Diagnostic>,
    pub unknown_gap: Option<f64>,
}

impl SpecimenMesh {
    /// A mesh whose edge is known.
    fn known(mesh: Mesh, origin: String) -> Self {
        Self {
            mesh,
            cell_size: None,
            origin,
            warnings: Vec::new(),
            doubts: Vec::new(),
            unknown_gap: None,
        }
    }
}

pub(super) fn mesh(request: &Request, field: &MarkerFiles) -> Result<SpecimenMesh, Error> {
    if request.conditions.edge_gap.is_some()
        && (field.mesh.is_some() || !matches!(request.mesh, MeshSource::Data))
    {
        return Err(Error::input(
            "an edge gap is given, but the specimen's edge is not made from markers",
            "leave out --edge-gap (edge_gap), or the mesh and the outline",
        ));
    }
    let frames = field.series.frames.len();
    let markers = field.series.positions().len();
    affords(
        request,
        need_of_markers(markers as f64, frames),
        &format!("a field of {markers} markers"),
        "use every other marker, or fewer frames",
    )?;
    let afford_mesh = |mesh: &Mesh, position: &str| {
        let need = need(mesh.cell_count() as f64, mesh.nodes.len() as f64, frames);
        affords(
            request,
            need,
            &format!("the mesh {position}"),
            "use a coarser mesh or fewer frames",
        )
    };
    match (&request.mesh, &field.mesh) {
        (MeshSource::File(path, reading), _) => {
            let (mesh, warnings) = import(path, *reading).map_err(Error::Input)?;
            afford_mesh(&mesh, &format!("of {}", path.display()))?;
            let origin = format!("from {}", path.display());
            Ok(SpecimenMesh {
                warnings,
                ..SpecimenMesh::known(mesh, origin)
            })
        }
        (MeshSource::Outline(path), _) => in_outline(request, path, field),
        (MeshSource::Data, Some(mesh)) => {
            afford_mesh(mesh, "of the field")?;
            Ok(of_field(mesh))
        }
        (MeshSource::Data, None) => match &request.images.mask {
            Some(mask) if request.has_images() => in_mask(request, mask, field),
            _ => of_markers(request, field),
        },
    }
}

/// A mesh inside the lines of a table.
fn in_outline(request: &Request, path: &Path, field: &MarkerFiles) -> Result<SpecimenMesh, Error> {
    let lines = read_lines(path, request.reading.unit)?;
    let hint = "give the corners of each closed line in order, in columns x [mm], y [mm], line";
    inside(request, field, lines, "outline of", path, hint)
}

/// A mesh inside the edge of a mask.
fn in_mask(
    request: &Request,
    mask: &ImageFile,
    field: &MarkerFiles,
) -> Result<SpecimenMesh, Error> {
    let image = mask.read()?;
    let mut lines = Region::of_mask(&image, image.size())?.edge();
    let pixel = request.reading.unit.unwrap_or(f64::NAN);
    let up = (image.size()[1] - 1) as f64;
    for position in lines.iter_mut().flatten() {
        *position = [pixel * position[0], pixel * (up - position[1])];
    }
    let hint = "draw one specimen white on black, with an edge that does not touch itself";
    inside(request, field, lines, "edge of the mask", &mask.path, hint)
}

/// A mesh inside the closed lines in mm of a file; `what` and `path` name their origin, `hint` is the remedy where they enclose no specimen.
fn inside(
    request: &Request,
    field: &MarkerFiles,
    lines: Vec<Vec<[f64; 2]>>,
    what: &str,
    path: &Path,
    hint: &str,
) -> Result<SpecimenMesh, Error> {
    let outline = Outline::of_lines(lines)
        .map_err(|reason| Error::input(format!("{}: {reason}", path.display()), hint))?;
    let markers = field.series.positions().len() as f64;
    let spacing = (outline.area() / markers).sqrt();
    let (mesh, size) = mesh_inside(request, &outline, spacing, field.series.frames.len())?;
    let origin = format!("made inside the {what} {}", path.display());
    Ok(SpecimenMesh {
        cell_size: Some(size),
        ..SpecimenMesh::known(mesh, origin)
    })
}

/// The mesh that the field came on.
fn of_field(mesh: &Mesh) -> SpecimenMesh {
    let faults = mesh.faults(Exemptions::default()).into_iter();
    let warnings = faults.map(|fault| Diagnostic {
        severity: Severity::Warning,
        hint: Some("correct the field on a valid mesh: --mesh or --outline".into()),
        ..fault.prefixed("the field's own mesh")
    });
    SpecimenMesh {
        warnings: warnings.collect(),
        ..SpecimenMesh::known(mesh.clone(), "taken from the field".into())
    }
}

/// A mesh inside the outline of the markers.
fn of_markers(request: &Request, field: &MarkerFiles) -> Result<SpecimenMesh, Error> {
    let (positions, in_gaps) = positions(&field.series, request.holes);
    let mut traced = Outline::of_points(&positions).map_err(no_mesh)?;
    let mut warnings = Vec::new();
    match (traced.outline.holes.len(), request.holes) {
        (0, _) => {}
        (_, false) => traced.outline.holes.clear(),
        (count, true) => {
            let filled = match in_gaps {
                0 => String::new(),
                lost => {
                    format!(", with {lost} points in them that have no displacement in any frame")
                }
            };
            let message = format!("gaps among the markers treated as holes: {count}{filled}");
            let hint = "use --holes closed if markers were only lost there, or give the true edges with --outline";
            warnings.push(Diagnostic::warning("", message).hint(hint));
        }
    }
    let spacing = traced.spacing;
    let beside_grid = is_beside_grid(&positions, &traced.outline, spacing);
    let reasons = std::mem::take(&mut traced.doubts).into_iter();
    let edge = EdgePosition::of(request, &field.understood, traced, beside_grid)?;
    let (mesh, size) = mesh_inside(request, &edge.outline, spacing, field.series.frames.len())?;
    let origin = format!(
        "made inside the outline of the markers, which are about {} mm apart{}",
        decimals(spacing, 4),
        edge.origin
    );
    warnings.extend(edge.warning);
    let doubt = |reason: String| {
        let message = format!("the outline of the markers is uncertain: {reason}");
        Diagnostic::warning("", message).hint(GIVE_EDGE)
    };
    Ok(SpecimenMesh {
        mesh,
        cell_size: Some(size),
        origin,
        warnings,
        doubts: reasons.map(doubt).collect(),
        unknown_gap: edge.unknown_gap,
    })
}

/// The positions of all markers, from which the outline is traced, without the lost markers that lie in holes among the others, if gaps are
/// holes; and the number of these. Where so many are lost that the others are scattered, gaps are not taken for holes.
fn positions(series: &MarkerSeries, gaps_are_holes: bool) -> (Vec<[f64; 2]>, usize) {
    let tracked = series.tracked_positions();
    let mut lost = series.lost.clone();
    if gaps_are_holes && !lost.is_empty() {
        let outline = Outline::of_points(&tracked).ok();
        if let Some(traced) = outline.filter(|traced| !traced.is_scattered) {
            lost.retain(|position| !traced.outline.has_in_a_hole(*position));
        }
    }
    let in_gaps = series.lost.len() - lost.len();
    (tracked.into_iter().chain(lost).collect(), in_gaps)
}

/// The area of a triangle with edges of length 1: √3/4.
const UNIT_TRIANGLE: f64 = 0.433_012_701_892_219_3;

/// The size of the cells in mm with which nodes are as far apart as the markers, but at least 16 cells go across the specimen, however it lies,
/// and at most about 5,000 are made, or 20,000 where fewer would not go across.
fn usual_size(outline: &Outline, spacing: f64, shape: CellShape) -> f64 {
    let smallest = |cells: f64| (outline.area() / (cells * UNIT_TRIANGLE)).sqrt();
    (shape.degree() as f64 * spacing)
        .max(smallest(ENOUGH_CELLS))
        .min(least_width(&outline.outer) / LEAST_ACROSS)
        .max(smallest(MOST_CELLS))
}

/// A mesh inside an outline, and the size of its cells in mm: that of the request, or else the usual one.
fn mesh_inside(
    request: &Request,
    outline: &Outline,
    spacing: f64,
    frames: usize,
) -> Result<(Mesh, f64), Error> {
    let across = least_width(&outline.outer);
    let size = request
        .cell_size
        .unwrap_or_else(|| usual_size(outline, spacing, request.shape));
    if size > across / 2.0 {
        let message = format!(
            "cells of {size} mm are too large for a specimen {} mm wide",
            decimals(across, 4)
        );
        return Err(Error::input(message, "choose a smaller --cell-size"));
    }
    let triangles = outline.area() / (size * size * UNIT_TRIANGLE);
    let (cells, nodes) = match request.shape {
        CellShape::Triangle3 => (triangles, 0.5 * triangles),
        CellShape::Quad4 => (3.0 * triangles, 3.0 * triangles),
        CellShape::Quad8 => (3.0 * triangles, 9.0 * triangles),
        CellShape::Quad9 => (3.0 * triangles, 12.0 * triangles),
        CellShape::Triangle6 => (triangles, 2.0 * triangles),
    };
    let remedy = "choose a larger --cell-size";
    affords(
        request,
        need(cells, nodes, frames),
        &format!("a mesh of cells of {size} mm"),
        remedy,
    )?;
    Ok((outline.mesh(size, request.shape), size))
}

/// The need of so many frames on a mesh.
fn need(cells: f64, nodes: f64, frames: usize) -> Need {
    let (unknowns, instants) = (2.0 * nodes, frames as f64);
    Need {
        cells,
        instants,
        unknowns,
        bytes: unknowns * (BYTES_OF_AN_UNKNOWN + 200.0 * instants),
        ..Need::default()
    }
}

/// The need of so many frames of so many markers, with their files, as measured with 60,000 and a million markers.
fn need_of_markers(markers: f64, frames: usize) -> Need {
    let instants = frames as f64;
    Need {
        instants,
        bytes: markers * (6500.0 + 200.0 * instants),
        ..Need::default()
    }
}

fn affords(request: &Request, need: Need, what: &str, smaller: &str) -> Result<(), Error> {
    let excess = |excess: Excess| Error::input(format!("{what} {excess}"), excess.remedy(smaller));
    request.budget.afford(need).map_err(excess)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_as_large_however_a_specimen_lies() {
        for degrees in [0.0, 30.0, 45.0, 90.0_f64] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let corners = [[0.0, 0.0], [50.0, 0.0], [50.0, 20.0], [0.0, 20.0]];
            let turned = corners.map(|[x, y]| [cosine * x - sine * y, sine * x + cosine * y]);
            let outline = Outline::of_lines(vec![turned.to_vec()]).unwrap();
            let size = usual_size(&outline, 1.43, CellShape::Triangle6);
            assert!((size - 20.0 / 16.0).abs() < 1e-12, "{degrees}: {size}");
        }
    }
}
