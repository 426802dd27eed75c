//! What to correct, and how.

use std::path::{Path, PathBuf};

use super::conditions::Conditions;
use super::specimen_file::SpecimenFile;
use crate::budget::Budget;
use crate::error::Error;
use crate::markers::{MarkerFiles, ReadSettings, read};
use crate::mesh::{CellShape, MeshReading};
use crate::studies::images::{ImageRequest, ImageSettings, TrackedImages, are_images};

/// Where the mesh comes from.
#[derive(Clone, Debug)]
pub enum MeshSource {
    /// The mesh of the field, or one inside the outline of the markers.
    Data,
    /// A file with a mesh, and how it is read.
    File(PathBuf, MeshReading),
    /// A table with closed lines.
    Outline(PathBuf),
}

/// What is to be corrected, and how.
#[derive(Clone, Debug)]
pub struct Request {
    /// The files of the field.
    pub files: Vec<PathBuf>,
    /// Units, columns and axes of these files, as far as they are stated.
    pub reading: ReadSettings,
    /// How images are followed, where the files are images.
    pub images: ImageSettings,
    /// Name or path of the material's card.
    pub material: String,
    /// Thickness at rest in mm.
    pub thickness: f64,
    /// The mesh.
    pub mesh: MeshSource,
    /// Size of the cells of a mesh that is made, in mm.
    pub cell_size: Option<f64>,
    /// Their kind.
    pub shape: CellShape,
    /// Whether gaps among the markers are holes of the specimen.
    pub holes: bool,
    /// What is known besides the displacements.
    pub conditions: Conditions,
    /// A testing machine's table with forces of the frames.
    pub forces: Option<PathBuf>,
    /// The memory and the work that it may use.
    pub budget: Budget,
}

impl Request {
    /// Whether the field is measured in images.
    pub(super) fn has_images(&self) -> bool {
        !self.images.in_memory.is_empty() || are_images(&self.files)
    }

    /// The markers of the files; or those of images that are followed, and these images. Each image is reported before it is followed.
    ///
    /// # Errors
    /// As of [`read`] and [`ImageRequest::follow`].
    pub(super) fn read_field(
        &self,
        watch: &dyn Fn(&str),
    ) -> Result<(MarkerFiles, Option<TrackedImages>), Error> {
        if !self.has_images() {
            return Ok((read(&self.files, &self.reading)?, None));
        }
        let images = ImageRequest {
            files: &self.files,
            pixel: self.reading.unit,
            settings: &self.images,
            outline: match &self.mesh {
                MeshSource::Outline(path) => Some(path),
                _ => None,
            },
            budget: self.budget,
        };
        let tracked = images.follow(watch)?;
        Ok((tracked.markers(), Some(tracked)))
    }
}

impl SpecimenFile {
    /// A request like another one, for this specimen; paths are relative to `folder`.
    pub fn request(&self, folder: &Path, conditions: Conditions, like: &Request) -> Request {
        let at = |path: &PathBuf| folder.join(path);
        let mut reading = like.reading.clone();
        reading.unit = self.unit.or(reading.unit);
        Request {
            files: self.fields.iter().map(at).collect(),
            reading,
            thickness: self.thickness,
            mesh: match (&self.mesh, &self.outline) {
                (Some((mesh, unit)), _) => MeshSource::File(at(mesh), MeshReading::in_unit(*unit)),
                (None, Some(outline)) => MeshSource::Outline(at(outline)),
                (None, None) => MeshSource::Data,
            },
            cell_size: self.cell_size.or(like.cell_size),
            conditions,
            forces: self.forces.as_ref().map(at),
            ..like.clone()
        }
    }
}
