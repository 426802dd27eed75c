//! Files that the results are computed from: nothing may replace or remove them, and a later start of the same run is recognised by them.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use crate::document::inputs;
use crate::error::Error;

/// Refuses to write a file over an input of the same command, or over any file that it has read.
///
/// # Errors
/// [`Error::Write`] where the file is one of them, by whatever names both are called.
pub fn refuse_inputs(target: &Path, inputs: &[&Path]) -> Result<(), Error> {
    refuse_input(target, &positions(inputs))
}

/// The absolute paths of the files that exist.
pub fn positions(files: &[&Path]) -> Vec<PathBuf> {
    let files = files.iter();
    files
        .filter_map(|file| fs::canonicalize(file).ok())
        .collect()
}

/// A file as one in `folder` names it.
pub fn relative(path: &Path, folder: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let relative_path =
        pathdiff::diff_paths(absolute(path), absolute(folder)).unwrap_or_else(|| path.to_owned());
    relative_path.to_string_lossy().replace('\\', "/")
}

pub fn refuse_input(target: &Path, given: &[PathBuf]) -> Result<(), Error> {
    let Ok(position) = fs::canonicalize(target) else {
        return Ok(());
    };
    if given.contains(&position) || inputs::read().contains(&position) {
        let cause = "it is an input of this command; choose another place with --output";
        return Err(Error::write(target, cause));
    }
    Ok(())
}

/// The identity of a run: its statement, the contents of all files that it has read, and the program itself.
pub fn identity(statement: &str, files: &[PathBuf], program: Option<&Path>) -> String {
    let mut hasher = DefaultHasher::new();
    statement.hash(&mut hasher);
    for file in files {
        file.hash(&mut hasher);
        // A file that can no longer be read differs from all others.
        fs::read(file).ok().hash(&mut hasher);
    }
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    let program = program.and_then(|program| fs::metadata(program).ok());
    let built = program.and_then(|program| Some((program.len(), program.modified().ok()?)));
    built.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}
