//! Images from files: PNG, TIFF of one or many pages, BMP and JPEG; 8 or 16 bit, grey or colour.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::{DynamicImage, ImageReader, Limits};
use rayon::prelude::*;
use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult};

use super::grey::{GreyImage, luminance};
use crate::error::Error;
use gelbench_base::document::given;
use palette::{as_grey, is_of_palette};

mod palette;

/// Pixels of the largest image that is read.
const MOST_PIXELS: u64 = 1 << 27;

/// Pixels along the shorter side of the smallest image that is of use.
const FEWEST: u32 = 8;

/// The ends of names of files that are images.
const ENDS: [&str; 6] = ["png", "tif", "tiff", "bmp", "jpg", "jpeg"];

/// Values none of which is larger are fractions of white, with noise.
const FRACTION: f32 = 2.0;

/// White of 16 bit.
const WHITE: f32 = 65535.0;

const KINDS: &str = "give a PNG, TIFF, BMP or JPEG image of 8 or 16 bit";

/// One image of a file, or one in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageFile {
    /// The file, or the name of an image in memory.
    pub path: PathBuf,
    /// The page of a TIFF file, from 0.
    pub page: usize,
    source: Source,
}

/// Where an image comes from.
#[derive(Clone, Debug, PartialEq)]
enum Source {
    Disk,
    /// The bytes of a file that a program gives.
    Bytes(Arc<[u8]>),
    Values(Arc<GreyImage>),
}

/// What images are decoded from.
trait Encoded: BufRead + Seek {}

impl<T: BufRead + Seek> Encoded for T {}

/// The end of a file's name in small letters; empty where it has none.
fn extension(path: &Path) -> String {
    let end = path.extension().unwrap_or_default();
    end.to_string_lossy().to_lowercase()
}

/// Whether a file is an image by the end of its name.
pub fn is_image_path(path: &Path) -> bool {
    ENDS.contains(&&*extension(path))
}

fn is_tiff(path: &Path) -> bool {
    extension(path).starts_with("tif")
}

fn refuse(path: &Path, fault: impl std::fmt::Display, hint: &str) -> Error {
    Error::input(format!("{}: {fault}", path.display()), hint)
}

/// All images of files, folders and patterns such as `frames/*.tif`, in the order of the numbers in their names.
///
/// # Errors
/// [`Error::Input`] where there is no image.
pub fn list(paths: &[PathBuf]) -> Result<Vec<ImageFile>, Error> {
    let mut files = Vec::new();
    for path in paths {
        files.extend(expanded(path)?);
    }
    // A shell puts frame10 before frame2.
    if files.is_sorted() {
        files.sort_by_cached_key(|path| in_order(&path.to_string_lossy()));
    }
    let mut images = Vec::new();
    for file in &files {
        images.extend(pages(file)?);
    }
    Ok(images)
}

/// The files that a path stands for.
fn expanded(path: &Path) -> Result<Vec<PathBuf>, Error> {
    let name_of = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let name = name_of(path);
    let is_pattern = name.contains(['*', '?']) && !path.exists();
    let folder = if path.is_dir() {
        path
    } else if is_pattern {
        let parent = path.parent();
        let parent = parent.filter(|folder| !folder.as_os_str().is_empty());
        parent.unwrap_or(Path::new("."))
    } else {
        return Ok(vec![path.to_owned()]);
    };
    let entries = std::fs::read_dir(folder)
        .map_err(|fault| refuse(folder, fault, "name a folder that can be read"))?;
    let suits = |path: &PathBuf| {
        let is_matched = || matches(name.as_bytes(), name_of(path).as_bytes());
        is_image_path(path) && (!is_pattern || is_matched())
    };
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(suits)
        .collect();
    paths.sort_by_cached_key(|path| in_order(&path.to_string_lossy()));
    if paths.is_empty() {
        return Err(refuse(path, "there is no image", KINDS));
    }
    Ok(paths)
}

/// Whether a name matches a pattern with `*` and `?`.
fn matches(pattern: &[u8], name: &[u8]) -> bool {
    match (pattern, name) {
        ([], []) => true,
        ([b'*', rest @ ..], _) => (0..=name.len()).any(|skipped| matches(rest, &name[skipped..])),
        ([b'?', rest @ ..], [_, others @ ..]) => matches(rest, others),
        ([one, rest @ ..], [other, others @ ..]) if one == other => matches(rest, others),
        _ => false,
    }
}

