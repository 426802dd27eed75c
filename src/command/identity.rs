//! What tells whether a command that was broken off is the same as a later one.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use crate::document::inputs;

/// The identity of a command by what was said to it, the contents of all files that it has read, and the program itself.
pub fn of(said: &str) -> String {
    let mut hasher = DefaultHasher::new();
    said.hash(&mut hasher);
    for file in inputs::read() {
        file.hash(&mut hasher);
        hash_content(&file, &mut hasher);
    }
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    let program = std::env::current_exe().and_then(std::fs::metadata);
    let built = program.and_then(|program| Ok((program.len(), program.modified()?)));
    built.ok().hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

fn hash_content(file: &Path, hasher: &mut DefaultHasher) {
    // A file that can no longer be read differs from all others.
    std::fs::read(file).ok().hash(hasher);
}
