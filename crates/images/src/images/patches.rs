//! Patches that share no pixel: measurements whose errors are independent.
//!
//! Subsets overlap, so that their errors are correlated. About a field that is known already, each patch gives one more measurement of the
//! displacement by the pixels of its own: the Gauss–Newton step of the images' misfit about this field, with its covariance. Least squares over
//! patches are then those over pixels,
//!
//! ```text
//! Σ (I₀ − a − b I₁(X + u))² ≈ const + Σ_patches (u − û)ᵀ A (u − û),   û: the displacement that a patch measures
//! ```

use rayon::prelude::*;

use super::grey::GreyImage;
use super::speckle::{patch_steps, speckle};
use super::spline::Spline;
use super::state::Tracked;
use super::subset::Subset;
use super::track::Tracker;
use super::warp::Warp;

/// Standard deviation of a displacement in speckles below which a patch is searched for; beyond it noise leads a search astray, and the step that is
/// linear about the field counts.
const PRECISE: f64 = 1.0 / 32.0;

/// The patches of a first image.
#[derive(Clone, Debug)]
pub struct Patches<'a> {
    tracker: &'a Tracker,
    width: usize,
    speckle: f64,
    /// The points of the grid at which there is a patch.
    points: Vec<usize>,
}

impl Tracker {
    /// Patches that are wide enough for the noise of the images.
    pub fn patches(&self) -> Patches<'_> {
        let speckle = speckle(&self.reference, &self.noise);
        let steps = patch_steps(
            &self.reference,
            &self.grid,
            self.spacing,
            &self.noise,
            speckle,
        );
        let points = &self.grid.points;
        let first = [0, 1].map(|axis| points.iter().map(|point| point[axis]).min().unwrap_or(0));
        let width = steps * self.spacing;
        let is_on_lattice = |point: &[usize; 2]| {
            (0..2).all(|axis| (point[axis] - first[axis]).is_multiple_of(width))
        };
        let points = (0..points.len()).filter(|number| is_on_lattice(&points[*number]));
        Patches {
            tracker: self,
            width,
            speckle,
            points: points.collect(),
        }
    }
}

impl Patches<'_> {
    /// Width of a patch in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Whether the noise moves most patches by so little that each leads to its displacement by itself.
    pub fn are_precise(&self) -> bool {
        let Tracker {
            reference, noise, ..
        } = self.tracker;
        let is_precise = |number: &usize| {
            let point = self.tracker.grid.points[*number];
            let patch = Subset::patch(reference, point, self.width, noise);
            patch.is_some_and(|patch| self.is_precise(&patch))
        };
        let precise = self.points.par_iter().copied().filter(is_precise).count();
        2 * precise > self.points.len()
    }

    fn is_precise(&self, patch: &Subset) -> bool {
        patch.expected_deviation() < PRECISE * self.speckle
    }

    /// A later image as it is measured in.
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
        let measured = self.points.par_iter().map(|&number| {
            let guess = about(number)?;
            self.measure_one(spline, self.tracker.grid.points[number], guess)
        });
        let measured: Vec<Option<Tracked>> = measured.collect();
        let mut all = vec![None; self.tracker.grid.points.len()];
        for (number, one) in self.points.iter().zip(measured) {
            all[*number] = one;
        }
        all
    }

    fn measure_one(&self, spline: &Spline, point: [usize; 2], guess: Warp) -> Option<Tracked> {
        let Tracker {
            reference, noise, ..
        } = self.tracker;
        let patch = Subset::patch(reference, point, self.width, noise)?;
        let middle = patch.middle();
        let fit = if self.is_precise(&patch) {
            patch.find(spline, guess, noise)?
        } else {
            patch.find_linear(spline, guess, noise)?
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
