//! A folder of results: written aside first, then moved into place.
//!
//! ```text
//! open      the folder is created and locked, and the unfinished files of a killed run are removed
//! add       a file is written into a folder for unfinished files, apart from the former results
//! finish    all files are moved into place; what the run before has written and this one has not is removed
//! ```
//!
//! A run that is killed while it moves its files is finished by the next one. Work in parts can be resumed: `keep` notes what
//! is done, and `resume` opens what a run with the same identity has left.
//!
//! `.gelbench-manifest.json` lists what gelbench has written into a folder, and which command wrote it. Nothing else is
//! ever removed or replaced: a file that is in the way is kept under another name. It is also what a run locks, and it says
//! whether the set of files is complete: between the first file that is moved and the last one it is not.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::{Diagnostic, Error};

mod inputs;
mod manifest;
mod unfinished;

pub use inputs::{identity, refuse_inputs, relative};
use inputs::{positions, refuse_input};
use manifest::{Locked, Manifest, Moving, PARTIAL, is_inside};
pub use unfinished::{BrokenOff, Remains, Unfinished};
use unfinished::{PARTS, Stage};

/// What to do where results would be replaced.
pub const ANOTHER_FOLDER: &str = "name another folder for results with --output";

/// A folder that is being written into.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
    writer: String,
    /// The files that the results follow from, which they must not replace.
    inputs: Vec<PathBuf>,
    manifest: Locked,
    before: Manifest,
    /// The first of the inputs, relative to the folder.
    source: Option<String>,
    unfinished: Arc<Unfinished>,
    names: Vec<String>,
    /// How many of the names belong to parts of the work that are kept.
    kept: usize,
    /// How many of the names were compared with the files that are there already.
    looked_at: usize,
}

impl AsRef<Self> for ResultFolder {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl ResultFolder {
    /// Makes and locks a folder for results of the command `writer`, such as `run`, that follow from `inputs`.
    ///
    /// # Errors
    /// [`Error::Write`] when the folder cannot be made or does not take files, when another process is writing
    /// into it, or when an input is a result that the same command has written into it and would replace.
    pub fn open(path: &Path, writer: &str, inputs: &[&Path]) -> Result<Self, Error> {
        Self::begin(path, writer, inputs, None)
    }

    /// Opens the folder as [`ResultFolder::open`] does, beginning with what a run of the same `identity` has kept when it was broken
    /// off. The identity follows from everything that the results follow from, and is part of a file's name.
    ///
    /// # Errors
    /// As [`ResultFolder::open`].
    pub fn resume(
        path: &Path,
        writer: &str,
        inputs: &[&Path],
        identity: &str,
    ) -> Result<Self, Error> {
        Self::begin(path, writer, inputs, Some(identity))
    }

