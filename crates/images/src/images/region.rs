//! The pixels of the specimen.

use super::grey::{GreyImage, range};
use crate::error::Error;

/// Which pixels show the specimen.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    size: [usize; 2],
    inside: Vec<bool>,
}

/// The largest share of a mask's pixels that may be neither white nor black, as along its edges.
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
            for pair in crossings(lines, y as f64).chunks_exact(2) {
                let from = pair[0].ceil().max(0.0) as usize;
                let to = (pair[1].floor() + 1.0).clamp(0.0, row.len() as f64) as usize;
                if let Some(within) = row.get_mut(from..to) {
                    within.fill(true);
                }
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

    /// The pixels around which interpolation uses no pixel outside of the specimen: cubic B-splines use two pixels to each side.
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

/// The x at which closed lines cross a row of pixels at a height, ascending.
fn crossings(lines: &[Vec<[f64; 2]>], height: f64) -> Vec<f64> {
    let mut crossings = Vec::new();
    for line in lines {
        let next = line.iter().cycle().skip(1);
        for (&[a, b], &[c, d]) in line.iter().zip(next) {
            if (b > height) != (d > height) {
                crossings.push(a + (height - b) / (d - b) * (c - a));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings
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
