//! The command as a process that is broken off, and what it leaves in a folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

#[cfg(unix)]
pub use nix::sys::signal::Signal;
use serde_json::Value;
use tempfile::TempDir;

pub const MANIFEST: &str = ".gelbench-manifest.json";
pub const PARTIAL: &str = ".gelbench-partial-";

/// A plate that is computed at once, at some stretches.
pub fn study(stretches: &str) -> String {
    format!(
        "[plate]\nlength = \"30 mm\"\nwidth = \"10 mm\"\ncells = [6, 2]\n[material]\ncard = \"neo-hooke\"\n[load]\n\
         stretches = [{stretches}]\n[finite_element]\ncells = [4, 4]\n[output]\nplots = false\n"
    )
}

/// Frames of a pulled strip, three markers across.
pub fn markers(frames: usize) -> String {
    let mut text = String::from("frame,x [mm],y [mm],ux [mm],uy [mm]\n");
    for frame in 1..=frames {
        for (i, j) in (0..6).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let (x, y) = (6.0 * f64::from(i), 5.0 * f64::from(j));
            let strain = 0.01 * frame as f64;
            let off = 0.01 * f64::from((7 * i + 5 * j) % 3 - 1);
            let (ux, uy) = (strain * x + off, -0.4 * strain * (y - 5.0) - off);
            text += &format!("{frame},{x},{y},{ux:.4},{uy:.4}\n");
        }
    }
    text
}

pub const CORRECT: &str = "correct m.csv --material neo-hooke --thickness 2mm --free top,bottom --rigid left,right \
                       --cells triangle3 --cell-size 5mm --edge-gap 0mm --noise 0.01mm --output c";

/// A folder with two studies of which the second has more results, and with markers.
pub fn workplace() -> TempDir {
    let folder = TempDir::new().unwrap();
    let write = |name, text: String| fs::write(folder.path().join(name), text).unwrap();
    write("a.toml", study("\"10 %\""));
    write("b.toml", study("\"10 %\", \"20 %\""));
    write("m.csv", markers(4));
    folder
}

pub fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gelbench"));
    command.current_dir(folder).args(arguments.split(' '));
    command
}

pub fn run(folder: &Path, arguments: &str) -> Output {
    command(folder, arguments).output().unwrap()
}

pub fn start(folder: &Path, arguments: &str) -> Child {
    let mut command = command(folder, arguments);
    let silent = command.stdout(Stdio::null()).stderr(Stdio::piped());
    silent.spawn().unwrap()
}

/// Sends a signal at once: a shell that sends it may be so late that the process has ended.
#[cfg(unix)]
pub fn send(child: &Child, signal: Signal) {
    let id = i32::try_from(child.id()).unwrap();
    nix::sys::signal::kill(nix::unistd::Pid::from_raw(id), signal).unwrap();
}

/// Runs a script in which `$G` is the program.
pub fn shell(folder: &Path, script: &str) -> Output {
    let mut command = Command::new("sh");
    command
        .current_dir(folder)
        .env("G", env!("CARGO_BIN_EXE_gelbench"));
    command.args(["-c", script]).output().unwrap()
}

pub fn output_text(output: &Output) -> String {
    super::one_line(&output.stderr)
}

#[track_caller]
pub fn assert_ends(output: &Output, code: i32, words: &str) {
    let message = output_text(output);
    assert_eq!(output.status.code(), Some(code), "{message}");
    assert!(message.contains(words), "{message}");
}

/// All files below a folder by their names, but for partial folders.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let (mut result, mut open) = (BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).into_iter().flatten().flatten() {
            let path = entry.path();
            let name = path
                .strip_prefix(folder)
                .unwrap()
                .to_str()
                .unwrap()
                .to_owned();
            if path.is_dir() && !name.starts_with(PARTIAL) {
                open.push(path);
            } else if path.is_file() {
                result.insert(name, fs::read(path).unwrap_or_default());
            }
        }
    }
    result
}

/// The results that are the same bytes on every run: reports hold times.
pub fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = files(folder);
    all.retain(|name, _| !name.starts_with("report.") && name != MANIFEST);
    all
}

pub fn manifest(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join(MANIFEST)).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// A folder of files that are not in place yet.
pub fn first_partial(folder: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let is_partial = |name: &str| name.starts_with(PARTIAL);
    let mut partial = entries.filter(|entry| is_partial(entry.file_name().to_str().unwrap()));
    partial.next().map(|entry| entry.path())
}

pub fn partial(folder: &Path) -> bool {
    first_partial(folder).is_some()
}

/// Every file that a collection or the manifest names is there.
#[track_caller]
pub fn assert_complete(folder: &Path) {
    let files = files(folder);
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".pvd")) {
        let text = String::from_utf8_lossy(text).into_owned();
        for part in text.split("file=\"").skip(1) {
            let file = format!("vtk/{}", part.split('"').next().unwrap());
            assert!(files.contains_key(&file), "{name} names {file}");
        }
    }
    if manifest(folder)["complete"] == true {
        for name in manifest(folder)["files"].as_object().unwrap().keys() {
            assert!(files.contains_key(name), "the manifest names {name}");
        }
    }
}

pub fn wait_for(what: impl Fn() -> bool) {
    let start = Instant::now();
    while !what() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
}
