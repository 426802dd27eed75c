//! A fault of the program itself, reported in one message.

use std::any::Any;
use std::io::Write;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};

/// The exit code of a fault of the program itself: `EX_SOFTWARE` of sysexits.
pub const EXIT_CODE: u8 = 70;

/// Sources whose panics are caught where they are called: the reader of VTK's legacy files panics on damaged ones, which is
/// reported as a fault of the file, and a picture that cannot be drawn is reported as a warning.
const CAUGHT: [&str; 4] = ["vtkio", "plotters", "tiny-skia", "output/picture"];

/// Performs work and returns its exit code, or [`EXIT_CODE`] where it panics. What it was writing has been removed by then: files
/// are written aside first.
pub fn contained(work: impl FnOnce() -> u8) -> u8 {
    panic::set_hook(Box::new(report));
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(EXIT_CODE)
}

fn report(fault: &PanicHookInfo) {
    let position = fault.location();
    if position.is_some_and(|position| CAUGHT.iter().any(|part| position.file().contains(part))) {
        return;
    }
    let position = position.map_or_else(String::new, |position| format!(" ({position})"));
    let _ = write!(std::io::stderr(), "{}", message(fault.payload(), &position));
}

fn message(payload: &dyn Any, position: &str) -> String {
    let texts = [
        payload.downcast_ref::<&str>().copied(),
        payload.downcast_ref::<String>().map(String::as_str),
    ];
    let what = texts.into_iter().flatten().next().unwrap_or("no reason");
    format!(
        "error: gelbench met a fault of its own: {what}{position}\n  nothing of this run was written; results of earlier runs are unchanged\n  please \
         report it with the command, its input files and the version: gelbench {}\n",
        env!("CARGO_PKG_VERSION")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_of_the_program_says_what_to_send() {
        let text = message(&"index out of bounds", " (src/mesh.rs:1:2)");
        assert!(
            text.contains("index out of bounds (src/mesh.rs:1:2)"),
            "{text}"
        );
        assert!(text.contains("please report"), "{text}");
        let formatted: Box<dyn Any + Send> = Box::new(format!("cell {}", 3));
        assert!(message(&*formatted, "").contains("cell 3"));
    }
}
