//! The list of what was written into a folder of results.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::inputs::refuse_input;
use crate::error::Error;

/// The file of the list.
pub const MANIFEST: &str = ".gelbench-manifest.json";

/// Begin of the names of folders whose files are not in place yet.
pub const PARTIAL: &str = ".gelbench-partial-";

/// What gelbench has written into a folder.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct Manifest {
    /// The version that wrote it.
    pub gelbench: String,
    /// Whether all files are in place.
    pub complete: bool,
    /// What wrote each file; files by their names relative to the folder, with `/` between the parts.
    pub files: BTreeMap<String, String>,
    /// What the results of each command follow from, relative to the folder.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sources: BTreeMap<String, String>,
    /// What is on its way while the files are not all in place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moving: Option<Moving>,
}

/// A complete set of files that is being moved into place.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct Moving {
    /// The folder that they come from.
    pub from: String,
    /// The files, by their names.
    pub files: Vec<String>,
    /// Files of the run before that have no successor.
    pub stale: Vec<String>,
}

impl Moving {
    /// Moves the files that are not in place yet, and then removes the stale ones; returns all that are in place.
    ///
    /// # Errors
    /// [`Error::Write`] with the file that could not be moved or removed.
    pub fn settle(&self, folder: &Path, inputs: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
        let mut placed = Vec::new();
        for name in self.files.iter().filter(|name| is_inside(name)) {
            let (source, target) = (folder.join(&self.from).join(name), folder.join(name));
            let fault = |cause: std::io::Error| Error::write(&target, cause);
            if source.exists() {
                fs::create_dir_all(target.parent().unwrap_or(folder)).map_err(fault)?;
                fs::rename(&source, &target).map_err(fault)?;
            }
            placed.push(target);
        }
        for name in self.stale.iter().filter(|name| is_inside(name)) {
            let target = folder.join(name);
            if target.exists() && refuse_input(&target, inputs).is_ok() {
                fs::remove_file(&target).map_err(|cause| Error::write(&target, cause))?;
            }
        }
        Ok(placed)
    }

    /// Takes the stale files off a list.
    pub fn forget_stale(&self, files: &mut BTreeMap<String, String>) {
        files.retain(|name, _| !self.stale.contains(name));
    }

    /// Whether it comes from a folder that a run has made for it.
    pub fn is_sound(&self) -> bool {
        self.from.starts_with(PARTIAL) && Path::new(&self.from).components().count() == 1
    }
}

/// The manifest of a folder, locked while it is open.
#[derive(Debug)]
pub struct Locked {
    folder: PathBuf,
    file: File,
}

impl Locked {
    /// Opens and locks the manifest of a folder.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be opened, or when another process has it.
    pub fn open(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(MANIFEST);
        let file = File::options()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(|cause| Error::write(&path, cause))?;
        match file.try_lock() {
            // Some file systems know no locks; two runs at once are then the user's own care.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self {
                folder: folder.to_owned(),
                file,
            }),
            Err(TryLockError::WouldBlock) => {
                let cause = "another run is writing into this folder; wait until it ends, or choose another with --output";
                Err(Error::write(folder, cause))
            }
        }
    }

    /// What it lists; nothing where it cannot be read, so that nothing is removed then.
    pub fn read(&self) -> Manifest {
        let mut text = String::new();
        match (&self.file).read_to_string(&mut text) {
            Ok(_) => serde_json::from_str(&text).unwrap_or_default(),
            Err(_) => Manifest::default(),
        }
    }

    /// Writes it; the set is complete where nothing is on its way.
    ///
    /// # Errors
    /// [`Error::Write`] with its path.
    pub fn write(&mut self, manifest: &Manifest) -> Result<(), Error> {
        let manifest = Manifest {
            gelbench: env!("CARGO_PKG_VERSION").to_owned(),
            complete: manifest.moving.is_none(),
            ..manifest.clone()
        };
        let path = self.folder.join(MANIFEST);
        let fault = |cause: std::io::Error| Error::write(&path, cause);
        let mut text =
            serde_json::to_string_pretty(&manifest).map_err(|cause| Error::write(&path, cause))?;
        text.push('\n');
        if !path.exists() {
            // The folder was removed in the meantime.
            fs::create_dir_all(&self.folder).map_err(fault)?;
            self.file = File::create(&path).map_err(fault)?;
        }
        // Blanks over the rest of a longer text, so that the file holds a complete list at every moment.
        let length = text.len();
        let before = self.file.metadata().map_err(fault)?.len() as usize;
        text.extend(std::iter::repeat_n('\n', before.saturating_sub(length)));
        self.file.rewind().map_err(fault)?;
        self.file.write_all(text.as_bytes()).map_err(fault)?;
        self.file.set_len(length as u64).map_err(fault)?;
        self.file.sync_all().map_err(fault)
    }
}

/// Whether a name leads to a file below its folder.
pub fn is_inside(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    parts.all(|part| matches!(part, Component::Normal(_)))
}
