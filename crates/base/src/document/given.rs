//! Files that a program gives in place of those on disk: in a browser there is no disk.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

thread_local! {
    static GIVEN: RefCell<BTreeMap<PathBuf, Vec<u8>>> = const { RefCell::new(BTreeMap::new()) };
}

/// Removes the files again, even after a panic.
struct Taken(BTreeMap<PathBuf, Vec<u8>>);

impl Drop for Taken {
    fn drop(&mut self) {
        GIVEN.set(std::mem::take(&mut self.0));
    }
}

/// Calls a function while this thread reads the files of a list instead of those on disk, by the paths that studies and requests use.
///
/// ```
/// use std::path::{Path, PathBuf};
/// use gelbench::document::with_files;
/// use gelbench::material::Card;
///
/// let card = gelbench::material::registry::CARDS[0].1;
/// let files = [(PathBuf::from("gel.toml"), card.as_bytes().to_vec())];
/// let read = with_files(files, || Card::load("gel.toml", Path::new("")));
/// assert_eq!(read.unwrap().law_name, "marlow-exponential");
/// assert!(Card::load("gel.toml", Path::new("")).is_err());
/// ```
pub fn with_files<T>(
    files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>,
    work: impl FnOnce() -> T,
) -> T {
    let before = GIVEN.replace(files.into_iter().collect());
    let _taken = Taken(before);
    work()
}

/// The bytes of a file that was given.
pub fn given(path: &Path) -> Option<Vec<u8>> {
    let plain = path.strip_prefix(".").unwrap_or(path);
    GIVEN.with_borrow(|files| files.get(plain).cloned())
}
