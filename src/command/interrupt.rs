//! What happens when the user interrupts a command, and how the same command is recognised when it is started again.

use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};

use gelbench_base::document::inputs;
use gelbench_base::error::Error;
use gelbench_report::output::{self, Remains, ResultFolder, Unfinished};

/// The exit code of a command that was interrupted: 128 and the number of the signal.
const EXIT_CODE: i32 = 130;

static UNFINISHED: Mutex<Option<Arc<Unfinished>>> = Mutex::new(None);

/// From here on an interrupted command removes the files that are not yet in place, reports it and ends.
pub fn attend() {
    // Without a handler the system ends the command, and the next one sweeps what it has left.
    let _ = ctrlc::set_handler(|| {
        let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        // Locked until the end: files that were removed are not written again meanwhile.
        let broken_off = unfinished.as_ref().map(|folder| folder.break_off());
        let remains = match broken_off.as_ref().map(|run| run.remains) {
            None | Some(Remains::Nothing) => {
                "nothing of this run is kept; results of earlier runs are unchanged"
            }
            Some(Remains::Parts) => {
                "the same command continues from here; results of earlier runs are unchanged"
            }
            Some(Remains::Results) => "the results of this run are complete",
        };
        let _ = writeln!(std::io::stderr(), "interrupted: {remains}");
        std::process::exit(EXIT_CODE);
    });
}

/// Opens results whose unfinished files an interrupt removes; one that comes meanwhile waits until they are open.
///
/// # Errors
/// Those of opening them.
pub fn guarded<T: AsRef<ResultFolder>>(
    open: impl FnOnce() -> Result<T, Error>,
) -> Result<T, Error> {
    let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    let opened = open()?;
    *unfinished = Some(opened.as_ref().unfinished());
    Ok(opened)
}

/// The identity of a command: its statement, the contents of all files that it has read, and the program itself.
pub fn identity(statement: &str) -> String {
    let program = std::env::current_exe().ok();
    output::identity(statement, &inputs::read(), program.as_deref())
}
