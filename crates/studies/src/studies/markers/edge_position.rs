//! The position of a specimen's edge outside of its outermost markers.

use super::request::Request;
use crate::error::{Diagnostic, Error};
use crate::markers::{Subset, Understood};
use crate::mesh::{Outline, OutlineFault, OutlineOfPoints};
use crate::studies::images::IMAGES;
use crate::units::{decimals, extents};

/// Distance of the outermost markers from their outline, in spacings, from which on the edge is not known exactly.
const ROUGH: f64 = 0.01;

/// What to do where markers do not show the edge.
pub(super) const GIVE_EDGE: &str =
    "give the specimen's edge with --outline, or its mesh with --mesh";

pub(super) fn no_mesh(reason: OutlineFault) -> Error {
    Error::input(format!("a mesh cannot be made: {reason}"), GIVE_EDGE)
}

/// The position of the edge outside of the outermost markers.
pub(super) struct EdgePosition {
    /// The outline of the markers brought to the edge.
    pub outline: Outline,
    /// How far outside of this outline the edge may still lie, in mm; `None` where the edge is known.
    pub unknown_gap: Option<f64>,
    /// How far the outline is widened, for the origin of the mesh.
    pub origin: String,
    pub warning: Option<Diagnostic>,
}

impl EdgePosition {
    /// The edge as the user states it, else half a subset outside, as subsets lie inside of the specimen, where files state the subset and
    /// it fits; else the markers' own outline.
    ///
    /// # Errors
    /// [`Error::Input`] where the outline cannot be widened by a stated gap.
    pub fn of(
        request: &Request,
        understood: &Understood,
        markers: OutlineOfPoints,
        beside_grid: bool,
    ) -> Result<Self, Error> {
        if let Some(gap) = request.conditions.edge_gap {
            return Self::stated(gap, markers, beside_grid);
        }
        let spacing = markers.spacing;
        if let Some(subset) = &understood.subset {
            let pixel = understood.pixel.unwrap_or(spacing / subset.step);
            if let Ok(outline) = markers.outline.widened(0.5 * subset.size * pixel) {
                let is_of_images = understood.layout == IMAGES;
                return Ok(Self::of_subset(subset, pixel, outline, is_of_images));
            }
        }
        let message = "the specimen's edge is not known: the outline is that of the markers, which usually end inside the edge";
        let hint = "state the edge with --edge-gap LENGTH (\"0 mm\" where markers lie on it), --outline or --mesh; forces grow with the width, so force \
             intervals between free edges, and stress errors beside them, include an edge up to one marker spacing farther out; without free \
             edges, forces are those through the outline";
        Ok(Self {
            outline: markers.outline,
            unknown_gap: Some(spacing),
            origin: String::new(),
            warning: Some(Diagnostic::warning("", message).hint(hint)),
        })
    }

    /// The edge at a gap that the user states. Where it is not parallel to the grid of the markers, it may lie up to a spacing farther out, and
    /// where the outermost markers do not lie on smooth lines, by as much as these are off.
    fn stated(gap: f64, markers: OutlineOfPoints, beside_grid: bool) -> Result<Self, Error> {
        let [length, width] = markers.outline.extents();
        if gap > length.max(width) {
            return Err(Error::input(
                format!(
                    "an edge gap of {gap} mm is larger than the field of the markers, which measures {}",
                    extents([length, width])
                ),
                "check the unit of --edge-gap (edge_gap), the distance from the outermost markers to the specimen's edge, or give the true edges with \
                 --outline or --mesh",
            ));
        }
        let spacing = markers.spacing;
        let roughness = Some(markers.roughness).filter(|off| *off > ROUGH * spacing);
        let warning = || {
            let message = format!(
                "the edge is assumed to lie {gap} mm outside the outermost markers, but the markers form a grid and the specimen is not a \
                 rectangle along it: beside curved or inclined edges rows end up to {} mm farther inside",
                decimals(spacing, 4)
            );
            let hint = "give the true edges with --outline or --mesh; force intervals between free edges, and stress errors beside them, include an edge up \
                 to that much farther out; where no edge is free, forces are those through the outline";
            Diagnostic::warning("", message).hint(hint)
        };
        let origin = (gap > 0.0).then(|| format!(", widened by {gap} mm"));
        Ok(Self {
            outline: markers.outline.widened(gap).map_err(no_mesh)?,
            unknown_gap: if beside_grid {
                Some(spacing)
            } else {
                roughness
            },
            origin: origin.unwrap_or_default(),
            warning: beside_grid.then(warning),
        })
    }

