//! Patches that share no pixel: measurements whose errors are independent.
//!
//! Subsets overlap, so that their errors are correlated. Once a field is known, each patch measures the displacement anew by pixels that no
//! other patch has: by the Gauss–Newton step of the images' misfit about this field, with its covariance. Least squares over patches are then
//! those over pixels,
//!
//! ```text
//! Σ (I₀ − a − b I₁(X + u))² ≈ const + Σ_patches (u − û)ᵀ A (u − û),   û: the displacement that a patch measures
//! ```

use rayon::prelude::*;

use super::grey::GreyImage;
use super::speckle::PatchLayout;
use super::spline::Spline;
use super::subset::Subset;
use super::track::Tracker;
use super::tracked::Tracked;
use super::warp::Warp;

/// Standard deviation of a displacement in speckles below which a patch is searched for; above it noise leads a search astray, and a single
/// step, linear about the field, is taken.
const PRECISE: f64 = 1.0 / 32.0;

/// The patches of a first image.
#[derive(Clone, Copy, Debug)]
pub struct Patches<'a> {
    tracker: &'a Tracker,
    layout: &'a PatchLayout,
}

impl Tracker {
    /// Patches that are wide enough for the noise of the images.
    pub fn patches(&self) -> Patches<'_> {
        let layout = || PatchLayout::new(&self.reference, &self.grid, self.spacing);
        Patches {
            tracker: self,
            layout: self.patch_layout.get_or_init(layout),
        }
    }
}

impl Patches<'_> {
    /// Width of a patch in pixels.
    pub fn width(&self) -> usize {
        self.layout.width
    }

    /// Whether the noise moves most patches by so little that each leads to its displacement by itself.
    pub fn are_precise(&self) -> bool {
        let is_precise = |number: usize| {
            self.patch(number)
                .is_some_and(|patch| self.is_precise(&patch))
        };
        let points = self.layout.points.par_iter();
        let precise = points.filter(|number| is_precise(**number)).count();
        2 * precise > self.layout.points.len()
    }

    /// The patch about a point of the grid.
    fn patch(&self, number: usize) -> Option<Subset> {
        let point = self.tracker.grid.points[number];
        Subset::patch(&self.tracker.reference, point, self.layout.width)
    }

    fn is_precise(&self, patch: &Subset) -> bool {
        patch.expected_deviation() < PRECISE * self.layout.speckle
    }

    /// A later image in the form in which [`Self::measure`] takes it.
    pub fn spline(&self, image: &GreyImage) -> Spline {
        Spline::new(&self.tracker.repaired(image))
    }

    /// The displacement of each patch in an image, from fields about its point: `about` gives the field about a point of the grid. The measurements
    /// stand at the numbers of the grid's points; a point without one is `None`.
    pub fn measure(
        &self,
        spline: &Spline,
        about: &(dyn Fn(usize) -> Option<Warp> + Sync),
    ) -> Vec<Option<Tracked>> {
        let points = self.layout.points.par_iter();
        let measured: Vec<Option<Tracked>> = points
            .map(|&number| self.measure_one(spline, number, about(number)?))
            .collect();
        let mut all = vec![None; self.tracker.grid.points.len()];
        for (number, one) in self.layout.points.iter().zip(measured) {
            all[*number] = one;
        }
        all
    }

    fn measure_one(&self, spline: &Spline, number: usize, guess: Warp) -> Option<Tracked> {
        let patch = self.patch(number)?;
        let (middle, point) = (patch.middle(), self.tracker.grid.points[number]);
        let fit = if self.is_precise(&patch) {
            patch.find(spline, guess)?
        } else {
            patch.find_linear(spline, guess)?
        };
        let [x, y] = [0, 1].map(|axis| middle[axis] - point[axis] as f64);
        let field = fit.warp.moved(x, y);
        Some(Tracked {
            position: middle,
            displacement: field.displacement(),
            gradient: field.gradient(),
            covariance: fit.covariance,
            similarity: fit.similarity,
        })
    }
}
