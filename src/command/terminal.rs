//! Printing: results to standard output, what deserves attention and progress to standard error.

use std::io::{self, IsTerminal, Write};

use super::message;
use crate::error::{Diagnostic, Error};
use crate::results::End;

/// What a command comes to: its exit code, or the fault that decides on it.
pub type Outcome = Result<u8, Error>;

/// Prints to standard output; a reader that has gone away is no error.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = io::stdout().lock();
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

/// Prints a fault with what may help.
pub fn complain(error: &Error) {
    let coloured = io::stderr().is_terminal();
    let text = match error {
        Error::Input(faults) => faults
            .iter()
            .map(|fault| message::diagnostic(fault, coloured))
            .collect(),
        Error::Solve { fault, .. } => format!("error: {error}\n  try: {}\n", fault.advice()),
        Error::Write { .. } => format!("error: {error}\n"),
    };
    let _ = write!(io::stderr(), "{text}");
}

/// Says which model ended early, and what to try.
pub fn complain_of_end(end: &End) {
    let advice = end.advice.map(|advice| format!("  try: {advice}\n"));
    let text = format!("error: {}\n{}", end.message, advice.unwrap_or_default());
    let _ = write!(io::stderr(), "{text}");
}
