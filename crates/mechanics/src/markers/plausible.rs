//! Whether lengths are consistent: positions with displacements, markers with a mesh.

use super::frames::{Frame, Marker, MarkerSeries};
use crate::error::{Diagnostic, Error};
use crate::mesh::Mesh;
use crate::mesh::geometry::{check_size, sides};
use crate::units::{decimals, extents, implausible_sheet};

/// Displacements of more than this multiple of the specimen's size are taken to be in another unit.
const LARGEST: f64 = 20.0;

/// A largest displacement below this share of the specimen's size is reported.
const SMALLEST: f64 = 1e-5;

/// Markers outside of the mesh up to this multiple of a cell's size belong to its boundary.
const NEAR_CELLS: f64 = 0.25;

/// Markers farther outside of the box around the mesh than this share of its size are not located in the mesh.
const MARGIN: f64 = 0.5;

/// Ratios of the units of length that are in use.
const RATIOS: [f64; 6] = [10.0, 25.4, 100.0, 254.0, 1e3, 1e6];

/// Checks that a sheet is thin, and not too thin: otherwise one of the lengths is in another unit.
pub fn check_thickness(mesh: &Mesh, thickness: f64) -> Option<Diagnostic> {
    let message = implausible_sheet(mesh.size(), thickness)?;
    let hint = "check the units of the thickness and of the field; --unit corrects that of the field (such as --unit mm)";
    Some(Diagnostic::warning("", message).hint(hint))
}

/// Checks that the data have displacements that are consistent with the positions.
pub fn check(series: &MarkerSeries, warnings: &mut Vec<Diagnostic>) -> Result<(), Error> {
    if series.frames.is_empty() {
        return Err(Error::input(
            "no point of the field has a displacement that is a number",
            "check the columns or the array that contain it",
        ));
    }
    let markers = series.frames.iter().flat_map(|frame| &frame.markers);
    let positions = markers.map(|marker| marker.position);
    let extent = sides(positions.clone());
    let size = extent[0].max(extent[1]);
    let frames = series.frames.iter().map(Frame::largest_displacement);
    let largest = frames.fold(0.0, f64::max);
    if largest == 0.0 {
        return Err(Error::input(
            "the displacement is zero everywhere",
            "give a field of a specimen that is deformed",
        ));
    }
    if let Err(measures) = check_size(positions)
        && size > 0.0
    {
        let hint =
            "write the unit of every column in its header, as in x [mm], or correct it with --unit";
        return Err(Error::input(format!("the points {measures}"), hint));
    }
    // One point alone has no size.
    if size > 0.0 && largest > LARGEST * size {
        return Err(Error::input(
            format!(
                "the displacement reaches {} mm, but the points span {} mm: they are in different units",
                decimals(largest, 4),
                decimals(size, 4)
            ),
            "write the unit of every column in its header, as in x [mm], ux [um]",
        ));
    }
    if largest < SMALLEST * size {
        let message = format!(
            "the displacement reaches only {largest:.3e} mm, but the points span {} mm",
            decimals(size, 4)
        );
        let hint = "check that positions and displacements are in the same unit";
        warnings.push(Diagnostic::warning("", message).hint(hint));
    }
    Ok(())
}

/// Markers on a mesh, without the markers outside.
#[derive(Debug)]
pub struct MarkersOnMesh {
    /// The markers on the mesh.
    pub series: MarkerSeries,
    /// The number of markers left out, over all frames.
    pub outside: usize,
}

/// Leaves out the markers that lie outside of a mesh by more than a quarter of a cell.
///
/// # Errors
/// [`Error::Input`] when most do, with the likely reason: another unit, or another origin.
pub fn place_on(mesh: &Mesh, series: &MarkerSeries) -> Result<MarkersOnMesh, Error> {
    let [low, high] = mesh.bounding_box();
    let near = |position: [f64; 2]| {
        let margin = [0, 1].map(|axis| MARGIN * (high[axis] - low[axis]));
        (0..2).all(|axis| {
            (low[axis] - margin[axis]..=high[axis] + margin[axis]).contains(&position[axis])
        })
    };
    let within =
        |marker: &&Marker| near(marker.position) && mesh.outside(marker.position) <= NEAR_CELLS;
    let frame = |frame: &Frame| Frame {
        markers: frame.markers.iter().filter(within).copied().collect(),
        ..frame.clone()
    };
    let kept = MarkerSeries {
        frames: series.frames.iter().map(frame).collect(),
        lost: series.lost.clone(),
        at_rest: series.at_rest.clone(),
    };
    let count = |series: &MarkerSeries| -> usize {
        let frames = series.frames.iter();
        frames.map(|frame| frame.markers.len()).sum()
    };
    let (all, inside) = (count(series), count(&kept));
    let positions = || series.frames.iter().flat_map(|frame| &frame.markers);
    let spanned = sides(positions().map(|marker| marker.position));
    let measures = mesh.size();
    let ratio = measures[0].hypot(measures[1]) / spanned[0].hypot(spanned[1]);
    let unit = unit_ratio(ratio);
    if 2 * inside >= all && (ratio < 8.0 || unit.is_none()) {
        return Ok(MarkersOnMesh {
            series: kept,
            outside: all - inside,
        });
    }
    let sizes = format!(
        "the mesh measures {} and the points span {}",
        extents(measures),
        extents(spanned)
    );
    Err(match unit {
        Some(unit) => Error::input(
            format!("{sizes}: about a factor of {unit}, as between two units of length"),
            "state the unit of the field with --unit, and that of the mesh with --mesh-unit",
        ),
        None => Error::input(
            format!(
                "{sizes}, but {} of {all} points lie outside the mesh",
                all - inside
            ),
            "give both in the same axes, at rest",
        ),
    })
}

/// The ratio of two units of length to which a ratio of two lengths, or its inverse, is near.
pub fn unit_ratio(ratio: f64) -> Option<f64> {
    let ratio = ratio.max(1.0 / ratio);
    let near = |unit: &f64| (0.8..1.3).contains(&(ratio / unit));
    RATIOS.iter().copied().find(near)
}
