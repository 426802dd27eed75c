//! Camera images.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use gelbench::document::with_files;
use gelbench::error::Error;
use gelbench_images::images::{ImageFile, Order, Settings};
use gelbench_studies::studies::images::{ImageRequest, ImageSettings, results};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors::choice;
use crate::markers::length_unit;
use crate::results::Results;
use crate::running::run;
use crate::study::budget;

/// An image of rows × columns.
struct Image {
    size: [usize; 2],
    values: Vec<f32>,
}

impl<'py> FromPyObject<'_, 'py> for Image {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array: PyReadonlyArray2<'py, f32> = object.extract()?;
        let [height, width] = [array.shape()[0], array.shape()[1]];
        Ok(Self {
            size: [width, height],
            values: array.as_slice()?.to_vec(),
        })
    }
}

impl Image {
    fn file(self, name: &str) -> Result<ImageFile, Error> {
        ImageFile::of_values(name, self.size, self.values)
    }
}

/// A file or an array.
#[derive(FromPyObject)]
enum Source {
    File(PathBuf),
    Array(Image),
}

/// How images are followed, and those in memory.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct ImageOptions {
    frames: Vec<Image>,
    spacing: usize,
    subset: Option<usize>,
    subset_shape: String,
    mask: Option<Source>,
}

impl ImageOptions {
    /// The settings of a study.
    ///
    /// # Errors
    /// [`Error::Input`] where an image cannot be one.
    pub fn settings(self) -> Result<ImageSettings, Error> {
        let order = choice("subset_shape", &self.subset_shape, &Order::NAMES)?;
        let numbered = self.frames.into_iter().enumerate();
        let frames = numbered.map(|(number, image)| image.file(&format!("images[{number}]")));
        Ok(ImageSettings {
            subsets: Settings {
                spacing: self.spacing,
                subset: self.subset,
                order,
            },
            mask: match self.mask {
                None => None,
                Some(Source::File(path)) => Some(ImageFile::new(&path, 0)),
                Some(Source::Array(image)) => Some(image.file("mask")?),
            },
            in_memory: frames.collect::<Result<_, _>>()?,
        })
    }
}

/// Follows the pattern of the first image through all others.
#[pyfunction]
#[pyo3(signature = (files, unit, outline, in_memory, options, progress=None, allow_large=false))]
#[expect(
    clippy::too_many_arguments,
    reason = "images, and what is known of them"
)]
pub fn track(
    py: Python<'_>,
    files: Vec<PathBuf>,
    unit: &str,
    outline: Option<PathBuf>,
    in_memory: BTreeMap<PathBuf, Vec<u8>>,
    options: ImageOptions,
    progress: Option<Py<PyAny>>,
    allow_large: bool,
) -> PyResult<Results> {
    run(py, progress, |watch| {
        let settings = options.settings()?;
        let request = ImageRequest {
            files: &files,
            pixel: Some(length_unit(unit)?),
            settings: &settings,
            outline: outline.as_deref(),
            budget: budget(allow_large),
        };
        let start = Instant::now();
        let tracked = with_files(in_memory, || request.follow(&|what| watch.report(what)))?;
        let seconds = start.elapsed().as_secs_f64();
        let tracking = results(&tracked, "track".to_owned(), seconds);
        let file = files.into_iter().next().unwrap_or_default();
        Ok(Results::new(tracking, file))
    })
}
