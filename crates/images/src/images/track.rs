//! The pattern of a first image followed through later ones.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::defects::{dead, repaired, saturated, warnings};
use super::gradient::Reference;
use super::grey::GreyImage;
use super::grid::{Follower, Grid};
use super::noise::{Classes, Noise};
use super::region::Region;
use super::seed::Pyramid;
use super::speckle::{PatchLayout, half_width};
use super::spline::Spline;
use super::subset::{Match, Subset};
use super::tracked::{Tracked, add_curvature};
use super::warp::Order;
use crate::error::{Diagnostic, Error};

/// How a pattern is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Distance of the points in pixels.
    pub spacing: usize,
    /// Width of the subsets in pixels; by the pattern where it is not given.
    pub subset: Option<usize>,
    /// The degree of the displacement in a subset.
    pub order: Order,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            spacing: 8,
            subset: None,
            order: Order::Affine,
        }
    }
}

/// Standard deviation in pixels of a displacement from which on a subset has no pattern that could be followed.
const KNOWN: f64 = 1.0;

/// The pattern of a first image.
#[derive(Clone, Debug)]
pub struct Tracker {
    pub(super) reference: Reference,
    pub(super) grid: Grid,
    pub(super) centres: Vec<Option<[usize; 2]>>,
    pub(super) half: usize,
    pub(super) order: Order,
    pub(super) white: f32,
    pub(super) dead: Vec<usize>,
    pub(super) spacing: usize,
    /// The image before, and where each point was last found.
    pub(super) before: Option<(GreyImage, Vec<Option<Match>>)>,
    /// Whether each point was found in the image before, rather than in an earlier one.
    pub(super) was_found: Vec<bool>,
    pub(super) warnings: Vec<Diagnostic>,
    pub(super) patch_layout: OnceLock<PatchLayout>,
}

/// One of so many points is searched first, from its field in the image before.
const SAMPLED: usize = 17;

/// The largest number of seeds, one for each separate part of a specimen.
const MOST_SEEDS: usize = 12;

impl Tracker {
    /// From the first image, another one of the series to tell dead pixels from the pattern, and the specimen's region.
    ///
    /// # Errors
    /// [`Error::Input`] where the sizes differ, or where the region has no pattern.
    pub fn new(
        first: &GreyImage,
        other: &GreyImage,
        region: &Region,
        settings: Settings,
    ) -> Result<Self, Error> {
        check_size(first, other)?;
        let usable_at_all = region.inner();
        let noise = Noise::of_image(first, &usable_at_all);
        let dead = dead(first, other, &noise);
        let image = repaired(first, &dead);
        let saturated = saturated(&image);
        let mut usable = usable_at_all;
        let pixels = usable.iter().filter(|flag| **flag).count();
        let within = |list: &[usize]| list.iter().filter(|index| region.flags()[**index]).count();
        let warnings = warnings(within(&dead), within(&saturated), pixels);
        dead.iter()
            .chain(&saturated)
            .for_each(|index| usable[*index] = false);
        let grid = Grid::new(first.size(), settings.spacing.max(1), |x, y| {
            region.has(x, y)
        });
        let reference = Reference::new(image, usable, noise);
        let half = match settings.subset {
            Some(width) => width / 2,
            None => half_width(&reference, &grid, settings.order),
        };
        let has_pattern = |point: &[usize; 2]| {
            let subset = Subset::new(&reference, *point, half, settings.order);
            subset.is_some_and(|subset| subset.expected_deviation() < KNOWN)
        };
        let centres: Vec<Option<[usize; 2]>> = grid
            .points
            .par_iter()
            .map(|point| has_pattern(point).then_some(*point))
            .collect();
        if centres.iter().flatten().count() < 3 {
            let message = "the specimen shows no pattern that could be followed";
            let hint = "take sharper images of a speckled specimen, or check the mask or outline";
            return Err(Error::input(message, hint));
        }
        Ok(Self {
            white: first.white(),
            reference,
            grid,
            centres,
            half,
            order: settings.order,
            dead,
            spacing: settings.spacing.max(1),
            before: None,
            was_found: Vec::new(),
            warnings,
            patch_layout: OnceLock::new(),
        })
    }

