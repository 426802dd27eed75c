//! Files that are read as a whole: regular files up to a size.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::given::given;
use super::inputs;
use crate::error::nearest;

/// Most bytes of a study, of a card or of conditions.
pub const MOST_OF_A_STUDY: u64 = 16 << 20;

/// Most bytes of a table, of a mesh or of a field.
pub const MOST_OF_DATA: u64 = 2 << 30;

/// Why a file is not read.
#[derive(Debug, thiserror::Error)]
pub enum FileFault {
    /// There is no file at this path, but perhaps one with a similar name, which is looked for when the fault is reported.
    #[error("there is no such file{}", suggestion(.0))]
    Missing(PathBuf),
    /// A folder.
    #[error("it is a folder; name a file in it")]
    Folder,
    /// A pipe or a device, whose size is unknown.
    #[error("it is not a regular file; save its output as a file first")]
    NoFile,
    /// The file is larger than such a file may be.
    #[error("it is larger than {0} MiB, the limit for this kind of file")]
    TooLarge(u64),
    /// The fault that the system reports.
    #[error("{0}")]
    Unreadable(#[from] std::io::Error),
}

/// The bytes of a file.
///
/// # Errors
/// A [`FileFault`].
pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, FileFault> {
    let limited = |bytes: Vec<u8>| {
        if bytes.len() as u64 > most {
            Err(FileFault::TooLarge(most >> 20))
        } else {
            Ok(bytes)
        }
    };
    if let Some(bytes) = given(path) {
        return limited(bytes);
    }
    // Before it is opened, for opening waits until somebody writes into a pipe.
    let about = std::fs::metadata(path).map_err(|fault| match fault.kind() {
        ErrorKind::NotFound => FileFault::Missing(path.to_owned()),
        _ => fault.into(),
    })?;
    if about.is_dir() {
        return Err(FileFault::Folder);
    }
    if !about.is_file() {
        return Err(FileFault::NoFile);
    }
    inputs::note(path);
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    limited(bytes)
}

/// The file that the user may have had in mind, as the end of a sentence.
fn suggestion(path: &Path) -> String {
    let named = similar(path).map(|path| format!("; did you mean {}?", path.display()));
    named.unwrap_or_default()
}

/// The file in the same folder with the nearest name: the same with an extension, or one with a wrong letter.
fn similar(path: &Path) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_str()?;
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let names = entries.filter_map(|entry| {
        let entry = entry.ok().filter(|entry| entry.path().is_file())?;
        entry.file_name().into_string().ok()
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    // A study is preferred to a picture of the same name.
    names.sort_by_key(|name| !name.ends_with(".toml"));
    let with_ending = names.iter().find(|name| {
        Path::new(name)
            .file_stem()
            .is_some_and(|stem| stem == wanted)
    });
    let near = || nearest(wanted, names.iter().map(String::as_str));
    let name = with_ending.map(String::as_str).or_else(near)?;
    Some(path.with_file_name(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_a_size_are_read() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "123456").unwrap();
        assert_eq!(read_bytes(&path, 6).unwrap(), b"123456");
        assert!(matches!(read_bytes(&path, 5), Err(FileFault::TooLarge(_))));
        assert!(matches!(
            read_bytes(folder.path(), 9),
            Err(FileFault::Folder)
        ));
        let suggested = |name: &str| match read_bytes(&folder.path().join(name), 9) {
            Err(FileFault::Missing(path)) => similar(&path),
            other => panic!("{other:?}"),
        };
        assert_eq!(suggested("a"), Some(path.clone()));
        assert_eq!(suggested("b.txt"), Some(path.clone()));
        assert_eq!(suggested("other"), None);
        let [picture, study] = ["plate.png", "plate.toml"].map(|name| folder.path().join(name));
        std::fs::write(picture, "").unwrap();
        std::fs::write(&study, "").unwrap();
        assert_eq!(suggested("plate"), Some(study));
        #[cfg(unix)]
        assert!(matches!(
            read_bytes(Path::new("/dev/zero"), 9),
            Err(FileFault::NoFile)
        ));
    }
}
