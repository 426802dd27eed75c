//! Printing: results to standard output, warnings, faults and progress to standard error.

use std::collections::HashMap;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use serde_json::Value;
use textwrap::{Options, WordSeparator, WordSplitter};

use super::message;
use gelbench_base::error::{Diagnostic, Error};
use gelbench_report::output;
use gelbench_report::results::End;

/// The end of a command: its exit code, or the fault that determines it.
pub type Outcome = Result<u8, Error>;

/// The exit code where a model and its conditions do not explain the measured data.
pub const NOT_EXPLAINED: u8 = 5;

/// What of a report is printed.
#[derive(Args, Clone, Copy, Debug)]
pub struct Printed {
    /// Print the report as JSON to standard output, and everything else to standard error
    #[arg(long)]
    json: bool,
}

/// Whether standard output is left to a report as JSON.
static IS_JSON: AtomicBool = AtomicBool::new(false);

impl Printed {
    /// From here on words go to standard error where a report is to be printed as JSON.
    pub fn choose(self) {
        IS_JSON.store(self.json, Ordering::Relaxed);
    }
}

/// Prints a report as JSON, if that is wanted.
pub fn print_report(report: impl FnOnce() -> Value) -> Result<(), Error> {
    if IS_JSON.load(Ordering::Relaxed) {
        print_data(&format!("{:#}\n", report()))
    } else {
        Ok(())
    }
}

/// Columns of the terminal behind standard error; `None` where there is none.
pub fn columns_of_errors() -> Option<usize> {
    columns(terminal_size::terminal_size_of(io::stderr()))
}

/// `COLUMNS`, as shells and tests state it, precedes the width that the terminal reports.
fn columns(terminal: Option<(terminal_size::Width, terminal_size::Height)>) -> Option<usize> {
    /// Narrower lines cannot be read.
    const LEAST: usize = 20;
    let variable = std::env::var("COLUMNS").ok();
    let stated = variable.and_then(|columns| columns.trim().parse().ok());
    let known = stated.or(terminal.map(|(width, _)| usize::from(width.0)));
    known
        .filter(|columns| *columns > 0)
        .map(|columns| columns.max(LEAST))
}

/// Lines that are longer than the terminal is wide, broken between words; what belongs to a line is indented below it.
fn wrapped(text: &str, columns: Option<usize>) -> String {
    let Some(columns) = columns else {
        return text.to_owned();
    };
    let of_line = |line: &str| {
        let indent = line.len() - line.trim_start_matches(' ').len() + 2;
        let indent = " ".repeat(indent.min(columns / 2));
        // Paths and options are not broken.
        let options = Options::new(columns)
            .subsequent_indent(&indent)
            .word_separator(WordSeparator::AsciiSpace)
            .word_splitter(WordSplitter::NoHyphenation)
            .break_words(false);
        textwrap::fill(line, options)
    };
    text.split('\n').map(of_line).collect::<Vec<_>>().join("\n")
}

/// Prints words for people, in lines that the terminal has room for; a reader that has gone away is no error.
pub fn print(text: &str) -> Result<(), Error> {
    if IS_JSON.load(Ordering::Relaxed) {
        print_to(
            &mut io::stderr().lock(),
            &wrapped(text, columns_of_errors()),
        )
    } else {
        let columns = columns(terminal_size::terminal_size_of(io::stdout()));
        print_data(&wrapped(text, columns))
    }
}

/// Prints output for programs unchanged.
pub fn print_data(text: &str) -> Result<(), Error> {
    print_to(&mut io::stdout().lock(), text)
}

fn print_to(out: &mut dyn Write, text: &str) -> Result<(), Error> {
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::write("standard output", cause))
        }
        _ => Ok(()),
    }
}

/// Prints warnings.
pub fn warn(warnings: &[Diagnostic]) {
    for warning in warnings {
        let _ = write!(io::stderr(), "{}", diagnostic(warning));
    }
}

/// Prints warnings that are words alone.
pub fn warn_texts(words: impl IntoIterator<Item = impl Into<String>>) {
    let warnings = words.into_iter();
    warnings.for_each(|words| warn(&[Diagnostic::warning("", words)]));
}

fn diagnostic(finding: &Diagnostic) -> String {
    message::diagnostic(finding, io::stderr().is_terminal(), columns_of_errors())
}

/// Writes a file, and warns where a former file of its name was kept under another one.
///
/// # Errors
/// As [`output::save`].
pub fn save(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    warn(output::save(path, bytes)?.as_slice());
    Ok(())
}

/// Prints a fault with what may help.
pub fn complain(error: &Error) {
    let words = match error {
        Error::Input(faults) => {
            let _ = write!(io::stderr(), "{}", text_of(faults, &diagnostic));
            return;
        }
        Error::Solve { fault, .. } => format!("error: {error}\n  try: {}\n", fault.advice()),
        Error::Write { .. } => format!("error: {error}\n"),
    };
    let _ = write!(io::stderr(), "{}", wrapped(&words, columns_of_errors()));
}

/// The text of some faults; of many with one cause only the first ones.
fn text_of(faults: &[Diagnostic], words: &dyn Fn(&Diagnostic) -> String) -> String {
    const OF_ONE_CAUSE: usize = 3;
    let (mut text, mut more) = (String::new(), 0);
    let mut counts: HashMap<(&str, &str), usize> = HashMap::new();
    for fault in faults {
        let alike = counts.entry((&fault.key, &fault.message)).or_default();
        *alike += 1;
        if *alike <= OF_ONE_CAUSE {
            text += &words(fault)
        } else {
            more += 1
        }
    }
    if more > 0 {
        text += &format!("  and {more} more of the same\n");
    }
    text
}

/// Says which model ended early, and what to try.
pub fn complain_of_end(end: &End) {
    let advice = end.advice.map(|advice| format!("  try: {advice}\n"));
    let text = format!("error: {}\n{}", end.message, advice.unwrap_or_default());
    let _ = write!(io::stderr(), "{}", wrapped(&text, columns_of_errors()));
}

/// All of some results, or the faults of all of them.
pub fn together<T>(results: impl Iterator<Item = Result<T, Error>>) -> Result<Vec<T>, Error> {
    let (mut good, mut faults) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(one) => good.push(one),
            Err(Error::Input(wrong)) => faults.extend(wrong),
            Err(other) => return Err(other),
        }
    }
    Error::refuse(faults).map(|()| good)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_faults_with_one_cause_three_are_told() {
        let fault = |message: &str| Diagnostic::error("", message);
        let mut faults: Vec<Diagnostic> = (0..40).map(|_| fault("a")).collect();
        faults.push(fault("b"));
        let text = text_of(&faults, &|fault| format!("{}\n", fault.message));
        assert_eq!(text, "a\na\na\nb\n  and 37 more of the same\n");
    }

    #[test]
    fn only_lines_longer_than_the_terminal_are_broken_between_words() {
        let text = "  force on --edge-gap is 12.5 N\n\nshort   line\n";
        let broken = "  force on --edge-gap\n    is 12.5 N\n\nshort   line\n";
        assert_eq!(wrapped(text, Some(22)), broken);
        assert_eq!(wrapped(text, Some(80)), text);
        assert_eq!(wrapped(text, None), text);
    }
}
