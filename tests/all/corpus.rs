//! What the campaign in `fuzz/` begins with, and what it has found: no input panics, takes long, or is refused by a target that
//! refuses everything.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

#[path = "../../fuzz/src/entries/mod.rs"]
mod entries;

use entries::{Became, TARGETS, try_on};

/// The files of a target in a folder of the campaign.
fn inputs(folder: &str, target: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz")
        .join(folder)
        .join(target);
    let files = fs::read_dir(folder).into_iter().flatten();
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.sort();
    files
}

/// Tries an input, within the time that the campaign allows on a machine that does other work too.
fn tried(target: &str, file: &Path) -> Became {
    const LONGEST: Duration = Duration::from_secs(60);
    let start = Instant::now();
    let became = try_on(target, &fs::read(file).unwrap());
    let took = start.elapsed();
    assert!(took < LONGEST, "{} took {took:?}", file.display());
    became
}

fn replay(target: &str) {
    let seeds = inputs("corpus", target);
    let complete = seeds
        .iter()
        .filter(|file| tried(target, file) == Became::Complete);
    assert!(
        complete.count() > 0,
        "{target} refuses all of its {} seeds",
        seeds.len()
    );
    for file in inputs("regressions", target) {
        tried(target, &file);
    }
}

macro_rules! replays {
    ($($target:ident)*) => {
        $(#[test]
        fn $target() {
            replay(stringify!($target));
        })*

        #[test]
        fn every_target_is_replayed() {
            let targets: Vec<&str> = TARGETS.iter().map(|(name, _)| *name).collect();
            assert_eq!(targets, [$(stringify!($target)),*]);
        }
    };
}

replays! {
    study card tables formats spreadsheet image markers outline gmsh abaqus vtk vtu pvd frd recording run correct fit identify specimen motion
}