    fn begin(
        path: &Path,
        writer: &str,
        inputs: &[&Path],
        identity: Option<&str>,
    ) -> Result<Self, Error> {
        let fault = |cause: std::io::Error| Error::write(path, cause);
        refuse_file(path)?;
        fs::create_dir_all(path).map_err(fault)?;
        let mut manifest = Locked::open(path)?;
        let inputs = positions(inputs);
        let mut before = manifest.read();
        if let Some(moving) = before.moving.take_if(|moving| moving.is_sound()) {
            moving.settle(path, &inputs)?;
            moving.forget_stale(&mut before.files);
            manifest.write(&before)?;
        }
        let source = inputs
            .first()
            .map(|input| relative(input, &absolute_path(path)));
        let kept = identity.map(|identity| format!("{PARTIAL}{identity}"));
        sweep(path, kept.as_deref());
        for folder in folders(path, &before) {
            let writable = tempfile::tempfile_in(&folder);
            writable.map_err(|cause| Error::write(&folder, cause))?;
        }
        let previous = before.files.iter().filter(|(_, by)| *by == writer);
        for (name, _) in previous.filter(|(name, _)| is_inside(name)) {
            refuse_input(&path.join(name), &inputs)?;
        }
        let partial = match kept {
            Some(name) => {
                let partial = path.join(name);
                fs::create_dir_all(&partial).map_err(fault)?;
                partial
            }
            None => {
                let mut builder = tempfile::Builder::new();
                let temporary = builder.prefix(PARTIAL).tempdir_in(path).map_err(fault)?;
                temporary.keep()
            }
        };
        Ok(Self {
            path: path.to_owned(),
            writer: writer.to_owned(),
            inputs,
            manifest,
            before,
            source,
            unfinished: Arc::new(Unfinished::new(path.to_owned(), partial)),
            names: Vec::new(),
            kept: 0,
            looked_at: 0,
        })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A warning where the folder holds what the same command found from another file, which is still there.
    pub fn replaces(&self) -> Option<Diagnostic> {
        let source = self.before.sources.get(&self.writer)?;
        let other = fs::canonicalize(self.path.join(source)).ok()?;
        (!self.inputs.contains(&other)).then(|| {
            let here = std::env::current_dir().and_then(fs::canonicalize);
            let shown = here.ok().and_then(|here| other.strip_prefix(here).ok());
            let message = format!(
                "{} contains the results of {}: they are replaced",
                self.path.display(),
                shown.unwrap_or(&other).display()
            );
            Diagnostic::warning("", message).hint(ANOTHER_FOLDER)
        })
    }

    /// What is not in place yet, for those who must break the run off.
    pub fn unfinished(&self) -> Arc<Unfinished> {
        Arc::clone(&self.unfinished)
    }

    /// Writes a file aside; `name` is relative to the folder, with `/` between its parts. A file of that name that gelbench has not
    /// written will be kept under another one.
    ///
    /// # Errors
    /// [`Error::Write`] when it would replace an input, or when it cannot be written.
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Error> {
        refuse_input(&self.path.join(name), &self.inputs)?;
        self.write_aside(name, bytes)?;
        self.names.push(name.to_owned());
        Ok(())
    }

    /// A warning for each file that is somebody else's and in the way of one that was added since the last time.
    pub fn in_the_way(&mut self) -> Vec<Diagnostic> {
        let new = &self.names[self.looked_at..];
        let warnings =
            unlisted_files(&self.path, new, &self.before).map(|position| kept(&position));
        let others = self.of_another_command(new);
        let warnings = warnings.chain(others).collect();
        self.looked_at = self.names.len();
        warnings
    }

    /// A warning where some files are those that another command has written.
    fn of_another_command(&self, names: &[String]) -> Option<Diagnostic> {
        let writer = |name: &String| self.before.files.get(name);
        let others = names.iter().filter_map(|name| Some((name, writer(name)?)));
        let others: Vec<_> = others.filter(|(_, by)| **by != self.writer).collect();
        let (name, by) = others.first()?;
        let rest = match others.len() {
            1 => String::new(),
            count => format!(" and {} more", count - 1),
        };
        let position = self.path.join(name);
        let message = format!(
            "{}{rest} of `gelbench {by}` are replaced",
            position.display()
        );
        Some(Diagnostic::warning("", message).hint(ANOTHER_FOLDER))
    }

    /// Notes that a part of the work is done: the files that were added since the part before belong to it, and a later
    /// start gets its `record` from [`ResultFolder::kept`].
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn keep(&mut self, part: &str, record: &impl Serialize) -> Result<(), Error> {
        let files = &self.names[self.kept..];
        let fault = |cause: postcard::Error| Error::write(&self.path, cause);
        let note = postcard::to_allocvec(&(files, record)).map_err(fault)?;
        let name = format!("{PARTS}/{part}");
        let written = self.write_aside(&format!("{name}.new"), &note)?;
        let position = self.unfinished.partial.join(&name);
        fs::rename(written, &position).map_err(|cause| Error::write(position, cause))?;
        self.kept = self.names.len();
        Ok(())
    }

    /// The record of a part of the work that is done already; its files are among those of this run then.
    pub fn kept<T: DeserializeOwned>(&mut self, part: &str) -> Option<T> {
        let partial = &self.unfinished.partial;
        let note = fs::read(partial.join(PARTS).join(part)).ok()?;
        let (files, record): (Vec<String>, T) = postcard::from_bytes(&note).ok()?;
        if !files.iter().all(|name| partial.join(name).is_file()) {
            return None;
        }
        self.names.extend(files);
        self.kept = self.names.len();
        Some(record)
    }

    fn write_aside(&self, name: &str, bytes: &[u8]) -> Result<PathBuf, Error> {
        let target = self.path.join(name);
        let fault = |cause: std::io::Error| Error::write(&target, cause);
        let aside = self.unfinished.partial.join(name);
        let folder = aside.parent().unwrap_or(&self.path);
        // Nobody who breaks the run off takes the folder away in the middle of a file, or finds one written afterwards.
        let _growing = self.unfinished.growing()?;
        // The folder may have been removed while the results were computed.
        fs::create_dir_all(folder).map_err(fault)?;
        let mut file = File::create(&aside).map_err(fault)?;
        file.write_all(bytes).map_err(fault)?;
        file.sync_all().map_err(fault)?;
        Ok(aside)
    }

    /// Moves all files into place and removes those that the same command has written before and has not now. Returns the
    /// files in the order in which they were added.
    ///
    /// # Errors
    /// [`Error::Write`] with the file that could not be moved, removed or written.
    pub fn finish(mut self) -> Result<Vec<PathBuf>, Error> {
        let names = self.names.iter().cloned();
        let new: BTreeMap<String, String> = names.map(|name| (name, self.writer.clone())).collect();
        let in_the_way: BTreeSet<PathBuf> =
            unlisted_files(&self.path, &self.names, &self.before).collect();
        let mut manifest = std::mem::take(&mut self.before);
        let files = &mut manifest.files;
        let ours = |(name, writer): (&String, &String)| {
            (*writer == self.writer && !new.contains_key(name)).then(|| name.clone())
        };
        let stale: Vec<String> = files.iter().filter_map(ours).collect();
        let unfinished = self.unfinished();
        let partial = &unfinished.partial;
        if let Some(lost) = self.names.iter().find(|name| !partial.join(name).exists()) {
            let cause = "it was written to a temporary folder and removed before it could be moved into place";
            return Err(Error::write(self.path.join(lost), cause));
        }
        files.extend(new);
        if let Some(source) = self.source.take() {
            manifest.sources.insert(self.writer.clone(), source);
        }
        let from = partial.file_name().unwrap_or_default().to_string_lossy();
        let moving = Moving {
            from: from.into_owned(),
            files: std::mem::take(&mut self.names),
            stale,
        };
        // Nobody who breaks the run off does so between the first file and the last.
        let mut stage = unfinished.growing()?;
        for position in in_the_way {
            fs::rename(&position, free_name(&position))
                .map_err(|cause| Error::write(&position, cause))?;
        }
        manifest.moving = Some(moving.clone());
        self.manifest.write(&manifest)?;
        // From here on the next run could finish it.
        *stage = Stage::InPlace;
        let written = moving.settle(&self.path, &self.inputs)?;
        manifest.moving = None;
        moving.forget_stale(&mut manifest.files);
        self.manifest.write(&manifest)?;
        let _ = fs::remove_dir_all(partial);
        Ok(written)
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        self.unfinished.discard();
    }
}

/// Refuses a folder for results that is a file, or whose path leads through one.
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

/// The files in the places of some names that gelbench has not written.
fn unlisted_files<'a>(
    path: &'a Path,
    names: &'a [String],
    before: &'a Manifest,
) -> impl Iterator<Item = PathBuf> + 'a {
    let others = names
        .iter()
        .filter(|name| !before.files.contains_key(*name));
    let positions = others.map(|name| path.join(name));
    positions.filter(|position| position.is_file())
}

