//! The first guess: where one subset went, without any knowledge of the motion.
//!
//! The subset is looked for on the coarsest of a pyramid of images by normalised cross-correlation, first as it is, then turned and stretched;
//! the best positions are refined level by level.

use nalgebra::{Matrix2, Rotation2};
use rayon::prelude::*;

use super::filter::symmetric;
use super::gradient::Reference;
use super::grey::GreyImage;
use super::grid::{Follower, LEAST_SIMILARITY};
use super::noise::Noise;
use super::spline::Spline;
use super::subset::{Match, Subset};
use super::warp::{Order, Warp};

/// Pixels along the longer side of the coarsest image.
const COARSEST: usize = 160;

/// Half the width of subsets on coarse images.
const HALF: usize = 9;

/// The binomial filter before each halving (P. Burt, E. Adelson, IEEE Trans. Commun. 31, 532 (1983)).
const BINOMIAL: [f32; 3] = [6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// An image of half the size: pixel (x, y) of it is pixel (2x, 2y).
fn halved(image: &GreyImage) -> GreyImage {
    let smooth = symmetric(image, &BINOMIAL);
    let [width, height] = image.size().map(|length| length.div_ceil(2));
    GreyImage::of(width, height, |x, y| smooth.value(2 * x, 2 * y))
}

/// The flags of the pixels of [`halved`].
fn halved_flags(flags: &[bool], [width, height]: [usize; 2]) -> Vec<bool> {
    let rows = (0..height).step_by(2);
    rows.flat_map(|y| (0..width).step_by(2).map(move |x| flags[y * width + x]))
        .collect()
}

/// A reference and the image that it is compared with, on one level of the pyramid.
struct Level {
    reference: Reference,
    spline: Spline,
    image: GreyImage,
}

/// A reference and the image in which its subsets are looked for, in full size and in smaller ones.
pub struct Pyramid<'a> {
    follower: &'a Follower<'a>,
    image: &'a GreyImage,
    spline: &'a Spline,
    /// From half the size down.
    coarse: Vec<Level>,
}

impl<'a> Pyramid<'a> {
    pub fn new(follower: &'a Follower<'a>, image: &'a GreyImage, spline: &'a Spline) -> Self {
        let mut coarse: Vec<Level> = Vec::new();
        loop {
            let (reference, other) = match coarse.last() {
                Some(level) => (&level.reference, &level.image),
                None => (follower.reference, image),
            };
            let size = reference.image.size();
            if size[0].max(size[1]) <= COARSEST || size[0].min(size[1]) <= 4 * HALF {
                break;
            }
            let first = halved(&reference.image);
            let usable = halved_flags(&reference.usable, size);
            let noise = Noise::of_image(&first, &usable);
            let other = halved(other);
            coarse.push(Level {
                spline: Spline::new(&other),
                reference: Reference::new(first, usable, noise),
                image: other,
            });
        }
        Self {
            follower,
            image,
            spline,
            coarse,
        }
    }

    /// Finds a subset about a pixel of the reference.
    pub fn seek(&self, centre: [usize; 2]) -> Option<Match> {
        self.refine(centre, Warp::default()).or_else(|| {
            let mut candidates = self.correlate(centre, Matrix2::identity()).into_iter();
            candidates.find_map(|(_, warp)| self.refine(centre, warp))
        })
    }

    /// Finds it turned and stretched.
    pub fn seek_deformed(&self, centre: [usize; 2]) -> Option<Match> {
        const BEST: usize = 12;
        const TURN: f64 = 15.0;
        const STRETCHES: [[f64; 2]; 8] = [
            [1.0, 1.0],
            [1.25, 0.9],
            [0.9, 1.25],
            [1.5, 0.8],
            [0.8, 1.5],
            [2.0, 0.7],
            [0.7, 2.0],
            [1.4, 1.4],
        ];
        let turns = (0..24).map(|k| f64::from(k) * TURN);
        let all: Vec<Matrix2<f64>> = turns
            .flat_map(|angle| {
                let turn = Rotation2::new(angle.to_radians());
                STRETCHES.map(|[x, y]| turn.matrix() * Matrix2::new(x, 0.0, 0.0, y))
            })
            .collect();
        let mut candidates: Vec<(f64, Warp)> = all
            .par_iter()
            .flat_map_iter(|f| self.correlate(centre, *f))
            .collect();
        candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
        let best = candidates.into_iter().take(BEST);
        let refined = best.filter_map(|(_, warp)| self.refine(centre, warp));
        refined.max_by(|a, b| a.similarity.total_cmp(&b.similarity))
    }

