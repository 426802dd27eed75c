//! Camera images as they are shown beneath meshes.

use std::path::{Path, PathBuf};

use gelbench::error::Error;
use gelbench_images::images::{GreyImage, ImageFile, is_image_path, list};
use gelbench_studies::studies::images::in_time;
use serde::{Deserialize, Serialize};

use super::FieldQuestion;
use super::request::unit;

/// The longest side of what is shown, in pixels.
const LONGEST: usize = 720;

/// A camera image in so many grey values as are shown.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Photo {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Row by row from the top.
    pub values: Vec<u8>,
    /// The lower left and the upper right corner in mm.
    pub corners: [[f64; 2]; 2],
}

impl Photo {
    /// Each pixel is the mean of a square of pixels; the darkest thousandth is black, and the brightest white.
    fn of(image: &GreyImage, pixel: f64) -> Self {
        let [width, height] = image.size();
        let side = width.max(height).div_ceil(LONGEST).min(width).min(height);
        let size = [width / side, height / side];
        let mean = |number: usize| {
            let [x, y] = [number % size[0], number / size[0]].map(|position| side * position);
            let rows = y..y + side;
            let sum: f32 = rows
                .flat_map(|y| (x..x + side).map(move |x| image.value(x, y)))
                .sum();
            sum / (side * side) as f32
        };
        let means: Vec<f32> = (0..size[0] * size[1]).map(mean).collect();
        let mut sorted = means.clone();
        sorted.sort_by(f32::total_cmp);
        let tail = sorted.len() / 1000;
        let (black, white) = (sorted[tail], sorted[sorted.len() - 1 - tail]);
        let grey = |mean: &f32| 255.0 * (mean - black) / (white - black).max(f32::MIN_POSITIVE);
        // The centre of the lower left pixel is the origin.
        let top = height as f64 - 0.5;
        let corner = |x: f64, y: f64| [pixel * x, pixel * y];
        let [right, bottom] = [0, 1].map(|axis| (side * size[axis]) as f64);
        Self {
            size,
            values: means.iter().map(|mean| grey(mean) as u8).collect(),
            corners: [corner(-0.5, top - bottom), corner(right - 0.5, top)],
        }
    }
}

/// The camera images of a question, if it has any.
pub struct Photos {
    pixel: f64,
    first: Option<ImageFile>,
    frames: Vec<(usize, ImageFile)>,
}

impl Photos {
    /// Finds the images.
    ///
    /// # Errors
    /// As of the study itself.
    pub fn of(question: &FieldQuestion) -> Result<Self, Error> {
        let pixel = unit(&question.unit)?.unwrap_or(f64::NAN);
        if !question.has_images() {
            let (first, frames) = (None, Vec::new());
            return Ok(Self {
                pixel,
                first,
                frames,
            });
        }
        let paths: Vec<PathBuf> = question.files.iter().map(|(name, _)| name.into()).collect();
        let files = list(&paths)?;
        let (first, frames) = in_time(&files)?;
        Ok(Self {
            pixel,
            first: Some(first.clone()),
            frames,
        })
    }

    /// That of the specimen at rest.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn at_rest(&self) -> Result<Option<Photo>, Error> {
        self.shown(self.first.as_ref())
    }

    /// That of a frame.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn of_frame(&self, number: usize) -> Result<Option<Photo>, Error> {
        let file = self.frames.iter().find(|(frame, _)| *frame == number);
        self.shown(file.map(|(_, file)| file))
    }

    fn shown(&self, file: Option<&ImageFile>) -> Result<Option<Photo>, Error> {
        let image = file.map(ImageFile::read).transpose()?;
        Ok(image.map(|image| Photo::of(&image, self.pixel)))
    }
}

impl FieldQuestion {
    /// Whether the files of the field are camera images.
    pub fn has_images(&self) -> bool {
        let mut files = self.files.iter();
        files.any(|(name, _)| is_image_path(Path::new(name)))
    }

    /// Whether an image under load is missing beside the one at rest.
    pub fn waits_for_images(&self) -> bool {
        self.has_images() && self.files.len() < 2
    }

    /// The specimen's edge, where it is known: an image of its region, or a table of lines.
    pub(super) fn mask_and_outline(&self) -> [Option<&str>; 2] {
        let name = self.edge_file.as_ref().map(|(name, _)| name.as_str());
        let is_mask = name.is_some_and(|name| is_image_path(Path::new(name)));
        [name.filter(|_| is_mask), name.filter(|_| !is_mask)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_photo_lies_where_its_pixels_are() {
        let image = GreyImage::of(
            1500,
            900,
            |x, y| if x < 750 && y < 450 { 200.0 } else { 10.0 },
        );
        let photo = Photo::of(&image, 0.1);
        assert_eq!(photo.size, [500, 300]);
        assert_eq!((photo.values[0], photo.values[499]), (255, 0));
        assert_eq!((photo.values[149 * 500], photo.values[150 * 500]), (255, 0));
        let narrow = Photo::of(&GreyImage::of(9000, 8, |_, _| 7.0), 0.1);
        assert_eq!(narrow.size, [1125, 1]);
        for (corner, expected) in photo
            .corners
            .iter()
            .flatten()
            .zip([-0.05, -0.05, 149.95, 89.95])
        {
            assert!((corner - expected).abs() < 1e-9, "{corner} {expected}");
        }
    }
}
