//! The command `gelbench`.

use std::process::ExitCode;

fn main() -> ExitCode {
    gelbench::command::main()
}
