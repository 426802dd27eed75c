//! Points that are not found from the first image, followed from the image before.

use rayon::prelude::*;

use super::gradient::Reference;
use super::grey::GreyImage;
use super::grid::Follower;
use super::spline::Spline;
use super::subset::Match;
use super::track::Tracker;

/// The pixel at a position in an image.
fn pixel_at([x, y]: [f64; 2], size: [usize; 2]) -> Option<[usize; 2]> {
    let [right, bottom] = size.map(|length| length as f64 - 1.0);
    let inside = x >= 0.0 && y >= 0.0 && x < right && y < bottom;
    inside.then(|| [x.round() as usize, y.round() as usize])
}

impl Tracker {
    /// Finds the points that were not found from the first image, by following them from the image before. Where the first image's pattern
    /// is then found after all, the match is with the first image; otherwise the covariances of both steps add up. The step of a point that was
    /// last found in an earlier image is not known as a whole: it must be found from the first image.
    pub(super) fn follow_from_image_before(
        &self,
        image: &GreyImage,
        spline: &Spline,
        found: &mut [Option<Match>],
    ) {
        let Some((last, before)) = &self.before else {
            return;
        };
        let size = last.size();
        let centre = |point: usize| {
            let position = before[point].as_ref()?.position(self.grid.points[point]);
            pixel_at(position, size)
        };
        let lost: Vec<usize> = (0..found.len())
            .filter(|point| found[*point].is_none() && before[*point].is_some())
            .collect();
        if lost.is_empty() {
            return;
        }
        let centres: Vec<Option<[usize; 2]>> = (0..found.len()).map(centre).collect();
        let usable = vec![true; size[0] * size[1]];
        let reference = Reference::new(last.clone(), usable, self.reference.noise);
        let follower = Follower {
            reference: &reference,
            centres: &centres,
            ..self.follower()
        };
        // The steps of the points that were found lead to those of their lost neighbours.
        let known_step = |point: usize| {
            centres[point].filter(|_| self.was_found[point])?;
            found[point]?.since(before[point].as_ref()?)
        };
        let mut steps: Vec<Option<Match>> = (0..found.len()).map(known_step).collect();
        let mut attempts = vec![0; steps.len()];
        if steps.iter().all(Option::is_none) {
            self.seed(&follower, image, spline, &mut steps, &mut attempts);
        } else {
            follower.spread(spline, &mut steps, &mut attempts);
        }
        let direct = self.follower();
        let solved = lost.par_iter().filter_map(|&point| {
            let (point_at_rest, centre) = (self.grid.points[point], centres[point]?);
            let indirect =
                before[point]
                    .as_ref()?
                    .followed_by(&steps[point]?, point_at_rest, centre);
            let again = direct.find(point, spline, indirect.warp);
            let indirect = self.was_found[point].then_some(indirect);
            Some((point, again.or(indirect)?))
        });
        let solved: Vec<(usize, Match)> = solved.collect();
        for (point, solution) in solved {
            found[point] = Some(solution);
        }
    }
}
