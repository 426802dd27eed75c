//! Texts of files, from any editor.

use std::path::Path;

use super::encoding::{TextEncoding, decode, is_utf16};
use super::file;
use crate::error::Error;

/// The text of a file of data in any encoding, or in the `wanted` one; `hint` describes what the file should be.
///
/// # Errors
/// [`Error::Input`] when it is not a text.
pub fn text_of_data(
    path: &Path,
    bytes: &[u8],
    wanted: Option<TextEncoding>,
    hint: &str,
) -> Result<(String, TextEncoding), Error> {
    decode(bytes, wanted).ok_or_else(|| {
        let name = path.display();
        match wanted {
            None => Error::input(format!("{name} is not a text file"), hint),
            Some(wanted) => Error::input(
                format!("{name} is not text encoded in {}", wanted.name()),
                "leave out --encoding, or name the one in which the file was saved",
            ),
        }
    })
}

/// The bytes of a file of so many at most.
///
/// # Errors
/// [`Error::Input`] when it cannot be read.
pub fn bytes(path: &Path, most: u64, hint: &str) -> Result<Vec<u8>, Error> {
    let name = path.display();
    file::read_bytes(path, most)
        .map_err(|cause| Error::input(format!("cannot read {name}: {cause}"), hint))
}

/// The text of a file of so many bytes at most; `hint` describes what it should be.
///
/// # Errors
/// [`Error::Input`] when it cannot be read or is not UTF-8.
pub fn read_text(path: &Path, most: u64, hint: &str) -> Result<String, Error> {
    let name = path.display();
    let bytes = bytes(path, most, hint)?;
    if is_utf16(&bytes) {
        let hint = "save it as UTF-8: in Notepad by Save as, Encoding; in PowerShell by `Out-File -Encoding utf8`";
        return Err(Error::input(format!("{name} is written in UTF-16"), hint));
    }
    let is_text = !bytes.contains(&0);
    String::from_utf8(bytes).map_err(|fault| {
        let before = &fault.as_bytes()[..fault.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        let hint = if is_text {
            format!("save it as UTF-8: an editor may have chosen Latin-1 or Windows-1252; {hint}")
        } else {
            hint.to_owned()
        };
        Error::input(format!("{name}: line {line} is not UTF-8 text"), hint)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(bytes: &[u8]) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        std::fs::write(&path, bytes).unwrap();
        read_text(&path, 999, "a study").unwrap_err().to_string()
    }

    #[test]
    fn other_encodings_are_told_with_how_to_save_the_file() {
        let text = "title = \"plate\"\nkind = \"plate\"\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let marked = [b"\xff\xfe", &*little].concat();
        for bytes in [&little, &big, &marked] {
            let message = message(bytes);
            assert!(
                message.contains("UTF-16") && message.contains("save it as UTF-8"),
                "{message}"
            );
        }
        let latin = message(b"kind = \"plate\"\ntitle = \"Gr\xfc\xdfe\"\n");
        assert!(
            latin.contains("line 2 is not UTF-8") && latin.contains("Latin-1"),
            "{latin}"
        );
        assert!(!message(b"\x7fELF\0\0\0\xff\xfe\xf0").contains("Latin-1"));
    }
}
