//! From camera images to markers.
//!
//! ```text
//! frames, pixel ─┐
//! mask, outline ─┼─▶ TrackedImages { markers of every frame, noise, subset } ─▶ table, report, MarkerStudy
//! spacing, … ────┘
//! ```

use std::path::{Path, PathBuf};

use crate::budget::{Budget, Need};
use crate::error::{Diagnostic, Error};
use crate::images::{
    GreyImage, ImageFile, Region, Settings, Tracked, Tracker, is_image_path, list, series,
};
use crate::markers::{
    Frame, MarkerFiles, MarkerSeries, Subset, Understood, number_at_end, read_lines,
};
use crate::units::decimals;

mod written;

pub use written::results;

/// How images are followed.
#[derive(Clone, Debug, Default)]
pub struct ImageSettings {
    /// Points and subsets.
    pub subsets: Settings,
    /// An image of the specimen's region, white on black.
    pub mask: Option<ImageFile>,
    /// Images in memory, which are followed instead of those of files.
    pub in_memory: Vec<ImageFile>,
}

/// What is to be followed.
#[derive(Clone, Debug)]
pub struct ImageRequest<'a> {
    /// Images, folders and patterns; the first image shows the specimen at rest.
    pub files: &'a [PathBuf],
    /// The length of a pixel in mm.
    pub pixel: Option<f64>,
    /// How they are followed.
    pub settings: &'a ImageSettings,
    /// The specimen's edge in mm, as a table of lines.
    pub outline: Option<&'a Path>,
    /// The memory that it may use.
    pub budget: Budget,
}

/// Images with the numbers of their frames.
type NumberedFiles = Vec<(usize, ImageFile)>;

/// Images that have been followed.
#[derive(Clone, Debug)]
pub struct TrackedImages {
    /// The first image's pattern.
    pub tracker: Tracker,
    /// The images after the first one with the numbers of their frames.
    pub files: NumberedFiles,
    /// The points in each frame.
    pub frames: Vec<(usize, Vec<Option<Tracked>>)>,
    /// The same in mm.
    pub series: MarkerSeries,
    /// Patches that share no pixel, in mm: their errors are independent.
    pub patches: MarkerSeries,
    /// The length of a pixel in mm.
    pub pixel: f64,
    /// How they were followed.
    pub settings: Settings,
    /// What deserves attention.
    pub warnings: Vec<Diagnostic>,
}

/// Memory per pixel while images are followed, in bytes: for grey values, splines, gradients and smoothed gradients.
const BYTES_OF_A_PIXEL: f64 = 120.0;

/// The largest difference between the mean strain of the pattern and that of its points' displacements which is no contradiction: a constant, and
/// a share of the strain. Both differ a little where strain varies and points are lost.
const APART: [f64; 2] = [0.03, 0.1];

/// The mean ∂ux/∂X and ∂uy/∂Y of the pattern about its points.
fn mean_strains(points: &[Option<Tracked>]) -> Option<[f64; 2]> {
    let followed: Vec<&Tracked> = points.iter().flatten().collect();
    let mean = |axis| {
        let strains = followed.iter().map(|point| point.gradient[(axis, axis)]);
        strains.sum::<f64>() / followed.len() as f64
    };
    (!followed.is_empty()).then(|| [mean(0), mean(1)])
}

/// The largest distance by which an outline may reach beyond the images, over their longer side.
const BEYOND: f64 = 0.02;

/// The layout of markers that were followed in images.
pub const IMAGES: &str = "images";

/// Whether files are images: all of them by their names, or one folder.
pub fn are_images(files: &[PathBuf]) -> bool {
    let is_folder = |path: &PathBuf| path.is_dir() || path.to_string_lossy().contains(['*', '?']);
    !files.is_empty()
        && files
            .iter()
            .all(|path| is_image_path(path) || is_folder(path))
}

