//! The files that a program has read and must not overwrite.
//!
//! A command calls [`remember`] once. A program that does not call it may write anywhere.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static READ: Mutex<Option<Vec<PathBuf>>> = Mutex::new(None);

thread_local! {
    /// The files that this thread has read within [`noted`].
    static NOTED: RefCell<Option<Vec<PathBuf>>> = const { RefCell::new(None) };
}

fn all() -> MutexGuard<'static, Option<Vec<PathBuf>>> {
    READ.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From here on every file that is read as a study, a card, a table, a mesh or a field is remembered.
pub fn remember() {
    all().get_or_insert_default();
}

/// Records that a file is read.
pub fn note(path: &Path) {
    let add = |read: &mut Option<Vec<PathBuf>>| {
        if let (Some(read), Ok(path)) = (read.as_mut(), std::fs::canonicalize(path))
            && !read.contains(&path)
        {
            read.push(path);
        }
    };
    add(&mut all());
    NOTED.with_borrow_mut(add);
}

/// Calls a function, and returns the files that this thread has read meanwhile, by their absolute paths.
pub fn noted<T>(work: impl FnOnce() -> T) -> (T, Vec<PathBuf>) {
    let before = NOTED.replace(Some(Vec::new()));
    let result = work();
    let read = NOTED.replace(before).unwrap_or_default();
    (result, read)
}

/// The files that were read, by their absolute paths, in the order in which they were first read.
pub fn read() -> Vec<PathBuf> {
    all().clone().unwrap_or_default()
}
