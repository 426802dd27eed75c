//! What tells whether a command that was broken off is the same as a later one.

use gelbench_base::document::inputs;
use gelbench_report::output::identity;

/// The identity of a command by what was said to it, the contents of all files that it has read, and the program itself.
pub fn of(statement: &str) -> String {
    let program = std::env::current_exe().ok();
    identity(statement, &inputs::read(), program.as_deref())
}