impl ImageRequest<'_> {
    /// Follows the pattern of the first image through all others; each is reported before it begins.
    ///
    /// # Errors
    /// [`Error::Input`] with the file, what is wrong and what to do.
    pub fn follow(&self, report: &dyn Fn(&str)) -> Result<TrackedImages, Error> {
        let pixel = self.known_pixel()?;
        let files = match &*self.settings.in_memory {
            [] => list(self.files)?,
            images => images.to_vec(),
        };
        let (first, numbered) = in_time(&files)?;
        let last = numbered.last().map_or(first, |(_, last)| last);
        let image = first.read()?;
        self.afford(&image)?;
        let region = self.region(image.size(), pixel)?;
        let settings = self.settings.subsets;
        report("the first image");
        let mut tracker = Tracker::new(&image, &of_file(last, last.read())?, &region, settings)?;
        let (mut frames, mut patches) = (Vec::new(), Vec::new());
        let mut warnings = tracker.warnings().to_vec();
        for (number, file) in &numbered {
            report(&file.name());
            match followed(&mut tracker, file) {
                Ok([points, measured]) => {
                    frames.push((*number, points));
                    patches.push((*number, measured));
                }
                Err(Error::Input(faults)) if numbered.len() > 1 => {
                    warnings.extend(faults.into_iter().map(|fault| left_out(fault, *number)));
                }
                Err(fault) => return Err(fault),
            }
        }
        if frames.is_empty() {
            let message = "no point of the first image is found again in any other";
            return Err(Error::input(
                message,
                "check that all images show one specimen with one pattern",
            ));
        }
        let height = image.size()[1];
        let in_mm = |frames: &[_]| series(frames, height, pixel);
        let (series, patches) = (in_mm(&frames), in_mm(&patches));
        Ok(TrackedImages {
            series,
            patches,
            tracker,
            files: numbered,
            frames,
            pixel,
            settings,
            warnings,
        })
    }

    fn known_pixel(&self) -> Result<f64, Error> {
        self.pixel.ok_or_else(|| {
            let message = "the length of a pixel is not known";
            Error::input(message, "give it, such as --unit \"0.02 mm\"")
        })
    }

    fn afford(&self, image: &GreyImage) -> Result<(), Error> {
        let [width, height] = image.size();
        let need = Need {
            bytes: BYTES_OF_A_PIXEL * (width * height) as f64,
            ..Need::default()
        };
        self.budget.afford(need).map_err(|excess| {
            let message = format!("following images of {width} × {height} pixels {excess}");
            Error::input(message, excess.remedy("crop the images to the specimen"))
        })
    }

    fn region(&self, size: [usize; 2], pixel: f64) -> Result<Region, Error> {
        if let Some(mask) = &self.settings.mask {
            let region = mask.read().and_then(|mask| Region::of_mask(&mask, size));
            return of_file(mask, region);
        }
        let Some(outline) = self.outline else {
            return Ok(Region::full(size));
        };
        let up = (size[1] - 1) as f64;
        let mut lines = read_lines(outline, Some(pixel))?;
        for position in lines.iter_mut().flatten() {
            *position = [position[0] / pixel, up - position[1] / pixel];
        }
        if let Some(message) = beyond(&lines, size, pixel) {
            let message = format!("{}: {message}", outline.display());
            let hint = "exchange its columns if they are y and x, check --unit, and let it end where the images end";
            return Err(Error::input(message, hint));
        }
        Region::of_lines(&lines, size)
    }
}

/// A message that says how far lines in pixels reach beyond images of a size, where that is more than an outline by hand is off.
fn beyond(lines: &[Vec<[f64; 2]>], size: [usize; 2], pixel: f64) -> Option<String> {
    let last = size.map(|length| (length - 1) as f64);
    let along =
        |position: &[f64; 2]| [0, 1].map(|axis| (position[axis] - last[axis]).max(-position[axis]));
    let far = lines.iter().flatten().flat_map(along).fold(0.0, f64::max);
    let [width, height, far_in_mm] =
        [last[0], last[1], far].map(|length| decimals(length * pixel, 3));
    (far > BEYOND * last[0].max(last[1])).then(|| {
        format!(
            "the outline reaches {far_in_mm} mm beyond the images, which show {width} × {height} mm"
        )
    })
}

/// The first image, and the later ones with the numbers of their frames.
///
/// # Errors
/// [`Error::Input`] where there are fewer than two.
pub fn in_time(files: &[ImageFile]) -> Result<(&ImageFile, NumberedFiles), Error> {
    match files {
        [first, others @ ..] if !others.is_empty() => {
            let numbered = numbers(others).into_iter().zip(others.iter().cloned());
            Ok((first, numbered.collect()))
        }
        _ => {
            let names: Vec<String> = files
                .iter()
                .map(|file| file.path.display().to_string())
                .collect();
            let message = format!("there are too few images: {}", names.join(", "));
            Err(Error::input(
                message,
                "give at least two, the first one of the specimen at rest",
            ))
        }
    }
}

