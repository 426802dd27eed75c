//! Which files a program has read: it must not write over them.
//!
//! A command calls [`remember`] once. A program of your own that does not is free to write wherever it wants.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static READ: Mutex<Option<Vec<PathBuf>>> = Mutex::new(None);

fn all() -> MutexGuard<'static, Option<Vec<PathBuf>>> {
    READ.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From here on every file that is read as a study, a card, a table, a mesh or a field is remembered.
pub fn remember() {
    all().get_or_insert_default();
}

/// Notes that a file is read.
pub fn note(path: &Path) {
    if let (Some(read), Ok(path)) = (all().as_mut(), std::fs::canonicalize(path))
        && !read.contains(&path)
    {
        read.push(path);
    }
}

/// The files that were read, by their whole paths, in the order in which they were first read.
pub fn read() -> Vec<PathBuf> {
    all().clone().unwrap_or_default()
}