    /// The edge half a subset outside of the outermost markers, from which it is less than a step away. In images, subsets whose centres are
    /// outside of the specimen may be followed too, with the part of them that shows it.
    fn of_subset(subset: &Subset, pixel: f64, outline: Outline, is_of_images: bool) -> Self {
        let [half, step] = [0.5 * subset.size, subset.step].map(|pixels| pixels * pixel);
        let wider = decimals(half, 4);
        let words = format!(
            "subset {} and step {} pixels according to {}",
            subset.size, subset.step, subset.source
        );
        let message = format!(
            "the specimen's edge is assumed to lie {wider} mm outside the outermost markers, half a subset: {words}"
        );
        let hint = if is_of_images {
            "state where the specimen is with --outline or --mask: points beside it may be followed with it, and its edge and its forces \
             be wrong by as much as half a subset".to_owned()
        } else {
            format!(
                "state the edge with --edge-gap LENGTH, --outline or --mesh; subsets end inside the specimen, less than one step from its edge, so force \
             intervals between free edges, and stress errors beside them, include an edge up to {} mm farther out; without free edges, forces \
             are those through the outline",
                decimals(step, 4)
            )
        };
        Self {
            outline,
            unknown_gap: Some(step),
            origin: format!(", widened by {wider} mm, half a subset ({words})"),
            warning: Some(Diagnostic::warning("", message).hint(hint)),
        }
    }
}

/// Whether markers form a grid along x and y whose outline is not the rectangle of that grid.
pub(super) fn is_beside_grid(positions: &[[f64; 2]], outline: &Outline, spacing: f64) -> bool {
    /// The largest ratio of the number of lines along x times that of lines along y to the number of markers in a grid: 1 where the grid's
    /// rectangle is full, and of scattered markers nearly their number.
    const SPARSE: usize = 8;
    /// The share of its rectangle above which a grid is full.
    const FULL: f64 = 0.97;
    let lines = |axis: usize| {
        let mut positions: Vec<f64> = positions.iter().map(|position| position[axis]).collect();
        positions.sort_unstable_by(f64::total_cmp);
        1 + positions
            .windows(2)
            .filter(|pair| pair[1] - pair[0] > 0.05 * spacing)
            .count()
    };
    let [along_x, along_y] = outline.extents();
    lines(0) * lines(1) <= SPARSE * positions.len()
        && outline.outer_area() < FULL * along_x * along_y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_waisted_grid_is_beside_its_edges_and_a_full_or_a_scattered_one_is_not() {
        let grid = |inside: &dyn Fn([f64; 2]) -> bool, jitter: f64| -> Vec<[f64; 2]> {
            let all = (0..41).flat_map(|i| (0..17).map(move |j| [f64::from(i), f64::from(j)]));
            let moved = all.enumerate().map(|(k, [x, y])| {
                let by = |factor: f64| jitter * ((factor * k as f64).sin());
                [x + by(12.9), y + by(78.2)]
            });
            moved.filter(|position| inside(*position)).collect()
        };
        let waisted = |[x, y]: [f64; 2]| (y - 8.0).abs() < 5.0 + 0.008 * (x - 20.0).powi(2);
        for (positions, expected) in [
            (grid(&|_| true, 0.0), false),
            (grid(&waisted, 0.0), true),
            (grid(&waisted, 0.3), false),
        ] {
            let traced = Outline::of_points(&positions).unwrap();
            assert_eq!(
                is_beside_grid(&positions, &traced.outline, traced.spacing),
                expected
            );
        }
    }
}
