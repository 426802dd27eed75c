//! Fields that are measured in camera images.

use super::request::{MeshSource, Request};
use crate::error::Error;
use crate::markers::{MarkerFiles, read};
use crate::studies::images::{ImageRequest, TrackedImages};

/// The markers of files; or those of images that are followed, and these images. Each image is reported before it is followed.
///
/// # Errors
/// As of [`read`] and [`ImageRequest::follow`].
pub fn read_field(
    request: &Request,
    watch: &dyn Fn(&str),
) -> Result<(MarkerFiles, Option<TrackedImages>), Error> {
    if !request.has_images() {
        return Ok((read(&request.files, &request.reading)?, None));
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
    let tracked = images.follow(watch)?;
    Ok((tracked.markers(), Some(tracked)))
}
