//! A set of results that is not in place yet, and what becomes of it when its run is broken off.

use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::manifest::MANIFEST;
use crate::error::Error;

/// Where a partial folder notes which parts of the work are done.
pub const PARTS: &str = ".parts";

/// A set of results that is not in place yet.
#[derive(Debug)]
pub struct Unfinished {
    /// The folder of the results.
    pub folder: PathBuf,
    /// The folder where the files are before they are in place.
    pub partial: PathBuf,
    stage: Mutex<Stage>,
}

/// How far a set of results is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// Files are written aside.
    Growing,
    /// The files are in place, or the next run moves them there.
    InPlace,
    /// Nothing more is written.
    BrokenOff,
}

/// What remains of a run that was broken off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remains {
    /// Nothing.
    Nothing,
    /// Parts from which a later start goes on.
    Parts,
    /// All of its results.
    Results,
}

/// A run that was broken off: nobody writes into its folder while this is held, nor later.
#[derive(Debug)]
pub struct BrokenOff<'a> {
    /// What remains of it.
    pub remains: Remains,
    _writers_wait: MutexGuard<'a, Stage>,
}

impl Unfinished {
    /// Of a folder, with the files in `partial`.
    pub fn new(folder: PathBuf, partial: PathBuf) -> Self {
        Self {
            folder,
            partial,
            stage: Mutex::new(Stage::Growing),
        }
    }

    /// Permission to write into it: nobody breaks it off while it is held.
    ///
    /// # Errors
    /// [`Error::Write`] when it was broken off.
    pub(super) fn growing(&self) -> Result<MutexGuard<'_, Stage>, Error> {
        let stage = self.stage();
        match *stage {
            Stage::BrokenOff => Err(Error::write(&self.folder, "the run was interrupted")),
            _ => Ok(stage),
        }
    }

    fn stage(&self) -> MutexGuard<'_, Stage> {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Removes it, and its folder where nothing was written into it.
    pub fn discard(&self) {
        self.take_away(&mut self.stage());
    }

    fn take_away(&self, stage: &mut Stage) {
        if *stage == Stage::Growing {
            let _ = fs::remove_dir_all(&self.partial);
            *stage = Stage::BrokenOff;
        }
        let manifest = self.folder.join(MANIFEST);
        let empty = manifest.metadata().is_ok_and(|file| file.len() == 0);
        if empty {
            let _ = fs::remove_file(manifest);
        }
        // It stays where it holds anything.
        let _ = fs::remove_dir(&self.folder);
    }

    /// Removes it, unless it is in place or a later start can go on from it.
    pub fn break_off(&self) -> BrokenOff<'_> {
        let mut stage = self.stage();
        let remains = match *stage {
            Stage::InPlace => Remains::Results,
            _ if self.partial.join(PARTS).is_dir() => Remains::Parts,
            _ => Remains::Nothing,
        };
        match remains {
            Remains::Results => {}
            Remains::Parts => *stage = Stage::BrokenOff,
            Remains::Nothing => self.take_away(&mut stage),
        }
        BrokenOff {
            remains,
            _writers_wait: stage,
        }
    }
}
