//! What every target does with an input: the doors of the library, as the command uses them.
//!
//! The targets of the campaign and `tests/all/corpus.rs`, which replays what was found, share this file.

use std::path::Path;

mod choices;
mod data;
mod readers;
mod studies;

/// What became of an input that did no harm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Became {
    /// It was refused with a message.
    Refused,
    /// It was computed up to where there is no solution, and ended with a message.
    Unsolved,
    /// It was read, and computed, to the end.
    Complete,
}

impl From<bool> for Became {
    fn from(complete: bool) -> Self {
        if complete {
            Self::Complete
        } else {
            Self::Refused
        }
    }
}

/// What a target does with its bytes.
pub type Entry = fn(&[u8]) -> Became;

/// The targets, each with what it does with its bytes.
pub const TARGETS: &[(&str, Entry)] = &[
    ("study", readers::study),
    ("card", readers::card),
    ("tables", readers::tables),
    ("formats", readers::formats),
    ("spreadsheet", readers::spreadsheet),
    ("image", readers::image),
    ("markers", readers::markers),
    ("outline", readers::outline),
    ("gmsh", readers::gmsh),
    ("abaqus", readers::abaqus),
    ("vtk", readers::vtk),
    ("vtu", readers::vtu),
    ("pvd", readers::pvd),
    ("frd", readers::frd),
    ("recording", readers::recording),
    ("run", studies::run),
    ("correct", data::correct),
    ("fit", data::fit),
    ("identify", data::identify),
    ("specimen", studies::specimen),
    ("motion", studies::motion),
];

/// Tries an input on a target.
pub fn try_on(target: &str, bytes: &[u8]) -> Became {
    let (_, entry) = TARGETS
        .iter()
        .find(|(name, _)| *name == target)
        .unwrap_or_else(|| panic!("there is no target {target}"));
    entry(bytes)
}

/// Gives bytes as a file with a name to what reads it.
fn with_file<T>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
    let memory = Path::new("/dev/shm");
    let root = if memory.is_dir() {
        memory.to_owned()
    } else {
        std::env::temp_dir()
    };
    let thread: String = format!("{:?}", std::thread::current().id());
    let thread: String = thread.chars().filter(char::is_ascii_digit).collect();
    let folder = root.join(format!("gelbench-fuzz-{}-{thread}", std::process::id()));
    let file = folder.join(name);
    std::fs::create_dir_all(&folder).expect("a folder for inputs");
    std::fs::write(&file, bytes).expect("a file for an input");
    let outcome = read(&file);
    std::fs::remove_dir_all(&folder).expect("the folder is removed");
    outcome
}