/// A key by which names sort with their numbers as numbers.
pub fn in_order(name: &str) -> String {
    let (mut key, mut digits) = (String::new(), String::new());
    for letter in name.chars().chain(['\0']) {
        if letter.is_ascii_digit() {
            digits.push(letter);
        } else {
            if !digits.is_empty() {
                key += &format!("{:0>20}", digits.trim_start_matches('0'));
                digits.clear();
            }
            key.push(letter);
        }
    }
    key
}

/// The images of a file: one, or as many as a TIFF file has pages.
fn pages(path: &Path) -> Result<Vec<ImageFile>, Error> {
    let first = ImageFile::new(path, 0);
    if !is_tiff(path) {
        return Ok(vec![first]);
    }
    let mut decoder = first.decoder()?;
    let mut count = 1;
    while decoder.more_images() {
        decoder
            .next_image()
            .map_err(|fault| refuse(path, fault, KINDS))?;
        count += 1;
    }
    let page = |page| ImageFile {
        page,
        ..first.clone()
    };
    Ok((0..count).map(page).collect())
}

fn check_size(width: u32, height: u32) -> Result<(), String> {
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!(
            "the image has {width} × {height} pixels, more than {MOST_PIXELS} in all"
        ));
    }
    if width.min(height) < FEWEST {
        return Err(format!(
            "the image has {width} × {height} pixels, fewer than {FEWEST} along one side"
        ));
    }
    Ok(())
}

impl ImageFile {
    /// The image of a file, or of a page of a TIFF file; a file that is given ([`with_files`](gelbench_base::document::with_files)) keeps its bytes.
    pub fn new(path: &Path, page: usize) -> Self {
        Self {
            path: path.to_owned(),
            page,
            source: given(path).map_or(Source::Disk, |bytes| Source::Bytes(bytes.into())),
        }
    }

    fn open(&self) -> Result<Box<dyn Encoded>, Error> {
        if let Source::Bytes(bytes) = &self.source {
            return Ok(Box::new(Cursor::new(Arc::clone(bytes))));
        }
        let file = File::open(&self.path)
            .map_err(|fault| refuse(&self.path, fault, "name a file that can be read"))?;
        Ok(Box::new(BufReader::new(file)))
    }

    fn decoder(&self) -> Result<Decoder<Box<dyn Encoded>>, Error> {
        Decoder::new(self.open()?).map_err(|fault| refuse(&self.path, fault, KINDS))
    }

    /// An image in memory, row by row from the top.
    ///
    /// # Errors
    /// [`Error::Input`] where it has too many or too few pixels, or values that are not numbers.
    pub fn of_values(
        name: &str,
        [width, height]: [usize; 2],
        values: Vec<f32>,
    ) -> Result<Self, Error> {
        let image = of_values(width, height, in_grey_values(values)).map_err(|fault| {
            let hint = "give arrays of rows × columns, grey values from 0 to 255 or 65535, or fractions of white";
            Error::input(format!("{name}: {fault}"), hint)
        })?;
        Ok(Self {
            source: Source::Values(Arc::new(image)),
            ..Self::new(Path::new(name), 0)
        })
    }

    /// The image in grey; of colours the luminance.
    ///
    /// # Errors
    /// [`Error::Input`] with the file, what is wrong and what to do. The size is checked before anything is decoded.
    pub fn read(&self) -> Result<GreyImage, Error> {
        if let Source::Values(image) = &self.source {
            return Ok((**image).clone());
        }
        let refuse = |fault: String| refuse(&self.path, fault, KINDS);
        if is_tiff(&self.path) {
            let mut decoder = self.decoder()?;
            decoder
                .seek_to_image(self.page)
                .map_err(|fault| refuse(fault.to_string()))?;
            return of_tiff(decoder).map_err(refuse);
        }
        drop(self.open()?);
        of_other(|| self.open()).map_err(refuse)
    }

    /// The name of the file without its end, and the page of several.
    pub fn name(&self) -> String {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        match self.page {
            0 => stem.into_owned(),
            page => format!("{stem}, page {}", page + 1),
        }
    }
}

/// An image from bytes, for tests of readers: a TIFF file by its first bytes, else any other.
///
/// # Errors
/// What is wrong.
pub fn of_bytes(bytes: &[u8]) -> Result<GreyImage, String> {
    if bytes.starts_with(b"II*\0") || bytes.starts_with(b"MM\0*") {
        let decoder = Decoder::new(Cursor::new(bytes)).map_err(|fault| fault.to_string())?;
        return of_tiff(decoder);
    }
    of_other(|| Ok(Cursor::new(bytes)))
}

