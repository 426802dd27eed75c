//! Files that are read whole: regular ones, within a size.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::given::given;
use super::inputs;

/// Bytes of a study, of a card or of conditions at most.
pub const MOST_OF_A_STUDY: u64 = 16 << 20;

/// Bytes of a table, of a mesh or of a field at most.
pub const MOST_OF_DATA: u64 = 2 << 30;

/// Why a file is not read.
#[derive(Debug, thiserror::Error)]
pub enum FileFault {
    /// A pipe, a folder, a device: how much it holds nobody knows.
    #[error("it is no file; save what it gives as a file first")]
    NoFile,
    /// It holds more than belongs into such a file.
    #[error("it has more than {0} MiB, which is too large for what it should be")]
    TooLarge(u64),
    /// What the system says.
    #[error("{0}")]
    Unreadable(#[from] std::io::Error),
}

/// The bytes of a file.
///
/// # Errors
/// A [`FileFault`].
pub fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, FileFault> {
    let limited = |bytes: Vec<u8>| match bytes.len() as u64 > most {
        true => Err(FileFault::TooLarge(most >> 20)),
        false => Ok(bytes),
    };
    if let Some(bytes) = given(path) {
        return limited(bytes);
    }
    // Before it is opened, for opening waits until somebody writes into a pipe.
    let about = std::fs::metadata(path)?;
    if !about.is_file() {
        return Err(FileFault::NoFile);
    }
    inputs::note(path);
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    limited(bytes)
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
            Err(FileFault::NoFile)
        ));
        #[cfg(unix)]
        assert!(matches!(
            read_bytes(Path::new("/dev/zero"), 9),
            Err(FileFault::NoFile)
        ));
    }
}
