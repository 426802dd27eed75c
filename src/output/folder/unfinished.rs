//! A set of results that is not in place yet, and what becomes of it when its run is broken off.

use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::manifest::MANIFEST;

/// Where a partial folder notes which parts of the work are done.
pub const PARTS: &str = ".parts";

/// A set of results that is not in place yet.
#[derive(Debug)]
pub struct Unfinished {
    /// The folder of the results.
    pub folder: PathBuf,
    /// The folder where the files are before they are in place.
    pub partial: PathBuf,
    settled: Mutex<bool>,
}

impl Unfinished {
    /// Of a folder, with the files in `partial`.
    pub fn new(folder: PathBuf, partial: PathBuf) -> Self {
        Self {
            folder,
            partial,
            settled: Mutex::new(false),
        }
    }

    /// Waits for a set that is being moved into place; true once it is there, or was taken away.
    pub(super) fn settled(&self) -> MutexGuard<'_, bool> {
        self.settled.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes it away, and a folder into which nothing came to be written.
    pub fn discard(&self) {
        let mut settled = self.settled();
        if !*settled {
            let _ = fs::remove_dir_all(&self.partial);
        }
        *settled = true;
        let manifest = self.folder.join(MANIFEST);
        let empty = manifest.metadata().is_ok_and(|file| file.len() == 0);
        if empty {
            let _ = fs::remove_file(manifest);
        }
        // It stays where it holds anything.
        let _ = fs::remove_dir(&self.folder);
    }

    /// Takes it away, unless a later start can go on from it; says whether one can.
    pub fn break_off(&self) -> bool {
        let resumable = !*self.settled() && self.partial.join(PARTS).is_dir();
        if !resumable {
            self.discard();
        }
        resumable
    }
}
