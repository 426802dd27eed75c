//! Markers of one specimen, frame after frame.

use std::collections::HashSet;

use nalgebra::{Matrix2, Vector2};

/// One series of frames of one specimen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerSeries {
    /// The frames, ascending by number.
    pub frames: Vec<Frame>,
    /// Positions at rest in mm of markers that were found in no frame.
    pub lost: Vec<[f64; 2]>,
    /// The numbers of frames in which no marker moves, as in the picture at rest; these frames are left out.
    pub at_rest: Vec<usize>,
}

/// The markers at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Its number in the series.
    pub number: usize,
    /// Its time, where the data state it.
    pub time: Option<f64>,
    /// The markers that were found.
    pub markers: Vec<Marker>,
}

/// A material point with its displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    /// Its number: the same point has the same one in all frames.
    pub number: usize,
    /// Its position at rest in mm.
    pub position: [f64; 2],
    /// ux, uy in mm.
    pub displacement: [f64; 2],
    /// Standard deviation of each component of the displacement in mm, where the data state it.
    pub standard_deviation: Option<f64>,
}

impl Frame {
    /// The sum of the squares of its displacements in mm².
    pub fn motion(&self) -> f64 {
        let markers = self.markers.iter().map(|marker| marker.displacement);
        markers.map(|[x, y]| x * x + y * y).sum()
    }

    /// The length of its largest displacement in mm.
    pub fn largest_displacement(&self) -> f64 {
        let displacements = self.markers.iter().map(|marker| marker.displacement);
        displacements.fold(0.0, |most: f64, [x, y]| most.max(x.hypot(y)))
    }

    /// ∂u/∂X of the linear field that is nearest to the markers; `None` where they lie on a line.
    pub fn mean_gradient(&self) -> Option<Matrix2<f64>> {
        let pairs = || {
            self.markers
                .iter()
                .map(|one| (Vector2::from(one.position), Vector2::from(one.displacement)))
        };
        let count = self.markers.len() as f64;
        let (positions, displacements): (Vec<Vector2<f64>>, Vec<Vector2<f64>>) = pairs().unzip();
        let [position, displacement] =
            [positions, displacements].map(|all| all.into_iter().sum::<Vector2<f64>>() / count);
        let (mut squares, mut products) = (Matrix2::zeros(), Matrix2::zeros());
        for (x, u) in pairs() {
            squares += (x - position) * (x - position).transpose();
            products += (u - displacement) * (x - position).transpose();
        }
        Some(products * squares.try_inverse()?)
    }
}

impl MarkerSeries {
    /// The positions at rest of all markers of all frames, each once, in the order of their first frame; those that were found in none
    /// come last.
    pub fn positions(&self) -> Vec<[f64; 2]> {
        let tracked = self.tracked_positions().into_iter();
        tracked.chain(self.lost.iter().copied()).collect()
    }

    /// The same without the markers that were found in no frame.
    pub fn tracked_positions(&self) -> Vec<[f64; 2]> {
        let mut seen = HashSet::new();
        let markers = self.frames.iter().flat_map(|frame| &frame.markers);
        let tracked = markers.filter(|marker| seen.insert(marker.number));
        tracked.map(|marker| marker.position).collect()
    }
}
