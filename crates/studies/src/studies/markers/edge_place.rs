//! Where a specimen's edge lies outside of its outermost markers.

use super::request::Request;
use crate::error::{Diagnostic, Error};
use crate::markers::Understood;
use crate::mesh::{Outline, OutlineFault, OutlineOfPoints};
use crate::units::{decimals, extents};

/// Outermost markers farther than this from their outline, in spacings, leave it open where the edge lies.
const ROUGH: f64 = 0.01;

/// What is known of the edge.
pub(super) enum EdgePlace {
    /// So far outside, as the user says, in mm; beside a grid, edges that are not along it may lie up to a step farther out, and where the
    /// outermost markers do not lie on smooth lines, edges may be off by as much as these.
    Given {
        gap: f64,
        step: Option<f64>,
        roughness: Option<f64>,
    },
    /// At least half a subset outside, as subsets lie inside of the specimen, and less than a step farther.
    Subset {
        half: f64,
        step: f64,
        /// Both in pixels, and where they are said.
        words: String,
    },
    /// Up to a spacing of the markers outside.
    Unknown(f64),
}

impl EdgePlace {
    /// What the user says, else what files say of subsets; the markers are beside edges that are not along their grid or not.
    pub fn of(
        request: &Request,
        understood: &Understood,
        markers: &OutlineOfPoints,
        beside_grid: bool,
    ) -> Self {
        let spacing = markers.spacing;
        match (request.conditions.edge_gap, &understood.subset) {
            (Some(gap), _) => Self::Given {
                gap,
                step: beside_grid.then_some(spacing),
                roughness: Some(markers.roughness).filter(|off| *off > ROUGH * spacing),
            },
            (None, Some(subset)) => {
                let pixel = understood.pixel.unwrap_or(spacing / subset.step);
                Self::Subset {
                    half: 0.5 * subset.size * pixel,
                    step: subset.step * pixel,
                    words: format!(
                        "subset {} and step {} pixels according to {}",
                        subset.size, subset.step, subset.told_by
                    ),
                }
            }
            (None, None) => Self::Unknown(spacing),
        }
    }

    /// Checks a gap that the user gives against the extents of the markers' outline in mm.
    ///
    /// # Errors
    /// [`Error::Input`] where it is longer.
    pub fn check(&self, [length, width]: [f64; 2]) -> Result<(), Error> {
        match self {
            Self::Given { gap, .. } if *gap > length.max(width) => Err(Error::input(
                format!(
                    "an edge gap of {gap} mm is larger than the field of the markers, which measures {}",
                    extents([length, width])
                ),
                "check the unit of --edge-gap (edge_gap), the distance from the outermost markers to the specimen's edge, or give the true edges with \
                 --outline or --mesh",
            )),
            _ => Ok(()),
        }
    }

    /// The outline of the markers brought to the edge, and what is known of it then: where half a subset does not fit, nothing.
    ///
    /// # Errors
    /// An [`OutlineFault`] of a gap that the user gives.
    pub fn outline(self, markers: Outline, spacing: f64) -> Result<(Outline, Self), OutlineFault> {
        match self {
            Self::Given { gap, .. } => Ok((markers.widened(gap)?, self)),
            Self::Subset { half, .. } => Ok(match markers.widened(half) {
                Ok(wider) => (wider, self),
                Err(_) => (markers, Self::Unknown(spacing)),
            }),
            Self::Unknown(_) => Ok((markers, self)),
        }
    }

    /// How far outside of the outline the edge may lie all the same, in mm.
    pub fn unknown(&self) -> Option<f64> {
        match self {
            Self::Given {
                step, roughness, ..
            } => step.or(*roughness),
            Self::Subset { step, .. } => Some(*step),
            Self::Unknown(spacing) => Some(*spacing),
        }
    }

    /// How a mesh's origin says it.
    pub fn origin(&self) -> String {
        match self {
            Self::Given { gap, .. } if *gap > 0.0 => format!(", widened by {gap} mm"),
            Self::Subset { half, words, .. } => {
                format!(
                    ", widened by {} mm, half a subset ({words})",
                    decimals(*half, 4)
                )
            }
            _ => String::new(),
        }
    }

    /// What the user should know of it.
    pub fn warning(&self) -> Option<Diagnostic> {
        let (message, hint) = match self {
            Self::Given { step: None, .. } => return None,
            Self::Given {
                gap,
                step: Some(step),
                ..
            } => (
                format!(
                    "the edge is assumed to lie {gap} mm outside the outermost markers, but the markers form a grid and the specimen is not a \
                     rectangle along it: beside curved or inclined edges rows end up to {} mm farther inside",
                    decimals(*step, 4)
                ),
                "give the true edges with --outline or --mesh; force intervals between free edges, and stress errors beside them, include an edge up \
                 to that much farther out; where no edge is free, forces are those through the outline"
                    .to_owned(),
            ),
            Self::Subset { half, step, words } => (
                format!(
                    "the specimen's edge is assumed to lie {} mm outside the outermost markers, half a subset: {words}",
                    decimals(*half, 4)
                ),
                format!(
                    "state the edge with --edge-gap LENGTH, --outline or --mesh; subsets end inside the specimen, less than one step from its edge, so force \
                     intervals between free edges, and stress errors beside them, include an edge up to {} mm farther out; without free edges, forces \
                     are those through the outline",
                    decimals(*step, 4)
                ),
            ),
            Self::Unknown(_) => (
                "the specimen's edge is not known: the outline is that of the markers, which usually end inside the edge".to_owned(),
                "state the edge with --edge-gap LENGTH (\"0 mm\" where markers lie on it), --outline or --mesh; forces grow with the width, so force \
                 intervals between free edges, and stress errors beside them, include an edge up to one marker spacing farther out; without free \
                 edges, forces are those through the outline"
                    .to_owned(),
            ),
        };
        Some(Diagnostic::warning("", message).hint(hint))
    }
}

/// Whether markers form a grid along x and y whose outline is not the rectangle of that grid.
pub(super) fn is_beside_grid(places: &[[f64; 2]], outline: &Outline, spacing: f64) -> bool {
    /// A grid has as many places as lines along x times lines along y, where its rectangle is full; scattered markers have nearly their square.
    const SPARSE: usize = 8;
    /// The share of the rectangle that is filled at least.
    const FULL: f64 = 0.97;
    let lines = |axis: usize| {
        let mut places: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        places.sort_unstable_by(f64::total_cmp);
        1 + places
            .windows(2)
            .filter(|pair| pair[1] - pair[0] > 0.05 * spacing)
            .count()
    };
    let [along_x, along_y] = outline.extents();
    lines(0) * lines(1) <= SPARSE * places.len() && outline.outer_area() < FULL * along_x * along_y
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
            moved.filter(|place| inside(*place)).collect()
        };
        let waisted = |[x, y]: [f64; 2]| (y - 8.0).abs() < 5.0 + 0.008 * (x - 20.0).powi(2);
        for (places, expected) in [
            (grid(&|_| true, 0.0), false),
            (grid(&waisted, 0.0), true),
            (grid(&waisted, 0.3), false),
        ] {
            let found = Outline::of_points(&places).unwrap();
            assert_eq!(
                is_beside_grid(&places, &found.outline, found.spacing),
                expected
            );
        }
    }
}
