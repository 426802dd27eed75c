//! Points that are lost in the first image, followed from the image before.

use rayon::prelude::*;

use super::gradient::Reference;
use super::grey::GreyImage;
use super::grid::Follower;
use super::spline::Spline;
use super::state::State;
use super::subset::Match;
use super::track::Tracker;

/// The pixel at a place in an image.
fn pixel_at([x, y]: [f64; 2], size: [usize; 2]) -> Option<[usize; 2]> {
    let [right, bottom] = size.map(|length| length as f64 - 1.0);
    let inside = x >= 0.0 && y >= 0.0 && x < right && y < bottom;
    inside.then(|| [x.round() as usize, y.round() as usize])
}

impl Tracker {
    /// Points that the first image does not lead to, over the image before; where the first image's pattern is found from there, it remains
    /// the reference, and else the covariances of both steps add up.
    pub(super) fn over_image_before(
        &self,
        image: &GreyImage,
        spline: &Spline,
        states: &mut [Option<State>],
    ) {
        let Some((last, before)) = &self.before else {
            return;
        };
        let size = last.size();
        let centre = |point: usize| {
            let position = before[point].as_ref()?.position(self.grid.points[point]);
            pixel_at(position, size)
        };
        let lost: Vec<usize> = (0..states.len())
            .filter(|point| states[*point].is_none() && before[*point].is_some())
            .collect();
        if lost.is_empty() {
            return;
        }
        let centres: Vec<Option<[usize; 2]>> = (0..states.len()).map(centre).collect();
        let usable = vec![true; size[0] * size[1]];
        let reference = Reference::new(last.clone(), usable, &self.noise);
        let follower = Follower {
            reference: &reference,
            centres: &centres,
            ..self.follower()
        };
        let mut matches: Vec<Option<Match>> = vec![None; states.len()];
        // What is known of the step of the others leads to the lost ones.
        for point in 0..states.len() {
            if let (Some(now), Some(then), Some(_)) =
                (&states[point], &before[point], centres[point])
            {
                matches[point] = now.since(then);
            }
        }
        let mut attempts = vec![0; matches.len()];
        if matches.iter().all(Option::is_none) {
            self.seed(&follower, (image, spline), &mut matches, &mut attempts);
        } else {
            follower.spread(spline, &mut matches, &mut attempts);
        }
        let direct = self.follower();
        let solved = lost.par_iter().filter_map(|&point| {
            let step = matches[point]?;
            let state = before[point].as_ref()?.followed_by(
                &step,
                self.grid.points[point],
                centres[point]?,
            );
            let again = direct.find(point, spline, state.warp);
            Some((point, again.map_or(state, |one| State::of(&one))))
        });
        let solved: Vec<(usize, State)> = solved.collect();
        solved
            .into_iter()
            .for_each(|(point, state)| states[point] = Some(state));
    }
}
