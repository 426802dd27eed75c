//! The files within a ZIP archive.

use std::io::{Cursor, Read};

use super::converted::{Unconvertible, afford};

/// An archive in memory.
pub(super) struct Archive<'a>(zip::ZipArchive<Cursor<&'a [u8]>>);

impl<'a> Archive<'a> {
    /// Reads the directory of an archive.
    ///
    /// # Errors
    /// [`Unconvertible`] where it has none.
    pub fn open(bytes: &'a [u8]) -> Result<Self, Unconvertible> {
        zip::ZipArchive::new(Cursor::new(bytes))
            .map(Self)
            .map_err(|cause| {
                Unconvertible::new(
                    format!("is a damaged archive: {cause}"),
                    "save or download it again",
                )
            })
    }

    /// The names of its files.
    pub fn names(&self) -> Vec<String> {
        let names = self.0.file_names();
        names
            .filter_map(|name| Some(name.ok()?.into_owned()))
            .collect()
    }

    /// Unpacks a file, up to the size that the directory states.
    ///
    /// # Errors
    /// [`Unconvertible`] where there is none of this name, it is damaged, or it is too large.
    pub fn read(&mut self, name: &str) -> Result<Vec<u8>, Unconvertible> {
        let damaged = |cause: String| {
            Unconvertible::new(
                format!("is damaged: {name}: {cause}"),
                "save it again, without a password",
            )
        };
        let file = self
            .0
            .by_name(name)
            .map_err(|cause| damaged(cause.to_string()))?;
        let size = file.size();
        afford(size as f64, 0.0)?;
        let mut bytes = Vec::new();
        file.take(size + 1)
            .read_to_end(&mut bytes)
            .map_err(|cause| damaged(cause.to_string()))?;
        if bytes.len() as u64 == size {
            Ok(bytes)
        } else {
            Err(damaged("its size is not the one stated".to_owned()))
        }
    }
}

/// An archive of some files.
#[cfg(test)]
pub(super) fn stored(files: &[(&str, &str)]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in files {
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(*name, options).unwrap();
        std::io::Write::write_all(&mut archive, text.as_bytes()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}
