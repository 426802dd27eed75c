//! Printing: results to standard output, what deserves attention and progress to standard error.

use std::collections::HashMap;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use serde_json::Value;

use super::message;
use crate::error::{Diagnostic, Error};
use crate::output;
use crate::results::End;

/// What a command comes to: its exit code, or the fault that decides on it.
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
    match IS_JSON.load(Ordering::Relaxed) {
        true => print_to(&mut io::stdout().lock(), &format!("{:#}\n", report())),
        false => Ok(()),
    }
}

/// Prints words for people; a reader that has gone away is no error.
pub fn print(text: &str) -> Result<(), Error> {
    match IS_JSON.load(Ordering::Relaxed) {
        true => print_to(&mut io::stderr().lock(), text),
        false => print_to(&mut io::stdout().lock(), text),
    }
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
    let coloured = io::stderr().is_terminal();
    for warning in warnings {
        let _ = write!(io::stderr(), "{}", message::diagnostic(warning, coloured));
    }
}

/// Writes a file, and tells what was kept that stood in its place.
///
/// # Errors
/// As [`output::save`].
pub fn save(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    warn(output::save(path, bytes)?.as_slice());
    Ok(())
}

/// Prints a fault with what may help.
pub fn complain(error: &Error) {
    let coloured = io::stderr().is_terminal();
    let text = match error {
        Error::Input(faults) => told(faults, &|fault| message::diagnostic(fault, coloured)),
        Error::Solve { fault, .. } => format!("error: {error}\n  try: {}\n", fault.advice()),
        Error::Write { .. } => format!("error: {error}\n"),
    };
    let _ = write!(io::stderr(), "{text}");
}

/// The words of some faults; of many with one cause the first ones stand for all.
fn told(faults: &[Diagnostic], words: &dyn Fn(&Diagnostic) -> String) -> String {
    const OF_ONE_CAUSE: usize = 3;
    let (mut text, mut more) = (String::new(), 0);
    let mut told: HashMap<(&str, &str), usize> = HashMap::new();
    for fault in faults {
        let alike = told.entry((&fault.key, &fault.message)).or_default();
        *alike += 1;
        match *alike <= OF_ONE_CAUSE {
            true => text += &words(fault),
            false => more += 1,
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
    let _ = write!(io::stderr(), "{text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_faults_with_one_cause_three_are_told() {
        let fault = |message: &str| Diagnostic::error("", message);
        let mut faults: Vec<Diagnostic> = (0..40).map(|_| fault("a")).collect();
        faults.push(fault("b"));
        let text = told(&faults, &|fault| format!("{}\n", fault.message));
        assert_eq!(text, "a\na\na\nb\n  and 37 more of the same\n");
    }
}
