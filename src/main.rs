//! The command: arguments to call, to print, to exit code.

use std::process::ExitCode;

fn main() -> ExitCode {
    gelbench::command::main()
}
