//! The options about camera images, and `gelbench track`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use super::arguments::{Large, one_of};
use super::conclusion::finish;
use super::correct::values::unit;
use super::interrupt;
use super::progress::Progress;
use super::terminal::{Outcome, Printed, warn};
use gelbench_images::images::{ImageFile, Order, Settings, list};
use gelbench_report::output::{self, ResultFolder};
use gelbench_studies::studies::images::{ImageRequest, ImageSettings, results};
use gelbench_studies::studies::name;

/// What the command line says of camera images.
#[derive(Args, Debug)]
#[command(next_help_heading = "Camera images")]
pub struct ImageOptions {
    /// Distance of the followed points in pixels
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u16).range(1..=1000), default_value_t = 8)]
    spacing: u16,
    /// Width of the subsets around them in pixels [default: five speckles, and wide enough for the images' noise]
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u16).range(5..=1001))]
    subset: Option<u16>,
    /// The displacement in a subset: with its gradient, or with its second derivatives too
    #[arg(long, value_parser = one_of(&Order::NAMES), default_value = "affine")]
    subset_shape: Order,
    /// An image of the specimen's region, white on black; without an outline or a mesh its edge is that of the specimen
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
}

impl ImageOptions {
    /// How images are followed.
    pub fn settings(&self) -> ImageSettings {
        ImageSettings {
            subsets: Settings {
                spacing: self.spacing.into(),
                subset: self.subset.map(usize::from),
                order: self.subset_shape,
            },
            mask: self.mask.as_deref().map(|mask| ImageFile::new(mask, 0)),
            in_memory: Vec::new(),
        }
    }

    /// The files among them.
    pub fn mask(&self) -> Option<PathBuf> {
        self.mask.clone()
    }
}

/// What the command line says about the tracking of images.
#[derive(Args, Debug)]
#[command(after_help = AFTER_HELP)]
pub struct TrackOptions {
    /// The images, folders of them, or patterns such as frames/*.tif; the first image shows the specimen at rest
    #[arg(required = true, value_name = "IMAGE")]
    images: Vec<PathBuf>,
    /// The length of a pixel, such as "0.02 mm"
    #[arg(long, value_name = "LENGTH", value_parser = unit)]
    unit: f64,
    /// The specimen's edge as a table: x [mm], y [mm], and line where there are holes; x to the right and y up from the centre of the lower
    /// left pixel
    #[arg(long, value_name = "FILE", conflicts_with = "mask")]
    outline: Option<PathBuf>,
    #[command(flatten)]
    options: ImageOptions,
    /// Write into this folder
    #[arg(long, value_name = "FOLDER", default_value = "output/track")]
    output: PathBuf,
    #[command(flatten)]
    large: Large,
    #[command(flatten)]
    printed: Printed,
}

/// What stands below the help.
const AFTER_HELP: &str = "\
Images are PNG, TIFF (also several pages in one file), BMP or JPEG, of 8 or 16 bit. markers.csv in the folder holds the points of all frames with
their standard deviations; gelbench correct reads it, and reads the images themselves as well.

Sample: gelbench track frames/*.tif --unit \"0.02 mm\" --spacing 8";

/// Follows the pattern of the first image, prints, and writes.
pub fn track(options: TrackOptions) -> Outcome {
    options.printed.choose();
    let settings = options.options.settings();
    let files = list(&options.images)?;
    let mut inputs: Vec<PathBuf> = files.iter().map(|file| file.path.clone()).collect();
    inputs.dedup();
    inputs.extend(
        options
            .outline
            .iter()
            .cloned()
            .chain(options.options.mask()),
    );
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    let mut folder = interrupt::guarded(|| ResultFolder::open(&options.output, "track", &inputs))?;
    warn(folder.replaces().as_slice());
    let progress = Progress::of(files.len() as u64);
    let request = ImageRequest {
        files: &options.images,
        pixel: Some(options.unit),
        settings: &settings,
        outline: options.outline.as_deref(),
        budget: options.large.budget(),
    };
    let start = Instant::now();
    let tracked = request.follow(&|what| {
        progress.report(what);
        progress.advance();
    })?;
    progress.report("files");
    warn(&tracked.warnings);
    let results = results(
        &tracked,
        name(&options.images[0]),
        start.elapsed().as_secs_f64(),
    );
    let warnings = output::write(&results, true, &mut folder)?;
    drop(progress);
    warn(&warnings);
    finish(folder, results)
}
