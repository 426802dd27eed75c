//! `gelbench workbench`: starts the workbench, which is a separate program.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::terminal::Outcome;
use gelbench_base::error::Error;

/// The program of the window.
const PROGRAM: &str = "gelbench-workbench";

const INSTALL: &str = "in gelbench's repository, `cargo install --path workbench` installs it, and \
                       `cargo run --release -p gelbench-workbench` starts it without";

/// Opens the workbench with files on its table, and waits until it is closed.
pub fn open(files: &[PathBuf]) -> Outcome {
    let executable = std::env::current_exe().ok();
    let folder = executable.as_deref().and_then(Path::parent);
    let path = std::env::var_os("PATH");
    let program = installed(folder, path.as_deref())
        .ok_or_else(|| Error::input("the workbench is not installed here", INSTALL))?;
    let ended = Command::new(&program).args(files).status();
    let status = ended.map_err(|cause| {
        let message = format!("{} cannot be started: {cause}", program.display());
        Error::input(message, INSTALL)
    })?;
    // A window that a signal has closed has no code.
    Ok(status
        .code()
        .map_or(1, |code| u8::try_from(code).unwrap_or(1)))
}

/// The workbench's program in the folder of this one, else the first one on the path.
fn installed(first: Option<&Path>, path: Option<&OsStr>) -> Option<PathBuf> {
    let name = format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX);
    let on_path = path.into_iter().flat_map(std::env::split_paths);
    let mut folders = first.map(Path::to_owned).into_iter().chain(on_path);
    folders.find_map(|folder| Some(folder.join(&name)).filter(|program| program.is_file()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_beside_this_one_comes_before_those_on_the_path() {
        let folders = [(); 3].map(|()| tempfile::TempDir::new().unwrap());
        let [adjacent, empty, on_path] = folders.each_ref().map(tempfile::TempDir::path);
        let name = format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX);
        let path = std::env::join_paths([empty, on_path]).unwrap();
        assert_eq!(installed(Some(adjacent), Some(&path)), None);
        std::fs::write(on_path.join(&name), "").unwrap();
        assert_eq!(
            installed(Some(adjacent), Some(&path)),
            Some(on_path.join(&name))
        );
        std::fs::write(adjacent.join(&name), "").unwrap();
        assert_eq!(
            installed(Some(adjacent), Some(&path)),
            Some(adjacent.join(&name))
        );
        assert_eq!(installed(None, None), None);
    }
}
