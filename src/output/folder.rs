//! A folder of results: written aside first, then moved into place.
//!
//! ```text
//! open      the folder is made, locked and swept of what a killed run has left
//! add       a file is written into a folder of its own beside the results that are there
//! finish    all files are moved into place; what the run before has written and this one has not is removed
//! ```
//!
//! `.gelbench-manifest.json` lists what gelbench has written into a folder, and which command wrote it. Nothing else is
//! ever removed. It is also what a run locks, and it says whether the set of files is complete: between the first file that
//! is moved and the last one it is not.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use crate::error::Error;

/// The list of what was written into a folder.
const MANIFEST: &str = ".gelbench-manifest.json";

/// Begin of the names of folders whose files are not in place yet.
const PARTIAL: &str = ".gelbench-partial-";

/// What gelbench has written into a folder.
#[derive(Debug, Default, Deserialize, Serialize)]
struct Manifest {
    /// The version that wrote it.
    gelbench: String,
    /// Whether all files are in place.
    complete: bool,
    /// What wrote each file; files by their names relative to the folder, with `/` between the parts.
    files: BTreeMap<String, String>,
}

/// A folder that is being written into.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
    writer: String,
    /// The files that the results follow from, which they must not replace.
    inputs: Vec<PathBuf>,
    manifest: File,
    before: Manifest,
    partial: Option<TempDir>,
    names: Vec<String>,
}

impl ResultFolder {
    /// Makes and locks a folder for results of the command `writer`, such as `run`, that follow from `inputs`.
    ///
    /// # Errors
    /// [`Error::Write`] when the folder cannot be made or does not take files, or when another process is writing
    /// into it.
    pub fn open(path: &Path, writer: &str, inputs: &[&Path]) -> Result<Self, Error> {
        let fault = |cause: std::io::Error| Error::write(path, cause);
        refuse_file(path)?;
        fs::create_dir_all(path).map_err(fault)?;
        let file = path.join(MANIFEST);
        let mut options = File::options();
        let options = options.read(true).write(true).create(true).truncate(false);
        let manifest = options
            .open(&file)
            .map_err(|cause| Error::write(&file, cause))?;
        match manifest.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let cause = "another run is writing into this folder; wait for its end, or choose another with --output";
                return Err(Error::write(path, cause));
            }
            // Some file systems know no locks; two runs at once are then the user's own care.
            Err(TryLockError::Error(_)) => {}
        }
        let before = read_manifest(&manifest);
        sweep(path);
        for folder in folders(path, &before) {
            let writable = tempfile::tempfile_in(&folder);
            writable.map_err(|cause| Error::write(&folder, cause))?;
        }
        let mut builder = tempfile::Builder::new();
        let partial = builder.prefix(PARTIAL).tempdir_in(path).map_err(fault)?;
        Ok(Self {
            path: path.to_owned(),
            writer: writer.to_owned(),
            inputs: places(inputs),
            manifest,
            before,
            partial: Some(partial),
            names: Vec::new(),
        })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file aside; `name` is relative to the folder, with `/` between its parts.
    ///
    /// # Errors
    /// [`Error::Write`] when it would replace an input, or when it cannot be written.
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        let target = self.path.join(name);
        refuse_input(&target, &self.inputs)?;
        let fault = |cause: std::io::Error| Error::write(&target, cause);
        let aside = self.aside().join(name);
        let folder = aside.parent().unwrap_or(&self.path);
        // The folder may have been taken away while the results were computed.
        fs::create_dir_all(folder).map_err(fault)?;
        let mut file = File::create(&aside).map_err(fault)?;
        file.write_all(bytes).map_err(fault)?;
        file.sync_all().map_err(fault)?;
        self.names.push(name.to_owned());
        Ok(())
    }

    /// Moves all files into place and removes those that the same command has written before and has not now. Returns the
    /// files in the order in which they were added.
    ///
    /// # Errors
    /// [`Error::Write`] with the file that could not be moved, removed or written.
    pub fn finish(mut self) -> Result<Vec<PathBuf>, Error> {
        let own = self.names.iter().cloned();
        let new: BTreeMap<String, String> = own.map(|name| (name, self.writer.clone())).collect();
        let mut files = std::mem::take(&mut self.before.files);
        let ours = |(name, writer): (&String, &String)| {
            (*writer == self.writer && !new.contains_key(name)).then(|| name.clone())
        };
        let stale: Vec<String> = files.iter().filter_map(ours).collect();
        files.extend(new);
        self.note(false, &files)?;
        let mut written = Vec::new();
        for name in &self.names {
            let target = self.path.join(name);
            let fault = |cause: std::io::Error| Error::write(&target, cause);
            fs::create_dir_all(target.parent().unwrap_or(&self.path)).map_err(fault)?;
            fs::rename(self.aside().join(name), &target).map_err(fault)?;
            written.push(target);
        }
        for name in stale {
            let target = self.path.join(&name);
            let removable = is_inside(&name) && refuse_input(&target, &self.inputs).is_ok();
            if removable && target.exists() {
                fs::remove_file(&target).map_err(|cause| Error::write(&target, cause))?;
            }
            files.remove(&name);
        }
        self.note(true, &files)?;
        Ok(written)
    }

    /// Where the files are before they are in place.
    fn aside(&self) -> &Path {
        self.partial
            .as_ref()
            .map_or(&self.path, |folder| folder.path())
    }

    /// Writes the manifest.
    fn note(&mut self, complete: bool, files: &BTreeMap<String, String>) -> Result<(), Error> {
        let manifest = Manifest {
            gelbench: env!("CARGO_PKG_VERSION").to_owned(),
            complete,
            files: files.clone(),
        };
        let file = self.path.join(MANIFEST);
        let fault = |cause: std::io::Error| Error::write(&file, cause);
        let mut text =
            serde_json::to_string_pretty(&manifest).map_err(|cause| Error::write(&file, cause))?;
        text.push('\n');
        if !file.exists() {
            // The folder was taken away and is made anew.
            fs::create_dir_all(&self.path).map_err(fault)?;
            self.manifest = File::create(&file).map_err(fault)?;
        }
        self.manifest.set_len(0).map_err(fault)?;
        self.manifest.rewind().map_err(fault)?;
        self.manifest.write_all(text.as_bytes()).map_err(fault)?;
        self.manifest.sync_all().map_err(fault)
    }
}