/// The warning that a file is kept under another name.
pub fn kept(position: &Path) -> Diagnostic {
    let message = format!(
        "{} existed and was not written by gelbench: it is kept as {}",
        position.display(),
        free_name(position).display()
    );
    Diagnostic::warning("", message).hint("name another place for results with --output")
}

/// A name like that of a file which no file has: `report.md.kept`, `report.md.kept-2` and so on.
pub fn free_name(path: &Path) -> PathBuf {
    let name = |number: usize| {
        let mut name = path.as_os_str().to_owned();
        name.push(".kept");
        if number > 1 {
            name.push(format!("-{number}"));
        }
        PathBuf::from(name)
    };
    let mut names = (1..).map(name);
    names.find(|name| !name.exists()).expect("a free name")
}

/// The path of a folder without links.
fn absolute_path(folder: &Path) -> PathBuf {
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
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

/// Removes the unfinished files of runs that were killed, except the folder `kept`.
fn sweep(path: &Path, kept: Option<&str>) {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let is_leftover = |name: &str| name.starts_with(PARTIAL) && Some(name) != kept;
    for entry in entries.filter(|entry| is_leftover(&entry.file_name().to_string_lossy())) {
        // What cannot be removed does no harm.
        let _ = fs::remove_dir_all(entry.path());
    }
}

#[cfg(test)]
mod tests;
