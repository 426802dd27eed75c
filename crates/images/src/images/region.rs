//! The pixels of the specimen.

use super::grey::{GreyImage, range};
use crate::error::Error;

/// Which pixels show the specimen.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    size: [usize; 2],
    inside: Vec<bool>,
}

/// The largest part of a mask's pixels that are neither white nor black, as along its edges.
const MOST_GREY: f64 = 0.2;

impl Region {
    /// The whole image.
    pub fn full(size: [usize; 2]) -> Self {
        Self {
            size,
            inside: vec![true; size[0] * size[1]],
        }
    }

    /// The pixels of a mask that are lighter than half of its range.
    ///
    /// # Errors
    /// [`Error::Input`] where its size is not that of the images, or where it is not of two colours.
    pub fn of_mask(mask: &GreyImage, size: [usize; 2]) -> Result<Self, Error> {
        if mask.size() != size {
            let ([a, b], [c, d]) = (mask.size(), size);
            let message = format!("the mask has {a} × {b} pixels, and the images have {c} × {d}");
            return Err(Error::input(message, "draw it on the first image"));
        }
        let (low, high) = range(mask.values());
        let is_grey = |value: &&f32| (0.1..0.9).contains(&((**value - low) / (high - low)));
        let grey = mask.values().iter().filter(is_grey).count() as f64;
        let fault = if low >= high {
            Some("all pixels of the mask are alike")
        } else if grey > MOST_GREY * mask.values().len() as f64 {
            Some("the mask is a photograph: many of its pixels are grey")
        } else {
            None
        };
        if let Some(message) = fault {
            return Err(Error::input(message, "draw the specimen white on black"));
        }
        let inside = mask
            .values()
            .iter()
            .map(|value| *value > 0.5 * (low + high));
        Ok(Self {
            size,
            inside: inside.collect(),
        })
    }

    /// The pixels within closed lines in pixels; lines within lines are holes.
    ///
    /// # Errors
    /// [`Error::Input`] where no pixel is inside.
    pub fn of_lines(lines: &[Vec<[f64; 2]>], size: [usize; 2]) -> Result<Self, Error> {
        let mut inside = vec![false; size[0] * size[1]];
        for (y, row) in inside.chunks_mut(size[0]).enumerate() {
            let height = y as f64;
            let crossing = |pair: [[f64; 2]; 2]| {
                let [[a, b], [c, d]] = pair;
                ((b > height) != (d > height)).then(|| a + (height - b) / (d - b) * (c - a))
            };
            let ends = |line: &Vec<[f64; 2]>| {
                let next = line.iter().cycle().skip(1).copied();
                let pairs = line.iter().copied().zip(next);
                pairs
                    .filter_map(|(from, to)| crossing([from, to]))
                    .collect::<Vec<_>>()
            };
            let mut crossings: Vec<f64> = lines.iter().flat_map(ends).collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let from = pair[0].ceil().max(0.0) as usize;
                let to = (pair[1].floor() + 1.0).clamp(0.0, row.len() as f64) as usize;
                row.iter_mut()
                    .take(to)
                    .skip(from)
                    .for_each(|flag| *flag = true);
            }
        }
        if !inside.contains(&true) {
            let message = "no pixel of the images is inside the outline";
            let hint = "give it in the images' coordinates: x to the right and y up from the centre of the lower left pixel, in mm by --unit";
            return Err(Error::input(message, hint));
        }
        Ok(Self { size, inside })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Whether each pixel is inside.
    pub fn flags(&self) -> &[bool] {
        &self.inside
    }

    /// The pixels whose interpolation reaches none outside of the specimen, within the image: cubic B-splines reach two pixels.
    pub fn inner(&self) -> Vec<bool> {
        const REACH: usize = 2;
        let [width, height] = self.size;
        let around =
            |at: usize, length: usize| at.saturating_sub(REACH)..=(at + REACH).min(length - 1);
        let is_inner = |index: usize| {
            let (x, y) = (index % width, index / width);
            around(y, height).all(|row| around(x, width).all(|column| self.has(column, row)))
        };
        (0..width * height).map(is_inner).collect()
    }

    /// Whether a pixel is inside.
    pub fn has(&self, x: usize, y: usize) -> bool {
        x < self.size[0] && y < self.size[1] && self.inside[y * self.size[0] + x]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_within_lines_are_inside_and_those_of_a_hole_are_not() {
        let square = |low: f64, high: f64| vec![[low, low], [high, low], [high, high], [low, high]];
        let region = Region::of_lines(&[square(1.5, 8.5), square(3.5, 5.5)], [10, 10]).unwrap();
        assert!(region.has(2, 2) && region.has(8, 8));
        assert!(!region.has(1, 4) && !region.has(4, 4) && !region.has(9, 9));
        assert_eq!(region.flags().iter().filter(|flag| **flag).count(), 49 - 4);
        assert!(Region::of_lines(&[square(20.0, 30.0)], [10, 10]).is_err());
    }
}
