//! Points of a grid that are followed from one image to another, each from the best of its neighbours.

use rayon::prelude::*;

use super::gradient::Reference;
use super::spline::Spline;
use super::subset::{Match, Subset};
use super::warp::{Order, Warp};

/// The least similarity of a match.
pub const LEAST_SIMILARITY: f64 = 0.5;

/// How often a point is searched from the fields of its neighbours.
const MOST_ATTEMPTS: usize = 4;

/// Points of a regular grid.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Their positions in the first image in pixels.
    pub points: Vec<[usize; 2]>,
    /// The neighbours of each, at most eight, by their numbers.
    pub neighbours: Vec<Vec<usize>>,
}

impl Grid {
    /// A grid of a spacing in the middle of an image; only its points for which `has` is true.
    pub fn new(size: [usize; 2], spacing: usize, has: impl Fn(usize, usize) -> bool) -> Self {
        let counts = size.map(|length| length.div_ceil(spacing));
        let starts = [0, 1].map(|axis| (size[axis] - 1 - (counts[axis] - 1) * spacing) / 2);
        let mut numbers = vec![None; counts[0] * counts[1]];
        let mut points = Vec::new();
        for (cell, number) in numbers.iter_mut().enumerate() {
            let [x, y] = [
                starts[0] + spacing * (cell % counts[0]),
                starts[1] + spacing * (cell / counts[0]),
            ];
            if has(x, y) {
                *number = Some(points.len());
                points.push([x, y]);
            }
        }
        let around = |[x, y]: [usize; 2]| {
            let [column, row] = [(x - starts[0]) / spacing, (y - starts[1]) / spacing];
            let neighbour = |(along, down): (isize, isize)| -> Option<usize> {
                let column = column.checked_add_signed(along)?;
                let row = row.checked_add_signed(down)?;
                if column >= counts[0] || row >= counts[1] {
                    return None;
                }
                numbers[row * counts[0] + column]
            };
            let steps = (-1..=1).flat_map(|down| (-1..=1).map(move |along| (along, down)));
            steps
                .filter(|step| *step != (0, 0))
                .filter_map(neighbour)
                .collect()
        };
        Self {
            neighbours: points.iter().map(|point| around(*point)).collect(),
            points,
        }
    }
}

/// What is followed: subsets of a reference about the points' positions in it.
pub struct Follower<'a> {
    pub reference: &'a Reference,
    /// The pixel of the reference at which each point is.
    pub centres: &'a [Option<[usize; 2]>],
    pub neighbours: &'a [Vec<usize>],
    pub half: usize,
    pub order: Order,
}

impl Follower<'_> {
    /// The match of a point, searched from a guess.
    pub fn find(&self, point: usize, image: &Spline, guess: Warp) -> Option<Match> {
        let subset = Subset::new(self.reference, self.centres[point]?, self.half, self.order)?;
        let fit = subset.find(image, guess)?;
        (fit.similarity >= LEAST_SIMILARITY).then_some(fit)
    }

    /// Finds some points at the same time.
    pub fn find_all(
        &self,
        image: &Spline,
        guesses: Vec<(usize, Warp)>,
    ) -> Vec<(usize, Option<Match>)> {
        let guesses = guesses.into_par_iter();
        guesses
            .map(|(point, guess)| (point, self.find(point, image, guess)))
            .collect()
    }

    /// Follows points from those that are found to all others, round by round.
    pub fn spread(&self, image: &Spline, matches: &mut [Option<Match>], attempts: &mut [usize]) {
        let mut fresh: Vec<usize> = (0..matches.len())
            .filter(|point| matches[*point].is_some())
            .collect();
        while !fresh.is_empty() {
            let mut next: Vec<usize> = fresh
                .iter()
                .flat_map(|point| &self.neighbours[*point])
                .copied()
                .filter(|point| matches[*point].is_none() && attempts[*point] < MOST_ATTEMPTS)
                .collect();
            next.sort_unstable();
            next.dedup();
            next.iter().for_each(|point| attempts[*point] += 1);
            let guesses = next
                .into_iter()
                .filter_map(|point| Some((point, self.guess(point, matches)?)));
            fresh = Vec::new();
            for (point, one) in self.find_all(image, guesses.collect()) {
                if one.is_some() {
                    matches[point] = one;
                    fresh.push(point);
                }
            }
        }
    }

    /// The field of a matched neighbour, about a point.
    fn field_of(&self, neighbour: usize, point: usize, matches: &[Option<Match>]) -> Option<Warp> {
        let ([x, y], [a, b]) = (self.centres[point]?, self.centres[neighbour]?);
        let warp = matches[neighbour].as_ref()?.warp;
        Some(warp.moved(x as f64 - a as f64, y as f64 - b as f64))
    }

    /// The field of the most similar neighbour, about a point.
    fn guess(&self, point: usize, matches: &[Option<Match>]) -> Option<Warp> {
        let similarity = |other: &usize| Some((*other, matches[*other].as_ref()?.similarity));
        let known = self.neighbours[point].iter().filter_map(similarity);
        let (best, _) = known.max_by(|a, b| a.1.total_cmp(&b.1))?;
        self.field_of(best, point, matches)
    }

    /// Drops points whose displacement is far from the one that their neighbours' fields have there: by more than five standard deviations of
    /// these and a tenth of a pixel (as J. Westerweel, F. Scarano, Exp. Fluids 39, 1096 (2005), with gradients). Points with too few matched
    /// neighbours for this test are dropped too, as where the specimen leaves the image.
    pub fn drop_outliers(&self, matches: &mut [Option<Match>]) {
        let far: Vec<usize> = (0..matches.len())
            .filter(|point| self.is_outlier(*point, matches))
            .collect();
        far.iter().for_each(|point| matches[*point] = None);
    }

    /// Whether a match is one of those that [`Self::drop_outliers`] drops.
    fn is_outlier(&self, point: usize, matches: &[Option<Match>]) -> bool {
        const FEWEST: usize = 3;
        const FAR: f64 = 5.0;
        const SURE: f64 = 0.1;
        const NORMAL: f64 = 1.4826;
        let (Some(fit), Some(_)) = (&matches[point], self.centres[point]) else {
            return false;
        };
        let neighbours = self.neighbours[point].iter();
        let displacements: Vec<[f64; 2]> = neighbours
            .filter_map(|other| Some(self.field_of(*other, point, matches)?.displacement()))
            .collect();
        if displacements.len() < FEWEST {
            return self.neighbours[point].len() >= FEWEST;
        }
        (0..2).any(|axis| {
            let values: Vec<f64> = displacements.iter().map(|u| u[axis]).collect();
            let middle = upper_median(values.clone());
            let off = values.iter().map(|value| (value - middle).abs()).collect();
            let deviation = NORMAL * upper_median(off) + fit.covariance[(axis, axis)].sqrt();
            (fit.warp.displacement()[axis] - middle).abs() > FAR * deviation + SURE
        })
    }
}

/// The median of some values; the upper of the two middle ones where their number is even.
fn upper_median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
