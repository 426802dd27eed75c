//! Fields that are measured in camera images.

use super::request::{MeshSource, Request};
use crate::error::Error;
use crate::markers::{MarkerFiles, read};
use crate::studies::images::{ImageRequest, are_images};

/// The markers of files, or those of images that are followed.
///
/// # Errors
/// As of [`read`] and [`ImageRequest::follow`].
pub fn read_field(request: &Request) -> Result<MarkerFiles, Error> {
    if !are_images(&request.files) {
        return read(&request.files, &request.reading);
    }
    let images = ImageRequest {
        files: &request.files,
        pixel: request.reading.unit,
        settings: &request.images,
        outline: match &request.mesh {
            MeshSource::Outline(path) => Some(path),
            _ => None,
        },
        budget: request.budget,
    };
    Ok(images.follow(&|_| ())?.markers())
}