impl Drop for ResultFolder {
    /// Takes away what is not in place, and a folder into which nothing came to be written.
    fn drop(&mut self) {
        drop(self.partial.take());
        let empty = self.manifest.metadata().is_ok_and(|file| file.len() == 0);
        if empty {
            let _ = fs::remove_file(self.path.join(MANIFEST));
        }
        // It stays where it holds anything.
        let _ = fs::remove_dir(&self.path);
    }
}

/// Refuses a folder for results that is a file, or lies in one.
///
/// # Errors
/// [`Error::Write`] with the file that is in the way.
pub fn refuse_file(folder: &Path) -> Result<(), Error> {
    match folder.ancestors().find(|part| part.is_file()) {
        None => Ok(()),
        Some(file) => {
            let cause = format!(
                "{} is a file, and results go into a folder; name another with --output",
                file.display()
            );
            Err(Error::write(folder, cause))
        }
    }
}

/// Refuses to write a file over an input of the same command.
///
/// # Errors
/// [`Error::Write`] where the file is one of the inputs, by whatever names both are called.
pub fn refuse_inputs(target: &Path, inputs: &[&Path]) -> Result<(), Error> {
    refuse_input(target, &places(inputs))
}

fn places(inputs: &[&Path]) -> Vec<PathBuf> {
    let inputs = inputs.iter();
    inputs
        .filter_map(|input| fs::canonicalize(input).ok())
        .collect()
}

fn refuse_input(target: &Path, inputs: &[PathBuf]) -> Result<(), Error> {
    let same = fs::canonicalize(target).is_ok_and(|target| inputs.contains(&target));
    if same {
        let cause = "it is an input of this command; choose another place with --output";
        return Err(Error::write(target, cause));
    }
    Ok(())
}

/// What a manifest lists; nothing where it cannot be read, so that nothing is removed then.
fn read_manifest(mut file: &File) -> Manifest {
    let mut text = String::new();
    match file.read_to_string(&mut text) {
        Ok(_) => serde_json::from_str(&text).unwrap_or_default(),
        Err(_) => Manifest::default(),
    }
}

/// Whether a name leads to a file below its folder.
fn is_inside(name: &str) -> bool {
    use std::path::Component;
    let mut parts = Path::new(name).components();
    parts.all(|part| matches!(part, Component::Normal(_)))
}

/// The folder and those below it that hold files of the run before.
fn folders(path: &Path, before: &Manifest) -> BTreeSet<PathBuf> {
    let inside = before.files.keys().filter(|name| is_inside(name));
    let parents = inside.filter_map(|name| Some(path.join(name).parent()?.to_owned()));
    parents
        .chain([path.to_owned(), path.join("vtk")])
        .filter(|folder| folder.is_dir())
        .collect()
}

/// Removes what runs that were killed have left.
fn sweep(path: &Path) {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let left = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(PARTIAL));
    for entry in left {
        // What cannot be removed does no harm.
        let _ = fs::remove_dir_all(entry.path());
    }
}

#[cfg(test)]
mod tests;