fn of_other<R: BufRead + Seek>(open: impl Fn() -> Result<R, Error>) -> Result<GreyImage, String> {
    let reader = || -> Result<ImageReader<R>, String> {
        let source = open().map_err(|fault| fault.to_string())?;
        let mut reader = ImageReader::new(source)
            .with_guessed_format()
            .map_err(|fault| fault.to_string())?;
        let mut limits = Limits::default();
        limits.max_alloc = Some(8 * MOST_PIXELS);
        reader.limits(limits);
        Ok(reader)
    };
    let (width, height) = reader()?
        .into_dimensions()
        .map_err(|fault| fault.to_string())?;
    check_size(width, height)?;
    let decoded = reader()?.decode().map_err(|fault| fault.to_string())?;
    let (width, height) = (width as usize, height as usize);
    let values = match decoded {
        DynamicImage::ImageLuma8(image) => greys(&image.into_raw(), 1, f32::from),
        DynamicImage::ImageLuma16(image) => greys(&image.into_raw(), 1, f32::from),
        DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => greys(&decoded.into_rgb16().into_raw(), 3, f32::from),
        other => greys(&other.into_rgb8().into_raw(), 3, f32::from),
    };
    Ok(GreyImage::new(width, height, values))
}

/// Grey values of pixels with so many samples: the first one, or the luminance of three or more.
fn greys<T: Copy + Sync>(samples: &[T], each: usize, value: impl Fn(T) -> f32 + Sync) -> Vec<f32> {
    let grey = |pixel: &[T]| match pixel {
        [r, g, b, ..] => luminance([*r, *g, *b].map(&value)),
        _ => value(pixel[0]),
    };
    samples.par_chunks_exact(each).map(grey).collect()
}

fn of_tiff<R: std::io::Read + Seek>(mut decoder: Decoder<R>) -> Result<GreyImage, String> {
    let (width, height) = decoder.dimensions().map_err(|fault| fault.to_string())?;
    check_size(width, height)?;
    match decoder.colortype() {
        Ok(ColorType::Gray(_)) => of_samples(decoder, 1),
        Ok(ColorType::GrayA(_)) => of_samples(decoder, 2),
        Ok(ColorType::RGB(_)) => of_samples(decoder, 3),
        Ok(ColorType::RGBA(_)) => of_samples(decoder, 4),
        Ok(other) => Err(format!(
            "its colours are {other:?}, where grey or RGB is expected"
        )),
        Err(fault) if is_of_palette(&fault) => {
            let (decoder, greys) = as_grey(&mut decoder)?;
            let mut image = of_samples(decoder, 1)?;
            let grey = |value: f32| greys.get(value as usize).copied().unwrap_or_default();
            image
                .values_mut()
                .iter_mut()
                .for_each(|value| *value = grey(*value));
            Ok(image)
        }
        Err(fault) => Err(fault.to_string()),
    }
}

/// An image of pixels of so many samples each.
fn of_samples<R: std::io::Read + Seek>(
    mut decoder: Decoder<R>,
    each: usize,
) -> Result<GreyImage, String> {
    let (width, height) = decoder.dimensions().map_err(|fault| fault.to_string())?;
    let values = match decoder.read_image().map_err(|fault| fault.to_string())? {
        DecodingResult::U8(samples) => greys(&samples, each, f32::from),
        DecodingResult::U16(samples) => greys(&samples, each, f32::from),
        DecodingResult::F32(samples) => in_grey_values(greys(&samples, each, |value: f32| value)),
        _ => return Err("its samples are neither of 8 nor of 16 bit".to_owned()),
    };
    of_values(width as usize, height as usize, values)
}

/// Fractions of white as grey values of 16 bit, because the variance of rounding is one of whole grey values; others as they are.
fn in_grey_values(values: Vec<f32>) -> Vec<f32> {
    if values.iter().any(|value| *value > FRACTION) {
        return values;
    }
    values.into_iter().map(|value| value * WHITE).collect()
}

/// An image of checked values.
fn of_values(width: usize, height: usize, values: Vec<f32>) -> Result<GreyImage, String> {
    let side = |length: usize| u32::try_from(length).map_err(|fault| fault.to_string());
    check_size(side(width)?, side(height)?)?;
    if values.len() != width * height {
        return Err("its samples are fewer than its pixels".to_owned());
    }
    if values.iter().any(|value| !value.is_finite()) {
        return Err("it has values that are not numbers".to_owned());
    }
    Ok(GreyImage::new(width, height, values))
}

#[cfg(test)]
mod tests;
