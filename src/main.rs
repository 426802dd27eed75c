//! The command `gelbench`.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    gelbench::command::main()
}
