//! Files that nobody would drop: the corpora of the readers' fuzzing, under every ending. Whatever they hold, they are taken or
//! a fault is told, in time and without a panic.

use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use eframe::egui::Key;
use gelbench_workbench::logic::background::Worker;
use gelbench_workbench::logic::field::{FieldCorrector, FieldQuestion};
use gelbench_workbench::logic::kind::Kind;
use gelbench_workbench::logic::material::{self, TestFile};
use gelbench_workbench::logic::scene::{CardFile, Model, Scene};
use gelbench_workbench::logic::table::{Action, Table};
use gelbench_workbench::views::app::Tab;

mod common;
use common::{small, state, state_mut, until, window};

/// What a file may be called, besides its own name.
const ENDINGS: [&str; 8] = ["toml", "csv", "txt", "vtu", "vtk", "pvd", "msh", "frd"];

/// How long one file may take until it is shown or its fault is told.
const PATIENCE: Duration = Duration::from_secs(20);

fn files_in(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        match entry.path() {
            path if path.is_dir() => files_in(&path, paths),
            path => paths.push(path),
        }
    }
}

/// The files of all corpora.
fn corpora() -> Vec<(PathBuf, Vec<u8>)> {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
    let mut paths = Vec::new();
    for folder in ["corpus", "regressions"] {
        files_in(&fuzz.join(folder), &mut paths);
    }
    assert!(paths.len() > 100, "{}", paths.len());
    let read = paths.into_iter().map(|path| {
        let content = std::fs::read(&path).unwrap();
        (path, content)
    });
    read.collect()
}

fn field(name: &str, content: &[u8]) -> FieldQuestion {
    let card = CardFile::shipped("pva-10").unwrap();
    FieldQuestion::of(vec![(name.to_owned(), content.to_vec())], card)
}

/// What is done with a file before anything is asked of it; whether it could be understood.
fn take(name: &str, content: &[u8]) -> bool {
    let text = std::str::from_utf8(content).ok().map(str::to_owned);
    match (Kind::of(name, text.as_deref()), text) {
        (Kind::Field, _) => FieldCorrector.answer(&field(name, content)).is_ok(),
        (Kind::Test, Some(text)) => {
            let file = TestFile {
                name: name.to_owned(),
                text,
            };
            material::read(&[file], &Default::default()).is_ok()
        }
        (Kind::Sheet, Some(text)) => {
            let mut table = Table::new(Scene::default());
            table.act(Action::Open {
                file: name.to_owned(),
                text,
            });
            table.message().is_none() && table.meshes().is_ok()
        }
        _ => true,
    }
}

#[test]
fn every_file_is_understood_or_refused_in_time_under_every_ending() {
    let mut slowest = (Duration::ZERO, String::new());
    let mut understood = 0;
    for (path, content) in corpora() {
        let file_name = path.file_name().unwrap().to_string_lossy().into_owned();
        let names = ENDINGS.map(|ending| format!("dropped.{ending}"));
        for name in names.into_iter().chain([file_name]) {
            let (done, ended) = channel();
            let (file, bytes) = (name.clone(), content.clone());
            let begun = Instant::now();
            std::thread::spawn(move || done.send(take(&file, &bytes)));
            let answer = ended.recv_timeout(PATIENCE);
            let took = begun.elapsed();
            match answer {
                Ok(read) => understood += usize::from(read),
                Err(cause) => panic!("{} as {name}: {cause} after {took:?}", path.display()),
            }
            if took > slowest.0 {
                slowest = (took, format!("{} as {name}", path.display()));
            }
        }
    }
    println!("{understood} understood; the slowest: {slowest:?}");
    assert!(understood > 100, "{understood}");
}

#[test]
fn the_window_goes_on_whatever_is_dropped_on_it() {
    let mut bench = window([1000.0, 700.0], small());
    for (path, content) in corpora() {
        let name = path.display().to_string();
        for name in [name.clone(), format!("{name}.csv"), format!("{name}.toml")] {
            state_mut(&mut bench).open(&name, &content);
            bench.step();
            bench.key_press(Key::Escape);
            bench.step();
        }
    }
    // A study that is dropped then is solved as ever.
    let text = small().study();
    state_mut(&mut bench).open("small.toml", text.as_bytes());
    bench.step();
    assert_eq!(state(&bench).tab, Tab::Sheet);
    until(&mut bench, |bench| bench.table.is_settled());
    assert!(state(&bench).table.shown(Model::Corrected).is_some());
}