    /// From a displacement on the coarsest level up to the full size.
    fn refine(&self, centre: [usize; 2], guess: Warp) -> Option<Match> {
        let mut warp = guess;
        for (index, level) in self.coarse.iter().enumerate().rev() {
            let at = centre.map(|c| c >> (index + 1));
            let subset = Subset::new(&level.reference, at, HALF, Order::Affine);
            let fit = subset.and_then(|subset| subset.find(&level.spline, warp));
            warp = fit.map_or(warp, |fit| fit.warp).scaled(2.0);
        }
        let Follower {
            reference,
            half,
            order,
            ..
        } = *self.follower;
        let subset = |order| Subset::new(reference, centre, half, order);
        let affine = subset(Order::Affine)?.find(self.spline, warp)?;
        let fit = match order {
            Order::Affine => affine,
            order => subset(order)?.find(self.spline, affine.warp)?,
        };
        (fit.similarity >= LEAST_SIMILARITY).then_some(fit)
    }

    /// The best three fields on the coarsest level of a subset deformed by F, with their correlations.
    fn correlate(&self, centre: [usize; 2], f: Matrix2<f64>) -> Vec<(f64, Warp)> {
        let (reference, other) = match self.coarse.last() {
            Some(level) => (&level.reference, &level.image),
            None => (self.follower.reference, self.image),
        };
        let [width, height] = reference.image.size();
        let centre = centre.map(|c| (c >> self.coarse.len()) as f64);
        let Some(inverse) = f.try_inverse() else {
            return Vec::new();
        };
        let reach = HALF as isize;
        let square = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| [x, y]));
        let template = square.filter_map(|[x, y]| {
            let from = inverse * nalgebra::Vector2::new(x as f64, y as f64);
            let [a, b] = [centre[0] + from.x, centre[1] + from.y];
            let inside = a >= 0.0 && b >= 0.0 && a < (width - 1) as f64 && b < (height - 1) as f64;
            let (column, row) = (a as usize, b as usize);
            (inside && reference.usable[row * width + column])
                .then(|| ([x, y], linear(&reference.image, a, b)))
        });
        let (offsets, mut values): (Vec<[isize; 2]>, Vec<f32>) = template.unzip();
        if offsets.len() < (HALF + 1).pow(2) {
            return Vec::new();
        }
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        values.iter_mut().for_each(|value| *value -= mean);
        let warp = |(score, x, y): (f64, usize, usize)| {
            let displacement = [x as f64 - centre[0], y as f64 - centre[1]];
            (score, Warp::affine(displacement, f - Matrix2::identity()))
        };
        best_positions(other, &offsets, &values)
            .into_iter()
            .map(warp)
            .collect()
    }
}

/// The value between four pixels, linear along x and y.
fn linear(image: &GreyImage, x: f64, y: f64) -> f32 {
    let (column, row) = (x as usize, y as usize);
    let (s, t) = ((x - column as f64) as f32, (y - row as f64) as f32);
    let along =
        |row: usize| image.value(column, row) * (1.0 - s) + image.value(column + 1, row) * s;
    along(row) * (1.0 - t) + along(row + 1) * t
}

/// The best three positions in an image of a template with mean 0, more than two pixels apart, with their correlations.
fn best_positions(
    image: &GreyImage,
    offsets: &[[isize; 2]],
    template: &[f32],
) -> Vec<(f64, usize, usize)> {
    const BEST: usize = 3;
    const APART: usize = 2;
    let ([columns, rows], pixels) = (image.size(), image.values());
    let size = template
        .iter()
        .map(|value| value * value)
        .sum::<f32>()
        .sqrt();
    let count = template.len() as f32;
    let flat: Vec<isize> = offsets
        .iter()
        .map(|[x, y]| y * columns as isize + x)
        .collect();
    let score = |x: usize, y: usize| {
        let at = (y * columns + x) as isize;
        let (mut product, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for (offset, value) in flat.iter().zip(template) {
            let other = pixels[(at + offset) as usize];
            product += value * other;
            sum += other;
            squares += other * other;
        }
        f64::from(product / (size * (squares - sum * sum / count).max(1e-6).sqrt()))
    };
    let inner = HALF..columns.saturating_sub(HALF);
    let positions =
        (HALF..rows.saturating_sub(HALF)).flat_map(|y| inner.clone().map(move |x| (x, y)));
    let mut scores: Vec<_> = positions.map(|(x, y)| (score(x, y), x, y)).collect();
    scores.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best: Vec<(f64, usize, usize)> = Vec::new();
    for (score, x, y) in scores {
        let is_apart =
            |other: &(f64, usize, usize)| x.abs_diff(other.1).max(y.abs_diff(other.2)) > APART;
        if best.iter().all(is_apart) {
            best.push((score, x, y));
        }
        if best.len() == BEST {
            break;
        }
    }
    best
}
