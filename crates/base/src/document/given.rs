//! Files in memory that replace those on disk: in a browser there is no disk.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

thread_local! {
    static GIVEN: RefCell<BTreeMap<PathBuf, Vec<u8>>> = const { RefCell::new(BTreeMap::new()) };
}

/// Gives the thread its former files again, even after a panic.
struct Restored(BTreeMap<PathBuf, Vec<u8>>);

impl Drop for Restored {
    fn drop(&mut self) {
        GIVEN.set(std::mem::take(&mut self.0));
    }
}

/// Calls a function while this thread reads the files of a list instead of those on disk, by the paths that studies and requests use.
///
/// ```
/// use std::path::{Path, PathBuf};
/// use gelbench_base::document::{read_text, with_files};
///
/// let files = [(PathBuf::from("gel.toml"), b"law = \"neo-hooke\"".to_vec())];
/// let read = || read_text(Path::new("gel.toml"), 1_000_000, "give a card");
/// assert_eq!(with_files(files, read)?, "law = \"neo-hooke\"");
/// assert!(read().is_err());
/// # Ok::<(), gelbench_base::error::Error>(())
/// ```
pub fn with_files<T>(
    files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>,
    work: impl FnOnce() -> T,
) -> T {
    let before = GIVEN.replace(files.into_iter().collect());
    let _restored = Restored(before);
    work()
}

/// The bytes of a file that was given.
pub fn given(path: &Path) -> Option<Vec<u8>> {
    let plain = path.strip_prefix(".").unwrap_or(path);
    GIVEN.with_borrow(|files| files.get(plain).cloned())
}