    /// Warnings about the first image.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// Width of the subsets in pixels.
    pub fn subset(&self) -> usize {
        2 * self.half + 1
    }

    /// The largest grey value of the camera.
    pub fn white(&self) -> f32 {
        self.white
    }

    /// The noise of the pixels; once an image has been followed, that of its residuals.
    pub fn noise(&self) -> &Noise {
        &self.reference.noise
    }

    /// The positions of all points in pixels.
    pub fn positions(&self) -> &[[usize; 2]] {
        &self.grid.points
    }

    /// The first image and its gradients.
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    /// A later image without its dead pixels.
    pub(super) fn repaired(&self, image: &GreyImage) -> GreyImage {
        repaired(image, &self.dead)
    }

    pub(super) fn follower(&self) -> Follower<'_> {
        Follower {
            reference: &self.reference,
            centres: &self.centres,
            neighbours: &self.grid.neighbours,
            half: self.half,
            order: self.order,
        }
    }

    /// Follows all points into the next image; a point that is not found there is `None`.
    ///
    /// # Errors
    /// [`Error::Input`] where its size is another one, or where no point is found.
    pub fn follow(&mut self, image: &GreyImage) -> Result<Vec<Option<Tracked>>, Error> {
        check_size(&self.reference.image, image)?;
        let image = self.repaired(image);
        let spline = Spline::new(&image);
        let mut matches = self.direct(&image, &spline);
        if self.before.is_none() {
            self.learn_noise(&spline, &mut matches);
        }
        self.follower().drop_outliers(&mut matches);
        self.follow_from_image_before(&image, &spline, &mut matches);
        if matches.iter().all(Option::is_none) {
            let message = "no point of the first image is found again";
            let hint = "give the images between them, or check that the series shows one specimen; the pattern must stay the same";
            return Err(Error::input(message, hint));
        }
        let mut tracked: Vec<Option<Tracked>> = matches
            .iter()
            .zip(&self.grid.points)
            .map(|(found, point)| Some(found.as_ref()?.tracked(*point)))
            .collect();
        if self.order == Order::Affine {
            add_curvature(&self.grid, self.spacing, self.half, &mut tracked);
        }
        self.was_found = matches.iter().map(Option::is_some).collect();
        if let Some((_, before)) = self.before.take() {
            for (found, last_found) in matches.iter_mut().zip(before) {
                *found = found.or(last_found);
            }
        }
        self.before = Some((image, matches));
        Ok(tracked)
    }

    /// Matches with the first image itself.
    fn direct(&self, image: &GreyImage, spline: &Spline) -> Vec<Option<Match>> {
        let follower = self.follower();
        let mut matches: Vec<Option<Match>> = vec![None; self.centres.len()];
        let mut attempts = vec![0; matches.len()];
        if let Some((_, before)) = &self.before {
            // Where the step is large, the fields of the image before are far from those of this one, and most searches from them fail. So a few
            // points are searched first, and lead to their neighbours; points that these do not lead to start from their own field.
            let known: Vec<usize> = (0..before.len())
                .filter(|point| before[*point].is_some())
                .collect();
            for every in [SAMPLED, 1] {
                let sampled = known.iter().copied().step_by(every);
                let open = sampled.filter(|point| matches[*point].is_none());
                let guesses = open.filter_map(|point| Some((point, before[point].as_ref()?.warp)));
                for (point, one) in follower.find_all(spline, guesses.collect()) {
                    matches[point] = one;
                }
                follower.spread(spline, &mut matches, &mut attempts);
            }
        }
        if self.before.is_none() || matches.iter().all(Option::is_none) {
            self.seed(&follower, image, spline, &mut matches, &mut attempts);
        }
        matches
    }

    /// Looks for seeds until each part of the specimen has one, or none is found.
    pub(super) fn seed(
        &self,
        follower: &Follower,
        image: &GreyImage,
        spline: &Spline,
        matches: &mut [Option<Match>],
        attempts: &mut [usize],
    ) {
        let pyramid = Pyramid::new(follower, image, spline);
        // A point of a part of the specimen that no match has spread to.
        let is_open = |point: usize, matches: &[Option<Match>], attempts: &[usize]| {
            follower.centres[point].is_some() && matches[point].is_none() && attempts[point] == 0
        };
        for round in 0..MOST_SEEDS {
            let open: Vec<usize> = (0..matches.len())
                .filter(|point| is_open(*point, matches, attempts))
                .collect();
            let candidates = spread_out(&open);
            let centre = |point: &usize| Some((*point, follower.centres[*point]?));
            let mut seeds = candidates.iter().filter_map(centre);
            let seed = seeds.find_map(|(point, centre)| Some((point, pyramid.seek(centre)?)));
            let deformed = || {
                let mut seeds = candidates.iter().take(4).filter_map(centre);
                seeds.find_map(|(point, centre)| Some((point, pyramid.seek_deformed(centre)?)))
            };
            let seed = if round == 0 {
                seed.or_else(deformed)
            } else {
                seed
            };
            let Some((point, one)) = seed else {
                return;
            };
            matches[point] = Some(one);
            attempts[point] += 1;
            follower.spread(spline, matches, attempts);
        }
    }

    /// Estimates the noise from the residuals of the first matches, and repeats the matches with it.
    fn learn_noise(&mut self, spline: &Spline, matches: &mut [Option<Match>]) {
        let mut misfits: Vec<f64> = matches.iter().flatten().map(|one| one.misfit).collect();
        if misfits.is_empty() {
            return;
        }
        misfits.sort_by(f64::total_cmp);
        let usual = 2.0 * misfits[misfits.len() / 2];
        let empty = Classes::new(self.white);
        let points: Vec<usize> = (0..matches.len())
            .filter(|point| matches[*point].is_some_and(|one| one.misfit <= usual))
            .collect();
        let parts = points.par_chunks(256).map(|points| {
            let mut classes = empty.clone();
            for point in points {
                let centre = self.centres[*point];
                let subset = centre
                    .and_then(|centre| Subset::new(&self.reference, centre, self.half, self.order));
                if let (Some(subset), Some(one)) = (subset, &matches[*point]) {
                    subset.classify(spline, one, &mut classes);
                }
            }
            classes
        });
        let parts: Vec<Classes> = parts.collect();
        let classes = parts.iter().fold(empty, Classes::join);
        if let Some(noise) = classes.noise() {
            self.patch_layout = OnceLock::new();
            let reference = &self.reference;
            self.reference =
                Reference::new(reference.image.clone(), reference.usable.clone(), noise);
            let follower = self.follower();
            let guesses = matches
                .iter()
                .enumerate()
                .filter_map(|(point, one)| Some((point, one.as_ref()?.warp)));
            let again = follower.find_all(spline, guesses.collect());
            again
                .into_iter()
                .for_each(|(point, one)| matches[point] = one);
            let mut attempts = vec![0; matches.len()];
            follower.spread(spline, matches, &mut attempts);
        }
    }
}

fn check_size(first: &GreyImage, other: &GreyImage) -> Result<(), Error> {
    let ([a, b], [c, d]) = (first.size(), other.size());
    if [a, b] == [c, d] {
        return Ok(());
    }
    let message = format!("an image has {c} × {d} pixels, and the first one has {a} × {b}");
    Err(Error::input(
        message,
        "give images of one camera with one setting",
    ))
}

/// Some of the points, from the middle of their list outwards.
fn spread_out(points: &[usize]) -> Vec<usize> {
    let parts = [8, 4, 12, 6, 10, 2, 14, 7, 9].map(|sixteenth| points.len() * sixteenth / 16);
    let chosen = parts.into_iter().filter_map(|at| points.get(at).copied());
    let mut seen = BTreeSet::new();
    chosen.filter(|point| seen.insert(*point)).collect()
}