/// Points and patches of a frame.
fn followed(tracker: &mut Tracker, file: &ImageFile) -> Result<[Vec<Option<Tracked>>; 2], Error> {
    let followed = file.read().and_then(|image| {
        let points = tracker.follow(&image)?;
        let about = |point: usize| Some(points[point]?.warp());
        let patches = tracker.patches();
        let measured = patches.measure(&patches.spline(&image), &about);
        Ok([points, measured])
    });
    of_file(file, followed)
}

/// A fault with the name of its image, where it does not have it.
fn of_file<T>(file: &ImageFile, result: Result<T, Error>) -> Result<T, Error> {
    let named = |fault: Diagnostic| {
        let name = file.path.display().to_string();
        if fault.message.contains(&name) {
            fault
        } else {
            fault.prefixed(name)
        }
    };
    result.map_err(|error| error.map_faults(named))
}

fn left_out(fault: Diagnostic, number: usize) -> Diagnostic {
    let message = format!("frame {number} is left out: {}", fault.message);
    Diagnostic::warning("", message).hint(fault.hint.unwrap_or_default())
}

/// The numbers at the ends of the files' names where all have one and they increase, else 1, 2, 3 …
fn numbers(files: &[ImageFile]) -> Vec<usize> {
    let number = |file: &ImageFile| -> Option<usize> {
        number_at_end(&file.path.file_stem()?.to_string_lossy())
    };
    let parsed: Option<Vec<usize>> = files.iter().map(number).collect();
    let grow = |numbers: &Vec<usize>| numbers.windows(2).all(|pair| pair[0] < pair[1]);
    parsed
        .filter(grow)
        .unwrap_or_else(|| (1..=files.len()).collect())
}

impl TrackedImages {
    /// The patches as if they had been read from a file.
    pub fn markers(&self) -> MarkerFiles {
        let width = self.tracker.patches().width() as f64;
        let subset = Subset {
            size: width,
            step: width,
            source: "the tracking of the images".to_owned(),
        };
        MarkerFiles {
            series: self.patches.clone(),
            mesh: None,
            understood: Understood {
                turned_up: true,
                subset: Some(subset),
                pixel: Some(self.pixel),
                ..Understood::of(IMAGES)
            },
            warnings: self.warnings.clone(),
        }
    }

    /// The first frame of a series of these images in which the strains of the pattern about its points contradict their displacements, as where
    /// a pattern that repeats itself was matched with its neighbours.
    pub fn contradiction(&self, series: &MarkerSeries) -> Option<Diagnostic> {
        let contradicted = |frame: &Frame| {
            let (_, points) = self.frames.iter().find(|(of, _)| *of == frame.number)?;
            let [x, y] = mean_strains(points)?;
            let gradient = frame.mean_gradient()?;
            let axes = [("x", x, gradient[(0, 0)]), ("y", y, gradient[(1, 1)])];
            let is_apart = |(_, strain, of_displacements): &(_, f64, f64)| {
                (strain - of_displacements).abs() > APART[0] + APART[1] * strain.abs()
            };
            Some((frame.number, axes.into_iter().find(is_apart)?))
        };
        let (number, (axis, strain, of_displacements)) =
            series.frames.iter().find_map(contradicted)?;
        let message = format!(
            "frame {number}: along {axis} the pattern is stretched to {:.3} on average, but the displacements of its points to {:.3}: points were \
             matched with others that look alike, as where a pattern repeats itself",
            1.0 + strain,
            1.0 + of_displacements
        );
        let hint = "give the images between them, so that each moves by less than half a period of the pattern, or take a pattern that does not repeat itself";
        Some(Diagnostic::warning("", message).hint(hint))
    }

    /// The image of a frame.
    pub fn file(&self, frame: usize) -> Option<&ImageFile> {
        let mut files = self.files.iter();
        files
            .find(|(number, _)| *number == frame)
            .map(|(_, file)| file)
    }

    /// The number of points of the grid.
    pub fn points(&self) -> usize {
        self.tracker.positions().len()
    }
}
