//! The identity of a run, by which a later start of the same run is recognised.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// The identity of a run: its statement, the contents of all files that it has read, and the program itself.
pub fn identity(statement: &str, files: &[PathBuf], program: Option<&Path>) -> String {
    let mut hasher = DefaultHasher::new();
    statement.hash(&mut hasher);
    for file in files {
        file.hash(&mut hasher);
        // A file that can no longer be read differs from all others.
        std::fs::read(file).ok().hash(&mut hasher);
    }
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    let program = program.and_then(|program| std::fs::metadata(program).ok());
    let built = program.and_then(|program| Some((program.len(), program.modified().ok()?)));
    built.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}
