//! Export of files: on the desktop to a path from a dialogue, in the browser as downloads. The results are events.

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod desktop;
#[cfg(not(target_arch = "wasm32"))]
mod recent;

use std::path::{Path, PathBuf};

#[cfg(target_arch = "wasm32")]
pub use browser::Files;
#[cfg(not(target_arch = "wasm32"))]
pub use desktop::{Choice, Choose, Files};
#[cfg(not(target_arch = "wasm32"))]
pub use recent::Recent;

use super::app::Tab;
use crate::logic::outputs::Written;

/// Files to be saved. Those of a document are the document and the files that it names.
pub struct Outgoing {
    /// The files.
    pub written: Written,
    /// The view whose document they are.
    pub document: Option<Tab>,
}

/// What happened to files.
pub enum Event {
    /// One was chosen to be opened.
    Chosen(PathBuf),
    /// Files were written.
    Saved {
        /// What was written, perhaps long after it was given.
        outgoing: Outgoing,
        /// The path of the first file; a download has none.
        path: Option<PathBuf>,
        /// A sentence that says where they are.
        message: String,
    },
    /// Nothing was written, for a reason.
    Failed(String),
}

/// The name of a file without its folders.
pub fn plain(name: &str) -> String {
    name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned()
}

/// A name as a path, where it is an absolute one: names in a browser are not.
pub fn absolute_path(name: &str) -> Option<PathBuf> {
    let path = Path::new(name);
    path.is_absolute().then(|| path.to_owned())
}
