//! Patches that share no pixel: measurements whose errors are independent.
//!
//! Subsets overlap, so that their errors are correlated. About a field that is known already, each patch gives one more measurement of the
//! displacement by the pixels of its own: the Gauss–Newton step of the images' misfit about this field, with its covariance.

use rayon::prelude::*;

use super::grey::GreyImage;
use super::speckle::patch_steps;
use super::spline::Spline;
use super::state::Tracked;
use super::subset::Subset;
use super::track::Tracker;
use super::warp::Warp;

/// The patches of a first image.
#[derive(Clone, Debug)]
pub struct Patches<'a> {
    tracker: &'a Tracker,
    width: usize,
    /// The points of the grid at which there is a patch.
    points: Vec<usize>,
}

impl Tracker {
    /// Patches that are wide enough for the noise of the images.
    pub fn patches(&self) -> Patches<'_> {
        let steps = patch_steps(&self.reference, &self.grid, self.spacing, &self.noise);
        let first = |axis: usize| {
            self.grid
                .points
                .iter()
                .map(|point| point[axis])
                .min()
                .unwrap_or(0)
        };
        let (firsts, width) = ([first(0), first(1)], steps * self.spacing);
        let is_own = |point: &[usize; 2]| {
            (0..2).all(|axis| (point[axis] - firsts[axis]).is_multiple_of(width))
        };
        let points = self
            .grid
            .points
            .iter()
            .enumerate()
            .filter(|(_, point)| is_own(point));
        Patches {
            tracker: self,
            width,
            points: points.map(|(number, _)| number).collect(),
        }
    }
}

impl Patches<'_> {
    /// Width of a patch in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The displacement of each patch in an image, from fields about its point: `about` gives the field about a point of the grid. The measurements
    /// stand at the numbers of the grid's points; a point without one is `None`.
    pub fn measure(
        &self,
        image: &GreyImage,
        about: &(dyn Fn(usize) -> Option<Warp> + Sync),
    ) -> Vec<Option<Tracked>> {
        let Tracker {
            reference,
            grid,
            noise,
            ..
        } = self.tracker;
        let spline = Spline::new(&self.tracker.repaired(image));
        let measured = self.points.par_iter().map(|&number| {
            let point = grid.points[number];
            let patch = Subset::patch(reference, point, self.width, noise)?;
            let middle = patch.middle();
            let guess = about(number)?;
            let found = patch.find(&spline, guess, noise)?;
            let [x, y] = [0, 1].map(|axis| middle[axis] - point[axis] as f64);
            let field = found.warp.moved(x, y);
            Some(Tracked {
                place: middle,
                displacement: field.displacement(),
                gradient: field.gradient(),
                covariance: found.covariance,
                similarity: found.similarity,
            })
        });
        let measured: Vec<Option<Tracked>> = measured.collect();
        let mut all = vec![None; grid.points.len()];
        self.points
            .iter()
            .zip(measured)
            .for_each(|(number, one)| all[*number] = one);
        all
    }
}
