//! What is being computed, how far it is, and for how long: a bar on a terminal, a line now and then elsewhere, or a line for
//! every step.

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::terminal::columns_of_errors;

/// How often a line is written where there is no bar.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// A terminal with fewer columns has no room for a bar.
const FEWEST_COLUMNS: usize = 60;

/// What is shown of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// A bar on a terminal, a line now and then elsewhere.
    Usual,
    /// Nothing.
    Nothing,
    /// A line for every step and every file.
    EveryStep,
}

static SHOWN: AtomicU8 = AtomicU8::new(Shown::Usual as u8);

/// Chooses what is shown from here on.
pub fn show(shown: Shown) {
    SHOWN.store(shown as u8, Ordering::Relaxed);
}

fn is_shown(shown: Shown) -> bool {
    SHOWN.load(Ordering::Relaxed) == shown as u8
}

/// Names the files that were written, where every step is shown.
pub fn report_files(files: &[PathBuf]) {
    if is_shown(Shown::EveryStep) {
        let line = |file: &PathBuf| format!("gelbench: written: {}\n", file.display());
        let lines: String = files.iter().map(line).collect();
        let _ = std::io::stderr().write_all(lines.as_bytes());
    }
}

/// What is being computed, how far it is, and for how long.
pub enum Progress {
    /// Nothing is shown.
    Quiet,
    /// A bar, or a wheel where the number of parts is not known.
    Bar(ProgressBar),
    /// Lines.
    Lines(Lines),
    /// A line for every step.
    Steps(Mutex<State>),
}

impl Progress {
    /// Of so many parts, or of an unknown number where that is 0.
    pub fn of(parts: u64) -> Self {
        if is_shown(Shown::Nothing) {
            return Self::Quiet;
        }
        if is_shown(Shown::EveryStep) {
            return Self::Steps(Mutex::new(State::new(parts)));
        }
        if has_room() {
            Self::Bar(bar(parts))
        } else {
            Self::Lines(Lines::new(parts, BETWEEN_LINES, std::io::stderr()))
        }
    }

    /// Shows what is being computed.
    pub fn report(&self, what: &str) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.set_message(what.to_owned()),
            Self::Lines(lines) => what.clone_into(&mut lines.state().what),
            Self::Steps(state) => {
                let mut state = lock(state);
                what.clone_into(&mut state.what);
                let _ = std::io::stderr().write_all(state.line().as_bytes());
            }
        }
    }

    /// Notes that one more part is done.
    pub fn advance(&self) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.inc(1),
            Self::Lines(lines) => lines.state().done += 1,
            Self::Steps(state) => lock(state).done += 1,
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// Whether standard error is a terminal on which a bar can be drawn.
fn has_room() -> bool {
    let drawable = std::env::var("TERM").is_ok_and(|name| name != "dumb") || cfg!(windows);
    let wide = columns_of_errors().is_some_and(|columns| columns >= FEWEST_COLUMNS);
    std::io::stderr().is_terminal() && drawable && wide
}

fn bar(parts: u64) -> ProgressBar {
    let template = match parts {
        0 => "{spinner} {elapsed} {wide_msg}",
        _ => "{bar:30} {pos}/{len} {elapsed} {wide_msg}",
    };
    let style = ProgressStyle::with_template(template);
    let bar = ProgressBar::new(parts);
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// How far the work is.
pub struct State {
    start: Instant,
    what: String,
    done: u64,
    parts: u64,
}

impl State {
    fn new(parts: u64) -> Self {
        Self {
            start: Instant::now(),
            what: "begins".to_owned(),
            done: 0,
            parts,
        }
    }

    /// `gelbench: 20 s, 3 of 15 done: corrector, 50 % stretch`.
    fn line(&self) -> String {
        let seconds = self.start.elapsed().as_secs();
        let far = match (self.parts, self.done) {
            (0, 0) => String::new(),
            (0, done) => format!(", {done} done"),
            (parts, done) => format!(", {done} of {parts} done"),
        };
        format!("gelbench: {seconds} s{far}: {}\n", self.what)
    }
}

/// A line now and then, as long as it lives.
pub struct Lines {
    state: Arc<Mutex<State>>,
    end: Option<Sender<()>>,
    writing: Option<JoinHandle<()>>,
}

impl Lines {
    fn new(parts: u64, between: Duration, mut out: impl Write + Send + 'static) -> Self {
        let state = Arc::new(Mutex::new(State::new(parts)));
        let shown = Arc::clone(&state);
        let (end, ended) = channel();
        let writing = std::thread::spawn(move || {
            while ended.recv_timeout(between) == Err(RecvTimeoutError::Timeout) {
                let line = lock(&shown).line();
                // Nobody may be there to read it.
                let _ = out.write_all(line.as_bytes());
            }
        });
        Self {
            state,
            end: Some(end),
            writing: Some(writing),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }
}

fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for Lines {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(writing) = self.writing.take() {
            let _ = writing.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Default)]
    struct Page(Arc<Mutex<Vec<u8>>>);

    impl Write for Page {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().extend(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn lines_say_what_is_computed_how_far_and_for_how_long() {
        let page = Page::default();
        let between = Duration::from_millis(20);
        let progress = Progress::Lines(Lines::new(3, between, page.clone()));
        progress.report("corrector, 50 % stretch");
        progress.advance();
        std::thread::sleep(10 * between);
        drop(progress);
        let printed = String::from_utf8(page.0.lock().unwrap().clone()).unwrap();
        let line = "gelbench: 0 s, 1 of 3 done: corrector, 50 % stretch\n";
        assert!(printed.contains(line), "{printed}");
        let unknown = Lines::new(0, between, Page::default());
        assert_eq!(unknown.state().line(), "gelbench: 0 s: begins\n");
    }
}
